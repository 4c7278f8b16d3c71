/* lecture.cl: the library's functions at the figures of test_lecture.c. */
#include "bsdf/conductor.h"
#include "bsdf/diffuse.h"
#include "lib/frame.h"
#include "lib/rng.h"
#include "lib/sampling.h"
#include "media/homogeneous.h"
#include "media/phase.h"

CDL_INLINE vec3 load3(__global const float *a) { return v3(a[0], a[1], a[2]); }

CDL_INLINE void store3(__global float *a, vec3 v) {
  a[0] = v.x;
  a[1] = v.y;
  a[2] = v.z;
}

/* w, n -> w mirrored about n */
__kernel void reflection(__global const float *in, __global float *out) {
  store3(out, fresnel_reflect(load3(in), load3(in + 3)));
}

/* cos_i, eta by item -> reflectance, cos_t, amplitudes, total, and the refracted direction of a ray
 * in the plane of x and z */
__kernel void dielectric_boundary(__global const float *in, __global float *out) {
  size_t i = get_global_id(0);
  float cos_i = in[2 * i], eta = in[2 * i + 1];
  DielectricFresnel f = fresnel_dielectric(cos_i, eta);
  vec3 w = v3(sqrt(1.0f - cos_i * cos_i), 0.0f, cos_i);
  out[8 * i] = f.reflectance;
  out[8 * i + 1] = f.cos_t;
  out[8 * i + 2] = f.amplitude_s;
  out[8 * i + 3] = f.amplitude_p;
  out[8 * i + 4] = (float)f.total;
  store3(out + 8 * i + 5, fresnel_refract(w, v3(0.0f, 0.0f, 1.0f), cos_i, f.cos_t, eta));
}

/* cos_i, eta (3), k (3) by item -> reflectance (3) */
__kernel void metal(__global const float *in, __global float *out) {
  size_t i = get_global_id(0);
  store3(out + 3 * i, fresnel_conductor(in[7 * i], load3(in + 7 * i + 1), load3(in + 7 * i + 4)));
}

/* d, g, f, cos_i, cos_o, cos_h -> the product; the half vector's Jacobian */
__kernel void microfacet(__global const float *in, __global float *out) {
  out[0] = microfacet_product(in[0], in[1], in[2], in[3], in[4]);
  out[1] = microfacet_half_vector_jacobian(in[5]);
}

/* alpha_x, alpha_y, beckmann, then h by item -> D(h) */
__kernel void facets(__global const float *in, __global float *out) {
  size_t i = get_global_id(0);
  Microfacets m = microfacet_surface(in[0], in[1], in[2] > 0.0f, 0);
  out[i] = microfacet_density(m, load3(in + 3 + 3 * i));
}

/* cos, g by item -> phase function per steradian */
__kernel void phase(__global const float *in, __global float *out) {
  size_t i = get_global_id(0);
  Phase phase = {in[2 * i + 1], 0.0f, 0.0f, 0.0f, 0.0f};
  out[i] = phase_value(phase, in[2 * i]);
}

/* sigma (3), t -> transmittance (3) */
__kernel void beer_lambert(__global const float *in, __global float *out) {
  store3(out, homogeneous_transmittance(load3(in), in[3]));
}

/* normal, vector -> x, y, z of the frame; vector in it; and back */
__kernel void local_frame(__global const float *in, __global float *out) {
  Frame f = frame_from_normal(load3(in));
  vec3 in_frame = frame_to_local(f, load3(in + 3));
  store3(out, f.x);
  store3(out + 3, f.y);
  store3(out + 6, f.z);
  store3(out + 9, in_frame);
  store3(out + 12, frame_to_world(f, in_frame));
}

/* reflectance -> by item: cosine and weight of a diffuse sample; tan^2 of a half vector drawn from
 * Beckmann's D of alpha 0.5 (straight from above, where all normals are visible), and the pdf of
 * the mirrored direction over D cos / (4 wo.h) */
__kernel void samples(__global const float *in, __global float *out) {
  uint i = (uint)get_global_id(0);
  float u = rng_to_unit(rng_hash2(i, 1u)), v = rng_to_unit(rng_hash2(i, 2u));
  DiffuseParams p = {.reflectance = v3_all(in[0])};
  vec3 up = v3(0.0f, 0.0f, 1.0f);
  BsdfSample diffuse = diffuse_sample(p, up, u, v, 0.0f);
  Microfacets m = microfacet_surface(0.5f, 0.5f, 1, 0);
  vec3 h = microfacet_sample_normal(m, up, u, v);
  MicrofacetLobe lobe = microfacet_evaluate(m, up, fresnel_reflect(up, h));
  float expected = microfacet_density(m, h) * h.z * microfacet_half_vector_jacobian(h.z);
  out[4 * i] = diffuse.wi.z;
  out[4 * i + 1] = diffuse.weight.x;
  out[4 * i + 2] = (1.0f - h.z * h.z) / (h.z * h.z);
  out[4 * i + 3] = lobe.pdf > 0.0f ? lobe.pdf / expected : 1.0f;
}
