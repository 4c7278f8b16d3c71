/* disney.h: Burley's principled model: the BRDF of 2012 ("Physically Based Shading at Disney", with
 * the masking of its 2014 addendum, as in Disney's BRDF Explorer) and what the BSDF of 2015 adds
 * ("Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering").
 *
 *   f = (1-metallic) (1-specTrans) (diffuse + sheen)        base colour, Burley's diffuse or, by
 *                                                           `subsurface`, Hanrahan and Krueger's
 *     + GGX [ metallic Schlick(baseColor)
 *             + (1-metallic) (1-specTrans) Schlick(0.08 specular tint)
 *             + (1-metallic) specTrans Fresnel(ior) ]
 *     + clearcoat/4 GTR1 Schlick(0.04)
 *     + (1-metallic) specTrans (1-Fresnel(ior)) GGX refraction, tinted by sqrt(baseColor)
 *
 * With specTrans 0 and thin 0 it is the BRDF of 2012 to the letter, luminance weights 0.3 0.6 0.1
 * and alpha >= 0.001 included. thin: both sides at once, so the refraction goes straight on with
 * roughness (0.65 ior - 0.35) and the whole baseColor; `flatness` takes the place of `subsurface`,
 * and diffTrans/2 of the diffuse part goes through as Lambert's.
 *
 * All of it is reciprocal, refraction but for the radiance's factor ior^2. Metal, glass and thin
 * glass never return more than they get. The rest does, as published, because the lobes are simply
 * added: the most that white returns, over all roughnesses, seen at a cosine of 0.5 or more and at
 * any angle (the most at grazing ones), is
 *   diffuse with specular 0, 0.5, 1    1.06 1.08 1.10    1.58 1.60 1.62
 *   subsurface 1, specular 0.5         1.14              1.72
 *   sheen 1, specular 0.5              1.09              1.69
 *   metal under clearcoat 1            1.02              1.05
 *   sheen, clearcoat, specular 1       1.13              1.73
 *   thin, flatness 1, diffTrans 1      1.11              1.79
 *   thin, diffTrans 2                  1.07              1.95
 * and the tinted sheen of saturated blue, whose tint is 10, returns 2.3 of blue. */
#ifndef CDL_BSDF_DISNEY_H
#define CDL_BSDF_DISNEY_H

#include "bsdf/bsdf.h"
#include "bsdf/microfacet.h"
#include "lib/sampling.h"

#define DISNEY_ALPHA_MIN 1e-3f
#define DISNEY_COAT_MASKING 0.0625f /* alpha^2 of the clear coat's masking, whatever its gloss */
#define DISNEY_IOR_STEP 0.01f       /* least |ior - 1|: below, half vectors have too few digits */

typedef struct DisneyParams {
  vec3 base;     /* base colour */
  vec3 specular; /* Schlick's reflectance of the dielectric at 0 degrees */
  vec3 sheen;    /* times its share */
  float metallic;
  float roughness;
  float opaque, glass;        /* shares: (1-metallic) (1-specTrans), (1-metallic) specTrans */
  float eta;                  /* beyond over before, at the side of wo */
  float flat;                 /* share of Hanrahan and Krueger in the diffuse part */
  float diffuse_through;      /* share of the diffuse part that goes through, [0,1] */
  float coat;                 /* clearcoat / 4 */
  float coat_alpha;           /* of GTR1 */
  float coat_log;             /* log(1 / alpha^2) */
  float alpha_x, alpha_y;     /* of reflection */
  float through_x, through_y; /* and of what passes */
  int thin;
} DisneyParams;

/* What one pair of directions meets. */
typedef struct DisneyPair {
  float cos_o, cos_i; /* > 0 */
  float cos_h;        /* wo.h >= 0 */
  float d, g1, g2;    /* GGX density; masking of wo; shadowing of wi */
  float fresnel;      /* exact, of specTrans's glass */
  float passed;       /* 1 - fresnel */
  float jacobian;     /* solid angle of half vectors over that of wi */
  float coat_d;       /* GTR1 */
  float facets;       /* 1: h faces both directions as it must, else 0 */
  vec3 h;
} DisneyPair;

/* Probability of each lobe, 1 in all unless the material is black. */
typedef struct DisneyChoice {
  float diffuse, diffuse_through, specular, coat, glass;
  float thin_reflect; /* of reflection within `glass` where thin */
} DisneyChoice;

