/* math.h: elementary functions that give the same bits on the host and on every device.
 *
 * Only + - * / sqrt fma, comparisons, selects, bit casts and integer arithmetic, without a branch,
 * a loop or a table, so that PoCL vectorises what calls them. The polynomials are weighted minimax
 * fits made for this file, with coefficients rounded to float from the lowest degree upward. Errors
 * are against the exact value and hold over the whole stated range, denormal arguments and results
 * included. Some devices flush denormal operands and results of fma, so tiny arguments take selects
 * that avoid it. NaN arguments are outside every contract: they give some value, never a trap. */
#ifndef CDL_MATH_H
#define CDL_MATH_H

#include "lib/portable.h"

/* ---- selects, signs and neighbours ---- */

/* a when the arguments are equal, so that the sign of a zero is the same everywhere. */
CDL_INLINE float math_min(float a, float b) { return b < a ? b : a; }

CDL_INLINE float math_max(float a, float b) { return b > a ? b : a; }

CDL_INLINE float math_clamp(float x, float low, float high) {
  return x < low ? low : (x > high ? high : x);
}

CDL_INLINE float math_saturate(float x) { return math_clamp(x, 0.0f, 1.0f); }

CDL_INLINE float math_sqr(float x) { return x * x; }

/* Exact at both ends: a at t = 0, b at t = 1. */
CDL_INLINE float math_lerp(float a, float b, float t) { return (1.0f - t) * a + t * b; }

/* sqrt, and 0 for negative arguments */
CDL_INLINE float math_safe_sqrt(float x) { return sqrt(math_max(0.0f, x)); }

CDL_INLINE float math_abs(float x) { return as_float(as_uint(x) & 0x7fffffffu); }

/* The sign bit of x, and none for -0: compilers that turn x + 0 into x make the sign of a zero
 * differ from device to device, so nothing may depend on it. */
CDL_INLINE uint math_sign_bit(float x) { return x < 0.0f ? 0x80000000u : 0u; }

CDL_INLINE float math_copysign(float magnitude, float sign) {
  return as_float((as_uint(magnitude) & 0x7fffffffu) | math_sign_bit(sign));
}

/* -1 for negative x, else 1 */
CDL_INLINE float math_sign(float x) { return math_copysign(1.0f, x); }

/* x with its sign flipped where `sign` is negative: x * math_sign(sign) */
CDL_INLINE float math_mulsign(float x, float sign) {
  return as_float(as_uint(x) ^ math_sign_bit(sign));
}

/* The next float towards +infinity; +infinity stays. */
CDL_INLINE float math_next_up(float x) {
  uint u = as_uint(x);
  u = u == 0x80000000u ? 0u : u;
  uint up = (u >> 31) != 0u ? u - 1u : u + 1u;
  return as_float(u == 0x7f800000u ? u : up);
}

/* The next float towards -infinity; -infinity stays. */
CDL_INLINE float math_next_down(float x) { return -math_next_up(-x); }

/* The nearest integer, ties to even, for |x| <= 2^22; any int outside. Adding 1.5 * 2^23 leaves the
 * integer in the low mantissa bits; the bit cast keeps optimisers from cancelling the sum. */
CDL_INLINE int math_round_int(float x) { return (int)(as_uint(x + 12582912.0f) - 0x4b400000u); }

/* 2^n for -126 <= n <= 127 */
CDL_INLINE float math_pow2i(int n) { return as_float((uint)(n + 127) << 23); }

/* x, for compilers a result of `before` as well. PoCL lets LLVM pack like operations on two values
 * of one work-item into a vector of two before it looks at the loop over work-items, and one such
 * vector keeps that loop from being vectorised, which costs a factor of 5. What depends on `before`
 * cannot be packed with it. It costs nothing: the zero is known, and gone, once the work-group's
 * size is. */
CDL_INLINE float math_after(float before, float x) {
  return as_float(as_uint(x) ^ (as_uint(before) & CDL_HIDDEN_ZERO));
}

/* ---- sine and cosine ---- */

/* Turns (sin, cos) of the reduced angle into those of the angle, `quadrant` quarter turns on. */
CDL_INLINE void math_rotate_quadrant(int quadrant, float s, float c, float *sine, float *cosine) {
  int odd = quadrant & 1;
  float a = odd ? c : s;
  *sine = as_float(as_uint(a) ^ ((uint)(quadrant & 2) << 30));
  float b = math_after(*sine, odd ? s : c);
  *cosine = as_float(as_uint(b) ^ ((uint)((quadrant + 1) & 2) << 30));
}

/* Where odd functions with slope 1 are their own argument, and fma is still far from denormals */
#define MATH_TINY 7.8886091e-31f /* 2^-100 */

