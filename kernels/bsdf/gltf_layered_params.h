/* gltf_layered_params.h: what the layered glTF material depends on at one point, and Fresnel's
 * factors of its base: see gltf_layered.h. */
#ifndef CDL_BSDF_GLTF_LAYERED_PARAMS_H
#define CDL_BSDF_GLTF_LAYERED_PARAMS_H

#include "bsdf/bsdf.h"
#include "bsdf/clearcoat.h"
#include "bsdf/dispersion.h"
#include "bsdf/gltf_albedo.h"
#include "bsdf/iridescence.h"
#include "bsdf/microfacet.h"
#include "bsdf/sheen.h"

/* Which lobes are compiled: constants, so that the code of others is never made. */
#ifdef CDL_GLTF_CLEARCOAT
#define GLTF_CLEARCOAT 1
#else
#define GLTF_CLEARCOAT 0
#endif
#ifdef CDL_GLTF_SHEEN
#define GLTF_SHEEN 1
#else
#define GLTF_SHEEN 0
#endif
#ifdef CDL_GLTF_IRIDESCENCE
#define GLTF_IRIDESCENCE 1
#else
#define GLTF_IRIDESCENCE 0
#endif
#ifdef CDL_GLTF_ANISOTROPY
#define GLTF_ANISOTROPY 1
#else
#define GLTF_ANISOTROPY 0
#endif
#ifdef CDL_GLTF_TRANSMISSION
#define GLTF_TRANSMISSION 1
#else
#define GLTF_TRANSMISSION 0
#endif
#ifdef CDL_GLTF_DIFFUSE_TRANSMISSION
#define GLTF_DIFFUSE_TRANSMISSION 1
#else
#define GLTF_DIFFUSE_TRANSMISSION 0
#endif
#ifdef CDL_GLTF_RETROREFLECTION
#define GLTF_RETROREFLECTION 1
#else
#define GLTF_RETROREFLECTION 0
#endif
#ifdef CDL_GLTF_DISPERSION
#define GLTF_DISPERSION 1
#else
#define GLTF_DISPERSION 0
#endif
#define GLTF_TRANSMITS (GLTF_TRANSMISSION | GLTF_DIFFUSE_TRANSMISSION)

/* What single precision can tell: the least index, and the least width of the refracted lobe,
 * alpha |eta - 1|, that is not taken for 0. */
#define GLTF_IOR_MIN 1.001f
#define GLTF_WIDTH_MIN 2e-5f

typedef struct GltfLayeredParams {
  vec3 base; /* base colour */
  vec3 f0;   /* of the dielectric at normal incidence, and */
  float f90; /* at grazing incidence */
  float ior; /* its index */
  float metallic;
  Microfacets surface;                  /* along direction_x, direction_y and across */
  float direction_x, direction_y;       /* unit: where anisotropy stretches, in the tangent plane */
  int smooth;                           /* what is transmitted is one direction */
  int solid;                            /* the boundary of a volume; else thin */
  int outside;                          /* wo is not inside of a volume */
  float eta;                            /* index beyond over index before; 1 where thin */
  float transmission;                   /* [0,1], of what enters */
  float diffuse_transmission;           /* [0,1], of what is scattered diffusely */
  vec3 diffuse_tint;                    /* of that */
  vec3 channels;                        /* weights of the path's colour channels, once dispersed */
  float retroreflection;                /* [0,1] */
  float film, film_ior, film_thickness; /* strength, index, nm */
  vec3 sheen_color;
  Sheen sheen;
  float coat; /* strength */
  vec3 coat_normal;
  Microfacets coat_surface;
} GltfLayeredParams;

/* A word that is a factor of [0,1]; 0 where its lobe is not compiled. */
CDL_INLINE float gltf_factor(int compiled, CDL_GLOBAL const uint *params, uint word, size_t stride,
                             size_t i) {
  return compiled ? math_saturate(param_float(params, word, stride, i)) : 0.0f;
}

CDL_INLINE void gltf_read_base(GltfLayeredParams *p, CDL_GLOBAL const uint *params, size_t stride,
                               size_t i) {
  float specular = gltf_factor(1, params, CDL_GLTF_LAYERED_SPECULAR, stride, i);
  vec3 color = param_vec3(params, CDL_GLTF_LAYERED_SPECULAR_COLOR, stride, i);
  p->ior = param_float(params, CDL_GLTF_LAYERED_IOR, stride, i);
  float plain = fresnel_f0(p->ior);
  p->f0 = v3(specular * math_min(plain * color.x, 1.0f), specular * math_min(plain * color.y, 1.0f),
             specular * math_min(plain * color.z, 1.0f));
  p->f90 = specular;
  p->metallic = gltf_factor(1, params, CDL_GLTF_LAYERED_METALLIC, stride, i);
  p->retroreflection =
      gltf_factor(GLTF_RETROREFLECTION, params, CDL_GLTF_LAYERED_RETROREFLECTION, stride, i);
}

