/* phase.h: how a medium turns light around: Henyey and Greenstein's phase function (1941).
 *
 * `direction` is that of propagation before the event, `wi` that of the path after it, both
 * pointing the way the path is traced; cosine = dot(direction, wi), so 1 is straight on and g > 0
 * favours it. Values integrate to 1 over the sphere, and sampling follows them: the weight is
 * always 1. */
#ifndef CDL_MEDIA_PHASE_H
#define CDL_MEDIA_PHASE_H

#include "lib/frame.h"
#include "lib/math.h"
#include "lib/vec.h"

/* (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) with 1 - cos or, for g < 0, 1 + cos given, so that
 * the narrow peak of |g| near 1 has no cancellation. `g` is |g| < 1. */
CDL_INLINE float phase_hg_from_rest(float rest, float g) {
  float d = fma(2.0f * g, rest, math_sqr(1.0f - g));
  return CDL_INV_4PI * (1.0f - g) * (1.0f + g) / (d * sqrt(d));
}

/* Value and pdf, per steradian; -1 <= cosine <= 1, |g| < 1. */
CDL_INLINE float phase_hg(float cosine, float g) {
  float rest = math_max(1.0f - math_mulsign(cosine, g), 0.0f);
  return phase_hg_from_rest(rest, math_abs(g));
}

typedef struct PhaseSample {
  vec3 wi;
  float pdf;    /* and value, per steradian */
  float cosine; /* dot(direction, wi) */
} PhaseSample;

/* A direction after scattering; u, v in [0,1).
 * Inverting the distribution gives, with every factor positive and no division by g,
 * 1 - cos = 2 u (1 - g)^2 (1 + g (1 - u)) / (1 - g + 2 g (1 - u))^2 for g >= 0. */
CDL_INLINE PhaseSample phase_hg_sample(vec3 direction, float g, float u, float v) {
  float a = math_abs(g);
  float left = 1.0f - u;
  float q = (1.0f - a) / fma(2.0f * a, left, 1.0f - a);
  float rest = math_clamp(2.0f * u * q * q * fma(a, left, 1.0f), 0.0f, 2.0f);
  float radius = math_safe_sqrt(rest * (2.0f - rest));
  float sine, cosine;
  math_sincos_2pi(v, &sine, &cosine);
  PhaseSample sample;
  sample.cosine = math_mulsign(1.0f - rest, g);
  sample.wi = frame_to_world(frame_from_normal(direction),
                             v3(radius * cosine, radius * sine, sample.cosine));
  sample.pdf = phase_hg_from_rest(rest, a);
  return sample;
}

#endif
