/* homogeneous.h: light in a medium that is the same everywhere. Coefficients are in 1/m, distances
 * in m; distances may be infinite. */
#ifndef CDL_MEDIA_HOMOGENEOUS_H
#define CDL_MEDIA_HOMOGENEOUS_H

#include "lib/math.h"
#include "lib/vec.h"
#include "media/equiangular.h"

/* exp(-sigma t), Beer and Lambert; 1 where sigma is 0, however far. */
CDL_INLINE float homogeneous_transmittance_channel(float sigma, float t) {
  float depth = sigma > 0.0f ? sigma * t : 0.0f;
  return math_exp(-depth);
}

CDL_INLINE vec3 homogeneous_transmittance(vec3 sigma_t, float t) {
  float x = homogeneous_transmittance_channel(sigma_t.x, t);
  float y = homogeneous_transmittance_channel(sigma_t.y, t);
  float z = homogeneous_transmittance_channel(sigma_t.z, t);
  return v3(x, y, z);
}

/* (1 - exp(-sigma t)) / sigma, the integral of the transmittance from 0 to t; t where sigma is 0.
 */
CDL_INLINE float homogeneous_transmittance_integral(float sigma, float t) {
  float depth = sigma > 0.0f ? sigma * t : 0.0f;
  float absorbed = -math_expm1(-depth) / (sigma > 0.0f ? sigma : 1.0f);
  return depth > 1e-8f ? absorbed : t;
}

/* Radiance that a stretch of length t sends to its start, itself attenuated: emission is radiance
 * per metre. Without emission 0, even over an infinite stretch. */
CDL_INLINE vec3 homogeneous_emission(vec3 emission, vec3 sigma_t, float t) {
  float x = emission.x * homogeneous_transmittance_integral(sigma_t.x, t);
  float y = emission.y * homogeneous_transmittance_integral(sigma_t.y, t);
  float z = emission.z * homogeneous_transmittance_integral(sigma_t.z, t);
  return v3(emission.x > 0.0f ? x : 0.0f, emission.y > 0.0f ? y : 0.0f,
            emission.z > 0.0f ? z : 0.0f);
}

/* How far a path flies. */
typedef struct FreeFlight {
  vec3 weight;   /* scattered: sigma_s T(t) / pdf(t); else T(t_max) / P(t_max) */
  float t;       /* where it scatters, or t_max */
  int scattered; /* 1: t < t_max */
} FreeFlight;

/* Probabilities of the channels: in proportion to the throughput, so that a channel never gains
 * more weight than the throughput's sum over its own. Black paths: evenly. */
CDL_INLINE vec3 homogeneous_channels(vec3 throughput) {
  float sum = throughput.x + throughput.y + throughput.z;
  float inverse = 1.0f / (sum > 0.0f ? sum : 3.0f);
  return v3_scale(v3_select(sum > 0.0f, throughput, v3_all(1.0f)), inverse);
}

/* Samples the free flight in a medium up to t_max, which may be infinite.
 * One channel, drawn by u_channel, gives the distance; the weight divides by the probability over
 * all of them (one-sample MIS, balance heuristic), and so it does over `near`, by which the
 * distance is drawn where u_distance is below its chance: what is left of the number is as evenly
 * spread over samples. A medium that only absorbs is never stopped in: it weights by
 * exp(-sigma t_max), vacuum by 1. */
CDL_INLINE FreeFlight homogeneous_sample(vec3 sigma_a, vec3 sigma_s, vec3 throughput, float t_max,
                                         float u_channel, float u_distance, EquiAngular near) {
  FreeFlight flight;
  vec3 sigma_t = v3_add(sigma_a, sigma_s);
  vec3 q = homogeneous_channels(throughput);
  int scatters = v3_max(sigma_s) > 0.0f;
  float beyond_x = u_channel < q.x + q.y ? sigma_t.y : sigma_t.z;
  float sigma = u_channel < q.x ? sigma_t.x : beyond_x;
  float chance = scatters ? near.chance : 0.0f;
  int draws_near = u_distance < chance;
  float of_near = u_distance / (draws_near ? chance : 1.0f);
  float of_others = math_min((u_distance - chance) / (1.0f - chance), CDL_ONE_MINUS_EPSILON);
  float drawn = -math_log(1.0f - math_max(of_others, 0.0f)) / (sigma > 0.0f ? sigma : 1.0f);
  drawn = draws_near ? equiangular_sample(near, t_max, of_near) : drawn;
  flight.scattered = scatters && (draws_near || (sigma > 0.0f && drawn < t_max));
  flight.t = flight.scattered ? drawn : t_max;
  vec3 t = homogeneous_transmittance(sigma_t, flight.t);
  vec3 rate = v3_select(flight.scattered, sigma_t, v3_all(1.0f));
  float mixed = v3_dot(v3_mul(q, rate), t);
  mixed = math_lerp(mixed, flight.scattered ? equiangular_pdf(near, flight.t) : 0.0f, chance);
  float probability = scatters ? mixed : 1.0f;
  float inverse = 1.0f / (probability > 0.0f ? probability : 1.0f);
  vec3 value = v3_mul(t, v3_select(flight.scattered, sigma_s, v3_all(1.0f)));
  flight.weight = v3_scale(value, probability > 0.0f ? inverse : 0.0f);
  return flight;
}

#endif
