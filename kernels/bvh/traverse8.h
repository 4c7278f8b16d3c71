/* traverse8.h: nodes and leaves of the eight-child layout; included by traverse.h.
 *
 * Eight boxes, and four triangles, are tested at once with the roundings of triangle.h, so the hits
 * are those of the two-child layout bit for bit. Of the children that are hit, the nearest is
 * entered and the others wait on the stack, farthest lowest, with the distances at which they are
 * entered. */
#ifndef CDL_BVH_TRAVERSE8_H
#define CDL_BVH_TRAVERSE8_H

#include "bvh/lanes.h"
#include "bvh/triangle.h"

#if CDL_BVH_WIDTH == 8

typedef cdl_BvhNode8 BvhNode;
typedef cdl_BvhTriangle4 BvhTriangle;

/* Edge functions of four triangles. */
typedef struct Edges4 {
  float4 e0, e1, e2;
} Edges4;

/* Four triangles as Sheared. */
typedef struct Sheared4 {
  float4 ax, ay, az, bx, by, bz, cx, cy, cz;
} Sheared4;

CDL_INLINE Sheared4 triangle4_shear(BvhRay r, CDL_GLOBAL const BvhTriangle *w) {
  Sheared4 s;
  float4 x = lanes4_all(r.origin_x), y = lanes4_all(r.origin_y), z = lanes4_all(r.origin_z);
  float4 shear_x = lanes4_all(-r.shear_x), shear_y = lanes4_all(-r.shear_y);
  CDL_GLOBAL const float *plane_x = w->v + 4u * r.axis_x;
  CDL_GLOBAL const float *plane_y = w->v + 4u * r.axis_y;
  CDL_GLOBAL const float *plane_z = w->v + 4u * r.axis_z;
  s.az = lanes4_load(plane_z) - z;
  s.bz = lanes4_load(plane_z + 12) - z;
  s.cz = lanes4_load(plane_z + 24) - z;
  s.ax = lanes4_fma(shear_x, s.az, lanes4_load(plane_x) - x);
  s.ay = lanes4_fma(shear_y, s.az, lanes4_load(plane_y) - y);
  s.bx = lanes4_fma(shear_x, s.bz, lanes4_load(plane_x + 12) - x);
  s.by = lanes4_fma(shear_y, s.bz, lanes4_load(plane_y + 12) - y);
  s.cx = lanes4_fma(shear_x, s.cz, lanes4_load(plane_x + 24) - x);
  s.cy = lanes4_fma(shear_y, s.cz, lanes4_load(plane_y + 24) - y);
  return s;
}

CDL_INLINE float4 edge_functions(float4 a, float4 b, float4 c, float4 d) {
  float4 p = a * b;
  float4 q = c * d;
  return p - q;
}

CDL_INLINE float4 edge_functions_compensated(float4 a, float4 b, float4 c, float4 d) {
  float4 p = a * b;
  float4 q = c * d;
  float4 e = lanes4_fma(a, b, -p);
  float4 f = lanes4_fma(c, d, -q);
  return (p - q) + (e - f);
}

/* Where no two edge functions have different signs, nor is one of them not a number. */
CDL_INLINE int4 edges_agree(Edges4 e) {
  float4 zero = lanes4_all(0.0f);
  float4 low = lanes4_min(lanes4_min(e.e0, e.e1), e.e2);
  float4 high = lanes4_max(lanes4_max(e.e0, e.e1), e.e2);
  return (low >= zero) | (high <= zero);
}

/* Compensated where one of them is zero. */
CDL_INLINE Edges4 edges_exact(Sheared4 s, Edges4 e) {
  float4 zero = lanes4_all(0.0f);
  int4 unsure = (e.e0 == zero) | (e.e1 == zero) | (e.e2 == zero);
  if (lanes4_mask(unsure) == 0u) return e;
  e.e0 = lanes4_select(unsure, edge_functions_compensated(s.cx, s.by, s.cy, s.bx), e.e0);
  e.e1 = lanes4_select(unsure, edge_functions_compensated(s.ax, s.cy, s.ay, s.cx), e.e1);
  e.e2 = lanes4_select(unsure, edge_functions_compensated(s.bx, s.ay, s.by, s.ax), e.e2);
  return e;
}

