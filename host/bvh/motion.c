#include "bvh/motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bvh/layout.h"

/* The parts of all meshes, by their first triangle. */
typedef struct Parts {
  const cdl_BvhPart **list;
  size_t count;
  uint32_t keys; /* of those that move */
} Parts;

static int compare(const void *a, const void *b) {
  const cdl_BvhPart *x = *(const cdl_BvhPart *const *)a, *y = *(const cdl_BvhPart *const *)b;
  return (x->first_primitive > y->first_primitive) - (x->first_primitive < y->first_primitive);
}

static int collect(const cdl_BvhMesh *meshes, uint32_t mesh_count, Parts *parts) {
  size_t count = 0;
  for (uint32_t m = 0; m < mesh_count; m++) count += meshes[m].part_count;
  parts->list = malloc((count + 1) * sizeof *parts->list);
  if (!parts->list) return -1;
  for (uint32_t m = 0; m < mesh_count; m++)
    for (uint32_t p = 0; p < meshes[m].part_count; p++) {
      const cdl_BvhPart *part = &meshes[m].parts[p];
      if (!part->triangle_count) continue;
      parts->list[parts->count++] = part;
      if (part->keys > parts->keys) parts->keys = part->keys;
    }
  qsort(parts->list, parts->count, sizeof *parts->list, compare);
  return 0;
}

static const cdl_BvhPart *part_of(const Parts *parts, uint32_t primitive) {
  size_t low = 0, high = parts->count;
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (parts->list[middle]->first_primitive <= primitive)
      low = middle;
    else
      high = middle;
  }
  return parts->list[low];
}

static int moves(const Parts *parts, uint32_t primitive) {
  return primitive != CDL_NONE && part_of(parts, primitive)->keys > 1;
}

/* The corners of a triangle at a key; those of one that stands still are the same at all. */
static void corners(const Parts *parts, uint32_t primitive, uint32_t key, float v[9]) {
  const cdl_BvhPart *part = part_of(parts, primitive);
  const float *positions = part->positions + (part->keys > 1 ? key * part->key_stride : 0);
  const uint32_t *index = part->indices + 3 * (size_t)(primitive - part->first_primitive);
  for (int k = 0; k < 3; k++) memcpy(v + 3 * k, positions + 3 * (size_t)index[k], 3 * sizeof *v);
}

static int group_moves(const Parts *parts, const cdl_BvhTriangle4 *group) {
  int any = 0;
  for (int lane = 0; lane < 4; lane++) any |= moves(parts, group->primitive[lane]);
  return any;
}

static void write_keys8(const Parts *parts, cdl_BvhTriangle4 *group, cdl_BvhTriangle4 *to,
                        uint32_t index) {
  for (uint32_t key = 0; key < parts->keys; key++) {
    to[key] = *group;
    for (int lane = 0; lane < 4; lane++) {
      float v[9];
      if (group->primitive[lane] == CDL_NONE) continue;
      corners(parts, group->primitive[lane], key, v);
      for (int i = 0; i < 9; i++) to[key].v[4 * i + lane] = v[i];
    }
  }
  group->v[0] = NAN;
  memcpy(&group->v[1], &index, sizeof index);
}

static void write_keys2(const Parts *parts, cdl_BvhTriangle *triangle, cdl_BvhTriangle *to,
                        uint32_t index) {
  for (uint32_t key = 0; key < parts->keys; key++) {
    to[key] = *triangle;
    float v[9];
    corners(parts, triangle->primitive, key, v);
    memcpy(to[key].v0, v, sizeof to[key].v0);
    memcpy(to[key].v1, v + 3, sizeof to[key].v1);
    memcpy(to[key].v2, v + 6, sizeof to[key].v2);
  }
  triangle->keys = index;
}

static int entry_moves(const Parts *parts, const cdl_Bvh *bvh, size_t i) {
  if (bvh->width == 8) return group_moves(parts, (const cdl_BvhTriangle4 *)bvh->triangles + i);
  return moves(parts, ((const cdl_BvhTriangle *)bvh->triangles)[i].primitive);
}

static int append(const Parts *parts, cdl_Bvh *bvh) {
  size_t size = bvh->width == 8 ? sizeof(cdl_BvhTriangle4) : sizeof(cdl_BvhTriangle);
  size_t count = bvh->triangle_bytes / size, at = count, moving = 0;
  for (size_t i = 0; i < count; i++) moving += (size_t)entry_moves(parts, bvh, i);
  size_t bytes = (count + moving * parts->keys) * size;
  if (bytes / size > CDL_BVH_INDEX) return -1;
  void *more = aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (!more) return -1;
  memcpy(more, bvh->triangles, count * size);
  free(bvh->triangles);
  bvh->triangles = more;
  bvh->triangle_bytes = bytes;
  for (size_t i = 0; i < count; i++) {
    if (!entry_moves(parts, bvh, i)) continue;
    cdl_BvhTriangle4 *groups = more;
    cdl_BvhTriangle *triangles = more;
    if (bvh->width == 8)
      write_keys8(parts, groups + i, groups + at, (uint32_t)at);
    else
      write_keys2(parts, triangles + i, triangles + at, (uint32_t)at);
    at += parts->keys;
  }
  return 0;
}

int motion_append(const cdl_BvhMesh *meshes, uint32_t mesh_count, cdl_Bvh *bvh) {
  Parts parts = {0};
  int failed = collect(meshes, mesh_count, &parts);
  if (!failed && parts.keys > 1) failed = append(&parts, bvh);
  free(parts.list);
  return failed;
}
