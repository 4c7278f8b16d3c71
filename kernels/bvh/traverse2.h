/* traverse2.h: nodes and leaves of the two-child layout; included by traverse.h.
 *
 * The ray goes on into the nearer child; the farther one waits on the stack with the distance at
 * which it is entered, and is dropped unseen if a nearer hit was found meanwhile. */
#ifndef CDL_BVH_TRAVERSE2_H
#define CDL_BVH_TRAVERSE2_H

#include "bvh/triangle.h"

#if CDL_BVH_WIDTH == 2

typedef cdl_BvhNode BvhNode;
typedef cdl_BvhTriangle BvhTriangle;

/* Tests the triangles of a leaf; 1 if one became the best hit. */
CDL_INLINE int bvh_leaf(BvhRay ray, CDL_GLOBAL const BvhTriangle *triangles, uint leaf,
                        BvhQuery *query) {
  uint first = leaf & CDL_BVH_INDEX;
  uint last = first + ((leaf & ~CDL_BVH_LEAF) >> CDL_BVH_LENGTH_SHIFT);
  int taken = 0;
  for (uint i = first; i <= last; i++) {
    CDL_GLOBAL const BvhTriangle *w = triangles + i;
    float t, u, v;
    if (!triangle_test(ray, triangle_shear(ray, w->v0, w->v1, w->v2), &t, &u, &v)) continue;
    float enter =
        triangle_enter(ray, v3(w->v0[0], w->v0[1], w->v0[2]), v3(w->v1[0], w->v1[1], w->v1[2]),
                       v3(w->v2[0], w->v2[1], w->v2[2]));
    taken |= bvh_take(query, t, u, v, w->primitive, enter);
  }
  return taken;
}

/* The ray in world space, padded for the whole scene. */
CDL_INLINE BvhRay bvh_ray_in_world(CDL_GLOBAL const BvhNode *root, vec3 o, vec3 d) {
  CDL_GLOBAL const float *a = root->bounds[0], *b = root->bounds[1];
  return bvh_ray(o, d, v3(bvh_min(a[0], b[0]), bvh_min(a[1], b[1]), bvh_min(a[2], b[2])),
                 v3(bvh_max(a[3], b[3]), bvh_max(a[4], b[4]), bvh_max(a[5], b[5])),
                 BVH_PAD_INSTANCES);
}

/* References that wait, and where the ray enters them. */
typedef struct BvhStack {
  uint child[CDL_BVH_STACK];
  float enter[CDL_BVH_STACK];
} BvhStack;

CDL_INLINE void bvh_put(BvhStack *stack, uint top, uint child, float enter) {
  stack->child[top] = child;
  stack->enter[top] = enter;
}

CDL_INLINE uint bvh_enter(BvhRay ray, CDL_GLOBAL const BvhNode *node, float limit, int any,
                          BvhStack *stack, uint *top) {
  float enter0 = bvh_box(ray, node->bounds[0], limit);
  float enter1 = bvh_box(ray, node->bounds[1], limit);
  uint near_child = enter1 < enter0 ? 1u : 0u;
  (void)any;
  if (!(bvh_min(enter0, enter1) < CDL_INFINITY)) return CDL_NONE;
  if (bvh_max(enter0, enter1) < CDL_INFINITY)
    bvh_put(stack, (*top)++, node->child[1u - near_child], bvh_max(enter0, enter1));
  return node->child[near_child];
}

CDL_INLINE uint bvh_enter_all(BvhRay ray, CDL_GLOBAL const BvhNode *node, float limit,
                              BvhStack *stack, uint top) {
  float enter0 = bvh_box(ray, node->bounds[0], limit);
  float enter1 = bvh_box(ray, node->bounds[1], limit);
  uint near_child = enter1 < enter0 ? 1u : 0u;
  float enter = bvh_min(enter0, enter1), later = bvh_max(enter0, enter1);
  if (later < CDL_INFINITY) bvh_put(stack, top++, node->child[1u - near_child], later);
  if (enter < CDL_INFINITY) bvh_put(stack, top++, node->child[near_child], enter);
  return top;
}

#endif
#endif
