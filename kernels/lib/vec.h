/* vec.h: three-vectors for host and kernels.
 *
 * vec3 carries two pads, always zero: structs of at most 16 bytes are packed into vector registers
 * by x86's calling convention, and one vector value in a kernel stops PoCL's loop vectoriser. A
 * larger struct passed to always-inline functions dissolves into scalars. */
#ifndef CDL_VEC_H
#define CDL_VEC_H

#include "lib/portable.h"

typedef struct vec3 {
  float x, y, z, pad0, pad1;
} vec3;

CDL_INLINE vec3 v3(float x, float y, float z) {
  vec3 v;
  v.x = x;
  v.y = y;
  v.z = z;
  v.pad0 = 0.0f;
  v.pad1 = 0.0f;
  return v;
}

CDL_INLINE vec3 v3_all(float a) { return v3(a, a, a); }

CDL_INLINE vec3 v3_add(vec3 a, vec3 b) { return v3(a.x + b.x, a.y + b.y, a.z + b.z); }

CDL_INLINE vec3 v3_sub(vec3 a, vec3 b) { return v3(a.x - b.x, a.y - b.y, a.z - b.z); }

CDL_INLINE vec3 v3_mul(vec3 a, vec3 b) { return v3(a.x * b.x, a.y * b.y, a.z * b.z); }

CDL_INLINE vec3 v3_scale(vec3 a, float s) { return v3(a.x * s, a.y * s, a.z * s); }

CDL_INLINE vec3 v3_neg(vec3 a) { return v3(-a.x, -a.y, -a.z); }

/* a + s b */
CDL_INLINE vec3 v3_madd(vec3 a, float s, vec3 b) {
  return v3(fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z));
}

CDL_INLINE float v3_dot(vec3 a, vec3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

/* ab - cd without catastrophic cancellation (Kahan; error at most 1.5 ulp, Jeannerod et al. 2013).
 */
CDL_INLINE float difference_of_products(float a, float b, float c, float d) {
  float cd = c * d;
  float error = fma(-c, d, cd);
  return fma(a, b, -cd) + error;
}

CDL_INLINE vec3 v3_cross(vec3 a, vec3 b) {
  return v3(difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x));
}

CDL_INLINE float v3_length2(vec3 a) { return v3_dot(a, a); }

CDL_INLINE float v3_length(vec3 a) { return sqrt(v3_length2(a)); }

/* The zero vector stays zero. */
CDL_INLINE vec3 v3_normalize(vec3 a) {
  float l = v3_length(a);
  return v3_scale(a, l > 0.0f ? 1.0f / l : 0.0f);
}

CDL_INLINE float v3_max(vec3 a) { return fmax(a.x, fmax(a.y, a.z)); }

/* condition ? a : b, by component, so that it stays a select */
CDL_INLINE vec3 v3_select(int condition, vec3 a, vec3 b) {
  return v3(condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z);
}

#endif
