/* mirror.h: ideal mirror without Fresnel; one delta lobe. */
#ifndef CDL_BSDF_MIRROR_H
#define CDL_BSDF_MIRROR_H

#include "bsdf/bsdf.h"

typedef struct MirrorParams {
  vec3 reflectance;
} MirrorParams;

CDL_INLINE MirrorParams mirror_params(BsdfPoint point, CDL_GLOBAL const uint *params, size_t stride,
                                      size_t i) {
  (void)params;
  (void)stride;
  (void)i;
  MirrorParams p;
  p.reflectance = point.base;
  return p;
}

CDL_INLINE BsdfValue mirror_evaluate(MirrorParams p, vec3 wo, vec3 wi) {
  (void)p;
  (void)wo;
  (void)wi;
  return bsdf_black();
}

CDL_INLINE BsdfSample mirror_sample(MirrorParams p, vec3 wo, float u, float v, float w) {
  (void)u;
  (void)v;
  (void)w;
  return bsdf_delta(bsdf_mirror(wo), p.reflectance);
}

#endif
