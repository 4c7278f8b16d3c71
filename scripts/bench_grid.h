/* bench_grid.h: the smoke that bench_grid looks values up in, and NanoVDB's builder in C++. */
#ifndef CANDELA_BENCH_GRID_H
#define CANDELA_BENCH_GRID_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Density of voxel (x, y, z) of `side` along each axis: a plume, mostly empty around it. */
float bench_smoke(int side, int x, int y, int z);

/* A grid of NanoVDB, `*size` bytes, aligned for it; free() it. */
void *bench_nanovdb(int side, size_t *size);

#ifdef __cplusplus
}
#endif
#endif
