/* energy.h: how much light single scattering between rough facets loses, for models that give it
 * back (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks").
 *
 * 1 - E(w) is what a surface that absorbs nothing keeps back of light from w. It comes from fits
 * (energy_fit.h), within 0.01 of the truth and on the side of too little rather than too much. The
 * mean over the cosine is that of the fit, so that all of it comes back:
 * f = (1 - E(wo)) (1 - E(wi)) / (pi mean).
 * A kernel built with CDL_ENERGY_COMPENSATION 0 does without; its results are those with
 * compensation off. */
#ifndef CDL_BSDF_ENERGY_H
#define CDL_BSDF_ENERGY_H

#include "bsdf/dielectric.h"
#include "bsdf/energy_fit.h"
#include "bsdf/microfacet.h"

#ifndef CDL_ENERGY_COMPENSATION
#define CDL_ENERGY_COMPENSATION 1
#endif

#define ENERGY_ALPHA_MIN 1e-3f
#define ENERGY_MEAN_ALPHA_MIN 0.0035f /* below, the mean goes with the square of alpha */
#define ENERGY_COSINE_MIN 1e-3f
#define ENERGY_MEAN_MIN 1e-9f

/* How many times rougher the surface is for which the fits answer: what is missing from very smooth
 * ones depends on the ratio of cosine and alpha alone. */
CDL_INLINE float energy_magnification(Microfacets m) {
  return math_max(ENERGY_ALPHA_MIN / math_max(m.alpha_x, m.alpha_y), 1.0f);
}

/* The surface within the range of the fits. */
CDL_INLINE Microfacets energy_surface(Microfacets m, float magnification, float least) {
  m.alpha_x = math_clamp(m.alpha_x * magnification, least, 1.0f);
  m.alpha_y = math_clamp(math_after(m.alpha_x, m.alpha_y) * magnification, least, 1.0f);
  return m;
}

/* 1 - E(w) of white metal, w.z > 0. */
CDL_INLINE float energy_metal_missing(Microfacets m, vec3 w) {
#if CDL_ENERGY_COMPENSATION
  float magnification = energy_magnification(m);
  m = energy_surface(m, magnification, ENERGY_ALPHA_MIN);
  w.z = math_clamp(w.z * magnification, ENERGY_COSINE_MIN, 1.0f);
  float sine = math_safe_sqrt(fma(w.x, w.x, w.y * w.y));
  float inverse = 1.0f / (sine > 1e-12f ? sine : 1.0f);
  float cos_phi = sine > 1e-12f ? w.x * inverse : 1.0f;
  float sin_phi = sine > 1e-12f ? w.y * inverse : 0.0f;
  float xc = m.alpha_x * cos_phi, ys = m.alpha_y * sin_phi;
  float along = sqrt(fma(xc, xc, ys * ys));
  float xs = math_after(along, m.alpha_x) * sin_phi, yc = m.alpha_y * cos_phi;
  float across = sqrt(fma(xs, xs, yc * yc));
  float g1 = 1.0f / (1.0f + microfacet_lambda(m, w));
  float t = w.z / (w.z + math_after(g1, along));
  float fit = energy_fit_metal(g1, t, w.z, along, across, m.alpha_x * m.alpha_y / along,
                               m.beckmann ? 1.0f : 0.0f, m.separable ? 1.0f : 0.0f);
  /* nothing is missing so far above grazing that no facet masks, but the fit would not say 0 */
  float gate = math_saturate(2.0f - 0.125f * w.z / math_max(m.alpha_x, m.alpha_y));
  return math_clamp(fit - ENERGY_FIT_BIAS, 0.0f, 1.0f) * gate;
#else
  (void)m;
  (void)w;
  return 0.0f;
#endif
}

