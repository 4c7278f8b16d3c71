/* occlude: shadow rays. What the light adds arrives if nothing opaque is in between, weakened by
 * media, holes and half transparent surfaces on the way. */
#include "lib/portable.h"

#include "abi/params.h"
#include "bvh/traverse.h"
#include "lib/passable.h"
#include "lib/state.h"
#include "media/homogeneous.h"

/* How far a shadow ray goes: short of the light, which would else shadow its own points, by some
 * hundred units in the last place of the coordinates there. */
CDL_INLINE float shadow_reach(vec3 origin, vec3 target, float distance) {
  float size = math_max(math_max(math_abs(origin.x), math_abs(target.x)),
                        math_max(math_abs(origin.y), math_abs(target.y)));
  size = math_max(size, math_max(math_abs(origin.z), math_abs(target.z)));
  return distance < CDL_INFINITY ? math_max(fma(-3e-5f, size, distance), 0.0f) : CDL_INFINITY;
}

#ifdef CDL_MEDIA
CDL_INLINE vec3 medium_transmittance(CDL_GLOBAL const cdl_Medium *medium, float distance) {
  vec3 extinction = v3(medium->absorption[0] + medium->scattering[0],
                       medium->absorption[1] + medium->scattering[1],
                       medium->absorption[2] + medium->scattering[2]);
  return homogeneous_transmittance(extinction, distance);
}
#endif

__kernel void occlude(CDL_CONSTANT cdl_Params *restrict params,
                      CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const BvhNode *bvh_nodes,
                      CDL_GLOBAL const BvhTriangle *bvh_triangles,
                      CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                      CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
                      CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
                      CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
                      CDL_GLOBAL const float *srgb, CDL_GLOBAL const cdl_Medium *media,
                      CDL_GLOBAL const uint *path, CDL_GLOBAL const uint *work,
                      CDL_GLOBAL uint *slots) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  vec3 radiance = state_vec3(work, CDL_WORK_SHADOW_RADIANCE, stride, i);
  if (!(v3_max(radiance) > 0.0f)) return;
  vec3 origin = state_vec3(work, CDL_WORK_SHADOW_ORIGIN, stride, i);
  vec3 direction = state_vec3(work, CDL_WORK_LIGHT_DIRECTION, stride, i);
  float distance = state_float(work, CDL_WORK_LIGHT_DISTANCE, stride, i);
  /* The ray begins beside the vertex, and still ends at the very point of the light. */
  vec3 position = state_vec3(work, CDL_WORK_POSITION, stride, i);
  vec3 target = v3_madd(position, distance, direction);
  if (distance < CDL_INFINITY) {
    direction = v3_normalize(v3_sub(target, origin));
    distance = v3_length(v3_sub(target, origin));
  }
  float reach = shadow_reach(origin, target, distance);
  if (bvh_occluded(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin, direction,
                   reach, CDL_MASK_OPAQUE))
    return;

#if defined(CDL_MEDIA) || defined(CDL_PASSABLE)
  MediaStack stack = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
  Hit last = hit_none(0.0f);
  int arrived = 0;
  for (uint passed = 0; passed < params->pass_limit && !arrived; passed++) {
    Hit hit = hit_none(0.0f);
#ifdef CDL_PASSABLE
    hit = bvh_closest_after(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin,
                            direction, reach, CDL_MASK_PASSABLE, last);
#endif
    arrived = !hit_is_some(hit);
#ifdef CDL_MEDIA
    float segment = (arrived ? distance : hit.t) - last.t;
    uint current = media_current(stack, params->scene_medium);
    radiance = v3_mul(radiance, medium_transmittance(media + current, segment));
#endif
#ifdef CDL_PASSABLE
    if (arrived) break;
    CDL_GLOBAL const cdl_Triangle *triangle = triangles + hit.primitive;
    CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
    CDL_GLOBAL const cdl_Material *material = materials + shape->material;
    int repeated = hit_repeats(hit, last, direction, bvh_instances, triangles, shapes, attributes);
    if (material->model != CDL_MODEL_INTERFACE) {
      TextureCoords uv = shape_texture_coords(shape, attributes, triangle, hit.u, hit.v);
      Texel base = material_base(material, shape, attributes, triangle, hit.u, hit.v, uv, textures,
                                 texels, srgb);
      radiance = v3_scale(radiance, repeated ? 1.0f : 1.0f - material_opacity(material, base.a));
    } else if (!repeated) {
      stack = hit_crossed(hit, stack, direction, material->medium, bvh_instances, triangles, shapes,
                          attributes);
    }
    last = hit;
#endif
    if (!(v3_max(radiance) > 0.0f)) return;
  }
  if (!arrived) return;
#endif
  uint slot = state_uint(path, CDL_PATH_SLOT, stride, i);
  state_add_radiance(slots, wave->slots, slot, radiance);
}
