/* dielectric.h: smooth glass and water: reflection and refraction, two delta lobes.
 *
 * The lobe is drawn by Fresnel's reflectance, which cancels in the weight. `transmittance` tints
 * what passes through. Radiance grows with the square of the index it is in, so passing into the
 * denser medium (seen against the light) divides by eta^2 (Veach 1997, section 5.2). */
#ifndef CDL_BSDF_DIELECTRIC_H
#define CDL_BSDF_DIELECTRIC_H

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"

typedef struct DielectricParams {
  vec3 transmittance;
  float ior; /* inside over outside */
  int front; /* 1: wo is outside */
} DielectricParams;

CDL_INLINE DielectricParams dielectric_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                              size_t stride, size_t i) {
  DielectricParams p;
  p.transmittance = point.base;
  p.ior = param_float(params, CDL_DIELECTRIC_IOR, stride, i);
  p.front = point.front;
  return p;
}

CDL_INLINE BsdfValue dielectric_evaluate(DielectricParams p, vec3 wo, vec3 wi) {
  (void)p;
  (void)wo;
  (void)wi;
  return bsdf_black();
}

/* wo is on +Z; p.front says whether that is outside. w picks the lobe. */
CDL_INLINE BsdfSample dielectric_sample(DielectricParams p, vec3 wo, float u, float v, float w) {
  (void)u;
  (void)v;
  float inverse = 1.0f / p.ior;
  float eta = p.front ? p.ior : inverse;
  float cos_o = math_saturate(wo.z);
  DielectricFresnel f = fresnel_dielectric(cos_o, eta);
  int transmitted = w >= f.reflectance;
  vec3 refracted = fresnel_refract(wo, v3(0.0f, 0.0f, 1.0f), cos_o, f.cos_t, eta);
  float scale = 1.0f / (eta * eta);
  vec3 wi = v3_select(transmitted, refracted, bsdf_mirror(wo));
  vec3 weight = v3_select(transmitted, v3_scale(p.transmittance, scale), v3_all(1.0f));
  BsdfSample sample = bsdf_delta(wi, weight);
  sample.eta = transmitted ? eta : 1.0f;
  sample.transmitted = transmitted;
  return sample;
}

#endif
