#include "bvh/source.h"

#include <stdlib.h>

int source_open(Source *source, const cdl_BvhMesh *mesh) {
  uint64_t total = 0;
  source->parts = mesh->parts;
  source->part_count = mesh->part_count;
  source->starts = malloc(((size_t)mesh->part_count + 1) * sizeof *source->starts);
  if (!source->starts) return -1;
  for (uint32_t i = 0; i < mesh->part_count; i++) {
    source->starts[i] = (uint32_t)total;
    total += mesh->parts[i].triangle_count;
    if (total > UINT32_MAX) return -1;
  }
  source->starts[mesh->part_count] = source->count = (uint32_t)total;
  return 0;
}

void source_close(Source *source) {
  free(source->starts);
  source->starts = NULL;
}

/* The last part that starts at or before triangle `number`. */
static uint32_t source_part(const Source *source, uint32_t number) {
  uint32_t low = 0, high = source->part_count;
  while (high - low > 1) {
    uint32_t middle = low + (high - low) / 2;
    if (source->starts[middle] <= number)
      low = middle;
    else
      high = middle;
  }
  return low;
}

static uint32_t triangle_at(const Source *source, uint32_t number, uint32_t key, float v[9]) {
  uint32_t at = source_part(source, number);
  const cdl_BvhPart *part = source->parts + at;
  const float *positions = part->positions + key * part->key_stride;
  uint32_t local = number - source->starts[at];
  for (int corner = 0; corner < 3; corner++) {
    size_t vertex = part->indices[3 * (size_t)local + (size_t)corner];
    memcpy(v + 3 * corner, positions + 3 * vertex, 3 * sizeof *v);
  }
  return part->first_primitive + local;
}

uint32_t source_triangle(const Source *source, uint32_t number, float v[9]) {
  return triangle_at(source, number, 0, v);
}

static int same_corner(const float *a, const float *b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static int is_finite(const float v[9]) {
  for (int i = 0; i < 9; i++)
    if (!isfinite(v[i])) return 0;
  return 1;
}

static int has_corners(const float v[9]) {
  return !same_corner(v, v + 3) && !same_corner(v + 3, v + 6) && !same_corner(v + 6, v);
}

static Box triangle_box(const float v[9]) {
  Box box = box_empty();
  for (int corner = 0; corner < 3; corner++) {
    const float *p = v + 3 * corner;
    Box point = {{p[0], p[1], p[2], 0.0f, -p[0], -p[1], -p[2], 0.0f}};
    box_grow(&box, &point);
  }
  return box;
}

/* Around a triangle at all keys of its motion, between which vertices move straight; empty if it
 * can never be hit. */
static Box fragment_box(const Source *source, uint32_t number) {
  uint32_t keys = source->parts[source_part(source, number)].keys;
  Box box = box_empty();
  int hittable = 0;
  for (uint32_t key = 0; key < (keys ? keys : 1); key++) {
    float v[9];
    triangle_at(source, number, key, v);
    if (!is_finite(v)) return box_empty();
    Box here = triangle_box(v);
    hittable |= has_corners(v);
    box_grow(&box, &here);
  }
  return hittable ? box : box_empty();
}

uint32_t source_fragments(const Source *source, Fragment *fragments, uint32_t *count) {
  /* In two passes, so that the second can drop some without losing the order. */
#pragma omp parallel for schedule(static)
  for (uint32_t i = 0; i < source->count; i++) {
    Box box = fragment_box(source, i);
    fragment_set(fragments + i, &box, i);
  }
  uint32_t kept = 0;
  for (uint32_t i = 0; i < source->count; i++)
    if (fragments[i].box.side[0] < INFINITY) fragments[kept++] = fragments[i];
  *count = kept;
  return source->count - kept;
}
