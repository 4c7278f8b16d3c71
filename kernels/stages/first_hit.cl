/* first_hit: what AOVs show of the first surface that a path does not pass through. */
#include "lib/portable.h"

#include "abi/bvh.h"
#include "abi/params.h"
#include "lib/camera.h"
#include "lib/dimensions.h"
#include "lib/material.h"
#include "lib/state.h"

__kernel void
first_hit(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
          CDL_GLOBAL const cdl_BvhInstance *bvh_instances, CDL_GLOBAL const cdl_Triangle *triangles,
          CDL_GLOBAL const cdl_Shape *shapes, CDL_GLOBAL const float *attributes,
          CDL_GLOBAL const cdl_Material *materials, CDL_GLOBAL const cdl_Texture *textures,
          CDL_GLOBAL const uint *texels, CDL_GLOBAL const float *srgb, CDL_GLOBAL const uint *path,
          CDL_GLOBAL const uint *work, CDL_GLOBAL uint *slots) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  uint slot = state_uint(path, CDL_PATH_SLOT, stride, i);
  uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
  if (counts_depth(counts) != 0u || slot >= wave->path_count) return;

  CDL_GLOBAL const cdl_Triangle *triangle =
      triangles + state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
  CDL_GLOBAL const cdl_BvhInstance *instance =
      bvh_instances + state_uint(path, CDL_PATH_HIT_INSTANCE, stride, i);
  CDL_GLOBAL const cdl_Material *material = materials + shape->material;
  TextureCoords uv = shape_texture_coords(shape, attributes, triangle,
                                          state_float(path, CDL_PATH_HIT_U, stride, i),
                                          state_float(path, CDL_PATH_HIT_V, stride, i));
  uint front = state_uint(work, CDL_WORK_VERTEX, stride, i) & CDL_VERTEX_FRONT;
  int lit = (front | (material->flags & CDL_MATERIAL_DOUBLE_SIDED)) != 0u;
  vec3 emission = material_emission(material, uv, textures, texels, srgb);
  vec3 position = state_vec3(work, CDL_WORK_POSITION, stride, i);
#ifdef CDL_MOTION
  MotionTime time = path_time(params, wave, slot);
#endif
  Transform camera = camera_to_world(params, attributes CDL_TIME(time));
  vec3 from_camera = v3_sub(position, camera.move);
  vec3 backwards = v3_normalize(v3(camera.x.z, camera.y.z, camera.z.z));
  uint object = surface_object(shape, instance);

  state_set_vec3(slots, CDL_SLOT_ALBEDO, wave->slots, slot,
                 state_vec3(work, CDL_WORK_BASE, stride, i));
  state_set_vec3(slots, CDL_SLOT_AOV_NORMAL, wave->slots, slot,
                 state_vec3(work, CDL_WORK_NORMAL, stride, i));
  state_set_float(slots, CDL_SLOT_DEPTH, wave->slots, slot, -v3_dot(from_camera, backwards));
  state_set_vec3(slots, CDL_SLOT_AOV_POSITION, wave->slots, slot, position);
  state_set_vec3(slots, CDL_SLOT_AOV_EMISSION, wave->slots, slot,
                 v3_select(lit, emission, v3_all(0.0f)));
  state_set_float(slots, CDL_SLOT_OBJECT, wave->slots, slot, (float)(int)(object + 1u));
  state_set_float(slots, CDL_SLOT_MATERIAL_ID, wave->slots, slot,
                  (float)(int)(shape->material + 1u));
}
