/* check_mesh.c: which attributes a primitive has, and of what form (section 3.7.2.1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/check.h"

#define BIT(component) (1u << ((component)-GL_BYTE))
#define FLOATS BIT(GL_FLOAT)
#define NORMS (BIT(GL_UNSIGNED_BYTE) | BIT(GL_UNSIGNED_SHORT))
#define SIGNED (BIT(GL_BYTE) | BIT(GL_SHORT))
#define INTEGERS (NORMS | SIGNED)

/* A semantic: widths, component types as bits, those that KHR_mesh_quantization adds, and which of
 * the integers must be normalised (1), must not (0), or may (2). */
typedef struct Semantic {
  const char *name;
  int indexed;
  uint32_t narrowest, widest;
  uint32_t components, quantized;
  int normalized;
} Semantic;

static const Semantic semantics[] = {
    {"POSITION", 0, 3, 3, FLOATS, INTEGERS, 2}, {"NORMAL", 0, 3, 3, FLOATS, SIGNED, 1},
    {"TANGENT", 0, 4, 4, FLOATS, SIGNED, 1},    {"TEXCOORD_", 1, 2, 2, FLOATS | NORMS, INTEGERS, 2},
    {"COLOR_", 1, 3, 4, FLOATS | NORMS, 0, 1},  {"JOINTS_", 1, 4, 4, NORMS, 0, 0},
    {"WEIGHTS_", 1, 4, 4, FLOATS | NORMS, 0, 1}};
enum { SEMANTICS = sizeof semantics / sizeof *semantics, JOINTS = 5, WEIGHTS = 6 };

typedef struct Place {
  Document *doc;
  size_t mesh, primitive;
  int target; /* -1: the primitive itself */
  int quantized;
  uint32_t *usage; /* by buffer view: GL target, 0: none so far */
} Place;

/* The pointer of an attribute, its name escaped. */
static char *attribute_pointer(char *text, const Place *place, const char *name) {
  char escaped[96];
  size_t n = 0;
  for (; *name && n + 3 < sizeof escaped; name++) {
    if (*name == '~' || *name == '/') escaped[n++] = '~';
    escaped[n++] = *name == '~' ? '0' : *name == '/' ? '1' : *name;
  }
  escaped[n] = 0;
  if (place->target < 0)
    return pointer_format(text, "/meshes/%zu/primitives/%zu/attributes/%s", place->mesh,
                          place->primitive, escaped);
  return pointer_format(text, "/meshes/%zu/primitives/%zu/targets/%d/%s", place->mesh,
                        place->primitive, place->target, escaped);
}

#define HERE(place, name) attribute_pointer((char[256]){0}, place, name)

/* The semantic of a name and the set number behind it; NULL for none. */
static const Semantic *find_semantic(const char *name, unsigned long *set) {
  for (int i = 0; i < SEMANTICS; i++) {
    size_t n = strlen(semantics[i].name);
    if (strncmp(name, semantics[i].name, n) != 0) continue;
    const char *digits = name + n;
    *set = 0;
    if (!semantics[i].indexed) return *digits ? NULL : &semantics[i];
    size_t length = strspn(digits, "0123456789");
    if (!length || digits[length] || length > 6 || (length > 1 && *digits == '0')) return NULL;
    *set = strtoul(digits, NULL, 10);
    return &semantics[i];
  }
  return NULL;
}

/* Morph targets hold differences: those of tangents leave their handedness, those of texture
 * coordinates and colours may be signed. */
static int target_allowed(const Place *place, const Semantic *semantic, const Accessor *a) {
  int handed = semantic->narrowest == 4 && semantic->widest == 4;
  uint32_t normalized =
      strcmp(semantic->name, "COLOR_") && strcmp(semantic->name, "TEXCOORD_") ? 0 : INTEGERS;
  uint32_t quantized = place->quantized ? semantic->quantized & SIGNED : 0;
  if (semantic - semantics >= JOINTS || a->columns != 1) return 0;
  if (handed ? a->width != 3 : a->width < semantic->narrowest || a->width > semantic->widest)
    return 0;
  if (a->component == GL_FLOAT) return 1;
  if (normalized & BIT(a->component) && a->normalized) return 1;
  return (quantized & BIT(a->component)) != 0 &&
         (semantic->normalized == 2 || (int)a->normalized == semantic->normalized);
}

