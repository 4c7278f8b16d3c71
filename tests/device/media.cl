/* media.cl: phase function and homogeneous media over arrays, for test_media.c. Results are rows of
 * get_global_size(0) floats. */
#include "lib/rng.h"
#include "media/homogeneous.h"
#include "media/phase.h"

#define ROW(k) out[(k)*get_global_size(0) + get_global_id(0)]

CDL_INLINE float test_unit(uint seed, uint dimension) {
  return rng_to_unit(rng_hash2(rng_hash2((uint)get_global_id(0), seed), dimension));
}

/* direction, g, seed */
__kernel void sample_phase(__global const float *in, __global float *out) {
  uint seed = as_uint(in[4]);
  vec3 direction = v3(in[0], in[1], in[2]);
  PhaseSample s = phase_hg_sample(direction, in[3], test_unit(seed, 0u), test_unit(seed, 1u));
  ROW(0) = s.wi.x;
  ROW(1) = s.wi.y;
  ROW(2) = s.wi.z;
  ROW(3) = s.cosine;
  ROW(4) = s.pdf;
  ROW(5) = phase_hg(s.cosine, in[3]);
}

/* g by item from -0.999 to 0.999, with 0 and tiny ones: any fault? */
__kernel void stress_phase(__global const float *in, __global float *out) {
  uint seed = as_uint(in[4]);
  float choice = test_unit(seed, 5u);
  float g = math_lerp(-0.999f, 0.999f, test_unit(seed, 2u));
  g = choice < 0.25f ? g * 1e-6f : g;
  g = choice > 0.75f ? math_mulsign(0.999f, g) : g;
  vec3 direction = v3_normalize(
      v3(test_unit(seed, 3u) - 0.5f, test_unit(seed, 4u) - 0.5f, test_unit(seed, 6u) - 0.5f));
  PhaseSample s = phase_hg_sample(direction, g, test_unit(seed, 0u), test_unit(seed, 1u));
  float length2 = v3_length2(s.wi);
  int sound = s.pdf > 0.0f && s.pdf < 1e6f && length2 > 0.9999f && length2 < 1.0001f;
  sound = sound && math_abs(v3_dot(direction, s.wi) - s.cosine) < 1e-5f;
  ROW(0) = sound ? 0.0f : 1.0f;
}

/* sigma_a, sigma_s, throughput, t_max, seed */
__kernel void sample_flight(__global const float *in, __global float *out) {
  uint seed = as_uint(in[10]);
  FreeFlight f =
      homogeneous_sample(v3(in[0], in[1], in[2]), v3(in[3], in[4], in[5]), v3(in[6], in[7], in[8]),
                         in[9], test_unit(seed, 0u), test_unit(seed, 1u));
  ROW(0) = f.t;
  ROW(1) = (float)f.scattered;
  ROW(2) = f.weight.x;
  ROW(3) = f.weight.y;
  ROW(4) = f.weight.z;
}

/* sigma, t: transmittance and its integral */
__kernel void transmit(__global const float *in, __global float *out) {
  size_t i = get_global_id(0), n = get_global_size(0);
  ROW(0) = homogeneous_transmittance(v3(in[i], 0.0f, 1.0f), in[n + i]).x;
  ROW(1) = homogeneous_transmittance_integral(in[i], in[n + i]);
  ROW(2) = homogeneous_emission(v3(2.0f, 0.0f, 0.0f), v3(in[i], 0.0f, 0.0f), in[n + i]).x;
  ROW(3) = homogeneous_emission(v3(2.0f, 0.0f, 0.0f), v3(in[i], 0.0f, 0.0f), in[n + i]).y;
}
