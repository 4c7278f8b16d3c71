/* triangle.h: the one triangle test and the one box test, and why no answer depends on the tree.
 *
 * The triangle test is that of Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection":
 * vertices are sheared so that the ray becomes the z axis, and the signs of three edge functions
 * decide. Each is a difference of separately rounded products, a b - c d, whose sign is right
 * unless the products round to the same number; then all three are computed again with the
 * products' errors. Swapping the ends of an edge negates its function exactly, and zero counts as
 * inside for either sign, so triangles that share an edge leave no gap between them.
 *
 * The box test takes planes by the ray's signs: t = plane/d - o/d in one fma, with o moved outward
 * by `pad` at either end (Ize 2013 pads t; we pad o, because the shear moves vertices by up to 5 u
 * E sideways, u = 2^-24 and E the distance of the farthest vertex, even where t is small). Rounding
 * in the slabs adds at most u |o| + 3 u E, so BVH_PAD (|o| + E) makes every triangle that passes
 * the triangle test pass the test of any box around it.
 *
 * Independence of the tree then holds by construction, not by an error bound. fma is monotone: of
 * two nested boxes the outer one enters no later and leaves no earlier, in floating point. A
 * triangle counts only if the ray passes the triangle's own box, its t is raised to where that box
 * is entered, and nodes are left out only where they are entered beyond the best t. So no node
 * around a triangle that counts is ever left out, and hits are totally ordered: see hit_before().
 *
 * No infinity or NaN arises: direction components are kept above 2^-40 of the largest, which moves
 * a ray by far less than the pad, and a ray that is still not finite is sorted out before the
 * traversal by bvh_ray_is_usable(). Coordinates should lie between 1e-10 and 1e12 in magnitude, or
 * be 0. */
#ifndef CDL_BVH_TRIANGLE_H
#define CDL_BVH_TRIANGLE_H

#include "bvh/hit.h"
#include "lib/motion.h"

#define BVH_PAD 9.5367431640625e-7f          /* 16 u: one mesh, seen in its own space */
#define BVH_PAD_INSTANCES 3.814697265625e-6f /* 64 u: rays are transformed below */

/* A ray made ready for boxes and triangles of one space. */
typedef struct BvhRay {
  float inverse_x, inverse_y, inverse_z; /* 1/d */
  float near_x, near_y, near_z;          /* -o/d, o padded outward */
  float far_x, far_y, far_z;
  uint sign_x, sign_y, sign_z;   /* where in min x y z, max x y z the near planes are */
  uint axis_x, axis_y, axis_z;   /* d is longest in axis_z */
  float shear_x, shear_y, scale; /* d.x/d.z, d.y/d.z, 1/d.z after renaming axes */
  float origin_x, origin_y, origin_z;
} BvhRay;

CDL_INLINE float bvh_min(float a, float b) { return a < b ? a : b; }

CDL_INLINE float bvh_max(float a, float b) { return a > b ? a : b; }

CDL_INLINE float bvh_component(vec3 a, uint axis) {
  return axis == 0u ? a.x : axis == 1u ? a.y : a.z;
}

/* The distance by which boxes grow for a ray from o: covers |o| and the way to the farthest point.
 */
CDL_INLINE float bvh_ray_pad(vec3 o, vec3 low, vec3 high, float units) {
  float x = bvh_max(fabs(low.x - o.x), fabs(high.x - o.x));
  float y = bvh_max(fabs(low.y - o.y), fabs(high.y - o.y));
  float z = bvh_max(fabs(low.z - o.z), fabs(high.z - o.z));
  float away = bvh_max(bvh_max(fabs(o.x), fabs(o.y)), fabs(o.z));
  return units * (bvh_max(bvh_max(x, y), z) + away);
}

CDL_INLINE float bvh_away_from_zero(float a, float least) {
  return fabs(a) >= least ? a : (a < 0.0f ? -least : least);
}

