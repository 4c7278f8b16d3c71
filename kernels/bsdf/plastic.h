/* plastic.h: a dielectric coat of facets over a Lambert base, with what goes back and forth between
 * the two.
 *
 *   f = F D G / (4 cos cos) + T(wi) T(wo) reflectance / (pi ior^2 (1 - reflectance K))
 *
 * T(w) = 1 - F(c(w)) is what passes the coat, and K = 1 - <T>/ior^2 what the coat returns of the
 * base's diffuse light: for a boundary in equilibrium ior^2 (1 - K) = <T>. The series of bounces
 * between base and coat sums to 1/(1 - reflectance K), as in Kubelka's and Saunderson's correction.
 * With smooth facets c is the cosine itself and all of it is exact: white returns what it gets.
 *
 * With rough ones what passes should be 1 - E(w), E the coat's albedo, of which there is no closed
 * form. c is a fit, made for this file, such that F(c) bounds E from above for alpha <= 1 and
 * 1 <= ior <= 3, both distributions: so f is reciprocal and never returns more than it gets, and
 * most of what facets lose by single scattering enters the base. White returns at ior 1.5 from
 * 0.97 to 1 seen at a cosine above 0.3, and not less than 0.92 down to 0.002. */
#ifndef CDL_BSDF_PLASTIC_H
#define CDL_BSDF_PLASTIC_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"
#include "lib/sampling.h"

typedef struct PlasticParams {
  vec3 base; /* reflectance / (ior^2 (1 - reflectance K)) */
  Microfacets facets;
  float eta;    /* index of the coat, [1,3] */
  float spread; /* how far facets spread c, by index: [0,1) */
  float least;  /* the smaller alpha, squared */
  float guess;  /* albedo of the base for light that has passed the coat; for sampling */
} PlasticParams;

CDL_INLINE float plastic_pick(int beckmann, float ggx_value, float beckmann_value) {
  return beckmann ? beckmann_value : ggx_value;
}

/* The square of the cosine at which a smooth coat would reflect at least as much as this one of
 * facets reflects, once, of the light from a direction of cosine mu: mu^2 + spread g(mu, alpha).
 * The polynomial is fitted from above to the albedo of the coat for 1.05 <= ior <= 3. */
CDL_INLINE float plastic_effective_cos2(int b, float spread, float alpha, float mu) {
  float y = alpha / (alpha + mu);
  float z = alpha / fma(4.0f, mu, alpha);
  float at_y =
      fma(plastic_pick(b, -3.71297f, -3.71368f), alpha,
          fma(plastic_pick(b, -1.14668f, -0.44979f), y, plastic_pick(b, 0.69094f, 0.27866f)));
  float at_z =
      fma(plastic_pick(b, -2.15286f, -0.05577f), alpha, plastic_pick(b, 0.70786f, 0.23418f));
  float c0 =
      fma(fma(plastic_pick(b, -0.46944f, -0.31916f), alpha, plastic_pick(b, 6.34862f, 4.21358f)),
          alpha, plastic_pick(b, -0.09828f, -0.04584f));
  float c1 =
      fma(fma(plastic_pick(b, 11.921f, 2.24552f), alpha, plastic_pick(b, -20.2424f, -4.28429f)),
          alpha, plastic_pick(b, 0.55224f, -0.59137f));
  float c2 =
      fma(fma(plastic_pick(b, -12.3677f, -3.21751f), alpha, plastic_pick(b, 23.4244f, 5.56986f)),
          alpha, plastic_pick(b, -2.379f, -1.36259f));
  float g = fma(y, at_y, fma(z, at_z, fma(fma(c2, mu, c1), mu, c0)));
  return math_clamp(fma(spread * alpha, g, mu * mu), 0.0f, 1.0f);
}

/* What the coat so reflects of diffuse light from outside, fitted from below. */
CDL_INLINE float plastic_average(int b, float alpha, float ior) {
  float s = (ior - 1.0f) / (ior + 1.0f);
  float r = sqrt(s);
  float a0 = fma(fma(plastic_pick(b, 1.8279f, 1.3019f), alpha, plastic_pick(b, -2.2138f, -2.5054f)),
                 alpha, plastic_pick(b, 0.4012f, 0.6757f));
  float a1 = fma(fma(plastic_pick(b, -7.0347f, -4.5912f), alpha, plastic_pick(b, 6.4046f, 8.3478f)),
                 alpha, plastic_pick(b, 0.6056f, -0.9017f));
  float a2 =
      fma(fma(plastic_pick(b, 10.4591f, 4.6205f), alpha, plastic_pick(b, -7.4566f, -9.5924f)),
          alpha, plastic_pick(b, -1.9781f, 0.7664f));
  float a3 = fma(fma(plastic_pick(b, -5.7047f, -0.7218f), alpha, plastic_pick(b, 3.6709f, 3.5106f)),
                 alpha, plastic_pick(b, 2.0074f, 0.3703f));
  return math_saturate(s * fma(fma(fma(a3, r, a2), r, a1), r, a0));
}

