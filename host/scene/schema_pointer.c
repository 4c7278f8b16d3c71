/* schema_pointer.c: JSON pointers (RFC 6901) to what may change while an animation runs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/schema.h"

/* The next token of a pointer, unescaped; NULL at its end, or when it is too long for any name. */
static const char *next_token(const char **pointer, char token[128]) {
  const char *p = *pointer;
  size_t n = 0;
  if (*p != '/') return NULL;
  for (p++; *p && *p != '/' && n < 127; p++) {
    int escape = *p == '~' && (p[1] == '0' || p[1] == '1');
    token[n++] = !escape ? *p : p[1] == '1' ? '/' : '~';
    p += escape;
  }
  token[n] = 0;
  *pointer = p;
  return *p && *p != '/' ? NULL : token;
}

/* An index below `count`, digits alone; DOCUMENT_NONE otherwise. */
static size_t read_index(const char *token, size_t count) {
  size_t length = token ? strspn(token, "0123456789") : 0;
  if (!length || length > 9 || token[length]) return DOCUMENT_NONE;
  size_t index = strtoul(token, NULL, 10);
  return index < count ? index : DOCUMENT_NONE;
}

static const Schema *extension_schema(const Schema *where, const char *name) {
  for (const ExtensionPlace *place = schema_extensions; place->name; place++)
    if (place->where == where && strcmp(place->name, name) == 0) return place->schema;
  return NULL;
}

/* What an animation may reach: not what says where data lie. */
static int is_mutable(const char *root_member) {
  static const char *const members[] = {"nodes",   "meshes", "materials",
                                        "cameras", "scenes", "extensions"};
  for (size_t i = 0; i < sizeof members / sizeof *members; i++)
    if (strcmp(root_member, members[i]) == 0) return 1;
  return 0;
}

/* The leaf: a number, a flag, an array of numbers or one element of it. */
static int resolve_leaf(json_t *object, const Member *member, const char *pointer,
                        SchemaPlace *place) {
  char token[128];
  int array = (member->flags & (ARRAY | EITHER)) != 0;
  if (member->type != MEMBER_NUMBER && member->type != MEMBER_BOOL) return 0;
  if (strcmp(member->name, "matrix") == 0) return 0;
  *place = (SchemaPlace){.object = object, .member = member, .element = DOCUMENT_NONE};
  if (!*pointer) return 1;
  const char *element = next_token(&pointer, token);
  place->element = read_index(element, member->longest ? member->longest : DOCUMENT_NONE);
  return array && place->element != DOCUMENT_NONE && !*pointer;
}

/* The object below `object` that the pointer's next tokens name; NULL: none, or no object. */
static json_t *enter(json_t *object, const Member *member, const char **pointer) {
  char token[128];
  json_t *value = json_object_get(object, member->name);
  if (member->type != MEMBER_OBJECT) return NULL;
  if (!(member->flags & ARRAY)) return value;
  return json_array_get(value, read_index(next_token(pointer, token), json_array_size(value)));
}

int schema_resolve(const Document *doc, const char *pointer, SchemaPlace *place) {
  const Schema *schema = &schema_root;
  json_t *object = doc->root;
  char token[128];
  while (object && schema && next_token(&pointer, token)) {
    if (schema == &schema_root && !is_mutable(token)) return 0;
    if (strcmp(token, "extensions") == 0) {
      if (!next_token(&pointer, token)) return 0;
      object = json_get_extension(object, token);
      schema = extension_schema(schema, token);
      continue;
    }
    const Member *member = schema_member(schema, token);
    if (!member) return 0;
    if (member->type != MEMBER_OBJECT) return resolve_leaf(object, member, pointer, place);
    object = enter(object, member, &pointer);
    schema = member->schema;
  }
  return 0;
}
