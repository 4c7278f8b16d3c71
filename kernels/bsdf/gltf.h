/* gltf.h: glTF 2.0 metallic-roughness, by the formulas of the specification's appendix B:
 * mix(dielectric, metal, metallic), Schlick's Fresnel at wo.h, GGX with alpha = roughness^2, and
 * masking in its separable form.
 *
 * dielectric = mix(base / pi, specular, F) takes F at wo.h from the diffuse part, not what the
 * specular lobe reflects in all. White seen at cos 0.1 therefore returns 1.5 times the light it
 * gets at roughness 0, 1.4 at 0.2, 1.05 at 0.6, and less than 1 from 0.9 on; at cos 0.8 and above
 * never more than 1. That is the specification's own; metals keep to 1. */
#ifndef CDL_BSDF_GLTF_H
#define CDL_BSDF_GLTF_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"
#include "lib/sampling.h"

#define GLTF_ALPHA_MIN 1e-3f /* of smooth surfaces, so that they have a density */

typedef struct GltfParams {
  vec3 base; /* base colour */
  float metallic, roughness;
  float ior; /* of the dielectric */
} GltfParams;

CDL_INLINE GltfParams gltf_params(BsdfPoint point, CDL_GLOBAL const uint *params, size_t stride,
                                  size_t i) {
  GltfParams p;
  p.base = point.base;
  p.metallic = param_float(params, CDL_GLTF_METALLIC, stride, i);
  p.roughness = param_float(params, CDL_GLTF_ROUGHNESS, stride, i);
  p.ior = param_float(params, CDL_GLTF_IOR, stride, i);
  return p;
}

CDL_INLINE Microfacets gltf_surface(GltfParams p) {
  float alpha = math_max(p.roughness * p.roughness, GLTF_ALPHA_MIN);
  return microfacet_surface(alpha, alpha, 0, 1);
}

/* Fresnel's factor of the specular lobe, by channel, the two materials mixed. */
CDL_INLINE vec3 gltf_fresnel(GltfParams p, float dielectric, float cos_h) {
  vec3 metal = fresnel_schlick_rgb(p.base, cos_h);
  return v3(math_lerp(dielectric, metal.x, p.metallic), math_lerp(dielectric, metal.y, p.metallic),
            math_lerp(dielectric, metal.z, p.metallic));
}

/* Probability of sampling the specular lobe: its share of an estimate of the albedo. The diffuse
 * part's share does not shrink at grazing angles, as the part itself does not. */
CDL_INLINE float gltf_specular_probability(GltfParams p, vec3 wo) {
  float f0 = fresnel_f0(p.ior);
  float specular = v3_max(gltf_fresnel(p, fresnel_schlick(f0, wo.z), wo.z));
  float diffuse = (1.0f - p.metallic) * (1.0f - f0) * v3_max(p.base);
  float sum = specular + diffuse;
  float share = specular / (sum > 0.0f ? sum : 1.0f);
  return sum > 0.0f ? share : 0.5f;
}

CDL_INLINE BsdfValue gltf_evaluate(GltfParams p, vec3 wo, vec3 wi) {
  MicrofacetLobe lobe = microfacet_evaluate(gltf_surface(p), wo, wi);
  float dielectric = fresnel_schlick(fresnel_f0(p.ior), lobe.cos_h);
  float cosine_pdf = CDL_INV_PI * math_max(wi.z, 0.0f);
  vec3 specular = v3_scale(gltf_fresnel(p, dielectric, lobe.cos_h), lobe.f_cos);
  vec3 f_cos = v3_madd(specular, (1.0f - p.metallic) * (1.0f - dielectric) * cosine_pdf, p.base);
  float probability = gltf_specular_probability(p, wo);
  return bsdf_value(f_cos, math_lerp(cosine_pdf, lobe.pdf, probability));
}

CDL_INLINE BsdfSample gltf_sample(GltfParams p, vec3 wo, float u, float v, float w) {
  vec3 normal = microfacet_sample_normal(gltf_surface(p), wo, u, v);
  int specular = w < gltf_specular_probability(p, wo);
  vec3 wi = v3_select(specular, fresnel_reflect(wo, normal), sample_cosine_hemisphere(u, v));
  BsdfValue value = gltf_evaluate(p, wo, wi);
  return bsdf_sample(wi, v3_scale(value.f_cos, bsdf_reciprocal(value.pdf)), value.pdf);
}

#endif
