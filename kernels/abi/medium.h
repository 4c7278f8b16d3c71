/* medium.h: participating media. */
#ifndef CDL_ABI_MEDIUM_H
#define CDL_ABI_MEDIUM_H

#include "abi/types.h"

#define CDL_MEDIUM_VACUUM 0u /* index of the medium that is none */

/* A medium at its place: what a grid fills is another medium for every node that holds it. */
typedef struct cdl_Medium {
  float absorption[3]; /* 1/m; with a grid: where the density is 1 */
  uint emissive;       /* 1: emission is not black */
  float scattering[3]; /* 1/m, likewise */
  uint density;        /* index into the grids; CDL_NONE: the same everywhere */
  float emission[3];   /* radiance per metre */
  float second;        /* weight of the phase function's second lobe, [0,1] */
  float g[2];          /* asymmetry of its lobes, (-1,1); > 0 is forward */
  float alpha[2];      /* Draine's parameter of its lobes, [0, 1e6]; 0 is Henyey and Greenstein's */
  float to_grid[12];   /* world to index space of the density grid, 3x4, row-major */
  uint temperature;    /* index into the grids, or CDL_NONE */
  uint color;          /* index of a grid of colours, which multiply the scattering, or CDL_NONE */
  float temperature_scale; /* kelvin for 1 in the grid */
  uint walk; /* 1: the inside of a subsurface material; its collisions belong to one event */
} cdl_Medium;
CDL_ABI_SIZE(cdl_Medium, 128);

#endif
