/* lens_medium: where rays do not begin at the camera's own place, the media that they begin in:
 * walks there from the camera. */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/dimensions.h"
#include "lib/state.h"
#include "media/walk.h"

__kernel void lens_medium(CDL_CONSTANT cdl_Params *restrict params,
                          CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const BvhNode *bvh_nodes,
                          CDL_GLOBAL const BvhTriangle *bvh_triangles,
                          CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                          CDL_GLOBAL const cdl_Triangle *triangles,
                          CDL_GLOBAL const cdl_Shape *shapes, CDL_GLOBAL const float *attributes,
                          CDL_GLOBAL const cdl_Material *materials,
                          CDL_GLOBAL const uint *camera_media, CDL_GLOBAL uint *path) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  CDL_CONSTANT float *to_world = params->camera.to_world;
  vec3 camera = v3(to_world[3], to_world[7], to_world[11]);
  vec3 offset = v3_sub(state_vec3(path, CDL_PATH_ORIGIN, stride, i), camera);
  if (!(v3_length2(offset) > 0.0f)) return;
#ifdef CDL_MOTION
  MotionTime time = path_time(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
#endif
  MediaStack stack =
      media_walk(media_make(camera_media[0], camera_media[1]), camera, offset, 1.0f,
                 params->pass_limit, bvh_nodes, bvh_triangles, bvh_instances, params->top_root,
                 triangles, shapes, attributes, materials CDL_TIME(time));
  state_set_uint(path, CDL_PATH_MEDIA, stride, i, stack.inner);
  state_set_uint(path, CDL_PATH_MEDIA + 1, stride, i, stack.outer);
}
