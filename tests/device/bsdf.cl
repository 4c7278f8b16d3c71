/* bsdf.cl: one surface model over arrays, for test_bsdf.c, which puts bsdf_setup.h, the model's
 * header and the names model_params, model_evaluate, model_sample and ModelParams before this text.
 *
 * Results are structures of arrays, one row per value. A work-item does a strip of neighbours,
 * because PoCL vectorises a loop in the kernel where it often fails at its own over work-items. */
#include "lib/rng.h"
#include "lib/sampling.h"

#ifdef __clang__ /* which warns when an early pass leaves the loop to a later one */
#pragma clang diagnostic ignored "-Wpass-failed"
#endif
#define EACH_ITEM                                                                                  \
  size_t first = get_global_id(0) * BSDF_STRIP;                                                    \
  _Pragma("clang loop vectorize(assume_safety)") for (size_t item = first;                         \
                                                      item < first + BSDF_STRIP; item++)
#define ITEMS (get_global_size(0) * BSDF_STRIP)
#define ROW(k) out[(k)*ITEMS + item]

CDL_INLINE float test_unit(uint seed, size_t item, uint dimension) {
  return rng_to_unit(rng_hash2(rng_hash2((uint)item, seed), dimension));
}

CDL_INLINE vec3 test_vec3(__global const float *a) { return v3(a[0], a[1], a[2]); }

CDL_INLINE BsdfPoint test_point(__global const BsdfSetup *setup, __global const float *energy) {
  BsdfPoint point;
  point.base = test_vec3(setup->base);
  point.throughput = test_vec3(setup->throughput);
  point.coat_normal = test_vec3(setup->coat_normal);
  point.wavelength = setup->wavelength;
  point.channel_choice = setup->channel_choice;
  point.flags = setup->flags;
  point.front = setup->front;
  point.mirrored = 0;
  point.energy = energy;
  return point;
}

/* 0 for a negative, an infinite or no number */
CDL_INLINE int test_sound(float x) { return x >= 0.0f && x <= 3.0e38f; }

CDL_INLINE int test_sound3(vec3 v) { return test_sound(v.x) & test_sound(v.y) & test_sound(v.z); }

CDL_INLINE int test_near(float a, float b, float tolerance) {
  return math_abs(a - b) <= tolerance * math_max(math_abs(a), math_abs(b)) + 1e-30f;
}

CDL_INLINE uint test_sample_faults(BsdfSample s, float weight_max) {
  float length2 = v3_length2(s.wi);
  int heavy = v3_max(s.weight) > 0.0f;
  int side = s.transmitted ? s.wi.z < 0.0f : s.wi.z > 0.0f;
  int weighs = test_sound3(s.weight) & (v3_max(s.weight) <= weight_max);
  int dense = test_sound(s.pdf) & (s.delta ? s.pdf == 0.0f : 1);
  uint faults = weighs ? 0u : BSDF_FAULT_WEIGHT;
  faults |= dense ? 0u : BSDF_FAULT_PDF;
  faults |= length2 > 0.9999f && length2 < 1.0001f ? 0u : BSDF_FAULT_DIRECTION;
  faults |= heavy & !side ? BSDF_FAULT_SIDE : 0u;
  return faults | (heavy & !s.delta & (s.pdf == 0.0f) ? BSDF_FAULT_LOST : 0u);
}

CDL_INLINE uint test_value_faults(BsdfValue e) {
  return test_sound3(e.f_cos) & test_sound(e.pdf) ? 0u : BSDF_FAULT_VALUE;
}

/* A black weight says that there is no such path, whatever may come from its direction. */
CDL_INLINE int test_is_refused(BsdfSample s, BsdfValue e) {
  return v3_max(s.weight) == 0.0f && v3_max(e.f_cos) > 0.0f;
}

