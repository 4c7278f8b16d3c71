/* camera.h: rays of pinhole, thin-lens and orthographic cameras. */
#ifndef CDL_CAMERA_H
#define CDL_CAMERA_H

#include "abi/params.h"
#include "lib/motion.h"
#include "lib/sampling.h"
#include "lib/transform.h"

typedef struct CameraRay {
  vec3 origin;
  vec3 direction; /* unit */
} CameraRay;

CDL_INLINE Transform transform_of_camera(CDL_CONSTANT cdl_CameraParams *camera) {
  CDL_CONSTANT float *m = camera->to_world;
  Transform t;
  t.x = v3(m[0], m[1], m[2]);
  t.y = v3(m[4], m[5], m[6]);
  t.z = v3(m[8], m[9], m[10]);
  t.move = v3(m[3], m[7], m[11]);
  return t;
}

/* Where the camera is, at the time of the path where it moves. */
CDL_INLINE Transform camera_to_world(CDL_CONSTANT cdl_Params *params,
                                     CDL_GLOBAL const float *attributes CDL_TIME_PARAM) {
#ifdef CDL_MOTION
  CDL_GLOBAL const float *keys = attributes + params->camera_keys + 12u * (size_t)time.key;
  Transform a = transform_load(keys);
  Transform b = transform_load(keys + 12);
  Transform t;
  t.x = motion_mix3(a.x, b.x, time.fraction);
  t.y = motion_mix3(a.y, b.y, time.fraction);
  t.z = motion_mix3(a.z, b.z, time.fraction);
  t.move = motion_mix3(a.move, b.move, time.fraction);
  return t;
#else
  (void)attributes;
  return transform_of_camera(&params->camera);
#endif
}

/* A point on the lens in camera space: round, or a regular polygon of `blades` sides with a corner
 * at the top, uniform by area. A polygon is a fan of triangles; a point is chosen in one about its
 * own axis and turned. */
CDL_INLINE vec3 camera_lens_point(CDL_CONSTANT cdl_CameraParams *camera, float u, float v) {
  float disk_x, disk_y;
  sample_disk(u, v, &disk_x, &disk_y);
  float blades = (float)(int)camera->blades;
  float blade = floor(u * blades);
  float reach = sqrt(v);
  float along = reach * camera->blade_cos;
  float across = reach * camera->blade_sin * fma(2.0f, u * blades - blade, -1.0f);
  float sine, cosine;
  math_sincos_2pi((blade + 0.5f) / blades, &sine, &cosine);
  int round = camera->blades < 3u;
  float x = round ? disk_x : fma(along, sine, across * cosine);
  float y = round ? disk_y : fma(along, cosine, -(across * sine));
  return v3(camera->lens_radius * x, camera->lens_radius * y, 0.0f);
}

/* x and y in [0,1] from the top left of the image; u and v choose the point on the lens. */
CDL_INLINE CameraRay camera_ray(CDL_CONSTANT cdl_CameraParams *camera, Transform to_world, float x,
                                float y, float u, float v) {
  float sx = fma(2.0f, x, -1.0f) * camera->scale[0];
  float sy = fma(-2.0f, y, 1.0f) * camera->scale[1];
  vec3 lens = camera_lens_point(camera, u, v);
  vec3 focus = v3(sx, sy, -1.0f);
  int ortho = camera->orthographic != 0u;
  vec3 origin = v3_select(ortho, v3(sx, sy, 0.0f), lens);
  vec3 towards =
      v3_select(ortho, v3(0.0f, 0.0f, -1.0f), v3_madd(focus, -camera->inverse_focus, lens));
  CameraRay ray;
  ray.origin = transform_point(to_world, origin);
  ray.direction = v3_normalize(transform_direction(to_world, towards));
  return ray;
}

#endif
