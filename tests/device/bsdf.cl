/* bsdf.cl: the surface models over arrays, for test_bsdf.c. `params` is laid out as PARAMETERS
 * there; results are structures of arrays, one row per value. A work-item does a strip of STRIP
 * neighbours, because PoCL vectorises a loop in the kernel where it often fails at its own loop
 * over work-items. */
#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/gltf.h"
#include "bsdf/mirror.h"
#include "bsdf/retroreflector.h"
#include "lib/rng.h"
#include "lib/sampling.h"

#ifdef __clang__ /* which warns when an early pass leaves the loop to a later one */
#pragma clang diagnostic ignored "-Wpass-failed"
#endif
#define STRIP 16u
#define EACH_ITEM                                                                                  \
  size_t first = get_global_id(0) * STRIP;                                                         \
  _Pragma("clang loop vectorize(assume_safety)") for (size_t item = first; item < first + STRIP;   \
                                                      item++)
#define ROW(k) out[(k) * (get_global_size(0) * STRIP) + item]

CDL_INLINE float test_unit(uint seed, size_t item, uint dimension) {
  return rng_to_unit(rng_hash2(rng_hash2((uint)item, seed), dimension));
}

CDL_INLINE vec3 test_vec3(__global const float *a) { return v3(a[0], a[1], a[2]); }

CDL_INLINE BsdfParams test_params(__global const float *a) {
  BsdfParams p;
  p.base = test_vec3(a);
  p.roughness = a[3];
  p.metallic = a[4];
  p.alpha_x = a[5];
  p.alpha_y = a[6];
  p.ior = a[7];
  p.eta = test_vec3(a + 8);
  p.k = test_vec3(a + 11);
  p.flags = as_uint(a[14]);
  p.front = as_int(a[15]);
  return p;
}

/* A direction of the upper hemisphere; one in eight grazes, one in sixteen is the normal. */
CDL_INLINE vec3 test_direction(uint seed, size_t item, uint dimension) {
  float choice = test_unit(seed, item, dimension + 2u);
  vec3 w = sample_sphere(test_unit(seed, item, dimension), test_unit(seed, item, dimension + 1u));
  float grazing = choice > 0.05f ? 1e-3f : 1e-6f;
  float z = choice < 0.125f ? grazing : math_max(math_abs(w.z), 1e-6f);
  vec3 up = v3_normalize(v3(w.x, w.y, z));
  return v3_select(choice > 0.9375f, v3(0.0f, 0.0f, 1.0f), up);
}

/* Every range, and its ends one time in four. */
CDL_INLINE float test_extreme(uint seed, size_t item, uint dimension, float low, float high) {
  float u = test_unit(seed, item, dimension);
  float inner = math_lerp(low, high, (u - 0.125f) * (4.0f / 3.0f));
  return u < 0.125f ? low : (u > 0.875f ? high : inner);
}

CDL_INLINE vec3 test_extreme3(uint seed, size_t item, uint dimension, float low, float high) {
  return v3(test_extreme(seed, item, dimension, low, high),
            test_extreme(seed, item, dimension + 1u, low, high),
            test_extreme(seed, item, dimension + 2u, low, high));
}

CDL_INLINE BsdfParams test_random_params(uint seed, size_t item) {
  BsdfParams p;
  float alpha = test_extreme(seed, item, 20u, 0.0f, 1.0f);
  p.base = test_extreme3(seed, item, 21u, 0.0f, 1.0f);
  p.roughness = test_extreme(seed, item, 24u, 0.0f, 1.0f);
  p.metallic = test_extreme(seed, item, 25u, 0.0f, 1.0f);
  p.alpha_x = test_unit(seed, item, 40u) < 0.3f ? alpha * 1e-4f : alpha;
  p.alpha_y =
      test_unit(seed, item, 41u) < 0.3f ? alpha : test_extreme(seed, item, 26u, 1e-4f, 1.0f);
  p.ior = test_extreme(seed, item, 27u, 1.0f, 3.0f);
  p.eta = test_extreme3(seed, item, 28u, 0.0f, 4.0f);
  p.k = test_extreme3(seed, item, 31u, 0.0f, 10.0f);
  p.flags = rng_hash2((uint)item, seed + 99u) & (CDL_MATERIAL_BECKMANN | CDL_MATERIAL_SEPARABLE);
  p.front = test_unit(seed, item, 34u) < 0.5f;
  return p;
}