/* A sample that has a density, against the evaluation of its direction. */
CDL_INLINE uint test_same_faults(BsdfSample s, BsdfValue e, float tolerance) {
  vec3 f_cos = v3_scale(s.weight, s.pdf);
  int same = test_near(f_cos.x, e.f_cos.x, tolerance) & test_near(f_cos.y, e.f_cos.y, tolerance) &
             test_near(f_cos.z, e.f_cos.z, tolerance);
  uint faults = test_near(s.pdf, e.pdf, tolerance) ? 0u : BSDF_FAULT_SAME_PDF;
  faults |= same ? 0u : BSDF_FAULT_SAME_VALUE;
  return s.pdf > 0.0f && !test_is_refused(s, e) ? faults : 0u;
}

/* The cell of a unit vector: bsdf_chart.h. */
CDL_INLINE uint test_cell(__global const BsdfChartSetup *chart, vec3 w) {
  float x = v3_dot(test_vec3(chart->axes), w);
  float y = v3_dot(test_vec3(chart->axes + 3), w);
  float z = v3_dot(test_vec3(chart->axes + 6), w);
  float side = fma(x, x, y * y);
  float near = side / (1.0f + math_max(z, 0.0f)); /* 1 - z without cancellation near the pole */
  float s = z > 0.0f ? near : 1.0f - z;
  float ring = math_log1p(s / chart->spread) * chart->inverse_range;
  float turn = math_atan2(-x * chart->inverse_aspect, y) * CDL_INV_2PI + 0.5f;
  uint i = (uint)math_clamp(ring * (float)BSDF_CELLS_X, 0.0f, (float)BSDF_CELLS_X - 0.5f);
  uint j = (uint)math_clamp(turn * (float)BSDF_CELLS_Y, 0.0f, (float)BSDF_CELLS_Y - 0.5f);
  return i * BSDF_CELLS_Y + j;
}

__kernel void sample(__global const BsdfSetup *setup, __global const uint *params,
                     __global const float *energy, __global uint *out) {
  uint seed = setup->seed;
  EACH_ITEM {
    ModelParams p = model_params(test_point(setup, energy), params, 1, 0);
    vec3 wo = test_vec3(setup->wo);
    BsdfSample s = model_sample(p, wo, test_unit(seed, item, 0u), test_unit(seed, item, 1u),
                                test_unit(seed, item, 2u));
    BsdfValue e = model_evaluate(p, wo, s.wi);
    vec3 wi = v3(s.wi.x, s.wi.y, math_abs(s.wi.z));
    uint above = test_cell(setup->charts, wi);
    uint below = test_cell(setup->charts + 1, wi) + BSDF_CELLS;
    uint cell = s.wi.z > 0.0f ? above : below;
    uint faults = test_sample_faults(s, setup->weight_max) | test_value_faults(e);
    float flux = s.eta * s.eta;
    ROW(0) = s.pdf > 0.0f && !test_is_refused(s, e) ? cell : BSDF_CELL_NONE;
    ROW(1) = as_uint(v3_max(s.weight) * flux);
    ROW(2) = faults | test_same_faults(s, e, setup->tolerance);
  }
}

/* Samples as they are. */
__kernel void draw(__global const BsdfSetup *setup, __global const uint *params,
                   __global const float *energy, __global float *out) {
  uint seed = setup->seed;
  EACH_ITEM {
    ModelParams p = model_params(test_point(setup, energy), params, 1, 0);
    BsdfSample s = model_sample(p, test_vec3(setup->wo), test_unit(seed, item, 0u),
                                test_unit(seed, item, 1u), test_unit(seed, item, 2u));
    ROW(0) = s.wi.x;
    ROW(1) = s.wi.y;
    ROW(2) = s.wi.z;
    ROW(3) = s.weight.x;
    ROW(4) = s.weight.y;
    ROW(5) = s.weight.z;
    ROW(6) = s.pdf;
    ROW(7) = s.eta;
    ROW(8) = (float)(s.delta + 2 * s.transmitted);
  }
}

/* `directions`: rows of wo and wi, wo.z > 0. What is seen from wi's side is turned over, so that
 * its z is positive: no model tells left from right. */
