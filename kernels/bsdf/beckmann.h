/* beckmann.h: Beckmann's distribution of microfacet normals (Beckmann and Spizzichino 1963; Walter
 * et al. 2007), its Smith Lambda, and sampling of the normals that are visible. */
#ifndef CDL_BSDF_BECKMANN_H
#define CDL_BSDF_BECKMANN_H

#include "lib/math.h"
#include "lib/vec.h"

#define BECKMANN_INV_SQRT_PI 0.564189583f

/* exp(-80) counts as 0: beyond come denormals, on which processors take a hundred times as long. */
#define BECKMANN_EXPONENT_MAX 80.0f

/* D for a squared stretched slope s2 = (h.x / (alpha_x h.z))^2 + (h.y / (alpha_y h.z))^2: the
 * normalised form exp(-s2) / (pi alpha_x alpha_y cos^4). */
CDL_INLINE float beckmann_density(float s2, float cos_h, float alpha_x, float alpha_y) {
  float cos2 = cos_h * cos_h;
  float area = math_max(CDL_PI * alpha_x * alpha_y * cos2 * cos2, 1e-30f);
  float value = math_exp(-math_min(s2, BECKMANN_EXPONENT_MAX)) / area;
  return s2 < BECKMANN_EXPONENT_MAX ? value : 0.0f;
}

/* Smith's Lambda for a = 1 / (alpha tan(theta)) >= 0, not fitted: (exp(-a^2) / (a sqrt(pi)) -
 * erfc(a)) / 2, with erfc(a) exp(a^2) after Hastings (Abramowitz and Stegun 7.1.26). Absolute error
 * below 1e-7 + 1e-6 Lambda. */
CDL_INLINE float beckmann_lambda(float a) {
  a = math_clamp(a, 1e-30f, 6.0f); /* beyond, Lambda < 1e-18 */
  float t = 1.0f / fma(0.3275911f, a, 1.0f);
  float p = fma(fma(1.061405429f, t, -1.453152027f), t, 1.421413741f);
  p = fma(fma(p, t, -0.284496736f), t, 0.254829592f) * t;
  return math_max(0.5f * math_exp(-a * a) * (BECKMANN_INV_SQRT_PI / a - p), 0.0f);
}

/* Inverse of the error function, |x| < 1; relative error 4e-7 (Giles, "Approximating the erfinv
 * function", 2010, single precision). */
CDL_INLINE float beckmann_erf_inverse(float x) {
  float w = -math_log((1.0f - x) * (1.0f + x));
  float c = w - 2.5f;
  float p = fma(fma(2.81022636e-8f, c, 3.43273939e-7f), c, -3.5233877e-6f);
  p = fma(fma(p, c, -4.39150654e-6f), c, 0.00021858087f);
  p = fma(fma(p, c, -0.00125372503f), c, -0.00417768164f);
  p = fma(fma(p, c, 0.246640727f), c, 1.50140941f);
  float t = math_safe_sqrt(w) - 3.0f;
  float q = fma(fma(-0.000200214257f, t, 0.000100950558f), t, 0.00134934322f);
  q = fma(fma(q, t, -0.00367342844f), t, 0.00573950773f);
  q = fma(fma(q, t, -0.0076224613f), t, 0.00943887047f);
  q = fma(fma(q, t, 1.00167406f), t, 2.83297682f);
  return x * (w < 5.0f ? p : q);
}

/* The error function for x >= 0; absolute error 2e-7 (Abramowitz and Stegun 7.1.26). */
CDL_INLINE float beckmann_erf(float x) {
  float t = 1.0f / fma(0.3275911f, x, 1.0f);
  float p = fma(fma(1.061405429f, t, -1.453152027f), t, 1.421413741f);
  p = fma(fma(p, t, -0.284496736f), t, 0.254829592f) * t;
  return 1.0f - p * math_exp(-math_min(x * x, BECKMANN_EXPONENT_MAX));
}

/* Slopes beyond +-3.7, one facet in 10^7, are left out: erf has no further floats there. */
#define BECKMANN_ERF_LIMIT 0.9999998f

/* One Newton step for the visible slope: b = erf(slope), a = cot(theta), target = u times the
 * area that is visible. In b the equation (a (1 + b) + exp(-slope^2) / sqrt(pi)) / 2 = target is
 * well conditioned on both tails. */
CDL_INLINE float beckmann_slope_step(float b, float a, float limit, float target) {
  float slope = math_min(beckmann_erf_inverse(b), a);
  float area = 0.5f * fma(BECKMANN_INV_SQRT_PI, math_exp(-slope * slope), a * (1.0f + b));
  float step = (area - target) / math_max(0.5f * (a - slope), 1e-4f);
  return math_clamp(b - step, -BECKMANN_ERF_LIMIT, limit);
}

/* The slope along the view of a visible facet of roughness 1, a = cot(theta) > 0 (Heitz and d'Eon
 * 2014 state the density; Jakob 2014 inverts it by Newton's method in erf too). The start
 * b = B - (1 + B) (k r + (1 - k) r^2), r = sqrt(1 - u), has the right ends and the right square
 * root at u = 1. */
CDL_INLINE float beckmann_visible_slope(float a, float u) {
  a = math_min(a, 1e4f);
  float limit = math_min(beckmann_erf(a), BECKMANN_ERF_LIMIT);
  float e = math_exp(-math_min(a * a, BECKMANN_EXPONENT_MAX));
  float area = 0.5f * fma(BECKMANN_INV_SQRT_PI, e, a * (1.0f + limit));
  float r = math_safe_sqrt(1.0f - u);
  float root = 2.0f * BECKMANN_INV_SQRT_PI * sqrt(2.0f * area * e / BECKMANN_INV_SQRT_PI);
  float b = limit - r * fma(r, 1.0f + limit - root, root);
  b = math_clamp(b, -BECKMANN_ERF_LIMIT, limit);
  float target = u * area;
  b = beckmann_slope_step(b, a, limit, target);
  b = beckmann_slope_step(b, a, limit, target);
  b = beckmann_slope_step(b, a, limit, target);
  return beckmann_erf_inverse(b);
}

/* A visible normal for the unit vector w, w.z > 0, of a surface of roughness 1, not normalised. */
CDL_INLINE vec3 beckmann_visible_normal(vec3 w, float u, float v) {
  float sin2 = fma(w.x, w.x, w.y * w.y);
  float sine = sqrt(sin2);
  float inverse = 1.0f / (sine > 1e-12f ? sine : 1.0f);
  float cos_phi = sine > 1e-12f ? w.x * inverse : 1.0f;
  float sin_phi = sine > 1e-12f ? w.y * inverse : 0.0f;
  float along = beckmann_visible_slope(w.z / math_max(sine, 1e-12f), u);
  float across = beckmann_erf_inverse(
      math_clamp(fma(2.0f, v, -1.0f), -BECKMANN_ERF_LIMIT, BECKMANN_ERF_LIMIT));
  float slope_x = fma(cos_phi, along, -(sin_phi * across));
  float slope_y = fma(sin_phi, along, cos_phi * across);
  return v3(-slope_x, -slope_y, 1.0f);
}

#endif
