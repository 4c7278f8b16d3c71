/* triangle.h: emissive triangles, sampled uniformly by area. */
#ifndef CDL_LIGHT_TRIANGLE_H
#define CDL_LIGHT_TRIANGLE_H

#include "abi/light.h"
#include "lib/sampling.h"
#include "light/light_sample.h"

CDL_INLINE vec3 light_vec3(CDL_GLOBAL const float *a) { return v3(a[0], a[1], a[2]); }

/* Density, in solid angle at a point `distance` m away, of choosing this very point of the
 * triangle; `cosine` is that of the angle at the light, either sign. 0 where the light is seen edge
 * on. */
CDL_INLINE float light_triangle_pdf(CDL_GLOBAL const cdl_Light *light, float distance,
                                    float cosine) {
  float projected = light->area * math_abs(cosine);
  float pdf = light->select_pdf * distance * distance / projected;
  return projected > 0.0f && pdf < CDL_INFINITY ? pdf : 0.0f;
}

/* Barycentrics of corners 1 and 2 of a point chosen uniformly; see sample_triangle(). */
CDL_INLINE LightSample light_triangle_sample(CDL_GLOBAL const cdl_Light *light, vec3 position,
                                             float b1, float b2, vec3 radiance) {
  vec3 e1 = light_vec3(light->e1);
  vec3 e2 = light_vec3(light->e2);
  vec3 point = v3_madd(v3_madd(light_vec3(light->p), b1, e1), b2, e2);
  vec3 to_light = v3_sub(point, position);
  float distance = v3_length(to_light);
  vec3 direction = v3_normalize(to_light);
  /* Not to be normalised side by side with the direction, see math_after. */
  e1.x = math_after(direction.z, e1.x);
  e1.y = math_after(e1.x, e1.y);
  e1.z = math_after(e1.y, e1.z);
  float outward = v3_dot(direction, v3_normalize(v3_cross(e1, e2)));
  float cosine = light->flags & CDL_LIGHT_MIRRORED ? outward : -outward;
  float pdf = light_triangle_pdf(light, distance, cosine);
  int lit = pdf > 0.0f && (cosine > 0.0f || (light->flags & CDL_LIGHT_DOUBLE_SIDED) != 0u);
  vec3 weight = v3_scale(radiance, lit ? 1.0f / pdf : 0.0f);
  return light_sample_make(direction, distance, weight, pdf);
}

#endif
