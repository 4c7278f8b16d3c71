#include "scene/pose.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/check.h"
#include "scene/choice.h"
#include "scene/schema.h"
#include "scene/track.h"

/* Morph targets of a mesh; each of its primitives has as many. */
static size_t mesh_targets(const Document *doc, size_t mesh) {
  const json_t *json = json_array_get(json_object_get(doc->root, "meshes"), mesh);
  const json_t *primitive = json_array_get(json_object_get(json, "primitives"), 0);
  return json_array_size(json_object_get(primitive, "targets"));
}

/* Where a channel leads, as a JSON pointer; NULL: nowhere. */
static const char *channel_pointer(const json_t *channel, char text[256]) {
  const json_t *target = json_object_get(channel, "target");
  const char *path = json_get_string(target, "path", "");
  uint32_t node = json_get_index(target, "node");
  if (strcmp(path, "pointer") == 0)
    return json_get_string(json_get_extension(target, "KHR_animation_pointer"), "pointer", NULL);
  static const char *const paths[] = {"translation", "rotation", "scale", "weights"};
  for (int i = 0; i < 4 && node != DOCUMENT_NONE; i++)
    if (strcmp(path, paths[i]) == 0) return pointer_format(text, "/nodes/%u/%s", node, path);
  return NULL;
}

/* What an array is before an animation changes one of its elements. */
static json_t *default_array(const Document *doc, const SchemaPlace *place, size_t count) {
  static const char *const zeros[] = {
      "translation",    "offset",           "weights",
      "emissiveFactor", "sheenColorFactor", "multiscatterColor",
      "absorption",     "scattering",       "multiscatterColorFactor",
      "emission",       "shutter"};
  const char *name = place->member->name;
  double fill = 1;
  for (size_t i = 0; i < sizeof zeros / sizeof *zeros; i++)
    if (strcmp(name, zeros[i]) == 0) fill = 0;
  uint32_t mesh = json_get_index(place->object, "mesh");
  const json_t *given = json_array_get(json_object_get(doc->root, "meshes"), mesh);
  if (strcmp(name, "weights") == 0 && mesh != DOCUMENT_NONE && json_object_get(given, "weights"))
    return json_deep_copy(json_object_get(given, "weights"));
  json_t *array = json_array();
  for (size_t i = 0; i < count; i++) {
    double value = strcmp(name, "rotation") == 0 ? i == 3 : fill;
    json_array_append_new(array, json_real(value));
  }
  return array;
}

/* Numbers in the whole array at a place: as it stands, or as the tables say; 0: it is no array. */
static size_t array_length(const Document *doc, const SchemaPlace *place) {
  const Member *member = place->member;
  const json_t *value = json_object_get(place->object, member->name);
  if (json_is_array(value)) return json_array_size(value);
  if (!(member->flags & (ARRAY | EITHER)) || json_is_number(value)) return 0;
  if (member->longest) return member->longest;
  uint32_t mesh = json_get_index(place->object, "mesh");
  const json_t *meshes = json_object_get(doc->root, "meshes");
  if (mesh != DOCUMENT_NONE) return mesh_targets(doc, mesh);
  for (size_t i = 0; i < json_array_size(meshes); i++)
    if (json_array_get(meshes, i) == place->object) return mesh_targets(doc, i);
  return 0;
}

/* Splines overshoot, and what leaves the range of a member would be no glTF any more. */
static json_t *value_of(const Member *member, double x) {
  if (member->type == MEMBER_BOOL) return json_boolean(x != 0);
  double least = fmax(member->min, -FLT_MAX), most = fmin(member->max, FLT_MAX);
  if (member->flags & ABOVE) least = nextafterf((float)least, FLT_MAX);
  return json_real(fmin(fmax(x, least), most));
}

static cdl_Status write_value(const Document *doc, const SchemaPlace *place, size_t length,
                              size_t count, const double *values) {
  const char *name = place->member->name;
  json_t *array = json_object_get(place->object, name);
  if (!length) {
    json_object_set_new(place->object, name, value_of(place->member, values[0]));
    return CDL_OK;
  }
  if (!json_is_array(array)) {
    array = default_array(doc, place, length);
    json_object_set_new(place->object, name, array);
  }
  size_t first = place->element == DOCUMENT_NONE ? 0 : place->element;
  for (size_t i = 0; i < count; i++)
    json_array_set_new(array, first + i, value_of(place->member, values[i]));
  return json_array_size(array) == length ? CDL_OK : document_out_of_memory(doc);
}

static int is_transform(const char *name) {
  return strcmp(name, "translation") == 0 || strcmp(name, "rotation") == 0 ||
         strcmp(name, "scale") == 0;
}

