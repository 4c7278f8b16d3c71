/* test_grid.c: bricks against a dense array of the same voxels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "abi/types.h"
#include "random.h"
#include "scene/grid.h"

enum { SPAN = 64, CHANNELS = 3, ROOM = 1 << 30 };

/* What a file is to hold: voxels of -SPAN/2 to SPAN/2 along each axis. */
typedef struct Dense {
  float values[CHANNELS][SPAN][SPAN][SPAN]; /* z, y, x */
  uint32_t channels;
} Dense;

static Dense dense;

static uint32_t below(uint32_t n) { return (uint32_t)(random_unit() * (float)n); }

static float dense_at(uint32_t c, int32_t x, int32_t y, int32_t z) {
  const int32_t half = SPAN / 2;
  if (x < -half || y < -half || z < -half || x >= half || y >= half || z >= half) return 0;
  return dense.values[c][z + half][y + half][x + half];
}

/* Hands the dense array to a source block by block: blocks of one value partly as tiles. */
static void give_block(GridSource *source, const int32_t origin[3]) {
  float values[CHANNELS * GRID_LEAF], tile[CHANNELS];
  const char *why = "";
  int any = 0, uniform = 1;
  for (uint32_t i = 0; i < dense.channels * GRID_LEAF; i++) {
    uint32_t v = i % GRID_LEAF, c = i / GRID_LEAF;
    values[i] = dense_at(c, origin[0] + (int32_t)(v & 7), origin[1] + (int32_t)(v >> 3 & 7),
                         origin[2] + (int32_t)(v >> 6));
    any |= values[i] != 0;
    uniform &= values[i] == values[c * GRID_LEAF];
    tile[c] = values[c * GRID_LEAF];
  }
  if (!any) return;
  cdl_Status status = uniform ? grid_source_tile(source, origin, 8, tile, &why)
                              : grid_source_leaf(source, origin, values, &why);
  assert_string_equal(why, "");
  assert_int_equal(status, CDL_OK);
}

static void give_all(GridSource *source) {
  const int32_t half = SPAN / 2;
  for (int32_t z = -half; z < half; z += 8)
    for (int32_t y = -half; y < half; y += 8)
      for (int32_t x = -half; x < half; x += 8) {
        const int32_t origin[3] = {x, y, z};
        int inside = 1;
        for (int k = 0; k < 3; k++)
          inside &= origin[k] + 8 > source->low[k] && origin[k] <= source->high[k];
        if (inside) give_block(source, origin);
      }
}

/* Random blobs, single voxels and boxes of one value within low to high. */
static void fill_dense(uint32_t channels, const int32_t low[3], const int32_t high[3]) {
  memset(&dense, 0, sizeof dense);
  dense.channels = channels;
  for (int n = 0; n < 40; n++) {
    int32_t from[3], to[3], constant = below(3) == 0;
    float value = (float)(1 + below(4));
    for (int k = 0; k < 3; k++) {
      uint32_t extent = (uint32_t)(high[k] - low[k]) + 1, length = below(3) ? below(24) : 0;
      from[k] = low[k] + (int32_t)below(extent);
      to[k] = from[k] + (int32_t)length < high[k] ? from[k] + (int32_t)length : high[k];
    }
    for (int32_t z = from[2]; z <= to[2]; z++)
      for (int32_t y = from[1]; y <= to[1]; y++)
        for (int32_t x = from[0]; x <= to[0]; x++)
          for (uint32_t c = 0; c < channels; c++)
            dense.values[c][z + SPAN / 2][y + SPAN / 2][x + SPAN / 2] =
                constant ? value : (float)below(1000) / 8;
  }
}

static float expected(const cdl_SceneGrid *grid, uint32_t c, const uint32_t voxel[3]) {
  int32_t at[3];
  for (int k = 0; k < 3; k++)
    at[k] = grid->low[k] + (int32_t)(voxel[k] < grid->size[k] ? voxel[k] : grid->size[k] - 1);
  return dense_at(c, at[0], at[1], at[2]);
}