/* Its mean over the cosine, > 0. */
CDL_INLINE float energy_metal_missing_mean(Microfacets m) {
#if CDL_ENERGY_COMPENSATION
  float magnification = energy_magnification(m);
  Microfacets whole = energy_surface(m, magnification, ENERGY_ALPHA_MIN);
  float scale = 0.5f * (whole.alpha_x + whole.alpha_y) / magnification;
  m = energy_surface(m, math_after(scale, magnification), ENERGY_MEAN_ALPHA_MIN);
  float mean = 0.5f * (m.alpha_x + m.alpha_y);
  float fit =
      energy_fit_metal_mean(mean, sqrt(m.alpha_x * m.alpha_y), sqrt(mean), mean / (mean + 0.05f),
                            m.beckmann ? 1.0f : 0.0f, m.separable ? 1.0f : 0.0f);
  return math_clamp(scale * scale * math_exp(fit), ENERGY_MEAN_MIN, 1.0f);
#else
  (void)m;
  return 1.0f;
#endif
}

/* What a dielectric boundary, or a thin sheet, keeps back, and how it shares it out. */
typedef struct GlassEnergy {
  float compensated;            /* 1, else 0 */
  float mean_here, mean_beyond; /* mean of 1 - E over the cosine, on the side of wo and beyond */
  float reflected;              /* share of it that comes back on the side of wo */
  int thin;
} GlassEnergy;

#if CDL_ENERGY_COMPENSATION

/* Cosine beyond the boundary, rounded off about the critical angle as roughness does: the root of a
 * hyperbola in place of max(x, 0). */
CDL_INLINE float energy_glass_scaled_cosine(float cosine, float eta, float alpha) {
  float x = fma(cosine, cosine, (eta - 1.0f) * (eta + 1.0f));
  return sqrt(math_max(0.5f * (x + sqrt(fma(x, x, 0.25f * alpha * alpha))), 1e-12f));
}

/* Masking of both directions together, or of one where it is separable. */
CDL_INLINE float energy_glass_masked(float lambda, float lambda_o, int separable) {
  return lambda / (1.0f + lambda + (separable ? 0.0f : lambda_o));
}

/* The isotropic surface that stands for m: its fits know no other. */
CDL_INLINE Microfacets energy_glass_surface(Microfacets m) {
  m = energy_surface(m, 1.0f, ENERGY_ALPHA_MIN);
  float alpha = sqrt(m.alpha_x * m.alpha_y);
  m.alpha_x = alpha;
  m.alpha_y = alpha;
  return m;
}

/* sqrt(1 - eta^2), the cosine of the critical angle; 0 for eta >= 1. */
CDL_INLINE float energy_critical_cosine(float eta) {
  return math_safe_sqrt((1.0f - eta) * (1.0f + eta));
}

CDL_INLINE float energy_glass_fit(Microfacets m, float cosine, float eta) {
  m = energy_glass_surface(m);
  eta = math_clamp(eta, 0.25f, 4.0f);
  cosine = math_clamp(cosine, ENERGY_COSINE_MIN, 1.0f);
  float alpha = m.alpha_x;
  float scaled = energy_glass_scaled_cosine(cosine, eta, alpha);
  float beyond = math_min(scaled / eta, 1.0f);
  float reflected = fresnel_dielectric_between(cosine, beyond, eta);
  float floor_beyond = math_max(beyond, 1e-3f);
  vec3 flat = v3(math_safe_sqrt((1.0f - cosine) * (1.0f + cosine)), 0.0f, cosine);
  float lambda_o = microfacet_lambda(m, flat);
  m.alpha_x = math_after(lambda_o, m.alpha_x);
  vec3 refracted =
      v3(math_safe_sqrt((1.0f - floor_beyond) * (1.0f + floor_beyond)), 0.0f, floor_beyond);
  float lambda_t = microfacet_lambda(m, refracted);
  float base_r = energy_glass_masked(lambda_o, lambda_o, m.separable);
  float base_t = energy_glass_masked(math_after(base_r, lambda_t), lambda_o, m.separable);
  float critical = energy_critical_cosine(eta);
  float dense = energy_critical_cosine(1.0f / math_after(critical, eta));
  float fit = energy_fit_glass(
      math_lerp(base_t, base_r, reflected), 1.0f / (1.0f + lambda_t), cosine / (cosine + alpha),
      reflected, beyond / (math_after(base_t, alpha) + beyond), cosine, alpha, critical, dense,
      critical / (critical + alpha + cosine), m.beckmann ? 1.0f : 0.0f, m.separable ? 1.0f : 0.0f);
  return math_clamp(fit - ENERGY_FIT_BIAS, 0.0f, 1.0f);
}