/* Sine and cosine of 2 pi turns, |turns| <= 2^20 (meaningless outside); 2 ulp. The reduction is
 * exact, so multiples of a quarter turn give exactly 0 and +-1. */
CDL_INLINE void math_sincos_2pi(float turns, float *sine, float *cosine) {
  int quadrant = math_round_int(4.0f * turns);
  float r = turns - 0.25f * (float)quadrant;
  float z = r * r;
  float s = fma(fma(-75.4075546f, z, 81.5926895f), z, -41.3416634f);
  float low = r * fma(s, z, -1.95191902e-7f);
  s = math_abs(r) < MATH_TINY ? r * 6.28318548f : fma(r, 6.28318548f, low);
  z = math_after(s, z);
  float c = fma(fma(fma(58.6056137f, z, -85.4243317f), z, 64.9391479f), z, -19.7392082f);
  math_rotate_quadrant(quadrant, s, fma(c, z, 1.0f), sine, cosine);
}

/* Sine and cosine of x radians, 2 ulp for |x| <= 2^17; larger arguments count as +-2^17.
 * Cody-Waite reduction: the first fma is exact, the second product and difference keep their
 * rounding errors in `low`. */
CDL_INLINE void math_sincos(float x, float *sine, float *cosine) {
  x = math_clamp(x, -131072.0f, 131072.0f);
  int quadrant = math_round_int(x * 0.636619747f);
  float q = (float)quadrant;
  float first = fma(q, -1.57079637f, x);
  float product = q * -4.37113883e-8f;
  float product_error = fma(q, -4.37113883e-8f, -product);
  float r = first - product;
  float b = first - r;
  float difference_error = (first - (r + b)) + (b - product);
  float low = difference_error - fma(q, -1.71512451e-15f, product_error);
  float z = r * r;
  float s = fma(fma(-0.000195182918f, z, 0.00833218917f), z, -0.166666552f);
  s = math_abs(x) < MATH_TINY ? x : r + fma(r * z, s, low);
  float c = fma(fma(2.44325656e-5f, z, -0.00138873106f), z, 0.0416666456f);
  c = fma(z * z, c, -(r * low));
  math_rotate_quadrant(quadrant, s, fma(z, -0.5f, 1.0f) + c, sine, cosine);
}

CDL_INLINE float math_sin(float x) {
  float s, c;
  math_sincos(x, &s, &c);
  return s;
}

CDL_INLINE float math_cos(float x) {
  float s, c;
  math_sincos(x, &s, &c);
  return c;
}

/* ---- exponentials ---- */

/* x 2^n for x in [0.5, 2] and |n| <= 250, in two steps so that neither factor leaves the normal
 * range and only the last product rounds. The factors are made in unlike ways, see math_after. */
CDL_INLINE float math_scale(float x, int n) {
  uint half_bits = (uint)((n >> 1) + 127) << 23;
  uint rest_bits = ((uint)(n + 254) << 23) - half_bits;
  return x * as_float(half_bits) * as_float(rest_bits);
}

/* 2^f for |f| <= 1/2 */
CDL_INLINE float math_exp2_fraction(float f) {
  float p = fma(0.000153293469f, f, 0.00133909704f);
  p = fma(fma(p, f, 0.00961849932f), f, 0.0555035956f);
  p = fma(fma(p, f, 0.240226477f), f, 0.693147182f);
  return fma(p, f, 1.0f);
}

/* 2^x, any x; 2 ulp */
CDL_INLINE float math_exp2(float x) {
  x = math_clamp(x, -151.0f, 129.0f);
  int n = math_round_int(x);
  return math_scale(math_exp2_fraction(x - (float)n), n);
}

/* x = n ln 2 + r with |r| <= ln(2) / 2; returns e^r - 1. For |x| <= 2^15. */
CDL_INLINE float math_expm1_reduced(float x, int *n) {
  *n = math_round_int(x * 1.44269502f);
  float k = (float)*n;
  float r = fma(k, 1.90465421e-9f, fma(k, -0.693147182f, x));
  float p = fma(fma(0.00138702837f, r, 0.0083662523f), r, 0.041667439f);
  p = fma(fma(p, r, 0.166665465f), r, 0.49999997f);
  return fma(r * r, p, r);
}

/* e^x, any x; 2 ulp */
CDL_INLINE float math_exp(float x) {
  int n;
  float p = math_expm1_reduced(math_clamp(x, -104.0f, 89.0f), &n);
  return math_scale(1.0f + p, n);
}

/* e^x - 1 without cancellation near 0, any x; 3 ulp. 1 - exp(-x) is -math_expm1(-x). */
CDL_INLINE float math_expm1(float x) {
  int n;
  x = math_clamp(x, -30.0f, 89.0f);
  float p = math_expm1_reduced(x, &n);
  /* Half the result, because 2^128 is not a float. */
  float t = math_pow2i(n - 1);
  float large = 2.0f * fma(t, p, t - 0.5f);
  p = math_abs(x) < MATH_TINY ? x : p;
  return n == 0 ? p : large;
}

