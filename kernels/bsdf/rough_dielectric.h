/* rough_dielectric.h: frosted glass: reflection and refraction by microfacets (Walter et al. 2007),
 * normals drawn from the visible ones.
 *
 * h is the normal of the facet that takes wi to wo, above the surface. Radiance is divided by eta^2
 * on its way into the denser medium. Masking correlated by height is 1 / (1 + Lambda(wo) +
 * Lambda(wi)) on both sides. A thin sheet transmits the lobe that it reflects, mirrored through
 * its plane. What goes to and fro between facets comes back as a diffuse lobe on either side
 * (Kulla and Conty 2017) where energy compensation is on. Facets too smooth, or an index too near
 * 1, for directions in single precision are dielectric.h's delta lobes. */
#ifndef CDL_BSDF_ROUGH_DIELECTRIC_H
#define CDL_BSDF_ROUGH_DIELECTRIC_H

#include "bsdf/dielectric.h"
#include "bsdf/energy.h"
#include "bsdf/microfacet.h"
#include "lib/sampling.h"

/* The least width of the refracted lobe, alpha |eta - 1|, that is not taken for 0. */
#define ROUGH_DIELECTRIC_WIDTH_MIN 2e-5f

typedef struct RoughDielectricParams {
  DielectricParams glass;
  Microfacets facets;
  GlassEnergy energy;
  float tint; /* greatest transmittance of the path's channels */
  int smooth; /* 1: as glass */
} RoughDielectricParams;

CDL_INLINE int rough_dielectric_is_smooth(Microfacets m, float eta, int thin) {
  float step = math_abs(eta - 1.0f) / math_max(eta, 1.0f);
  float width = math_max(m.alpha_x, m.alpha_y) * (thin ? 1.0f : step);
  return m.smooth || width < ROUGH_DIELECTRIC_WIDTH_MIN;
}

CDL_INLINE RoughDielectricParams rough_dielectric_make(BsdfPoint point, float alpha_x,
                                                       float alpha_y, float ior, float abbe) {
  RoughDielectricParams p;
  p.glass = dielectric_make(point, ior, abbe);
  p.facets = microfacet_surface(alpha_x, alpha_y, (point.flags & CDL_MATERIAL_BECKMANN) != 0u,
                                (point.flags & CDL_MATERIAL_SEPARABLE) != 0u);
  p.smooth = rough_dielectric_is_smooth(p.facets, p.glass.eta, p.glass.thin);
  int compensated = (point.flags & CDL_MATERIAL_ENERGY_COMPENSATED) != 0u && !p.smooth;
#if CDL_ENERGY_COMPENSATION
  p.energy = energy_glass(point.energy, p.facets, p.glass.eta, p.glass.thin, compensated);
#else
  (void)compensated;
  p.energy = energy_glass_none(p.glass.thin);
#endif
  float widest = v3_max(p.glass.channel);
  p.tint = v3_max(v3_mul(p.glass.channel, p.glass.transmittance)) / (widest > 0.0f ? widest : 1.0f);
  return p;
}

CDL_INLINE RoughDielectricParams rough_dielectric_params(BsdfPoint point,
                                                         CDL_GLOBAL const uint *params,
                                                         size_t stride, size_t i) {
  return rough_dielectric_make(point, param_float(params, CDL_ROUGH_DIELECTRIC_ALPHA, stride, i),
                               param_float(params, CDL_ROUGH_DIELECTRIC_ALPHA + 1u, stride, i),
                               param_float(params, CDL_ROUGH_DIELECTRIC_IOR, stride, i),
                               param_float(params, CDL_ROUGH_DIELECTRIC_ABBE, stride, i));
}

/* Probability of reflection where `reflectance` of the light is reflected. */
CDL_INLINE float rough_dielectric_choice(float reflectance, float tint) {
  float sum = fma(1.0f - reflectance, tint, reflectance);
  return reflectance / (sum > 0.0f ? sum : 1.0f);
}

