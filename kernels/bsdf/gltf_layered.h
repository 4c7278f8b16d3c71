/* gltf_layered.h: glTF 2.0 metallic-roughness with the layers and lobes of KHR_materials_*:
 *
 *   coat over sheen over mix(dielectric, metal, metallic)
 *   dielectric = F specular + mix(scattered, (1 - max F) base specular transmission, transmission)
 *   scattered  = what specular leaves of mix(base / pi, tint / pi beyond, diffuse_transmission)
 *
 * Each lobe is compiled only where CDL_GLTF_CLEARCOAT, _SHEEN, _IRIDESCENCE, _ANISOTROPY,
 * _TRANSMISSION, _DIFFUSE_TRANSMISSION, _RETROREFLECTION or _DISPERSION is defined; with none it is
 * gltf.h with KHR_materials_specular, and the rest is as there: Schlick's Fresnel at wo.h, GGX of
 * alpha = roughness^2, separable masking.
 *
 * Where the extensions leave a choice or break reciprocity or energy, this is what was chosen.
 * - All lobes keep to 1 together. What is diffuse gets what the specular lobe leaves in all, of the
 *   channel where that is least: see gltf_albedo.h. With a film, the two boundaries count with all
 *   that interference may add at any thickness; inside of a volume, what a smooth boundary lets
 *   pass at a cosine lessened by roughness.
 * - Coat and sheen scale what is below by one symmetric factor, 1 - max(share of wo, of wi): see
 *   clearcoat.h and sheen.h.
 * - Specular transmission takes the same facets as reflection, so that both keep to 1 together.
 *   Thin: KHR_materials_transmission's mirrored reflection, alpha not changed by the index. With a
 *   volume: refraction (Walter et al. 2007), and total reflection, which `specular` does not
 * lessen.
 * - Smooth transmission, alpha below 1e-3 or an index near 1, is one direction.
 * - Coat and sheen are on both sides of thin surfaces, and outside of volumes, where what passes is
 *   scaled by its outer direction.
 * - Retroreflection turns the specular lobe of dielectric and metal, anisotropy, film and all, and
 *   nothing else (as the draft has it), by mirroring wo.
 * - Diffuse transmission is tint / pi from either side, of volumes too, as if there were no index;
 *   so a volume's boundary that also refracts is not reciprocal in that part.
 * - Dispersion leaves one colour channel to a path that enters a volume: see dispersion.h. */
#ifndef CDL_BSDF_GLTF_LAYERED_H
#define CDL_BSDF_GLTF_LAYERED_H

#include "bsdf/gltf_layered_params.h"
#include "lib/frame.h"
#include "lib/sampling.h"

/* Probabilities of sampling the lobes. */
typedef struct GltfChoice {
  float coat, sheen, retro, facets, diffuse; /* the rest is diffuse transmission */
  float through;
  float reflected; /* of `facets` on a smooth surface; else by half vector */
  float left;      /* of what is diffuse for wo, over its mean: see gltf_albedo.h */
} GltfChoice;

/* Into and out of the frame along the direction of anisotropy. */
CDL_INLINE vec3 gltf_turn(GltfLayeredParams p, vec3 w) {
  float x = fma(p.direction_x, w.x, p.direction_y * w.y);
  return v3(x, fma(p.direction_x, w.y, -(p.direction_y * w.x)), w.z);
}

CDL_INLINE vec3 gltf_turn_back(GltfLayeredParams p, vec3 w) {
  float x = fma(p.direction_x, w.x, -(p.direction_y * w.y));
  return v3(x, fma(p.direction_x, w.y, p.direction_y * w.x), w.z);
}

CDL_INLINE vec3 gltf_fold(vec3 w) { return v3(w.x, w.y, math_abs(w.z)); }

/* Of the light that facets reflect or let pass, the part reflected. */
CDL_INLINE float gltf_reflected_share(GltfLayeredParams p, GltfFacet facet) {
  float reflected = (1.0f - p.retroreflection) * v3_max(facet.specular);
  float sum = fma(p.transmission * facet.rest, v3_max(p.base), reflected);
  float share = reflected / (sum > 0.0f ? sum : 1.0f);
  return sum > 0.0f ? share : 1.0f;
}

/* What layers above keep from those below, for a pair of directions. */
typedef struct GltfCover {
  float coat, sheen;     /* what passes; 1: all */
  float lesser;          /* coat: the lesser Fresnel factor */
  float divisor;         /* sheen: of the lobe */
  float sheen_o, coat_o; /* shares of the two for wo alone */
} GltfCover;

