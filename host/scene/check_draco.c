/* check_draco.c: primitives compressed by KHR_draco_mesh_compression. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/compression.h"

#define EXTENSION "KHR_draco_mesh_compression"
#define POINTER "/meshes/%zu/primitives/%zu"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MOST_ATTRIBUTES = 32 };

/* A primitive on its way: which accessor each decoded attribute goes to. */
typedef struct Primitive {
  Document *doc;
  json_t *json;
  const json_t *extension;
  size_t mesh, number;
  uint32_t view, indices, mode;
  DracoMesh out;
  DracoAttribute attributes[MOST_ATTRIBUTES];
  uint32_t accessors[MOST_ATTRIBUTES];
  const char *names[MOST_ATTRIBUTES];
} Primitive;

#define HERE(p, member) AT(POINTER "/" member, (p)->mesh, (p)->number)
#define INSIDE(p, member) AT(POINTER "/extensions/" EXTENSION member, (p)->mesh, (p)->number)

static cdl_Status add_attribute(Primitive *p, const char *name, uint32_t id) {
  const json_t *attributes = json_object_get(p->json, "attributes");
  uint32_t index = json_get_index(attributes, name), n = p->out.attribute_count;
  if (index == DOCUMENT_NONE)
    return document_fail(p->doc, INSIDE(p, "/attributes"), "UNRESOLVED_REFERENCE",
                         "the primitive itself has no attribute %.60s.", name);
  if (n == MOST_ATTRIBUTES)
    return document_fail(p->doc, INSIDE(p, "/attributes"), "ARRAY_LENGTH_NOT_IN_LIST",
                         "more than %d attributes are too many.", MOST_ATTRIBUTES);
  const Accessor *a = &p->doc->accessors[index];
  if (a->columns != 1)
    return document_fail(p->doc, HERE(p, "attributes"),
                         "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
                         "%.60s cannot be a matrix.", name);
  if (n && a->count != p->out.points)
    return document_fail(p->doc, HERE(p, "attributes"), "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                         "%.60s has %zu elements, the one before %zu.", name, a->count,
                         p->out.points);
  p->attributes[n] = (DracoAttribute){.id = id, .component = a->component, .width = a->width};
  p->accessors[n] = index;
  p->names[n] = name;
  p->out.points = a->count;
  p->out.attribute_count++;
  return CDL_OK;
}

/* The decoder writes what check_meshes() would only refuse later. */
static cdl_Status check_index_format(const Primitive *p) {
  const Accessor *a = &p->doc->accessors[p->indices];
  if (a->width == 1 && (a->component == GL_UNSIGNED_BYTE || a->component == GL_UNSIGNED_SHORT ||
                        a->component == GL_UNSIGNED_INT))
    return CDL_OK;
  return document_fail(p->doc, HERE(p, "indices"), "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
                       "indices must be unsigned scalars.");
}

static cdl_Status read_extension(Primitive *p) {
  const json_t *ids = json_object_get(p->extension, "attributes");
  const char *name;
  json_t *id;
  p->view = json_get_index(p->extension, "bufferView");
  p->indices = json_get_index(p->json, "indices");
  p->mode = (uint32_t)json_get_number(p->json, "mode", MODE_TRIANGLES);
  if (p->mode != MODE_TRIANGLES && p->mode != MODE_STRIP)
    return document_fail(p->doc, HERE(p, "mode"), "VALUE_NOT_IN_LIST",
                         "only triangles and triangle strips can be compressed.");
  if (p->indices == DOCUMENT_NONE)
    return document_fail(p->doc, AT(POINTER, p->mesh, p->number), "UNDEFINED_PROPERTY",
                         "a compressed primitive must have indices.");
  const BufferView *view = &p->doc->views[p->view];
  const Accessor *indices = &p->doc->accessors[p->indices];
  if (!view->data)
    return document_fail(p->doc, INSIDE(p, "/bufferView"), "NON_RELATIVE_URI",
                         "its buffer has no data here, and nothing is fetched from the network.");
  p->out.stream = view->data;
  p->out.size = view->length;
  p->out.index_component = indices->component;
  p->out.most_faces =
      p->mode == MODE_STRIP ? indices->count - (indices->count > 1 ? 2 : 1) : indices->count / 3;
  p->out.attributes = p->attributes;
  cdl_Status status = check_index_format(p);
  json_object_foreach((json_t *)ids, name, id) {
    if (status) break;
    status = add_attribute(p, name, (uint32_t)json_number_value(id));
  }
  return status;
}

/* Primitives may share accessors, but only with the same stream behind them. */
static int taken_from(const Primitive *p, uint32_t index, uint32_t view) {
  return p->doc->accessors[index].source == view;
}

