/* material.c: glTF's metallic-roughness materials and the KHR_materials_ extensions that are
 * rendered. */
#include <string.h>

#include "scene/material_params.h"

static const ParamMember metallic_roughness[] = {
    {"metallicFactor", CDL_GLTF_METALLIC, 1, {1}, "metallicRoughnessTexture", CHANNEL_B},
    {"roughnessFactor", CDL_GLTF_ROUGHNESS, 1, {1}, "metallicRoughnessTexture", CHANNEL_G},
    {.name = NULL}};
static const ParamMember ior[] = {{"ior", CDL_GLTF_IOR, 1, {1.5f}, NULL, 0}, {.name = NULL}};

static cdl_SceneMaterial material_default(void) {
  cdl_TextureRef none = texture_ref_none();
  return (cdl_SceneMaterial){
      .model = CDL_MODEL_GLTF,
      .alpha_cutoff = 0.5f,
      .base = {1, 1, 1, 1},
      .param = {[CDL_GLTF_METALLIC] = 1, [CDL_GLTF_ROUGHNESS] = 1, [CDL_GLTF_IOR] = 1.5f},
      .normal_scale = 1,
      .coat_normal_scale = 1,
      .medium = CDL_NONE,
      .base_texture = none,
      .normal_texture = none,
      .coat_normal_texture = none,
      .emission_texture = none};
}

static cdl_Status read_pbr(Builder *builder, const char *at, const json_t *pbr,
                           cdl_SceneMaterial *material) {
  json_get_numbers(pbr, "baseColorFactor", 4, material->base);
  cdl_Status status = build_params(builder, at, pbr, metallic_roughness, material);
  if (status) return status;
  return build_texture_ref(builder, at, json_object_get(pbr, "baseColorTexture"),
                           &material->base_texture);
}

static cdl_AlphaMode alpha_mode(const char *name) {
  return strcmp(name, "MASK") == 0    ? CDL_ALPHA_MASK
         : strcmp(name, "BLEND") == 0 ? CDL_ALPHA_BLEND
                                      : CDL_ALPHA_OPAQUE;
}

static cdl_Status read_core(Builder *builder, const char *at, const json_t *json,
                            cdl_SceneMaterial *material) {
  const json_t *normal = json_object_get(json, "normalTexture");
  const json_t *strength = json_get_extension(json, "KHR_materials_emissive_strength");
  float factor = (float)json_get_number(strength, "emissiveStrength", 1);
  material->double_sided = json_is_true(json_object_get(json, "doubleSided"));
  material->alpha_mode = alpha_mode(json_get_string(json, "alphaMode", "OPAQUE"));
  material->alpha_cutoff = (float)json_get_number(json, "alphaCutoff", 0.5);
  material->normal_scale = (float)json_get_number(normal, "scale", 1);
  json_get_numbers(json, "emissiveFactor", 3, material->emission);
  for (int c = 0; c < 3; c++) material->emission[c] *= factor;
  cdl_Status status =
      read_pbr(builder, at, json_object_get(json, "pbrMetallicRoughness"), material);
  if (!status) status = build_texture_ref(builder, at, normal, &material->normal_texture);
  if (!status)
    status = build_texture_ref(builder, at, json_object_get(json, "emissiveTexture"),
                               &material->emission_texture);
  return status;
}

static cdl_Status read_khr(Builder *builder, uint32_t index, const json_t *json,
                           cdl_SceneMaterial *material) {
  cdl_Status status = build_params(builder, AT("/materials/%u/extensions/KHR_materials_ior", index),
                                   json_get_extension(json, "KHR_materials_ior"), ior, material);
  if (!status) status = build_gltf_layers(builder, index, json, material);
  if (json_get_extension(json, "KHR_materials_unlit")) material->model = CDL_MODEL_UNLIT;
  return status;
}

/* Extensions that change how light behaves and are not rendered are named, with the material. */
static void note_unsupported(Builder *builder, uint32_t index, const json_t *json) {
  const char *name;
  json_t *value;
  json_object_foreach(json_object_get(json, "extensions"), name, value) {
    cdl_ExtensionState state;
    extension_state(name, &state);
    if (state == CDL_EXTENSION_UNSUPPORTED)
      document_note(builder->doc, name, AT("/materials/%u/extensions/%s", index, name),
                    "the extension %s is not supported; it is left out.", name);
  }
}

static cdl_Status build_material(Builder *builder, uint32_t index, const json_t *json) {
  struct cdl_Scene *scene = builder->scene;
  cdl_SceneMaterial material = material_default();
  const json_t *medium = json_get_extension(json, "CDL_medium");
  const json_t *cdl = json_get_extension(json, "CDL_material");
  cdl_Status status = read_core(builder, AT("/materials/%u", index), json, &material);
  if (!status) status = read_khr(builder, index, json, &material);
  if (!status && cdl) status = build_cdl_material(builder, index, cdl, &material);
  if (!status && medium)
    status = build_medium(builder, AT("/materials/%u/extensions/CDL_medium", index), medium,
                          &material.medium);
  if (status) return status;
  note_unsupported(builder, index, json);
  cdl_SceneMaterial *slot =
      array_push((void **)&scene->materials, scene->material_count, sizeof *slot);
  material.name = slot ? string_copy(json_get_string(json, "name", "")) : NULL;
  if (!material.name) return document_out_of_memory(builder->doc);
  *slot = material;
  scene->material_count++;
  return CDL_OK;
}

cdl_Status build_materials(Builder *builder) {
  const json_t *list = json_object_get(builder->doc->root, "materials");
  cdl_Status status = CDL_OK;
  for (uint32_t i = 0; i < json_array_size(list) && !status; i++)
    status = build_material(builder, i, json_array_get(list, i));
  return status;
}

uint32_t build_default_material(Builder *builder) {
  struct cdl_Scene *scene = builder->scene;
  if (builder->default_material != CDL_NONE) return builder->default_material;
  cdl_SceneMaterial *slot =
      array_push((void **)&scene->materials, scene->material_count, sizeof *slot);
  char *name = slot ? string_copy("default") : NULL;
  if (!name) return CDL_NONE;
  *slot = material_default();
  slot->name = name;
  return builder->default_material = scene->material_count++;
}