/* Layers are outside of volumes alone. wi, of either side, may be wo. */
CDL_INLINE GltfCover gltf_cover(GltfLayeredParams p, vec3 wo, vec3 wi, vec3 coat_normal) {
  GltfCover cover = {1.0f, 1.0f, 0.0f, 1.0f, 0.0f, 0.0f};
  int outer_i = p.solid ? p.outside == (wi.z > 0.0f) : 1;
  if (GLTF_CLEARCOAT) {
    float fresnel_o = clearcoat_fresnel(p.coat, v3_dot(wo, coat_normal));
    float fresnel_i = clearcoat_fresnel(p.coat, v3_dot(wi, coat_normal));
    cover.coat_o = p.outside ? fresnel_o : 0.0f;
    fresnel_i = outer_i ? fresnel_i : 0.0f;
    cover.lesser = math_min(cover.coat_o, fresnel_i);
    cover.coat = 1.0f - math_max(cover.coat_o, fresnel_i);
  }
  if (GLTF_SHEEN) {
    float strength = v3_max(p.sheen_color);
    float albedo_o = sheen_albedo(p.sheen, wo.z);
    float albedo_i = sheen_albedo(p.sheen, math_abs(wi.z));
    albedo_o = p.outside ? albedo_o : 0.0f;
    float greater = math_max(albedo_o, outer_i ? albedo_i : 0.0f);
    cover.divisor = math_max(greater, 1.0f);
    cover.sheen = fma(-strength, math_min(greater, 1.0f), 1.0f);
    cover.sheen_o = strength * math_min(albedo_o, 1.0f);
  }
  return cover;
}

/* The frame of the coat; any where there is none. */
CDL_INLINE Frame gltf_coat_frame(GltfLayeredParams p, vec3 wo) {
  Frame none = {wo, wo, wo};
  return GLTF_CLEARCOAT ? clearcoat_frame(p.coat_normal, wo) : none;
}

/* What the specular lobe returns at most, by channel, but for a film on metal. */
CDL_INLINE float gltf_specular_share(GltfLayeredParams p, GltfAlbedo albedo, float left) {
  float metal = gltf_reflected(albedo, v3_max(p.base), 1.0f);
  metal = GLTF_IRIDESCENCE ? math_lerp(metal, albedo.white, p.film) : metal;
  return math_lerp(1.0f - left, metal, p.metallic);
}

/* By the lobes' albedos; none vanishes that an estimate may miss. */
CDL_INLINE GltfChoice gltf_choose(GltfLayeredParams p, vec3 wo) {
  GltfChoice choice;
  GltfAlbedo albedo = gltf_layered_albedo(p, gltf_turn(p, wo));
  float left = gltf_layered_left(p, albedo);
  GltfCover cover = gltf_cover(p, wo, wo, gltf_coat_frame(p, wo).z);
  float cover_o = (1.0f - cover.coat_o) * (1.0f - cover.sheen_o);
  float rest = cover_o * (1.0f - p.metallic);
  float scattered = rest * (1.0f - p.transmission) * math_max(left, 0.02f);
  float specular = cover_o * math_max(gltf_specular_share(p, albedo, left), 0.01f);
  float passed = 0.0f;
  choice.reflected = 1.0f;
  if (GLTF_TRANSMISSION) {
    GltfFacet facet = gltf_facet(p, wo.z);
    passed = math_max(cover_o * facet.rest, 0.2f * rest) * p.transmission;
    choice.reflected = math_max(gltf_reflected_share(p, facet), 0.01f);
  }
  choice.left = (1.0f - p.metallic) * left / gltf_layered_left_mean(p);
  choice.coat = cover.coat_o;
  choice.sheen = (1.0f - cover.coat_o) * cover.sheen_o;
  choice.retro = specular * p.retroreflection;
  choice.facets = fma(specular, 1.0f - p.retroreflection, passed * v3_max(p.base));
  choice.diffuse = scattered * (1.0f - p.diffuse_transmission) * v3_max(p.base);
  choice.through = scattered * p.diffuse_transmission * v3_max(p.diffuse_tint);
  float sum =
      choice.coat + choice.sheen + choice.retro + choice.facets + choice.diffuse + choice.through;
  float scale = 1.0f / (sum > 0.0f ? sum : 1.0f);
  choice.coat *= scale;
  choice.sheen *= scale;
  choice.retro *= scale;
  choice.facets *= scale;
  choice.diffuse = sum > 0.0f ? choice.diffuse * scale : 1.0f;
  choice.through *= scale;
  return choice;
}

