/* animation.c: the list of animations that a file has. */
#include <math.h>
#include <stdlib.h>

#include "scene/accessor.h"
#include "scene/build.h"

/* The accessor of times must say its least and greatest (check_animations). */
static void grow_span(const Builder *builder, const json_t *sampler, cdl_SceneAnimation *to) {
  const json_t *accessors = json_object_get(builder->doc->root, "accessors");
  const json_t *input = json_array_get(accessors, json_get_index(sampler, "input"));
  double begin = json_number_value(json_array_get(json_object_get(input, "min"), 0));
  double end = json_number_value(json_array_get(json_object_get(input, "max"), 0));
  to->begin = fmin(to->begin, begin);
  to->end = fmax(to->end, end);
}

cdl_Status build_animations(Builder *builder) {
  const json_t *list = json_object_get(builder->doc->root, "animations");
  struct cdl_Scene *scene = builder->scene;
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *json = json_array_get(list, i), *samplers = json_object_get(json, "samplers");
    cdl_SceneAnimation *to =
        array_push((void **)&scene->animations, scene->animation_count, sizeof *to);
    if (!to || !(to->name = string_copy(json_get_string(json, "name", ""))))
      return document_out_of_memory(builder->doc);
    scene->animation_count++;
    to->begin = INFINITY;
    to->channels = (uint32_t)json_array_size(json_object_get(json, "channels"));
    for (size_t s = 0; s < json_array_size(samplers); s++)
      grow_span(builder, json_array_get(samplers, s), to);
  }
  return CDL_OK;
}