/* ---- parameters ---- */

CDL_INLINE vec3 disney_tint(vec3 base, float amount) {
  float luminance = fma(0.3f, base.x, fma(0.6f, base.y, 0.1f * base.z));
  float inverse = 1.0f / (luminance > 0.0f ? luminance : 1.0f);
  vec3 tint = v3_select(luminance > 0.0f, v3_scale(base, inverse), v3_all(1.0f));
  return v3_madd(v3_all(1.0f - amount), amount, tint);
}

CDL_INLINE float disney_alpha(float roughness2, float aspect) {
  return math_max(roughness2 * aspect, DISNEY_ALPHA_MIN);
}

CDL_INLINE DisneyParams disney_params(BsdfPoint point, CDL_GLOBAL const uint *params, size_t stride,
                                      size_t i) {
  DisneyParams p;
  p.base = point.base;
  p.metallic = param_float(params, CDL_DISNEY_METALLIC, stride, i);
  p.roughness = param_float(params, CDL_DISNEY_ROUGHNESS, stride, i);
  float through = param_float(params, CDL_DISNEY_SPEC_TRANS, stride, i);
  p.opaque = (1.0f - p.metallic) * (1.0f - through);
  p.glass = (1.0f - p.metallic) * through;
  float specular = 0.08f * param_float(params, CDL_DISNEY_SPECULAR, stride, i);
  float specular_tint = param_float(params, CDL_DISNEY_SPECULAR_TINT, stride, i);
  p.specular = v3_scale(disney_tint(p.base, specular_tint), specular);
  float sheen = p.opaque * param_float(params, CDL_DISNEY_SHEEN, stride, i);
  float sheen_tint = param_float(params, CDL_DISNEY_SHEEN_TINT, stride, i);
  p.sheen = v3_scale(disney_tint(p.base, sheen_tint), sheen);
  p.thin = param_float(params, CDL_DISNEY_THIN, stride, i) >= 0.5f;
  float subsurface = param_float(params, CDL_DISNEY_SUBSURFACE, stride, i);
  float flatness = param_float(params, CDL_DISNEY_FLATNESS, stride, i);
  p.flat = p.thin ? flatness : subsurface;
  float diffuse_through = 0.5f * param_float(params, CDL_DISNEY_DIFF_TRANS, stride, i);
  p.diffuse_through = p.thin ? diffuse_through : 0.0f;
  p.coat = 0.25f * param_float(params, CDL_DISNEY_CLEARCOAT, stride, i);
  p.coat_alpha =
      math_lerp(0.1f, 0.001f, param_float(params, CDL_DISNEY_CLEARCOAT_GLOSS, stride, i));
  p.coat_log = -2.0f * math_log(p.coat_alpha);
  float ior = param_float(params, CDL_DISNEY_IOR, stride, i);
  float apart = math_copysign(math_max(math_abs(ior - 1.0f), DISNEY_IOR_STEP), ior - 1.0f);
  ior = math_max(1.0f + apart, DISNEY_IOR_STEP);
  p.eta = p.thin || point.front ? ior : 1.0f / ior;
  float aspect = sqrt(1.0f - 0.9f * param_float(params, CDL_DISNEY_ANISOTROPIC, stride, i));
  float inverse = 1.0f / aspect;
  float scale = p.thin ? math_saturate(fma(0.65f, ior, -0.35f)) : 1.0f;
  float alpha = p.roughness * p.roughness;
  float through_alpha = alpha * (scale * scale);
  p.alpha_x = disney_alpha(alpha, inverse);
  p.alpha_y = disney_alpha(alpha, aspect);
  p.through_x = disney_alpha(through_alpha, inverse);
  p.through_y = disney_alpha(through_alpha, aspect);
  return p;
}

/* ---- parts of f ---- */

/* The facets that a reflected (through = 0) or transmitted (1) direction meets. */
CDL_INLINE Microfacets disney_facets(DisneyParams p, int through) {
  float x = through ? p.through_x : p.alpha_x;
  float y = through ? p.through_y : p.alpha_y;
  return microfacet_surface(x, y, 0, 1);
}

/* GTR1's density of normals: (1 - alpha^2) / (pi log(1/alpha^2)) / (1 + (alpha^2 - 1) h.z^2). */
CDL_INLINE float disney_coat_density(DisneyParams p, vec3 h) {
  float alpha2 = p.coat_alpha * p.coat_alpha;
  float t = fma(h.x, h.x, fma(h.y, h.y, alpha2 * h.z * h.z));
  return (1.0f - alpha2) * CDL_INV_PI / (p.coat_log * t);
}

