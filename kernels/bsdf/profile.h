/* profile.h: how far from where light enters a body it leaves it: profiles of diffusion over a
 * plane, each normalised to 1, one colour channel at a time.
 *
 * Diffusion (Christensen and Burley 2015, "Approximate Reflectance Profiles for Efficient
 * Subsurface Scattering"): (exp(-r/d) + exp(-r/3d)) / (8 pi d r), d = radius / s, with their fit of
 * s for light that enters diffusely, 1.9 - albedo + 3.5 (albedo - 0.8)^2.
 *
 * Dipole (Jensen et al. 2001, "A Practical Model for Subsurface Light Transport"): two sources, at
 * the depths radius and radius (1 + 4A/3), where A = (1 + F) / (1 - F) and F is what the boundary
 * reflects of diffuse light from within (Egan and Hilgeman 1973). The effective extinction is what
 * gives the albedo.
 *
 * Radii are mean free paths in m. Both profiles end at `reach`, beyond which 1/1000 of their light
 * would lie. */
#ifndef CDL_BSDF_PROFILE_H
#define CDL_BSDF_PROFILE_H

#include "bsdf/fresnel.h"
#include "lib/math.h"

#define PROFILE_TAIL 1e-3f
#define PROFILE_TAIL_DEPTH 6.90775528f   /* -ln of it */
#define PROFILE_DIFFUSION_REACH 19.8602f /* in d: 3 ln(3/4 / tail) */

typedef struct Profile {
  float radius; /* m, > 0 */
  float slope;  /* diffusion: s; dipole: effective extinction times radius */
  float reach;  /* m */
  float depth;  /* dipole: that of the virtual source over that of the real one, > 1 */
  float real;   /* dipole: what of its light is the real source's */
  int dipole;
} Profile;

/* Profile.depth of a boundary with the relative index eta, [1,3]. */
CDL_INLINE float profile_depth(float eta) {
  float f = fresnel_inner_mean(eta);
  return 1.0f + 1.33333333f * (1.0f + f) / (1.0f - f);
}

CDL_INLINE float profile_dipole_step(float x, float albedo, float k) {
  float both = 0.5f * math_exp(-x);
  float echo = both * math_exp(-k * x);
  float alpha = fma(x * x, -0.333333333f, 1.0f);
  float sum = both + echo;
  float value = alpha * sum - albedo;
  float fall = fma(0.666666667f * x, sum, alpha * fma(k, echo, sum));
  return math_clamp(x + value / fall, 0.0f, 1.73205081f);
}

/* The x with alpha/2 (1 + exp(-(depth - 1) x)) exp(-x) = albedo for alpha = 1 - x^2/3, by Newton's
 * method: the left side is convex. The albedo comes out to 3e-3, and to 1e-4 for eta < 1.5. */
CDL_INLINE float profile_dipole_slope(float albedo, float depth) {
  float k = depth - 1.0f;
  float twice = math_min(2.0f * albedo, 1.0f);
  float x = math_max((1.0f - albedo) / fma(0.5f, k, 1.0f),
                     1.73205081f * (1.0f - twice) / fma(1.83f, twice, 1.0f));
  x = profile_dipole_step(x, albedo, k);
  x = profile_dipole_step(x, albedo, k);
  x = profile_dipole_step(x, albedo, k);
  return profile_dipole_step(x, albedo, k);
}

CDL_INLINE float profile_source_step(float y, float b, float x) {
  float grown = math_expm1(y);
  return math_max(y - fma(b, grown, y - x) / fma(b, grown, 1.0f + b), 0.0f);
}

/* The y >= 0 with y + b (exp(y) - 1) = x, b >= 0, x >= 0: exp(y) is the distance from a source,
 * over its depth, beyond which exp(-x) of its light arrives. Newton's method from above, where it
 * does not overshoot; 5e-6. */
CDL_INLINE float profile_source_log_distance(float b, float x) {
  float y = math_min(x, math_log1p(x / math_max(b, 1e-20f)));
  y = profile_source_step(y, b, x);
  y = profile_source_step(y, b, x);
  y = profile_source_step(y, b, x);
  return profile_source_step(y, b, x);
}

/* Distance over the plane from the foot of a source, over its depth, for exp(y) as above. */
CDL_INLINE float profile_source_radius(float y) { return math_safe_sqrt(math_expm1(2.0f * y)); }

CDL_INLINE float profile_real_share(float slope, float depth) {
  return 1.0f / (1.0f + math_exp(-slope * (depth - 1.0f)));
}

CDL_INLINE Profile profile_make(float albedo, float radius, float depth, int dipole) {
  Profile p;
  p.radius = radius;
  p.depth = depth;
  p.dipole = dipole;
  float a = math_saturate(albedo);
  float fit = fma(3.5f * (a - 0.8f), a - 0.8f, 1.9f - a);
  p.slope = dipole ? profile_dipole_slope(a, depth) : fit;
  p.real = profile_real_share(p.slope, depth);
  float y = profile_source_log_distance(p.slope * depth, PROFILE_TAIL_DEPTH);
  p.reach = radius * (dipole ? depth * profile_source_radius(y) : PROFILE_DIFFUSION_REACH / fit);
  return p;
}

/* What a source z below the plane, sigma = b / z, gives at distance r of its foot, per area, times
 * 2 pi: z (1 + sigma d) exp(-sigma (d - z)) / d^3. */
CDL_INLINE float profile_source(float z, float b, float r) {
  float d = sqrt(fma(r, r, z * z));
  float inverse = 1.0f / d;
  float flat = r * inverse;
  float fall = math_exp(-b * (flat * r) / (z * (1.0f + z * inverse)));
  return fma(b, inverse, z * inverse * inverse) * (inverse * fall);
}

CDL_INLINE float profile_dipole(Profile p, float r) {
  float real = profile_source(p.radius, p.slope, r);
  float image = profile_source(p.radius * p.depth, p.slope * p.depth, r);
  return CDL_INV_2PI * math_lerp(image, real, p.real);
}

CDL_INLINE float profile_diffusion(Profile p, float r) {
  float inverse = p.slope / p.radius;
  float wide = math_exp(-0.333333333f * (r * inverse));
  float exponentials = 0.25f * fma(wide * wide, wide, wide) * inverse;
  return CDL_INV_2PI * exponentials / math_max(r, 1e-12f);
}

/* Per area at distance r <= reach: what profile_sample draws. Not for code that is to be
 * vectorised. */
CDL_INLINE float profile_density(Profile p, float r) {
  if (r > p.reach) return 0.0f;
  return p.dipole ? profile_dipole(p, r) : profile_diffusion(p, r);
}

/* What the part within reach is to be multiplied by so that it is all. */
CDL_INLINE float profile_gain(Profile p) {
  float tail = p.dipole ? PROFILE_TAIL * (1.0f - p.real) : PROFILE_TAIL;
  return 1.0f / (1.0f - tail);
}

/* A distance drawn by profile_density; u and w in [0,1). */
CDL_INLINE float profile_sample(Profile p, float u, float w) {
  float x = -math_log1p(-u);
  float diffusion = x * p.radius / p.slope * (w < 0.25f ? 1.0f : 3.0f);
  float times = w < p.real ? 1.0f : p.depth;
  float y = profile_source_log_distance(p.slope * times, x);
  float dipole = p.radius * times * profile_source_radius(y);
  return p.dipole ? dipole : diffusion;
}

#endif