/* Refraction by facets, wi.z < 0: f cos without Fresnel's and the base's factors, and the density
 * of wi when visible normals are sampled and all refract (Walter et al. 2007, eqs. 16, 17 and 21).
 */
typedef struct GltfRefraction {
  float outer; /* cosine of the facet to the direction outside */
  float f_cos, pdf;
  float pad0, pad1;
} GltfRefraction;

CDL_INLINE GltfRefraction gltf_refraction(GltfLayeredParams p, vec3 wo, vec3 wi) {
  GltfRefraction lobe;
  vec3 sum = v3_normalize(v3_madd(wo, p.eta, wi));
  vec3 h = v3_scale(sum, sum.z < 0.0f ? -1.0f : 1.0f);
  float cos_o = v3_dot(wo, h);
  float cos_i = -v3_dot(wi, h);
  int refracts = cos_o > 0.0f && cos_i > 0.0f && wi.z < 0.0f;
  float d = microfacet_density(p.surface, h);
  float g_o = 1.0f / (1.0f + microfacet_lambda(p.surface, wo));
  float g_i = 1.0f / (1.0f + microfacet_lambda(p.surface, gltf_fold(wi)));
  float visible = microfacet_visible_density(d, g_o, cos_o, math_max(wo.z, 1e-9f));
  float denominator = math_max(math_sqr(fma(-p.eta, cos_i, cos_o)), 1e-20f);
  float jacobian = p.eta * p.eta * cos_i / denominator;
  lobe.outer = math_clamp(p.outside ? cos_o : cos_i, 0.0f, 1.0f);
  lobe.pdf = refracts ? visible * jacobian : 0.0f;
  lobe.f_cos = lobe.pdf * g_i / (p.eta * p.eta);
  lobe.pad0 = 0.0f;
  lobe.pad1 = 0.0f;
  return lobe;
}

/* Coat and sheen on top of what `below` is. */
CDL_INLINE BsdfValue gltf_cover_value(GltfLayeredParams p, GltfChoice choice, vec3 wo, vec3 wi,
                                      BsdfValue below) {
  BsdfValue value = below;
  Frame frame = gltf_coat_frame(p, wo);
  GltfCover cover = gltf_cover(p, wo, wi, frame.z);
  float above = wi.z > 0.0f ? 1.0f : 0.0f;
  value.f_cos = v3_scale(below.f_cos, cover.coat * cover.sheen);
  if (GLTF_SHEEN) {
    float covered = p.outside ? above : 0.0f;
    vec3 up = gltf_fold(wi);
    float sheen = covered * cover.coat * sheen_value(p.sheen, wo, up) * up.z / cover.divisor;
    value.f_cos = v3_madd(value.f_cos, sheen, p.sheen_color);
    value.pdf = fma(covered * choice.sheen, SHEEN_PDF, value.pdf);
  }
  if (GLTF_CLEARCOAT) {
    vec3 coat_o = frame_to_local(frame, wo);
    vec3 coat_i = frame_to_local(frame, wi);
    MicrofacetLobe lobe = microfacet_evaluate(p.coat_surface, coat_o, coat_i);
    value.f_cos = v3_add(value.f_cos, v3_all(above * cover.lesser * lobe.f_cos));
    value.pdf = fma(above * choice.coat, lobe.bounded_pdf, value.pdf);
  }
  return value;
}

/* The specular lobe turned back to wo: adds to it and its density. */
CDL_INLINE void gltf_add_retro(GltfLayeredParams p, GltfChoice choice, vec3 wo, vec3 wi,
                               vec3 *specular, float *pdf) {
  MicrofacetLobe lobe = microfacet_evaluate(p.surface, bsdf_mirror(wo), wi);
  GltfFacet facet = gltf_facet(p, lobe.cos_h);
  *specular = v3_madd(*specular, p.retroreflection * lobe.f_cos, facet.specular);
  *pdf = fma(choice.retro, lobe.bounded_pdf, *pdf);
}

/* What passes to wi, wi.z < 0, folded up: the lobe is that of reflection, the density of lobes
 * other than the facets' is given. */
