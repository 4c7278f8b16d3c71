/* check_data.c: the values in buffers. */
#include <math.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/check.h"

/* How far from 1 the length of a unit vector may be; quantised to 8 bits it is off by as much. */
#define UNIT_TOLERANCE 0.01
/* The same where data were compressed with loss; signs are off by as much, colours by less. */
#define LOSSY_TOLERANCE 0.1
#define LOSSY_COLOR 0.01

static const json_t *accessor_json(const Document *doc, uint32_t i) {
  return json_array_get(json_object_get(doc->root, "accessors"), i);
}

static double declared(const Accessor *a, const json_t *bound, uint32_t c) {
  double value = json_number_value(json_array_get(bound, c));
  return a->component == GL_FLOAT ? (float)value : value;
}

/* min and max must be those of the data: what frames a scene relies on them. */
static cdl_Status check_extent(Document *doc, uint32_t i, const double *least, const double *most) {
  const Accessor *a = &doc->accessors[i];
  const json_t *min = json_object_get(accessor_json(doc, i), "min");
  const json_t *max = json_object_get(accessor_json(doc, i), "max");
  for (uint32_t c = 0; c < a->width; c++) {
    if (min && declared(a, min, c) != least[c])
      return document_fail(doc, AT("/accessors/%u/min/%u", i, c), "ACCESSOR_MIN_MISMATCH",
                           "it is %g, but the least value is %g.", declared(a, min, c), least[c]);
    if (max && declared(a, max, c) != most[c])
      return document_fail(doc, AT("/accessors/%u/max/%u", i, c), "ACCESSOR_MAX_MISMATCH",
                           "it is %g, but the greatest value is %g.", declared(a, max, c), most[c]);
  }
  return CDL_OK;
}

static cdl_Status check_values(Document *doc, uint32_t i) {
  const Accessor *a = &doc->accessors[i];
  const json_t *json = accessor_json(doc, i);
  /* Of data compressed with loss, min and max are those before. */
  int bounded = !a->lossy && (json_object_get(json, "min") || json_object_get(json, "max"));
  double least[16], most[16];
  if (!accessor_has_data(doc, a)) return CDL_OK;
  if (!bounded && a->component != GL_FLOAT) return CDL_OK;
  for (uint32_t c = 0; c < a->width; c++) least[c] = INFINITY, most[c] = -INFINITY;
  for (size_t k = 0; k < a->count; k++) {
    const uint8_t *element = accessor_element(doc, a, k);
    for (uint32_t c = 0; c < a->width; c++) {
      double value = accessor_component(a, element, c);
      if (!isfinite(value))
        return document_fail(doc, AT("/accessors/%u", i), "ACCESSOR_INVALID_FLOAT",
                             "component %u of element %zu is not a finite number.", c, k);
      least[c] = fmin(least[c], value);
      most[c] = fmax(most[c], value);
    }
  }
  return bounded ? check_extent(doc, i, least, most) : CDL_OK;
}

static double full_scale(uint32_t component) {
  switch (component) {
  case GL_BYTE:
    return 127;
  case GL_UNSIGNED_BYTE:
    return 255;
  case GL_SHORT:
    return 32767;
  case GL_UNSIGNED_SHORT:
    return 65535;
  default:
    return 1;
  }
}

static cdl_Status check_directions(Document *doc, const char *at, const Accessor *a, int tangents) {
  double scale = full_scale(a->component);
  double tolerance = a->lossy ? LOSSY_TOLERANCE : UNIT_TOLERANCE;
  if (!accessor_has_data(doc, a)) return CDL_OK;
  for (size_t k = 0; k < a->count; k++) {
    const uint8_t *element = accessor_element(doc, a, k);
    double length = 0, sign = tangents ? accessor_component(a, element, 3) / scale : 1;
    for (uint32_t c = 0; c < 3; c++) {
      double x = accessor_component(a, element, c) / scale;
      length += x * x;
    }
    if (!(fabs(sqrt(length) - 1) <= tolerance))
      return document_fail(doc, at, "ACCESSOR_VECTOR3_NON_UNIT", "vector %zu has length %g, not 1.",
                           k, sqrt(length));
    if (fabs(fabs(sign) - 1) > (a->lossy ? LOSSY_TOLERANCE : 0))
      return document_fail(doc, at, "ACCESSOR_INVALID_SIGN",
                           "the handedness of tangent %zu is %g, neither 1 nor -1.", k, sign);
  }
  return CDL_OK;
}

