#include "scene/choice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/document.h"

static const char *camera_name(const void *things, uint32_t i) {
  return ((const cdl_SceneCamera *)things)[i].name;
}

static const char *material_name(const void *things, uint32_t i) {
  return ((const cdl_SceneMaterial *)things)[i].name;
}

static const char *object_name(const void *things, uint32_t i) {
  return json_get_string(json_array_get(things, i), "name", "");
}

Choice choice_of_cameras(const struct cdl_Scene *scene) {
  return (Choice){"camera", scene->path, scene->camera_count, 0, camera_name, scene->cameras};
}

Choice choice_of_materials(const struct cdl_Scene *scene) {
  return (Choice){"material", scene->path,   scene->material_count,
                  0,          material_name, scene->materials};
}

Choice choice_of_objects(const char *kind, const char *path, const json_t *list) {
  return (Choice){kind, path, (uint32_t)json_array_size(list), 0, object_name, list};
}

uint32_t choice_find(const Choice *choice, const char *wanted) {
  for (uint32_t i = 0; i < choice->count; i++)
    if (strcmp(choice->name(choice->things, i), wanted) == 0) return i;
  size_t digits = strspn(wanted, "0123456789");
  if (choice->by_name || digits == 0 || wanted[digits]) return CDL_NONE;
  unsigned long index = strtoul(wanted, NULL, 10); /* what is too large for it is the largest */
  return index < choice->count ? (uint32_t)index : CDL_NONE;
}

static void list_names(const Choice *choice, char *text, size_t size) {
  *text = 0;
  for (uint32_t i = 0; i < choice->count; i++) {
    const char *name = choice->name(choice->things, i), *comma = i ? ", " : "";
    size_t used = strlen(text);
    if (used + strlen(name) + 24 > size) {
      snprintf(text + used, size - used, "%s…", comma);
      return;
    }
    if (choice->by_name)
      snprintf(text + used, size - used, "%s\"%s\"", comma, name);
    else
      snprintf(text + used, size - used, "%s%u \"%s\"", comma, i, name);
  }
}

cdl_Status choice_require(const cdl_Log *log, const Choice *choice, const char *wanted,
                          uint32_t *index) {
  char names[1024];
  *index = choice_find(choice, wanted);
  if (*index != CDL_NONE) return CDL_OK;
  list_names(choice, names, sizeof names);
  if (!*names)
    return log_fail(log, CDL_USAGE, "--%s %s: %s has no %ss", choice->kind, wanted, choice->path,
                    choice->kind);
  return log_fail(log, CDL_USAGE, "--%s %s: %s has no such %s; it has %s", choice->kind, wanted,
                  choice->path, choice->kind, names);
}