CDL_INLINE float energy_glass_fit_mean(Microfacets m, float eta) {
  m = energy_glass_surface(m);
  eta = math_clamp(eta, 0.25f, 4.0f);
  float alpha = m.alpha_x;
  float critical = energy_critical_cosine(eta);
  float dense = energy_critical_cosine(1.0f / math_after(critical, eta));
  float fit = energy_fit_glass_mean(alpha, sqrt(alpha), alpha / (alpha + 0.05f),
                                    (eta - 1.0f) / (eta + 1.0f), critical, dense,
                                    m.beckmann ? 1.0f : 0.0f, m.separable ? 1.0f : 0.0f);
  return math_clamp(alpha * math_exp(fit), ENERGY_MEAN_MIN, 1.0f);
}

/* Reflected share x of side o, with 1 - x_o = (1 - F_o) mean_t / max(mean_o, mean_t): reciprocal,
 * because n_o^2 (1 - F_o) = n_t^2 (1 - F_t) for Fresnel's means over the cosine (Kulla and Conty
 * 2017; their fit of F for the denser side, the other from that identity). */
CDL_INLINE GlassEnergy energy_glass(Microfacets m, float eta, int thin, int compensated) {
  GlassEnergy e;
  float metal = energy_metal_missing_mean(m);
  m.alpha_x = math_after(metal, m.alpha_x);
  float here = energy_glass_fit_mean(m, eta);
  m.alpha_x = math_after(here, m.alpha_x);
  float beyond = energy_glass_fit_mean(m, 1.0f / eta);
  float denser = math_max(eta, 1.0f / eta);
  float fresnel = (denser - 1.0f) / fma(1.00071f, denser, 4.08567f);
  float passes = (1.0f - fresnel) * (eta < 1.0f ? eta * eta : 1.0f);
  float share = 1.0f - passes * beyond / math_max(here, beyond);
  e.compensated = compensated ? 1.0f : 0.0f;
  e.mean_here = thin ? metal : here;
  e.mean_beyond = thin ? metal : beyond;
  e.reflected = thin ? dielectric_sheet(fresnel) : share;
  e.thin = thin;
  return e;
}

/* 1 - E(w), w.z > 0, on the side from which the other has the relative index eta. */
CDL_INLINE float energy_glass_missing(GlassEnergy e, Microfacets m, vec3 w, float eta) {
  float metal = energy_metal_missing(m, w);
  m.alpha_x = math_after(metal, m.alpha_x);
  float glass = energy_glass_fit(m, w.z, eta);
  return e.thin ? metal : glass;
}

#else

CDL_INLINE GlassEnergy energy_glass(Microfacets m, float eta, int thin, int compensated) {
  (void)m;
  (void)eta;
  (void)compensated;
  GlassEnergy e;
  e.compensated = 0.0f;
  e.mean_here = 1.0f;
  e.mean_beyond = 1.0f;
  e.reflected = 0.5f;
  e.thin = thin;
  return e;
}

CDL_INLINE float energy_glass_missing(GlassEnergy e, Microfacets m, vec3 w, float eta) {
  (void)e;
  (void)m;
  (void)w;
  (void)eta;
  return 0.0f;
}

#endif

#endif
