/* choice.h: one of a scene's things, as a user says which. */
#ifndef CANDELA_SCENE_CHOICE_H
#define CANDELA_SCENE_CHOICE_H

#include <jansson.h>

#include "scene/scene.h"

/* What there is to choose from. */
typedef struct Choice {
  const char *kind; /* "camera": the option's name as well */
  const char *path; /* of the scene */
  uint32_t count;
  int by_name; /* by name alone: an index names nothing */
  const char *(*name)(const void *things, uint32_t i);
  const void *things;
} Choice;

Choice choice_of_cameras(const struct cdl_Scene *scene);
Choice choice_of_materials(const struct cdl_Scene *scene);

/* The objects of a list in a document, by what they call "name". */
Choice choice_of_objects(const char *kind, const char *path, const json_t *list);

/* The index of what `wanted` names or is the index of; CDL_NONE: of nothing. A name comes before an
 * index, as things may be called "2", and the first comes before others of its name. */
uint32_t choice_find(const Choice *choice, const char *wanted);

/* The same, and CDL_USAGE with a list of what there is where it is nothing. */
cdl_Status choice_require(const cdl_Log *log, const Choice *choice, const char *wanted,
                          uint32_t *index);

#endif