CDL_INLINE BsdfValue gltf_passed(GltfLayeredParams p, GltfChoice choice, vec3 wo, vec3 up,
                                 MicrofacetLobe lobe, BsdfValue scattered) {
  BsdfValue value = scattered;
  if (GLTF_TRANSMISSION) {
    GltfRefraction refraction = gltf_refraction(p, wo, v3(up.x, up.y, -up.z));
    GltfFacet facet = gltf_facet_outside(p, p.solid ? refraction.outer : lobe.cos_h);
    float rough = p.smooth ? 0.0f : 1.0f;
    float f_cos = rough * (p.solid ? refraction.f_cos : lobe.f_cos);
    float pdf = rough * (p.solid ? refraction.pdf : lobe.pdf);
    float chance = choice.facets * (1.0f - gltf_reflected_share(p, facet));
    value.f_cos = v3_madd(value.f_cos, p.transmission * facet.rest * f_cos, p.base);
    value.pdf = fma(chance, pdf, value.pdf);
  }
  value.f_cos = v3_mul(value.f_cos, p.channels);
  return value;
}

/* The base, wi on either side. */
CDL_INLINE BsdfValue gltf_base_value(GltfLayeredParams p, GltfChoice choice, vec3 wo, vec3 wi) {
  int above = wi.z > 0.0f;
  vec3 up = gltf_fold(wi);
  vec3 along_o = gltf_turn(p, wo);
  vec3 along_i = gltf_turn(p, up);
  MicrofacetLobe lobe = microfacet_evaluate(p.surface, along_o, along_i);
  GltfFacet facet = gltf_facet(p, lobe.cos_h);
  float regular = 1.0f - p.retroreflection;
  float share = p.smooth ? choice.reflected : gltf_reflected_share(p, facet);
  float lobe_pdf = p.transmission > 0.0f ? share * lobe.pdf : lobe.bounded_pdf;
  vec3 specular = v3_scale(facet.specular, regular * lobe.f_cos);
  float cosine = up.z * CDL_INV_PI;
  float pdf = fma(choice.facets, lobe_pdf, choice.diffuse * cosine);
  if (GLTF_RETROREFLECTION) gltf_add_retro(p, choice, along_o, along_i, &specular, &pdf);
  float left = gltf_layered_left(p, gltf_layered_albedo(p, along_i));
  float scattered = choice.left * left * cosine * (1.0f - p.transmission);
  vec3 f_cos = v3_madd(specular, scattered * (1.0f - p.diffuse_transmission), p.base);
  f_cos = v3_mul(f_cos, v3_select(p.outside, v3_all(1.0f), p.channels));
  BsdfValue passed = bsdf_black();
  if (GLTF_TRANSMITS) {
    vec3 tint = v3_scale(p.diffuse_tint, p.diffuse_transmission);
    passed = bsdf_value(v3_scale(tint, scattered), choice.through * cosine);
    passed = gltf_passed(p, choice, along_o, along_i, lobe, passed);
  }
  return bsdf_value(v3_select(above, f_cos, passed.f_cos), above ? pdf : passed.pdf);
}

CDL_INLINE BsdfValue gltf_layered_value(GltfLayeredParams p, GltfChoice choice, vec3 wo, vec3 wi) {
  return gltf_cover_value(p, choice, wo, wi, gltf_base_value(p, choice, wo, wi));
}

CDL_INLINE BsdfValue gltf_layered_evaluate(GltfLayeredParams p, vec3 wo, vec3 wi) {
  return gltf_layered_value(p, gltf_choose(p, wo), wo, wi);
}

/* A direction of the lobes that facets make: those of the coat, of the base, or turned back. */
typedef struct GltfFacetSample {
  vec3 wi;
  int transmitted;
  int valid; /* 0: below the horizon on the wrong side */
} GltfFacetSample;

/* Turns the reflection wi of `view` by h into what passes, or leaves it; in the facets' frame. */
CDL_INLINE vec3 gltf_sample_passage(GltfLayeredParams p, GltfChoice choice, vec3 view, vec3 h,
                                    vec3 wi, float w, int *transmitted) {
  float cos_h = math_clamp(v3_dot(view, h), 0.0f, 1.0f);
  float share = p.smooth ? choice.reflected : gltf_reflected_share(p, gltf_facet(p, cos_h));
  vec3 n = v3_select(p.smooth, v3(0.0f, 0.0f, 1.0f), h);
  float cos_n = p.smooth ? math_clamp(view.z, 0.0f, 1.0f) : cos_h;
  DielectricFresnel f = fresnel_dielectric(cos_n, p.eta);
  *transmitted = *transmitted && w >= share && !(p.solid && f.total);
  vec3 refracted = fresnel_refract(view, n, cos_n, f.cos_t, p.eta);
  vec3 thin = v3_select(p.smooth, v3_neg(view), v3(wi.x, wi.y, -wi.z));
  return v3_select(*transmitted, v3_select(p.solid, refracted, thin), wi);
}

