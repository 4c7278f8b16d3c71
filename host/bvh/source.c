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

uint32_t source_triangle(const Source *source, uint32_t number, float v[9]) {
  uint32_t at = source_part(source, number);
  const cdl_BvhPart *part = source->parts + at;
  uint32_t local = number - source->starts[at];
  for (int corner = 0; corner < 3; corner++) {
    size_t vertex = part->indices[3 * (size_t)local + (size_t)corner];
    memcpy(v + 3 * corner, part->positions + 3 * vertex, 3 * sizeof *v);
  }
  return part->first_primitive + local;
}

static int same_corner(const float *a, const float *b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static int is_hittable(const float v[9]) {
  for (int i = 0; i < 9; i++)
    if (!isfinite(v[i])) return 0;
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

uint32_t source_fragments(const Source *source, Fragment *fragments, uint32_t *count) {
  /* In two passes, so that the second can drop some without losing the order. */
#pragma omp parallel for schedule(static)
  for (uint32_t i = 0; i < source->count; i++) {
    float v[9];
    source_triangle(source, i, v);
    Box box = is_hittable(v) ? triangle_box(v) : box_empty();
    fragment_set(fragments + i, &box, i);
  }
  uint32_t kept = 0;
  for (uint32_t i = 0; i < source->count; i++)
    if (fragments[i].box.side[0] < INFINITY) fragments[kept++] = fragments[i];
  *count = kept;
  return source->count - kept;
}