/* A ray among things within low … high; `units` is BVH_PAD or BVH_PAD_INSTANCES. */
CDL_INLINE BvhRay bvh_ray(vec3 o, vec3 d, vec3 low, vec3 high, float units) {
  BvhRay r;
  float ax = fabs(d.x), ay = fabs(d.y), az = fabs(d.z);
  float least = bvh_max(bvh_max(ax, ay), az) * 9.094947017729282e-13f;
  float pad = bvh_ray_pad(o, low, high, units);
  vec3 e = v3(bvh_away_from_zero(d.x, least), bvh_away_from_zero(d.y, least),
              bvh_away_from_zero(d.z, least));
  r.inverse_x = 1.0f / e.x;
  r.inverse_y = 1.0f / e.y;
  r.inverse_z = 1.0f / e.z;
  r.near_x = -(o.x + (e.x < 0.0f ? -pad : pad)) * r.inverse_x;
  r.near_y = -(o.y + (e.y < 0.0f ? -pad : pad)) * r.inverse_y;
  r.near_z = -(o.z + (e.z < 0.0f ? -pad : pad)) * r.inverse_z;
  r.far_x = -(o.x - (e.x < 0.0f ? -pad : pad)) * r.inverse_x;
  r.far_y = -(o.y - (e.y < 0.0f ? -pad : pad)) * r.inverse_y;
  r.far_z = -(o.z - (e.z < 0.0f ? -pad : pad)) * r.inverse_z;
  r.sign_x = e.x < 0.0f ? 3u : 0u;
  r.sign_y = e.y < 0.0f ? 4u : 1u;
  r.sign_z = e.z < 0.0f ? 5u : 2u;
  r.axis_z = az >= ax && az >= ay ? 2u : ay >= ax ? 1u : 0u;
  r.axis_x = r.axis_z == 2u ? 0u : r.axis_z + 1u;
  r.axis_y = r.axis_x == 2u ? 0u : r.axis_x + 1u;
  r.scale = r.axis_z == 0u ? r.inverse_x : r.axis_z == 1u ? r.inverse_y : r.inverse_z;
  r.shear_x = bvh_component(d, r.axis_x) * r.scale;
  r.shear_y = bvh_component(d, r.axis_y) * r.scale;
  r.origin_x = bvh_component(o, r.axis_x);
  r.origin_y = bvh_component(o, r.axis_y);
  r.origin_z = bvh_component(o, r.axis_z);
  return r;
}

/* False for rays with an infinite or not-a-number component or without direction, and in an empty
 * box. */
CDL_INLINE int bvh_ray_is_usable(BvhRay r) {
  return fabs(r.near_x) + fabs(r.near_y) + fabs(r.near_z) < CDL_INFINITY && r.scale != 0.0f;
}

/* Where the ray, cut to 0 … limit, enters a box given by its near and far planes; infinity:
 * nowhere. */
CDL_INLINE float bvh_slabs(BvhRay r, vec3 closer, vec3 farther, float limit) {
  float enter =
      bvh_max(bvh_max(fma(closer.x, r.inverse_x, r.near_x), 0.0f),
              bvh_max(fma(closer.y, r.inverse_y, r.near_y), fma(closer.z, r.inverse_z, r.near_z)));
  float leave =
      bvh_min(bvh_min(fma(farther.x, r.inverse_x, r.far_x), limit),
              bvh_min(fma(farther.y, r.inverse_y, r.far_y), fma(farther.z, r.inverse_z, r.far_z)));
  return enter <= leave ? enter : CDL_INFINITY;
}

/* a b - c d with each product rounded; its sign is right unless it is zero. */
CDL_INLINE float edge_function(float a, float b, float c, float d) {
  float p = a * b;
  float q = c * d;
  return p - q;
}

/* The same with the products' rounding errors; never of the wrong sign. */
CDL_INLINE float edge_function_compensated(float a, float b, float c, float d) {
  float p = a * b;
  float q = c * d;
  float e = fma(a, b, -p);
  float f = fma(c, d, -q);
  return (p - q) + (e - f);
}

/* Corners in the ray's space: x, y sheared, z along the ray and not yet scaled. */
typedef struct Sheared {
  float ax, ay, az, bx, by, bz, cx, cy, cz;
} Sheared;

CDL_INLINE Sheared triangle_shear(BvhRay r, CDL_GLOBAL const float *v0, CDL_GLOBAL const float *v1,
                                  CDL_GLOBAL const float *v2) {
  Sheared s;
  s.az = v0[r.axis_z] - r.origin_z;
  s.bz = v1[r.axis_z] - r.origin_z;
  s.cz = v2[r.axis_z] - r.origin_z;
  s.ax = fma(-r.shear_x, s.az, v0[r.axis_x] - r.origin_x);
  s.ay = fma(-r.shear_y, s.az, v0[r.axis_y] - r.origin_y);
  s.bx = fma(-r.shear_x, s.bz, v1[r.axis_x] - r.origin_x);
  s.by = fma(-r.shear_y, s.bz, v1[r.axis_y] - r.origin_y);
  s.cx = fma(-r.shear_x, s.cz, v2[r.axis_x] - r.origin_x);
  s.cy = fma(-r.shear_y, s.cz, v2[r.axis_y] - r.origin_y);
  return s;
}

