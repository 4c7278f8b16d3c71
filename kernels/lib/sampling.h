/* sampling.h: from uniform numbers to directions, points and choices; heuristics and ray offsets.
 *
 * u and v are in [0, 1). Directions are of unit length in a local frame with +Z as its axis. Every
 * map keeps neighbours together where it can, so that stratified numbers stay stratified. */
#ifndef CDL_SAMPLING_H
#define CDL_SAMPLING_H

#include "lib/math.h"
#include "lib/vec.h"

/* The concentric map of the square to the unit disk (Shirley and Chiu 1997) without branches:
 * radius signed, angle as (cosine, sine). x = radius cosine, y = radius sine. a and b are made in
 * unlike ways, with the same results, because compilers pack like operations on two floats into a
 * vector, which stops PoCL's loop vectoriser. */
CDL_INLINE float sample_disk_polar(float u, float v, float *cosine, float *sine) {
  float a = fma(2.0f, u, -1.0f);
  float b = (v - 0.5f) + (v - 0.5f);
  int wide = (a - b) * (a + b) > 0.0f; /* |a| > |b| */
  float radius = wide ? a : b;
  float eighth = 0.125f * (wide ? b : a) / (radius == 0.0f ? 1.0f : radius);
  math_sincos_2pi(wide ? eighth : 0.25f - eighth, sine, cosine);
  return radius;
}

/* Uniform on the unit disk; density CDL_INV_PI by area. */
CDL_INLINE void sample_disk(float u, float v, float *x, float *y) {
  float cosine, sine;
  float radius = sample_disk_polar(u, v, &cosine, &sine);
  *x = radius * cosine;
  *y = radius * sine;
}

CDL_INLINE float sample_cosine_hemisphere_pdf(float cosine) {
  return math_max(cosine, 0.0f) * CDL_INV_PI;
}

/* Proportional to the cosine about +Z (Malley's method). z is at least 1e-4, so the density of what
 * is drawn is never 0. */
CDL_INLINE vec3 sample_cosine_hemisphere(float u, float v) {
  float cosine, sine;
  float radius = sample_disk_polar(u, v, &cosine, &sine);
  float z = sqrt(math_max((1.0f - radius) * (1.0f + radius), 1e-8f));
  return v3(radius * cosine, radius * sine, z);
}

/* Uniform over all directions; density CDL_INV_4PI by solid angle. */
CDL_INLINE vec3 sample_sphere(float u, float v) {
  float h = 2.0f * u;
  float radius = math_safe_sqrt(h * (2.0f - h));
  float cosine, sine;
  math_sincos_2pi(v, &sine, &cosine);
  return v3(radius * cosine, radius * sine, 1.0f - h);
}

/* Uniform on a triangle, as the barycentric weights of its first two corners; the third's is the
 * rest to 1 and not negative. Density 1 / area. (Heitz 2019, "A Low-Distortion Map Between Triangle
 * and Square") */
CDL_INLINE void sample_triangle(float u, float v, float *b0, float *b1) {
  int upper = v > u;
  float half_small = 0.5f * (upper ? u : v);
  float rest = (upper ? v : u) - half_small;
  *b0 = upper ? half_small : rest;
  *b1 = upper ? rest : half_small;
}

/* Multiple importance sampling by the power heuristic (Veach 1997, section 9.2): the weight of a
 * sample drawn with density `own` that the other technique would have drawn with density `other`,
 * both >= 0. Infinite densities are limits; two equal ones weigh 1/2, and own = 0 weighs 0. */
CDL_INLINE float mis_power(float own, float other) {
  float ratio = own == other ? 1.0f : other / (own > 0.0f ? own : 1.0f);
  return own > 0.0f ? 1.0f / fma(ratio, ratio, 1.0f) : 0.0f;
}

/* The same of one technique alone, whose density may be 0 for what the other one cannot do: camera
 * rays and delta lobes (no light is sampled for them), delta lights (no ray meets them). */
CDL_INLINE float mis_power_or_alone(float own, float other) {
  return own > 0.0f ? mis_power(own, other) : 1.0f;
}

/* One coordinate of offset_ray. The bits of a float are an ordered integer, so adding to them moves
 * by units in the last place; below 2^-5, where those shrink, a fixed step does. A single compare,
 * and of a product, keeps compilers from packing two coordinates into a vector (see above). */
CDL_INLINE float offset_coordinate(float p, float n) {
  uint step = (uint)(int)(256.0f * math_mulsign(n, p));
  float moved = as_float(as_uint(p) + step);
  return p * p < 0.0009765625f ? p + n * 1.52587891e-5f : moved;
}

/* Moves a point computed on a surface off it along unit normal n, so that a ray from there does not
 * meet the surface again; n is on the side to which the ray leaves. (Waechter and Binder 2019, "A
 * Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, chapter 6) */
CDL_INLINE vec3 offset_ray(vec3 p, vec3 n) {
  return v3(offset_coordinate(p.x, n.x), offset_coordinate(p.y, n.y), offset_coordinate(p.z, n.z));
}

#endif
