/* bvh.h: what rays are traced through: nodes, triangles in leaf order and instances.
 *
 * Two levels: the top level's leaves are instances, one each; an instance names the root of its
 * mesh's tree, whose leaves are ranges of triangles. Both levels live in one node buffer. Programs
 * are built for one layout, -DCDL_BVH_WIDTH=2 (the default) or 8; bvh/traverse.h names the layout's
 * types BvhNode and BvhTriangle. */
#ifndef CDL_ABI_BVH_H
#define CDL_ABI_BVH_H

#include "abi/types.h"

/* Bounds of a stack that no tree of host/bvh overflows. */
#define CDL_BVH_STACK 64   /* entries, width 2: the depths of both levels together */
#define CDL_BVH8_STACK 192 /* entries, width 8 */

/* Width 2: a node holds its children's boxes, so a ray fetches only nodes whose box it hits. An
 * empty child has min = +inf, max = -inf and is never entered. */
typedef struct cdl_BvhNode {
  float bounds[12]; /* min x of both, then min y, min z, max x, max y, max z */
  uint child[2];    /* references, see below */
  uint pad[2];
} cdl_BvhNode;
CDL_ABI_SIZE(cdl_BvhNode, 64);

/* A reference to a child: the index of a node; or, with bit 31 set, a leaf: 3 bits of its length
 * less one, then the index of its first triangle (width 8: group of triangles), or of its instance.
 */
#define CDL_BVH_LEAF 0x80000000u
#define CDL_BVH_LENGTH_SHIFT 28
#define CDL_BVH_LENGTH_MAX 8u
#define CDL_BVH_INDEX 0x0fffffffu

/* Width 2: a triangle in leaf order, corners as the mesh orders them. */
typedef struct cdl_BvhTriangle {
  float v0[3], v1[3], v2[3];
  uint primitive; /* global number, in the order of the triangle table; independent of the tree */
  uint keys;      /* where its keys lie in this array, if it moves; else 0 */
  uint pad;
} cdl_BvhTriangle;
CDL_ABI_SIZE(cdl_BvhTriangle, 48);

/* Width 8: structure of arrays. Unused children are empty boxes. */
typedef struct cdl_BvhNode8 {
  float bounds[48]; /* eight times min x, then min y, min z, max x, max y, max z of the children */
  uint child[8];    /* references */
  float all[6];     /* box of the node itself: min x y z, max x y z */
  uint pad[2];
} cdl_BvhNode8;
CDL_ABI_SIZE(cdl_BvhNode8, 256);

/* Width 8: four triangles at once. Unused lanes have primitive CDL_NONE and not-a-number vertices,
 * which no ray hits. In a group of which a triangle moves the first vertex is not a number, and the
 * bits of v[1] say where its keys lie in this array. */
typedef struct cdl_BvhTriangle4 {
  float v[36]; /* four times v0.x, then v0.y, v0.z, v1.x … v2.z */
  uint primitive[4];
} cdl_BvhTriangle4;
CDL_ABI_SIZE(cdl_BvhTriangle4, 160);

/* Instance flags. */
#define CDL_INSTANCE_IDENTITY 1u /* object space is world space: rays need no transform */

/* Visibility masks: a ray with mask m sees the instances with (instance.mask & m) != 0. */
#define CDL_MASK_ALL 0xffffffffu

/* A mesh placed in the world. The host gives instances in its own order and hits name them by it.
 */
typedef struct cdl_BvhInstance {
  float to_object[12]; /* 3x4, row-major */
  float to_world[12];
  float object_bounds[6]; /* of the mesh: min x y z, max x y z */
  float world_bounds[6];  /* padded, so that rounding in the transform cannot lose a hit */
  uint root;              /* node at which the mesh's tree begins */
  uint mask;
  uint flags;
  uint mesh;
  uint object;      /* of the scene: node number */
  uint first_light; /* light of the mesh's first triangle; CDL_NONE: no lights */
  uint medium;      /* what the mesh holds, where its shape does not say it */
  uint pad[5];
} cdl_BvhInstance;
CDL_ABI_SIZE(cdl_BvhInstance, 192);

#endif
