/* clearcoat.h: a clear lacquer of index 1.5 with a roughness and a normal of its own, as
 * KHR_materials_clearcoat has it: coat = mix(below, specular lobe, clearcoat F).
 *
 * The extension takes F at the coat's normal and wo from both parts, which is neither reciprocal
 * nor, where wi is lower, conserving. Here the lobe takes the lesser of F(wo) and F(wi), and what
 * is below is scaled by 1 less the greater: symmetric, never more than 1 whatever is below, and the
 * extension's own value wherever both directions are equally steep, as for any coat that is smooth.
 *
 * The lobe keeps the cosine of its own normal, as all normal mapping does: it returns no more than
 * F, but where the coat's normal is not the base's, f is only reciprocal with that cosine. */
#ifndef CDL_BSDF_CLEARCOAT_H
#define CDL_BSDF_CLEARCOAT_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"
#include "lib/frame.h"

#define CLEARCOAT_F0 0.04f
#define CLEARCOAT_ALPHA_MIN 1e-3f /* as of the base, see gltf.h */

/* Fresnel's factor of a coat of strength `clearcoat` for a direction at `cosine` to its normal:
 * also what is missing of emission that passes it. */
CDL_INLINE float clearcoat_fresnel(float clearcoat, float cosine) {
  return clearcoat * fresnel_schlick(CLEARCOAT_F0, math_min(math_abs(cosine), 1.0f));
}

CDL_INLINE Microfacets clearcoat_surface(float roughness) {
  float alpha = math_max(roughness * roughness, CLEARCOAT_ALPHA_MIN);
  return microfacet_surface(alpha, alpha, 0, 1);
}

/* The coat's frame; a normal that wo sees from behind is bent until it grazes. wo.z > 0. */
CDL_INLINE Frame clearcoat_frame(vec3 normal, vec3 wo) {
  float cosine = v3_dot(normal, wo);
  float least = math_min(0.01f, wo.z);
  float bend = cosine < least ? least - cosine : 0.0f;
  return frame_from_normal(v3_normalize(v3_madd(normal, bend, wo)));
}

#endif