CDL_INLINE PlasticParams plastic_make(BsdfPoint point, float alpha_along, float alpha_across,
                                      float ior) {
  PlasticParams p;
  float alpha_x = math_clamp(alpha_along, 0.0f, 1.0f);
  float alpha_y = math_min(alpha_across, 1.0f);
  int beckmann = (point.flags & CDL_MATERIAL_BECKMANN) != 0u;
  p.facets =
      microfacet_surface(alpha_x, alpha_y, beckmann, (point.flags & CDL_MATERIAL_SEPARABLE) != 0u);
  p.eta = math_clamp(ior, 1.0f, 3.0f);
  p.spread = (p.eta - 1.0f) / (p.eta - 0.96f);
  float x2 = p.facets.alpha_x * p.facets.alpha_x;
  float y2 = p.facets.alpha_y * p.facets.alpha_y;
  p.least = math_min(x2, y2);
  float most = math_max(x2, y2);
  float average = plastic_average(beckmann, sqrt(0.5f * (most + p.least)), p.eta);
  float leaves = (1.0f - average) / (p.eta * p.eta); /* 1 - K */
  float returns = 1.0f - leaves;
  vec3 r = point.base;
  float x = r.x / (p.eta * p.eta * (1.0f - r.x * returns));
  float y = r.y / (p.eta * p.eta * (1.0f - r.y * returns));
  float z = r.z / (p.eta * p.eta * (1.0f - r.z * returns));
  p.base = v3(x, y, z);
  p.guess = v3_max(p.base) * (1.0f - average);
  return p;
}

CDL_INLINE PlasticParams plastic_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                        size_t stride, size_t i) {
  return plastic_make(point, param_float(params, CDL_PLASTIC_ALPHA, stride, i),
                      param_float(params, CDL_PLASTIC_ALPHA + 1u, stride, i),
                      param_float(params, CDL_PLASTIC_IOR, stride, i));
}

/* The share of light from w, of the base's side of the coat: 1 - F(c). alpha is that along w,
 * lowered towards the smaller one: the mean of squares bounds the anisotropic coat too. */
CDL_INLINE float plastic_pass(PlasticParams p, vec3 w) {
  float mu = math_saturate(w.z);
  float x = p.facets.alpha_x * w.x;
  float y = p.facets.alpha_y * w.y;
  float sin2 = fma(w.x, w.x, w.y * w.y);
  float along = fma(x, x, y * y) / math_max(sin2, 1e-12f);
  float alpha = sqrt(0.5f * (math_max(along, p.least) + p.least));
  float cos2 = plastic_effective_cos2(p.facets.beckmann, p.spread, alpha, mu);
  float effective = p.facets.smooth ? mu : sqrt(cos2);
  return 1.0f - fresnel_dielectric(effective, p.eta).reflectance;
}

/* Probability of the coat, from what it reflects at most and what the base returns. */
CDL_INLINE float plastic_coat_probability(PlasticParams p, float pass) {
  float coat = 1.0f - pass;
  float sum = fma(pass, p.guess, coat);
  float share = coat / (sum > 0.0f ? sum : 1.0f);
  return sum > 0.0f ? share : 0.0f;
}

/* f cos and the density, of what is not a delta lobe. */
CDL_INLINE BsdfValue plastic_value(PlasticParams p, vec3 wo, vec3 wi, float pass) {
  MicrofacetLobe lobe = microfacet_evaluate(p.facets, wo, wi);
  float fresnel = fresnel_dielectric(lobe.cos_h, p.eta).reflectance;
  float cosine = CDL_INV_PI * math_max(wi.z, 0.0f);
  float coat = p.facets.smooth ? 0.0f : lobe.f_cos * fresnel;
  float coat_pdf = p.facets.smooth ? 0.0f : lobe.pdf;
  float probability = plastic_coat_probability(p, pass);
  float through = pass * plastic_pass(p, wi) * cosine;
  return bsdf_value(v3_madd(v3_all(coat), through, p.base),
                    math_lerp(cosine, coat_pdf, probability));
}

CDL_INLINE BsdfValue plastic_evaluate(PlasticParams p, vec3 wo, vec3 wi) {
  return plastic_value(p, wo, wi, plastic_pass(p, wo));
}

/* w picks the coat or the base. */
CDL_INLINE BsdfSample plastic_sample(PlasticParams p, vec3 wo, float u, float v, float w) {
  float pass = plastic_pass(p, wo);
  float probability = plastic_coat_probability(p, pass);
  int coat = w < probability;
  int delta = coat && p.facets.smooth;
  vec3 rough = fresnel_reflect(wo, microfacet_sample_normal(p.facets, wo, u, v));
  vec3 reflected = v3_select(p.facets.smooth, bsdf_mirror(wo), rough);
  vec3 wi = v3_select(coat, reflected, sample_cosine_hemisphere(u, v));
  BsdfValue value = plastic_value(p, wo, wi, pass);
  vec3 mirror = v3_all((1.0f - pass) / (delta ? probability : 1.0f));
  vec3 weight = v3_scale(value.f_cos, bsdf_reciprocal(value.pdf));
  BsdfSample sample = bsdf_sample(wi, v3_select(delta, mirror, weight), delta ? 0.0f : value.pdf);
  sample.delta = delta;
  return sample;
}

#endif