static int format_allowed(const Place *place, const Semantic *semantic, const Accessor *a) {
  uint32_t bit = BIT(a->component);
  uint32_t allowed = semantic->components | (place->quantized ? semantic->quantized : 0);
  if (place->target >= 0) return target_allowed(place, semantic, a);
  if (a->columns != 1 || a->width < semantic->narrowest || a->width > semantic->widest) return 0;
  if (!(allowed & bit)) return 0;
  if (a->component == GL_FLOAT || semantic->normalized == 2) {
    int core = (semantic->components & bit) && a->component != GL_FLOAT && !place->quantized;
    return !core || a->normalized;
  }
  return (int)a->normalized == semantic->normalized;
}

static cdl_Status check_alignment(const Place *place, const char *name, const Accessor *a) {
  if (a->view == DOCUMENT_NONE) return CDL_OK;
  const BufferView *view = &place->doc->views[a->view];
  size_t stride = view->stride ? view->stride : accessor_element_size(a);
  if (a->offset % 4 == 0 && stride % 4 == 0) return CDL_OK;
  return document_fail(place->doc, HERE(place, name), "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
                       "vertex attributes must begin at multiples of 4 bytes.");
}

static cdl_Status check_usage(const Place *place, const char *at, const Accessor *a,
                              uint32_t target) {
  if (a->view == DOCUMENT_NONE) return CDL_OK;
  uint32_t *usage = &place->usage[a->view];
  if (*usage && *usage != target)
    return document_fail(place->doc, at, "BUFFER_VIEW_TARGET_OVERRIDE",
                         "bufferView %u cannot hold vertices and indices.", a->view);
  *usage = target;
  return CDL_OK;
}

static cdl_Status check_format(const Place *place, const char *name, const Semantic *semantic,
                               uint32_t index) {
  Document *doc = place->doc;
  const Accessor *a = &doc->accessors[index];
  const json_t *json = json_array_get(json_object_get(doc->root, "accessors"), index);
  if (a->component == GL_UNSIGNED_INT)
    return document_fail(doc, HERE(place, name), "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
                         "attributes cannot be 32-bit integers.");
  if (semantic && !format_allowed(place, semantic, a))
    return document_fail(doc, HERE(place, name),
                         "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
                         "an accessor of this type cannot hold %s%s.", name,
                         place->quantized ? "" : " without KHR_mesh_quantization");
  if (strcmp(name, "POSITION") == 0 &&
      (!json_object_get(json, "min") || !json_object_get(json, "max")))
    return document_fail(doc, HERE(place, name), "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
                         "the accessor must have min and max.");
  if (a->count >= DOCUMENT_NONE)
    return document_fail(doc, HERE(place, name), "ACCESSOR_TOO_LONG", "%zu vertices are too many.",
                         a->count);
  cdl_Status status = check_usage(place, HERE(place, name), a, 34962);
  return status ? status : check_alignment(place, name, a);
}

static cdl_Status check_attributes(const Place *place, const json_t *attributes, size_t *count) {
  unsigned long highest[SEMANTICS] = {0}, present[SEMANTICS] = {0}, set = 0;
  const char *name;
  json_t *value;
  json_object_foreach((json_t *)attributes, name, value) {
    const Semantic *semantic = *name == '_' ? NULL : find_semantic(name, &set);
    uint32_t index = (uint32_t)json_number_value(value);
    if (*name != '_' && !semantic)
      return document_fail(place->doc, HERE(place, name), "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
                           "there is no attribute of this name.");
    cdl_Status status = check_format(place, name, semantic, index);
    if (status) return status;
    if (*count && place->doc->accessors[index].count != *count)
      return document_fail(place->doc, HERE(place, name), "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                           "it has %zu elements, the one before %zu.",
                           place->doc->accessors[index].count, *count);
    *count = place->doc->accessors[index].count;
    if (!semantic) continue;
    present[semantic - semantics]++;
    if (set > highest[semantic - semantics]) highest[semantic - semantics] = set;
  }
  const char *at = AT("/meshes/%zu/primitives/%zu/attributes", place->mesh, place->primitive);
  for (int i = 0; i < SEMANTICS; i++)
    if (present[i] && present[i] != highest[i] + 1)
      return document_fail(place->doc, at, "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
                           "the sets of %s must be counted from 0 without gaps.",
                           semantics[i].name);
  if (place->target < 0 && present[JOINTS] != present[WEIGHTS])
    return document_fail(place->doc, at, "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
                         "there are %lu sets of joints and %lu of weights.", present[JOINTS],
                         present[WEIGHTS]);
  return CDL_OK;
}

