#include "scene/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/pack_parts.h"

void *pack_array(const cdl_Log *log, const char *what, size_t count, size_t size) {
  void *array = calloc(count ? count : 1, size);
  if (!array)
    log_fail(log, CDL_BAD_INPUT, "not enough memory for %zu %s; use a machine with more", count,
             what);
  return array;
}

void pack_point(const float m[12], const float *point, float out[3]) {
  const double x = point[0], y = point[1], z = point[2];
  for (int r = 0; r < 3; r++)
    out[r] = (float)(m[4 * r] * x + m[4 * r + 1] * y + m[4 * r + 2] * z + m[4 * r + 3]);
}

int pack_mirrors(const float m[12]) {
  double a = m[0], b = m[1], c = m[2], d = m[4], e = m[5], f = m[6], g = m[8], h = m[9], i = m[10];
  return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0.0;
}

double pack_scene_radius(const cdl_Pack *pack) {
  const float *b = pack->bvh.bounds;
  if (!(b[0] <= b[3])) return 1.0;
  double x = (double)b[3] - b[0], y = (double)b[4] - b[1], z = (double)b[5] - b[2];
  return 0.5 * sqrt(x * x + y * y + z * z);
}

cdl_Status pack_scene(const cdl_Log *log, const cdl_Scene *scene, int bvh_width, cdl_Pack *pack) {
  double environment_power = 0.0;
  memset(pack, 0, sizeof *pack);
  cdl_Status status = pack_textures(log, scene, pack);
  if (!status) status = pack_materials(log, scene, pack);
  if (!status) status = pack_energy(log, pack);
  if (!status) status = pack_media(log, scene, pack);
  if (!status) status = pack_grids(log, scene, pack);
  if (!status) status = pack_geometry(log, scene, bvh_width, pack);
  if (!status) status = pack_environment(log, scene, pack, &environment_power);
  if (!status) status = pack_lights(log, scene, environment_power, pack);
  return status;
}

void pack_free(cdl_Pack *pack) {
  free(pack->triangles);
  free(pack->shapes);
  free(pack->mesh_shapes);
  free(pack->attributes);
  free(pack->materials);
  free(pack->param_textures);
  free(pack->textures);
  free(pack->texels);
  free(pack->lights);
  free(pack->light_table);
  free(pack->environment);
  free(pack->environment_cells);
  free(pack->media);
  free(pack->instance_media);
  free(pack->grids);
  free(pack->grid_table);
  free(pack->grid_most);
  free(pack->grid_values);
  free(pack->blackbody);
  free(pack->energy_table);
  bvh_free(&pack->bvh);
  memset(pack, 0, sizeof *pack);
}
