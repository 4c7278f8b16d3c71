#include "scene/schema.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Where the walk is: a list of frames from the innermost outwards. */
typedef struct Frame {
  const struct Frame *up;
  const char *key; /* NULL: `index` counts */
  size_t index;
} Frame;

static cdl_Status check_object(Document *doc, const json_t *object, const Schema *schema,
                               const Frame *frame);

/* RFC 6901: ~ and / within a key are escaped. */
static size_t put_key(char *text, size_t at, size_t room, const char *key) {
  for (; *key && at + 3 < room; key++) {
    if (*key == '~' || *key == '/') {
      text[at++] = '~';
      text[at++] = *key == '~' ? '0' : '1';
    } else {
      text[at++] = *key;
    }
  }
  text[at] = 0;
  return at;
}

static size_t put_frame(char *text, size_t room, const Frame *frame) {
  if (!frame) return 0;
  size_t at = put_frame(text, room, frame->up);
  if (at + 24 >= room) return at;
  text[at++] = '/';
  if (frame->key) return put_key(text, at, room, frame->key);
  return at + (size_t)snprintf(text + at, room - at, "%zu", frame->index);
}

static const char *pointer_of(char text[256], const Frame *frame) {
  text[0] = 0;
  put_frame(text, 256, frame);
  return text;
}

#define FAIL(doc, frame, ...) document_fail(doc, pointer_of((char[256]){0}, frame), __VA_ARGS__)

static const char *type_name(const json_t *value) {
  switch (json_typeof(value)) {
  case JSON_OBJECT:
    return "an object";
  case JSON_ARRAY:
    return "an array";
  case JSON_STRING:
    return "a string";
  case JSON_TRUE:
  case JSON_FALSE:
    return "a boolean";
  case JSON_NULL:
    return "null";
  default:
    return "a number";
  }
}

static cdl_Status wrong_type(Document *doc, const Frame *frame, const json_t *value,
                             const char *wanted) {
  return FAIL(doc, frame, "TYPE_MISMATCH", "it must be %s, not %s.", wanted, type_name(value));
}

static cdl_Status check_number(Document *doc, const json_t *value, const Member *member,
                               const Frame *frame) {
  if (!json_is_number(value)) return wrong_type(doc, frame, value, "a number");
  double x = json_number_value(value);
  if (member->type != MEMBER_NUMBER && x != floor(x))
    return FAIL(doc, frame, "TYPE_MISMATCH", "it must be an integer, not %g.", x);
  if (x < member->min || x > member->max || ((member->flags & ABOVE) && x == member->min))
    return FAIL(doc, frame, "VALUE_NOT_IN_RANGE", "the value %g is out of range.", x);
  if (fabs(x) > FLT_MAX)
    return FAIL(doc, frame, "VALUE_NOT_IN_RANGE", "the value %g is beyond single precision.", x);
  return CDL_OK;
}

static cdl_Status check_listed(Document *doc, const json_t *value, const Member *member,
                               const Frame *frame) {
  int known = 0;
  for (const unsigned *v = member->values; v && *v != DOCUMENT_NONE; v++)
    known |= json_number_value(value) == *v;
  for (const char *const *c = member->choices; c && *c; c++)
    known |= strcmp(json_string_value(value), *c) == 0;
  if (known) return CDL_OK;
  char number[32] = "";
  if (json_is_number(value)) snprintf(number, sizeof number, "%g", json_number_value(value));
  const char *text = json_is_string(value) ? json_string_value(value) : number;
  if (member->flags & LISTED)
    return FAIL(doc, frame, "VALUE_NOT_IN_LIST", "the value %.60s is not one of those allowed.",
                text);
  document_note(doc, NULL, pointer_of((char[256]){0}, frame),
                "VALUE_NOT_IN_LIST: the value %.60s is not known and is left out.", text);
  return CDL_OK;
}

/* The array that an index counts in: at the root, or that of an extension there. */
static const json_t *target_array(const Document *doc, const char *target) {
  if (strcmp(target, "lights") == 0)
    return json_object_get(json_get_extension(doc->root, "KHR_lights_punctual"), "lights");
  if (strcmp(target, "variants") == 0)
    return json_object_get(json_get_extension(doc->root, "KHR_materials_variants"), "variants");
  return json_object_get(doc->root, target);
}

static cdl_Status check_index(Document *doc, const json_t *value, const Member *member,
                              const Frame *frame) {
  static const Member index = {.type = MEMBER_INTEGER, .max = 0x1p31};
  cdl_Status status = check_number(doc, value, &index, frame);
  if (status || !member->target) return status;
  double i = json_number_value(value);
  const json_t *array = target_array(doc, member->target);
  int in_extension =
      strcmp(member->target, "lights") == 0 || strcmp(member->target, "variants") == 0;
  if (!array && in_extension)
    return FAIL(doc, frame->up, "UNSATISFIED_DEPENDENCY",
                "the extension must define %s at the root.", member->target);
  if (i >= (double)json_array_size(array))
    return FAIL(doc, frame, "UNRESOLVED_REFERENCE", "there is no %s[%.0f].", member->target, i);
  return CDL_OK;
}

static cdl_Status check_index_map(Document *doc, const json_t *map, const Member *member,
                                  const Frame *frame) {
  if (!json_is_object(map)) return wrong_type(doc, frame, map, "an object");
  if (json_object_size(map) == 0) return FAIL(doc, frame, "EMPTY_ENTITY", "it cannot be empty.");
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)map, key, value) {
    cdl_Status status = check_index(doc, value, member, &(Frame){frame, key, 0});
    if (status) return status;
  }
  return CDL_OK;
}

