/* check_material.c: what a schema cannot say of materials, cameras and lights. */
#include <string.h>

#include "scene/check.h"

cdl_Status check_materials(Document *doc) {
  const json_t *list = json_object_get(doc->root, "materials");
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *extension = json_get_extension(json_array_get(list, i), "KHR_materials_ior");
    double ior = json_get_number(extension, "ior", 1.5);
    if (ior > 0 && ior < 1)
      return document_fail(doc, AT("/materials/%zu/extensions/KHR_materials_ior/ior", i),
                           "VALUE_NOT_IN_RANGE", "%g is neither 0 nor at least 1.", ior);
  }
  return CDL_OK;
}

static cdl_Status check_camera(Document *doc, size_t i, const json_t *camera) {
  const char *type = json_get_string(camera, "type", "");
  const json_t *lens = json_object_get(camera, type);
  const char *at = AT("/cameras/%zu/%.40s", i, type);
  int orthographic = strcmp(type, "orthographic") == 0;
  if (!orthographic && strcmp(type, "perspective") != 0) return CDL_OK;
  if (!lens)
    return document_fail(doc, AT("/cameras/%zu", i), "UNDEFINED_PROPERTY",
                         "a camera of type %s needs an object of that name.", type);
  if (json_object_get(lens, "zfar") &&
      json_get_number(lens, "zfar", 0) <= json_get_number(lens, "znear", 0))
    return document_fail(doc, at, "CAMERA_ZFAR_LEQUAL_ZNEAR", "zfar must be beyond znear.");
  if (orthographic &&
      (json_get_number(lens, "xmag", 0) == 0 || json_get_number(lens, "ymag", 0) == 0))
    return document_fail(doc, at, "CAMERA_XMAG_YMAG_ZERO", "xmag and ymag must not be 0.");
  if (!orthographic && json_get_number(lens, "yfov", 0) >= 3.14159)
    return document_fail(doc, AT("%s/yfov", at), "VALUE_NOT_IN_RANGE",
                         "the field of view must be less than half a turn.");
  return CDL_OK;
}

static cdl_Status check_light(Document *doc, size_t i, const json_t *light) {
  const json_t *spot = json_object_get(light, "spot");
  const char *at = AT("/extensions/KHR_lights_punctual/lights/%zu", i);
  double inner = json_get_number(spot, "innerConeAngle", 0);
  double outer = json_get_number(spot, "outerConeAngle", 0.78539816339744831);
  if (strcmp(json_get_string(light, "type", ""), "spot") != 0) return CDL_OK;
  if (!spot)
    return document_fail(doc, at, "UNDEFINED_PROPERTY", "a spot light needs the member spot.");
  if (outer <= inner)
    return document_fail(doc, AT("%.200s/spot/outerConeAngle", at),
                         "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
                         "the outer angle %g must be greater than the inner %g.", outer, inner);
  return CDL_OK;
}

cdl_Status check_cameras_and_lights(Document *doc) {
  const json_t *cameras = json_object_get(doc->root, "cameras");
  const json_t *lights =
      json_object_get(json_get_extension(doc->root, "KHR_lights_punctual"), "lights");
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < json_array_size(cameras) && !status; i++)
    status = check_camera(doc, i, json_array_get(cameras, i));
  for (size_t i = 0; i < json_array_size(lights) && !status; i++)
    status = check_light(doc, i, json_array_get(lights, i));
  return status;
}
