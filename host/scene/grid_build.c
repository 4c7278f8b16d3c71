/* grid_build.c: bricks from blocks.
 *
 * An index box begins anywhere in the file's index, so that a brick with its ninth voxels lies over
 * two blocks along each axis. Bricks are gathered twice: first to find their ranges and which of
 * them are stored, then into place. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/grid_parts.h"

enum { CHANNELS_MAX = 3, SHARED = 1024, FEW = 1024 /* bricks not worth a second thread */ };

/* In the table between the two passes. */
#define STORED (CDL_NONE - 1)
#define UNIFORM (CDL_NONE - 2)

/* For each voxel of a brick along an axis: the block that it lies in, and its place there. */
typedef struct Axis {
  int32_t block[GRID_STORED]; /* -1: outside of all */
  uint32_t at[GRID_STORED];
} Axis;

/* A voxel of the box along axis `k`, in voxels of the source's blocks; its last one past its end.
 */
static int64_t voxel_of(const GridSource *source, const cdl_SceneGrid *grid, int k,
                        uint32_t voxel) {
  if (voxel > grid->size[k] - 1) voxel = grid->size[k] - 1;
  return (int64_t)grid->low[k] + voxel - (int64_t)source->first[k] * GRID_BRICK;
}

/* -1: outside of all blocks. */
static int32_t block_at(const GridSource *source, int k, int64_t voxel) {
  if (voxel < 0 || voxel >= (int64_t)source->blocks[k] * GRID_BRICK) return -1;
  return (int32_t)(voxel / GRID_BRICK);
}

static Axis axis_of(const GridSource *source, const cdl_SceneGrid *grid, int k, uint32_t brick) {
  Axis axis;
  for (uint32_t i = 0; i < GRID_STORED; i++) {
    int64_t voxel = voxel_of(source, grid, k, brick * GRID_BRICK + i);
    axis.block[i] = block_at(source, k, voxel);
    axis.at[i] = (uint32_t)(voxel & (GRID_BRICK - 1));
  }
  return axis;
}

static uint32_t slot_of(const GridSource *source, int32_t x, int32_t y, int32_t z) {
  if (x < 0 || y < 0 || z < 0) return CDL_NONE;
  return source->slots[((size_t)z * source->blocks[1] + (size_t)y) * source->blocks[0] + (size_t)x];
}

/* One channel of a row of nine voxels. */
static void gather_row(const GridSource *source, const Axis axes[3], uint32_t y, uint32_t z,
                       uint32_t channel, float *to) {
  const Axis *x = &axes[0];
  uint32_t slot = CDL_NONE, row = (axes[2].at[z] * GRID_BRICK + axes[1].at[y]) * GRID_BRICK;
  for (uint32_t i = 0; i < GRID_STORED; i++) {
    if (i == 0 || x->block[i] != x->block[i - 1])
      slot = slot_of(source, x->block[i], axes[1].block[y], axes[2].block[z]);
    if (slot == CDL_NONE)
      to[i] = 0;
    else if (slot & GRID_TILE)
      to[i] = source->tiles[(size_t)(slot & ~GRID_TILE) * source->channels + channel];
    else
      to[i] =
          source->leaves[((size_t)slot * source->channels + channel) * GRID_LEAF + row + x->at[i]];
  }
}

static void gather(const GridSource *source, const cdl_SceneGrid *grid, const uint32_t brick[3],
                   float *to) {
  Axis axes[3];
  for (int k = 0; k < 3; k++) axes[k] = axis_of(source, grid, k, brick[k]);
  for (uint32_t c = 0; c < grid->channels; c++)
    for (uint32_t z = 0; z < GRID_STORED; z++)
      for (uint32_t y = 0; y < GRID_STORED; y++, to += GRID_STORED)
        gather_row(source, axes, y, z, c, to);
}

static void brick_at(const cdl_SceneGrid *grid, size_t entry, uint32_t brick[3]) {
  brick[0] = (uint32_t)(entry % grid->bricks[0]);
  brick[1] = (uint32_t)(entry / grid->bricks[0] % grid->bricks[1]);
  brick[2] = (uint32_t)(entry / grid->bricks[0] / grid->bricks[1]);
}

