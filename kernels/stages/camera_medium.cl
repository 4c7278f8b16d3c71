/* camera_medium: which media the camera is inside of: walks to it from outside the scene. One
 * work-item, once a render. */
#include "lib/portable.h"

#include "abi/params.h"
#include "media/walk.h"

__kernel void camera_medium(CDL_CONSTANT cdl_Params *restrict params,
                            CDL_GLOBAL const BvhNode *bvh_nodes,
                            CDL_GLOBAL const BvhTriangle *bvh_triangles,
                            CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                            CDL_GLOBAL const cdl_Triangle *triangles,
                            CDL_GLOBAL const cdl_Shape *shapes, CDL_GLOBAL const float *attributes,
                            CDL_GLOBAL const cdl_Material *materials,
                            CDL_GLOBAL uint *camera_media) {
  if (get_global_id(0) != 0) return;
  CDL_CONSTANT float *to_world = params->camera.to_world;
  vec3 camera = v3(to_world[3], to_world[7], to_world[11]);
  vec3 center = v3(params->scene_center[0], params->scene_center[1], params->scene_center[2]);
  /* An odd direction, so that the ray does not run along edges of what people model. */
  vec3 direction = v3_normalize(v3(0.3713907f, -0.8017837f, 0.4682165f));
  float reach = 2.0f * params->scene_radius + v3_length(v3_sub(camera, center));
#ifdef CDL_MOTION
  MotionTime time = {0u, 0.0f}; /* where the camera is as the shutter opens */
#endif
  MediaStack stack =
      media_walk(media_make(0u, 0u), v3_madd(camera, -reach, direction), direction, reach,
                 params->pass_limit, bvh_nodes, bvh_triangles, bvh_instances, params->top_root,
                 triangles, shapes, attributes, materials CDL_TIME(time));
  camera_media[0] = stack.inner;
  camera_media[1] = stack.outer;
}