__kernel void pairs(__global const BsdfSetup *setup, __global const uint *params,
                    __global const float *energy, __global const float *directions,
                    __global float *out) {
  EACH_ITEM {
    BsdfPoint point = test_point(setup, energy);
    vec3 wo = v3(directions[item], directions[ITEMS + item], directions[2 * ITEMS + item]);
    vec3 wi = v3(directions[3 * ITEMS + item], directions[4 * ITEMS + item],
                 directions[5 * ITEMS + item]);
    float turn = wi.z > 0.0f ? 1.0f : -1.0f;
    BsdfValue there = model_evaluate(model_params(point, params, 1, 0), wo, wi);
    BsdfValue below = model_evaluate(model_params(point, params, 1, 0), wo, v3_neg(wi));
    point.front = wi.z > 0.0f ? point.front : !point.front;
    BsdfValue back = model_evaluate(model_params(point, params, 1, 0), v3(wi.x, wi.y, wi.z * turn),
                                    v3(wo.x, wo.y, wo.z * turn));
    float cosine = math_abs(wi.z);
    ROW(0) = there.f_cos.x / cosine;
    ROW(1) = there.f_cos.y / cosine;
    ROW(2) = there.f_cos.z / cosine;
    ROW(3) = back.f_cos.x / wo.z;
    ROW(4) = back.f_cos.y / wo.z;
    ROW(5) = back.f_cos.z / wo.z;
    ROW(6) = there.pdf;
    ROW(7) = v3_max(below.f_cos);
    ROW(8) = below.pdf;
  }
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

/* [0,1], and its ends one time in four */
CDL_INLINE float test_extreme(uint seed, size_t item, uint dimension) {
  float u = test_unit(seed, item, dimension);
  return u < 0.125f ? 0.0f : (u > 0.875f ? 1.0f : (u - 0.125f) * (4.0f / 3.0f));
}

CDL_INLINE vec3 test_extreme3(uint seed, size_t item, uint dimension) {
  return v3(test_extreme(seed, item, dimension), test_extreme(seed, item, dimension + 1u),
            test_extreme(seed, item, dimension + 2u));
}

/* A coat's normal as `parameters` leaves it: any, bent towards wo. */
CDL_INLINE vec3 test_coat_normal(uint seed, size_t item, vec3 wo) {
  vec3 n = test_direction(seed, item, 30u);
  float cosine = v3_dot(n, wo);
  return v3_normalize(v3_madd(n, cosine < 0.01f ? 0.01f - cosine : 0.0f, wo));
}

/* Any input. `params` holds param_sets of them. */
__kernel void stress(__global const BsdfSetup *setup, __global const uint *params,
                     __global const float *energy, __global uint *out) {
  uint seed = setup->seed;
  EACH_ITEM {
    vec3 wo = test_direction(seed, item, 0u), wi = test_direction(seed, item, 4u);
    wi.z = test_unit(seed, item, 8u) < 0.4f ? -wi.z : wi.z;
    BsdfPoint point = test_point(setup, energy);
    point.base = test_extreme3(seed, item, 20u);
    point.throughput = test_extreme3(seed, item, 23u);
    vec3 coat_normal = test_coat_normal(seed, item, wo);
    point.coat_normal =
        v3_select(test_unit(seed, item, 26u) < 0.5f, coat_normal, point.coat_normal);
    point.wavelength = test_unit(seed, item, 27u);
    point.channel_choice = test_unit(seed, item, 28u);
    point.flags = rng_hash2((uint)item, seed + 99u) & setup->flags;
    point.front = test_unit(seed, item, 29u) < 0.5f;
    point.mirrored = test_unit(seed, item, 33u) < 0.5f;
    ModelParams p = model_params(point, params, setup->param_sets, item & (setup->param_sets - 1u));
    BsdfSample s = model_sample(p, wo, test_unit(seed, item, 9u), test_unit(seed, item, 10u),
                                test_unit(seed, item, 11u));
    uint faults = test_sample_faults(s, setup->weight_max);
    faults |= test_value_faults(model_evaluate(p, wo, wi));
    ROW(0) = faults | test_same_faults(s, model_evaluate(p, wo, s.wi), setup->tolerance);
  }
}
