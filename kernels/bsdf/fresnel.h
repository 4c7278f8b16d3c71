/* fresnel.h: reflection, refraction, and how much light takes which way.
 *
 * Directions point away from the surface. `eta` is always relative: the index on the far side over
 * the index on the side of the cosine. */
#ifndef CDL_BSDF_FRESNEL_H
#define CDL_BSDF_FRESNEL_H

#include "lib/math.h"
#include "lib/vec.h"

/* w mirrored about n: both point away from the surface; n has length 1, w any length. */
CDL_INLINE vec3 fresnel_reflect(vec3 w, vec3 n) {
  return v3_sub(v3_scale(n, 2.0f * v3_dot(w, n)), w);
}

/* A boundary between two dielectrics seen at one angle. */
typedef struct DielectricFresnel {
  float reflectance; /* of unpolarised light, [0,1]; 1 under total internal reflection */
  float cos_t;       /* of the refracted direction, >= 0; 0 where there is none */
  float amplitude_s; /* reflected over incident field, polarised across the plane of incidence */
  float amplitude_p; /* and along it: 0 at Brewster's angle */
  int total;         /* 1: total internal reflection */
} DielectricFresnel;

/* Fresnel's equations without absorption, exact; 0 <= cos_i <= 1, eta > 0.
 * cos_t^2 = (eta^2 - 1 + cos_i^2) / eta^2 keeps its digits where eta is near 1 or the ray grazes;
 * 1 - sin^2 / eta^2 would not. */
CDL_INLINE DielectricFresnel fresnel_dielectric(float cos_i, float eta) {
  DielectricFresnel f;
  float scaled = fma(cos_i, cos_i, (eta - 1.0f) * (eta + 1.0f)); /* (eta cos_t)^2 */
  float eta_cos_t = math_safe_sqrt(scaled);
  f.total = scaled <= 0.0f;
  f.cos_t = math_min(eta_cos_t / eta, 1.0f);
  float denominator_s = cos_i + eta_cos_t;
  float denominator_p = fma(eta, cos_i, f.cos_t);
  float s = (cos_i - eta_cos_t) / (f.total ? 1.0f : denominator_s);
  float p = fma(eta, cos_i, -f.cos_t) / (f.total ? 1.0f : denominator_p);
  f.amplitude_s = f.total ? 1.0f : s;
  f.amplitude_p = f.total ? 1.0f : p;
  f.reflectance = 0.5f * fma(f.amplitude_s, f.amplitude_s, f.amplitude_p * f.amplitude_p);
  return f;
}

/* The same reflectance from both cosines, where both are known: accurate near total reflection, and
 * the same seen from either side. */
CDL_INLINE float fresnel_dielectric_between(float cos_i, float cos_t, float eta) {
  float s = (cos_i - eta * cos_t) / math_max(fma(eta, cos_t, cos_i), 1e-30f);
  float p = fma(eta, cos_i, -cos_t) / math_max(fma(eta, cos_i, cos_t), 1e-30f);
  return math_min(0.5f * fma(s, s, p * p), 1.0f);
}

/* w refracted through the boundary with normal n, dot(w, n) = cos_i > 0; cos_t as above.
 * Meaningless under total internal reflection, but finite. */
CDL_INLINE vec3 fresnel_refract(vec3 w, vec3 n, float cos_i, float cos_t, float eta) {
  float inverse = 1.0f / eta;
  return v3_madd(v3_scale(w, -inverse), fma(inverse, cos_i, -cos_t), n);
}

/* One channel of a conductor of index eta + i k against vacuum, exact, unpolarised (Born and Wolf,
 * Principles of Optics, 14.2). a + i b = sqrt((eta + i k)^2 - sin^2); both forms of a^2 are the
 * same number, and each is taken where it does not cancel. */
CDL_INLINE float fresnel_conductor_channel(float cos_i, float eta, float k) {
  float cos2 = cos_i * cos_i;
  float sin2 = (1.0f - cos_i) * (1.0f + cos_i);
  float product = eta * k;
  float difference = fma(eta - k, eta + k, -sin2);                          /* a^2 - b^2 */
  float root = sqrt(fma(difference, difference, 4.0f * product * product)); /* a^2 + b^2 */
  float sum = root + math_abs(difference);
  float small = 2.0f * product * product / (sum > 0.0f ? sum : 1.0f);
  float a = math_safe_sqrt(difference > 0.0f ? 0.5f * sum : small);
  float twice = 2.0f * a * cos_i;
  float both = root + cos2;
  float denominator_s = both + twice;
  float s = (both - twice) / (denominator_s > 0.0f ? denominator_s : 1.0f);
  float q = fma(cos2, root, sin2 * sin2);
  float denominator_p = fma(twice, sin2, q);
  float ratio = fma(-twice, sin2, q) / (denominator_p > 0.0f ? denominator_p : 1.0f);
  ratio = denominator_p > 0.0f ? ratio : 1.0f;
  return math_saturate(0.5f * fma(s, ratio, s));
}

/* The same for RGB. */
CDL_INLINE vec3 fresnel_conductor(float cos_i, vec3 eta, vec3 k) {
  float r = fresnel_conductor_channel(cos_i, eta.x, k.x);
  float g = fresnel_conductor_channel(cos_i, eta.y, k.y);
  float b = fresnel_conductor_channel(cos_i, eta.z, k.z);
  return v3(r, g, b);
}

/* (1 - cos)^5, Schlick's weight of white (1994, eq. 15): for glTF, which is defined by it. */
CDL_INLINE float fresnel_schlick_weight(float cos_i) {
  float m = math_saturate(1.0f - cos_i);
  float m2 = m * m;
  return m2 * m2 * m;
}

CDL_INLINE float fresnel_schlick(float f0, float cos_i) {
  return fma(1.0f - f0, fresnel_schlick_weight(cos_i), f0);
}

CDL_INLINE vec3 fresnel_schlick_rgb(vec3 f0, float cos_i) {
  float weight = fresnel_schlick_weight(cos_i);
  return v3(fma(1.0f - f0.x, weight, f0.x), fma(1.0f - f0.y, weight, f0.y),
            fma(1.0f - f0.z, weight, f0.z));
}

/* Reflectance at normal incidence. */
CDL_INLINE float fresnel_f0(float eta) { return math_sqr((1.0f - eta) / (1.0f + eta)); }

/* Mean reflectance of a smooth boundary for diffuse light from within, eta in [1,3] (a fit by Egan
 * and Hilgeman 1973). */
CDL_INLINE float fresnel_inner_mean(float eta) {
  float inverse = 1.0f / eta;
  return fma(fma(-1.4399f, inverse, 0.7099f), inverse, fma(0.0636f, eta, 0.6681f));
}

#endif