static cdl_Status check_value(Document *doc, const json_t *value, const Member *member,
                              const Frame *frame) {
  cdl_Status status = CDL_OK;
  switch (member->type) {
  case MEMBER_ANY:
    break;
  case MEMBER_NUMBER:
  case MEMBER_INTEGER:
    status = check_number(doc, value, member, frame);
    break;
  case MEMBER_BOOL:
    if (!json_is_boolean(value)) status = wrong_type(doc, frame, value, "a boolean");
    break;
  case MEMBER_STRING:
    if (!json_is_string(value)) status = wrong_type(doc, frame, value, "a string");
    break;
  case MEMBER_OBJECT:
    return check_object(doc, value, member->schema, frame);
  case MEMBER_INDEX:
    return check_index(doc, value, member, frame);
  case MEMBER_INDEX_MAP:
    return check_index_map(doc, value, member, frame);
  }
  if (!status && (member->choices || member->values))
    status = check_listed(doc, value, member, frame);
  return status;
}

static cdl_Status check_unique(Document *doc, const json_t *array, const Frame *frame) {
  json_t *seen = json_object();
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < json_array_size(array) && !status; i++) {
    char key[32];
    snprintf(key, sizeof key, "%.0f", json_number_value(json_array_get(array, i)));
    Frame at = {frame, NULL, i};
    if (json_object_get(seen, key))
      status = FAIL(doc, &at, "ARRAY_ELEMENT_NOT_UNIQUE", "%s came before.", key);
    json_object_set_new(seen, key, json_true());
  }
  json_decref(seen);
  return status;
}

static cdl_Status check_array(Document *doc, const json_t *array, const Member *member,
                              const Frame *frame) {
  if (!json_is_array(array)) return wrong_type(doc, frame, array, "an array");
  size_t count = json_array_size(array);
  if (count == 0 && member->shortest > 0)
    return FAIL(doc, frame, "EMPTY_ENTITY", "it cannot be empty.");
  if (count < member->shortest || (member->longest && count > member->longest))
    return FAIL(doc, frame, "ARRAY_LENGTH_NOT_IN_LIST", "a length of %zu is not allowed.", count);
  for (size_t i = 0; i < count; i++) {
    cdl_Status status =
        check_value(doc, json_array_get(array, i), member, &(Frame){frame, NULL, i});
    if (status) return status;
  }
  return (member->flags & UNIQUE) && count > 1 ? check_unique(doc, array, frame) : CDL_OK;
}

static int is_declared(const Document *doc, const char *extension) {
  const json_t *used = json_object_get(doc->root, "extensionsUsed");
  for (size_t i = 0; i < json_array_size(used); i++) {
    const char *name = json_string_value(json_array_get(used, i));
    if (name && strcmp(name, extension) == 0) return 1;
  }
  return 0;
}

static cdl_Status check_extension(Document *doc, const json_t *object, const char *name,
                                  const Schema *where, const Frame *frame) {
  if (!is_declared(doc, name))
    return FAIL(doc, frame, "UNDECLARED_EXTENSION", "it is not listed in extensionsUsed.");
  int known = 0;
  for (const ExtensionPlace *place = schema_extensions; place->name; place++) {
    if (strcmp(place->name, name) != 0) continue;
    known = 1;
    if (place->where == where) return check_object(doc, object, place->schema, frame);
  }
  if (known) return FAIL(doc, frame, "UNEXPECTED_EXTENSION_OBJECT", "it does not belong here.");
  return CDL_OK;
}

static cdl_Status check_extensions(Document *doc, const json_t *extensions, const Schema *where,
                                   const Frame *frame) {
  if (!json_is_object(extensions)) return wrong_type(doc, frame, extensions, "an object");
  const char *name;
  json_t *object;
  json_object_foreach((json_t *)extensions, name, object) {
    cdl_Status status = check_extension(doc, object, name, where, &(Frame){frame, name, 0});
    if (status) return status;
  }
  return CDL_OK;
}

const Member *schema_member(const Schema *schema, const char *name) {
  for (const Member *m = schema->members; m->name; m++)
    if (strcmp(m->name, name) == 0) return m;
  return NULL;
}

static cdl_Status check_member(Document *doc, const json_t *value, const Schema *schema,
                               const Frame *frame) {
  const char *name = frame->key;
  if (strcmp(name, "extensions") == 0) return check_extensions(doc, value, schema, frame);
  if (strcmp(name, "extras") == 0) return CDL_OK;
  const Member *member = schema_member(schema, name);
  if (!member) {
    char key[128];
    snprintf(key, sizeof key, "%s.%.80s", schema->name, name);
    document_note(doc, key, pointer_of((char[256]){0}, frame),
                  "UNEXPECTED_PROPERTY: %s has no such member; it is left out.", schema->name);
    return CDL_OK;
  }
  if ((member->flags & NULLABLE) && json_is_null(value)) return CDL_OK;
  if ((member->flags & EITHER) && json_is_number(value))
    return check_value(doc, value, member, frame);
  if (member->flags & (ARRAY | EITHER)) return check_array(doc, value, member, frame);
  return check_value(doc, value, member, frame);
}

static cdl_Status check_object(Document *doc, const json_t *object, const Schema *schema,
                               const Frame *frame) {
  if (!json_is_object(object)) return wrong_type(doc, frame, object, "an object");
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key, value) {
    cdl_Status status = check_member(doc, value, schema, &(Frame){frame, key, 0});
    if (status) return status;
  }
  for (const Member *m = schema->members; m->name; m++)
    if ((m->flags & REQUIRED) && !json_object_get(object, m->name))
      return FAIL(doc, frame, "UNDEFINED_PROPERTY", "the member %s must be given.", m->name);
  return CDL_OK;
}

cdl_Status schema_check(Document *doc) { return check_object(doc, doc->root, &schema_root, NULL); }
