#include "render/camera.h"

#include <math.h>
#include <string.h>

#include "core/angle.h"
#include "scene/choice.h"

cdl_Status camera_find(const cdl_Log *log, const cdl_Scene *scene, const char *name,
                       const cdl_SceneCamera **camera) {
  Choice cameras = choice_of_cameras(scene);
  uint32_t index = 0;
  cdl_Status status = name ? choice_require(log, &cameras, name, &index) : CDL_OK;
  if (!status) *camera = &scene->cameras[index];
  return status;
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
