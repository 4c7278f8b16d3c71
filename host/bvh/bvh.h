/* bvh.h: builds what rays are traced through, ready to upload.
 *
 * Meshes are placed in the world by instances; instances of one mesh share its tree. A hit names a
 * triangle by its global number and an instance by its place in the list, so the order in which
 * trees are built shows nowhere. All memory belongs to the cdl_Bvh; the input is only read. */
#ifndef CANDELA_BVH_BVH_H
#define CANDELA_BVH_BVH_H

#include <stddef.h>
#include <stdint.h>

#include "abi/bvh.h"
#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Triangles with positions of their own: 3 floats a vertex, 3 indices a triangle, in range. The
 * first one has the global number first_primitive, the others follow. What moves has positions at
 * `keys` times, key_stride floats apart; all parts that move have as many. */
typedef struct cdl_BvhPart {
  const float *positions;
  const uint32_t *indices;
  uint32_t triangle_count;
  uint32_t first_primitive;
  uint32_t keys; /* below 2: it stands still */
  size_t key_stride;
} cdl_BvhPart;

/* One tree is built over all parts of a mesh. */
typedef struct cdl_BvhMesh {
  const cdl_BvhPart *parts;
  uint32_t part_count;
} cdl_BvhMesh;

/* `mesh` placed by a 3x4 row-major matrix. The rest is passed on to cdl_BvhInstance. Exactly the
 * identity costs rays nothing; a matrix that cannot be inverted hides the instance. */
typedef struct cdl_BvhPlacement {
  uint32_t mesh;
  float to_world[12];
  uint32_t mask;
  uint32_t object;
  uint32_t first_light;
  uint32_t medium;
} cdl_BvhPlacement;

/* Zeros mean the defaults. None of these changes what a ray hits. */
typedef struct cdl_BvhOptions {
  int width;    /* 2 (default) or 8: CDL_BVH_WIDTH of the kernels */
  int bins;     /* of the SAH, 2 … 32 (32) */
  int leaf_max; /* triangles in a leaf, 1 … 8 (width 8: 1 … 32) */
} cdl_BvhOptions;

typedef struct cdl_BvhStatistics {
  uint64_t triangles; /* in leaves; instances do not multiply them */
  uint64_t dropped;   /* triangles with two equal or with not finite corners */
  uint64_t nodes, leaves;
  uint32_t instances;
  uint32_t depth;          /* inner nodes on the longest way, both levels together */
  uint32_t leaf_max;       /* triangles in the largest leaf */
  uint64_t leaf_sizes[33]; /* leaves of so many triangles */
  double leaf_average;
  double sah; /* expected cost of a ray that meets the box of the largest mesh: nodes + triangles */
  double seconds;
  uint64_t bytes; /* nodes, triangles and instances */
} cdl_BvhStatistics;

typedef struct cdl_Bvh {
  int width;
  void *nodes;     /* cdl_BvhNode or cdl_BvhNode8, aligned to 64 bytes */
  void *triangles; /* cdl_BvhTriangle or cdl_BvhTriangle4 */
  cdl_BvhInstance *instances;
  size_t node_bytes, triangle_bytes, instance_bytes; /* never 0 */
  uint32_t instance_count;
  uint32_t root;   /* reference: to the top level's node, or to the only instance */
  float bounds[6]; /* of everything, in the world: min x y z, max x y z; min > max if empty */
  cdl_BvhStatistics statistics;
} cdl_Bvh;

/* Builds on all cores, the same tree for any number of them. Nothing to hit is fine. Fails with
 * CDL_BAD_INPUT when there are too many triangles or not enough memory. options may be NULL. Free
 * with bvh_free(), also after a failure. */
cdl_Status bvh_build(const cdl_Log *log, const cdl_BvhMesh *meshes, uint32_t mesh_count,
                     const cdl_BvhPlacement *placements, uint32_t placement_count,
                     const cdl_BvhOptions *options, cdl_Bvh *bvh);

/* Frees and zeroes it; fine for an all-zero one. */
void bvh_free(cdl_Bvh *bvh);

/* One line: "BVH2: 1619968 triangles, 1 instance, 620123 nodes, SAH 63.2, leaves 2.6 (8 at most),
 * …". Returns what snprintf does. */
int bvh_statistics_line(const cdl_BvhStatistics *statistics, int width, char *line, size_t size);

#ifdef __cplusplus
}
#endif
#endif
