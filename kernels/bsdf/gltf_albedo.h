/* gltf_albedo.h: what glTF's specular lobe reflects in all, so that what lies below gets the rest.
 *
 * The lobe is GGX with separable masking and Schlick's Fresnel. Its directional albedo is
 * E(w) = f0 white(w) + (f90 - f0) edge(w): white that of facets that reflect all, edge that of
 * facets that reflect (1 - w.h)^5. A diffuse layer below, weighted by
 *
 *   (1 - E(wo)) (1 - E(wi)) / (1 - mean of E over the hemisphere)
 *
 * is reciprocal, and white returns just what the lobe leaves (Kelemen and Szirmay-Kalos 2001, "A
 * Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling"; Ashikhmin and
 * Shirley 2000). So light that single scattering loses enters the base.
 *
 * Both are fitted by scripts/fit_gltf_albedo.py to a quadrature, from above, and their means from
 * below: no more than all is ever returned. For alpha from 1e-3 to 1 and cosines from 0.01, E is
 * too high by at most 0.006 at f0 0.04 (0.003 on average), 0.007 at 0.25, the index 3, and 0.017 at
 * 1; a white dielectric returns 0.9934 to 1 of uniform light at f0 0.04, 0.9917 to 1 at 0.25, and
 * 0.93 to 1 at f0 1, where what little is below matters less.
 *
 * Anisotropic facets count as isotropic ones of an alpha by direction. That is above E too, by 0.04
 * on average and, at grazing angles of very unlike alphas, by up to 0.34. */
#ifndef CDL_BSDF_GLTF_ALBEDO_H
#define CDL_BSDF_GLTF_ALBEDO_H

#include "bsdf/microfacet.h"
#include "lib/math.h"

#define GLTF_ALPHA_MIN 1e-3f             /* of smooth surfaces, so that they have a density */
#define GLTF_ROUGHNESS_MIN 0.0316227766f /* its root */

#define GLTF_ALBEDO_RISE 0.0029f        /* of edge above its fit */
#define GLTF_ALBEDO_NARROW 0.25f        /* by how much alpha counts as less, */
#define GLTF_ALBEDO_KEEP 0.35f          /* light is not counted as lost */
#define GLTF_ALBEDO_UNLIKE_RISE 0.003f  /* and edge rises, where the alphas are very unlike */
#define GLTF_SCHLICK_MEAN 0.0476190476f /* of (1 - cosine)^5, weighted by the cosine */

typedef struct GltfAlbedo {
  float white, edge;
  float pad0, pad1, pad2;
} GltfAlbedo;

/* Facets, as the fits see them. */
typedef struct GltfFacets {
  float alpha;     /* roughness^2 */
  float roughness; /* [GLTF_ROUGHNESS_MIN,1] */
  float lose;      /* scale of what is lost */
  float rise;      /* of edge */
  float pad;
} GltfFacets;

CDL_INLINE GltfFacets gltf_facets(float roughness) {
  GltfFacets f = {roughness * roughness, roughness, 1.0f, GLTF_ALBEDO_RISE, 0.0f};
  return f;
}

/* Anisotropic ones, along2 the square of alpha along some direction. */
CDL_INLINE GltfFacets gltf_facets_along(Microfacets m, float along2) {
  float least = math_min(m.alpha_x, m.alpha_y);
  float unlike = 1.0f - least / math_max(m.alpha_x, m.alpha_y);
  float alpha = sqrt(0.5f * fma(least, least, along2)) * fma(-GLTF_ALBEDO_NARROW, unlike, 1.0f);
  GltfFacets f = gltf_facets(sqrt(math_max(alpha, GLTF_ALPHA_MIN)));
  f.lose = fma(-GLTF_ALBEDO_KEEP, unlike, 1.0f);
  f.rise = fma(GLTF_ALBEDO_UNLIKE_RISE, unlike, GLTF_ALBEDO_RISE);
  return f;
}

