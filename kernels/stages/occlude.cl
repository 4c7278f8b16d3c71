/* occlude: shadow rays. What the light adds arrives if nothing opaque is in between, weakened by
 * media, holes and half transparent surfaces on the way. */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/dimensions.h"
#include "lib/state.h"
#include "light/shadow.h"

__kernel void occlude(CDL_CONSTANT cdl_Params *restrict params,
                      CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const BvhNode *bvh_nodes,
                      CDL_GLOBAL const BvhTriangle *bvh_triangles,
                      CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                      CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
                      CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
                      CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
                      CDL_GLOBAL const float *srgb, CDL_GLOBAL const cdl_Medium *media,
                      CDL_GLOBAL const cdl_Grid *grids, CDL_GLOBAL const uint *grid_table,
                      CDL_GLOBAL const float *grid_most, CDL_GLOBAL const float *grid_values,
                      CDL_GLOBAL const uint *path, CDL_GLOBAL const uint *work,
                      CDL_GLOBAL uint *slots) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  vec3 radiance = state_vec3(work, CDL_WORK_SHADOW_RADIANCE, stride, i);
  if (!(v3_max(radiance) > 0.0f)) return;
  ShadowRay ray = shadow_ray(state_vec3(work, CDL_WORK_POSITION, stride, i),
                             state_vec3(work, CDL_WORK_SHADOW_ORIGIN, stride, i),
                             state_vec3(work, CDL_WORK_LIGHT_DIRECTION, stride, i),
                             state_float(work, CDL_WORK_LIGHT_DISTANCE, stride, i));
#ifdef CDL_MOTION
  MotionTime time = path_time(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
#endif
  if (bvh_occluded(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, ray.origin,
                   ray.direction, ray.reach, CDL_MASK_OPAQUE CDL_TIME(time)))
    return;
#if defined(CDL_MEDIA) || defined(CDL_PASSABLE)
  MediaStack stack = media_make(state_uint(work, CDL_WORK_SHADOW_MEDIA, stride, i),
                                state_uint(work, CDL_WORK_SHADOW_MEDIA + 1, stride, i));
  PathRandom random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
  uint vertex = counts_vertex(state_uint(path, CDL_PATH_COUNTS, stride, i));
  RandomStream stream = random_stream(random.key, random.sample, vertex, CDL_STREAM_SHADOW);
  radiance =
      shadow_filter(radiance, ray, stack, params->scene_medium, params->pass_limit, bvh_nodes,
                    bvh_triangles, params->top_root, media, stream, bvh_instances, triangles,
                    shapes, attributes, materials, textures, texels, srgb CDL_TIME(time) CDL_GRID);
#endif
  state_add_radiance(slots, wave->slots, state_uint(path, CDL_PATH_SLOT, stride, i), radiance);
}
