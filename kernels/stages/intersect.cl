/* intersect: finds the nearest surface of every living path and the queue that it belongs to. */
#include "lib/portable.h"

#include "abi/geometry.h"
#include "abi/material.h"
#include "abi/params.h"
#include "bvh/traverse.h"
#include "lib/dimensions.h"
#include "lib/passable.h"
#include "lib/state.h"

/* The queue of the material that was hit. A path that `ends` here can only see what is emitted,
 * there or, where the material has holes, behind them. */
CDL_INLINE uint hit_queue(Hit hit, int ends, CDL_GLOBAL const cdl_Triangle *triangles,
                          CDL_GLOBAL const cdl_Shape *shapes,
                          CDL_GLOBAL const cdl_Material *materials) {
  if (!hit_is_some(hit)) return CDL_QUEUE_ESCAPED;
  CDL_GLOBAL const cdl_Material *material =
      materials + shapes[triangles[hit.primitive].shape].material;
  if (material->model == CDL_MODEL_INTERFACE) return CDL_QUEUE_PASS;
  uint emissive = material->flags & CDL_MATERIAL_EMISSIVE ? 1u : 0u;
  uint holes = material->flags & (CDL_MATERIAL_MASK | CDL_MATERIAL_BLEND);
  if (ends && !emissive && !holes && material->model != CDL_MODEL_UNLIT) return CDL_QUEUE_ENDED;
  return CDL_QUEUE_MODELS + 2u * material->model + emissive;
}

__kernel void
intersect(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
          CDL_GLOBAL const BvhNode *bvh_nodes, CDL_GLOBAL const BvhTriangle *bvh_triangles,
          CDL_GLOBAL const cdl_BvhInstance *bvh_instances, CDL_GLOBAL const cdl_Triangle *triangles,
          CDL_GLOBAL const cdl_Shape *shapes, CDL_GLOBAL const float *attributes,
          CDL_GLOBAL const cdl_Material *materials, CDL_GLOBAL uint *path, CDL_GLOBAL uint *work) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  if (state_uint(work, CDL_WORK_QUEUE, stride, i) != CDL_QUEUE_LIVE) return;
  vec3 origin = state_vec3(path, CDL_PATH_ORIGIN, stride, i);
  vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
#ifdef CDL_MOTION
  MotionTime time = path_time(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
#endif
#ifdef CDL_PASSABLE
  Hit last = hit_none(state_float(path, CDL_PATH_PASSED, stride, i));
  if (last.t > 0.0f) {
    last.primitive = state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i);
    last.instance = state_uint(path, CDL_PATH_HIT_INSTANCE, stride, i);
  }
  Hit hit = bvh_closest_after(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin,
                              direction, CDL_INFINITY, CDL_MASK_ALL, last CDL_TIME(time));
  while (hit_repeats(hit, last, direction, bvh_instances, triangles, shapes,
                     attributes CDL_TIME(time))) {
    last = hit;
    hit = bvh_closest_after(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin,
                            direction, CDL_INFINITY, CDL_MASK_ALL, last CDL_TIME(time));
  }
#else
  Hit hit = bvh_closest(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin,
                        direction, CDL_INFINITY, CDL_MASK_ALL CDL_TIME(time));
#endif
  int found = hit_is_some(hit);
  state_set_float(path, CDL_PATH_HIT_T, stride, i, found ? hit.t : CDL_INFINITY);
  state_set_float(path, CDL_PATH_HIT_U, stride, i, hit.u);
  state_set_float(path, CDL_PATH_HIT_V, stride, i, hit.v);
  state_set_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i, found ? hit.primitive : 0u);
  state_set_uint(path, CDL_PATH_HIT_INSTANCE, stride, i, found ? hit.instance : 0u);
  uint depth = counts_depth(state_uint(path, CDL_PATH_COUNTS, stride, i));
  int ends = depth > 0u && depth >= params->max_depth; /* depth 0 is kept for AOVs */
  uint queue = hit_queue(hit, ends, triangles, shapes, materials);
  state_set_uint(work, CDL_WORK_QUEUE, stride, i, queue);
}
