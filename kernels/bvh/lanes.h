/* lanes.h: two, four and eight floats at once, for device and host, rounding as the scalar code
 * does.
 *
 * Conditions are integer vectors with all bits set where true; a mask has bit i for lane i, which
 * lanes8_mask_ordered sets where a <= b. */
#ifndef CDL_BVH_LANES_H
#define CDL_BVH_LANES_H

#include "lib/portable.h"

#ifdef __OPENCL_VERSION__

/* One instruction gathers the sign bits where the compiler has x86's; elsewhere they are combined.
 */
#if defined(__has_builtin) && defined(__AVX__)
#if __has_builtin(__builtin_ia32_movmskps256) && __has_builtin(__builtin_ia32_movmskps)
#define CDL_HAS_MOVMSK 1
#endif
#endif

/* Asks for the cache line at p, where the compiler can. */
#ifdef CDL_HAS_MOVMSK
#define LANES_PREFETCH(p) __builtin_prefetch((const void *)(size_t)(p))
#else
#define LANES_PREFETCH(p) ((void)(p))
#endif

CDL_INLINE float2 lanes2_load(CDL_GLOBAL const float *p) { return vload2(0, p); }
CDL_INLINE float2 lanes2_all(float a) { return (float2)(a); }
CDL_INLINE float2 lanes2_fma(float2 a, float2 b, float2 c) { return fma(a, b, c); }
CDL_INLINE float2 lanes2_min(float2 a, float2 b) { return a < b ? a : b; }
CDL_INLINE float2 lanes2_max(float2 a, float2 b) { return a > b ? a : b; }

CDL_INLINE float4 lanes4_load(CDL_GLOBAL const float *p) { return vload4(0, p); }
CDL_INLINE float8 lanes8_load(CDL_GLOBAL const float *p) { return vload8(0, p); }
CDL_INLINE void lanes4_store(float4 a, float *p) { vstore4(a, 0, p); }
CDL_INLINE void lanes8_store(float8 a, float *p) { vstore8(a, 0, p); }
CDL_INLINE float4 lanes4_all(float a) { return (float4)(a); }
CDL_INLINE float8 lanes8_all(float a) { return (float8)(a); }
CDL_INLINE float4 lanes4_fma(float4 a, float4 b, float4 c) { return fma(a, b, c); }
CDL_INLINE float8 lanes8_fma(float8 a, float8 b, float8 c) { return fma(a, b, c); }
CDL_INLINE float8 lanes8_min(float8 a, float8 b) { return a < b ? a : b; }
CDL_INLINE float8 lanes8_max(float8 a, float8 b) { return a > b ? a : b; }
CDL_INLINE float4 lanes4_min(float4 a, float4 b) { return a < b ? a : b; }
CDL_INLINE float4 lanes4_max(float4 a, float4 b) { return a > b ? a : b; }
CDL_INLINE float4 lanes4_select(int4 condition, float4 a, float4 b) { return condition ? a : b; }

#ifdef CDL_HAS_MOVMSK
typedef float lanes4_x86 __attribute__((__vector_size__(16)));
typedef float lanes8_x86 __attribute__((__vector_size__(32)));
CDL_INLINE uint lanes4_mask(int4 condition) {
  return (uint)__builtin_ia32_movmskps(__builtin_astype(condition, lanes4_x86));
}
CDL_INLINE uint lanes8_mask_ordered(float8 a, float8 b) {
  return (uint)__builtin_ia32_movmskps256(__builtin_astype(a <= b, lanes8_x86));
}
#else
CDL_INLINE uint lanes4_mask(int4 condition) {
  int4 bit = condition & (int4)(1, 2, 4, 8);
  return (uint)(bit.x | bit.y | bit.z | bit.w);
}
CDL_INLINE uint lanes8_mask_ordered(float8 a, float8 b) {
  return lanes4_mask(a.lo <= b.lo) | lanes4_mask(a.hi <= b.hi) << 4;
}
#endif

CDL_INLINE uint mask_lowest(uint mask) { return 31u - clz(mask & (0u - mask)); }

#else

#define LANES_PREFETCH(p) __builtin_prefetch(p)

typedef float float4 __attribute__((vector_size(16)));
typedef int int4 __attribute__((vector_size(16)));

/* No vector, because how those of 32 bytes are passed depends on the processor. */
typedef struct float8 {
  float lane[8];
} float8;

typedef struct float2 {
  float x, y;
} float2;

CDL_INLINE float2 lanes2_load(const float *p) { return (float2){p[0], p[1]}; }
CDL_INLINE float2 lanes2_all(float a) { return (float2){a, a}; }

CDL_INLINE float2 lanes2_fma(float2 a, float2 b, float2 c) {
  return (float2){fma(a.x, b.x, c.x), fma(a.y, b.y, c.y)};
}

CDL_INLINE float2 lanes2_min(float2 a, float2 b) {
  return (float2){a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y};
}

CDL_INLINE float2 lanes2_max(float2 a, float2 b) {
  return (float2){a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y};
}

CDL_INLINE float4 lanes4_load(const float *p) {
  float4 a;
  memcpy(&a, p, sizeof a);
  return a;
}

CDL_INLINE float8 lanes8_load(const float *p) {
  float8 a;
  memcpy(&a, p, sizeof a);
  return a;
}

CDL_INLINE void lanes4_store(float4 a, float *p) { memcpy(p, &a, sizeof a); }
CDL_INLINE void lanes8_store(float8 a, float *p) { memcpy(p, &a, sizeof a); }
CDL_INLINE float4 lanes4_all(float a) { return (float4){a, a, a, a}; }
CDL_INLINE float8 lanes8_all(float a) { return (float8){{a, a, a, a, a, a, a, a}}; }

CDL_INLINE float4 lanes4_fma(float4 a, float4 b, float4 c) {
  for (int i = 0; i < 4; i++) c[i] = fma(a[i], b[i], c[i]);
  return c;
}

CDL_INLINE float8 lanes8_fma(float8 a, float8 b, float8 c) {
  for (int i = 0; i < 8; i++) c.lane[i] = fma(a.lane[i], b.lane[i], c.lane[i]);
  return c;
}

CDL_INLINE float8 lanes8_min(float8 a, float8 b) {
  for (int i = 0; i < 8; i++) a.lane[i] = a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i];
  return a;
}

CDL_INLINE float8 lanes8_max(float8 a, float8 b) {
  for (int i = 0; i < 8; i++) a.lane[i] = a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i];
  return a;
}

CDL_INLINE float4 lanes4_min(float4 a, float4 b) {
  for (int i = 0; i < 4; i++) a[i] = a[i] < b[i] ? a[i] : b[i];
  return a;
}

CDL_INLINE float4 lanes4_max(float4 a, float4 b) {
  for (int i = 0; i < 4; i++) a[i] = a[i] > b[i] ? a[i] : b[i];
  return a;
}

CDL_INLINE float4 lanes4_select(int4 condition, float4 a, float4 b) {
  for (int i = 0; i < 4; i++) a[i] = condition[i] ? a[i] : b[i];
  return a;
}

CDL_INLINE uint lanes4_mask(int4 condition) {
  uint mask = 0;
  for (int i = 0; i < 4; i++) mask |= condition[i] ? 1u << i : 0u;
  return mask;
}

CDL_INLINE uint lanes8_mask_ordered(float8 a, float8 b) {
  uint mask = 0;
  for (int i = 0; i < 8; i++) mask |= a.lane[i] <= b.lane[i] ? 1u << i : 0u;
  return mask;
}

CDL_INLINE uint mask_lowest(uint mask) { return (uint)__builtin_ctz(mask); }

#endif
#endif