/* The direction of the words, turned by the rotation of the words. */
CDL_INLINE void gltf_read_direction(GltfLayeredParams *p, int mirrored,
                                    CDL_GLOBAL const uint *params, size_t stride, size_t i) {
  float cosine = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_ROTATION, stride, i);
  float sine = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_ROTATION + 1u, stride, i);
  float x = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_DIRECTION, stride, i);
  float y = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_DIRECTION + 1u, stride, i);
  float turned_x = fma(cosine, x, -(sine * y));
  float turned_y = fma(sine, x, cosine * y);
  float length = sqrt(fma(turned_x, turned_x, turned_y * turned_y));
  int known = length > 1e-6f;
  float scale = 1.0f / (known ? length : 1.0f);
  p->direction_x = known ? turned_x * scale : 1.0f;
  scale = mirrored ? -scale : scale;
  p->direction_y = known ? turned_y * scale : 0.0f;
}

/* alpha along the direction of anisotropy is mix(alpha, 1, strength^2). */
CDL_INLINE void gltf_read_surface(GltfLayeredParams *p, int mirrored, CDL_GLOBAL const uint *params,
                                  size_t stride, size_t i) {
  float roughness = gltf_factor(1, params, CDL_GLTF_LAYERED_ROUGHNESS, stride, i);
  float strength =
      gltf_factor(GLTF_ANISOTROPY, params, CDL_GLTF_LAYERED_ANISOTROPY_STRENGTH, stride, i);
  float alpha = roughness * roughness;
  float along = GLTF_ANISOTROPY ? math_lerp(alpha, 1.0f, strength * strength) : alpha;
  p->direction_x = 1.0f;
  p->direction_y = 0.0f;
  if (GLTF_ANISOTROPY) gltf_read_direction(p, mirrored, params, stride, i);
  p->smooth = along < GLTF_ALPHA_MIN;
  p->surface =
      microfacet_surface(math_max(along, GLTF_ALPHA_MIN), math_max(alpha, GLTF_ALPHA_MIN), 0, 1);
}

CDL_INLINE void gltf_read_transmission(GltfLayeredParams *p, BsdfPoint point,
                                       CDL_GLOBAL const uint *params, size_t stride, size_t i) {
  float thickness =
      GLTF_TRANSMITS ? param_float(params, CDL_GLTF_LAYERED_THICKNESS, stride, i) : 0.0f;
  float dispersion =
      GLTF_DISPERSION ? param_float(params, CDL_GLTF_LAYERED_DISPERSION, stride, i) : 0.0f;
  p->transmission =
      gltf_factor(GLTF_TRANSMISSION, params, CDL_GLTF_LAYERED_TRANSMISSION, stride, i);
  p->diffuse_transmission = gltf_factor(GLTF_DIFFUSE_TRANSMISSION, params,
                                        CDL_GLTF_LAYERED_DIFFUSE_TRANSMISSION, stride, i);
  p->solid = (thickness > 0.0f) & (p->transmission + p->diffuse_transmission > 0.0f);
  p->outside = p->solid ? point.front : 1;
  int disperses = p->solid && dispersion > 0.0f;
  Dispersion d = {v3_all(1.0f), p->ior, 0.0f};
  if (GLTF_DISPERSION) d = dispersion_choose(point, p->ior, disperses ? 20.0f / dispersion : 0.0f);
  float ior = math_max(d.ior, GLTF_IOR_MIN);
  float width = math_max(p->surface.alpha_x, p->surface.alpha_y) * (ior - 1.0f) / ior;
  p->channels = d.weight;
  p->eta = p->solid ? (point.front ? ior : 1.0f / ior) : 1.0f;
  p->smooth = p->smooth || (p->solid && width < GLTF_WIDTH_MIN);
  p->diffuse_tint = GLTF_DIFFUSE_TRANSMISSION
                        ? param_vec3(params, CDL_GLTF_LAYERED_DIFFUSE_TRANSMISSION_COLOR, stride, i)
                        : v3_all(0.0f);
}

CDL_INLINE void gltf_read_film(GltfLayeredParams *p, CDL_GLOBAL const uint *params, size_t stride,
                               size_t i) {
  float strength = gltf_factor(1, params, CDL_GLTF_LAYERED_IRIDESCENCE, stride, i);
  p->film_ior = param_float(params, CDL_GLTF_LAYERED_IRIDESCENCE_IOR, stride, i);
  p->film_thickness = param_float(params, CDL_GLTF_LAYERED_IRIDESCENCE_THICKNESS, stride, i);
  p->film = p->film_thickness > 0.0f ? strength : 0.0f;
}

