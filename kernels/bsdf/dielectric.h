/* dielectric.h: smooth glass and water: reflection and refraction, two delta lobes.
 *
 * The lobe is drawn by Fresnel's reflectance, which cancels in the weight. `transmittance` tints
 * what passes through. Radiance grows with the square of the index it is in, so passing into the
 * denser medium (seen against the light) divides by eta^2 (Veach 1997, section 5.2). */
#ifndef CDL_BSDF_DIELECTRIC_H
#define CDL_BSDF_DIELECTRIC_H

#include "bsdf/bsdf.h"
#include "bsdf/dispersion.h"
#include "bsdf/fresnel.h"

typedef struct DielectricParams {
  vec3 transmittance;
  vec3 channel; /* weight of each colour channel, 1 unless dispersive */
  float eta;    /* index beyond the surface over that on the side of wo */
  int thin;     /* 1: both sides of a sheet at once; light leaves it in the direction it came in */
} DielectricParams;

CDL_INLINE DielectricParams dielectric_make(BsdfPoint point, float ior, float abbe) {
  Dispersion dispersion = dispersion_choose(point, math_max(ior, BSDF_IOR_MIN), abbe);
  float inverse = 1.0f / dispersion.ior;
  DielectricParams p;
  p.transmittance = point.base;
  p.thin = (point.flags & CDL_MATERIAL_THIN) != 0u;
  p.channel = dispersion.weight;
  p.eta = point.front || p.thin ? dispersion.ior : inverse;
  return p;
}

CDL_INLINE DielectricParams dielectric_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                              size_t stride, size_t i) {
  return dielectric_make(point, param_float(params, CDL_DIELECTRIC_IOR, stride, i),
                         param_float(params, CDL_DIELECTRIC_ABBE, stride, i));
}

CDL_INLINE BsdfValue dielectric_evaluate(DielectricParams p, vec3 wo, vec3 wi) {
  (void)p;
  (void)wo;
  (void)wi;
  return bsdf_black();
}

/* What a sheet reflects whose two sides reflect r each, all orders of interreflection summed:
 * r + t^2 r / (1 - r^2) with t = 1 - r. */
CDL_INLINE float dielectric_sheet(float r) { return 2.0f * r / (1.0f + r); }

/* wo is on +Z. w picks the lobe. */
CDL_INLINE BsdfSample dielectric_sample(DielectricParams p, vec3 wo, float u, float v, float w) {
  (void)u;
  (void)v;
  float cos_o = math_saturate(wo.z);
  DielectricFresnel f = fresnel_dielectric(cos_o, p.eta);
  float reflectance = p.thin ? dielectric_sheet(f.reflectance) : f.reflectance;
  int transmitted = w >= reflectance;
  vec3 refracted = fresnel_refract(wo, v3(0.0f, 0.0f, 1.0f), cos_o, f.cos_t, p.eta);
  vec3 through = v3_select(p.thin, v3_neg(wo), refracted);
  float beyond = p.thin ? 1.0f : p.eta;
  float scale = 1.0f / (beyond * beyond);
  vec3 wi = v3_select(transmitted, through, bsdf_mirror(wo));
  vec3 weight = v3_select(transmitted, v3_scale(p.transmittance, scale), v3_all(1.0f));
  BsdfSample sample = bsdf_delta(wi, v3_mul(p.channel, weight));
  sample.eta = transmitted ? beyond : 1.0f;
  sample.transmitted = transmitted;
  return sample;
}

#endif
