/* schema.h: what glTF allows where, as tables, and the walk that holds a document against them.
 *
 * The tables say type, range, length and reference of every member; the walk reports the first
 * violation with its JSON pointer, notes members that it does not know, and checks that extensions
 * stand where they belong and are declared. */
#ifndef CANDELA_SCENE_SCHEMA_H
#define CANDELA_SCENE_SCHEMA_H

#include "scene/document.h"

typedef enum MemberType {
  MEMBER_ANY,
  MEMBER_NUMBER,
  MEMBER_INTEGER,
  MEMBER_BOOL,
  MEMBER_STRING,
  MEMBER_OBJECT,   /* of `schema` */
  MEMBER_INDEX,    /* into the array named `target` */
  MEMBER_INDEX_MAP /* an object whose every member is such an index */
} MemberType;

enum {
  REQUIRED = 1,
  ARRAY = 2,    /* an array of the type, `shortest` to `longest` long */
  EITHER = 4,   /* the array, or a single number for all of it */
  ABOVE = 8,    /* min itself is out of range */
  UNIQUE = 16,  /* no number twice */
  LISTED = 32,  /* a value outside the choices is an error; else it is noted */
  NULLABLE = 64 /* null means absent */
};

typedef struct Schema Schema;

typedef struct Member {
  const char *name;
  MemberType type;
  unsigned flags;
  double min, max;            /* of numbers, both allowed */
  unsigned shortest, longest; /* of arrays; longest 0: any */
  const Schema *schema;
  const char *target;
  const char *const *choices; /* strings, ended by NULL */
  const unsigned *values;     /* integers, ended by 0xffffffff */
} Member;

struct Schema {
  const char *name;
  const Member *members; /* ended by a NULL name */
};

/* An extension's object at one place: `where` is the schema it may stand on. */
typedef struct ExtensionPlace {
  const char *name;
  const Schema *where, *schema;
} ExtensionPlace;

extern const Schema schema_root, schema_scene, schema_node, schema_mesh, schema_primitive,
    schema_material, schema_pbr, schema_texture_info, schema_normal_info, schema_occlusion_info,
    schema_texture, schema_image, schema_camera, schema_animation_target, schema_buffer,
    schema_buffer_view, schema_sampler, schema_light;

/* Ended by a NULL name. */
extern const ExtensionPlace schema_extensions[];

/* The member of that name; NULL: there is none. */
const Member *schema_member(const Schema *schema, const char *name);

/* A number, a flag or an array of numbers in the document, which may be absent as yet. */
typedef struct SchemaPlace {
  json_t *object; /* that has the member */
  const Member *member;
  size_t element; /* of an array; DOCUMENT_NONE: the whole value */
} SchemaPlace;

/* Follows a JSON pointer (RFC 6901) to a value of which the tables know type and range, and which
 * an animation may change; 0 when it leads to none, or when the object around it is absent. */
int schema_resolve(const Document *doc, const char *pointer, SchemaPlace *place);

/* Holds the whole document against the tables. */
cdl_Status schema_check(Document *doc);

#endif
