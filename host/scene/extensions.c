/* extensions.c: the list of extensions that a scene uses, and how each fares. */
#include <string.h>

#include "scene/build.h"

static const struct {
  const char *name;
  cdl_ExtensionState state;
} known[] = {
    {"CDL_camera", CDL_EXTENSION_USED},
    {"CDL_environment", CDL_EXTENSION_USED},
    {"CDL_material", CDL_EXTENSION_USED},
    {"CDL_medium", CDL_EXTENSION_USED},
    {"EXT_mesh_gpu_instancing", CDL_EXTENSION_USED},
    {"EXT_meshopt_compression", CDL_EXTENSION_USED},
    {"EXT_texture_webp", CDL_EXTENSION_USED},
    {"FB_ngon_encoding", CDL_EXTENSION_IGNORED},
    {"KHR_animation_pointer", CDL_EXTENSION_USED},
    {"KHR_draco_mesh_compression", CDL_EXTENSION_USED},
    {"KHR_lights_punctual", CDL_EXTENSION_USED},
    {"KHR_materials_emissive_strength", CDL_EXTENSION_USED},
    {"KHR_materials_ior", CDL_EXTENSION_USED},
    {"KHR_materials_anisotropy", CDL_EXTENSION_USED},
    {"KHR_materials_clearcoat", CDL_EXTENSION_USED},
    {"KHR_materials_diffuse_transmission", CDL_EXTENSION_USED},
    {"KHR_materials_dispersion", CDL_EXTENSION_USED},
    {"KHR_materials_iridescence", CDL_EXTENSION_USED},
    {"KHR_materials_retroreflection", CDL_EXTENSION_USED},
    {"KHR_materials_sheen", CDL_EXTENSION_USED},
    {"KHR_materials_specular", CDL_EXTENSION_USED},
    {"KHR_materials_transmission", CDL_EXTENSION_USED},
    {"KHR_materials_unlit", CDL_EXTENSION_USED},
    {"KHR_materials_variants", CDL_EXTENSION_USED},
    {"KHR_materials_volume", CDL_EXTENSION_USED},
    {"KHR_materials_volume_scatter", CDL_EXTENSION_USED},
    {"KHR_mesh_quantization", CDL_EXTENSION_USED},
    {"KHR_meshopt_compression", CDL_EXTENSION_USED},
    {"KHR_node_visibility", CDL_EXTENSION_USED},
    /* Where a texture has no other image, texture.c says that it is unsupported. */
    {"KHR_texture_basisu", CDL_EXTENSION_IGNORED},
    {"KHR_texture_transform", CDL_EXTENSION_USED},
    {"KHR_xmp", CDL_EXTENSION_IGNORED},
    {"KHR_xmp_json_ld", CDL_EXTENSION_IGNORED},
};

int extension_state(const char *name, cdl_ExtensionState *state) {
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (strcmp(known[i].name, name) == 0) {
      *state = known[i].state;
      return 1;
    }
  *state = CDL_EXTENSION_UNSUPPORTED;
  return 0;
}

cdl_Status extension_mark(Builder *builder, const char *name, cdl_ExtensionState state) {
  struct cdl_Scene *scene = builder->scene;
  for (uint32_t i = 0; i < scene->extension_count; i++) {
    if (strcmp(scene->extensions[i].name, name) != 0) continue;
    if (state > scene->extensions[i].state) scene->extensions[i].state = state;
    return CDL_OK;
  }
  cdl_SceneExtension *slot =
      array_push((void **)&scene->extensions, scene->extension_count, sizeof *slot);
  char *copy = slot ? string_copy(name) : NULL;
  if (!copy) return document_out_of_memory(builder->doc);
  *slot = (cdl_SceneExtension){copy, state};
  scene->extension_count++;
  return CDL_OK;
}

cdl_Status build_extensions(Builder *builder) {
  const json_t *used = json_object_get(builder->doc->root, "extensionsUsed");
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < json_array_size(used) && !status; i++) {
    cdl_ExtensionState state;
    const char *name = json_string_value(json_array_get(used, i));
    extension_state(name, &state);
    status = extension_mark(builder, name, state);
  }
  return status;
}
