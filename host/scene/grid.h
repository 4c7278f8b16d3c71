/* grid.h: volumes in bricks, laid out for a device to read as they are.
 *
 * A grid covers an index box of size[0] x size[1] x size[2] voxels. Voxel (i, j, k) has its centre
 * at (i, j, k) of index space, so that the box spans [-0.5, size - 0.5]. The box is cut into bricks
 * of 8^3 voxels. Values between voxel 8b + 7 and voxel 8b + 8 are of brick b, which for that holds
 * a ninth voxel along each axis: the next brick's first, and past the end of the box the last one
 * again. A look-up so needs one brick alone. */
#ifndef CANDELA_SCENE_GRID_H
#define CANDELA_SCENE_GRID_H

#include <stddef.h>
#include <stdint.h>

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  GRID_BRICK = 8,               /* voxels of a side that are a brick's own */
  GRID_STORED = GRID_BRICK + 1, /* and that it stores */
  GRID_VALUES = GRID_STORED * GRID_STORED * GRID_STORED, /* stored for each channel */
  GRID_LEAF = GRID_BRICK * GRID_BRICK * GRID_BRICK,
  GRID_TABLE_MAX = 1 << 24 /* bricks of an index box: 2048^3 voxels */
};

#define GRID_FLOATS_MAX ((uint64_t)1 << 31) /* stored by all bricks of a grid: 8 GiB */

typedef struct cdl_SceneGrid {
  char *file, *name;  /* where it is from */
  uint32_t channels;  /* 1 or 3 */
  uint32_t size[3];   /* voxels of the index box */
  uint32_t bricks[3]; /* size / 8, rounded up */
  uint32_t *table;    /* for each brick, x fastest, its number; CDL_NONE: 0 everywhere. Bricks that
                         hold one and the same value everywhere may share a number */
  uint32_t brick_count;
  float *values; /* for each number: channel by channel 9^3 values, x fastest */
  float *least;  /* for each entry of the table: no value that interpolation meets is below, */
  float *most;   /* or above; over all channels */
  float minimum, maximum; /* of all voxels of the box, over all channels */
  uint64_t active;        /* voxels that the file marks so */
  int32_t low[3];         /* the file's index of voxel (0, 0, 0) */
  int whole;              /* 1: the box is the file's own, not that of another grid */
  double to_index[12];    /* from the file's space to index space, 3x4, row-major */
} cdl_SceneGrid;

/* What a file holds, as it was read: blocks of 8^3 voxels at multiples of 8 of the file's index,
 * and larger ones that are uniform. Made by grid_source_begin(), filled, and built from. */
typedef struct GridSource {
  uint32_t channels;
  int32_t low[3], high[3]; /* the first and the last voxel of the index box */
  int32_t first[3];        /* of the first block, in blocks */
  uint32_t blocks[3];
  uint32_t *slots; /* for each block, x fastest: what it holds (grid.c) */
  float *leaves, *tiles;
  uint32_t leaf_room, leaf_count, tile_room, tile_count;
  uint64_t active;
  uint64_t negative; /* values below 0 that were made 0 */
  float lowest;      /* of them */
  double to_world[12];
} GridSource;

/* Prepares for `leaves` blocks and `tiles` uniform ones in a box from voxel `low` to voxel `high`.
 * CDL_BAD_INPUT without a report: *why is set to a few words, for that the box is too large, or for
 * lack of memory. Call grid_source_free() in any case. */
cdl_Status grid_source_begin(GridSource *source, uint32_t channels, const int32_t low[3],
                             const int32_t high[3], uint32_t leaves, uint32_t tiles,
                             const char **why);

/* A block: `values` are channel by channel, x fastest, 0 where nothing is. Values below 0 become 0
 * and are counted. Fails, likewise, at values that are not finite and at blocks out of place. */
cdl_Status grid_source_leaf(GridSource *source, const int32_t origin[3], const float *values,
                            const char **why);

/* Blocks of one value: `side` is a multiple of 8, and `origin` of it. */
cdl_Status grid_source_tile(GridSource *source, const int32_t origin[3], uint32_t side,
                            const float *values, const char **why);

void grid_source_free(GridSource *source);

/* Builds the bricks of the index box from voxel `low` on of `size` voxels; what lies outside the
 * source is 0. It may take `room` bytes. Fails as above; call grid_free() in any case. file, name
 * and to_index are left to the caller. */
cdl_Status grid_build(const GridSource *source, const int32_t low[3], const uint32_t size[3],
                      size_t room, cdl_SceneGrid *grid, const char **why);

void grid_free(cdl_SceneGrid *grid);

/* Bytes that a grid takes in memory. */
uint64_t grid_memory(const cdl_SceneGrid *grid);

#ifdef __cplusplus
}
#endif
#endif
