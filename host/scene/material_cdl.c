/* material_cdl.c: CDL_material, which replaces glTF's own shading. */
#include <string.h>

#include "scene/build.h"

typedef struct Model {
  const char *name;
  uint32_t model;
  float base;          /* the colour's default */
  float alpha;         /* alpha's default */
  const char *colour;  /* the member that holds the colour, or NULL */
  const char *texture; /* and its texture */
} Model;

static const Model models[] = {
    {"diffuse", CDL_MODEL_DIFFUSE, 0.5f, 0, "reflectance", "reflectanceTexture"},
    {"mirror", CDL_MODEL_MIRROR, 1, 0, "reflectance", "reflectanceTexture"},
    {"retroreflector", CDL_MODEL_RETROREFLECTOR, 1, 0.05f, "reflectance", "reflectanceTexture"},
    {"conductor", CDL_MODEL_CONDUCTOR, 1, 0, NULL, NULL},
    {"dielectric", CDL_MODEL_DIELECTRIC, 1, 0, "transmittance", "transmittanceTexture"},
    {"interface", CDL_MODEL_INTERFACE, 1, 0, NULL, NULL},
};

static const Model *find_model(const char *name) {
  for (size_t i = 0; i < sizeof models / sizeof *models; i++)
    if (strcmp(models[i].name, name) == 0) return &models[i];
  return NULL;
}

static cdl_Status not_supported(Builder *builder, const char *key, const char *at, const char *what,
                                const char *instead) {
  document_note(builder->doc, key, at, "%s is not supported; %s.", what, instead);
  return extension_mark(builder, "CDL_material", CDL_EXTENSION_UNSUPPORTED);
}

static cdl_Status read_conductor(Builder *builder, const char *at, const json_t *json,
                                 cdl_SceneMaterial *material) {
  const char *metal = json_get_string(json, "metal", NULL);
  int eta = json_object_get(json, "eta") != NULL, k = json_object_get(json, "k") != NULL;
  if (eta != k)
    return document_fail(builder->doc, at, "UNSATISFIED_DEPENDENCY",
                         "eta and k must be given together.");
  if (!eta && !metal) metal = "Au";
  if (metal && !metal_index(metal, material->eta, material->k))
    return document_fail(builder->doc, AT("%.200s/metal", at), "VALUE_NOT_IN_LIST",
                         "the metal %.40s is not known; give eta and k.", metal);
  json_get_numbers(json, "eta", 3, material->eta);
  json_get_numbers(json, "k", 3, material->k);
  return CDL_OK;
}

static cdl_Status read_microfacet(Builder *builder, const char *at, const Model *model,
                                  const json_t *json, cdl_SceneMaterial *material) {
  material->alpha[0] = material->alpha[1] = model->alpha;
  json_get_numbers(json, "alpha", 2, material->alpha);
  int beckmann = strcmp(json_get_string(json, "distribution", "ggx"), "beckmann") == 0;
  int separable = strcmp(json_get_string(json, "masking", "correlated"), "separable") == 0;
  material->distribution = beckmann ? CDL_BECKMANN : CDL_GGX;
  material->masking = separable ? CDL_MASKING_SEPARABLE : CDL_MASKING_CORRELATED;
  return build_texture_ref(builder, at, json_object_get(json, "alphaTexture"),
                           &material->alpha_texture);
}

/* Parameters that this renderer knows of but does not act on. */
static cdl_Status note_left_out(Builder *builder, const char *at, const json_t *json,
                                cdl_SceneMaterial *material) {
  cdl_Status status = CDL_OK;
  if (json_is_true(json_object_get(json, "energyCompensation")))
    status =
        not_supported(builder, "energyCompensation", at, "energyCompensation", "it is left out");
  if (!status && json_is_number(json_object_get(json, "abbe")))
    status = not_supported(builder, "abbe", at, "abbe", "the glass does not disperse");
  int rough = material->alpha[0] > 0 || material->alpha[1] > 0;
  if (!status && material->model == CDL_MODEL_DIELECTRIC && rough)
    status = not_supported(builder, "rough dielectric", at, "a rough dielectric",
                           "it is rendered smooth");
  if (!status && material->model == CDL_MODEL_DIELECTRIC && material->thin)
    status = not_supported(builder, "thin dielectric", at, "a thin dielectric",
                           "it is rendered as a solid");
  return status;
}

cdl_Status build_cdl_material(Builder *builder, uint32_t index, const json_t *json,
                              cdl_SceneMaterial *material) {
  const char *at = AT("/materials/%u/extensions/CDL_material", index);
  const char *name = json_get_string(json, "model", "");
  const Model *model = find_model(name);
  if (!model)
    return not_supported(builder, name, at, AT("the model %s", name),
                         "the plain glTF material takes its place");
  material->model = model->model;
  material->thin = json_is_true(json_object_get(json, "thin"));
  material->ior = (float)json_get_number(json, "ior", 1.5);
  material->transmission = 0;
  material->medium = CDL_NONE;
  for (int c = 0; c < 3; c++) material->base[c] = model->base;
  material->base_texture = material->metallic_roughness_texture = material->transmission_texture =
      texture_ref_none();
  cdl_Status status = CDL_OK;
  if (model->colour) {
    json_get_numbers(json, model->colour, 3, material->base);
    status = build_texture_ref(builder, at, json_object_get(json, model->texture),
                               &material->base_texture);
  }
  if (!status) status = read_microfacet(builder, at, model, json, material);
  if (!status && model->model == CDL_MODEL_CONDUCTOR)
    status = read_conductor(builder, at, json, material);
  return status ? status : note_left_out(builder, at, json, material);
}
