/* bsdf.h: what all surface models share.
 *
 * A model NAME in NAME.h is two functions,
 *   BsdfValue NAME_evaluate(BsdfParams p, vec3 wo, vec3 wi)
 *   BsdfSample NAME_sample(BsdfParams p, vec3 wo, float u, float v, float w)
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

/* A material at one point, textures applied. Each model reads what SCENES's table gives it. */
typedef struct BsdfParams {
  vec3 base;              /* reflectance, base colour or transmittance, [0,1] */
  float roughness;        /* glTF's, [0,1] */
  float metallic;         /* [0,1] */
  float alpha_x, alpha_y; /* microfacet alpha along tangent and bitangent, >= 0 */
  float ior;              /* inside over outside, > 0 */
  vec3 eta, k;            /* complex index of a conductor */
  uint flags;             /* CDL_MATERIAL_* */
  int front;              /* 1: wo is on the front of the geometry, outside */
} BsdfParams;

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
