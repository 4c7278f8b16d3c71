/* source.h: the triangles of a mesh, numbered through its parts. Internal to bvh/. */
#ifndef CANDELA_BVH_SOURCE_H
#define CANDELA_BVH_SOURCE_H

#include "bvh/bvh.h"
#include "bvh/tree.h"

typedef struct Source {
  const cdl_BvhPart *parts;
  uint32_t *starts; /* number of each part's first triangle; one more at the end */
  uint32_t part_count;
  uint32_t count; /* triangles */
} Source;

/* 0, or -1 when memory is short or there are more than UINT32_MAX triangles. */
int source_open(Source *source, const cdl_BvhMesh *mesh);
void source_close(Source *source);

/* The nine coordinates of triangle `number`, at the first key of its motion; returns its global
 * number. */
uint32_t source_triangle(const Source *source, uint32_t number, float v[9]);

/* Makes a fragment of every triangle that can be hit. Left out are those with corners that are not
 * finite, and those with two equal corners. Triangles that are merely flat stay: rounding in the
 * triangle test may open one to a sliver, through which rays would slip if it were missing. Returns
 * how many were left out. */
uint32_t source_fragments(const Source *source, Fragment *fragments, uint32_t *count);

#endif
