/* check_animation.c: animation samplers and channels (section 3.11). */
#include <math.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/check.h"

#define UNIT_TOLERANCE 0.01

static cdl_Status check_times(Document *doc, const char *at, const Accessor *a) {
  double before = -1;
  for (size_t i = 0; i < a->count; i++) {
    double time = accessor_component(a, accessor_element(doc, a, i), 0);
    if (time < 0)
      return document_fail(doc, at, "ACCESSOR_ANIMATION_INPUT_NEGATIVE", "time %zu is %g.", i,
                           time);
    if (!(time > before))
      return document_fail(doc, at, "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
                           "time %zu, %g, does not follow the one before.", i, time);
    before = time;
  }
  return CDL_OK;
}

static cdl_Status check_sampler(Document *doc, size_t i, size_t s, const json_t *sampler) {
  static const char *const names[] = {"input", "output"};
  uint32_t input = json_get_index(sampler, "input");
  const Accessor *a = &doc->accessors[input];
  const json_t *json = json_array_get(json_object_get(doc->root, "accessors"), input);
  const char *at = AT("/animations/%zu/samplers/%zu/input", i, s);
  for (int k = 0; k < 2; k++) {
    uint32_t view = doc->accessors[json_get_index(sampler, names[k])].view;
    if (view != DOCUMENT_NONE && doc->views[view].stride)
      return document_fail(doc, AT("/animations/%zu/samplers/%zu/%s", i, s, names[k]),
                           "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE",
                           "the bufferView of an animation cannot have a stride.");
  }
  if (a->width != 1 || a->component != GL_FLOAT)
    return document_fail(doc, at, "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT",
                         "times must be scalar floats.");
  if (!json_object_get(json, "min") || !json_object_get(json, "max"))
    return document_fail(doc, at, "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS",
                         "the accessor of times must have min and max.");
  if (strcmp(json_get_string(sampler, "interpolation", ""), "CUBICSPLINE") == 0 && a->count < 2)
    return document_fail(doc, at, "ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS",
                         "a cubic spline needs two keys or more.");
  /* An accessor of zeros without data, as examples have it, is no clock to go by. */
  return accessor_has_data(doc, a) ? check_times(doc, at, a) : CDL_OK;
}

/* The length of vectors of an accessor of rotations, of floats or normalised integers. */
static cdl_Status check_rotations(Document *doc, const char *at, const Accessor *a, int cubic) {
  double scale = a->component == GL_BYTE             ? 127
                 : a->component == GL_UNSIGNED_BYTE  ? 255
                 : a->component == GL_SHORT          ? 32767
                 : a->component == GL_UNSIGNED_SHORT ? 65535
                                                     : 1;
  if (!accessor_has_data(doc, a)) return CDL_OK;
  for (size_t i = cubic ? 1 : 0; i < a->count; i += cubic ? 3 : 1) {
    double length = 0;
    for (uint32_t c = 0; c < 4; c++) {
      double x = accessor_component(a, accessor_element(doc, a, i), c) / scale;
      length += x * x;
    }
    if (!(fabs(sqrt(length) - 1) <= UNIT_TOLERANCE))
      return document_fail(doc, at, "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION",
                           "rotation %zu has length %g, not 1.", i, sqrt(length));
  }
  return CDL_OK;
}

/* How many elements a key's output has; weights have one for each morph target. */
static size_t targets_of(const Document *doc, uint32_t node) {
  const json_t *json = json_array_get(json_object_get(doc->root, "nodes"), node);
  const json_t *mesh =
      json_array_get(json_object_get(doc->root, "meshes"), json_get_index(json, "mesh"));
  const json_t *primitive = json_array_get(json_object_get(mesh, "primitives"), 0);
  return json_array_size(json_object_get(primitive, "targets"));
}

static int output_fits(const Accessor *a, const char *path) {
  int rotation = strcmp(path, "rotation") == 0, weights = strcmp(path, "weights") == 0;
  uint32_t width = rotation ? 4 : weights ? 1 : 3;
  if (a->width != width || a->columns != 1) return 0;
  if (a->component == GL_FLOAT) return 1;
  return (rotation || weights) && a->normalized && a->component < GL_UNSIGNED_INT;
}

static cdl_Status check_output(Document *doc, const char *at, const json_t *target,
                               const json_t *sampler) {
  const char *path = json_get_string(target, "path", "");
  int cubic = strcmp(json_get_string(sampler, "interpolation", ""), "CUBICSPLINE") == 0;
  const Accessor *output = &doc->accessors[json_get_index(sampler, "output")];
  size_t keys = doc->accessors[json_get_index(sampler, "input")].count, each = cubic ? 3 : 1;
  uint32_t node = json_get_index(target, "node");
  int weights = strcmp(path, "weights") == 0, pointer = strcmp(path, "pointer") == 0;
  int known = weights || strcmp(path, "rotation") == 0 || strcmp(path, "translation") == 0 ||
              strcmp(path, "scale") == 0;
  if (known && !output_fits(output, path))
    return document_fail(doc, at, "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
                         "an accessor of this type cannot animate %s.", path);
  if (weights && node != DOCUMENT_NONE) each *= targets_of(doc, node);
  if (!pointer && !(weights && node == DOCUMENT_NONE) && output->count != keys * each)
    return document_fail(doc, at, "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
                         "there are %zu values, not %zu.", output->count, keys * each);
  return strcmp(path, "rotation") == 0 ? check_rotations(doc, at, output, cubic) : CDL_OK;
}

static cdl_Status check_pointer(Document *doc, size_t i, size_t c, const json_t *target) {
  const char *at = AT("/animations/%zu/channels/%zu/target/extensions/KHR_animation_pointer", i, c);
  if (!json_get_extension(target, "KHR_animation_pointer")) return CDL_OK;
  if (json_object_get(target, "node"))
    return document_fail(doc, at, "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE",
                         "a target with a pointer cannot have a node.");
  if (strcmp(json_get_string(target, "path", ""), "pointer") != 0)
    return document_fail(doc, at, "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH",
                         "the path of a target with a pointer must be pointer.");
  return CDL_OK;
}

static cdl_Status check_channel(Document *doc, size_t i, size_t c, const json_t *animation) {
  const json_t *channel = json_array_get(json_object_get(animation, "channels"), c);
  const json_t *samplers = json_object_get(animation, "samplers");
  const json_t *target = json_object_get(channel, "target");
  uint32_t sampler = json_get_index(channel, "sampler");
  const char *at = AT("/animations/%zu/channels/%zu/sampler", i, c);
  if (sampler >= json_array_size(samplers))
    return document_fail(doc, at, "UNRESOLVED_REFERENCE", "there is no sampler %u.", sampler);
  cdl_Status status = check_pointer(doc, i, c, target);
  return status ? status : check_output(doc, at, target, json_array_get(samplers, sampler));
}

cdl_Status check_animations(Document *doc) {
  const json_t *list = json_object_get(doc->root, "animations");
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < json_array_size(list) && !status; i++) {
    const json_t *animation = json_array_get(list, i);
    const json_t *samplers = json_object_get(animation, "samplers");
    size_t channels = json_array_size(json_object_get(animation, "channels"));
    for (size_t s = 0; s < json_array_size(samplers) && !status; s++)
      status = check_sampler(doc, i, s, json_array_get(samplers, s));
    for (size_t c = 0; c < channels && !status; c++) status = check_channel(doc, i, c, animation);
  }
  return status;
}
