/* camera_medium: which media the camera is inside of: follows a ray from outside the scene to it
 * and keeps account of what it enters and leaves. One work-item, once a render. */
#include "lib/portable.h"

#include "abi/params.h"
#include "bvh/traverse.h"
#include "lib/passable.h"

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
  vec3 origin = v3_madd(camera, -reach, direction);
  MediaStack stack = media_make(0u, 0u);
  Hit last = hit_none(0.0f);
  for (uint passed = 0; passed < params->pass_limit; passed++) {
    Hit hit = bvh_closest_after(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin,
                                direction, reach, CDL_MASK_ALL, last);
    if (!hit_is_some(hit)) break;
    int repeated = hit_repeats(hit, last, direction, bvh_instances, triangles, shapes, attributes);
    last = hit;
    if (repeated) continue;
    CDL_GLOBAL const cdl_Material *material =
        materials + shapes[triangles[hit.primitive].shape].material;
    /* Opaque surfaces are often open; they count as closed only if they say what they hold. */
    if (material->model == CDL_MODEL_INTERFACE || material->model == CDL_MODEL_DIELECTRIC ||
        material->medium != CDL_MEDIUM_VACUUM)
      stack = hit_crossed(hit, stack, direction, material->medium, bvh_instances, triangles, shapes,
                          attributes);
  }
  camera_media[0] = stack.inner;
  camera_media[1] = stack.outer;
}
