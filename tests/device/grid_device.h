/* grid_device.h: fields as grids on a device, for tests of them. The bricks are cut here, by the
 * layout that abi/grid.h states, apart from what packs scenes. */
#ifndef CANDELA_TESTS_GRID_DEVICE_H
#define CANDELA_TESTS_GRID_DEVICE_H

#include <stddef.h>

#include "abi/grid.h"
#include "tests/device/grid_field.h"
#include "tests/device/harness.h"

enum { SET_GRIDS = 4 };

/* Grids with one medium that they fill. Numbers 0 and up in the order of addition. */
typedef struct GridSet {
  cdl_Medium medium;
  cdl_Grid grids[SET_GRIDS];
  uint32_t count;
  uint32_t *table;
  float *most, *values, *blackbody;
  size_t entries, most_count, bricks; /* bricks: numbers of CDL_GRID_VALUES */
} GridSet;

/* The box is a unit cube or what is like `size` about the origin; `turn` rotates and shears it. */
GridSet grid_set_make(const uint32_t size[3], double turn);

/* Returns the grid's number. Unused values are NaN, so that a stray look-up shows. */
uint32_t grid_set_add(GridSet *set, const Field *field);

/* Loosens what bounds the values, by a factor. */
void grid_set_loosen(GridSet *set, float factor);

void grid_set_free(GridSet *set);

/* Rays of all kinds about the set's first grid: anything, along axes and nearly so, from planes of
 * bricks, of far-off lengths. `raw`: the world is its index space. */
FieldRay grid_random_ray(uint32_t *state, const GridSet *set, int raw);

/* The device of all tests of grids, as cmocka wants it. */
int grid_device_open(void **state);
int grid_device_close(void **state);

/* Runs a kernel of grids.cl on the set's arrays and three further ones. */
void grid_run(const char *kernel, size_t items, const GridSet *set, HarnessBuffer points,
              HarnessBuffer in, HarnessBuffer out);

/* Any kernel of grids.cl. */
void grid_run_plain(const char *kernel, size_t items, const HarnessBuffer *buffers, size_t count);

#endif