/* The eight blocks under a brick. */
static void slots_under(const GridSource *source, const cdl_SceneGrid *grid,
                        const uint32_t brick[3], uint32_t slots[8]) {
  int32_t block[3][2];
  for (int k = 0; k < 3; k++) {
    for (int end = 0; end < 2; end++) {
      uint32_t voxel = (brick[k] + (uint32_t)end) * GRID_BRICK;
      block[k][end] = block_at(source, k, voxel_of(source, grid, k, voxel));
    }
  }
  for (int i = 0; i < 8; i++)
    slots[i] = slot_of(source, block[0][i & 1], block[1][i >> 1 & 1], block[2][i >> 2]);
}

/* The tile whose values all eight blocks have; NULL: none. */
static const float *tile_under(const GridSource *source, const uint32_t slots[8]) {
  const float *tile = NULL;
  for (int i = 0; i < 8; i++) {
    if (slots[i] == CDL_NONE || !(slots[i] & GRID_TILE)) return NULL;
    if (i > 0 && slots[i] == slots[0]) continue;
    const float *other = source->tiles + (size_t)(slots[i] & ~GRID_TILE) * source->channels;
    if (tile && memcmp(tile, other, source->channels * sizeof *tile) != 0) return NULL;
    if (!tile) tile = other;
  }
  return tile;
}

static void survey_values(cdl_SceneGrid *grid, size_t entry, const float *values, uint32_t stored) {
  float least = values[0], most = values[0];
  int uniform = 1;
  for (uint32_t i = 0; i < stored * grid->channels; i++) {
    least = fminf(least, values[i]);
    most = fmaxf(most, values[i]);
    uniform &= values[i] == values[i / stored * stored];
  }
  grid->least[entry] = least;
  grid->most[entry] = most;
  if (most > 0) grid->table[entry] = uniform ? UNIFORM : STORED;
}

/* What lies in tiles is not gathered: a few bytes of a file can be a lot of them. */
static void survey(const GridSource *source, cdl_SceneGrid *grid, size_t entry) {
  float values[CHANNELS_MAX * GRID_VALUES];
  uint32_t brick[3];
  brick_at(grid, entry, brick);
  grid->table[entry] = CDL_NONE;
  grid->least[entry] = grid->most[entry] = 0;
  uint32_t slots[8], any = CDL_NONE;
  slots_under(source, grid, brick, slots);
  for (int i = 0; i < 8; i++) any &= slots[i];
  if (any == CDL_NONE) return;
  const float *tile = tile_under(source, slots);
  if (!tile) gather(source, grid, brick, values);
  survey_values(grid, entry, tile ? tile : values, tile ? 1 : GRID_VALUES);
}

/* The first voxel of a brick. */
static void first_values(const GridSource *source, const cdl_SceneGrid *grid, size_t entry,
                         float values[CHANNELS_MAX]) {
  float row[GRID_STORED];
  uint32_t brick[3];
  Axis axes[3];
  brick_at(grid, entry, brick);
  for (int k = 0; k < 3; k++) axes[k] = axis_of(source, grid, k, brick[k]);
  for (uint32_t c = 0; c < grid->channels; c++) {
    gather_row(source, axes, 0, 0, c, row);
    values[c] = row[0];
  }
}

/* Uniform bricks that have been given a number, found by their values. */
typedef struct Shared {
  struct {
    uint32_t number; /* CDL_NONE: free */
    float values[CHANNELS_MAX];
  } known[SHARED];
} Shared;

static uint32_t share(Shared *shared, const float values[CHANNELS_MAX], uint32_t number) {
  uint32_t hash = 0, bits[CHANNELS_MAX];
  memcpy(bits, values, sizeof bits);
  for (int c = 0; c < CHANNELS_MAX; c++) hash = (hash ^ bits[c]) * 2654435761u;
  uint32_t at = hash >> 22;
  if (shared->known[at].number != CDL_NONE &&
      memcmp(shared->known[at].values, values, sizeof bits) == 0)
    return shared->known[at].number;
  shared->known[at].number = number;
  memcpy(shared->known[at].values, values, sizeof bits);
  return number;
}

