#include "render/camera.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/angle.h"
#include "core/log.h"

static cdl_Status fail_unknown(const cdl_Log *log, const cdl_Scene *scene, const char *name) {
  char names[1024] = "";
  for (uint32_t i = 0; i < scene->camera_count; i++) {
    size_t used = strlen(names);
    snprintf(names + used, sizeof names - used, "%s%u \"%s\"", i ? ", " : "", i,
             scene->cameras[i].name ? scene->cameras[i].name : "");
  }
  return log_fail(log, CDL_USAGE, "--camera %s: %s has no such camera; it has %s", name,
                  scene->path, names);
}

cdl_Status camera_find(const cdl_Log *log, const cdl_Scene *scene, const char *name,
                       const cdl_SceneCamera **camera) {
  *camera = &scene->cameras[0];
  if (!name) return CDL_OK;
  for (uint32_t i = 0; i < scene->camera_count; i++)
    if (scene->cameras[i].name && !strcmp(scene->cameras[i].name, name)) {
      *camera = &scene->cameras[i];
      return CDL_OK;
    }
  char *end;
  unsigned long index = strtoul(name, &end, 10);
  if (name[0] < '0' || name[0] > '9' || *end || index >= scene->camera_count)
    return fail_unknown(log, scene, name);
  *camera = &scene->cameras[index];
  return CDL_OK;
}

static double camera_aspect(const cdl_SceneCamera *camera) {
  if (camera->orthographic && camera->ymag > 0.0f) return fabs(camera->xmag / camera->ymag);
  return camera->aspect > 0.0f ? camera->aspect : 16.0 / 9.0;
}

void camera_image_size(const cdl_SceneCamera *camera, uint32_t *width, uint32_t *height) {
  double aspect = camera_aspect(camera);
  if (!*width) *width = (uint32_t)fmax(1.0, fmin(65536.0, round(*height * aspect)));
  if (!*height) *height = (uint32_t)fmax(1.0, fmin(65536.0, round(*width / aspect)));
}

void camera_params(const cdl_SceneCamera *camera, uint32_t width, uint32_t height,
                   cdl_CameraParams *params) {
  double aspect = (double)width / height;
  double half = camera->orthographic ? camera->ymag : angle_tan(0.5 * camera->yfov);
  *params = (cdl_CameraParams){
      .scale = {(float)(half * aspect), (float)half},
      .lens_radius = camera->aperture_radius,
      .inverse_focus = camera->focus_distance > 0.0f ? 1.0f / camera->focus_distance : 1.0f,
      .orthographic = camera->orthographic != 0,
      .blades = camera->blades ? camera->blades : 1};
  math_sincos_2pi(0.5f / (float)params->blades, &params->blade_sin, &params->blade_cos);
  memcpy(params->to_world, camera->to_world, sizeof params->to_world);
}