/* Every value of a brick, with its ninth ones, and its range. */
static void check_brick(const cdl_SceneGrid *grid, const uint32_t brick[3]) {
  size_t entry = ((size_t)brick[2] * grid->bricks[1] + brick[1]) * grid->bricks[0] + brick[0];
  uint32_t number = grid->table[entry];
  float least = INFINITY, most = -INFINITY;
  assert_true(number == CDL_NONE || number < grid->brick_count);
  for (uint32_t i = 0; i < grid->channels * GRID_VALUES; i++) {
    uint32_t c = i / GRID_VALUES, v = i % GRID_VALUES;
    const uint32_t voxel[3] = {8 * brick[0] + v % 9, 8 * brick[1] + v / 9 % 9,
                               8 * brick[2] + v / 81};
    float wanted = expected(grid, c, voxel);
    least = fminf(least, wanted), most = fmaxf(most, wanted);
    float got =
        number == CDL_NONE ? 0 : grid->values[(size_t)number * grid->channels * GRID_VALUES + i];
    if (got != wanted)
      fail_msg("voxel %u %u %u: %g, not %g", voxel[0], voxel[1], voxel[2], got, wanted);
  }
  assert_true((number == CDL_NONE) == (most == 0));
  assert_true(grid->least[entry] == least && grid->most[entry] == most);
}

static void check_grid(const GridSource *source, const int32_t low[3], const uint32_t size[3]) {
  cdl_SceneGrid grid;
  const char *why;
  float least = INFINITY, most = 0;
  assert_int_equal(grid_build(source, low, size, ROOM, &grid, &why), CDL_OK);
  uint32_t brick[3];
  for (int k = 0; k < 3; k++) assert_int_equal(grid.bricks[k], (size[k] + 7) / 8);
  for (brick[2] = 0; brick[2] < grid.bricks[2]; brick[2]++)
    for (brick[1] = 0; brick[1] < grid.bricks[1]; brick[1]++)
      for (brick[0] = 0; brick[0] < grid.bricks[0]; brick[0]++) check_brick(&grid, brick);
  for (uint32_t i = 0; i < grid.bricks[0] * grid.bricks[1] * grid.bricks[2]; i++) {
    least = fminf(least, grid.least[i]);
    most = fmaxf(most, grid.most[i]);
  }
  assert_true(grid.minimum == least && grid.maximum == most);
  grid_free(&grid);
}

static void begin(GridSource *source, uint32_t channels, const int32_t low[3],
                  const int32_t high[3]) {
  const char *why = "";
  assert_int_equal(grid_source_begin(source, channels, low, high, 512, 512, &why), CDL_OK);
}

static void test_bricks(void **state) {
  (void)state;
  for (int n = 0; n < 60; n++) {
    GridSource source;
    int32_t low[3], high[3], other[3];
    uint32_t size[3], cut[3], channels = n % 3 == 0 ? 3 : 1;
    for (int k = 0; k < 3; k++) {
      low[k] = (int32_t)below(SPAN) - SPAN / 2;
      high[k] = low[k] + (int32_t)below((uint32_t)(SPAN / 2 - low[k]));
      size[k] = (uint32_t)(high[k] - low[k]) + 1;
      other[k] = low[k] + (int32_t)below(20) - 10;
      cut[k] = 1 + below(30);
    }
    fill_dense(channels, low, high);
    begin(&source, channels, low, high);
    give_all(&source);
    check_grid(&source, low, size);
    check_grid(&source, other, cut); /* the box of another grid */
    grid_source_free(&source);
  }
}

/* A voxel that is the first of its brick is seen by eight. */
static void test_apron(void **state) {
  (void)state;
  const int32_t low[3] = {0, 0, 0}, high[3] = {15, 15, 15};
  const uint32_t size[3] = {16, 16, 16};
  GridSource source;
  cdl_SceneGrid grid;
  const char *why;
  memset(&dense, 0, sizeof dense);
  dense.channels = 1;
  dense.values[0][SPAN / 2 + 8][SPAN / 2 + 8][SPAN / 2 + 8] = 5;
  begin(&source, 1, low, high);
  give_all(&source);
  assert_int_equal(grid_build(&source, low, size, ROOM, &grid, &why), CDL_OK);
  assert_int_equal(grid.brick_count, 8);
  for (uint32_t i = 0; i < 8; i++) assert_true(grid.most[i] == 5 && grid.least[i] == 0);
  grid_free(&grid);
  grid_source_free(&source);
}

