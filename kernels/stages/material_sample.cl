/* material_sample: directions drawn for given ones, of one material, with the numbers that a render
 * would draw: results of 8 floats, wi, weight (red, green, blue), pdf and whether it is a delta
 * lobe. */
#include "bsdf/query.h"
#include "lib/dimensions.h"
#include "lib/rng.h"

__kernel void material_sample(CDL_CONSTANT cdl_BsdfQuery *restrict query,
                              CDL_GLOBAL const cdl_Material *materials,
                              CDL_GLOBAL const float *energy_table,
                              CDL_GLOBAL const float *bsdf_directions,
                              CDL_GLOBAL float *bsdf_results) {
  size_t i = get_global_id(0);
  if (i >= query->count) return;
  uint sample = query->first_sample + (uint)i;
  uint direction = sample / query->samples;
  sample -= direction * query->samples;
  uint key = rng_pixel_key(query->first + direction, 0u, query->seed);
  float u, v, lobe, channel, wavelength, unused;
  rng_2d(key, sample, CDL_PAIR_PATH, &wavelength, &unused);
  rng_2d(key, sample, CDL_PAIR_FIRST_VERTEX + CDL_PAIR_DIRECTION, &u, &v);
  rng_2d(key, sample, CDL_PAIR_FIRST_VERTEX + CDL_PAIR_LOBE, &lobe, &unused);
  rng_2d(key, sample, CDL_PAIR_FIRST_VERTEX + CDL_PAIR_CHANNEL, &channel, &unused);
  vec3 wo = query_vec3(bsdf_directions, direction);
  int front = wo.z > 0.0f;
  wo = query_turn(front, wo);
  BsdfParams p = query_params(materials, energy_table, front, wavelength, channel);
  BsdfSample s = bsdf_sample_model(p, wo, u, v, lobe);
  int there = wo.z > 0.0f;
  vec3 wi = query_turn(front, s.wi);
  CDL_GLOBAL float *out = bsdf_results + 8 * i;
  out[0] = wi.x;
  out[1] = wi.y;
  out[2] = wi.z;
  out[3] = there ? s.weight.x : 0.0f;
  out[4] = there ? s.weight.y : 0.0f;
  out[5] = there ? s.weight.z : 0.0f;
  out[6] = there ? s.pdf : 0.0f;
  out[7] = s.delta ? 1.0f : 0.0f;
}
