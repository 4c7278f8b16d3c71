/* light.c: KHR_lights_punctual. */
#include <math.h>
#include <string.h>

#include "scene/build.h"

static int light_type(const char *name, cdl_PunctualType *type) {
  if (strcmp(name, "point") == 0)
    *type = CDL_PUNCTUAL_POINT;
  else if (strcmp(name, "spot") == 0)
    *type = CDL_PUNCTUAL_SPOT;
  else if (strcmp(name, "directional") == 0)
    *type = CDL_PUNCTUAL_DIRECTIONAL;
  else
    return 0;
  return 1;
}

/* Lights look along -Z of their node; a node's scale does not change them. */
static void place(const Matrix *to_world, cdl_SceneLight *light) {
  double direction[3], length;
  matrix_apply(to_world, (double[3]){0, 0, -1}, 0, direction);
  length =
      sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
  for (int c = 0; c < 3; c++) {
    light->position[c] = (float)to_world->m[4 * c + 3];
    light->direction[c] = length > 0 ? (float)(direction[c] / length) : c == 2 ? -1.0f : 0.0f;
  }
}

cdl_Status build_light(Builder *builder, uint32_t index, const Matrix *to_world) {
  struct cdl_Scene *scene = builder->scene;
  const json_t *list =
      json_object_get(json_get_extension(builder->doc->root, "KHR_lights_punctual"), "lights");
  const json_t *json = json_array_get(list, index), *spot = json_object_get(json, "spot");
  cdl_SceneLight light = {.intensity = {1, 1, 1}};
  if (!light_type(json_get_string(json, "type", ""), &light.type)) return CDL_OK;
  float intensity = (float)json_get_number(json, "intensity", 1);
  json_get_numbers(json, "color", 3, light.intensity);
  for (int c = 0; c < 3; c++) light.intensity[c] *= intensity;
  if (light.type != CDL_PUNCTUAL_DIRECTIONAL)
    light.range = (float)json_get_number(json, "range", 0);
  light.inner_cone = (float)json_get_number(spot, "innerConeAngle", 0);
  light.outer_cone = (float)json_get_number(spot, "outerConeAngle", M_PI_4);
  place(to_world, &light);
  cdl_SceneLight *slot = array_push((void **)&scene->lights, scene->light_count, sizeof *slot);
  light.name = slot ? string_copy(json_get_string(json, "name", "")) : NULL;
  if (!light.name) return document_out_of_memory(builder->doc);
  *slot = light;
  scene->light_count++;
  return CDL_OK;
}
