/* conductor.h: a metal, smooth or rough: exact Fresnel of a complex index on each facet. */
#ifndef CDL_BSDF_CONDUCTOR_H
#define CDL_BSDF_CONDUCTOR_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"

typedef struct ConductorParams {
  Microfacets facets;
  vec3 eta, k; /* complex index, per channel */
} ConductorParams;

CDL_INLINE ConductorParams conductor_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                            size_t stride, size_t i) {
  ConductorParams p;
  p.facets = microfacet_surface(param_float(params, CDL_CONDUCTOR_ALPHA, stride, i),
                                param_float(params, CDL_CONDUCTOR_ALPHA + 1u, stride, i),
                                (point.flags & CDL_MATERIAL_BECKMANN) != 0u,
                                (point.flags & CDL_MATERIAL_SEPARABLE) != 0u);
  p.eta = param_vec3(params, CDL_CONDUCTOR_ETA, stride, i);
  p.k = param_vec3(params, CDL_CONDUCTOR_K, stride, i);
  return p;
}

CDL_INLINE BsdfValue conductor_evaluate(ConductorParams p, vec3 wo, vec3 wi) {
  Microfacets m = p.facets;
  MicrofacetLobe lobe = microfacet_evaluate(m, wo, wi);
  vec3 fresnel = fresnel_conductor(lobe.cos_h, p.eta, p.k);
  float f_cos = m.smooth ? 0.0f : lobe.f_cos;
  return bsdf_value(v3_scale(fresnel, f_cos), m.smooth ? 0.0f : lobe.pdf);
}

CDL_INLINE BsdfSample conductor_sample(ConductorParams p, vec3 wo, float u, float v, float w) {
  (void)w;
  Microfacets m = p.facets;
  vec3 rough = fresnel_reflect(wo, microfacet_sample_normal(m, wo, u, v));
  vec3 wi = v3_select(m.smooth, bsdf_mirror(wo), rough);
  MicrofacetLobe lobe = microfacet_evaluate(m, wo, wi);
  vec3 fresnel = fresnel_conductor(m.smooth ? math_saturate(wo.z) : lobe.cos_h, p.eta, p.k);
  vec3 weight = v3_scale(fresnel, m.smooth ? 1.0f : lobe.weight);
  BsdfSample sample = bsdf_sample(wi, weight, m.smooth ? 0.0f : lobe.pdf);
  sample.delta = m.smooth;
  return sample;
}

#endif
