/* probe.cl: what a device computes and which items it runs; for tests and for `candela devices`. */
#include "lib/portable.h"

/* Per item i, from three floats in[3i…]: out[12i…] gets the bits of every operation that exact
 * arithmetic allows. The host computes the same in device/exactness.c. */
__kernel void probe_arithmetic(__global const float *in, __global uint *out) {
  uint i = (uint)get_global_id(0);
  float a = in[3 * i];
  float b = in[3 * i + 1];
  float c = in[3 * i + 2];
  uint bits = as_uint(a);
  out[12 * i] = as_uint(a + b);
  out[12 * i + 1] = as_uint(a - b);
  out[12 * i + 2] = as_uint(a * b);
  out[12 * i + 3] = as_uint(a / b);
  out[12 * i + 4] = as_uint(sqrt(fabs(a)));
  out[12 * i + 5] = as_uint(fma(a, b, c));
  out[12 * i + 6] = as_uint(a * b + c); /* two roundings: must not be contracted */
  out[12 * i + 7] = as_uint(floor(c));
  out[12 * i + 8] = as_uint(rint(c));
  out[12 * i + 9] = as_uint((float)bits + (float)as_int(b));
  out[12 * i + 10] = as_uint(fmin(a, fmax(b, c)));
  out[12 * i + 11] = (bits * 0x9e3779b9u) ^ (bits >> 15);
}

/* out[k] = k for the items that run, wherever the launch starts. */
__kernel void probe_index(__global uint *out) {
  uint i = (uint)get_global_id(0);
  out[i] = i;
}
