/* traverse.h: ray queries. The one interface to both layouts, chosen by -DCDL_BVH_WIDTH=2|8.
 *
 *   Hit bvh_closest(nodes, triangles, instances, root, o, d, tmax, mask)
 *   Hit bvh_closest_after(nodes, triangles, instances, root, o, d, tmax, mask, after)
 *   int bvh_occluded(nodes, triangles, instances, root, o, d, tmax, mask)
 *
 * with CDL_GLOBAL const BvhNode *nodes, CDL_GLOBAL const BvhTriangle *triangles, CDL_GLOBAL const
 * cdl_BvhInstance *instances, uint root (cdl_Bvh.root), vec3 o, vec3 d, float tmax, uint mask.
 *
 * A ray hits at 0 < t <= tmax, both sides of every triangle, in units of d, which need not be unit.
 * tmax may be infinite. Origins on a surface are to be offset by the caller. bvh_closest gives the
 * smallest hit in the order of hit_before(); bvh_closest_after the smallest that comes after
 * another hit of the same ray, which goes on through transparent surfaces without losing or
 * repeating one; bvh_occluded is 1 exactly where bvh_closest hits. Rays with an infinite or
 * not-a-number component or without direction hit nothing. The answers do not depend on the tree:
 * bvh/triangle.h says why.
 *
 * With -DCDL_MOTION each takes the time as well, a MotionTime after the others: the answer is that
 * for the scene as it stands then.
 */
#ifndef CDL_BVH_TRAVERSE_H
#define CDL_BVH_TRAVERSE_H

#ifndef CDL_BVH_WIDTH
#define CDL_BVH_WIDTH 2
#endif

#include "bvh/triangle.h"

#include "bvh/traverse2.h"
#include "bvh/traverse8.h"

#include "bvh/instance.h"

CDL_INLINE Hit bvh_closest_after(CDL_GLOBAL const BvhNode *nodes,
                                 CDL_GLOBAL const BvhTriangle *triangles,
                                 CDL_GLOBAL const cdl_BvhInstance *instances, uint root, vec3 o,
                                 vec3 d, float tmax, uint mask, Hit after CDL_TIME_PARAM) {
  return bvh_search(nodes, triangles, instances, root, o, d, tmax, mask, after, 0 CDL_TIME(time));
}

CDL_INLINE int bvh_occluded(CDL_GLOBAL const BvhNode *nodes,
                            CDL_GLOBAL const BvhTriangle *triangles,
                            CDL_GLOBAL const cdl_BvhInstance *instances, uint root, vec3 o, vec3 d,
                            float tmax, uint mask CDL_TIME_PARAM) {
  return hit_is_some(bvh_search(nodes, triangles, instances, root, o, d, tmax, mask, hit_none(0.0f),
                                1 CDL_TIME(time)));
}

CDL_INLINE Hit bvh_closest(CDL_GLOBAL const BvhNode *nodes, CDL_GLOBAL const BvhTriangle *triangles,
                           CDL_GLOBAL const cdl_BvhInstance *instances, uint root, vec3 o, vec3 d,
                           float tmax, uint mask CDL_TIME_PARAM) {
  return bvh_closest_after(nodes, triangles, instances, root, o, d, tmax, mask,
                           hit_none(0.0f) CDL_TIME(time));
}

#endif