CDL_INLINE void gltf_read_sheen(GltfLayeredParams *p, CDL_GLOBAL const uint *params, size_t stride,
                                size_t i) {
  p->sheen_color = param_vec3(params, CDL_GLTF_LAYERED_SHEEN_COLOR, stride, i);
  p->sheen = sheen_make(param_float(params, CDL_GLTF_LAYERED_SHEEN_ROUGHNESS, stride, i));
}

CDL_INLINE void gltf_read_coat(GltfLayeredParams *p, vec3 normal, CDL_GLOBAL const uint *params,
                               size_t stride, size_t i) {
  float roughness = gltf_factor(1, params, CDL_GLTF_LAYERED_CLEARCOAT_ROUGHNESS, stride, i);
  p->coat = gltf_factor(1, params, CDL_GLTF_LAYERED_CLEARCOAT, stride, i);
  p->coat_normal = normal;
  p->coat_surface = clearcoat_surface(roughness);
}

CDL_INLINE GltfLayeredParams gltf_layered_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                                 size_t stride, size_t i) {
  GltfLayeredParams p;
  p.base = point.base;
  gltf_read_base(&p, params, stride, i);
  gltf_read_surface(&p, point.mirrored, params, stride, i);
  gltf_read_transmission(&p, point, params, stride, i);
  if (GLTF_IRIDESCENCE) gltf_read_film(&p, params, stride, i);
  if (GLTF_SHEEN) gltf_read_sheen(&p, params, stride, i);
  if (GLTF_CLEARCOAT) gltf_read_coat(&p, point.coat_normal, params, stride, i);
  return p;
}

/* What facets at one angle do with light. */
typedef struct GltfFacet {
  vec3 specular; /* reflected */
  float rest;    /* what enters the dielectric */
  float pad;
} GltfFacet;

CDL_INLINE vec3 gltf_mix(vec3 a, vec3 b, float t) {
  return v3(math_lerp(a.x, b.x, t), math_lerp(a.y, b.y, t), math_lerp(a.z, b.z, t));
}

/* The material's film, where it may have one. */
CDL_INLINE ThinFilm gltf_film(GltfLayeredParams p, float cosine) {
  ThinFilm none = {0};
  return GLTF_IRIDESCENCE ? film_make(p.film_ior, p.film_thickness, cosine) : none;
}

/* Schlick's Fresnel from f0 to f90; the film's where there is one. */
CDL_INLINE vec3 gltf_fresnel_at(GltfLayeredParams p, ThinFilm film, vec3 f0, float f90,
                                float cosine) {
  vec3 fresnel = gltf_mix(f0, v3_all(f90), fresnel_schlick_weight(cosine));
  return GLTF_IRIDESCENCE ? gltf_mix(fresnel, film_reflectance(film, f0), p.film) : fresnel;
}

/* Inside of what transmits, Schlick's formula, which is the one from outside, takes the cosine
 * beyond the boundary. */
typedef struct GltfAngle {
  float cosine;
  int total; /* 1: all is reflected */
  float pad0, pad1, pad2;
} GltfAngle;

CDL_INLINE int gltf_inside(GltfLayeredParams p) {
  return GLTF_TRANSMISSION && !p.outside && p.transmission > 0.0f;
}

CDL_INLINE GltfAngle gltf_angle(GltfLayeredParams p, float cosine) {
  GltfAngle angle = {cosine, 0, 0.0f, 0.0f, 0.0f};
  int inside = gltf_inside(p);
  float squared = fma(cosine, cosine, (p.eta - 1.0f) * (p.eta + 1.0f));
  float beyond = math_min(math_safe_sqrt(squared) / p.eta, 1.0f);
  angle.cosine = inside ? beyond : cosine;
  angle.total = inside && squared <= 0.0f;
  return angle;
}

/* Facets at an angle. */
CDL_INLINE GltfFacet gltf_facet_at(GltfLayeredParams p, GltfAngle angle) {
  GltfFacet facet;
  ThinFilm film = gltf_film(p, angle.cosine);
  vec3 dielectric = gltf_fresnel_at(p, film, p.f0, p.f90, angle.cosine);
  dielectric = v3_select(angle.total, v3_all(1.0f), dielectric);
  vec3 metal = gltf_fresnel_at(p, film, p.base, 1.0f, angle.cosine);
  facet.specular = gltf_mix(dielectric, metal, p.metallic);
  facet.rest = (1.0f - p.metallic) * (1.0f - v3_max(dielectric));
  facet.pad = 0.0f;
  return facet;
}

/* Facets at cos_h to wo. */
CDL_INLINE GltfFacet gltf_facet(GltfLayeredParams p, float cos_h) {
  return gltf_facet_at(p, gltf_angle(p, cos_h));
}

