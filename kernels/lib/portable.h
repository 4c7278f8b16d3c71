/* portable.h: the little that lets library headers compile as OpenCL C 1.2 and as C11.
 *
 * Arithmetic is exact by contract: no contraction, no library transcendental, so that host and
 * every device compute the same bits. Include this first in every kernel translation unit. */
#ifndef CDL_PORTABLE_H
#define CDL_PORTABLE_H

#ifdef __OPENCL_VERSION__

#pragma OPENCL FP_CONTRACT OFF

/* always_inline: a plain inline function stays a call in PoCL and stops its vectoriser. */
#define CDL_INLINE static inline __attribute__((always_inline))
#define CDL_GLOBAL __global
#define CDL_CONSTANT __constant

/* A long function, kept a call by PoCL, which compiles a kernel three times: by itself, and inlined
 * into each of the two functions that start a work-group. It inlines whatever asks for the size or
 * the place of the work-group, so such a function must not. */
#ifdef POCL_DEVICE_ADDRESS_BITS
#define CDL_FUNCTION static __attribute__((noinline))
#else
#define CDL_FUNCTION CDL_INLINE
#endif

/* 0; PoCL cannot know that before it knows the work-group's size; see math_after. Strips do without
 * (lib/stage.h). */
#if defined(POCL_DEVICE_ADDRESS_BITS) && CDL_STRIP == 1
#define CDL_HIDDEN_ZERO ((uint)(get_local_size(2) >> 31))
#else
#define CDL_HIDDEN_ZERO 0u
#endif

#else

#if defined(__FAST_MATH__) || (defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0)
#error "the host's arithmetic must be exact: no -ffast-math, and for 32-bit x86 -mfpmath=sse -msse2"
#endif

#include <tgmath.h>
#include <stdint.h>
#include <string.h>

#define CDL_INLINE static inline __attribute__((always_inline, unused))
#define CDL_FUNCTION static __attribute__((unused))
#define CDL_GLOBAL
#define CDL_CONSTANT const
#define CDL_HIDDEN_ZERO 0u

typedef uint32_t uint;

CDL_INLINE uint as_uint(float x) {
  uint u;
  memcpy(&u, &x, 4);
  return u;
}

CDL_INLINE uint mul_hi(uint a, uint b) { return (uint)(((uint64_t)a * b) >> 32); }

CDL_INLINE int as_int(float x) {
  int i;
  memcpy(&i, &x, 4);
  return i;
}

CDL_INLINE float as_float(uint u) {
  float x;
  memcpy(&x, &u, 4);
  return x;
}

#endif

#define CDL_PI 3.14159265358979323846f
#define CDL_INV_PI 0.31830988618379067154f
#define CDL_INV_2PI 0.15915494309189533577f
#define CDL_INV_4PI 0.07957747154594766788f
#define CDL_INFINITY as_float(0x7f800000u)
#define CDL_ONE_MINUS_EPSILON 0.99999994f /* the float below 1 */

#endif
