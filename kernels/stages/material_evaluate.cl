/* material_evaluate: f and the density of pairs of directions, of one material: results of 4
 * floats, f (red, green, blue, without the cosine) and pdf. `bsdf_directions` holds wo and wi of
 * each pair. */
#include "bsdf/query.h"

__kernel void material_evaluate(CDL_CONSTANT cdl_BsdfQuery *restrict query,
                                CDL_GLOBAL const cdl_Material *materials,
                                CDL_GLOBAL const float *energy_table,
                                CDL_GLOBAL const float *bsdf_directions,
                                CDL_GLOBAL float *bsdf_results) {
  size_t i = get_global_id(0);
  if (i >= query->count) return;
  vec3 wo = query_vec3(bsdf_directions, 2 * i);
  vec3 wi = query_vec3(bsdf_directions, 2 * i + 1);
  int front = wo.z > 0.0f;
  wo = query_turn(front, wo);
  wi = query_turn(front, wi);
  uint bands = query->wavelengths;
  uint count = bands > 0u ? 3u * bands : 1u;
  vec3 f_cos = v3_all(0.0f);
  float pdf = 0.0f;
  for (uint k = 0; k < count; k++) {
    float wavelength = ((float)(k / 3u) + 0.5f) / (float)(bands > 0u ? bands : 1u);
    float channel = ((float)(k % 3u) + 0.5f) / 3.0f;
    BsdfValue value =
        bsdf_evaluate(query_params(materials, energy_table, front, wavelength, channel), wo, wi);
    f_cos = v3_add(f_cos, value.f_cos);
    pdf += value.pdf;
  }
  float cosine = math_abs(wi.z);
  float inverse = wo.z > 0.0f && cosine > 0.0f ? 1.0f / (cosine * (float)count) : 0.0f;
  bsdf_results[4 * i] = f_cos.x * inverse;
  bsdf_results[4 * i + 1] = f_cos.y * inverse;
  bsdf_results[4 * i + 2] = f_cos.z * inverse;
  bsdf_results[4 * i + 3] = inverse > 0.0f ? pdf / (float)count : 0.0f;
}