/* 0 for a negative, an infinite or no number */
CDL_INLINE int test_sound(float x) { return x >= 0.0f && x <= 3.0e38f; }

CDL_INLINE int test_sound3(vec3 v) { return test_sound(v.x) && test_sound(v.y) && test_sound(v.z); }

/* Bits of what is wrong with a sample and an evaluation. */
CDL_INLINE uint test_faults(BsdfSample s, BsdfValue e) {
  float length2 = v3_length2(s.wi);
  uint faults = test_sound3(s.weight) && v3_max(s.weight) < 30.0f ? 0u : 1u;
  faults |= test_sound(s.pdf) ? 0u : 2u;
  faults |= length2 > 0.9999f && length2 < 1.0001f ? 0u : 4u;
  faults |= test_sound3(e.f_cos) ? 0u : 8u;
  return faults | (test_sound(e.pdf) ? 0u : 16u);
}

#define TEST_KERNELS(NAME)                                                                         \
  __kernel void sample_##NAME(__global const float *params, __global float *out) {                 \
    uint seed = as_uint(params[19]);                                                               \
    EACH_ITEM {                                                                                    \
      BsdfParams p = test_params(params);                                                          \
      vec3 wo = test_vec3(params + 16);                                                            \
      BsdfSample s = NAME##_sample(p, wo, test_unit(seed, item, 0u), test_unit(seed, item, 1u),    \
                                   test_unit(seed, item, 2u));                                     \
      BsdfValue e = NAME##_evaluate(p, wo, s.wi);                                                  \
      ROW(0) = s.wi.x;                                                                             \
      ROW(1) = s.wi.y;                                                                             \
      ROW(2) = s.wi.z;                                                                             \
      ROW(3) = s.weight.x;                                                                         \
      ROW(4) = s.weight.y;                                                                         \
      ROW(5) = s.weight.z;                                                                         \
      ROW(6) = s.pdf;                                                                              \
      ROW(7) = (float)(s.delta + 2 * s.transmitted);                                               \
      ROW(8) = e.f_cos.x;                                                                          \
      ROW(9) = e.f_cos.y;                                                                          \
      ROW(10) = e.f_cos.z;                                                                         \
      ROW(11) = e.pdf;                                                                             \
    }                                                                                              \
  }                                                                                                \
  __kernel void pairs_##NAME(__global const float *params, __global float *out) {                  \
    uint seed = as_uint(params[19]);                                                               \
    EACH_ITEM {                                                                                    \
      BsdfParams p = test_params(params);                                                          \
      vec3 wo = test_direction(seed, item, 0u), wi = test_direction(seed, item, 4u);               \
      BsdfValue there = NAME##_evaluate(p, wo, wi), back = NAME##_evaluate(p, wi, wo);             \
      BsdfValue below = NAME##_evaluate(p, wo, v3_neg(wi));                                        \
      ROW(0) = there.f_cos.x / wi.z;                                                               \
      ROW(1) = there.f_cos.y / wi.z;                                                               \
      ROW(2) = there.f_cos.z / wi.z;                                                               \
      ROW(3) = back.f_cos.x / wo.z;                                                                \
      ROW(4) = back.f_cos.y / wo.z;                                                                \
      ROW(5) = back.f_cos.z / wo.z;                                                                \
      ROW(6) = v3_max(below.f_cos) + below.pdf;                                                    \
    }                                                                                              \
  }                                                                                                \
  __kernel void stress_##NAME(__global const float *params, __global float *out) {                 \
    uint seed = as_uint(params[19]);                                                               \
    EACH_ITEM {                                                                                    \
      BsdfParams p = test_random_params(seed, item);                                               \
      vec3 wo = test_direction(seed, item, 0u), wi = test_direction(seed, item, 4u);               \
      BsdfSample s = NAME##_sample(p, wo, test_unit(seed, item, 8u), test_unit(seed, item, 9u),    \
                                   test_unit(seed, item, 10u));                                    \
      ROW(0) = (float)test_faults(s, NAME##_evaluate(p, wo, wi));                                  \
    }                                                                                              \
  }

TEST_KERNELS(diffuse)
TEST_KERNELS(mirror)
TEST_KERNELS(conductor)
TEST_KERNELS(dielectric)
TEST_KERNELS(retroreflector)
TEST_KERNELS(gltf)
