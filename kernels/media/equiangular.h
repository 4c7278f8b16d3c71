/* equiangular.h: distances along a ray that see a point at evenly spread angles, so that what a
 * lamp in thin fog scatters, radiance over squared distance, is sampled as it lies (Kulla and
 * Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media"). */
#ifndef CDL_MEDIA_EQUIANGULAR_H
#define CDL_MEDIA_EQUIANGULAR_H

#include "lib/math.h"
#include "lib/vec.h"

typedef struct EquiAngular {
  float chance;    /* of drawing a distance like this and not by the transmittance; 0: none */
  float along;     /* where the ray comes nearest to the point, m */
  float offset;    /* how near, m, > 0 */
  float low, high; /* angles at which the stretch begins and ends, seen from the point */
} EquiAngular;

/* The most of all distances: what lies behind the fog must be found as well. */
#define EQUIANGULAR_MOST 0.25f

CDL_INLINE EquiAngular equiangular_none(void) {
  EquiAngular e = {0.0f, 0.0f, 1.0f, 0.0f, 1.0f};
  return e;
}

/* For the stretch from `origin` to `t_max` metres along the unit `direction`, which may be
 * infinite. In thick media the transmittance says more than the lamp does: the chance falls with
 * what the mean extinction `sigma` leaves of light from there. */
CDL_INLINE EquiAngular equiangular_toward(vec3 point, vec3 origin, vec3 direction, float t_max,
                                          float sigma) {
  EquiAngular e;
  vec3 to_point = v3_sub(point, origin);
  e.along = v3_dot(to_point, direction);
  vec3 aside = v3_madd(to_point, -e.along, direction);
  float distance = v3_length(to_point);
  e.offset = math_max(v3_length(aside), math_max(1e-4f * distance, 1e-20f));
  e.low = math_atan2(-e.along, e.offset);
  e.high = math_atan2(t_max - e.along, e.offset);
  int wide = e.high - e.low > 1e-4f;
  e.chance = wide ? EQUIANGULAR_MOST * math_exp(-sigma * distance) : 0.0f;
  e.high = wide ? e.high : e.low + 1.0f;
  return e;
}

CDL_INLINE float equiangular_sample(EquiAngular e, float t_max, float u) {
  float sine, cosine;
  math_sincos(math_lerp(e.low, e.high, u), &sine, &cosine);
  float t = fma(e.offset, sine / math_max(cosine, 1e-7f), e.along);
  return math_clamp(t, 0.0f, t_max);
}

/* Per metre. */
CDL_INLINE float equiangular_pdf(EquiAngular e, float t) {
  float from = (t - e.along) / e.offset;
  return 1.0f / ((e.high - e.low) * e.offset * fma(from, from, 1.0f));
}

#endif