/* ---- logarithms ---- */

/* x = m 2^e for positive finite x, with m in [low, 2 low) for low = as_float(low_bits). */
CDL_INLINE float math_split_exponent(float x, uint low_bits, int *e) {
  int denormal = x < 1.17549435e-38f;
  uint u = as_uint(denormal ? x * 8388608.0f : x);
  int k = (int)(u - low_bits) >> 23;
  *e = k - (denormal ? 23 : 0);
  return as_float(u - ((uint)k << 23));
}

/* -infinity for x <= 0, +infinity at +infinity, else `value` */
CDL_INLINE float math_log_edges(float x, float value) {
  value = x > 3.40282347e+38f ? CDL_INFINITY : value;
  return x > 0.0f ? value : -CDL_INFINITY;
}

/* e ln 2 + log(1 + f) for f in [-1/3, 1/3] */
CDL_INLINE float math_log_reduced(float e, float f) {
  float p = fma(fma(-0.128892511f, f, 0.139868513f), f, -0.121848792f);
  p = fma(fma(p, f, 0.140053079f), f, -0.166804388f);
  p = fma(fma(p, f, 0.20010446f), f, -0.249997988f);
  p = fma(p, f, 0.333332151f);
  float f2 = f * f;
  float low = fma(f2 * f, p, fma(e, -1.90465421e-9f, -0.5f * f2));
  return fma(e, 0.693147182f, f + low);
}

/* Natural logarithm; 2 ulp. -infinity for x <= 0. */
CDL_INLINE float math_log(float x) {
  int e;
  float m = math_split_exponent(x, 0x3f2aaaabu, &e);
  return math_log_edges(x, math_log_reduced((float)e, m - 1.0f));
}

/* Binary logarithm; 2 ulp, exact for powers of two. -infinity for x <= 0. */
CDL_INLINE float math_log2(float x) {
  int e;
  float f = math_split_exponent(x, 0x3f2aaaabu, &e) - 1.0f;
  float p = fma(fma(-0.188198566f, f, 0.202782422f), f, -0.175115645f);
  p = fma(fma(p, f, 0.201805606f), f, -0.240720287f);
  p = fma(fma(p, f, 0.288710415f), f, -0.360667616f);
  p = fma(fma(p, f, 0.480895996f), f, -0.72134757f);
  p = fma(p, f, 2.49439065e-8f);
  return math_log_edges(x, (float)e + fma(f, 1.44269502f, f * p));
}

/* log(1 + x) without cancellation near 0; 3 ulp. -infinity for x <= -1.
 * The exponent is that of the rounded 1 + x; f is taken from x itself, with one rounding, and none
 * at all while the exponent is 0. */
CDL_INLINE float math_log1p(float x) {
  int e;
  float u = 1.0f + x;
  float m = math_split_exponent(u, 0x3f2aaaabu, &e);
  int large = e > 25;
  float t = math_pow2i(-(large ? 25 : e));
  float f = large ? m - 1.0f : fma(x, t, t - 1.0f);
  float value = math_abs(x) < MATH_TINY ? x : math_log_reduced((float)e, f);
  return math_log_edges(u, value);
}

/* ---- powers ---- */

/* log2 of positive finite x as the unevaluated sum of the result and *low, relative error 2^-30.
 * log2(m) = 2 / ln 2 atanh(s), s = (m - 1) / (m + 1), with s and the leading product in
 * double-float (Dekker 1971). */
CDL_INLINE float math_log2_extended(float x, float *low) {
  int exponent;
  float m = math_split_exponent(x, 0x3f3504f3u, &exponent);
  float e = (float)exponent;
  float f = m - 1.0f;
  float denominator = m + 1.0f;
  float denominator_low = m - (denominator - 1.0f);
  float reciprocal = 1.0f / denominator;
  float s = f * reciprocal;
  float remainder = fma(-s, denominator_low, fma(-s, denominator, f));
  float s_low = remainder * reciprocal;
  float z = fma(s, s, 2.0f * s * s_low);
  float p = fma(fma(0.121398516f, z, 0.142493859f), z, 0.200004861f);
  p = z * fma(p, z, 0.333333313f);
  float t = s * 2.88539004f;
  float t_low = fma(s, 2.88539004f, -t);
  t_low = fma(s, 3.85192607e-8f, fma(s_low, 2.88539004f, t_low));
  t_low = fma(t, p, t_low);
  float sum = e + t;
  float rest = ((e - sum) + t) + t_low;
  float high = sum + rest;
  *low = rest - (high - sum);
  return high;
}

