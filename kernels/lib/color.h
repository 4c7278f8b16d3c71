/* color.h: linear colours with the primaries and white of Rec. 709, and sRGB's transfer function.
 */
#ifndef CDL_COLOR_H
#define CDL_COLOR_H

#include "lib/math.h"
#include "lib/vec.h"

/* Relative luminance (Rec. 709); 1 for white. */
CDL_INLINE float color_luminance(vec3 rgb) {
  return fma(0.2126f, rgb.x, fma(0.7152f, rgb.y, 0.0722f * rgb.z));
}

/* sRGB to linear (IEC 61966-2-1); the linear segment goes on below 0, the power above 1. */
CDL_INLINE float color_srgb_decode(float x) {
  float power = math_pow((x + 0.055f) / 1.055f, 2.4f);
  return x <= 0.04045f ? x / 12.92f : power;
}

/* Linear to sRGB; the linear segment goes on below 0, the power above 1. */
CDL_INLINE float color_srgb_encode(float x) {
  float power = fma(1.055f, math_pow(x, 1.0f / 2.4f), -0.055f);
  return x <= 0.0031308f ? 12.92f * x : power;
}

CDL_INLINE vec3 color_srgb_decode3(vec3 c) {
  return v3(color_srgb_decode(c.x), color_srgb_decode(c.y), color_srgb_decode(c.z));
}

CDL_INLINE vec3 color_srgb_encode3(vec3 c) {
  return v3(color_srgb_encode(c.x), color_srgb_encode(c.y), color_srgb_encode(c.z));
}

#endif
