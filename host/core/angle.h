/* angle.h: trigonometry for what reaches the film, by the kernels' own functions.
 *
 * The C library picks its variants by the processor, and they differ in the last bit; these give
 * the same everywhere. Results are floats, as all that kernels are handed. */
#ifndef CANDELA_CORE_ANGLE_H
#define CANDELA_CORE_ANGLE_H

#include "lib/math.h"

/* Sine and cosine of finite radians; 2 ulp for the angle that is rounded to float once it is a part
 * of a turn. Quarter turns give exactly 0 and +-1. */
static inline void angle_sincos(double radians, float *sine, float *cosine) {
  double turns = radians / (2 * M_PI);
  math_sincos_2pi((float)(turns - rint(turns)), sine, cosine);
}

static inline double angle_sin(double radians) {
  float sine, cosine;
  angle_sincos(radians, &sine, &cosine);
  return sine;
}

static inline double angle_tan(double radians) {
  float sine, cosine;
  angle_sincos(radians, &sine, &cosine);
  return (double)sine / cosine;
}

/* 1 - cos, without the cancellation near 0. */
static inline double angle_versine(double radians) {
  double sine = angle_sin(radians / 2);
  return 2 * sine * sine;
}

/* The angle between two vectors of equal length from the lengths of their difference and of their
 * sum (Kahan 2006): as exact for tiny angles as for others, and a right angle where one is 0. */
static inline double angle_between(double difference, double sum) {
  return 2.0 * math_atan2((float)difference, (float)sum);
}

#endif
