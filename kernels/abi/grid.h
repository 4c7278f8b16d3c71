/* grid.h: sparse grids of values, as participating media have them.
 *
 * Voxel i of an axis has its centre at i in index space, so a grid of `size` voxels reaches from
 * -1/2 to size - 1/2. Between centres values are interpolated, beyond the last ones they are those
 * of the last, outside of the grid 0.
 *
 * Cells, from one centre to the next, are kept in bricks of 8 along each axis, which hold the
 * values at both ends: one look-up meets one brick. Where all is 0 there is no brick. */
#ifndef CDL_ABI_GRID_H
#define CDL_ABI_GRID_H

#include "abi/types.h"

#define CDL_GRID_CELLS 8u              /* of a brick, along an axis */
#define CDL_GRID_SIDE 9u               /* values of a brick, along an axis */
#define CDL_GRID_VALUES (9u * 9u * 9u) /* of a channel of a brick, x fastest */
#define CDL_GRID_BLOCK 4u              /* bricks of a block, along an axis */

/* The grids of one medium have the same size, and so the same bricks and blocks. In grid_table is,
 * by brick, x fastest, the number of its first channel's CDL_GRID_VALUES in grid_values, further
 * channels following, or CDL_NONE. In grid_most is the largest value of each brick, and of each
 * block of bricks, both x fastest. Values are not negative. */
typedef struct cdl_Grid {
  uint size[3];     /* voxels */
  uint channels;    /* 1 or 3 */
  uint bricks[3];   /* along each axis */
  uint first_brick; /* in grid_table and grid_most */
  uint blocks[3];   /* along each axis */
  uint first_block; /* in grid_most */
} cdl_Grid;
CDL_ABI_SIZE(cdl_Grid, 48);

/* Collisions are counted in as many places, so that paths seldom meet at one; even words count real
 * ones, odd words null ones. */
#define CDL_COLLISION_COUNTERS 64u

/* Radiance of black bodies in linear sRGB by temperature, as the table `blackbody` has it: every
 * CDL_BLACKBODY_STEP kelvin from 0 on, 3 floats each. */
#define CDL_BLACKBODY_STEP 4.0f
#define CDL_BLACKBODY_COUNT 4096u

#endif