/* Facets that refract, by the cosine on the outer side: it is at hand there, and would cancel if it
 * were worked out from the inner one near the critical angle. */
CDL_INLINE GltfFacet gltf_facet_outside(GltfLayeredParams p, float cos_h) {
  GltfAngle angle = {cos_h, 0, 0.0f, 0.0f, 0.0f};
  return gltf_facet_at(p, angle);
}

/* ---- what the dielectric's specular lobe reflects in all ---- */

/* From inside, facets that lean count as ones at a cosine that is less by
 * GLTF_INSIDE_SHIFT alpha / (alpha + GLTF_INSIDE_ALPHA), fitted to be no more than what passes. */
#define GLTF_INSIDE_SHIFT 0.18f
#define GLTF_INSIDE_ALPHA 0.02f

/* For light at w, in the facets' frame, of wo's side. */
CDL_INLINE GltfAlbedo gltf_layered_albedo(GltfLayeredParams p, vec3 w) {
  float cosine = math_saturate(w.z);
  float alpha = math_max(p.surface.alpha_x, p.surface.alpha_y);
  GltfAlbedo albedo = gltf_albedo(
      GLTF_ANISOTROPY ? gltf_facets_toward(p.surface, w) : gltf_facets(sqrt(alpha)), cosine);
  if (GLTF_TRANSMISSION) {
    float shift = GLTF_INSIDE_SHIFT * alpha / (alpha + GLTF_INSIDE_ALPHA);
    GltfAngle angle = gltf_angle(p, math_max(cosine - shift, 0.0f));
    float edge = angle.total ? 1.0f : fresnel_schlick_weight(angle.cosine);
    int inside = gltf_inside(p);
    albedo.white = inside ? 1.0f : albedo.white;
    albedo.edge = inside ? edge : albedo.edge;
  }
  return albedo;
}

/* Its mean over all directions. */
CDL_INLINE GltfAlbedo gltf_layered_albedo_mean(GltfLayeredParams p) {
  GltfAlbedo albedo = gltf_albedo_mean(GLTF_ANISOTROPY ? gltf_facets_mean(p.surface)
                                                       : gltf_facets(sqrt(p.surface.alpha_x)));
  int inside = gltf_inside(p);
  albedo.white = inside ? 1.0f : albedo.white;
  albedo.edge = inside ? GLTF_SCHLICK_MEAN : albedo.edge;
  return albedo;
}

/* No less than what a film reflects in all, whatever its thickness: the two boundaries' albedos and
 * what interference may add, by the inequality of Cauchy and Schwarz, 1.785 being the greatest
 * absolute response of a channel. The inner boundary is seen at the cosine within the film. */
CDL_INLINE float gltf_film_albedo(GltfLayeredParams p, GltfAlbedo albedo) {
  float n = math_max(p.film_ior, 1.0f);
  float least = film_inner_f0(n, math_min(math_min(p.f0.x, p.f0.y), p.f0.z));
  float most = film_inner_f0(n, v3_max(p.f0));
  float inner = math_max(least, most);
  float outer = p.film_ior < 1.0f ? 1.0f : fresnel_f0(n);
  float limit = fresnel_schlick_weight(math_safe_sqrt(1.0f - 1.0f / (n * n)));
  float first = fma(1.0f - outer, albedo.edge, outer * albedo.white);
  float edge = math_min(albedo.edge, limit * albedo.white);
  float second = fma(1.0f - inner, edge, inner * albedo.white);
  return math_min(fma(3.57f, sqrt(first * second), first + second), albedo.white);
}

/* What the lobe leaves of that. f90 does not lessen total reflection, nor a film. */
CDL_INLINE float gltf_layered_left(GltfLayeredParams p, GltfAlbedo albedo) {
  float reflected = gltf_reflected(albedo, v3_max(p.f0), gltf_inside(p) ? 1.0f : p.f90);
  if (GLTF_IRIDESCENCE) reflected = math_lerp(reflected, gltf_film_albedo(p, albedo), p.film);
  return 1.0f - reflected;
}

/* The mean of it; within a volume of what light from outside leaves over the index squared, as what
 * passes a boundary is the same from either side. */
CDL_INLINE float gltf_layered_left_mean(GltfLayeredParams p) {
  GltfAlbedo mean = gltf_layered_albedo_mean(p);
  float reflected = gltf_reflected(mean, v3_max(p.f0), gltf_inside(p) ? 1.0f : p.f90);
  if (GLTF_IRIDESCENCE) {
    mean.edge = 0.0f;
    reflected = math_lerp(reflected, gltf_film_albedo(p, mean), p.film);
  }
  float left = 1.0f - reflected;
  return math_max(gltf_inside(p) ? left * p.eta * p.eta : left, GLTF_LEFT_MIN);
}

#endif