/* 1 / (c + sqrt(a^2 + c^2 - a^2 c^2)): Smith's masking of GGX over 2 c. */
CDL_INLINE float disney_coat_masking(float c) {
  float root = sqrt(fma(1.0f - DISNEY_COAT_MASKING, c * c, DISNEY_COAT_MASKING));
  return 1.0f / (c + root);
}

/* What Fresnel's equations let pass, from both cosines: 1 - reflectance cancels near the critical
 * angle. */
CDL_INLINE float disney_passed(float cos_i, float cos_t, float eta) {
  float s = fma(eta, cos_t, cos_i);
  float p = fma(eta, cos_i, cos_t);
  return math_min(2.0f * cos_i * eta * cos_t * (1.0f / (s * s) + 1.0f / (p * p)), 1.0f);
}

/* Everything that depends on the half vector, for reflection and transmission alike: h is halfway
 * between wo and wi, wi mirrored into the upper hemisphere where thin, or Walter's -(wo + eta wi).
 */
CDL_INLINE DisneyPair disney_pair(DisneyParams p, vec3 wo, vec3 wi) {
  DisneyPair q;
  int through = wi.z < 0.0f;
  int bends = through && !p.thin;
  vec3 mirrored = v3(wi.x, wi.y, math_abs(wi.z));
  float eta = bends ? p.eta : 1.0f;
  vec3 sum = v3_madd(wo, eta, v3_select(bends, wi, mirrored));
  float length = math_max(v3_length(sum), 1e-9f);
  q.h = v3_scale(sum, math_copysign(1.0f / length, sum.z));
  q.cos_o = math_max(wo.z, 1e-9f);
  q.cos_i = math_max(math_abs(wi.z), 1e-9f);
  float cos_oh = v3_dot(wo, q.h);
  float cos_ih = v3_dot(wi, q.h);
  float half_length = 0.5f * length; /* wo.h and wi.h of a reflection, whatever rounds */
  q.cos_h = math_clamp(bends ? cos_oh : half_length, 1e-9f, 1.0f);
  float cos_ih_bent = math_max(-cos_ih, 0.0f);
  float bent = eta * eta * cos_ih_bent / (length * length);
  q.jacobian = bends ? bent : 0.25f / q.cos_h;
  q.facets = (bends && (cos_oh <= 0.0f || cos_ih >= 0.0f)) ? 0.0f : 1.0f;
  Microfacets m = disney_facets(p, through);
  q.d = microfacet_density(m, q.h);
  q.g1 = 1.0f / (1.0f + microfacet_lambda(m, wo));
  q.g2 = 1.0f / (1.0f + microfacet_lambda(m, mirrored));
  q.fresnel = fresnel_dielectric(q.cos_h, p.eta).reflectance;
  q.passed = bends ? disney_passed(q.cos_h, cos_ih_bent, p.eta) : 1.0f - q.fresnel;
  q.coat_d = disney_coat_density(p, q.h);
  return q;
}

/* Burley's diffuse factor and Hanrahan and Krueger's, mixed, times pi over the base colour. */
CDL_INLINE float disney_diffuse(DisneyParams p, DisneyPair q) {
  float weight_o = fresnel_schlick_weight(q.cos_o);
  float weight_i = fresnel_schlick_weight(q.cos_i);
  float retro = q.cos_h * q.cos_h * p.roughness;
  float at_90 = fma(2.0f, retro, -0.5f);
  float burley_o = fma(at_90, weight_o, 1.0f);
  float burley = burley_o * fma(at_90, weight_i, 1.0f);
  float flat_o = fma(retro - 1.0f, weight_o, 1.0f);
  float flat = flat_o * fma(retro - 1.0f, weight_i, 1.0f);
  float subsurface = 1.25f * fma(flat, 1.0f / (q.cos_o + q.cos_i) - 0.5f, 0.5f);
  return math_lerp(burley, subsurface, p.flat);
}

/* One channel of the Fresnel factor of reflection. */
CDL_INLINE float disney_fresnel(DisneyParams p, float base, float specular, float weight,
                                float glass) {
  float metal = fma(1.0f - base, weight, base);
  float dielectric = fma(1.0f - specular, weight, specular);
  return fma(p.metallic, metal, fma(p.opaque, dielectric, p.glass * glass));
}