/* A node that moves has translation, rotation and scale; a matrix beside them does not count. */
static void drop_matrix(const char *pointer, const SchemaPlace *place) {
  if (strncmp(pointer, "/nodes/", 7) == 0 && is_transform(place->member->name))
    json_object_del(place->object, "matrix");
}

static cdl_Status apply_channel(Document *doc, double time, const char *at, const char *pointer,
                                const json_t *sampler) {
  SchemaPlace place;
  if (!schema_resolve(doc, pointer, &place)) {
    document_note(doc, NULL, at, "%.200s is nothing that can be animated here; it stays.", pointer);
    return CDL_OK;
  }
  size_t length = array_length(doc, &place);
  int whole = place.element == DOCUMENT_NONE;
  if ((!whole && place.element >= length) || (length == 0 && (place.member->flags & ARRAY)))
    return document_fail(doc, at, "UNRESOLVED_REFERENCE", "there is no %.200s.", pointer);
  size_t count = whole && length ? length : 1;
  int rotation = strcmp(place.member->name, "rotation") == 0 && count == 4;
  double *values = calloc(count, sizeof *values);
  Track track = {0};
  cdl_Status status =
      values ? track_load(doc, at, sampler, count, &track) : document_out_of_memory(doc);
  if (!status) {
    track.step |= place.member->type == MEMBER_BOOL;
    track_sample(&track, time, rotation, values);
    status = write_value(doc, &place, length, count, values);
    drop_matrix(pointer, &place);
  }
  track_free(&track);
  free(values);
  return status;
}

static cdl_Status apply_animation(Document *doc, double time, size_t index) {
  const json_t *animation = json_array_get(json_object_get(doc->root, "animations"), index);
  const json_t *channels = json_object_get(animation, "channels");
  cdl_Status status = CDL_OK;
  for (size_t c = 0; c < json_array_size(channels) && !status; c++) {
    const json_t *channel = json_array_get(channels, c);
    const json_t *sampler =
        json_array_get(json_object_get(animation, "samplers"), json_get_index(channel, "sampler"));
    const char *pointer = channel_pointer(channel, (char[256]){0});
    if (pointer)
      status =
          apply_channel(doc, time, AT("/animations/%zu/channels/%zu", index, c), pointer, sampler);
  }
  return status;
}

/* Elements of one array are one thing: an animation that moves one contradicts one that moves
 * another. */
static void strip_element(char *pointer) {
  char *last = strrchr(pointer, '/');
  if (last && last[1] && !last[1 + strspn(last + 1, "0123456789")]) *last = 0;
}

/* Whether an animation moves what is in `taken`; adds what it moves otherwise. */
static int contradicts(const json_t *animation, json_t *taken) {
  const json_t *channels = json_object_get(animation, "channels");
  for (int add = 0; add < 2; add++)
    for (size_t c = 0; c < json_array_size(channels); c++) {
      char text[256], key[512];
      const char *pointer = channel_pointer(json_array_get(channels, c), text);
      if (!pointer) continue;
      snprintf(key, sizeof key, "%s", pointer);
      strip_element(key);
      if (!add && json_object_get(taken, key)) return 1;
      if (add) json_object_set_new(taken, key, json_true());
    }
  return 0;
}

static cdl_Status apply_all(Document *doc, double time) {
  const json_t *list = json_object_get(doc->root, "animations");
  json_t *taken = json_object();
  cdl_Status status = taken ? CDL_OK : document_out_of_memory(doc);
  size_t left_out = 0;
  for (size_t i = 0; i < json_array_size(list) && !status; i++) {
    if (contradicts(json_array_get(list, i), taken))
      left_out++;
    else
      status = apply_animation(doc, time, i);
  }
  if (left_out && !status)
    document_note(doc, "animations", "/animations",
                  "%zu of %zu animations move what one before them moves, and are left out; choose "
                  "one by --animation.",
                  left_out, json_array_size(list));
  json_decref(taken);
  return status;
}

static cdl_Status apply_named(Document *doc, double time, const char *name) {
  const json_t *list = json_object_get(doc->root, "animations");
  Choice animations = choice_of_objects("animation", doc->path, list);
  uint32_t index;
  cdl_Status status = choice_require(doc->log, &animations, name, &index);
  return status ? status : apply_animation(doc, time, index);
}

/* What pointers reach is checked once more: members may contradict each other only together. */
cdl_Status pose_document(Document *doc, double time, const char *animation) {
  cdl_Status status = animation ? apply_named(doc, time, animation) : apply_all(doc, time);
  if (!status) status = check_materials(doc);
  return status ? status : check_cameras_and_lights(doc);
}
