/* retroreflector.h: light goes back where it came from.
 *
 * The view is mirrored about the normal before an ordinary microfacet lobe is evaluated or sampled,
 * which turns the lobe around to wo (the idea of the draft KHR_materials_retroreflection).
 * Mirroring twice is nothing, and D does not change under half a turn, so the lobe stays
 * reciprocal. Light passes the coat of index `ior` on its way in and out: (1 - F(wo)) (1 - F(wi)).
 */
#ifndef CDL_BSDF_RETROREFLECTOR_H
#define CDL_BSDF_RETROREFLECTOR_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"

typedef struct RetroreflectorParams {
  vec3 reflectance;
  Microfacets facets;
  float ior;
} RetroreflectorParams;

CDL_INLINE RetroreflectorParams retroreflector_params(BsdfPoint point,
                                                      CDL_GLOBAL const uint *params, size_t stride,
                                                      size_t i) {
  RetroreflectorParams p;
  p.reflectance = point.base;
  p.facets = microfacet_surface(param_float(params, CDL_RETROREFLECTOR_ALPHA, stride, i),
                                param_float(params, CDL_RETROREFLECTOR_ALPHA + 1u, stride, i),
                                (point.flags & CDL_MATERIAL_BECKMANN) != 0u,
                                (point.flags & CDL_MATERIAL_SEPARABLE) != 0u);
  p.ior = math_max(param_float(params, CDL_RETROREFLECTOR_IOR, stride, i), BSDF_IOR_MIN);
  return p;
}

/* Reflectance times what passes the coat, by channel. */
CDL_INLINE vec3 retroreflector_tint(RetroreflectorParams p, vec3 wo, vec3 wi) {
  float in = 1.0f - fresnel_dielectric(math_saturate(wi.z), p.ior).reflectance;
  float out = 1.0f - fresnel_dielectric(math_saturate(wo.z), p.ior).reflectance;
  return v3_scale(p.reflectance, in * out);
}

CDL_INLINE BsdfValue retroreflector_evaluate(RetroreflectorParams p, vec3 wo, vec3 wi) {
  Microfacets m = p.facets;
  MicrofacetLobe lobe = microfacet_evaluate(m, bsdf_mirror(wo), wi);
  float f_cos = m.smooth ? 0.0f : lobe.f_cos;
  return bsdf_value(v3_scale(retroreflector_tint(p, wo, wi), f_cos), m.smooth ? 0.0f : lobe.pdf);
}

CDL_INLINE BsdfSample retroreflector_sample(RetroreflectorParams p, vec3 wo, float u, float v,
                                            float w) {
  (void)w;
  Microfacets m = p.facets;
  vec3 mirrored = bsdf_mirror(wo);
  vec3 rough = fresnel_reflect(mirrored, microfacet_sample_normal(m, mirrored, u, v));
  vec3 wi = v3_select(m.smooth, wo, rough);
  MicrofacetLobe lobe = microfacet_evaluate(m, mirrored, wi);
  vec3 weight = v3_scale(retroreflector_tint(p, wo, wi), m.smooth ? 1.0f : lobe.weight);
  BsdfSample sample = bsdf_sample(wi, weight, m.smooth ? 0.0f : lobe.pdf);
  sample.delta = m.smooth;
  return sample;
}

#endif