/* f cos for wi above the surface. */
CDL_INLINE vec3 disney_reflection(DisneyParams p, DisneyPair q) {
  float weight = fresnel_schlick_weight(q.cos_h);
  float facets = 0.25f * q.d * q.g1 * q.g2 / q.cos_o;
  vec3 specular = v3(disney_fresnel(p, p.base.x, p.specular.x, weight, q.fresnel),
                     disney_fresnel(p, p.base.y, p.specular.y, weight, q.fresnel),
                     disney_fresnel(p, p.base.z, p.specular.z, weight, q.fresnel));
  float masking = disney_coat_masking(q.cos_o);
  masking = masking * disney_coat_masking(q.cos_i);
  float coat = p.coat * q.coat_d * masking * fma(0.96f, weight, 0.04f) * q.cos_i;
  float share = p.opaque * (1.0f - p.diffuse_through) * CDL_INV_PI * q.cos_i;
  vec3 f = v3_madd(v3_all(coat), facets, specular);
  f = v3_madd(f, share * disney_diffuse(p, q), p.base);
  return v3_madd(f, weight * q.cos_i, p.sheen);
}

/* f cos for wi below the surface. Refracted radiance is divided by eta^2, which the Jacobian
 * brings in. */
CDL_INLINE vec3 disney_transmission(DisneyParams p, DisneyPair q) {
  vec3 root = v3(sqrt(p.base.x), sqrt(p.base.y), sqrt(p.base.z));
  float scale = p.thin ? 1.0f : 1.0f / (p.eta * p.eta);
  float passed = p.glass * q.passed * scale * q.facets;
  float facets = q.d * q.g1 * q.g2 * q.cos_h * q.jacobian / q.cos_o;
  vec3 refracted = v3_scale(v3_select(p.thin, p.base, root), passed * facets);
  float diffuse = p.opaque * p.diffuse_through * CDL_INV_PI * q.cos_i;
  return v3_madd(refracted, diffuse, p.base);
}

/* ---- sampling ---- */

/* Each lobe by its share of a guess at the albedo. Schlick's weight is kept from 0 because facets
 * are seen at other angles than the surface. */
CDL_INLINE DisneyChoice disney_choice(DisneyParams p, float cos_o) {
  DisneyChoice c;
  float weight = math_max(fresnel_schlick_weight(cos_o), 0.02f);
  float color = p.opaque * v3_max(p.base);
  float metal = p.metallic * math_lerp(v3_max(p.base), 1.0f, weight);
  float dielectric = p.opaque * math_lerp(v3_max(p.specular), 1.0f, weight);
  float sheen = math_max(weight, 0.1f) * v3_max(p.sheen);
  c.diffuse = fma(1.0f - p.diffuse_through, color, sheen);
  c.diffuse_through = p.diffuse_through * color;
  c.specular = metal + dielectric;
  c.coat = p.coat * fma(0.96f, weight, 0.04f);
  c.glass = p.glass;
  float sum = c.diffuse + c.diffuse_through + c.specular + c.coat + c.glass;
  float inverse = 1.0f / sum; /* > 0: metallic + opaque + glass = 1 */
  c.diffuse *= inverse;
  c.diffuse_through *= inverse;
  c.specular *= inverse;
  c.coat *= inverse;
  c.glass *= inverse;
  float reflected = fresnel_dielectric(cos_o, p.eta).reflectance;
  c.thin_reflect = math_clamp(reflected, 0.1f, 0.9f);
  return c;
}

/* Probability that glass, once chosen and its facet known, reflects. */
CDL_INLINE float disney_glass_reflects(DisneyParams p, DisneyChoice c, float fresnel) {
  return p.thin ? c.thin_reflect : fresnel;
}

CDL_INLINE float disney_pdf(DisneyParams p, DisneyPair q, DisneyChoice c, int through) {
  float visible = q.facets * q.d * q.g1 * q.cos_h / q.cos_o * q.jacobian;
  float reflects = disney_glass_reflects(p, c, q.fresnel);
  float passes = p.thin ? 1.0f - reflects : q.passed;
  float glass = c.glass * (through ? passes : reflects);
  float diffuse = through ? c.diffuse_through : c.diffuse;
  float coat = c.coat * q.coat_d * q.h.z * 0.25f / q.cos_h;
  float mirror = through ? 0.0f : c.specular;
  float pdf = fma(glass + mirror, visible, diffuse * CDL_INV_PI * q.cos_i);
  return pdf + (through ? 0.0f : coat);
}

