/* bvh_shapes.h: meshes for the tests of rays, and random numbers. */
#ifndef CANDELA_TESTS_BVH_SHAPES_H
#define CANDELA_TESTS_BVH_SHAPES_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "lib/vec.h"

typedef struct Random {
  uint32_t state;
} Random;

/* A 32-bit hash of a counter. */
static inline uint32_t random_next(Random *random) {
  uint32_t x = random->state += 0x9e3779b9u;
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

/* In [-1,1). */
static inline float random_signed(Random *random) {
  return (float)(random_next(random) >> 8) * 0x1p-23f - 1.0f;
}

typedef struct Shape {
  float *positions;
  uint32_t *indices;
  uint32_t vertices, triangles;
} Shape;

static inline Shape shape_new(uint32_t vertices, uint32_t triangles) {
  Shape shape = {malloc(3 * (size_t)vertices * sizeof(float)),
                 malloc(3 * (size_t)triangles * sizeof(uint32_t)), 0, 0};
  if (!shape.positions || !shape.indices) abort();
  return shape;
}

static inline void shape_free(Shape *shape) {
  free(shape->positions);
  free(shape->indices);
}

static inline uint32_t shape_vertex(Shape *shape, vec3 p) {
  float *at = shape->positions + 3 * (size_t)shape->vertices;
  at[0] = p.x;
  at[1] = p.y;
  at[2] = p.z;
  return shape->vertices++;
}

static inline void shape_triangle(Shape *shape, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *at = shape->indices + 3 * (size_t)shape->triangles++;
  at[0] = a;
  at[1] = b;
  at[2] = c;
}

/* Triangles of about `size`, anywhere in a cube of side 2. */
static inline Shape shape_soup(uint32_t triangles, float size, uint32_t seed) {
  Random random = {seed};
  Shape shape = shape_new(3 * triangles, triangles);
  for (uint32_t i = 0; i < triangles; i++) {
    vec3 at = v3_all(0.0f);
    for (uint32_t k = 0; k < 4; k++) {
      float x = random_signed(&random), y = random_signed(&random), z = random_signed(&random);
      if (k == 0)
        at = v3(x, y, z);
      else
        shape_vertex(&shape, v3(at.x + size * x, at.y + size * y, at.z + size * z));
    }
    shape_triangle(&shape, 3 * i, 3 * i + 1, 3 * i + 2);
  }
  return shape;
}

/* Needles: long, and thinner than any box around them. */
static inline Shape shape_slivers(uint32_t triangles, uint32_t seed) {
  Shape shape = shape_soup(triangles, 1.0f, seed);
  for (uint32_t i = 0; i < triangles; i++) {
    float *p = shape.positions + 9 * (size_t)i;
    for (int k = 0; k < 3; k++) p[6 + k] = p[k] + 1e-3f * (p[6 + k] - p[k]);
  }
  return shape;
}

/* A grid of n x n squares spanned over a cube's or other patch's corners; corners shared inside. */
static inline void shape_patch(Shape *shape, uint32_t n, vec3 corner, vec3 u, vec3 v) {
  uint32_t first = shape->vertices;
  for (uint32_t j = 0; j <= n; j++)
    for (uint32_t i = 0; i <= n; i++) {
      float s = (float)i / (float)n, t = (float)j / (float)n;
      shape_vertex(shape, v3(corner.x + s * u.x + t * v.x, corner.y + s * u.y + t * v.y,
                             corner.z + s * u.z + t * v.z));
    }
  for (uint32_t j = 0; j < n; j++)
    for (uint32_t i = 0; i < n; i++) {
      uint32_t a = first + j * (n + 1) + i, b = a + n + 1;
      shape_triangle(shape, a, a + 1, b);
      shape_triangle(shape, a + 1, b + 1, b);
    }
}

/* A closed box of 12 n^2 triangles with half sides `half`. Grid lines of adjacent faces are
 * computed in the same steps, so they meet exactly. */
static inline Shape shape_box(uint32_t n, vec3 center, vec3 half) {
  Shape shape = shape_new(6 * (n + 1) * (n + 1), 12 * n * n);
  vec3 low = v3_sub(center, half), size = v3_add(half, half);
  vec3 x = v3(size.x, 0.0f, 0.0f), y = v3(0.0f, size.y, 0.0f), z = v3(0.0f, 0.0f, size.z);
  shape_patch(&shape, n, low, x, y);
  shape_patch(&shape, n, low, y, z);
  shape_patch(&shape, n, low, z, x);
  shape_patch(&shape, n, v3_add(low, z), x, y);
  shape_patch(&shape, n, v3_add(low, x), y, z);
  shape_patch(&shape, n, v3_add(low, y), z, x);
  return shape;
}

/* One face of the icosahedron, split `levels` times; the same edge gives the same points from
 * either side, because a midpoint does not depend on the order of its ends. */
static inline void shape_split(Shape *shape, int levels, vec3 a, vec3 b, vec3 c, vec3 center,
                               float radius) {
  if (levels > 0) {
    vec3 ab = v3_normalize(v3_add(a, b)), bc = v3_normalize(v3_add(b, c)),
         ca = v3_normalize(v3_add(c, a));
    shape_split(shape, levels - 1, a, ab, ca, center, radius);
    shape_split(shape, levels - 1, ab, b, bc, center, radius);
    shape_split(shape, levels - 1, ca, bc, c, center, radius);
    shape_split(shape, levels - 1, ab, bc, ca, center, radius);
    return;
  }
  uint32_t first = shape->vertices;
  shape_vertex(shape, v3_add(center, v3_scale(a, radius)));
  shape_vertex(shape, v3_add(center, v3_scale(b, radius)));
  shape_vertex(shape, v3_add(center, v3_scale(c, radius)));
  shape_triangle(shape, first, first + 1, first + 2);
}

/* A closed sphere of 20 * 4^levels triangles. */
static inline Shape shape_sphere(int levels, vec3 center, float radius) {
  static const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const float g = 1.618034f;
  const vec3 corners[12] = {v3(-1, g, 0), v3(1, g, 0), v3(-1, -g, 0), v3(1, -g, 0),
                            v3(0, -1, g), v3(0, 1, g), v3(0, -1, -g), v3(0, 1, -g),
                            v3(g, 0, -1), v3(g, 0, 1), v3(-g, 0, -1), v3(-g, 0, 1)};
  uint32_t triangles = 20u << (2 * levels);
  Shape shape = shape_new(3 * triangles, triangles);
  for (int i = 0; i < 20; i++)
    shape_split(&shape, levels, v3_normalize(corners[faces[i][0]]),
                v3_normalize(corners[faces[i][1]]), v3_normalize(corners[faces[i][2]]), center,
                radius);
  return shape;
}

/* A point on an edge of some triangle, or one of its vertices, as well as floats can say. */
static inline vec3 shape_edge_point(const Shape *shape, Random *random) {
  const uint32_t *at = shape->indices + 3 * (size_t)(random_next(random) % shape->triangles);
  uint32_t k = random_next(random) % 3, kind = random_next(random) % 4;
  const float *a = shape->positions + 3 * (size_t)at[k];
  const float *b = shape->positions + 3 * (size_t)at[(k + 1) % 3];
  float s = kind == 0 ? 0.0f : kind == 1 ? 0.5f : 0.5f * random_signed(random) + 0.5f;
  return v3(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]));
}

