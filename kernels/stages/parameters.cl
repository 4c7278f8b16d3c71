/* parameters: what a surface's model depends on beyond its base colour, textures applied: the words
 * of abi/param_fields.h, and the normal of a clear coat. */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/dimensions.h"
#include "lib/material.h"
#include "lib/state.h"
#include "lib/surface.h"

CDL_INLINE float texel_channel(Texel texel, uint channel) {
  return channel == 0u ? texel.r : channel == 1u ? texel.g : channel == 2u ? texel.b : texel.a;
}

__kernel void
parameters(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
           CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
           CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
           CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
           CDL_GLOBAL const cdl_ParamTexture *param_textures,
           CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
           CDL_GLOBAL const float *srgb, CDL_GLOBAL const uint *path, CDL_GLOBAL uint *work) {
  size_t i = get_global_id(0);
  (void)params;
  size_t stride = wave->stride;
  CDL_GLOBAL const cdl_Material *material =
      materials + state_uint(work, CDL_WORK_MATERIAL, stride, i);
  for (uint k = 0; k < material->param_count; k++)
    state_set_float(work, CDL_WORK_PARAM + k, stride, i, material->param[k]);
#ifdef CDL_TEXTURES
  CDL_GLOBAL const cdl_Triangle *triangle =
      triangles + state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
  float u = state_float(path, CDL_PATH_HIT_U, stride, i);
  float v = state_float(path, CDL_PATH_HIT_V, stride, i);
  TextureCoords uv = shape_texture_coords(shape, attributes, triangle, u, v);
  for (uint n = 0; n < material->texture_count; n++) {
    CDL_GLOBAL const cdl_ParamTexture *from = param_textures + material->first_texture + n;
    Texel texel = texture_lookup(&from->slot, textures, texels, srgb, uv, (int)from->decode);
    for (uint k = 0; k < from->words; k++) {
      float value = fma(from->scale[k], texel_channel(texel, from->channel + k), from->offset);
      state_set_float(work, CDL_WORK_PARAM + from->param + k, stride, i, value);
    }
  }
#endif
#ifdef CDL_GLTF_CLEARCOAT
  vec3 wo = v3_neg(state_vec3(path, CDL_PATH_DIRECTION, stride, i));
  CDL_GLOBAL const cdl_BvhInstance *instance =
      bvh_instances + state_uint(path, CDL_PATH_HIT_INSTANCE, stride, i);
  int front = (state_uint(work, CDL_WORK_VERTEX, stride, i) & CDL_VERTEX_FRONT) != 0u;
  CDL_GLOBAL const cdl_Triangle *hit =
      triangles + state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
#ifdef CDL_MOTION
  MotionTime time = path_time(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
#endif
  SurfacePoint point = surface_point(instance, shapes + hit->shape, attributes, hit,
                                     state_float(path, CDL_PATH_HIT_U, stride, i),
                                     state_float(path, CDL_PATH_HIT_V, stride, i) CDL_TIME(time));
  vec3 normal = point.normal;
#ifdef CDL_TEXTURES
  normal = material_normal(&material->coat_normal_texture, material->coat_normal_scale, point, uv,
                           textures, texels, srgb);
#endif
  normal = surface_face_path(v3_select(front, normal, v3_neg(normal)), wo);
  state_set_vec3(work, CDL_WORK_COAT_NORMAL, stride, i, normal);
#endif
}