/* A normal of GTR1, by its density times h.z: sin^2 = (alpha^(2 u) - alpha^2) / (1 - alpha^2). */
CDL_INLINE vec3 disney_coat_normal(DisneyParams p, float u, float v) {
  float alpha2 = p.coat_alpha * p.coat_alpha;
  float sin2 = (math_exp(-p.coat_log * u) - alpha2) / (1.0f - alpha2);
  sin2 = math_saturate(sin2);
  float radius = sqrt(sin2);
  float cosine, sine;
  math_sincos_2pi(v, &sine, &cosine);
  return v3(radius * cosine, radius * sine, sqrt(1.0f - sin2));
}

/* What glass does with the number w, rescaled to [0,1): a reflected, bent or straight direction. */
CDL_INLINE vec3 disney_glass(DisneyParams p, vec3 wo, vec3 h, int through) {
  vec3 reflected = fresnel_reflect(wo, h);
  vec3 straight = v3(reflected.x, reflected.y, -reflected.z);
  float cos_h = math_saturate(v3_dot(wo, h));
  DielectricFresnel f = fresnel_dielectric(cos_h, p.eta);
  vec3 bent = v3_normalize(fresnel_refract(wo, h, cos_h, f.cos_t, p.eta));
  return v3_select(through, v3_select(p.thin, straight, bent), reflected);
}

CDL_INLINE BsdfValue disney_evaluate(DisneyParams p, vec3 wo, vec3 wi) {
  DisneyPair q = disney_pair(p, wo, wi);
  DisneyChoice c = disney_choice(p, q.cos_o);
  int through = wi.z < 0.0f;
  vec3 f_cos = v3_select(through, disney_transmission(p, q), disney_reflection(p, q));
  float pdf = disney_pdf(p, q, c, through);
  int there = wi.z != 0.0f && (!through || p.glass + p.diffuse_through > 0.0f);
  return bsdf_value(v3_select(there, f_cos, v3_all(0.0f)), there ? pdf : 0.0f);
}

/* w picks diffuse, diffuse through, coat, specular, glass, in this order. What the lobe meant to be
 * on one side and came out on the other has no weight. */
CDL_INLINE BsdfSample disney_sample(DisneyParams p, vec3 wo, float u, float v, float w) {
  DisneyChoice c = disney_choice(p, math_max(wo.z, 1e-9f));
  float to_through = c.diffuse + c.diffuse_through;
  float to_coat = to_through + c.coat;
  float to_specular = to_coat + c.specular;
  int glass = w >= to_specular && c.glass > 0.0f;
  float rest = math_min((w - to_specular) / math_max(c.glass, 1e-9f), CDL_ONE_MINUS_EPSILON);
  int thin_through = glass && p.thin && rest >= c.thin_reflect;
  vec3 normal = microfacet_sample_normal(disney_facets(p, thin_through), wo, u, v);
  float fresnel = fresnel_dielectric(math_saturate(v3_dot(wo, normal)), p.eta).reflectance;
  int glass_through = glass && rest >= disney_glass_reflects(p, c, fresnel);
  vec3 diffuse = sample_cosine_hemisphere(u, v);
  int diffuse_through = w >= c.diffuse && w < to_through;
  diffuse.z = diffuse_through ? -diffuse.z : diffuse.z;
  int coat = w >= to_through && w < to_coat;
  vec3 facet = v3_select(coat, disney_coat_normal(p, u, v), normal);
  vec3 wi = v3_select(w < to_through, diffuse, disney_glass(p, wo, facet, glass_through));
  int through = diffuse_through || glass_through;
  int there = through ? wi.z < 0.0f : wi.z > 0.0f;
  BsdfValue value = disney_evaluate(p, wo, wi);
  vec3 weight = v3_scale(value.f_cos, there ? bsdf_reciprocal(value.pdf) : 0.0f);
  BsdfSample sample = bsdf_sample(wi, weight, there ? value.pdf : 0.0f);
  sample.transmitted = through;
  sample.eta = through && glass && !p.thin ? p.eta : 1.0f;
  return sample;
}

#endif
