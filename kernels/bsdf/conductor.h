/* conductor.h: a metal, smooth or rough: exact Fresnel of a complex index on each facet.
 *
 * Where energy compensation is on, light that goes to and fro between facets comes back as a
 * diffuse lobe, coloured by its reflections (Kulla and Conty 2017). */
#ifndef CDL_BSDF_CONDUCTOR_H
#define CDL_BSDF_CONDUCTOR_H

#include "bsdf/bsdf.h"
#include "bsdf/energy.h"
#include "bsdf/microfacet.h"
#include "lib/sampling.h"

typedef struct ConductorParams {
  Microfacets facets;
  vec3 eta, k;       /* complex index, per channel */
  vec3 diffuse;      /* colour of the diffuse lobe over the mean of what is missing */
  float compensated; /* 1, else 0 */
#if CDL_ENERGY_COMPENSATION
  CDL_GLOBAL const float *energy; /* table of its kind of facets */
#endif
} ConductorParams;

/* Mean reflectance, weighted by the cosine, by Gauss's rule for that weight with two nodes; error
 * below 0.007. */
CDL_INLINE vec3 conductor_mean_fresnel(vec3 eta, vec3 k) {
  vec3 grazing = fresnel_conductor(0.355051026f, eta, k);
  vec3 steep = fresnel_conductor(0.844948974f, eta, k);
  return v3_madd(v3_scale(grazing, 0.363917240f), 0.636082760f, steep);
}

/* F^2 E / (1 - F (1 - E)): all orders beyond the first that leave, of one channel. */
CDL_INLINE float conductor_diffuse_color(float fresnel, float missing) {
  return fresnel * fresnel * (1.0f - missing) / fma(-fresnel, missing, 1.0f);
}

CDL_INLINE ConductorParams conductor_make(BsdfPoint point, float alpha_x, float alpha_y, vec3 eta,
                                          vec3 k) {
  ConductorParams p;
  p.facets = microfacet_surface(alpha_x, alpha_y, (point.flags & CDL_MATERIAL_BECKMANN) != 0u,
                                (point.flags & CDL_MATERIAL_SEPARABLE) != 0u);
  p.eta = eta;
  p.k = k;
  p.diffuse = v3_all(0.0f);
  p.compensated = 0.0f;
#if CDL_ENERGY_COMPENSATION
  int compensated = (point.flags & CDL_MATERIAL_ENERGY_COMPENSATED) != 0u && !p.facets.smooth;
  p.energy = energy_table(point.energy, p.facets);
  float missing = energy_metal_missing_mean(p.energy, p.facets);
  vec3 fresnel = conductor_mean_fresnel(eta, k);
  float inverse = 1.0f / missing;
  float r = conductor_diffuse_color(fresnel.x, missing);
  float g = conductor_diffuse_color(fresnel.y, missing);
  float b = conductor_diffuse_color(fresnel.z, missing);
  p.diffuse = v3_scale(v3(r, g, b), inverse);
  p.compensated = compensated ? 1.0f : 0.0f;
#endif
  return p;
}

CDL_INLINE ConductorParams conductor_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                            size_t stride, size_t i) {
  return conductor_make(point, param_float(params, CDL_CONDUCTOR_ALPHA, stride, i),
                        param_float(params, CDL_CONDUCTOR_ALPHA + 1u, stride, i),
                        param_vec3(params, CDL_CONDUCTOR_ETA, stride, i),
                        param_vec3(params, CDL_CONDUCTOR_K, stride, i));
}

/* Share of light that single scattering does not return, and of samples of the diffuse lobe. */
CDL_INLINE float conductor_diffuse_share(ConductorParams p, vec3 wo) {
#if CDL_ENERGY_COMPENSATION
  return p.compensated * energy_metal_missing(p.energy, p.facets, wo);
#else
  (void)wo;
  return p.compensated * 0.0f;
#endif
}

CDL_INLINE BsdfValue conductor_value(ConductorParams p, vec3 wo, vec3 wi, float share) {
  MicrofacetLobe lobe = microfacet_evaluate(p.facets, wo, wi);
  vec3 fresnel = fresnel_conductor(lobe.cos_h, p.eta, p.k);
  vec3 f_cos = v3_scale(fresnel, lobe.f_cos);
  float pdf = lobe.bounded_pdf;
#if CDL_ENERGY_COMPENSATION
  float cosine_pdf = wo.z > 0.0f ? CDL_INV_PI * math_max(wi.z, 0.0f) : 0.0f;
  float missing = energy_metal_missing(p.energy, p.facets, wi);
  f_cos = v3_madd(f_cos, share * missing * cosine_pdf, p.diffuse);
  pdf = math_lerp(pdf, cosine_pdf, share);
#else
  (void)share;
#endif
  float rough = p.facets.smooth ? 0.0f : 1.0f;
  return bsdf_value(v3_scale(f_cos, rough), rough * pdf);
}

CDL_INLINE BsdfValue conductor_evaluate(ConductorParams p, vec3 wo, vec3 wi) {
  return conductor_value(p, wo, wi, conductor_diffuse_share(p, wo));
}

/* w picks the lobe. */
CDL_INLINE BsdfSample conductor_sample(ConductorParams p, vec3 wo, float u, float v, float w) {
  (void)w;
  float share = conductor_diffuse_share(p, wo);
  vec3 wi = microfacet_sample_reflection(p.facets, wo, u, v);
#if CDL_ENERGY_COMPENSATION
  wi = v3_select(w < share, sample_cosine_hemisphere(u, v), wi);
#endif
  int smooth = p.facets.smooth;
  BsdfValue value = conductor_value(p, wo, wi, share);
  vec3 rough = v3_scale(value.f_cos, bsdf_reciprocal(value.pdf));
  float cos_o = math_saturate(wo.z);
  vec3 mirror = fresnel_conductor(cos_o, p.eta, p.k);
  BsdfSample sample = bsdf_sample(v3_select(smooth, bsdf_mirror(wo), wi),
                                  v3_select(smooth, mirror, rough), smooth ? 0.0f : value.pdf);
  sample.delta = smooth;
  return sample;
}

#endif
