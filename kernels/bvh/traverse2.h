/* traverse2.h: nodes and leaves of the two-child layout; included by traverse.h.
 *
 * The ray goes on into the nearer child; the farther one waits on the stack with the distance at
 * which it is entered, and is dropped unseen if a nearer hit was found meanwhile. */
#ifndef CDL_BVH_TRAVERSE2_H
#define CDL_BVH_TRAVERSE2_H

#include "bvh/lanes.h"
#include "bvh/triangle.h"

#if CDL_BVH_WIDTH == 2

typedef cdl_BvhNode BvhNode;
typedef cdl_BvhTriangle BvhTriangle;

#ifdef CDL_MOTION
/* A triangle that moves: its corners between two of its keys. */
CDL_INLINE int bvh_moving(BvhRay ray, CDL_GLOBAL const BvhTriangle *triangles,
                          CDL_GLOBAL const BvhTriangle *w, BvhQuery *query) {
  CDL_GLOBAL const BvhTriangle *p = triangles + w->keys + query->time.key;
  CDL_GLOBAL const BvhTriangle *q = p + 1;
  float f = query->time.fraction;
  vec3 a = motion_mix3(attribute_vec3(p->v0, 0), attribute_vec3(q->v0, 0), f);
  vec3 b = motion_mix3(attribute_vec3(p->v1, 0), attribute_vec3(q->v1, 0), f);
  vec3 c = motion_mix3(attribute_vec3(p->v2, 0), attribute_vec3(q->v2, 0), f);
  return bvh_take_moving(ray, a, b, c, w->primitive, query);
}
#endif

/* Tests the triangles of a leaf; 1 if one became the best hit. */
CDL_INLINE int bvh_leaf(BvhRay ray, CDL_GLOBAL const BvhTriangle *triangles, uint leaf,
                        BvhQuery *query) {
  uint first = leaf & CDL_BVH_INDEX;
  uint last = first + ((leaf & ~CDL_BVH_LEAF) >> CDL_BVH_LENGTH_SHIFT);
  int taken = 0;
  for (uint i = first; i <= last; i++) {
    CDL_GLOBAL const BvhTriangle *w = triangles + i;
#ifdef CDL_MOTION
    if (w->keys != 0u) {
      taken |= bvh_moving(ray, triangles, w, query);
      continue;
    }
#endif
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

/* Where the ray enters each child, x and y; and where it leaves them, cut to `limit`: it meets
 * those that it enters before it leaves. */
CDL_INLINE void bvh_boxes(BvhRay r, CDL_GLOBAL const BvhNode *node, float limit, float2 *enter,
                          float2 *leave) {
  CDL_GLOBAL const float *planes = node->bounds;
  float2 ix = lanes2_all(r.inverse_x), iy = lanes2_all(r.inverse_y), iz = lanes2_all(r.inverse_z);
  float2 near_x = lanes2_fma(lanes2_load(planes + 2u * r.sign_x), ix, lanes2_all(r.near_x));
  float2 near_y = lanes2_fma(lanes2_load(planes + 2u * r.sign_y), iy, lanes2_all(r.near_y));
  float2 near_z = lanes2_fma(lanes2_load(planes + 2u * r.sign_z), iz, lanes2_all(r.near_z));
  float2 far_x = lanes2_fma(lanes2_load(planes + (6u - 2u * r.sign_x)), ix, lanes2_all(r.far_x));
  float2 far_y = lanes2_fma(lanes2_load(planes + (10u - 2u * r.sign_y)), iy, lanes2_all(r.far_y));
  float2 far_z = lanes2_fma(lanes2_load(planes + (14u - 2u * r.sign_z)), iz, lanes2_all(r.far_z));
  *enter = lanes2_max(lanes2_max(near_x, lanes2_all(0.0f)), lanes2_max(near_y, near_z));
  *leave = lanes2_min(lanes2_min(far_x, lanes2_all(limit)), lanes2_min(far_y, far_z));
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
  float2 enter, leave;
  bvh_boxes(ray, node, limit, &enter, &leave);
  (void)any;
  if (enter.x <= leave.x && enter.y <= leave.y) {
    uint x = node->child[0], y = node->child[1];
    if (enter.y < enter.x) {
      LANES_PREFETCH(nodes + (x & CDL_BVH_INDEX));
      bvh_put(stack, (*top)++, x, enter.x);
      return y;
    }
    LANES_PREFETCH(nodes + (y & CDL_BVH_INDEX));
    bvh_put(stack, (*top)++, y, enter.y);
    return x;
  }
  if (enter.x <= leave.x) return node->child[0];
  return enter.y <= leave.y ? node->child[1] : CDL_NONE;
}

CDL_INLINE uint bvh_enter_all(BvhRay ray, CDL_GLOBAL const BvhNode *nodes, uint at, float limit,
                              BvhStack *stack, uint top) {
  CDL_GLOBAL const BvhNode *node = nodes + at;
  float2 enter, leave;
  bvh_boxes(ray, node, limit, &enter, &leave);
  int swap = enter.y < enter.x;
  if (swap && enter.x <= leave.x) bvh_put(stack, top++, node->child[0], enter.x);
  if (enter.y <= leave.y) bvh_put(stack, top++, node->child[1], enter.y);
  if (!swap && enter.x <= leave.x) bvh_put(stack, top++, node->child[0], enter.x);
  return top;
}

#endif
#endif
