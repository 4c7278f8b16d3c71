/* camera.c: the camera of a scene that has none. */
#include <math.h>
#include <string.h>

#include "core/angle.h"
#include "scene/matrix.h"
#include "scene/scene.h"

static void normalise(double v[3]) {
  double n = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int i = 0; i < 3; i++) v[i] /= n;
}

static void cross(const double a[3], const double b[3], double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* The distance at which every corner of a box lies within a square field of view: for each corner
 * max(|x|, |y|) / tan(half angle) + z, in the camera's frame about the box's centre. */
static double framing_distance(const float bounds[2][3], const double axes[3][3], double tangent) {
  double most = 0;
  for (int corner = 0; corner < 8; corner++) {
    double at[3] = {0, 0, 0};
    for (int c = 0; c < 3; c++) {
      double half = ((double)bounds[1][c] - bounds[0][c]) / 2 * (corner >> c & 1 ? 1 : -1);
      for (int a = 0; a < 3; a++) at[a] += axes[a][c] * half;
    }
    most = fmax(most, fmax(fabs(at[0]), fabs(at[1])) / tangent + at[2]);
  }
  return most;
}

void scene_frame_camera(const float bounds[2][3], cdl_SceneCamera *camera) {
  static const float unit_box[2][3] = {{-1, -1, -1}, {1, 1, 1}};
  const char *name = camera->name;
  if (!(bounds[0][0] <= bounds[1][0])) bounds = unit_box;
  double back[3] = {0.55, 0.45, 1}, up[3] = {0, 1, 0}, axes[3][3];
  normalise(back);
  memcpy(axes[2], back, sizeof back);
  cross(up, back, axes[0]);
  normalise(axes[0]);
  cross(back, axes[0], axes[1]);
  double yfov = 40 * M_PI / 180;
  double distance = framing_distance(bounds, axes, angle_tan(yfov / 2)) * 1.05;
  if (!(distance > 0)) distance = 1;
  *camera = (cdl_SceneCamera){.name = (char *)name,
                              .yfov = (float)yfov,
                              .focus_distance = (float)distance,
                              .shutter = {0, 0}};
  for (int r = 0; r < 3; r++) {
    double centre = ((double)bounds[0][r] + bounds[1][r]) / 2;
    for (int c = 0; c < 3; c++) camera->to_world[4 * r + c] = (float)axes[c][r];
    camera->to_world[4 * r + 3] = (float)(centre + back[r] * distance);
  }
}
