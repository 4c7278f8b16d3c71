/* motion.h: what triangles that move add to the arrays. Internal to bvh/. */
#ifndef CANDELA_BVH_MOTION_H
#define CANDELA_BVH_MOTION_H

#include "bvh/bvh.h"

/* Appends the keys of every triangle (width 8: group of four) that moves to bvh->triangles, which
 * are complete otherwise, and marks it. 0, or -1 when memory is short or there are too many. */
int motion_append(const cdl_BvhMesh *meshes, uint32_t mesh_count, cdl_Bvh *bvh);

#endif
