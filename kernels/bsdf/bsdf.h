/* bsdf.h: what all surface models share.
 *
 * A model Name in name.h is a struct of what it depends on at one point and three functions,
 *   NameParams name_params(BsdfPoint point, CDL_GLOBAL const uint *params, size_t stride, size_t i)
 *   BsdfValue name_evaluate(NameParams p, vec3 wo, vec3 wi)
 *   BsdfSample name_sample(NameParams p, vec3 wo, float u, float v, float w)
 * in the local frame: X the tangent, Y the bitangent, Z the shading normal turned to the side of
 * wo, so that wo.z > 0. Directions have length 1 and point away from the surface: wo to where the
 * radiance goes, wi to where it comes from. u, v, w are uniform in [0,1).
 *
 * Opaque models answer 0 for wi.z <= 0. Delta lobes are only ever sampled: evaluate gives 0 with a
 * pdf of 0. sample's pdf is evaluate's at its wi, and its weight is f cos / pdf. All is radiance:
 * refraction divides by the square of the relative index. Everything is straight-line code. */
#ifndef CDL_BSDF_BSDF_H
#define CDL_BSDF_BSDF_H

#include "abi/material.h"
#include "lib/math.h"
#include "lib/vec.h"

#define BSDF_IOR_MIN 0.01f /* the least index; textures may say 0 */

/* What all models have at a point, textures applied. */
typedef struct BsdfPoint {
  vec3 base;            /* reflectance, base colour or transmittance, [0,1] */
  vec3 throughput;      /* of the path so far; for the choice of a colour channel alone */
  vec3 coat_normal;     /* unit, in the local frame: the normal of a clear coat */
  float wavelength;     /* [0,1), the same at all vertices of a path */
  float channel_choice; /* [0,1), of this vertex: for the choice of a colour channel */
  uint flags;           /* CDL_MATERIAL_* */
  int front;            /* 1: wo is on the front of the geometry, outside */
  int mirrored;         /* 1: the texture's bitangent is along -Y */
  /* energy.h's tables, for models that compensate; else NULL */
  CDL_GLOBAL const float *energy;
} BsdfPoint;

/* Words of the model's own parameters, abi/param_fields.h: word k of point i is params[k stride +
 * i]. */
CDL_INLINE float param_float(CDL_GLOBAL const uint *params, uint word, size_t stride, size_t i) {
  return as_float(params[word * stride + i]);
}

CDL_INLINE vec3 param_vec3(CDL_GLOBAL const uint *params, uint word, size_t stride, size_t i) {
  return v3(param_float(params, word, stride, i), param_float(params, word + 1u, stride, i),
            param_float(params, word + 2u, stride, i));
}

CDL_INLINE void param_set_vec3(CDL_GLOBAL uint *params, uint word, size_t stride, size_t i,
                               vec3 value) {
  params[word * stride + i] = as_uint(value.x);
  params[(word + 1u) * stride + i] = as_uint(value.y);
  params[(word + 2u) * stride + i] = as_uint(value.z);
}

typedef struct BsdfValue {
  vec3 f_cos; /* f |cos theta_i|, >= 0 */
  float pdf;  /* of sampling this wi, per solid angle */
  float pad;
} BsdfValue;

typedef struct BsdfSample {
  vec3 wi;
  vec3 weight; /* f |cos theta_i| / pdf; black: no such path */
  float pdf;   /* per solid angle; 0 for a delta lobe */
  float eta;   /* index beyond over index before, 1 unless transmitted */
  int delta;
  int transmitted;
} BsdfSample;

CDL_INLINE BsdfValue bsdf_value(vec3 f_cos, float pdf) {
  BsdfValue value;
  value.f_cos = f_cos;
  value.pdf = pdf;
  value.pad = 0.0f;
  return value;
}

CDL_INLINE BsdfValue bsdf_black(void) { return bsdf_value(v3_all(0.0f), 0.0f); }

/* A sample of a lobe that has a density. */
CDL_INLINE BsdfSample bsdf_sample(vec3 wi, vec3 weight, float pdf) {
  BsdfSample sample;
  sample.wi = wi;
  sample.weight = weight;
  sample.pdf = pdf;
  sample.eta = 1.0f;
  sample.delta = 0;
  sample.transmitted = 0;
  return sample;
}

/* A sample of a lobe that is one direction. */
CDL_INLINE BsdfSample bsdf_delta(vec3 wi, vec3 weight) {
  BsdfSample sample = bsdf_sample(wi, weight, 0.0f);
  sample.delta = 1;
  return sample;
}

/* Mirror direction about +Z. */
CDL_INLINE vec3 bsdf_mirror(vec3 w) { return v3(-w.x, -w.y, w.z); }

/* 1/x, and 0 for x <= 0 */
CDL_INLINE float bsdf_reciprocal(float x) {
  float r = 1.0f / (x > 0.0f ? x : 1.0f);
  return x > 0.0f ? r : 0.0f;
}

#endif
