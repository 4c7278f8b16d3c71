/* microfacet.h: reflection by a rough surface of mirrors: GGX or Beckmann normals, Smith masking,
 * sampling of visible normals, bounded where they reflect; anisotropic throughout.
 *
 * +Z is the surface's normal. alpha is the microfacet alpha along X and Y. */
#ifndef CDL_BSDF_MICROFACET_H
#define CDL_BSDF_MICROFACET_H

#include "bsdf/beckmann.h"
#include "bsdf/fresnel.h"
#include "lib/math.h"
#include "lib/vec.h"

/* The least alpha that directions in single precision can tell from a mirror; models with both
 * alphas below it are delta lobes, one alone is raised to it. */
#define MICROFACET_ALPHA_MIN 1e-4f

typedef struct Microfacets {
  float alpha_x, alpha_y; /* >= MICROFACET_ALPHA_MIN */
  int beckmann;           /* else GGX */
  int separable;          /* masking G1 G1; else correlated by height */
  int smooth;             /* 1: to be treated as a mirror */
} Microfacets;

CDL_INLINE Microfacets microfacet_surface(float alpha_x, float alpha_y, int beckmann,
                                          int separable) {
  Microfacets m;
  m.alpha_x = math_max(alpha_x, MICROFACET_ALPHA_MIN);
  m.alpha_y = math_max(alpha_y, MICROFACET_ALPHA_MIN);
  m.beckmann = beckmann;
  m.separable = separable;
  m.smooth = math_max(alpha_x, alpha_y) < MICROFACET_ALPHA_MIN;
  return m;
}

/* D(h): area of facets with normal h, |h| = 1, h.z >= 0, per solid angle and surface area. */
CDL_INLINE float microfacet_density(Microfacets m, vec3 h) {
  float x = h.x / m.alpha_x;
  float y = h.y / m.alpha_y;
  float xy2 = fma(x, x, y * y);
  float z2 = math_max(h.z * h.z, 1e-12f);
  float q = xy2 + z2;
  float ggx = CDL_INV_PI / (m.alpha_x * m.alpha_y * q * q);
  float beckmann = beckmann_density(xy2 / z2, sqrt(z2), m.alpha_x, m.alpha_y);
  return m.beckmann ? beckmann : ggx;
}

/* Smith's Lambda(w) (Heitz 2014, eqs. 68 to 72), w.z > 0. */
CDL_INLINE float microfacet_lambda(Microfacets m, vec3 w) {
  float x = m.alpha_x * w.x;
  float y = m.alpha_y * w.y;
  float z = math_max(w.z, 1e-9f);
  float xy2 = fma(x, x, y * y);
  float t = xy2 / (z * z); /* (alpha tan theta)^2 */
  float ggx = 0.5f * t / (1.0f + sqrt(1.0f + t));
  float beckmann = beckmann_lambda(z / sqrt(math_max(xy2, 1e-30f)));
  return m.beckmann ? beckmann : ggx;
}

/* The microfacet BRDF from its parts (Cook and Torrance 1982; Walter et al. 2007, eq. 20). */
CDL_INLINE float microfacet_product(float d, float g, float f, float cos_i, float cos_o) {
  return d * g * f / (4.0f * cos_i * cos_o);
}

/* Solid angle of half vectors over solid angle of the reflected directions wi: 1 / (4 wo.h). */
CDL_INLINE float microfacet_half_vector_jacobian(float cos_h) { return 0.25f / cos_h; }

/* Density of the normals that wo sees, D G1(wo) (wo.h) / wo.z: integrates to 1 (Heitz 2014). */
CDL_INLINE float microfacet_visible_density(float d, float g1, float cos_h, float cos_o) {
  return d * g1 * cos_h / cos_o;
}

/* How much of the cap below the horizon reflection needs, [0,1], wo.z > 0: the directions that
 * normals seen by wo reflect it to are, on the stretched surface, within a cap that ends at
 * -bound w.z (Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", eqs. 5 and
 * 6). Beckmann's normals are drawn unbounded. */
CDL_INLINE float microfacet_bound(Microfacets m, vec3 wo) {
  float a = math_min(math_min(m.alpha_x, m.alpha_y), 1.0f);
  float a2 = a * a;
  float s = 1.0f + math_safe_sqrt((1.0f - wo.z) * (1.0f + wo.z));
  float s2 = s * s;
  float bound = (1.0f - a2) * s2 / fma(a2 * wo.z, wo.z, s2);
  return m.beckmann ? 1.0f : bound;
}

