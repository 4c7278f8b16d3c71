/* punctual.h: point, spot and directional lights of KHR_lights_punctual. */
#ifndef CDL_LIGHT_PUNCTUAL_H
#define CDL_LIGHT_PUNCTUAL_H

#include "light/triangle.h"

/* The window that KHR_lights_punctual recommends: max(min(1 - (d / range)^4, 1), 0). */
CDL_INLINE float light_range_window(float distance, float range) {
  float ratio = math_sqr(math_sqr(distance / (range > 0.0f ? range : 1.0f)));
  return range > 0.0f ? math_saturate(1.0f - ratio) : 1.0f;
}

/* A point or a spot: intensity, cone and window over the squared distance. */
CDL_INLINE LightSample light_point_sample(CDL_GLOBAL const cdl_Light *light, vec3 position) {
  vec3 to_light = v3_sub(light_vec3(light->p), position);
  float distance2 = v3_length2(to_light);
  float distance = sqrt(distance2);
  vec3 direction = v3_normalize(to_light);
  float along_axis = -v3_dot(direction, light_vec3(light->e1));
  float cone = math_saturate(fma(along_axis, light->cone_scale, light->cone_offset));
  float falloff = math_sqr(cone) * light_range_window(distance, light->range);
  float scale = falloff / (distance2 * light->select_pdf);
  int lit = distance2 > 0.0f && scale < CDL_INFINITY;
  return light_sample_make(direction, distance,
                           v3_scale(light_vec3(light->radiance), lit ? scale : 0.0f), 0.0f);
}

CDL_INLINE LightSample light_directional_sample(CDL_GLOBAL const cdl_Light *light) {
  return light_sample_make(v3_neg(light_vec3(light->e1)), CDL_INFINITY,
                           v3_scale(light_vec3(light->radiance), 1.0f / light->select_pdf), 0.0f);
}

#endif