/* The same for the direction w, in the facets' frame. */
CDL_INLINE GltfFacets gltf_facets_toward(Microfacets m, vec3 w) {
  float x = m.alpha_x * w.x;
  float y = m.alpha_y * w.y;
  float sin2 = fma(w.x, w.x, w.y * w.y);
  return gltf_facets_along(m, fma(x, x, y * y) / math_max(sin2, 1e-12f));
}

/* The same for means over all directions: such that those are not above the fits'. */
CDL_INLINE GltfFacets gltf_facets_mean(Microfacets m) {
  float least = math_min(m.alpha_x, m.alpha_y);
  float most = math_max(m.alpha_x, m.alpha_y);
  return gltf_facets_along(m, 0.5f * fma(most, most, least * least));
}

/* 1 - white: y = alpha / (alpha + cosine). */
CDL_INLINE float gltf_albedo_loss(GltfFacets f, float cosine, float y) {
  float alpha2 = f.alpha * f.alpha;
  float turned = alpha2 * cosine;
  float p = fma(fma(-5.149101f, y, 12.9449f), y, fma(-1.379228f, turned, -9.389911f));
  p = fma(p, y, fma(-4.584366f * turned, cosine, -0.2897495f * alpha2));
  p = fma(p, y, fma(0.2072936f * f.roughness, f.alpha, 1.780618f));
  p = fma(p, y, fma(1.634203f, turned, -0.1277626f));
  return fma(p, y, f.alpha * fma(0.5451186f, f.roughness, -0.1499398f));
}

/* The cosine at which (1 - cosine)^5 is edge / white. */
CDL_INLINE float gltf_albedo_cosine(GltfFacets f, float cosine, float y) {
  float cube = f.alpha * f.roughness;
  float p = f.roughness * fma(-0.1056711f, cosine, fma(1.420546f, f.roughness, -0.2146881f));
  p = fma(p, y, fma(4.385256f, cosine, fma(0.5088334f, f.roughness, -0.005824745f)));
  float slope = fma(0.3828287f, cube, -3.322919f * f.roughness);
  p = fma(p, y, fma(slope, cosine, -2.592439f * cube));
  float rest = f.alpha * fma(1.189171f, f.alpha, 0.2090775f);
  return fma(p, y, fma(fma(-0.04185699f, cube, 1.0f), cosine, rest));
}

/* cosine > 0, to the shading normal */
CDL_INLINE GltfAlbedo gltf_albedo(GltfFacets f, float cosine) {
  GltfAlbedo a = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  float y = f.alpha / (f.alpha + cosine);
  a.white = fma(-f.lose, math_saturate(gltf_albedo_loss(f, cosine, y)), 1.0f);
  float weight = fresnel_schlick_weight(gltf_albedo_cosine(f, cosine, y));
  a.edge = math_min(fma(a.white, weight, f.rise), a.white);
  return a;
}

/* Means, weighted by the cosine. */
CDL_INLINE GltfAlbedo gltf_albedo_mean(GltfFacets f) {
  GltfAlbedo a = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  float r = f.roughness;
  float loss = fma(fma(fma(-0.4187929f, r, -0.3749449f), r, 1.619479f), r, -0.2121115f);
  a.white = fma(-f.lose, fma(f.alpha, loss, 0.000776401f), 1.0f);
  float edge = fma(fma(-0.2738139f, r, 0.6637873f), r, -0.4938194f);
  a.edge = fma(fma(edge, r, 0.05851433f), r, 0.04836868f);
  return a;
}

/* E. */
CDL_INLINE float gltf_reflected(GltfAlbedo a, float f0, float f90) {
  return fma(f90 - f0, a.edge, f0 * a.white);
}

/* The least mean of 1 - E, to divide by: where f0 is 1. More than it is conserves too. */
#define GLTF_LEFT_MIN 1e-4f

#endif
