#include "tests/device/grid_device.h"

#include <stdarg.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static Harness *harness;

/* ---- bricks ---- */

static void *grow(void *array, size_t count, size_t more, size_t element) {
  array = realloc(array, (count + more + 1) * element);
  assert_non_null(array);
  return array;
}

GridSet grid_set_make(const uint32_t size[3], double turn) {
  GridSet set = {.medium = {.density = CDL_NONE, .temperature = CDL_NONE, .color = CDL_NONE}};
  double c = cos(turn), s = sin(turn), shear = 0.3 * s;
  double rows[3][3] = {{c, -s, shear}, {s * c, c * c, -s}, {s * s, c * s, c}};
  uint32_t longest = size[0] > size[1] ? size[0] : size[1];
  longest = size[2] > longest ? size[2] : longest;
  for (int r = 0; r < 3; r++) {
    for (int k = 0; k < 3; k++) set.medium.to_grid[4 * r + k] = (float)(longest * rows[r][k]);
    set.medium.to_grid[4 * r + 3] = 0.5f * ((float)size[r] - 1);
  }
  set.medium.temperature_scale = 1;
  set.most = grow(NULL, 0, 0, sizeof *set.most);
  set.table = grow(NULL, 0, 0, sizeof *set.table);
  set.blackbody = grow(NULL, 0, 3 * CDL_BLACKBODY_COUNT, sizeof *set.blackbody);
  memset(set.blackbody, 0, 3 * CDL_BLACKBODY_COUNT * sizeof *set.blackbody);
  /* a brick that nothing may look at */
  set.values = grow(NULL, 0, CDL_GRID_VALUES, sizeof *set.values);
  for (size_t i = 0; i < CDL_GRID_VALUES; i++) set.values[i] = NAN;
  set.bricks = 1;
  return set;
}

static float cut_channel(const Field *field, uint32_t channel, const uint32_t brick[3],
                         float *values) {
  float most = 0;
  for (int z = 0; z < 9; z++)
    for (int y = 0; y < 9; y++)
      for (int x = 0; x < 9; x++) {
        *values = field_voxel(field, channel, (int)(8 * brick[0]) + x, (int)(8 * brick[1]) + y,
                              (int)(8 * brick[2]) + z);
        most = fmaxf(most, *values++);
      }
  return most;
}

/* Cuts one brick and keeps it if it is not empty. */
static void add_brick(GridSet *set, const cdl_Grid *grid, const Field *field,
                      const uint32_t brick[3]) {
  size_t at = ((size_t)brick[2] * grid->bricks[1] + brick[1]) * grid->bricks[0] + brick[0];
  size_t block = ((size_t)(brick[2] / 4) * grid->blocks[1] + brick[1] / 4) * grid->blocks[0];
  float most = 0, *blocks = set->most + grid->first_block;
  set->values = grow(set->values, set->bricks * CDL_GRID_VALUES,
                     (field->channels + 1) * CDL_GRID_VALUES, sizeof *set->values);
  float *values = set->values + set->bricks * CDL_GRID_VALUES;
  for (uint32_t c = 0; c < field->channels; c++)
    most = fmaxf(most, cut_channel(field, c, brick, values + c * CDL_GRID_VALUES));
  set->table[grid->first_brick + at] = most > 0 ? (uint32_t)set->bricks : CDL_NONE;
  set->most[grid->first_brick + at] = most;
  blocks[block + brick[0] / 4] = fmaxf(blocks[block + brick[0] / 4], most);
  if (!(most > 0)) return;
  set->bricks += field->channels;
  if (set->bricks % 5) return; /* a gap now and then */
  values += field->channels * CDL_GRID_VALUES;
  for (size_t i = 0; i < CDL_GRID_VALUES; i++) values[i] = NAN;
  set->bricks++;
}

