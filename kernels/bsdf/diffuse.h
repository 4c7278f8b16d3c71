/* diffuse.h: ideal Lambert, f = reflectance / pi. */
#ifndef CDL_BSDF_DIFFUSE_H
#define CDL_BSDF_DIFFUSE_H

#include "bsdf/bsdf.h"
#include "lib/sampling.h"

typedef struct DiffuseParams {
  vec3 reflectance;
} DiffuseParams;

CDL_INLINE DiffuseParams diffuse_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                        size_t stride, size_t i) {
  (void)params;
  (void)stride;
  (void)i;
  DiffuseParams p;
  p.reflectance = point.base;
  return p;
}

CDL_INLINE BsdfValue diffuse_evaluate(DiffuseParams p, vec3 wo, vec3 wi) {
  (void)wo;
  float pdf = CDL_INV_PI * math_max(wi.z, 0.0f);
  return bsdf_value(v3_scale(p.reflectance, pdf), pdf);
}

CDL_INLINE BsdfSample diffuse_sample(DiffuseParams p, vec3 wo, float u, float v, float w) {
  (void)wo;
  (void)w;
  vec3 wi = sample_cosine_hemisphere(u, v);
  float pdf = CDL_INV_PI * math_max(wi.z, 0.0f);
  return bsdf_sample(wi, v3_select(pdf > 0.0f, p.reflectance, v3_all(0.0f)), pdf);
}

#endif
