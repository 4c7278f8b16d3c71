/* walk.h: the media that a point is inside of, known from those of another point: what a straight
 * line between them enters and leaves. */
#ifndef CDL_MEDIA_WALK_H
#define CDL_MEDIA_WALK_H

#include "bvh/traverse.h"
#include "lib/passable.h"

/* Follows `direction` from `origin` to `reach` (in units of direction) and keeps account of every
 * boundary of a medium on the way, at most `limit` surfaces. */
CDL_FUNCTION MediaStack media_walk(MediaStack stack, vec3 origin, vec3 direction, float reach,
                                   uint limit, CDL_GLOBAL const BvhNode *nodes,
                                   CDL_GLOBAL const BvhTriangle *bvh_triangles,
                                   CDL_GLOBAL const cdl_BvhInstance *instances, uint root,
                                   CDL_GLOBAL const cdl_Triangle *triangles,
                                   CDL_GLOBAL const cdl_Shape *shapes,
                                   CDL_GLOBAL const float *attributes,
                                   CDL_GLOBAL const cdl_Material *materials CDL_TIME_PARAM) {
  Hit last = hit_none(0.0f);
  for (uint crossed = 0; crossed < limit; crossed++) {
    Hit hit = bvh_closest_after(nodes, bvh_triangles, instances, root, origin, direction, reach,
                                CDL_MASK_ALL, last CDL_TIME(time));
    if (!hit_is_some(hit)) break;
    int repeated =
        hit_repeats(hit, last, direction, instances, triangles, shapes, attributes CDL_TIME(time));
    CDL_GLOBAL const cdl_Material *material =
        materials + shapes[triangles[hit.primitive].shape].material;
    /* Opaque surfaces count where they hold a medium: without one, nothing says that they are
     * closed. */
    int boundary = (material->flags & CDL_MATERIAL_BOUNDARY) != 0u;
    if (boundary && !repeated)
      stack = hit_crossed(hit, stack, direction, instances, triangles, shapes,
                          attributes CDL_TIME(time));
    last = hit;
  }
  return stack;
}

#endif
