/* environment.c: what a scene object says of its surroundings. */
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

#include "scene/build.h"

static cdl_Status load_picture(Builder *builder, const char *pointer, const char *uri,
                               uint32_t *index) {
  struct cdl_Scene *scene = builder->scene;
  uint32_t n = scene->image_count;
  Bytes bytes = {0};
  char name[1024];
  cdl_Image **image = array_push((void **)&scene->images, n, sizeof *image);
  char **label = array_push((void **)&scene->image_names, n, sizeof *label);
  uint32_t *from = array_push((void **)&builder->image_sources, n, sizeof *from);
  if (!image || !label || !from) return document_out_of_memory(builder->doc);
  cdl_Status status = document_read_uri(builder->doc, pointer, uri, &bytes, NULL);
  if (status) return status;
  snprintf(name, sizeof name, "%.500s: %.400s", builder->doc->path, pointer);
  status = image_decode(builder->doc->log, name, bytes.data, bytes.size, image);
  free(bytes.owned);
  if (status) return status;
  scene->image_count++;
  *from = CDL_NONE;
  *index = n;
  *label = string_copy(strncasecmp(uri, "data:", 5) ? uri : "");
  return *label ? CDL_OK : document_out_of_memory(builder->doc);
}

static cdl_Status build_environment(Builder *builder, uint32_t scene, const json_t *json) {
  cdl_SceneEnvironment *environment = &builder->scene->environment;
  const char *uri = json_get_string(json, "uri", NULL);
  const char *at = AT("/scenes/%u/extensions/CDL_environment", scene);
  if (!uri && !json_object_get(json, "radiance"))
    return document_fail(builder->doc, at, "UNDEFINED_PROPERTY",
                         "either uri or radiance must be given.");
  *environment = (cdl_SceneEnvironment){.present = 1,
                                        .image = CDL_NONE,
                                        .radiance = {1, 1, 1},
                                        .strength = (float)json_get_number(json, "strength", 1),
                                        .rotation = (float)json_get_number(json, "rotation", 0)};
  if (uri) return load_picture(builder, AT("%.200s/uri", at), uri, &environment->image);
  json_get_numbers(json, "radiance", 3, environment->radiance);
  return CDL_OK;
}

/* A medium that glows without end and absorbs nothing of it. */
static cdl_Status check_glow(Builder *builder, const char *at) {
  if (builder->scene->medium == CDL_NONE) return CDL_OK;
  const cdl_SceneMedium *m = &builder->scene->media[builder->scene->medium];
  for (int c = 0; c < 3; c++)
    if (m->density == CDL_NONE && m->emission[c] > 0 && !(m->absorption[c] + m->scattering[c] > 0))
      return document_fail(
          builder->doc, at, "VALUE_NOT_IN_RANGE",
          "a medium that fills the scene and glows without absorbing is infinitely "
          "bright; give it absorption in the channels of its emission.");
  return CDL_OK;
}

cdl_Status build_scene_extensions(Builder *builder, uint32_t index, const json_t *json) {
  const json_t *environment = json_get_extension(json, "CDL_environment");
  const json_t *medium = json_get_extension(json, "CDL_medium");
  cdl_Status status = CDL_OK;
  if (environment) status = build_environment(builder, index, environment);
  if (!status && medium)
    status = build_medium(builder, AT("/scenes/%u/extensions/CDL_medium", index), medium,
                          &builder->scene->medium);
  return status ? status : check_glow(builder, AT("/scenes/%u/extensions/CDL_medium", index));
}
