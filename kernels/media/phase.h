/* phase.h: how a medium turns light around: a mixture of two lobes of Draine's phase function
 * (2003), (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) (1 + alpha cos^2) / (1 + alpha (1 + 2 g^2) /
 * 3). Its lobe is Henyey and Greenstein's (1941) where alpha is 0, Rayleigh's where g is 0 and
 * alpha 1, and isotropic where both are 0; water droplets are one lobe of each kind (Jendersie and
 * d'Eon 2023).
 *
 * `direction` is that of propagation before the event, `wi` that of the path after it, both
 * pointing the way the path is traced; cosine = dot(direction, wi), so 1 is straight on and g > 0
 * favours it. Values integrate to 1 over the sphere, and sampling follows them: the weight is
 * always 1. */
#ifndef CDL_MEDIA_PHASE_H
#define CDL_MEDIA_PHASE_H

#include "abi/medium.h"
#include "lib/frame.h"
#include "lib/math.h"
#include "lib/vec.h"

#ifndef CDL_DRAINE
#define CDL_DRAINE 1 /* 0: no medium has a second lobe, or an alpha above 0 */
#endif

typedef struct Phase {
  float g0, g1;         /* (-1,1) */
  float alpha0, alpha1; /* [0, 1e6] */
  float second;         /* weight of lobe 1 */
} Phase;

typedef struct PhaseSample {
  vec3 wi;
  float pdf;    /* and value, per steradian */
  float cosine; /* dot(direction, wi) */
} PhaseSample;

CDL_INLINE Phase phase_of(CDL_GLOBAL const cdl_Medium *medium) {
  Phase phase;
  phase.g0 = medium->g[0];
  phase.g1 = medium->g[1];
  phase.alpha0 = medium->alpha[0];
  phase.alpha1 = medium->alpha[1];
  phase.second = medium->second;
  return phase;
}

/* ---- values ---- */

/* (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) with 1 - cos or, for g < 0, 1 + cos given, so that
 * the narrow peak of |g| near 1 has no cancellation. `g` is |g| < 1. */
CDL_INLINE float phase_hg_from_rest(float rest, float g) {
  float d = fma(2.0f * g, rest, math_sqr(1.0f - g));
  return CDL_INV_4PI * (1.0f - g) * (1.0f + g) / (d * sqrt(d));
}

/* 1 + alpha (1 + 2 g^2) / 3: what 1 + alpha cos^2 is on average over Henyey and Greenstein's lobe.
 */
CDL_INLINE float phase_draine_norm(float g, float alpha) {
  return fma(alpha, fma(2.0f * g, g, 1.0f) * 0.333333343f, 1.0f);
}

/* A lobe's value, per steradian; `forward` is 1 - cosine, `backward` 1 + cosine. */
CDL_INLINE float phase_lobe(float forward, float backward, float cosine, float g, float alpha) {
  float a = math_abs(g);
  float hg = phase_hg_from_rest(g < 0.0f ? backward : forward, a);
  float factor = fma(alpha * cosine, cosine, 1.0f) / phase_draine_norm(a, alpha);
  return CDL_DRAINE ? hg * factor : hg;
}

CDL_INLINE float phase_mixture(Phase phase, float forward, float backward, float cosine) {
  float first = phase_lobe(forward, backward, cosine, phase.g0, phase.alpha0);
  float second = phase_lobe(forward, backward, cosine, phase.g1, phase.alpha1);
  float mixed = (1.0f - phase.second) * first + phase.second * second;
  return CDL_DRAINE ? mixed : first;
}

/* Value and pdf, per steradian; -1 <= cosine <= 1, beyond that the value there. */
CDL_INLINE float phase_value(Phase phase, float cosine) {
  float c = math_clamp(cosine, -1.0f, 1.0f);
  return phase_mixture(phase, 1.0f - c, 1.0f + c, c);
}

/* ---- sampling ----
 *
 * Let x be the share of Henyey and Greenstein's lobe, g >= 0, that is nearer to straight on than a
 * direction. Inverting gives, with every factor positive and no division by g,
 * 1 - cos = 2 x q^2 (1 + g (1 - x)), q = (1 - g) / (1 - g + 2 g (1 - x)).
 * Of Draine's lobe the same directions hold the share F(x) / N, where N is phase_draine_norm and
 * F(x) = integral of 1 + alpha cos^2 from 0 to x
 *      = x (1 + alpha ((1 - (1 - g) x q)^2 + (1 - g^2) q (x q)^2 / 3)),
 * again without cancellation. F(x) = u N is a quartic in x q (and a cubic for g = 0). Its closed
 * form (Jendersie and d'Eon 2023) divides by g and subtracts what is nearly equal;
 * floats do not bear that. Here a cubic that agrees with F at its inflection, cos = 0, and at the
 * nearer end is solved instead, which is exact for g = 0, and three steps of Householder's method
 * of the third order lead to the root. They leave an error in u of at most 5e-7, and of 2e-6 for
 * alpha > 1000; that of x is small beside x. */

