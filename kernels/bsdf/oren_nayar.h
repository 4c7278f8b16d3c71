/* oren_nayar.h: a matt surface of rough facets that loses no energy: EON (Portsmouth, Kutz and Hill
 * 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF"), in its exact form.
 *
 * Single scattering is Fujii's variant of Oren and Nayar, f = reflectance/pi A (1 + r s/t); what it
 * loses goes into a second term that is separable and reciprocal, so that white returns exactly
 * what it gets at every angle and roughness. Roughness 0 is Lambert.
 *
 * With E the albedo of single scattering for white, 1 - E = A r (C1 - G/pi): the factor A r is
 * taken out of the second term, (1 - E(wo)) (1 - E(wi)) / (1 - <E>), so that nothing is 0/0 at
 * roughness 0. */
#ifndef CDL_BSDF_OREN_NAYAR_H
#define CDL_BSDF_OREN_NAYAR_H

#include "bsdf/bsdf.h"
#include "lib/sampling.h"

#define OREN_NAYAR_C1 0.287793409f  /* 1/2 - 2/(3 pi) */
#define OREN_NAYAR_C2 0.0724882111f /* 2/3 - 28/(15 pi) */

typedef struct OrenNayarParams {
  vec3 reflectance; /* [0,1] */
  float roughness;  /* [0,1] */
} OrenNayarParams;

CDL_INLINE OrenNayarParams oren_nayar_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                             size_t stride, size_t i) {
  OrenNayarParams p;
  p.reflectance = point.base;
  p.roughness = math_saturate(param_float(params, CDL_OREN_NAYAR_ROUGHNESS, stride, i));
  return p;
}

/* C1 - G(mu)/pi >= 0, G of eq. 18: 0 at grazing angles. (1 - s^3)/mu is taken without cancellation.
 */
CDL_INLINE float oren_nayar_loss(float mu) {
  float s = math_safe_sqrt((1.0f - mu) * (1.0f + mu));
  float cubic = mu * (1.0f + s + s * s) / (1.0f + s);
  float g = fma(s, math_acos(mu) - s * mu, (2.0f / 3.0f) * s * (cubic - 1.0f));
  return math_max(OREN_NAYAR_C1 - CDL_INV_PI * g, 0.0f);
}

/* One channel of the reflectance of what scatters more than once. */
CDL_INLINE float oren_nayar_multiple(float reflectance, float average) {
  return reflectance * reflectance * average / (1.0f - reflectance * (1.0f - average));
}

/* f times pi. */
CDL_INLINE vec3 oren_nayar_scaled(OrenNayarParams p, vec3 wo, vec3 wi) {
  float mu_o = math_saturate(wo.z);
  float mu_i = math_saturate(wi.z);
  float a = 1.0f / fma(OREN_NAYAR_C1, p.roughness, 1.0f);
  float s = fma(wo.x, wi.x, wo.y * wi.y); /* dot(wo, wi) - mu_o mu_i */
  float t = s > 0.0f ? math_max(math_max(mu_o, mu_i), 1e-9f) : 1.0f;
  float single = a * fma(p.roughness, s / t, 1.0f);
  float average = a * fma(OREN_NAYAR_C2, p.roughness, 1.0f);
  float loss_o = oren_nayar_loss(mu_o);
  float loss_i = oren_nayar_loss(mu_i);
  float lost = a * p.roughness * loss_o * loss_i / (OREN_NAYAR_C1 - OREN_NAYAR_C2);
  vec3 multiple = v3(oren_nayar_multiple(p.reflectance.x, average),
                     oren_nayar_multiple(p.reflectance.y, average),
                     oren_nayar_multiple(p.reflectance.z, average));
  return v3_madd(v3_scale(p.reflectance, single), lost, multiple);
}

/* The cosine lobe that a linear map turns into one like f: its matrix is (a 0 b, 0 c 0, d 0 1) in
 * the frame whose x axis points towards wo; fitted by the authors (their listing 2). */
typedef struct OrenNayarLobe {
  float a, b, c, d;
  float x, y;    /* unit vector along the projection of wo */
  float clipped; /* share of the hemisphere's cosine lobe that lands above the horizon */
  float uniform; /* probability of a uniform direction instead */
} OrenNayarLobe;