/* What is the same everywhere is stored once, and costs no time either. */
static void test_uniform(void **state) {
  (void)state;
  const int32_t low[3] = {-1024, 0, 0}, high[3] = {1023, 2047, 2047};
  const uint32_t size[3] = {2048, 2048, 2048};
  GridSource source;
  cdl_SceneGrid grid;
  const char *why;
  const float value = 0.5f;
  begin(&source, 1, low, high);
  for (int32_t z = 0; z < 2048; z += 1024)
    for (int32_t y = 0; y < 2048; y += 1024)
      for (int32_t x = -1024; x < 1024; x += 1024) {
        const int32_t origin[3] = {x, y, z};
        assert_int_equal(grid_source_tile(&source, origin, 1024, &value, &why), CDL_OK);
      }
  assert_int_equal(grid_build(&source, low, size, ROOM, &grid, &why), CDL_OK);
  assert_int_equal(grid.brick_count, 1);
  assert_true(grid.minimum == 0.5f && grid.maximum == 0.5f);
  grid_free(&grid);
  grid_source_free(&source);
}

static void test_negative(void **state) {
  (void)state;
  const int32_t low[3] = {0, 0, 0}, high[3] = {7, 7, 7};
  GridSource source;
  const char *why = "";
  float values[GRID_LEAF] = {-1, 2, -0.0f, -3};
  begin(&source, 1, low, high);
  assert_int_equal(grid_source_leaf(&source, low, values, &why), CDL_OK);
  assert_int_equal(source.negative, 2);
  assert_true(source.lowest == -3 && source.leaves[0] == 0 && source.leaves[1] == 2);
  grid_source_free(&source);
}

/* What a damaged file may say. */
static void test_refused(void **state) {
  (void)state;
  const int32_t low[3] = {-4, 0, 0}, high[3] = {20, 7, 7}, far[3] = {1 << 29, 7, 7};
  const int32_t origins[4][3] = {{-16, 0, 0}, {24, 0, 0}, {1, 0, 0}, {0, 8, 0}};
  const int32_t wide[3] = {1 << 20, 1 << 20, 7}, first[3] = {0, 0, 0};
  GridSource source;
  const char *why;
  float values[GRID_LEAF] = {0}, bad[GRID_LEAF] = {INFINITY};
  assert_int_equal(grid_source_begin(&source, 1, high, low, 1, 1, &why), CDL_BAD_INPUT);
  grid_source_free(&source);
  assert_int_equal(grid_source_begin(&source, 1, low, far, 1, 1, &why), CDL_BAD_INPUT);
  grid_source_free(&source);
  assert_int_equal(grid_source_begin(&source, 1, low, wide, 1, 1, &why), CDL_BAD_INPUT);
  grid_source_free(&source);
  begin(&source, 1, low, high);
  for (int i = 0; i < 4; i++) {
    assert_int_equal(grid_source_leaf(&source, origins[i], values, &why), CDL_BAD_INPUT);
    assert_int_equal(grid_source_tile(&source, origins[i], 8, values, &why), CDL_BAD_INPUT);
  }
  assert_int_equal(grid_source_tile(&source, first, 1u << 31, values, &why), CDL_BAD_INPUT);
  assert_int_equal(grid_source_tile(&source, first, 12, values, &why), CDL_BAD_INPUT);
  assert_int_equal(grid_source_leaf(&source, first, bad, &why), CDL_BAD_INPUT);
  assert_int_equal(grid_source_leaf(&source, first, values, &why), CDL_BAD_INPUT); /* twice */
  grid_source_free(&source);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bricks), cmocka_unit_test(test_apron), cmocka_unit_test(test_uniform),
      cmocka_unit_test(test_negative), cmocka_unit_test(test_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