/* base^exponent for base >= 0 (a negative base counts as 0); 4 ulp. Zero and infinite bases as in
 * C: 0^0 = 1, 0^negative = infinity. |exponent| above 10^10 counts as 10^10, which changes no
 * result. */
CDL_INLINE float math_pow(float base, float exponent) {
  float low;
  float high = math_log2_extended(base, &low);
  float b = math_clamp(exponent, -1e10f, 1e10f);
  float y = b * high;
  float y_low = fma(b, low, fma(b, high, -y));
  int saturated = math_abs(y) > 200.0f;
  y = math_clamp(y, -200.0f, 200.0f);
  int n = math_round_int(y);
  float f = (y - (float)n) + (saturated ? 0.0f : y_low);
  float value = math_scale(math_exp2_fraction(f), n);
  float at_zero = b > 0.0f ? 0.0f : (b < 0.0f ? CDL_INFINITY : 1.0f);
  float at_infinity = b > 0.0f ? CDL_INFINITY : (b < 0.0f ? 0.0f : 1.0f);
  value = base > 3.40282347e+38f ? at_infinity : value;
  return base > 0.0f ? value : at_zero;
}

/* ---- inverse trigonometric functions ---- */

/* The angle of (x, y) in [-pi, pi], 3 ulp; signed zeros as in C. Infinite arguments count as the
 * largest finite float. */
CDL_INLINE float math_atan2(float y, float x) {
  float ax = math_min(math_abs(x), 3.40282347e+38f);
  float ay = math_min(math_abs(math_after(ax, y)), 3.40282347e+38f);
  float large = math_max(ax, ay);
  float small = math_min(ax, math_after(large, ay));
  /* keeps the sum below finite */
  float scale = large > 4.2535296e+37f ? 0.25f : 1.0f;
  large *= scale;
  small = math_after(large, small) * scale;
  /* atan(t) = pi/4 + atan((t - 1) / (t + 1)) beyond tan(pi/8), with one division either way */
  int beyond = small > 0.414213562f * large;
  float numerator = beyond ? small - large : small;
  float denominator = beyond ? small + large : large;
  float t = numerator / (denominator > 0.0f ? denominator : 1.0f);
  float z = t * t;
  float p = fma(fma(0.0805416107f, z, -0.138778493f), z, 0.199777305f);
  p = t * z * fma(p, z, -0.333329499f);
  /* base +- (t + p), the constants' low parts first */
  int swap = ay > ax;
  int left = x < 0.0f;
  float high = (beyond ? 0.785398185f : 0.0f);
  float low = (beyond ? -2.18556941e-8f : 0.0f);
  high = swap ? 1.57079637f - high : high;
  low = swap ? -4.37113883e-8f - low : low;
  high = left ? 3.14159274f - high : high;
  low = left ? -8.74227766e-8f - low : low;
  float sign = swap != left ? -1.0f : 1.0f;
  return math_copysign(high + (sign * t + (sign * p + low)), y);
}

/* asin(s) - s for 0 <= s^2 = z <= 1/4 */
CDL_INLINE float math_asin_tail(float s, float z) {
  float p = fma(fma(0.0421570092f, z, 0.0241855029f), z, 0.0454690196f);
  p = fma(fma(p, z, 0.0749531016f), z, 0.166667521f);
  return s * z * p;
}

/* Arc sine in [-pi/2, pi/2], 3 ulp; arguments outside [-1, 1] count as the nearer end.
 * Beyond 1/2: asin(x) = pi/2 - 2 asin(sqrt((1 - x) / 2)). */
CDL_INLINE float math_asin(float x) {
  float a = math_min(math_abs(x), 1.0f);
  int outer = a > 0.5f;
  float half_rest = 0.5f * (1.0f - a);
  float z = outer ? half_rest : a * a;
  float s = outer ? sqrt(half_rest) : a;
  float tail = math_asin_tail(s, z);
  float beyond = 1.57079637f - 2.0f * (s + (tail + 2.18556941e-8f));
  return math_copysign(outer ? beyond : s + tail, x);
}

/* Arc cosine in [0, pi], 3 ulp; arguments outside [-1, 1] count as the nearer end. */
CDL_INLINE float math_acos(float x) {
  float a = math_min(math_abs(x), 1.0f);
  int outer = a > 0.5f;
  float half_rest = 0.5f * (1.0f - a);
  float z = outer ? half_rest : a * a;
  float s = outer ? sqrt(half_rest) : math_mulsign(a, x);
  float tail = math_asin_tail(s, z);
  float inner = 1.57079637f - (s + (tail + 4.37113883e-8f));
  float twice = 2.0f * (s + tail);
  float left = 3.14159274f - (twice + 8.74227766e-8f);
  return outer ? (x < 0.0f ? left : twice) : inner;
}

#endif
