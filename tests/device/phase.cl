/* phase.cl: phase functions over arrays, for test_phase.c. Results are rows of get_global_size(0)
 * floats; `in` begins with g0, g1, alpha0, alpha1 and the second lobe's weight. */
#include "lib/rng.h"
#include "media/phase.h"

#define ROW(k) out[(k)*get_global_size(0) + get_global_id(0)]

CDL_INLINE float test_unit(uint seed, uint dimension) {
  return rng_to_unit(rng_hash2(rng_hash2((uint)get_global_id(0), seed), dimension));
}

CDL_INLINE Phase test_phase(__global const float *in) {
  Phase phase = {in[0], in[1], in[2], in[3], in[4]};
  return phase;
}

/* direction, seed */
__kernel void sample_phase(__global const float *in, __global float *out) {
  uint seed = as_uint(in[8]);
  Phase phase = test_phase(in);
  PhaseSample s = phase_sample(phase, v3(in[5], in[6], in[7]), test_unit(seed, 0u),
                               test_unit(seed, 1u), test_unit(seed, 2u));
  ROW(0) = s.wi.x;
  ROW(1) = s.wi.y;
  ROW(2) = s.wi.z;
  ROW(3) = s.cosine;
  ROW(4) = s.pdf;
  ROW(5) = phase_value(phase, s.cosine);
}

/* distances r from straight on and straight back: values at cos = 1 - r and r - 1 */
__kernel void integrate_phase(__global const float *in, __global float *out) {
  Phase phase = test_phase(in);
  float r = in[5 + get_global_id(0)];
  ROW(0) = phase_mixture(phase, r, 2.0f - r, 1.0f - r);
  ROW(1) = phase_mixture(phase, 2.0f - r, r, r - 1.0f);
}

/* In [-0.99999, 0.99999], with both ends, 0 and tiny ones. */
CDL_INLINE float test_asymmetry(float choice, float u) {
  float g = math_lerp(-0.99999f, 0.99999f, u);
  g = choice < 0.25f ? g * 1e-6f : g;
  g = choice < 0.1f ? 0.0f : g;
  return choice > 0.75f ? math_mulsign(0.99999f, g) : g;
}

/* In [0, 1e6] by magnitude, with both ends and tiny ones. */
CDL_INLINE float test_alpha(float choice, float u) {
  float alpha = math_exp2(math_lerp(-13.0f, 19.9f, u));
  alpha = choice < 0.2f ? alpha * 1e-30f : alpha;
  alpha = choice < 0.1f ? 0.0f : alpha;
  return choice > 0.9f ? 1e6f : alpha;
}

/* In [0,1), with both ends. */
CDL_INLINE float test_edge(float choice, float u) {
  float x = choice < 0.1f ? 0.0f : u;
  return choice > 0.9f ? CDL_ONE_MINUS_EPSILON : x;
}

/* seed; any parameters, any numbers: any fault? */
__kernel void stress_phase(__global const float *in, __global float *out) {
  uint seed = as_uint(in[0]);
  Phase phase;
  phase.g0 = test_asymmetry(test_unit(seed, 0u), test_unit(seed, 1u));
  phase.g1 = test_asymmetry(test_unit(seed, 2u), test_unit(seed, 3u));
  phase.alpha0 = test_alpha(test_unit(seed, 4u), test_unit(seed, 5u));
  phase.alpha1 = test_alpha(test_unit(seed, 6u), test_unit(seed, 7u));
  float weight = test_edge(test_unit(seed, 8u), test_unit(seed, 9u));
  phase.second = weight == CDL_ONE_MINUS_EPSILON ? 1.0f : weight;
  vec3 direction = v3_normalize(
      v3(test_unit(seed, 10u) - 0.5f, test_unit(seed, 11u) - 0.5f, test_unit(seed, 12u) - 0.5f));
  float u = test_edge(test_unit(seed, 13u), test_unit(seed, 14u));
  float v = test_edge(test_unit(seed, 15u), test_unit(seed, 16u));
  float w = test_edge(test_unit(seed, 17u), test_unit(seed, 18u));
  PhaseSample s = phase_sample(phase, direction, u, v, w);
  float value = phase_value(phase, math_lerp(-1.0f, 1.0f, test_edge(u, v)));
  float length2 = v3_length2(s.wi);
  int sound = s.pdf > 0.0f && s.pdf < 1e10f && length2 > 0.9999f && length2 < 1.0001f;
  sound = sound && math_abs(v3_dot(direction, s.wi) - s.cosine) < 1e-5f;
  ROW(0) = sound && value > 0.0f && value < 1e10f ? 0.0f : 1.0f;
}
