/* body.h: the surface of a body in which light wanders until it has lost its direction: a rough
 * dielectric coat, and below it what passes, spread evenly,
 *
 *   outside:  f = F D G / (4 cos cos);  inwards: f = T(wo) / (pi ior^2)
 *   inside:   f = K / pi;               outwards: f = T(wi) / pi
 *
 * with T(w), what passes the coat, and K = 1 - <T> / ior^2, what it sends back in of diffuse light,
 * as plastic.h has them: plastic is this surface over a base that is no body. Reciprocal, with the
 * ior^2 of radiance on the denser side, and light in equilibrium stays so.
 *
 * A boundary that refracted would keep the direction of the last step, and no light could be
 * sampled through it. */
#ifndef CDL_BSDF_BODY_H
#define CDL_BSDF_BODY_H

#include "bsdf/plastic.h"

typedef struct BodyParams {
  PlasticParams coat; /* over a white base, whose base is 1 / <T> */
  float returned;     /* K */
  int front;          /* wo is outside */
} BodyParams;

CDL_INLINE BodyParams body_params(BsdfPoint point, CDL_GLOBAL const uint *params, size_t stride,
                                  size_t i) {
  BodyParams p;
  point.base = v3_all(1.0f);
  p.coat = plastic_make(point, param_float(params, CDL_BODY_ALPHA, stride, i),
                        param_float(params, CDL_BODY_ALPHA + 1u, stride, i),
                        param_float(params, CDL_BODY_IOR, stride, i));
  p.coat.guess = 1.0f;
  p.returned = 1.0f - 1.0f / (p.coat.base.x * p.coat.eta * p.coat.eta);
  p.front = point.front;
  return p;
}

/* Probability of staying on wo's side: by the coat, or by what it sends back. */
CDL_INLINE float body_stays(BodyParams p, float pass) {
  return p.front ? plastic_coat_probability(p.coat, pass) : p.returned;
}

CDL_INLINE BsdfValue body_value(BodyParams p, vec3 wo, vec3 wi, float stays) {
  MicrofacetLobe lobe = microfacet_evaluate(p.coat.facets, wo, wi);
  float fresnel = fresnel_dielectric(lobe.cos_h, p.coat.eta).reflectance;
  int above = wi.z > 0.0f;
  float rough = p.coat.facets.smooth ? 0.0f : 1.0f;
  float cosine = CDL_INV_PI * math_abs(wi.z);
  vec3 outer = v3_select(p.front, wo, v3(wi.x, wi.y, -wi.z));
  float scale = p.front ? 1.0f / (p.coat.eta * p.coat.eta) : 1.0f;
  float through = plastic_pass(p.coat, outer) * scale * cosine;
  float back = p.front ? rough * lobe.f_cos * fresnel : p.returned * cosine;
  float back_pdf = p.front ? rough * lobe.pdf : cosine;
  return bsdf_value(v3_all(above ? back : through),
                    above ? stays * back_pdf : (1.0f - stays) * cosine);
}

CDL_INLINE BsdfValue body_evaluate(BodyParams p, vec3 wo, vec3 wi) {
  return body_value(p, wo, wi, body_stays(p, plastic_pass(p.coat, wo)));
}

CDL_INLINE BsdfSample body_sample(BodyParams p, vec3 wo, float u, float v, float w) {
  float pass = plastic_pass(p.coat, wo);
  float stays = body_stays(p, pass);
  int stay = w < stays;
  int smooth = p.coat.facets.smooth;
  int delta = stay && p.front && smooth;
  vec3 facet = fresnel_reflect(wo, microfacet_sample_normal(p.coat.facets, wo, u, v));
  vec3 spread = sample_cosine_hemisphere(u, v);
  vec3 back = v3_select(p.front, v3_select(smooth, bsdf_mirror(wo), facet), spread);
  vec3 wi = v3_select(stay, back, v3_neg(spread));
  BsdfValue value = body_value(p, wo, wi, stays);
  int lost = stay && !(wi.z > 0.0f); /* a facet sends it below the horizon: it does not pass */
  value.pdf = lost ? 0.0f : value.pdf;
  vec3 weight = v3_scale(value.f_cos, bsdf_reciprocal(value.pdf));
  vec3 mirror = v3_all((1.0f - pass) / (delta ? stays : 1.0f));
  BsdfSample sample = bsdf_sample(wi, v3_select(delta, mirror, weight), delta ? 0.0f : value.pdf);
  sample.delta = delta;
  sample.transmitted = wi.z < 0.0f;
  sample.eta = sample.transmitted ? (p.front ? p.coat.eta : 1.0f / p.coat.eta) : 1.0f;
  return sample;
}

#endif
