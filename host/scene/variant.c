/* variant.c: KHR_materials_variants: which material a primitive has. */
#include <stdlib.h>

#include "scene/build.h"
#include "scene/choice.h"

static const json_t *variants_of(const Document *doc) {
  return json_object_get(json_get_extension(doc->root, "KHR_materials_variants"), "variants");
}

cdl_Status variant_find(const Document *doc, const char *name, uint32_t *index) {
  Choice variants = choice_of_objects("variant", doc->path, variants_of(doc));
  variants.by_name = 1;
  *index = CDL_NONE;
  return name ? choice_require(doc->log, &variants, name, index) : CDL_OK;
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
