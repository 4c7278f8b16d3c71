#include "tests/device/grid_field.h"

#include <math.h>
#include <stdlib.h>

double field_random(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  uint32_t x = *state ^ (*state >> 15);
  x *= 0x2c1b3c6du;
  return (x ^ (x >> 13)) / 4294967296.0;
}

static float kind_value(FieldKind kind, const uint32_t size[3], const uint32_t at[3],
                        uint32_t *state) {
  double r = field_random(state), chance = field_random(state);
  int middle = 1;
  for (int k = 0; k < 3; k++) middle &= at[k] >= size[k] / 4 && at[k] < size[k] - size[k] / 4;
  switch (kind) {
  case FIELD_CONSTANT:
    return 1;
  case FIELD_RAMP:
    return size[0] > 1 ? (float)at[0] / (float)(size[0] - 1) : 1;
  case FIELD_STEP:
    return middle ? 1 : 0;
  case FIELD_CHECKER:
    return (at[0] / 8 + at[1] / 8 + at[2] / 8) % 2 ? (float)r : 0;
  case FIELD_SPARSE:
    return chance < 0.025 ? (float)r : 0;
  case FIELD_RARE:
    return chance < 2.5e-5 ? (float)r : 0;
  case FIELD_NOISE:
    return (float)r;
  default:
    return 0;
  }
}

Field field_make(FieldKind kind, const uint32_t size[3], uint32_t channels, float scale,
                 uint32_t seed) {
  Field field = {{size[0], size[1], size[2]}, channels, NULL};
  size_t count = (size_t)size[0] * size[1] * size[2] * channels, i = 0;
  field.values = malloc(count * sizeof *field.values);
  for (uint32_t c = 0; c < channels; c++)
    for (uint32_t z = 0; z < size[2]; z++)
      for (uint32_t y = 0; y < size[1]; y++)
        for (uint32_t x = 0; x < size[0]; x++)
          field.values[i++] = scale * kind_value(kind, size, (uint32_t[]){x, y, z}, &seed);
  return field;
}

static int keep(int i, uint32_t size) { return i < 0 ? 0 : i >= (int)size ? (int)size - 1 : i; }

float field_voxel(const Field *field, uint32_t channel, int x, int y, int z) {
  const uint32_t *size = field->size;
  size_t at = ((size_t)channel * size[2] + (size_t)keep(z, size[2])) * size[1];
  return field->values[(at + (size_t)keep(y, size[1])) * size[0] + (size_t)keep(x, size[0])];
}

double field_value(const Field *field, uint32_t channel, const double r[3]) {
  int low[3];
  double part[3], sum = 0;
  for (int k = 0; k < 3; k++) {
    double c = fmin(fmax(r[k], 0), field->size[k] - 1.0);
    low[k] = (int)floor(c);
    part[k] = c - low[k];
  }
  for (int corner = 0; corner < 8; corner++) {
    int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    double weight =
        (x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]);
    if (weight > 0) sum += weight * field_voxel(field, channel, low[0] + x, low[1] + y, low[2] + z);
  }
  return sum;
}

void field_place(const cdl_Medium *medium, const FieldRay *ray, double origin[3],
                 double direction[3]) {
  for (int r = 0; r < 3; r++) {
    const float *m = medium->to_grid + 4 * r;
    origin[r] = m[3], direction[r] = 0;
    for (int k = 0; k < 3; k++) {
      origin[r] += (double)m[k] * ray->origin[k];
      direction[r] += (double)m[k] * ray->direction[k];
    }
  }
}

void field_clip(const uint32_t size[3], const double origin[3], const double direction[3],
                double margin, double *first, double *last) {
  for (int k = 0; k < 3; k++) {
    double low = -0.5 - margin - origin[k], high = size[k] - 0.5 + margin - origin[k];
    if (direction[k] == 0) {
      if (low > 0 || high < 0) *last = *first;
      continue;
    }
    double a = low / direction[k], b = high / direction[k];
    *first = fmax(*first, fmin(a, b));
    *last = fmin(*last, fmax(a, b));
  }
}

/* ---- along a ray ---- */

typedef struct Walk {
  const cdl_Medium *medium;
  const Field *density, *heat, *color;
  FieldColor radiance;
  double origin[3], direction[3];
  double passed; /* integral of the density so far */
} Walk;

static double density_at(const Walk *w, double t, double r[3]) {
  for (int k = 0; k < 3; k++) r[k] = w->origin[k] + t * w->direction[k];
  return field_value(w->density, 0, r);
}

