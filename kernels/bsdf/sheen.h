/* sheen.h: fibres that stand up from a surface: the "Charlie" distribution with its fitted masking
 * (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"), as KHR_materials_sheen has
 * them.
 *
 * What sheen reflects is taken from the layers below by albedo scaling. That needs the albedo
 * E(cos, roughness) of white sheen, which is fitted here: sqrt(E) is a polynomial in the fourth
 * root of the cosine and the square root of roughness, fitted to quadrature and raised a little, so
 * that it is above E by 0 to 0.0052 (relative where E > 1).
 *
 * At grazing angles and roughness below 0.3 the formula itself returns more than it gets (1.9 times
 * at cos 0.01 and roughness 0.1). There the lobe is divided by the greater of E(wo) and E(wi),
 * which keeps it reciprocal; where both are below 1, it is the formula's. Roughness below 0.1
 * counts as 0.1: at 0, the extension's default, the lobe is nothing but a line on the horizon. */
#ifndef CDL_BSDF_SHEEN_H
#define CDL_BSDF_SHEEN_H

#include "bsdf/bsdf.h"

#define SHEEN_ROUGHNESS_MIN 0.1f
#define SHEEN_ROOT_MIN 0.316227766f /* its square root */

typedef struct Sheen {
  float inverse;       /* 1 / alpha, alpha = roughness^2 */
  float a, b, c, d, e; /* of the masking's fit */
  float middle;        /* twice its exponent at cos 1/2 */
  float albedo_0, albedo_1, albedo_2, albedo_3, albedo_4, albedo_5, albedo_6, albedo_7, albedo_8;
} Sheen;

CDL_INLINE float sheen_row(float y, float c0, float c1, float c2, float c3, float c4, float c5,
                           float c6) {
  float p = fma(fma(fma(c6, y, c5), y, c4), y, c3);
  return fma(fma(fma(p, y, c2), y, c1), y, c0);
}

/* The exponent of Lambda, x in [0, 1/2] (Estevez and Kulla, eq. 3 and table 1). */
CDL_INLINE float sheen_exponent(Sheen s, float x) {
  float power = math_exp2(s.c * math_log2(math_max(x, 1e-9f)));
  return s.a / fma(s.b, power, 1.0f) + fma(s.d, x, s.e);
}

CDL_INLINE Sheen sheen_masking(Sheen s, float alpha) {
  float t = (1.0f - alpha) * (1.0f - alpha);
  s.a = math_lerp(21.5473f, 25.3245f, t);
  s.b = math_lerp(3.82987f, 3.32435f, t);
  s.c = math_lerp(0.19823f, 0.16801f, t);
  s.d = math_lerp(-1.97760f, -1.27393f, t);
  s.e = math_lerp(-4.32054f, -4.85967f, t);
  s.middle = 2.0f * sheen_exponent(s, 0.5f);
  return s;
}

CDL_INLINE Sheen sheen_make(float roughness) {
  Sheen s;
  float r = math_clamp(roughness, SHEEN_ROUGHNESS_MIN, 1.0f);
  float y = fma(sqrt(r) - SHEEN_ROOT_MIN, 2.0f / (1.0f - SHEEN_ROOT_MIN), -1.0f);
  s.inverse = 1.0f / (r * r);
  s.albedo_0 = sheen_row(y, 0.7967228f, 0.02363783f, 0.2037381f, -0.04358416f, -0.06678371f,
                         0.000281242f, -0.02183812f);
  s.albedo_1 = sheen_row(y, -0.4165387f, 0.3035953f, -0.3633505f, 0.1765232f, -0.1490982f,
                         0.1659792f, -0.03843119f);
  s.albedo_2 = sheen_row(y, -0.2935616f, 0.1932024f, -0.2443991f, 0.2654792f, -0.01585847f,
                         -0.2444373f, 0.1476465f);
  s.albedo_3 = sheen_row(y, 0.1329205f, -0.06393278f, 0.09591801f, 0.001633522f, 0.2315722f,
                         -0.4688707f, 0.2161358f);
  s.albedo_4 = sheen_row(y, -0.2259516f, -0.08623593f, 0.1911603f, -0.7837651f, 0.5084838f,
                         0.4670286f, -0.387612f);
  s.albedo_5 = sheen_row(y, 0.2053285f, 0.07632776f, 0.2556356f, -0.5976562f, 0.2149282f,
                         0.4887042f, -0.3625256f);
  s.albedo_6 = sheen_row(y, 0.0835692f, 0.05323302f, -0.2799524f, 0.9695123f, -0.5190142f,
                         -0.762762f, 0.5930508f);
  s.albedo_7 = sheen_row(y, -0.2802606f, -0.1414307f, -0.1410156f, 0.3946476f, -0.3172843f,
                         -0.1380671f, 0.216428f);
  s.albedo_8 = sheen_row(y, 0.119063f, -0.04932509f, 0.4205484f, -0.5821479f, 0.1085005f,
                         0.5686475f, -0.3979007f);
  return sheen_masking(s, r * r);
}

/* E(cos), see above. */
CDL_INLINE float sheen_albedo(Sheen s, float cosine) {
  float x = fma(2.0f, sqrt(sqrt(math_clamp(cosine, 1e-4f, 1.0f))), -1.0f);
  float p = fma(fma(fma(s.albedo_8, x, s.albedo_7), x, s.albedo_6), x, s.albedo_5);
  p = fma(fma(fma(p, x, s.albedo_4), x, s.albedo_3), x, s.albedo_2);
  p = math_max(fma(fma(p, x, s.albedo_1), x, s.albedo_0), 0.0f);
  return fma(1.002f * p, p, 0.0013f);
}

CDL_INLINE float sheen_lambda(Sheen s, float cosine) {
  int low = cosine < 0.5f;
  float exponent = sheen_exponent(s, low ? cosine : 1.0f - cosine);
  return math_exp(low ? exponent : s.middle - exponent);
}

/* f of white sheen before it is kept below 1; both cosines > 0. */
CDL_INLINE float sheen_value(Sheen s, vec3 wo, vec3 wi) {
  float cos_o = math_max(wo.z, 1e-6f);
  float cos_i = math_max(wi.z, 1e-6f);
  vec3 sum = v3_add(wo, wi);
  float length2 = math_max(v3_length2(sum), 1e-12f);
  float sin2 = math_clamp(fma(sum.x, sum.x, sum.y * sum.y) / length2, 0.0f, 1.0f);
  float power = math_exp2(0.5f * s.inverse * math_log2(math_max(sin2, 1e-30f)));
  float d = (2.0f + s.inverse) * CDL_INV_2PI * power;
  float lambda_o = sheen_lambda(s, math_min(cos_o, 1.0f));
  float lambda_i = sheen_lambda(s, math_min(cos_i, 1.0f));
  return d / ((1.0f + lambda_o + lambda_i) * 4.0f * cos_i * cos_o);
}

/* Directions are drawn uniformly, as Estevez and Kulla do: the relative deviation of the weight is
 * 0.2 to 1.5 from roughness 0.3 on and 2 to 4 at 0.1; drawn by the cosine it is 1 to 4 times that.
 */
#define SHEEN_PDF CDL_INV_2PI

CDL_INLINE vec3 sheen_sample(float u, float v) {
  float cosine, sine;
  float radius = math_safe_sqrt((1.0f - u) * (1.0f + u));
  math_sincos_2pi(v, &sine, &cosine);
  return v3(radius * cosine, radius * sine, math_max(u, 1e-6f));
}

#endif
