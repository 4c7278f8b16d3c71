/* bvh_exact.h: ray queries in double over all triangles, independent of the kernels. */
#ifndef CANDELA_TESTS_BVH_EXACT_H
#define CANDELA_TESTS_BVH_EXACT_H

#include "abi/bvh.h"
#include "bvh_shapes.h"

/* What Moeller and Trumbore 1997 say in double; `margin` is the least distance, in barycentric
 * coordinates, at which any triangle's edge passes the ray, and `gap` that between the two nearest
 * hits: only where they are not tiny is the answer beyond doubt. */
typedef struct Exact {
  double t, margin, gap;
  uint32_t primitive, instance;
} Exact;

static inline int exact_triangle(const double v[9], const double o[3], const double d[3], double *t,
                                 double *margin) {
  double e1[3], e2[3], p[3], s[3], q[3];
  for (int i = 0; i < 3; i++) {
    e1[i] = v[3 + i] - v[i];
    e2[i] = v[6 + i] - v[i];
    s[i] = o[i] - v[i];
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    p[i] = d[j] * e2[k] - d[k] * e2[j];
    q[i] = s[j] * e1[k] - s[k] * e1[j];
  }
  double det = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
  if (det == 0.0) return 0;
  double a = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det;
  double b = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
  double inside = fmin(fmin(a, b), 1.0 - a - b);
  *t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
  if (*t > 0.0) *margin = fmin(*margin, fabs(inside));
  return inside >= 0.0 && *t > 0.0;
}

/* Adds the triangles of a placed shape; start with t and gap infinite. */
static inline void exact_shape(const Shape *shape, const float m[12], uint32_t instance, vec3 o,
                               vec3 d, Exact *exact) {
  const double origin[3] = {o.x, o.y, o.z}, direction[3] = {d.x, d.y, d.z};
  for (uint32_t i = 0; i < shape->triangles; i++) {
    double v[9], t;
    for (int k = 0; k < 9; k++) {
      const float *p = shape->positions + 3 * (size_t)shape->indices[3 * i + (uint32_t)k / 3];
      const float *row = m + 4 * (k % 3);
      v[k] = (double)row[0] * p[0] + (double)row[1] * p[1] + (double)row[2] * p[2] + row[3];
    }
    if (!exact_triangle(v, origin, direction, &t, &exact->margin)) continue;
    exact->gap = fmin(exact->gap, fabs(t - exact->t));
    if (t < exact->t) {
      exact->t = t;
      exact->primitive = i;
      exact->instance = instance;
    }
  }
}

static inline Exact exact_none(void) {
  return (Exact){INFINITY, INFINITY, INFINITY, CDL_NONE, CDL_NONE};
}

static inline int is_beyond_doubt(const Exact *exact) {
  return exact->margin > 1e-4 && (isinf(exact->t) || exact->gap > 1e-4 * exact->t);
}

#endif
