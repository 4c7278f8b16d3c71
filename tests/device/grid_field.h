/* grid_field.h: dense fields and what light does in them, in double precision, for tests of grids.
 * It knows no bricks: those are what is tested. */
#ifndef CANDELA_TESTS_GRID_FIELD_H
#define CANDELA_TESTS_GRID_FIELD_H

#include <stdint.h>

#include "abi/medium.h"

typedef enum FieldKind {
  FIELD_CONSTANT,
  FIELD_RAMP,    /* from 0 to 1 along x */
  FIELD_STEP,    /* 1 in a box in the middle, 0 around it */
  FIELD_CHECKER, /* bricks in turns empty and random */
  FIELD_SPARSE,  /* one voxel in 40 random, the others 0 */
  FIELD_RARE,    /* one voxel in 40000 */
  FIELD_NOISE,   /* every voxel random */
  FIELD_EMPTY,
  FIELD_KINDS
} FieldKind;

/* Voxels channel by channel, x fastest; the caller frees `values`. */
typedef struct Field {
  uint32_t size[3], channels;
  float *values;
} Field;

Field field_make(FieldKind kind, const uint32_t size[3], uint32_t channels, float scale,
                 uint32_t seed);

float field_voxel(const Field *field, uint32_t channel, int x, int y, int z);

/* Interpolated between the centres of voxels, as the outermost ones beyond them. */
double field_value(const Field *field, uint32_t channel, const double r[3]);

/* A ray as it is given to the device. */
typedef struct FieldRay {
  float origin[3], from, direction[3], to;
} FieldRay;

/* Origin and direction in index space. */
void field_place(const cdl_Medium *medium, const FieldRay *ray, double origin[3],
                 double direction[3]);

/* The part [*first, *last] of a ray of index space in the box of `size` voxels, grown by `margin`
 * voxels on every side; *last <= *first where there is none. */
void field_clip(const uint32_t size[3], const double origin[3], const double direction[3],
                double margin, double *first, double *last);

/* The next of a fixed sequence of numbers in [0, 1). */
double field_random(uint32_t *state);

enum { FIELD_CELLS = 16 };

/* What becomes of light along a ray, by channel, if the path has throughput 1. */
typedef struct FieldTruth {
  double first, last;               /* m, where the ray is in the box */
  double through[3];                /* transmittance */
  double scattered[3][FIELD_CELLS]; /* in as many equal lengths of [first, last] */
  double glow[3];
  double reached[FIELD_CELLS + 1]; /* transmittance of the first channel at each border */
} FieldTruth;

/* Radiance by temperature in kelvin. */
typedef void (*FieldColor)(double kelvin, double rgb[3]);

/* heat and color may be NULL. */
FieldTruth field_truth(const cdl_Medium *medium, const Field *density, const Field *heat,
                       const Field *color, FieldColor radiance, const FieldRay *ray);

#endif