/* Between planes of centres the density is a cubic of t, for which two points of Gauss are exact.
 */
static double density_integral(const Walk *w, double a, double b) {
  double middle = 0.5 * (a + b), half = 0.5 * (b - a), r[3];
  return half *
         (density_at(w, middle - half / sqrt(3), r) + density_at(w, middle + half / sqrt(3), r));
}

static double extinction(const cdl_Medium *m, int c) {
  return (double)m->absorption[c] + m->scattering[c];
}

/* Adds what happens between a and b, where nothing has a kink. */
static void add_piece(Walk *w, FieldTruth *truth, int cell, double a, double b) {
  static const double nodes[3] = {-0.77459666924148338, 0, 0.77459666924148338};
  static const double weights[3] = {5 / 9., 8 / 9., 5 / 9.};
  for (int i = 0; i < 3; i++) {
    double t = 0.5 * (a + b) + 0.5 * (b - a) * nodes[i], r[3];
    double weight = 0.5 * (b - a) * weights[i], density = density_at(w, t, r);
    double depth = w->passed + density_integral(w, a, t), light[3] = {1, 1, 1};
    if (w->heat) w->radiance(field_value(w->heat, 0, r) * w->medium->temperature_scale, light);
    for (uint32_t c = 0; c < 3; c++) {
      double reached = weight * exp(-extinction(w->medium, (int)c) * depth);
      double tint = w->color ? fmin(field_value(w->color, c, r), 1) : 1;
      truth->scattered[c][cell] += reached * density * w->medium->scattering[c] * tint;
      truth->glow[c] += reached * w->medium->emission[c] * light[c];
    }
  }
  w->passed += density_integral(w, a, b);
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Every t in (a, b) at which the ray meets a plane of centres, between a and b themselves. */
static int find_kinks(const Walk *w, double a, double b, double **kinks) {
  const uint32_t *size = w->density->size;
  int count = 2;
  *kinks = malloc((2 + (size_t)size[0] + size[1] + size[2]) * sizeof **kinks);
  (*kinks)[0] = a, (*kinks)[1] = b;
  for (int k = 0; k < 3; k++)
    for (uint32_t plane = 0; plane < size[k] && w->direction[k] != 0; plane++) {
      double t = (plane - w->origin[k]) / w->direction[k];
      if (t > a && t < b) (*kinks)[count++] = t;
    }
  qsort(*kinks, (size_t)count, sizeof **kinks, by_value);
  return count;
}

static void add_cell(Walk *w, FieldTruth *truth, int cell, double a, double b) {
  double *kinks, sigma = 0;
  int count = find_kinks(w, a, b, &kinks);
  for (int c = 0; c < 3; c++) sigma = fmax(sigma, extinction(w->medium, c));
  for (int i = 0; i + 1 < count; i++) {
    double length = kinks[i + 1] - kinks[i];
    int parts = 1 + (int)fmin(2 * sigma * density_integral(w, kinks[i], kinks[i + 1]), 100);
    parts = w->heat ? parts + 11 : parts; /* temperatures bend the light sharply */
    for (int p = 0; p < parts; p++)
      add_piece(w, truth, cell, kinks[i] + length * p / parts, kinks[i] + length * (p + 1) / parts);
  }
  free(kinks);
}

FieldTruth field_truth(const cdl_Medium *medium, const Field *density, const Field *heat,
                       const Field *color, FieldColor radiance, const FieldRay *ray) {
  Walk w = {medium, density, heat, color, radiance, {0}, {0}, 0};
  FieldTruth truth = {ray->from, ray->to, {1, 1, 1}, {{0}}, {0}, {1}};
  field_place(medium, ray, w.origin, w.direction);
  field_clip(density->size, w.origin, w.direction, 0, &truth.first, &truth.last);
  if (!(truth.last > truth.first)) truth.last = truth.first;
  double length = (truth.last - truth.first) / FIELD_CELLS;
  for (int i = 0; i < FIELD_CELLS; i++) {
    if (length > 0)
      add_cell(&w, &truth, i, truth.first + i * length, truth.first + (i + 1) * length);
    truth.reached[i + 1] = exp(-extinction(medium, 0) * w.passed);
  }
  for (int c = 0; c < 3; c++) truth.through[c] = exp(-extinction(medium, c) * w.passed);
  return truth;
}
