/* variant.c: KHR_materials_variants: which material a primitive has. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/build.h"

static const json_t *variants_of(const Document *doc) {
  return json_object_get(json_get_extension(doc->root, "KHR_materials_variants"), "variants");
}

static cdl_Status fail_unknown(const Document *doc, const char *name) {
  const json_t *list = variants_of(doc);
  char names[1024] = "";
  for (size_t i = 0; i < json_array_size(list); i++) {
    size_t used = strlen(names);
    snprintf(names + used, sizeof names - used, "%s\"%s\"", i ? ", " : "",
             json_get_string(json_array_get(list, i), "name", ""));
  }
  return log_fail(doc->log, CDL_USAGE, "--variant %s: %s has %s%s", name, doc->path,
                  *names ? "no such variant; it has " : "no variants", names);
}

cdl_Status variant_find(const Document *doc, const char *name, uint32_t *index) {
  const json_t *list = variants_of(doc);
  *index = CDL_NONE;
  if (!name) return CDL_OK;
  for (size_t i = 0; i < json_array_size(list); i++)
    if (strcmp(json_get_string(json_array_get(list, i), "name", ""), name) == 0) {
      *index = (uint32_t)i;
      return CDL_OK;
    }
  return fail_unknown(doc, name);
}

uint32_t variant_material(const json_t *primitive, uint32_t variant, uint32_t otherwise) {
  const json_t *mappings =
      json_object_get(json_get_extension(primitive, "KHR_materials_variants"), "mappings");
  if (variant == CDL_NONE) return otherwise;
  for (size_t m = 0; m < json_array_size(mappings); m++) {
    const json_t *mapping = json_array_get(mappings, m);
    const json_t *variants = json_object_get(mapping, "variants");
    for (size_t v = 0; v < json_array_size(variants); v++)
      if ((uint32_t)json_number_value(json_array_get(variants, v)) == variant)
        return json_get_index(mapping, "material");
  }
  return otherwise;
}

cdl_Status build_variants(Builder *builder) {
  const json_t *list = variants_of(builder->doc);
  struct cdl_Scene *scene = builder->scene;
  for (size_t i = 0; i < json_array_size(list); i++) {
    char **slot = array_push((void **)&scene->variants, scene->variant_count, sizeof *slot);
    char *name = string_copy(json_get_string(json_array_get(list, i), "name", ""));
    if (!slot || !name) {
      free(name);
      return document_out_of_memory(builder->doc);
    }
    scene->variants[scene->variant_count++] = name;
  }
  return CDL_OK;
}