/* Takes the lanes of `mask` that are better than the best hit so far; 1 if there was one. */
CDL_INLINE int bvh_take_lanes(BvhRay ray, CDL_GLOBAL const BvhTriangle *w, uint mask, float4 t4,
                              float4 u4, float4 v4, BvhQuery *query) {
  float t[4], u[4], v[4];
  int taken = 0;
  lanes4_store(t4, t);
  lanes4_store(u4, u);
  lanes4_store(v4, v);
  for (; mask != 0u; mask &= mask - 1u) {
    uint i = mask_lowest(mask);
    float enter = triangle_enter(ray, v3(w->v[i], w->v[4u + i], w->v[8u + i]),
                                 v3(w->v[12u + i], w->v[16u + i], w->v[20u + i]),
                                 v3(w->v[24u + i], w->v[28u + i], w->v[32u + i]));
    taken |= bvh_take(query, t[i], u[i], v[i], w->primitive[i], enter);
  }
  return taken;
}

/* Tests four triangles; 1 if one became the best hit. */
CDL_INLINE int bvh_group(BvhRay ray, CDL_GLOBAL const BvhTriangle *w, BvhQuery *query) {
  Sheared4 s = triangle4_shear(ray, w);
  Edges4 e;
  e.e0 = edge_functions(s.cx, s.by, s.cy, s.bx);
  e.e1 = edge_functions(s.ax, s.cy, s.ay, s.cx);
  e.e2 = edge_functions(s.bx, s.ay, s.by, s.ax);
  int4 inside = edges_agree(e);
  if (lanes4_mask(inside) == 0u) return 0;
  e = edges_exact(s, e);
  float4 determinant = (e.e0 + e.e1) + e.e2;
  float4 t = lanes4_fma(e.e0, s.az, lanes4_fma(e.e1, s.bz, e.e2 * s.cz)) / determinant;
  t = t * lanes4_all(ray.scale);
  inside &= edges_agree(e) & (determinant != lanes4_all(0.0f));
  inside &= (t > lanes4_all(0.0f)) & (t <= lanes4_all(query->best.t));
  uint mask = lanes4_mask(inside);
  if (mask == 0u) return 0;
  return bvh_take_lanes(ray, w, mask, t, e.e1 / determinant, e.e2 / determinant, query);
}

#ifdef CDL_MOTION
/* Corner `corner` of lane i between two keys of its group. */
CDL_INLINE vec3 bvh_lane_at(CDL_GLOBAL const BvhTriangle *p, uint corner, uint i, float f) {
  CDL_GLOBAL const float *a = p->v + 12u * corner + i;
  CDL_GLOBAL const float *b = (p + 1)->v + 12u * corner + i;
  return motion_mix3(v3(a[0], a[4], a[8]), v3(b[0], b[4], b[8]), f);
}

/* A group of which a triangle moves, one lane after the other. */
CDL_INLINE int bvh_moving(BvhRay ray, CDL_GLOBAL const BvhTriangle *triangles,
                          CDL_GLOBAL const BvhTriangle *w, BvhQuery *query) {
  CDL_GLOBAL const BvhTriangle *p = triangles + as_uint(w->v[1]) + query->time.key;
  float f = query->time.fraction;
  int taken = 0;
  for (uint i = 0; i < 4u && w->primitive[i] != CDL_NONE; i++)
    taken |= bvh_take_moving(ray, bvh_lane_at(p, 0u, i, f), bvh_lane_at(p, 1u, i, f),
                             bvh_lane_at(p, 2u, i, f), w->primitive[i], query);
  return taken;
}
#endif

CDL_INLINE int bvh_leaf(BvhRay ray, CDL_GLOBAL const BvhTriangle *triangles, uint leaf,
                        BvhQuery *query) {
  uint first = leaf & CDL_BVH_INDEX;
  uint last = first + ((leaf & ~CDL_BVH_LEAF) >> CDL_BVH_LENGTH_SHIFT);
  int taken = 0;
  for (uint i = first; i <= last; i++) {
#ifdef CDL_MOTION
    if (triangles[i].v[0] != triangles[i].v[0]) {
      taken |= bvh_moving(ray, triangles, triangles + i, query);
      continue;
    }
#endif
    taken |= bvh_group(ray, triangles + i, query);
  }
  return taken;
}

CDL_INLINE BvhRay bvh_ray_in_world(CDL_GLOBAL const BvhNode *root, vec3 o, vec3 d) {
  CDL_GLOBAL const float *all = root->all;
  return bvh_ray(o, d, v3(all[0], all[1], all[2]), v3(all[3], all[4], all[5]), BVH_PAD_INSTANCES);
}

