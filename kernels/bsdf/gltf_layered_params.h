/* gltf_layered_params.h: what the layered glTF material depends on at one point, and Fresnel's
 * factors of its base: see gltf_layered.h. */
#ifndef CDL_BSDF_GLTF_LAYERED_PARAMS_H
#define CDL_BSDF_GLTF_LAYERED_PARAMS_H

#include "bsdf/bsdf.h"
#include "bsdf/clearcoat.h"
#include "bsdf/gltf.h"
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

/* Refraction by less than this cannot be told from none in single precision. */
#define GLTF_IOR_MIN 1.001f

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
CDL_INLINE void gltf_read_direction(GltfLayeredParams *p, CDL_GLOBAL const uint *params,
                                    size_t stride, size_t i) {
  float cosine = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_ROTATION, stride, i);
  float sine = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_ROTATION + 1u, stride, i);
  float x = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_DIRECTION, stride, i);
  float y = param_float(params, CDL_GLTF_LAYERED_ANISOTROPY_DIRECTION + 1u, stride, i);
  float turned_x = fma(cosine, x, -(sine * y));
  float turned_y = fma(sine, math_after(turned_x, x), cosine * y);
  float length = sqrt(fma(turned_x, turned_x, turned_y * turned_y));
  int known = length > 1e-6f;
  float scale = 1.0f / (known ? length : 1.0f);
  p->direction_x = known ? turned_x * scale : 1.0f;
  p->direction_y = known ? turned_y * math_after(p->direction_x, scale) : 0.0f;
}

/* alpha along the direction of anisotropy is mix(alpha, 1, strength^2). */
CDL_INLINE void gltf_read_surface(GltfLayeredParams *p, CDL_GLOBAL const uint *params,
                                  size_t stride, size_t i) {
  float roughness = gltf_factor(1, params, CDL_GLTF_LAYERED_ROUGHNESS, stride, i);
  float strength =
      gltf_factor(GLTF_ANISOTROPY, params, CDL_GLTF_LAYERED_ANISOTROPY_STRENGTH, stride, i);
  float alpha = roughness * roughness;
  float along = GLTF_ANISOTROPY ? math_lerp(alpha, 1.0f, strength * strength) : alpha;
  p->direction_x = 1.0f;
  p->direction_y = 0.0f;
  if (GLTF_ANISOTROPY) gltf_read_direction(p, params, stride, i);
  p->smooth = along < GLTF_ALPHA_MIN;
  p->surface = microfacet_surface(math_max(along, GLTF_ALPHA_MIN),
                                  math_max(math_after(along, alpha), GLTF_ALPHA_MIN), 0, 1);
}

/* The channel that a dispersed path has, drawn by its throughput, and that channel's index: the
 * whole spread n_F - n_C = (n - 1) / Abbe number between red and blue, dispersion being 20 over
 * Abbe's number. A path dispersed before has but one channel left, which is drawn again. */
CDL_INLINE float gltf_disperse(GltfLayeredParams *p, BsdfPoint point, float dispersion) {
  vec3 t = point.throughput;
  float sum = t.x + t.y + t.z;
  float pick = point.channel_choice * sum;
  int red = pick < t.x;
  int green = !red && pick < t.x + t.y;
  int blue = !red && !green;
  float own = red ? t.x : (green ? t.y : t.z);
  float weight = own > 0.0f ? sum / own : 0.0f;
  int disperses = dispersion > 0.0f;
  vec3 one = v3(red ? weight : 0.0f, green ? weight : 0.0f, blue ? weight : 0.0f);
  p->channels = v3_select(disperses, one, v3_all(1.0f));
  float half_spread = 0.025f * dispersion * (p->ior - 1.0f);
  return p->ior + (red ? -half_spread : (blue ? half_spread : 0.0f));
}

CDL_INLINE void gltf_read_transmission(GltfLayeredParams *p, BsdfPoint point,
                                       CDL_GLOBAL const uint *params, size_t stride, size_t i) {
  float thickness =
      GLTF_TRANSMITS ? param_float(params, CDL_GLTF_LAYERED_THICKNESS, stride, i) : 0.0f;
  float dispersion =
      GLTF_DISPERSION ? param_float(params, CDL_GLTF_LAYERED_DISPERSION, stride, i) : 0.0f;
  p->solid = thickness > 0.0f;
  p->outside = p->solid ? point.front : 1;
  p->channels = v3_all(1.0f);
  float ior = GLTF_DISPERSION ? gltf_disperse(p, point, p->solid ? dispersion : 0.0f) : p->ior;
  ior = math_max(ior, GLTF_IOR_MIN);
  p->eta = p->solid ? (point.front ? ior : 1.0f / ior) : 1.0f;
  p->transmission =
      gltf_factor(GLTF_TRANSMISSION, params, CDL_GLTF_LAYERED_TRANSMISSION, stride, i);
  p->diffuse_transmission = gltf_factor(GLTF_DIFFUSE_TRANSMISSION, params,
                                        CDL_GLTF_LAYERED_DIFFUSE_TRANSMISSION, stride, i);
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
  gltf_read_surface(&p, params, stride, i);
  gltf_read_transmission(&p, point, params, stride, i);
  if (GLTF_IRIDESCENCE) gltf_read_film(&p, params, stride, i);
  if (GLTF_SHEEN) gltf_read_sheen(&p, params, stride, i);
  if (GLTF_CLEARCOAT) gltf_read_coat(&p, point.coat_normal, params, stride, i);
  return p;
}

/* What facets at one angle do with light. */
typedef struct GltfFacet {
  vec3 specular;     /* reflected */
  float diffuse;     /* left for what is scattered below, */
  float transmitted; /* and for what passes: equal unless inside of a volume */
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

/* The dielectric seen from inside of a volume at cos_h: by the cosine beyond, where Schlick's
 * formula is the one from outside, and 1 under total reflection. */
CDL_INLINE vec3 gltf_fresnel_beyond(GltfLayeredParams p, float cos_h) {
  float squared = fma(cos_h, cos_h, (p.eta - 1.0f) * (p.eta + 1.0f));
  float cos_t = math_min(math_safe_sqrt(squared) / p.eta, 1.0f);
  vec3 fresnel = gltf_fresnel_at(p, gltf_film(p, cos_t), p.f0, p.f90, cos_t);
  return v3_select(squared > 0.0f, fresnel, v3_all(1.0f));
}

/* Facets at cos_h to wo. Inside of a volume, what is scattered takes the same part as outside. */
CDL_INLINE GltfFacet gltf_facet(GltfLayeredParams p, float cos_h) {
  GltfFacet facet;
  ThinFilm film = gltf_film(p, cos_h);
  vec3 dielectric = gltf_fresnel_at(p, film, p.f0, p.f90, cos_h);
  vec3 metal = gltf_fresnel_at(p, film, p.base, 1.0f, math_after(dielectric.z, cos_h));
  vec3 beyond = dielectric;
  if (GLTF_TRANSMISSION) {
    beyond = gltf_fresnel_beyond(p, math_after(metal.z, cos_h));
    beyond = v3_select(p.outside, dielectric, beyond);
  }
  vec3 specular = GLTF_TRANSMISSION ? gltf_mix(dielectric, beyond, p.transmission) : dielectric;
  float rest = 1.0f - p.metallic;
  facet.diffuse = rest * (1.0f - v3_max(dielectric));
  facet.transmitted = rest * (1.0f - v3_max(beyond));
  facet.specular = gltf_mix(specular, metal, p.metallic);
  return facet;
}

#endif