/* What one pair of directions has of the lobe, without Fresnel's factor. */
typedef struct MicrofacetLobe {
  float cos_h;  /* wo.h = wi.h, h halfway between */
  float f_cos;  /* D G / (4 wo.z); 0 unless both directions are above the surface */
  float pdf;    /* of wi when visible normals are sampled, microfacet_sample_normal */
  float weight; /* f_cos / pdf = G / G1(wo), without the division */
  float bounded_pdf, bounded_weight; /* the same for microfacet_sample_reflection */
} MicrofacetLobe;

CDL_INLINE MicrofacetLobe microfacet_evaluate(Microfacets m, vec3 wo, vec3 wi) {
  MicrofacetLobe lobe;
  vec3 sum = v3_add(wo, wi);
  float length = v3_length(sum);
  vec3 h = v3_scale(sum, length > 0.0f ? 1.0f / length : 0.0f);
  int above = wo.z > 0.0f && wi.z > 0.0f;
  float cos_o = math_max(wo.z, 1e-9f);
  float cos_i = math_max(wi.z, 1e-9f);
  float bound = microfacet_bound(m, wo);
  float d = microfacet_density(m, h);
  float lambda_o = microfacet_lambda(m, wo);
  float g1 = 1.0f / (1.0f + lambda_o);
  float lambda_i = microfacet_lambda(m, wi);
  float masked = (1.0f + lambda_o) / (1.0f + lambda_o + lambda_i);
  float ratio = m.separable ? 1.0f / (1.0f + lambda_i) : masked;
  float cos_h = math_max(0.5f * length, 1e-9f); /* wo.h and wi.h alike, whatever rounds */
  float f_cos = cos_i * microfacet_product(d, g1 * ratio, 1.0f, cos_i, cos_o);
  float visible = microfacet_visible_density(d, g1, cos_h, cos_o);
  float pdf = visible * microfacet_half_vector_jacobian(cos_h);
  lobe.cos_h = math_min(cos_h, 1.0f);
  lobe.f_cos = above ? f_cos : 0.0f;
  lobe.pdf = above ? pdf : 0.0f;
  lobe.weight = above ? ratio : 0.0f;
  /* (1 + 2 Lambda) wo.z is the length of the stretched wo */
  float gain = fma(2.0f, lambda_o, 1.0f + bound) * (0.5f * g1);
  lobe.bounded_pdf = lobe.pdf / gain;
  lobe.bounded_weight = lobe.weight * gain;
  return lobe;
}

/* A visible normal of a GGX surface of roughness 1: a point of the spherical cap above z = -bottom,
 * and the vector from -w, |w| = 1, to it (Dupuy and Benyoub 2023). bottom = w.z gives all normals
 * that w sees. */
CDL_INLINE vec3 microfacet_ggx_cap_normal(vec3 w, float bottom, float u, float v) {
  float sine, cosine;
  math_sincos_2pi(u, &sine, &cosine);
  float drop = v * (1.0f + bottom); /* 1 - z of the point */
  float radius = math_safe_sqrt(drop * (2.0f - drop));
  return v3(fma(radius, cosine, w.x), fma(radius, sine, w.y), (1.0f - drop) + w.z);
}

CDL_INLINE vec3 microfacet_ggx_visible_normal(vec3 w, float u, float v) {
  return microfacet_ggx_cap_normal(w, w.z, u, v);
}

/* The surface is stretched to roughness 1 and back (Heitz 2018, section 3). */
CDL_INLINE vec3 microfacet_sample_bounded(Microfacets m, vec3 wo, float bound, float u, float v) {
  vec3 w = v3_normalize(v3(m.alpha_x * wo.x, m.alpha_y * wo.y, math_max(wo.z, 1e-9f)));
  vec3 ggx = microfacet_ggx_cap_normal(w, bound * w.z, u, v);
  vec3 beckmann = beckmann_visible_normal(w, u, v);
  vec3 n = v3_select(m.beckmann, beckmann, ggx);
  return v3_normalize(v3(m.alpha_x * n.x, m.alpha_y * n.y, math_max(n.z, 0.0f)));
}

/* A normal drawn from those that wo sees, by microfacet_visible_density. u, v in [0,1). */
CDL_INLINE vec3 microfacet_sample_normal(Microfacets m, vec3 wo, float u, float v) {
  return microfacet_sample_bounded(m, wo, 1.0f, u, v);
}

/* wo reflected by a facet that it sees: fewer of these end below the horizon than by
 * microfacet_sample_normal. Density: MicrofacetLobe.bounded_pdf. */
CDL_INLINE vec3 microfacet_sample_reflection(Microfacets m, vec3 wo, float u, float v) {
  return fresnel_reflect(wo, microfacet_sample_bounded(m, wo, microfacet_bound(m, wo), u, v));
}

#endif