/* A rotation, scaled unevenly and possibly mirrored, moved by up to three units. */
static inline void random_matrix(Random *random, float m[12]) {
  float q[4], n = 0.0f, scale[3];
  for (int i = 0; i < 4; i++) q[i] = random_signed(random);
  for (int i = 0; i < 4; i++) n += q[i] * q[i];
  float w = q[0], x = q[1], y = q[2], z = q[3], s = 2.0f / n;
  float r[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
  for (int i = 0; i < 3; i++) {
    scale[i] = 0.3f + fabsf(random_signed(random));
    if (random_signed(random) < 0.0f) scale[i] = -scale[i];
  }
  for (int i = 0; i < 9; i++) m[4 * (i / 3) + i % 3] = r[i] * scale[i % 3];
  for (int i = 0; i < 3; i++) m[4 * i + 3] = 3.0f * random_signed(random);
}

/* Closed surfaces, and a cube of half side `inside` around `center` that lies within. */
typedef struct ClosedShape {
  Shape shape;
  vec3 center;
  float inside;
} ClosedShape;

enum { CLOSED_SHAPES = 8 };

static inline ClosedShape shape_closed(int which) {
  vec3 far_away = v3(1e5f, -2e5f, 3e4f), zero = v3_all(0.0f);
  switch (which) {
  case 0:
    return (ClosedShape){shape_sphere(4, zero, 1.0f), zero, 0.5f};
  case 1:
    return (ClosedShape){shape_box(16, zero, v3_all(1.0f)), zero, 0.9f};
  case 2:
    return (ClosedShape){shape_box(1, zero, v3_all(1.0f)), zero, 0.9f};
  case 3: /* triangles 2000 times longer than wide */
    return (ClosedShape){shape_box(20, zero, v3(1000.0f, 0.01f, 1.0f)), zero, 0.009f};
  case 4:
    return (ClosedShape){shape_sphere(4, far_away, 100.0f), far_away, 40.0f};
  case 5:
    return (ClosedShape){shape_box(8, far_away, v3(64.0f, 32.0f, 128.0f)), far_away, 30.0f};
  case 6:
    return (ClosedShape){shape_sphere(3, zero, 1e-4f), zero, 4e-5f};
  default:
    return (ClosedShape){shape_sphere(6, v3(1.0f, 2.0f, 3.0f), 1e4f), v3(1, 2, 3), 5e3f};
  }
}

#endif