uint32_t grid_set_add(GridSet *set, const Field *field) {
  assert_true(set->count < SET_GRIDS);
  cdl_Grid *grid = &set->grids[set->count];
  size_t bricks = 1, blocks = 1;
  for (int k = 0; k < 3; k++) {
    grid->size[k] = field->size[k];
    bricks *= grid->bricks[k] = (field->size[k] + 7) / 8;
    blocks *= grid->blocks[k] = (grid->bricks[k] + 3) / 4;
  }
  /* table and bounds of bricks keep the same numbers, so bounds of blocks leave a hole in the table
   */
  grid->channels = field->channels;
  grid->first_brick = (uint32_t)set->most_count;
  grid->first_block = (uint32_t)(set->most_count + bricks);
  set->most = grow(set->most, set->most_count, bricks + blocks, sizeof *set->most);
  set->table = grow(set->table, set->most_count, bricks + blocks, sizeof *set->table);
  for (size_t i = 0; i < bricks + blocks; i++) {
    set->most[set->most_count + i] = 0;
    set->table[set->most_count + i] = 0;
  }
  set->most_count += bricks + blocks;
  set->entries = set->most_count;
  uint32_t at[3];
  for (at[2] = grid->bricks[2]; at[2]-- > 0;)
    for (at[1] = 0; at[1] < grid->bricks[1]; at[1]++)
      for (at[0] = grid->bricks[0]; at[0]-- > 0;) add_brick(set, grid, field, at);
  return set->count++;
}

void grid_set_loosen(GridSet *set, float factor) {
  for (size_t i = 0; i < set->most_count; i++) set->most[i] *= factor;
}

void grid_set_free(GridSet *set) {
  free(set->table);
  free(set->most);
  free(set->values);
  free(set->blackbody);
}

/* ---- rays ---- */

static double spread(uint32_t *state, double low, double high) {
  return low + (high - low) * field_random(state);
}

static const float specials[] = {0, 0, 0, 1e-41f, -1e-39f, -1e-38f, 1e-30f, -1e-20f, 1, -1};

FieldRay grid_random_ray(uint32_t *state, const GridSet *set, int raw) {
  FieldRay ray = {.from = 0, .to = INFINITY};
  const uint32_t *size = set->grids[0].size;
  int kind = (int)(4 * field_random(state));
  double scale = kind == 3 ? exp2(spread(state, -90, 90)) : 1;
  for (int k = 0; k < 3; k++) {
    double at =
        raw ? spread(state, -0.5 * size[k] - 2, 1.5 * size[k] + 2) : spread(state, -1.2, 1.2);
    if (raw && field_random(state) < 0.4) at = 8 * rint(at / 8);
    if (raw && field_random(state) < 0.1) at = field_random(state) < 0.5 ? -0.5 : size[k] - 0.5;
    double d = spread(state, -1, 1);
    if (kind == 1) d = specials[(int)(sizeof specials / sizeof *specials * field_random(state))];
    if (kind == 2 && field_random(state) < 0.5) d = rint(d);
    ray.origin[k] = (float)at;
    ray.direction[k] = (float)(d * scale);
  }
  double near = spread(state, 0, 1) * (raw ? size[0] : 1) / scale;
  if (field_random(state) < 0.3) ray.from = (float)near;
  if (field_random(state) < 0.3) ray.to = (float)(ray.from + near);
  return ray;
}

/* ---- device ---- */

int grid_device_open(void **state) {
  (void)state;
  static char text[1 << 16];
  harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  FILE *file = fopen("tests/device/grids.cl", "rb");
  if (!harness || !file) fail_msg("no device, or no tests/device/grids.cl");
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  harness_build(harness, text);
  return 0;
}

int grid_device_close(void **state) {
  (void)state;
  harness_close(harness);
  return 0;
}

void grid_run(const char *kernel, size_t items, const GridSet *set, HarnessBuffer points,
              HarnessBuffer in, HarnessBuffer out) {
  cdl_Medium medium = set->medium;
  cdl_Grid grids[SET_GRIDS];
  memcpy(grids, set->grids, sizeof grids);
  HarnessBuffer buffers[] = {
      {&medium, sizeof medium},
      {grids, sizeof grids},
      {set->table, (set->entries + 1) * sizeof *set->table},
      {set->most, (set->most_count + 1) * sizeof *set->most},
      {set->values, set->bricks * CDL_GRID_VALUES * sizeof *set->values},
      {set->blackbody, 3 * CDL_BLACKBODY_COUNT * sizeof *set->blackbody},
      points,
      in,
      out,
  };
  harness_run(harness, kernel, items, buffers, sizeof buffers / sizeof *buffers);
}

void grid_run_plain(const char *kernel, size_t items, const HarnessBuffer *buffers, size_t count) {
  harness_run(harness, kernel, items, buffers, count);
}
