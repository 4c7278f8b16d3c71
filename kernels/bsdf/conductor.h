/* conductor.h: a metal, smooth or rough: exact Fresnel of a complex index on each facet. */
#ifndef CDL_BSDF_CONDUCTOR_H
#define CDL_BSDF_CONDUCTOR_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"

CDL_INLINE Microfacets conductor_surface(BsdfParams p) {
  return microfacet_surface(p.alpha_x, p.alpha_y, (p.flags & CDL_MATERIAL_BECKMANN) != 0u,
                            (p.flags & CDL_MATERIAL_SEPARABLE) != 0u);
}

CDL_INLINE BsdfValue conductor_evaluate(BsdfParams p, vec3 wo, vec3 wi) {
  Microfacets m = conductor_surface(p);
  MicrofacetLobe lobe = microfacet_evaluate(m, wo, wi);
  vec3 fresnel = fresnel_conductor(lobe.cos_h, p.eta, p.k);
  float f_cos = m.smooth ? 0.0f : lobe.f_cos;
  return bsdf_value(v3_scale(fresnel, f_cos), m.smooth ? 0.0f : lobe.pdf);
}

CDL_INLINE BsdfSample conductor_sample(BsdfParams p, vec3 wo, float u, float v, float w) {
  (void)w;
  Microfacets m = conductor_surface(p);
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
