/* dispersion.h: an index of refraction that depends on the wavelength, for paths that carry RGB.
 *
 * A path that meets a dispersive material is reduced to one colour channel, chosen in proportion to
 * its throughput, and goes on with the index at a wavelength of that channel's band. Each band is a
 * density over wavelengths, so that each channel keeps its mean: what does not refract stays white.
 * The bands are everywhere positive and overlap, so a prism shows a spectrum without gaps. */
#ifndef CDL_BSDF_DISPERSION_H
#define CDL_BSDF_DISPERSION_H

#include "bsdf/bsdf.h"

/* 0 for scenes whose glass does not disperse; results are those with abbe 0. */
#ifndef CDL_DISPERSION
#define CDL_DISPERSION 1
#endif

typedef struct Dispersion {
  vec3 weight; /* one channel's is its 1 / probability, the others' 0; 1 without dispersion */
  float ior;   /* inside over outside, at the path's wavelength */
  float pad;
} Dispersion;

/* A wavelength in micrometres of channel 0, 1, 2, u uniform in [0,1). The bands are logistic, with
 * the mean and the deviation of the positive part of the Rec. 709 colour matching functions (CIE
 * 1931, after Wyman, Sloan and Shirley 2013; red's lobe in the violet left out). */
CDL_INLINE float dispersion_wavelength(int channel, float u) {
  float inner = fma(0.998f, u, 0.001f);
  float middle = channel == 0 ? 0.609f : (channel == 1 ? 0.541f : 0.452f);
  float scale = channel == 0 ? 0.0142f : (channel == 1 ? 0.0154f : 0.0117f);
  return fma(scale, math_log(inner / (1.0f - inner)), middle);
}

/* Cauchy's equation with two terms, through the index `ior` of the line d (0.58756 um) and Abbe's
 * number (n_d - 1) / (n_F - n_C), whose lines F and C are at 0.48613 and 0.65627 um. */
CDL_INLINE float dispersion_index(float ior, float abbe, float wavelength) {
  float slope = (ior - 1.0f) / (abbe * 1.90961f);
  float index = fma(slope, 1.0f / (wavelength * wavelength) - 2.89662f, ior);
  return math_max(index, 0.01f);
}

/* abbe 0: no dispersion. */
CDL_INLINE Dispersion dispersion_choose(BsdfPoint point, float ior, float abbe) {
  vec3 t = point.throughput;
  float sum = t.x + t.y + t.z;
  t = v3_select(sum > 0.0f, t, v3_all(1.0f));
  sum = sum > 0.0f ? sum : 3.0f;
  float choice = point.channel_choice * sum;
  int blue = t.z > 0.0f && choice >= t.x + t.y;
  int green = t.y > 0.0f && !blue && choice >= t.x;
  float chosen = blue ? t.z : (green ? t.y : t.x);
  float inverse = sum / (chosen > 0.0f ? chosen : 1.0f);
  int disperses = CDL_DISPERSION && abbe > 0.0f;
  int channel = blue ? 2 : (green ? 1 : 0);
  float wavelength = dispersion_wavelength(channel, point.wavelength);
  float index = dispersion_index(ior, disperses ? abbe : 1.0f, wavelength);
  vec3 one = v3(channel == 0 ? inverse : 0.0f, green ? inverse : 0.0f, blue ? inverse : 0.0f);
  Dispersion d;
  d.weight = v3_select(disperses, one, v3_all(1.0f));
  d.ior = disperses ? index : ior;
  d.pad = 0.0f;
  return d;
}

#endif