/* Numbers the bricks in the order of the table; the first entry of each number, in `entries`. */
static cdl_Status number_bricks(const GridSource *source, cdl_SceneGrid *grid, size_t count,
                                uint32_t *entries) {
  Shared *shared = malloc(sizeof *shared);
  if (!shared) return CDL_BAD_INPUT;
  memset(shared, 0xff, sizeof *shared);
  for (size_t i = 0; i < count; i++) {
    uint32_t kind = grid->table[i], number = grid->brick_count;
    if (kind == CDL_NONE) continue;
    if (kind == UNIFORM) {
      float first[CHANNELS_MAX] = {0};
      if (grid->channels == 1)
        first[0] = grid->least[i];
      else
        first_values(source, grid, i, first);
      number = share(shared, first, number);
    }
    grid->table[i] = number;
    if (number == grid->brick_count) entries[grid->brick_count++] = (uint32_t)i;
  }
  free(shared);
  return CDL_OK;
}

static cdl_Status refuse_size(const char **why) {
  *why = "it would take more memory than is allowed";
  return CDL_BAD_INPUT;
}

static cdl_Status fill_bricks(const GridSource *source, cdl_SceneGrid *grid,
                              const uint32_t *entries, size_t room, const char **why) {
  size_t each = (size_t)GRID_VALUES * grid->channels;
  if (grid->brick_count * each > GRID_FLOATS_MAX || grid_memory(grid) > room)
    return refuse_size(why);
  grid->values = malloc((grid->brick_count * each + 1) * sizeof *grid->values);
  if (!grid->values) return CDL_BAD_INPUT;
#pragma omp parallel for schedule(static) if (grid->brick_count > FEW)
  for (uint32_t i = 0; i < grid->brick_count; i++) {
    uint32_t brick[3];
    brick_at(grid, entries[i], brick);
    gather(source, grid, brick, grid->values + i * each);
  }
  return CDL_OK;
}

/* Stops as soon as more bricks must be stored than there is room for. */
static cdl_Status survey_all(const GridSource *source, cdl_SceneGrid *grid, size_t count,
                             size_t room) {
  size_t stored = 0, most = room / (GRID_VALUES * grid->channels * sizeof *grid->values);
#pragma omp parallel for schedule(dynamic, 64) if (count > FEW)
  for (size_t i = 0; i < count; i++) {
    size_t so_far;
#pragma omp atomic read
    so_far = stored;
    if (so_far > most) continue;
    survey(source, grid, i);
    if (grid->table[i] != STORED) continue;
#pragma omp atomic
    stored++;
  }
  return stored > most ? CDL_BAD_INPUT : CDL_OK;
}

static void find_range(cdl_SceneGrid *grid, size_t count) {
  grid->minimum = FLT_MAX, grid->maximum = 0;
  for (size_t i = 0; i < count; i++) {
    grid->minimum = fminf(grid->minimum, grid->least[i]);
    grid->maximum = fmaxf(grid->maximum, grid->most[i]);
  }
}

static cdl_Status prepare(const GridSource *source, const int32_t low[3], const uint32_t size[3],
                          size_t room, cdl_SceneGrid *grid, size_t *count, const char **why) {
  *grid = (cdl_SceneGrid){.channels = source->channels, .active = source->active};
  uint64_t bricks = 1;
  for (int k = 0; k < 3; k++) {
    grid->low[k] = low[k];
    grid->size[k] = size[k];
    grid->bricks[k] = (size[k] + GRID_BRICK - 1) / GRID_BRICK;
    bricks *= grid->bricks[k];
    if (bricks > GRID_TABLE_MAX) {
      *why = "its voxels lie in a box of more than 2048^3";
      return CDL_BAD_INPUT;
    }
  }
  *count = (size_t)bricks;
  if (grid_memory(grid) > room) return refuse_size(why);
  grid->table = malloc(*count * sizeof *grid->table);
  grid->least = malloc(*count * sizeof *grid->least);
  grid->most = malloc(*count * sizeof *grid->most);
  return grid->table && grid->least && grid->most ? CDL_OK : CDL_BAD_INPUT;
}

cdl_Status grid_build(const GridSource *source, const int32_t low[3], const uint32_t size[3],
                      size_t room, cdl_SceneGrid *grid, const char **why) {
  size_t count = 0;
  *why = "there is not enough memory for it";
  cdl_Status status = prepare(source, low, size, room, grid, &count, why);
  if (status) return status;
  if (survey_all(source, grid, count, room)) return refuse_size(why);
  find_range(grid, count);
  uint32_t *entries = malloc((count + 1) * sizeof *entries);
  if (!entries) return CDL_BAD_INPUT;
  status = number_bricks(source, grid, count, entries);
  if (!status) status = fill_bricks(source, grid, entries, room, why);
  free(entries);
  return status;
}
