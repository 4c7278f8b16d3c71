/* grid.h: a wavy sheet with every attribute, and what compares it with what was loaded. */
#ifndef CANDELA_TESTS_GRID_H
#define CANDELA_TESTS_GRID_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define SIDE 40
#define POINTS (SIDE * SIDE)
#define FACES (2 * (SIDE - 1) * (SIDE - 1))

typedef struct Grid {
  float positions[POINTS][3], normals[POINTS][3], tangents[POINTS][4], uv[POINTS][2];
  uint8_t colors[POINTS][4];
  uint32_t indices[FACES][3];
} Grid;

/* z = sin(3x) cos(2y) / 4 over the unit square, with its analytic normal and tangent. */
static inline void grid_point(Grid *grid, int i, int k) {
  int n = i * SIDE + k;
  double x = k / (double)(SIDE - 1), y = i / (double)(SIDE - 1);
  double dx = 0.75 * cos(3 * x) * cos(2 * y), dy = -0.5 * sin(3 * x) * sin(2 * y);
  double length = sqrt(dx * dx + dy * dy + 1), along = sqrt(dx * dx + 1);
  const float position[3] = {(float)x, (float)y, (float)(0.25 * sin(3 * x) * cos(2 * y))};
  const float normal[3] = {(float)(-dx / length), (float)(-dy / length), (float)(1 / length)};
  const float tangent[4] = {(float)(1 / along), 0, (float)(dx / along), n % 3 ? 1.0f : -1.0f};
  const uint8_t color[4] = {(uint8_t)(6 * k), (uint8_t)(6 * i), (uint8_t)(n * 7), 255};
  memcpy(grid->positions[n], position, sizeof position);
  memcpy(grid->normals[n], normal, sizeof normal);
  memcpy(grid->tangents[n], tangent, sizeof tangent);
  memcpy(grid->colors[n], color, sizeof color);
  grid->uv[n][0] = (float)(2 * x - 0.5);
  grid->uv[n][1] = (float)(1 - y);
}

static inline void grid_make(Grid *grid) {
  uint32_t t = 0;
  for (int i = 0; i < SIDE; i++)
    for (int k = 0; k < SIDE; k++) grid_point(grid, i, k);
  for (uint32_t i = 0; i + 1 < SIDE; i++)
    for (uint32_t k = 0; k + 1 < SIDE; k++) {
      uint32_t a = i * SIDE + k;
      const uint32_t faces[2][3] = {{a, a + 1, a + SIDE}, {a + 1, a + SIDE + 1, a + SIDE}};
      memcpy(grid->indices[t], faces, sizeof faces);
      t += 2;
    }
}

/* The largest difference of two lists of numbers. */
static inline double grid_difference(const float *a, const float *b, size_t count) {
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs((double)a[i] - b[i]));
  return most;
}

/* Whether two triangles are the same but for the corner that they begin with. */
static inline int same_triangle(const uint32_t *a, const uint32_t *b) {
  for (int k = 0; k < 3; k++)
    if (a[0] == b[k] && a[1] == b[(k + 1) % 3] && a[2] == b[(k + 2) % 3]) return 1;
  return 0;
}

#endif
