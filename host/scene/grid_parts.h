/* grid_parts.h: what grid.c and grid_build.c share. */
#ifndef CANDELA_SCENE_GRID_PARTS_H
#define CANDELA_SCENE_GRID_PARTS_H

#include "abi/types.h"
#include "scene/grid.h"

/* A slot of GridSource is CDL_NONE for a block without values, the number of a leaf, or, with this
 * bit, that of a tile. */
#define GRID_TILE 0x40000000u

/* Indices of voxels beyond this are refused: sums of them stay integers of 32 bits, and floats of
 * a transform keep a part of a voxel. */
#define GRID_INDEX_MAX (1 << 28)

#endif