/* What one pair of directions has of the single-scattering lobe. */
typedef struct RoughDielectricLobe {
  float f_cos; /* without transmittance */
  float pdf;
  int through; /* refracted: eta^2 counts */
  float pad0, pad1;
} RoughDielectricLobe;

CDL_INLINE RoughDielectricLobe rough_dielectric_lobe(RoughDielectricParams p, vec3 wo, vec3 wi) {
  RoughDielectricLobe lobe;
  Microfacets m = p.facets;
  float eta = p.glass.eta;
  int below = wi.z < 0.0f;
  int through = below && !p.glass.thin;
  vec3 up = v3(wi.x, wi.y, math_abs(wi.z));
  vec3 sum = v3_add(wo, v3_select(through, v3_scale(wi, eta), up));
  float length = v3_length(sum);
  float inverse = 1.0f / math_max(length, 1e-12f);
  vec3 h = v3_scale(sum, sum.z < 0.0f ? -inverse : inverse);
  float wo_h = through ? v3_dot(wo, h) : 0.5f * length;
  float wi_h = through ? -v3_dot(wi, h) : 0.5f * length;
  float cos_o = math_max(wo.z, 1e-9f);
  float d = microfacet_density(m, h);
  float lambda_o = microfacet_lambda(m, wo);
  float g1 = 1.0f / (1.0f + lambda_o);
  float lambda_i = microfacet_lambda(m, up);
  float correlated = 1.0f / (1.0f + lambda_o + lambda_i);
  float g = m.separable ? g1 / (1.0f + lambda_i) : correlated;
  float cos_h = math_saturate(wo_h);
  DielectricFresnel fresnel = fresnel_dielectric(cos_h, eta);
  float between = fresnel_dielectric_between(cos_h, wi_h, eta);
  float reflectance = through ? between : fresnel.reflectance;
  reflectance = p.glass.thin ? dielectric_sheet(reflectance) : reflectance;
  float choice = rough_dielectric_choice(reflectance, p.tint);
  /* solid angle of h over that of wi, times wo.h, without eta^2 where refracted */
  float jacobian = through ? wo_h * wi_h * inverse * inverse : 0.25f;
  float common = d * jacobian / cos_o;
  float scale = through ? eta * eta : 1.0f;
  int valid = wo.z > 0.0f && wi.z != 0.0f && wo_h > 0.0f && wi_h > 0.0f;
  lobe.f_cos = valid ? common * g * (below ? 1.0f - reflectance : reflectance) : 0.0f;
  lobe.pdf = valid ? common * g1 * scale * (below ? 1.0f - choice : choice) : 0.0f;
  lobe.through = through;
  lobe.pad0 = 0.0f;
  lobe.pad1 = 0.0f;
  return lobe;
}

/* Probability of sampling the diffuse lobe. */
CDL_INLINE float rough_dielectric_diffuse_share(RoughDielectricParams p, vec3 wo) {
#if CDL_ENERGY_COMPENSATION
  return p.energy.compensated * energy_glass_missing(p.energy, p.facets, wo, p.glass.eta);
#else
  (void)wo;
  return p.energy.compensated * 0.0f;
#endif
}

CDL_INLINE BsdfValue rough_dielectric_value(RoughDielectricParams p, vec3 wo, vec3 wi,
                                            float share) {
  RoughDielectricLobe lobe = rough_dielectric_lobe(p, wo, wi);
  int below = wi.z < 0.0f;
  float f_cos = lobe.f_cos;
  float pdf = lobe.pdf;
#if CDL_ENERGY_COMPENSATION
  float eta = p.glass.eta;
  float scale = lobe.through ? 1.0f / (eta * eta) : 1.0f;
  float cosine_pdf = CDL_INV_PI * math_abs(wi.z);
  vec3 up = v3(wi.x, wi.y, math_abs(wi.z));
  float missing = energy_glass_missing(p.energy, p.facets, up, lobe.through ? 1.0f / eta : eta);
  float reflected = p.energy.reflected;
  float side =
      below ? (1.0f - reflected) * scale / p.energy.mean_beyond : reflected / p.energy.mean_here;
  float diffuse = share * missing * side * cosine_pdf;
  float choice = rough_dielectric_choice(reflected, p.tint);
  float diffuse_pdf = (below ? 1.0f - choice : choice) * cosine_pdf;
  f_cos = f_cos + (wo.z > 0.0f ? diffuse : 0.0f);
  pdf = math_lerp(pdf, wo.z > 0.0f ? diffuse_pdf : 0.0f, share);
#else
  (void)share;
#endif
  vec3 tint = v3_select(below, p.glass.transmittance, v3_all(1.0f));
  float rough = p.smooth ? 0.0f : 1.0f;
  return bsdf_value(v3_scale(v3_mul(p.glass.channel, tint), rough * f_cos), rough * pdf);
}

