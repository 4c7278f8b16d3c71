/* iridescence.h: reflection by a thin film on a surface (Belcour and Barla 2017, "A Practical
 * Extension to Microfacet Theory for the Modeling of Varying Iridescence"), with the approximations
 * of KHR_materials_iridescence: Schlick's Fresnel at both boundaries, no polarisation, phases of 0
 * or pi, two orders of interference, and the eye's response as Gaussians over wave number.
 *
 * All phases being multiples of pi, they only change the sign of odd orders; so the spectral
 * integrals are made once for an angle and serve every base. The sign is taken by channel of the
 * result (the extension's listing takes it by channel of XYZ, which is the same unless the film's
 * index lies between those of the base's channels). Its least product of reflectances, 1e-5, is
 * left out, which would be 0.009 of reflectance. The result is kept within [0,1]. */
#ifndef CDL_BSDF_IRIDESCENCE_H
#define CDL_BSDF_IRIDESCENCE_H

#include "bsdf/fresnel.h"
#include "lib/math.h"
#include "lib/vec.h"

/* A film in air at one angle. */
typedef struct ThinFilm {
  float ior;
  float cos_2;        /* within the film */
  float reflectance;  /* of its outer boundary */
  int total;          /* 1: all is reflected there */
  vec3 first, second; /* RGB of the first and second order of interference, for phase 0 */
} ThinFilm;

/* Linear RGB (Rec. 709) of XYZ, as the extension has it. */
CDL_INLINE vec3 film_rgb(float x, float y, float z) {
  return v3(fma(3.2404542f, x, fma(-1.5371385f, y, -0.4985314f * z)),
            fma(-0.9692660f, x, fma(1.8760108f, y, 0.0415560f * z)),
            fma(0.0556434f, x, fma(-0.2040259f, y, 1.0572252f * z)));
}

/* One Gaussian lobe of the eye's response: peak wave number in 1/nm, falloff per nm^2; *second is
 * its value at twice the path. cos(2 a) and exp(-4 b) come from cos(a) and exp(-b). */
CDL_INLINE float film_response(float path, float scale, float wave_number, float falloff,
                               float *second) {
  float sine, cosine;
  math_sincos_2pi(wave_number * path, &sine, &cosine);
  float decay = math_exp(-math_min(falloff * path * path, 80.0f));
  float decay2 = decay * decay;
  *second = scale * fma(2.0f * cosine, cosine, -1.0f) * decay2 * decay2;
  return scale * cosine * decay;
}

CDL_INLINE ThinFilm film_make(float ior, float thickness, float cos_1) {
  ThinFilm film;
  float n = math_max(ior, 1e-3f);
  float squared = fma(cos_1, cos_1, (n - 1.0f) * (n + 1.0f)); /* (n cos_2)^2 */
  float path = math_min(2.0f * thickness * math_safe_sqrt(squared), 1e6f);
  film.ior = n;
  film.total = squared <= 0.0f;
  film.cos_2 = math_min(math_safe_sqrt(squared) / n, 1.0f);
  film.reflectance = fresnel_schlick(fresnel_f0(n), cos_1);
  float x2, y2, z2, red2;
  float x = film_response(path, 0.846590002f, 1.6810e-3f, 1.70854696e-7f, &x2);
  float y = film_response(path, 1.00022189f, 1.7953e-3f, 3.67330884e-7f, &y2);
  float z = film_response(path, 1.00112249f, 2.2084e-3f, 2.61035245e-7f, &z2);
  float red = film_response(path, 0.153868307f, 2.2399e-3f, 1.78766171e-7f, &red2);
  film.first = film_rgb(x + red, y, z);
  film.second = film_rgb(x2 + red2, y2, z2);
  return film;
}

/* The index of a base that alone, in air, would reflect f0 at normal incidence. */
CDL_INLINE float film_base_ior(float f0) {
  float root = sqrt(math_clamp(f0 + 1e-4f, 0.0f, 0.9999f));
  return (1.0f + root) / (1.0f - root);
}

/* What the boundary of such a base with a film of index ior reflects at normal incidence. */
CDL_INLINE float film_inner_f0(float ior, float f0) {
  float base = film_base_ior(f0);
  return math_sqr((base - ior) / (base + ior));
}

/* One channel over such a base. */
CDL_INLINE float film_channel(ThinFilm film, float f0, float first, float second) {
  float ior = film_base_ior(f0);
  float inner = fresnel_schlick(film_inner_f0(film.ior, f0), film.cos_2);
  float sign = (ior < film.ior) == (film.ior < 1.0f) ? -1.0f : 1.0f;
  float passed = 1.0f - film.reflectance;
  float product = math_min(film.reflectance * inner, 0.9999f);
  float rest = passed * passed * inner / (1.0f - product);
  float order = (rest - passed) * sqrt(product);
  float waves = fma(order * sign, first, order * sqrt(product) * second);
  float sum = fma(2.0f, waves, film.reflectance + rest);
  return film.total ? 1.0f : math_saturate(sum);
}

CDL_INLINE vec3 film_reflectance(ThinFilm film, vec3 f0) {
  float r = film_channel(film, f0.x, film.first.x, film.second.x);
  float g = film_channel(film, f0.y, film.first.y, film.second.y);
  float b = film_channel(film, f0.z, film.first.z, film.second.z);
  return v3(r, g, b);
}

#endif
