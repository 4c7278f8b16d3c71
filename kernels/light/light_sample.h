/* light_sample.h: what sampling a light answers. */
#ifndef CDL_LIGHT_SAMPLE_H
#define CDL_LIGHT_SAMPLE_H

#include "lib/vec.h"

typedef struct LightSample {
  vec3 direction; /* unit, from the vertex to the light */
  vec3 weight;    /* radiance over density; of delta lights irradiance over probability; >= 0 */
  float distance; /* m; infinite for lights at infinity */
  float pdf;      /* 1/sr, choice of the light included; 0: delta light */
} LightSample;

CDL_INLINE LightSample light_sample_make(vec3 direction, float distance, vec3 weight, float pdf) {
  LightSample s;
  s.direction = direction;
  s.weight = weight;
  s.distance = distance;
  s.pdf = pdf;
  return s;
}

CDL_INLINE LightSample light_sample_select(int condition, LightSample a, LightSample b) {
  return light_sample_make(v3_select(condition, a.direction, b.direction),
                           condition ? a.distance : b.distance,
                           v3_select(condition, a.weight, b.weight), condition ? a.pdf : b.pdf);
}

#endif