static cdl_Status check_sources(const Primitive *p, int *done) {
  *done = taken_from(p, p->indices, p->view);
  int free_or_same = *done || taken_from(p, p->indices, DOCUMENT_NONE);
  for (uint32_t i = 0; i < p->out.attribute_count; i++) {
    int same = taken_from(p, p->accessors[i], p->view);
    *done &= same;
    free_or_same &= same || taken_from(p, p->accessors[i], DOCUMENT_NONE);
  }
  if (free_or_same) return CDL_OK;
  return document_fail(p->doc, INSIDE(p, "/bufferView"), "DRACO_DATA_INVALID",
                       "an accessor of it belongs to another compressed primitive as well.");
}

/* Quantised, a handedness is near 1 and a colour near its range only. */
static void restore_exact(const char *name, const Accessor *a) {
  float values[4];
  int tangents = strcmp(name, "TANGENT") == 0, colors = strncmp(name, "COLOR_", 6) == 0;
  if (a->component != GL_FLOAT || (!tangents && !colors) || a->width > 4) return;
  for (size_t i = 0; i < a->count; i++) {
    memcpy(values, a->owned + i * a->stride, 4 * a->width);
    for (uint32_t c = 0; colors && c < a->width; c++) values[c] = fminf(fmaxf(values[c], 0), 1);
    if (tangents && a->width == 4) values[3] = values[3] < 0 ? -1 : 1;
    memcpy(a->owned + i * a->stride, values, 4 * a->width);
  }
}

/* The accessor owns the data from now on, unless it has the same already. */
static void fill_accessor(const Primitive *p, uint32_t index, uint8_t **data, size_t count) {
  Accessor *a = &p->doc->accessors[index];
  if (a->source != DOCUMENT_NONE) return;
  a->owned = *data;
  a->data = *data;
  a->stride = accessor_packed_size(a);
  a->count = count;
  a->view = DOCUMENT_NONE;
  a->source = p->view;
  a->lossy = 1;
  a->sparse_count = 0; /* belongs to what the data take the place of */
  *data = NULL;
}

static cdl_Status fill_all(Primitive *p) {
  size_t indices = 3 * p->out.faces;
  if (p->mode == MODE_TRIANGLES && indices != p->doc->accessors[p->indices].count)
    return document_fail(p->doc, HERE(p, "indices"), "DRACO_DATA_INVALID",
                         "%zu indices are declared, but the compressed data have %zu.",
                         p->doc->accessors[p->indices].count, indices);
  if (indices == 0)
    return document_fail(p->doc, INSIDE(p, "/bufferView"), "DRACO_DATA_INVALID",
                         "it has no triangles.");
  fill_accessor(p, p->indices, &p->out.indices, indices);
  for (uint32_t i = 0; i < p->out.attribute_count; i++) {
    int is_new = taken_from(p, p->accessors[i], DOCUMENT_NONE);
    fill_accessor(p, p->accessors[i], &p->attributes[i].data, p->out.points);
    if (is_new) restore_exact(p->names[i], &p->doc->accessors[p->accessors[i]]);
  }
  return CDL_OK;
}

static cdl_Status decode_primitive(Primitive *p) {
  int done = 0;
  cdl_Status status = read_extension(p);
  if (!status) status = check_sources(p, &done);
  if (!status) status = document_charge(p->doc, INSIDE(p, ""), p->out.size);
  if (status) return status;
  p->out.budget = p->doc->decode_left;
  if (!done && !draco_decode(&p->out))
    status = document_fail(p->doc, INSIDE(p, "/bufferView"), "DRACO_DATA_INVALID",
                           "the compressed mesh cannot be read: %s.", p->out.error);
  else if (!done)
    status = document_charge(p->doc, INSIDE(p, ""), p->out.budget);
  if (!status && !done) status = fill_all(p);
  if (!status && p->mode == MODE_STRIP)
    json_object_set_new(p->json, "mode", json_real(MODE_TRIANGLES));
  free(p->out.indices);
  for (uint32_t i = 0; i < p->out.attribute_count; i++) free(p->attributes[i].data);
  return status;
}

cdl_Status draco_primitives(Document *doc) {
  const json_t *meshes = json_object_get(doc->root, "meshes");
  cdl_Status status = CDL_OK;
  for (size_t m = 0; m < json_array_size(meshes) && !status; m++) {
    const json_t *list = json_object_get(json_array_get(meshes, m), "primitives");
    for (size_t i = 0; i < json_array_size(list) && !status; i++) {
      Primitive p = {.doc = doc, .json = json_array_get(list, i), .mesh = m, .number = i};
      p.extension = json_get_extension(p.json, EXTENSION);
      if (p.extension) status = decode_primitive(&p);
    }
  }
  return status;
}