static cdl_Status check_colors(Document *doc, const char *at, const Accessor *a) {
  double slack = a->lossy ? LOSSY_COLOR : 0;
  if (a->component != GL_FLOAT || !accessor_has_data(doc, a)) return CDL_OK;
  for (size_t k = 0; k < a->count; k++)
    for (uint32_t c = 0; c < a->width; c++) {
      double value = accessor_component(a, accessor_element(doc, a, k), c);
      if (value < -slack || value > 1 + slack)
        return document_fail(doc, at, "ACCESSOR_NON_CLAMPED", "colour %zu has a component of %g.",
                             k, value);
    }
  return CDL_OK;
}

static cdl_Status check_indices(Document *doc, const char *at, const Accessor *a, size_t vertices) {
  uint32_t restart = a->component == GL_UNSIGNED_BYTE    ? 0xff
                     : a->component == GL_UNSIGNED_SHORT ? 0xffff
                                                         : 0xffffffffu;
  if (!accessor_has_data(doc, a)) return CDL_OK;
  for (size_t k = 0; k < a->count; k++) {
    uint32_t index = (uint32_t)accessor_component(a, accessor_element(doc, a, k), 0);
    if (index == restart)
      return document_fail(doc, at, "ACCESSOR_INDEX_PRIMITIVE_RESTART",
                           "index %zu is %u, which means a restart; that is not allowed.", k,
                           index);
    if (index >= vertices)
      return document_fail(doc, at, "ACCESSOR_INDEX_OOB",
                           "index %zu is %u, but there are %zu vertices.", k, index, vertices);
  }
  return CDL_OK;
}

static cdl_Status check_primitive(Document *doc, size_t m, size_t p, const json_t *primitive) {
  const json_t *attributes = json_object_get(primitive, "attributes");
  const char *name;
  json_t *value;
  size_t vertices = 0;
  json_object_foreach((json_t *)attributes, name, value) {
    const Accessor *a = &doc->accessors[(uint32_t)json_number_value(value)];
    const char *at = AT("/meshes/%zu/primitives/%zu/attributes/%.40s", m, p, name);
    cdl_Status status = CDL_OK;
    if (strcmp(name, "NORMAL") == 0)
      status = check_directions(doc, at, a, 0);
    else if (strcmp(name, "TANGENT") == 0)
      status = check_directions(doc, at, a, 1);
    else if (strncmp(name, "COLOR_", 6) == 0)
      status = check_colors(doc, at, a);
    if (status) return status;
    vertices = a->count;
  }
  uint32_t indices = json_get_index(primitive, "indices");
  if (indices == DOCUMENT_NONE) return CDL_OK;
  return check_indices(doc, AT("/meshes/%zu/primitives/%zu/indices", m, p),
                       &doc->accessors[indices], vertices);
}

cdl_Status check_mesh_data(Document *doc) {
  const json_t *meshes = json_object_get(doc->root, "meshes");
  cdl_Status status = CDL_OK;
  for (uint32_t i = 0; i < doc->accessor_count && !status; i++) status = check_values(doc, i);
  for (size_t m = 0; m < json_array_size(meshes) && !status; m++) {
    const json_t *list = json_object_get(json_array_get(meshes, m), "primitives");
    for (size_t p = 0; p < json_array_size(list) && !status; p++)
      status = check_primitive(doc, m, p, json_array_get(list, p));
  }
  return status;
}