CDL_INLINE GltfFacetSample gltf_sample_facets(GltfLayeredParams p, GltfChoice choice, vec3 wo,
                                              int coated, int retro, float u, float v, float w) {
  GltfFacetSample s;
  Microfacets m = p.surface;
  Frame coat = gltf_coat_frame(p, wo);
  vec3 along = gltf_turn(p, wo);
  vec3 view = v3_select(retro, bsdf_mirror(along), along);
  if (GLTF_CLEARCOAT) {
    view = v3_select(coated, frame_to_local(coat, wo), view);
    m.alpha_x = coated ? p.coat_surface.alpha_x : m.alpha_x;
    m.alpha_y = coated ? p.coat_surface.alpha_y : m.alpha_y;
  }
  int whole = !coated && !retro && p.transmission > 0.0f;
  float bound = whole ? 1.0f : microfacet_bound(m, view);
  vec3 h = microfacet_sample_bounded(m, view, bound, u, v);
  vec3 wi = fresnel_reflect(view, h);
  s.transmitted = whole;
  if (GLTF_TRANSMISSION) wi = gltf_sample_passage(p, choice, view, h, wi, w, &s.transmitted);
  s.wi = gltf_turn_back(p, wi);
  if (GLTF_CLEARCOAT) s.wi = v3_select(coated, frame_to_world(coat, wi), s.wi);
  s.valid = s.transmitted ? s.wi.z < 0.0f : s.wi.z > 0.0f;
  s.valid = s.valid && (!coated || wi.z > 0.0f); /* above the coat's own plane */
  return s;
}

/* The weight of passing a smooth surface, a direction that is drawn with a probability. */
CDL_INLINE vec3 gltf_straight_weight(GltfLayeredParams p, GltfChoice choice, vec3 wo, vec3 wi) {
  GltfFacet facet = gltf_facet(p, wo.z);
  GltfCover cover = gltf_cover(p, wo, wi, gltf_coat_frame(p, wo).z);
  float strength = cover.coat * cover.sheen * p.transmission * facet.rest;
  float chance = choice.facets * (1.0f - choice.reflected) * p.eta * p.eta;
  return v3_scale(v3_mul(p.base, p.channels), strength * bsdf_reciprocal(chance));
}

CDL_INLINE BsdfSample gltf_layered_sample(GltfLayeredParams p, vec3 wo, float u, float v, float w) {
  GltfChoice choice = gltf_choose(p, wo);
  float after_coat = w - choice.coat;
  float after_sheen = after_coat - choice.sheen;
  float after_retro = after_sheen - choice.retro;
  float after_facets = after_retro - choice.facets;
  int coated = GLTF_CLEARCOAT && after_coat < 0.0f;
  int fibre = GLTF_SHEEN && !coated && after_sheen < 0.0f;
  int retro = GLTF_RETROREFLECTION && !coated && !fibre && after_retro < 0.0f;
  int facets = !coated && !fibre && !retro && after_facets < 0.0f;
  int through = choice.through > 0.0f && after_facets >= choice.diffuse;
  float inner = after_retro * bsdf_reciprocal(choice.facets); /* w within `facets` */
  GltfFacetSample s = gltf_sample_facets(p, choice, wo, coated, retro, u, v, inner);
  int specular = coated || retro || facets;
  vec3 wi = sample_cosine_hemisphere(u, v);
  wi.z = through ? -wi.z : wi.z;
  wi = v3_select(specular, s.wi, wi);
  int valid = specular ? s.valid : 1;
  if (GLTF_SHEEN) wi = v3_select(fibre, sheen_sample(u, v), wi);
  BsdfValue value = gltf_layered_value(p, choice, wo, wi);
  vec3 weight = v3_scale(value.f_cos, bsdf_reciprocal(value.pdf));
  int delta = GLTF_TRANSMISSION && p.smooth && facets && s.transmitted;
  if (GLTF_TRANSMISSION) weight = v3_select(delta, gltf_straight_weight(p, choice, wo, wi), weight);
  weight = v3_select(valid, weight, v3_all(0.0f));
  BsdfSample sample = bsdf_sample(wi, weight, delta ? 0.0f : value.pdf);
  sample.delta = delta;
  sample.transmitted = wi.z < 0.0f;
  sample.eta = facets && s.transmitted ? p.eta : 1.0f;
  return sample;
}

#endif
