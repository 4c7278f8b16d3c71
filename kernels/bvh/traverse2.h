/* traverse2.h: nodes and leaves of the two-child layout; included by traverse.h.
 *
 * The ray goes on into the nearer child; the farther one waits on the stack with the distance at
 * which it is entered, and is dropped unseen if a nearer hit was found meanwhile. */
#ifndef CDL_BVH_TRAVERSE2_H
#define CDL_BVH_TRAVERSE2_H

#include "bvh/triangle.h"

#if CDL_BVH_WIDTH == 2

#include "bvh/lanes.h"

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
  CDL_GLOBAL const float *b = root->bounds;
  return bvh_ray(o, d, v3(bvh_min(b[0], b[1]), bvh_min(b[2], b[3]), bvh_min(b[4], b[5])),
                 v3(bvh_max(b[6], b[7]), bvh_max(b[8], b[9]), bvh_max(b[10], b[11])),
                 BVH_PAD_INSTANCES);
}

/* Where the ray, cut to 0 ... limit, enters each child, x and y; infinity: nowhere. */
CDL_INLINE float2 bvh_boxes(BvhRay r, CDL_GLOBAL const BvhNode *node, float limit) {
  CDL_GLOBAL const float *planes = node->bounds;
  float2 ix = lanes2_all(r.inverse_x), iy = lanes2_all(r.inverse_y), iz = lanes2_all(r.inverse_z);
  float2 near_x = lanes2_fma(lanes2_load(planes + 2u * r.sign_x), ix, lanes2_all(r.near_x));
  float2 near_y = lanes2_fma(lanes2_load(planes + 2u * r.sign_y), iy, lanes2_all(r.near_y));
  float2 near_z = lanes2_fma(lanes2_load(planes + 2u * r.sign_z), iz, lanes2_all(r.near_z));
  float2 far_x = lanes2_fma(lanes2_load(planes + (6u - 2u * r.sign_x)), ix, lanes2_all(r.far_x));
  float2 far_y = lanes2_fma(lanes2_load(planes + (10u - 2u * r.sign_y)), iy, lanes2_all(r.far_y));
  float2 far_z = lanes2_fma(lanes2_load(planes + (14u - 2u * r.sign_z)), iz, lanes2_all(r.far_z));
  float2 enter = lanes2_max(lanes2_max(near_x, lanes2_all(0.0f)), lanes2_max(near_y, near_z));
  float2 leave = lanes2_min(lanes2_min(far_x, lanes2_all(limit)), lanes2_min(far_y, far_z));
  enter.x = enter.x <= leave.x ? enter.x : CDL_INFINITY;
  enter.y = enter.y <= leave.y ? enter.y : CDL_INFINITY;
  return enter;
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

CDL_INLINE uint bvh_enter(BvhRay ray, CDL_GLOBAL const BvhNode *nodes, uint at, float limit,
                          int any, BvhStack *stack, uint *top) {
  CDL_GLOBAL const BvhNode *node = nodes + at;
  float2 enters = bvh_boxes(ray, node, limit);
  uint near_child = enters.y < enters.x ? 1u : 0u;
  (void)any;
  LANES_PREFETCH(nodes + (node->child[1u - near_child] & CDL_BVH_INDEX));
  /* Stored in any case, which is cheaper than a branch that is hard to predict. */
  bvh_put(stack, *top, node->child[1u - near_child], bvh_max(enters.x, enters.y));
  *top += bvh_max(enters.x, enters.y) < CDL_INFINITY ? 1u : 0u;
  if (!(bvh_min(enters.x, enters.y) < CDL_INFINITY)) return CDL_NONE;
  return node->child[near_child];
}

CDL_INLINE uint bvh_enter_all(BvhRay ray, CDL_GLOBAL const BvhNode *nodes, uint at, float limit,
                              BvhStack *stack, uint top) {
  CDL_GLOBAL const BvhNode *node = nodes + at;
  float2 enters = bvh_boxes(ray, node, limit);
  uint near_child = enters.y < enters.x ? 1u : 0u;
  float enter = bvh_min(enters.x, enters.y), later = bvh_max(enters.x, enters.y);
  if (later < CDL_INFINITY) bvh_put(stack, top++, node->child[1u - near_child], later);
  if (enter < CDL_INFINITY) bvh_put(stack, top++, node->child[near_child], enter);
  return top;
}

#endif
#endif