static cdl_Status check_indices(const Place *place, const json_t *primitive) {
  uint32_t index = json_get_index(primitive, "indices");
  if (index == DOCUMENT_NONE) return CDL_OK;
  const Accessor *a = &place->doc->accessors[index];
  const char *at = AT("/meshes/%zu/primitives/%zu/indices", place->mesh, place->primitive);
  if (a->width != 1 || a->normalized ||
      (a->component != GL_UNSIGNED_BYTE && a->component != GL_UNSIGNED_SHORT &&
       a->component != GL_UNSIGNED_INT))
    return document_fail(place->doc, at, "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
                         "indices must be unsigned scalars.");
  if (a->view != DOCUMENT_NONE && place->doc->views[a->view].stride)
    return document_fail(place->doc, at, "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
                         "the bufferView of indices cannot have a stride.");
  if (a->count >= DOCUMENT_NONE)
    return document_fail(place->doc, at, "ACCESSOR_TOO_LONG", "%zu indices are too many.",
                         a->count);
  return check_usage(place, at, a, 34963);
}

static cdl_Status check_targets(Place *place, const json_t *primitive, size_t count) {
  const json_t *targets = json_object_get(primitive, "targets");
  const json_t *base = json_object_get(primitive, "attributes");
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < json_array_size(targets) && !status; i++) {
    const char *name;
    json_t *value;
    size_t same = count;
    place->target = (int)i;
    status = check_attributes(place, json_array_get(targets, i), &same);
    if (status) break;
    json_object_foreach(json_array_get(targets, i), name, value) {
      if (json_object_get(base, name)) continue;
      status = document_fail(place->doc, HERE(place, name),
                             "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
                             "the primitive itself has no such attribute.");
      break;
    }
  }
  return status;
}

/* KHR_materials_variants: no variant twice on one primitive. */
static cdl_Status check_variants(const Place *place, const json_t *primitive) {
  const json_t *mappings =
      json_object_get(json_get_extension(primitive, "KHR_materials_variants"), "mappings");
  json_t *seen = json_object();
  cdl_Status status = CDL_OK;
  for (size_t m = 0; m < json_array_size(mappings); m++) {
    const json_t *variants = json_object_get(json_array_get(mappings, m), "variants");
    for (size_t v = 0; v < json_array_size(variants) && !status; v++) {
      char key[32];
      snprintf(key, sizeof key, "%.0f", json_number_value(json_array_get(variants, v)));
      if (json_object_get(seen, key))
        status = document_fail(place->doc,
                               AT("/meshes/%zu/primitives/%zu/extensions/KHR_materials_variants/"
                                  "mappings/%zu/variants/%zu",
                                  place->mesh, place->primitive, m, v),
                               "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT",
                               "the variant %s has a material already.", key);
      json_object_set_new(seen, key, json_true());
    }
  }
  json_decref(seen);
  return status;
}

static cdl_Status check_primitive(Place *place, const json_t *primitive) {
  size_t count = 0;
  place->target = -1;
  cdl_Status status = check_attributes(place, json_object_get(primitive, "attributes"), &count);
  if (!status) status = check_indices(place, primitive);
  if (!status) status = check_variants(place, primitive);
  return status ? status : check_targets(place, primitive, count);
}

static int uses_quantization(const Document *doc) {
  const json_t *used = json_object_get(doc->root, "extensionsUsed");
  for (size_t i = 0; i < json_array_size(used); i++)
    if (strcmp(json_string_value(json_array_get(used, i)), "KHR_mesh_quantization") == 0) return 1;
  return 0;
}

cdl_Status check_meshes(Document *doc) {
  const json_t *meshes = json_object_get(doc->root, "meshes");
  Place place = {.doc = doc, .quantized = uses_quantization(doc)};
  place.usage = calloc(doc->view_count + 1, sizeof *place.usage);
  if (!place.usage) return document_out_of_memory(doc);
  for (uint32_t i = 0; i < doc->view_count; i++) place.usage[i] = doc->views[i].target;
  cdl_Status status = CDL_OK;
  for (place.mesh = 0; place.mesh < json_array_size(meshes) && !status; place.mesh++) {
    const json_t *list = json_object_get(json_array_get(meshes, place.mesh), "primitives");
    for (place.primitive = 0; place.primitive < json_array_size(list) && !status; place.primitive++)
      status = check_primitive(&place, json_array_get(list, place.primitive));
  }
  free(place.usage);
  return status;
}