CDL_INLINE OrenNayarLobe oren_nayar_lobe(float r, vec3 wo) {
  OrenNayarLobe l;
  float mu = math_saturate(wo.z);
  l.a = fma(
      r, fma(fma(0.335918f, mu, -0.276266f), r, fma(fma(0.111709f, mu, -0.518982f), mu, 0.303392f)),
      1.0f);
  float b = r * fma(fma(-0.150105f, mu, 0.150815f), r, fma(1.15859f, mu, -1.16407f));
  l.b = b / fma(mu * mu, mu, -1.43545f);
  l.c = fma(r, fma(fma(0.261777f, mu, -0.506373f), mu, 0.20013f), 1.0f);
  float d = r * fma(fma(0.475392f, mu, -1.01625f), mu, 0.540852f);
  l.d = d / fma(mu + 0.0725628f, mu, -1.0743f);
  float length = sqrt(fma(wo.x, wo.x, wo.y * wo.y));
  float inverse = 1.0f / (length > 0.0f ? length : 1.0f);
  l.x = length > 0.0f ? wo.x * inverse : 1.0f;
  l.y = wo.y * inverse;
  l.clipped = 0.5f + 0.5f / sqrt(fma(l.d, l.d, 1.0f));
  float eighth_root = sqrt(sqrt(sqrt(r)));
  float share = fma(fma(fma(-0.290822f, mu, 0.538233f), mu, -0.372058f), mu, 0.162925f);
  l.uniform = eighth_root * math_max(share, 0.0f);
  return l;
}

/* Density of wi, wi.z > 0: the lobe's, clipped to the hemisphere, mixed with a uniform one. */
CDL_INLINE float oren_nayar_pdf(OrenNayarLobe l, vec3 wi) {
  float x = fma(l.x, wi.x, l.y * wi.y);
  float y = fma(l.x, wi.y, -(l.y * wi.x));
  float minor = l.a - l.b * l.d;
  float hx = l.c * (x - l.b * wi.z);
  float hy = minor * y;
  float hz = l.c * (l.a * wi.z - l.d * x);
  float length2 = fma(hx, hx, fma(hy, hy, hz * hz));
  float density = l.c * minor / length2;
  density = density * density * math_max(hz, 0.0f) * CDL_INV_PI / l.clipped;
  return wi.z > 0.0f ? math_lerp(density, CDL_INV_2PI, l.uniform) : 0.0f;
}

CDL_INLINE vec3 oren_nayar_sample_uniform(float u, float v) {
  float cosine, sine;
  float z = 1.0f - u;
  float radius = math_safe_sqrt(u * (1.0f + z));
  math_sincos_2pi(v, &sine, &cosine);
  return v3(radius * cosine, radius * sine, z);
}

/* A direction of the lobe: a point of the part of the disk whose image lies above the horizon is
 * found as for visible normals (Heitz and d'Eon 2014), then mapped. */
CDL_INLINE vec3 oren_nayar_sample_lobe(OrenNayarLobe l, float u, float v) {
  float cosine, sine;
  float radius = sample_disk_polar(u, v, &cosine, &sine);
  float y = radius * sine;
  float x = -math_lerp(math_safe_sqrt((1.0f - y) * (1.0f + y)), radius * cosine, l.clipped);
  float z = math_safe_sqrt(1.0f - fma(x, x, y * y));
  vec3 w = v3_normalize(v3(fma(l.a, x, l.b * z), l.c * y, fma(l.d, x, z)));
  return v3(fma(l.x, w.x, -(l.y * w.y)), fma(l.y, w.x, l.x * w.y), math_max(w.z, 1e-4f));
}

CDL_INLINE BsdfValue oren_nayar_evaluate(OrenNayarParams p, vec3 wo, vec3 wi) {
  float cosine = CDL_INV_PI * math_max(wi.z, 0.0f);
  float pdf = oren_nayar_pdf(oren_nayar_lobe(p.roughness, wo), wi);
  return bsdf_value(v3_scale(oren_nayar_scaled(p, wo, wi), cosine), pdf);
}

CDL_INLINE BsdfSample oren_nayar_sample(OrenNayarParams p, vec3 wo, float u, float v, float w) {
  OrenNayarLobe lobe = oren_nayar_lobe(p.roughness, wo);
  vec3 uniform = oren_nayar_sample_uniform(u, v);
  vec3 wi = v3_select(w < lobe.uniform, uniform, oren_nayar_sample_lobe(lobe, u, v));
  float pdf = oren_nayar_pdf(lobe, wi);
  float cosine = CDL_INV_PI * math_max(wi.z, 0.0f);
  vec3 f = oren_nayar_scaled(p, wo, wi);
  return bsdf_sample(wi, v3_scale(f, cosine * bsdf_reciprocal(pdf)), pdf);
}

#endif