/* The same for corners that were worked out. */
CDL_INLINE Sheared corners_shear(BvhRay r, vec3 a, vec3 b, vec3 c) {
  Sheared s;
  s.az = bvh_component(a, r.axis_z) - r.origin_z;
  s.bz = bvh_component(b, r.axis_z) - r.origin_z;
  s.cz = bvh_component(c, r.axis_z) - r.origin_z;
  s.ax = fma(-r.shear_x, s.az, bvh_component(a, r.axis_x) - r.origin_x);
  s.ay = fma(-r.shear_y, s.az, bvh_component(a, r.axis_y) - r.origin_y);
  s.bx = fma(-r.shear_x, s.bz, bvh_component(b, r.axis_x) - r.origin_x);
  s.by = fma(-r.shear_y, s.bz, bvh_component(b, r.axis_y) - r.origin_y);
  s.cx = fma(-r.shear_x, s.cz, bvh_component(c, r.axis_x) - r.origin_x);
  s.cy = fma(-r.shear_y, s.cz, bvh_component(c, r.axis_y) - r.origin_y);
  return s;
}

/* Whether the line of the ray meets the triangle, where (t) and at which u, v. Both orientations.
 */
CDL_INLINE int triangle_test(BvhRay r, Sheared s, float *t, float *u, float *v) {
  float e0 = edge_function(s.cx, s.by, s.cy, s.bx);
  float e1 = edge_function(s.ax, s.cy, s.ay, s.cx);
  float e2 = edge_function(s.bx, s.ay, s.by, s.ax);
  if ((e0 < 0.0f || e1 < 0.0f || e2 < 0.0f) && (e0 > 0.0f || e1 > 0.0f || e2 > 0.0f)) return 0;
  if (e0 == 0.0f || e1 == 0.0f || e2 == 0.0f) {
    e0 = edge_function_compensated(s.cx, s.by, s.cy, s.bx);
    e1 = edge_function_compensated(s.ax, s.cy, s.ay, s.cx);
    e2 = edge_function_compensated(s.bx, s.ay, s.by, s.ax);
    if ((e0 < 0.0f || e1 < 0.0f || e2 < 0.0f) && (e0 > 0.0f || e1 > 0.0f || e2 > 0.0f)) return 0;
  }
  float determinant = (e0 + e1) + e2;
  if (determinant == 0.0f) return 0;
  *t = fma(e0, s.az, fma(e1, s.bz, e2 * s.cz)) / determinant * r.scale;
  *u = e1 / determinant;
  *v = e2 / determinant;
  return 1;
}

/* What a hit must satisfy, and the best so far. */
typedef struct BvhQuery {
  Hit best;             /* at first: hit_none(tmax) */
  Hit after;            /* hits up to and with this one do not count; at first hit_none(0) */
  float instance_enter; /* where the ray enters the instance's box */
  uint instance;
#ifdef CDL_MOTION
  MotionTime time;
#endif
} BvhQuery;

/* Takes a hit that passed the triangle test if it is the best so far; 1 if so. */
CDL_INLINE int bvh_take(BvhQuery *query, float t, float u, float v, uint primitive, float enter) {
  Hit hit;
  hit.t = bvh_max(t, bvh_max(enter, query->instance_enter));
  hit.u = u;
  hit.v = v;
  hit.primitive = primitive;
  hit.instance = query->instance;
  if (!(t > 0.0f && hit.t < CDL_INFINITY)) return 0;
  if (!hit_before(hit, query->best) || !hit_before(query->after, hit)) return 0;
  query->best = hit;
  return 1;
}

/* Where the ray enters the box of one triangle, by the same arithmetic as for nodes. */
CDL_INLINE float triangle_enter(BvhRay r, vec3 a, vec3 b, vec3 c) {
  vec3 low = v3(bvh_min(bvh_min(a.x, b.x), c.x), bvh_min(bvh_min(a.y, b.y), c.y),
                bvh_min(bvh_min(a.z, b.z), c.z));
  vec3 high = v3(bvh_max(bvh_max(a.x, b.x), c.x), bvh_max(bvh_max(a.y, b.y), c.y),
                 bvh_max(bvh_max(a.z, b.z), c.z));
  vec3 closer = v3(r.sign_x == 0u ? low.x : high.x, r.sign_y == 1u ? low.y : high.y,
                   r.sign_z == 2u ? low.z : high.z);
  vec3 farther = v3(r.sign_x == 0u ? high.x : low.x, r.sign_y == 1u ? high.y : low.y,
                    r.sign_z == 2u ? high.z : low.z);
  return bvh_slabs(r, closer, farther, CDL_INFINITY);
}

#ifdef CDL_MOTION
/* Tests a triangle that moves, given where it is now; 1 if it became the best hit. */
CDL_INLINE int bvh_take_moving(BvhRay ray, vec3 a, vec3 b, vec3 c, uint primitive,
                               BvhQuery *query) {
  float t, u, v;
  if (!triangle_test(ray, corners_shear(ray, a, b, c), &t, &u, &v)) return 0;
  return bvh_take(query, t, u, v, primitive, triangle_enter(ray, a, b, c));
}
#endif

#endif