/* Which children the ray enters before `limit`, and where. */
CDL_INLINE uint bvh_boxes(BvhRay r, CDL_GLOBAL const BvhNode *node, float limit, float enters[8]) {
  CDL_GLOBAL const float *planes = node->bounds;
  LANES_PREFETCH(node->child);
  float8 ix = lanes8_all(r.inverse_x), iy = lanes8_all(r.inverse_y), iz = lanes8_all(r.inverse_z);
  float8 near_x = lanes8_fma(lanes8_load(planes + 8u * r.sign_x), ix, lanes8_all(r.near_x));
  float8 near_y = lanes8_fma(lanes8_load(planes + 8u * r.sign_y), iy, lanes8_all(r.near_y));
  float8 near_z = lanes8_fma(lanes8_load(planes + 8u * r.sign_z), iz, lanes8_all(r.near_z));
  float8 far_x = lanes8_fma(lanes8_load(planes + (24u - 8u * r.sign_x)), ix, lanes8_all(r.far_x));
  float8 far_y = lanes8_fma(lanes8_load(planes + (40u - 8u * r.sign_y)), iy, lanes8_all(r.far_y));
  float8 far_z = lanes8_fma(lanes8_load(planes + (56u - 8u * r.sign_z)), iz, lanes8_all(r.far_z));
  float8 enter = lanes8_max(lanes8_max(near_x, lanes8_all(0.0f)), lanes8_max(near_y, near_z));
  float8 leave = lanes8_min(lanes8_min(far_x, lanes8_all(limit)), lanes8_min(far_y, far_z));
  lanes8_store(enter, enters);
  return lanes8_mask_ordered(enter, leave);
}

/* Asks for a child's node before it is needed. */
CDL_INLINE void bvh_prefetch(CDL_GLOBAL const BvhNode *nodes, uint child) {
  LANES_PREFETCH(nodes[child & CDL_BVH_INDEX].bounds);
  LANES_PREFETCH(nodes[child & CDL_BVH_INDEX].bounds + 32);
}

/* References that wait, and where the ray enters them. */
typedef struct BvhStack {
  uint child[CDL_BVH8_STACK];
  float enter[CDL_BVH8_STACK];
} BvhStack;

/* Puts the children of `mask` (two or more) on the stack, the nearest on top; returns the new top.
 */
CDL_INLINE uint bvh_push(BvhStack *stack, uint top, CDL_GLOBAL const BvhNode *nodes,
                         CDL_GLOBAL const uint *children, uint mask, const float enters[8]) {
  uint base = top;
  for (; mask != 0u; mask &= mask - 1u) {
    uint i = mask_lowest(mask), at = top++;
    float enter = enters[i];
    bvh_prefetch(nodes, children[i]);
    for (; at > base && stack->enter[at - 1u] < enter; at--) {
      stack->enter[at] = stack->enter[at - 1u];
      stack->child[at] = stack->child[at - 1u];
    }
    stack->enter[at] = enter;
    stack->child[at] = children[i];
  }
  return top;
}

CDL_INLINE uint bvh_enter(BvhRay ray, CDL_GLOBAL const BvhNode *nodes, uint at, float limit,
                          int any, BvhStack *stack, uint *top) {
  CDL_GLOBAL const BvhNode *node = nodes + at;
  float enters[8];
  uint hits = bvh_boxes(ray, node, limit, enters);
  if (hits == 0u) return CDL_NONE;
  uint others = hits & (hits - 1u), a = mask_lowest(hits);
  if (others == 0u) return node->child[a];
  if (any) {
    for (; others != 0u; others &= others - 1u) {
      uint child = node->child[mask_lowest(others)];
      bvh_prefetch(nodes, child);
      stack->child[(*top)++] = child;
    }
    return node->child[a];
  }
  uint b = mask_lowest(others);
  if (others == 1u << b) {
    uint later = enters[b] < enters[a] ? a : b;
    bvh_prefetch(nodes, node->child[a]);
    bvh_prefetch(nodes, node->child[b]);
    stack->child[*top] = node->child[later];
    stack->enter[(*top)++] = enters[later];
    return node->child[a + b - later];
  }
  *top = bvh_push(stack, *top, nodes, node->child, hits, enters) - 1u;
  return stack->child[*top];
}

CDL_INLINE uint bvh_enter_all(BvhRay ray, CDL_GLOBAL const BvhNode *nodes, uint at, float limit,
                              BvhStack *stack, uint top) {
  float enters[8];
  uint hits = bvh_boxes(ray, nodes + at, limit, enters);
  return bvh_push(stack, top, nodes, nodes[at].child, hits, enters);
}

#endif
#endif
