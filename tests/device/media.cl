/* media.cl: homogeneous media over arrays, for test_media.c. Results are rows of
 * get_global_size(0) floats. */
#include "lib/rng.h"
#include "media/homogeneous.h"

#define ROW(k) out[(k)*get_global_size(0) + get_global_id(0)]

CDL_INLINE float test_unit(uint seed, uint dimension) {
  return rng_to_unit(rng_hash2(rng_hash2((uint)get_global_id(0), seed), dimension));
}

/* sigma_a, sigma_s, throughput, t_max, seed */
__kernel void sample_flight(__global const float *in, __global float *out) {
  uint seed = as_uint(in[10]);
  FreeFlight f =
      homogeneous_sample(v3(in[0], in[1], in[2]), v3(in[3], in[4], in[5]), v3(in[6], in[7], in[8]),
                         in[9], test_unit(seed, 0u), test_unit(seed, 1u), equiangular_none());
  ROW(0) = f.t;
  ROW(1) = (float)f.scattered;
  ROW(2) = f.weight.x;
  ROW(3) = f.weight.y;
  ROW(4) = f.weight.z;
}

/* The same, with a lamp aside of the ray at (in[11], 0, in[12]); rows 5 and 6: a distance drawn
 * near to it, and its density. */
__kernel void sample_flight_near(__global const float *in, __global float *out) {
  uint seed = as_uint(in[10]);
  vec3 sigma_a = v3(in[0], in[1], in[2]), sigma_s = v3(in[3], in[4], in[5]);
  EquiAngular near = equiangular_toward(v3(in[11], 0.0f, in[12]), v3_all(0.0f),
                                        v3(0.0f, 0.0f, 1.0f), in[9], 1e-3f);
  FreeFlight f = homogeneous_sample(sigma_a, sigma_s, v3(in[6], in[7], in[8]), in[9],
                                    test_unit(seed, 0u), test_unit(seed, 1u), near);
  ROW(0) = f.t;
  ROW(1) = (float)f.scattered;
  ROW(2) = f.weight.x;
  ROW(3) = f.weight.y;
  ROW(4) = f.weight.z;
  ROW(5) = equiangular_sample(near, in[9], test_unit(seed, 3u));
  ROW(6) = equiangular_pdf(near, out[5 * get_global_size(0) + get_global_id(0)]);
}

/* sigma, t: transmittance and its integral */
__kernel void transmit(__global const float *in, __global float *out) {
  size_t i = get_global_id(0), n = get_global_size(0);
  ROW(0) = homogeneous_transmittance(v3(in[i], 0.0f, 1.0f), in[n + i]).x;
  ROW(1) = homogeneous_transmittance_integral(in[i], in[n + i]);
  ROW(2) = homogeneous_emission(v3(2.0f, 0.0f, 0.0f), v3(in[i], 0.0f, 0.0f), in[n + i]).x;
  ROW(3) = homogeneous_emission(v3(2.0f, 0.0f, 0.0f), v3(in[i], 0.0f, 0.0f), in[n + i]).y;
}
