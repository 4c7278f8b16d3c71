/* gltf.h: glTF 2.0 metallic-roughness: mix(dielectric, metal, metallic), Schlick's Fresnel at wo.h,
 * GGX with alpha = roughness^2, and masking in its separable form, all as in the specification's
 * appendix B, but for what is below the dielectric's facets.
 *
 * There the appendix has dielectric = mix(base / pi, specular, F(wo.h)), which takes from the base
 * what one facet reflects, not what all of them do: white seen at cos 0.01 would return up to 1.55
 * times the light it gets, while the specification asks of every such model that it conserves
 * energy. Here the base gets what the specular lobe leaves in all, see gltf_albedo.h: white returns
 * from 0.99 to 1 of what it gets at any angle, and metals no more than 1. */
#ifndef CDL_BSDF_GLTF_H
#define CDL_BSDF_GLTF_H

#include "bsdf/bsdf.h"
#include "bsdf/gltf_albedo.h"
#include "bsdf/microfacet.h"
#include "lib/sampling.h"

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

CDL_INLINE GltfFacets gltf_facets_of(GltfParams p) {
  return gltf_facets(math_max(p.roughness, GLTF_ROUGHNESS_MIN));
}

CDL_INLINE Microfacets gltf_surface(GltfParams p) {
  float alpha = gltf_facets_of(p).alpha;
  return microfacet_surface(alpha, alpha, 0, 1);
}

/* Fresnel's factor of the specular lobe, by channel, the two materials mixed. */
CDL_INLINE vec3 gltf_fresnel(GltfParams p, float cos_h) {
  float f0 = (1.0f - p.metallic) * fresnel_f0(p.ior);
  return fresnel_schlick_rgb(v3(fma(p.metallic, p.base.x, f0), fma(p.metallic, p.base.y, f0),
                                fma(p.metallic, p.base.z, f0)),
                             cos_h);
}

/* The base, seen from wo: how much of its cosine lobe is returned but for what is kept from wi, and
 * the probability of sampling it, its share of the albedo. */
typedef struct GltfBelow {
  float strength;
  float probability;
  float pad0, pad1, pad2;
} GltfBelow;

CDL_INLINE float gltf_left(GltfParams p, float cosine) {
  GltfAlbedo albedo = gltf_albedo(gltf_facets_of(p), cosine);
  return 1.0f - gltf_reflected(albedo, fresnel_f0(p.ior), 1.0f);
}

CDL_INLINE GltfBelow gltf_below(GltfParams p, vec3 wo) {
  GltfBelow below = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  GltfFacets facets = gltf_facets_of(p);
  GltfAlbedo albedo = gltf_albedo(facets, math_saturate(wo.z));
  float f0 = fresnel_f0(p.ior);
  float most = math_lerp(f0, v3_max(p.base), p.metallic);
  float specular = gltf_reflected(albedo, most, 1.0f);
  float left = (1.0f - p.metallic) * (1.0f - gltf_reflected(albedo, f0, 1.0f));
  float diffuse = left * v3_max(p.base);
  float mean = 1.0f - gltf_reflected(gltf_albedo_mean(facets), f0, 1.0f);
  below.strength = left / math_max(mean, GLTF_LEFT_MIN);
  below.probability = diffuse / (specular + diffuse);
  return below;
}

CDL_INLINE BsdfValue gltf_value(GltfParams p, GltfBelow below, vec3 wo, vec3 wi) {
  MicrofacetLobe lobe = microfacet_evaluate(gltf_surface(p), wo, wi);
  float cosine = math_saturate(wi.z);
  float cosine_pdf = CDL_INV_PI * cosine;
  vec3 specular = v3_scale(gltf_fresnel(p, lobe.cos_h), lobe.f_cos);
  float left = gltf_left(p, cosine);
  vec3 f_cos = v3_madd(specular, below.strength * left * cosine_pdf, p.base);
  return bsdf_value(f_cos, math_lerp(lobe.pdf, cosine_pdf, below.probability));
}

CDL_INLINE BsdfValue gltf_evaluate(GltfParams p, vec3 wo, vec3 wi) {
  return gltf_value(p, gltf_below(p, wo), wo, wi);
}

CDL_INLINE BsdfSample gltf_sample(GltfParams p, vec3 wo, float u, float v, float w) {
  GltfBelow below = gltf_below(p, wo);
  vec3 normal = microfacet_sample_normal(gltf_surface(p), wo, u, v);
  int specular = w >= below.probability;
  vec3 wi = v3_select(specular, fresnel_reflect(wo, normal), sample_cosine_hemisphere(u, v));
  BsdfValue value = gltf_value(p, below, wo, wi);
  return bsdf_sample(wi, v3_scale(value.f_cos, bsdf_reciprocal(value.pdf)), value.pdf);
}

#endif
