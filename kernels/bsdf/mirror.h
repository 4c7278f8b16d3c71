/* mirror.h: ideal mirror without Fresnel; one delta lobe. */
#ifndef CDL_BSDF_MIRROR_H
#define CDL_BSDF_MIRROR_H

#include "bsdf/bsdf.h"

CDL_INLINE BsdfValue mirror_evaluate(BsdfParams p, vec3 wo, vec3 wi) {
  (void)p;
  (void)wo;
  (void)wi;
  return bsdf_black();
}

CDL_INLINE BsdfSample mirror_sample(BsdfParams p, vec3 wo, float u, float v, float w) {
  (void)u;
  (void)v;
  (void)w;
  return bsdf_delta(bsdf_mirror(wo), p.base);
}

#endif