CDL_INLINE BsdfValue rough_dielectric_evaluate(RoughDielectricParams p, vec3 wo, vec3 wi) {
  return rough_dielectric_value(p, wo, wi, rough_dielectric_diffuse_share(p, wo));
}

/* A direction of the single-scattering lobe; wi.z = 0 where there is none. */
CDL_INLINE vec3 rough_dielectric_sample_lobe(RoughDielectricParams p, vec3 wo, float u, float v,
                                             float w) {
  float eta = p.glass.eta;
  vec3 normal = microfacet_sample_normal(p.facets, wo, u, v);
  float cos_h = math_saturate(v3_dot(wo, normal));
  DielectricFresnel f = fresnel_dielectric(cos_h, eta);
  float reflectance = p.glass.thin ? dielectric_sheet(f.reflectance) : f.reflectance;
  int reflects = w < rough_dielectric_choice(reflectance, p.tint);
  vec3 reflected = fresnel_reflect(wo, normal);
  vec3 mirrored = v3(reflected.x, reflected.y, -reflected.z);
  vec3 refracted = v3_normalize(fresnel_refract(wo, normal, cos_h, f.cos_t, eta));
  vec3 through = v3_select(p.glass.thin, mirrored, refracted);
  vec3 wi = v3_select(reflects, reflected, through);
  return v3_select(reflects ? wi.z > 0.0f : wi.z < 0.0f, wi, v3(1.0f, 0.0f, 0.0f));
}

CDL_INLINE BsdfSample rough_dielectric_sample(RoughDielectricParams p, vec3 wo, float u, float v,
                                              float w) {
  float share = rough_dielectric_diffuse_share(p, wo);
  int diffuse = w < share;
  float rest = 1.0f - share;
  float lobe_w = (diffuse ? w : w - share) / math_max(diffuse ? share : rest, 1e-12f);
  lobe_w = math_min(lobe_w, CDL_ONE_MINUS_EPSILON);
  vec3 scattered = sample_cosine_hemisphere(u, v);
  int up = lobe_w < rough_dielectric_choice(p.energy.reflected, p.tint);
  scattered.z = up ? scattered.z : -scattered.z;
  vec3 single = rough_dielectric_sample_lobe(p, wo, u, v, lobe_w);
  vec3 wi = v3_select(diffuse, scattered, single);
  BsdfValue value = rough_dielectric_value(p, wo, wi, share);
  BsdfSample rough = bsdf_sample(wi, v3_scale(value.f_cos, bsdf_reciprocal(value.pdf)), value.pdf);
  BsdfSample smooth = dielectric_sample(p.glass, wo, u, v, w);
  float eta = p.glass.thin ? 1.0f : p.glass.eta;
  BsdfSample sample;
  sample.wi = v3_select(p.smooth, smooth.wi, rough.wi);
  sample.weight = v3_select(p.smooth, smooth.weight, rough.weight);
  sample.pdf = p.smooth ? 0.0f : rough.pdf;
  sample.transmitted = sample.wi.z < 0.0f;
  sample.eta = sample.transmitted ? eta : 1.0f;
  sample.delta = p.smooth;
  return sample;
}

#endif
