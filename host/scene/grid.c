/* grid.c: what a volume file holds, block by block, on its way into bricks. */
#include "scene/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/grid_parts.h"

static cdl_Status refuse(const char **why, const char *words) {
  *why = words;
  return CDL_BAD_INPUT;
}

/* The block that voxel `i` of the file lies in: division that rounds down. */
static int32_t block_of(int32_t i) { return (i >= 0 ? i : i - (GRID_BRICK - 1)) / GRID_BRICK; }

cdl_Status grid_source_begin(GridSource *source, uint32_t channels, const int32_t low[3],
                             const int32_t high[3], uint32_t leaves, uint32_t tiles,
                             const char **why) {
  *source = (GridSource){.channels = channels, .leaf_room = leaves, .tile_room = tiles};
  uint64_t blocks = 1;
  if (channels < 1 || channels > 3 || leaves >= GRID_TILE || tiles >= GRID_TILE)
    return refuse(why, "it holds too much");
  for (int k = 0; k < 3; k++) {
    if (low[k] > high[k]) return refuse(why, "it has no voxels");
    if (low[k] < -GRID_INDEX_MAX || high[k] > GRID_INDEX_MAX)
      return refuse(why, "its voxels lie too far from its origin");
    source->low[k] = low[k];
    source->high[k] = high[k];
    source->first[k] = block_of(low[k]);
    source->blocks[k] = (uint32_t)(block_of(high[k]) - source->first[k]) + 1;
    /* A box that begins within a block takes up to one more of them than it has bricks. */
    blocks *= source->blocks[k];
    if (blocks > 2 * (uint64_t)GRID_TABLE_MAX)
      return refuse(why, "its voxels lie in a box of more than 2048^3");
  }
  source->slots = malloc(blocks * sizeof *source->slots);
  source->leaves = malloc(((size_t)leaves * GRID_LEAF * channels + 1) * sizeof *source->leaves);
  source->tiles = malloc(((size_t)tiles * channels + 1) * sizeof *source->tiles);
  if (!source->slots || !source->leaves || !source->tiles)
    return refuse(why, "there is not enough memory for it");
  memset(source->slots, 0xff, blocks * sizeof *source->slots);
  return CDL_OK;
}

void grid_source_free(GridSource *source) {
  free(source->slots);
  free(source->leaves);
  free(source->tiles);
  *source = (GridSource){0};
}

/* The slot of the block at `origin`; NULL: there is none of it. */
static uint32_t *slot_at(const GridSource *source, const int32_t origin[3]) {
  uint32_t at[3];
  for (int k = 0; k < 3; k++) {
    at[k] = (uint32_t)(block_of(origin[k]) - source->first[k]);
    if (origin[k] % GRID_BRICK || at[k] >= source->blocks[k]) return NULL;
  }
  return &source->slots[((size_t)at[2] * source->blocks[1] + at[1]) * source->blocks[0] + at[0]];
}

static cdl_Status take(GridSource *source, float *to, const float *from, size_t count,
                       uint64_t weight, const char **why) {
  for (size_t i = 0; i < count; i++) {
    if (!isfinite(from[i])) return refuse(why, "a value is not finite in single precision");
    to[i] = from[i] > 0 ? from[i] : 0;
    if (from[i] >= 0) continue;
    source->negative += weight;
    source->lowest = fminf(source->lowest, from[i]);
  }
  return CDL_OK;
}

cdl_Status grid_source_leaf(GridSource *source, const int32_t origin[3], const float *values,
                            const char **why) {
  uint32_t *slot = slot_at(source, origin);
  if (!slot || *slot != CDL_NONE || source->leaf_count == source->leaf_room)
    return refuse(why, "a block of it is out of place");
  size_t count = (size_t)GRID_LEAF * source->channels;
  *slot = source->leaf_count++;
  return take(source, source->leaves + *slot * count, values, count, 1, why);
}

cdl_Status grid_source_tile(GridSource *source, const int32_t origin[3], uint32_t side,
                            const float *values, const char **why) {
  if (side < GRID_BRICK || side % GRID_BRICK || source->tile_count == source->tile_room)
    return refuse(why, "a tile of it is out of place");
  uint32_t tile = source->tile_count++ | GRID_TILE;
  uint64_t voxels = (uint64_t)side * side * side;
  float *to = source->tiles + (size_t)(tile & ~GRID_TILE) * source->channels;
  int32_t end[3], at[3];
  for (int k = 0; k < 3; k++) {
    if (origin[k] < -GRID_INDEX_MAX || origin[k] > GRID_INDEX_MAX ||
        side > (uint32_t)GRID_INDEX_MAX)
      return refuse(why, "a tile of it is out of place");
    end[k] = origin[k] + (int32_t)side;
  }
  for (at[2] = origin[2]; at[2] < end[2]; at[2] += GRID_BRICK)
    for (at[1] = origin[1]; at[1] < end[1]; at[1] += GRID_BRICK)
      for (at[0] = origin[0]; at[0] < end[0]; at[0] += GRID_BRICK) {
        uint32_t *slot = slot_at(source, at);
        if (!slot || *slot != CDL_NONE) return refuse(why, "a tile of it is out of place");
        *slot = tile;
      }
  return take(source, to, values, source->channels, voxels, why);
}

void grid_free(cdl_SceneGrid *grid) {
  free(grid->file);
  free(grid->name);
  free(grid->table);
  free(grid->values);
  free(grid->least);
  free(grid->most);
  *grid = (cdl_SceneGrid){0};
}

uint64_t grid_memory(const cdl_SceneGrid *grid) {
  uint64_t entries = (uint64_t)grid->bricks[0] * grid->bricks[1] * grid->bricks[2];
  uint64_t entry = sizeof *grid->table + sizeof *grid->least + sizeof *grid->most;
  return entries * entry +
         (uint64_t)grid->brick_count * GRID_VALUES * grid->channels * sizeof *grid->values;
}