/* q of the above */
CDL_INLINE float phase_share_scale(float x, float g) {
  return (1.0f - g) / fma(2.0f * g, 1.0f - x, 1.0f - g);
}

/* 1 - cos where that share of Henyey and Greenstein's lobe ends */
CDL_INLINE float phase_hg_rest(float x, float g) {
  float left = 1.0f - x;
  float q = (1.0f - g) / fma(2.0f * g, left, 1.0f - g);
  return math_clamp(2.0f * x * q * q * fma(g, left, 1.0f), 0.0f, 2.0f);
}

/* F(x) of the above */
CDL_INLINE float phase_draine_share(float x, float q, float g, float alpha) {
  float y = x * q;
  float even = math_sqr(fma(-(1.0f - g), y, 1.0f));
  float odd = (1.0f - g) * (1.0f + g) * q * y * y * 0.333333343f;
  return x * fma(alpha, even + odd, 1.0f);
}

/* The root of t + b t^3 = c, b >= 0: Cardano's, with its difference of roots written as a quotient
 * of sums. */
CDL_INLINE float phase_cubic_root(float b, float c) {
  float h = 0.5f * math_abs(c) * sqrt(b);
  float w = h + sqrt(fma(h, h, 0.0370370373f));
  float y = math_exp2(0.666666687f * math_log2(w));
  return c / (y + 0.333333343f + 0.111111112f / y);
}

/* One step from x towards F(x) = target; F' = 1 + alpha cos^2. */
CDL_INLINE float phase_draine_step(float x, float target, float g, float alpha) {
  float q = phase_share_scale(x, g);
  float f = phase_draine_share(x, q, g, alpha) - target;
  float cosine = 1.0f - phase_hg_rest(x, g);
  /* derivatives of cos by x: -2 (1 + g) q^2 turns */
  float width = (1.0f - g) * (1.0f + g);
  float s = (1.0f + g) * q;
  float first = -2.0f * s * s * s / width;
  float second = first * 6.0f * g * s / width;
  float f1 = fma(alpha * cosine, cosine, 1.0f);
  float f2 = 2.0f * alpha * cosine * first;
  float f3 = 2.0f * alpha * fma(cosine, second, first * first);
  float above = fma(-0.5f * f, f2, f1 * f1);
  float below = fma(f1, fma(-f, f2, f1 * f1), f * f * f3 * 0.166666672f);
  return x - f * (below > 0.0f ? above / below : 1.0f / f1);
}

/* The share x of Henyey and Greenstein's lobe that goes with the share u of Draine's, g >= 0. */
CDL_INLINE float phase_draine_invert(float u, float g, float alpha) {
  float norm = phase_draine_norm(g, alpha);
  float target = u * norm;
  /* the density is nowhere more than (1 + alpha) / N times the other's */
  float least = norm / (1.0f + alpha);
  float low = u * least;
  float high = fma(u, least, 1.0f - least);
  float root = sqrt(fma(g, g, 1.0f));
  float middle = 0.5f * (1.0f + g) * (1.0f + root + g) / (root * (1.0f + root));
  float share = phase_draine_share(middle, phase_share_scale(middle, g), g, alpha);
  int before = target < share;
  float length = before ? middle : 1.0f - middle;
  float part = before ? share : norm - share;
  float bend = math_max(part / length - 1.0f, 0.0f);
  float x = fma(-length, phase_cubic_root(bend, (share - target) / length), middle);
  x = math_clamp(x, low, high);
  x = math_clamp(phase_draine_step(x, target, g, alpha), low, high);
  x = math_clamp(phase_draine_step(x, target, g, alpha), low, high);
  x = math_clamp(phase_draine_step(x, target, g, alpha), low, high);
  return CDL_DRAINE && alpha > 0.0f ? x : u;
}

/* A direction after scattering; u, v and w, which chooses the lobe, in [0,1). */
CDL_INLINE PhaseSample phase_sample(Phase phase, vec3 direction, float u, float v, float w) {
  int other = CDL_DRAINE && w < phase.second;
  float g = other ? phase.g1 : phase.g0;
  float a = math_abs(g);
  float rest = phase_hg_rest(phase_draine_invert(u, a, other ? phase.alpha1 : phase.alpha0), a);
  float radius = math_safe_sqrt(rest * (2.0f - rest));
  float sine, cosine;
  math_sincos_2pi(v, &sine, &cosine);
  PhaseSample sample;
  sample.cosine = math_mulsign(1.0f - rest, g);
  sample.wi = frame_to_world(frame_from_normal(direction),
                             v3(radius * cosine, radius * sine, sample.cosine));
  float far = 2.0f - rest;
  sample.pdf = phase_mixture(phase, g < 0.0f ? far : rest, g < 0.0f ? rest : far, sample.cosine);
  return sample;
}

#endif
