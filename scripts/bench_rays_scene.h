/* bench_rays_scene.h: the triangles of bench_rays.c. */
#ifndef CANDELA_BENCH_RAYS_SCENE_H
#define CANDELA_BENCH_RAYS_SCENE_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Mesh {
  float *positions;
  uint32_t *indices;
  uint32_t vertices, triangles;
} Mesh;

static void die(const char *what) {
  fprintf(stderr, "bench_rays: %s\n", what);
  exit(1);
}

static void *need(size_t bytes) {
  void *memory = malloc(bytes);
  if (!memory) die("not enough memory");
  return memory;
}

/* A number in [0,1) from a counter (a hash by Wellons's search). */
static float random_of(uint32_t x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return (float)((x ^ x >> 16) >> 8) * 0x1p-24f;
}

/* --- Scene */

/* A patch of n x n squares; `patch` -1 is the ground, else a sphere. */
static void patch_point(int patch, float s, float t, float p[3]) {
  if (patch < 0) {
    p[0] = 24.0f * s - 12.0f;
    p[2] = 24.0f * t - 12.0f;
    p[1] = 0.25f * sinf(2.1f * p[0]) * cosf(1.7f * p[2]) + 0.02f * sinf(29.0f * p[0] + p[2]);
    return;
  }
  float theta = 3.14159265f * t, phi = 6.2831853f * s;
  float r = 0.85f + 0.05f * sinf(9.0f * phi) * sinf(7.0f * theta) +
            0.01f * sinf(61.0f * phi + 3.0f * (float)patch) * sinf(53.0f * theta);
  p[0] = 2.2f * (float)(patch % 5 - 2) + r * sinf(theta) * cosf(phi);
  p[1] = 1.0f + r * cosf(theta);
  p[2] = 2.2f * (float)(patch / 5 - 2) + r * sinf(theta) * sinf(phi);
}

static void add_patch(Mesh *mesh, int patch, uint32_t n) {
  uint32_t first = mesh->vertices;
  for (uint32_t j = 0; j <= n; j++)
    for (uint32_t i = 0; i <= n; i++)
      patch_point(patch, (float)i / (float)n, (float)j / (float)n,
                  mesh->positions + 3 * (size_t)mesh->vertices++);
  for (uint32_t j = 0; j < n; j++)
    for (uint32_t i = 0; i < n; i++) {
      uint32_t a = first + j * (n + 1) + i, b = a + n + 1;
      uint32_t corners[6] = {a, b, a + 1, a + 1, b, b + 1};
      memcpy(mesh->indices + 3 * (size_t)mesh->triangles, corners, sizeof corners);
      mesh->triangles += 2;
    }
}

static Mesh make_mesh(float detail) {
  enum { PATCHES = 26 };
  uint32_t n = (uint32_t)(176.0f * sqrtf(detail)) + 1;
  size_t vertices = (size_t)PATCHES * (n + 1) * (n + 1), triangles = (size_t)PATCHES * 2 * n * n;
  Mesh mesh = {need(3 * vertices * sizeof(float) + 16), need(3 * triangles * 4), 0, 0};
  for (int patch = -1; patch < PATCHES - 1; patch++) add_patch(&mesh, patch, n);
  return mesh;
}

#endif
