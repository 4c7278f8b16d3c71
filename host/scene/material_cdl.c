/* material_cdl.c: CDL_material, which replaces glTF's own shading. */
#include <string.h>

#include "scene/material_params.h"

#define ALPHA(word, value)                                                                         \
  { "alpha", word, 2, {value, value}, "alphaTexture", CHANNEL_R }
#define END                                                                                        \
  { .name = NULL }

static const ParamMember none[] = {END};
static const ParamMember conductor[] = {ALPHA(CDL_CONDUCTOR_ALPHA, 0),
                                        {"eta", CDL_CONDUCTOR_ETA, 3, {0}, NULL, 0},
                                        {"k", CDL_CONDUCTOR_K, 3, {0}, NULL, 0},
                                        END};
static const ParamMember dielectric[] = {
    {"ior", CDL_DIELECTRIC_IOR, 1, {1.5f}, "iorTexture", CHANNEL_R},
    {"abbe", CDL_DIELECTRIC_ABBE, 1, {0}, "abbeTexture", CHANNEL_R},
    END};
static const ParamMember rough_dielectric[] = {
    ALPHA(CDL_ROUGH_DIELECTRIC_ALPHA, 0),
    {"ior", CDL_ROUGH_DIELECTRIC_IOR, 1, {1.5f}, "iorTexture", CHANNEL_R},
    {"abbe", CDL_ROUGH_DIELECTRIC_ABBE, 1, {0}, "abbeTexture", CHANNEL_R},
    END};
static const ParamMember subsurface[] = {
    ALPHA(CDL_BODY_ALPHA, 0.3f), {"ior", CDL_BODY_IOR, 1, {1.4f}, "iorTexture", CHANNEL_R}, END};
static const ParamMember profile[] = {
    ALPHA(CDL_SUBSURFACE_ALPHA, 0.3f),
    {"ior", CDL_SUBSURFACE_IOR, 1, {1.4f}, "iorTexture", CHANNEL_R},
    {"radius", CDL_SUBSURFACE_RADIUS, 3, {1e-3f, 1e-3f, 1e-3f}, "radiusTexture", CHANNEL_R},
    END};
static const ParamMember plastic[] = {ALPHA(CDL_PLASTIC_ALPHA, 0.1f),
                                      {"ior", CDL_PLASTIC_IOR, 1, {1.5f}, "iorTexture", CHANNEL_R},
                                      END};
static const ParamMember retroreflector[] = {
    ALPHA(CDL_RETROREFLECTOR_ALPHA, 0.05f),
    {"ior", CDL_RETROREFLECTOR_IOR, 1, {1.5f}, "iorTexture", CHANNEL_R},
    END};

static const ParamMember oren_nayar[] = {
    {"roughness", CDL_OREN_NAYAR_ROUGHNESS, 1, {0.5f}, "roughnessTexture", CHANNEL_R}, END};

/* The defaults of 2012; glass of 1.5, solid and opaque, from 2015. */
#define DISNEY(name, word, value)                                                                  \
  { name, CDL_DISNEY_##word, 1, {value}, name "Texture", CHANNEL_R }
static const ParamMember disney[] = {DISNEY("metallic", METALLIC, 0),
                                     DISNEY("roughness", ROUGHNESS, 0.5f),
                                     DISNEY("anisotropic", ANISOTROPIC, 0),
                                     DISNEY("specular", SPECULAR, 0.5f),
                                     DISNEY("specularTint", SPECULAR_TINT, 0),
                                     DISNEY("sheen", SHEEN, 0),
                                     DISNEY("sheenTint", SHEEN_TINT, 0.5f),
                                     DISNEY("clearcoat", CLEARCOAT, 0),
                                     DISNEY("clearcoatGloss", CLEARCOAT_GLOSS, 1),
                                     DISNEY("subsurface", SUBSURFACE, 0),
                                     DISNEY("specTrans", SPEC_TRANS, 0),
                                     {"ior", CDL_DISNEY_IOR, 1, {1.5f}, "iorTexture", CHANNEL_R},
                                     DISNEY("diffTrans", DIFF_TRANS, 0),
                                     DISNEY("flatness", FLATNESS, 0),
                                     {"thin", CDL_DISNEY_THIN, 1, {0}, NULL, 0},
                                     END};

typedef struct Model {
  const char *name;
  uint32_t model;
  const char *color;   /* the member that holds the base colour, or NULL */
  const char *texture; /* and its texture */
  float base;          /* its default */
  const ParamMember *members;
} Model;

#define REFLECTANCE "reflectance", "reflectanceTexture"

static const Model models[] = {
    {"diffuse", CDL_MODEL_DIFFUSE, REFLECTANCE, 0.5f, none},
    {"mirror", CDL_MODEL_MIRROR, REFLECTANCE, 1, none},
    {"retroreflector", CDL_MODEL_RETROREFLECTOR, REFLECTANCE, 1, retroreflector},
    {"conductor", CDL_MODEL_CONDUCTOR, NULL, NULL, 1, conductor},
    {"dielectric", CDL_MODEL_DIELECTRIC, "transmittance", "transmittanceTexture", 1, dielectric},
    {"plastic", CDL_MODEL_PLASTIC, REFLECTANCE, 0.5f, plastic},
    {"oren_nayar", CDL_MODEL_OREN_NAYAR, REFLECTANCE, 0.5f, oren_nayar},
    {"disney", CDL_MODEL_DISNEY, "baseColor", "baseColorTexture", 0.5f, disney},
    {"subsurface", CDL_MODEL_BODY, NULL, NULL, 1, subsurface},
    {"interface", CDL_MODEL_INTERFACE, NULL, NULL, 1, none},
};

/* What "dielectric" is where its alpha is not 0. */
static const Model frosted = {
    "dielectric",    CDL_MODEL_ROUGH_DIELECTRIC, "transmittance", "transmittanceTexture", 1,
    rough_dielectric};

/* What "subsurface" is where its light follows a profile. */
static const Model profiled = {"subsurface", CDL_MODEL_SUBSURFACE, "albedo", "albedoTexture", 0.5f,
                               profile};

static int is_profiled(const json_t *json) {
  return strcmp(json_get_string(json, "method", "random_walk"), "random_walk") != 0;
}

static int is_rough(const json_t *json) {
  float alpha[2] = {0, 0};
  json_get_numbers(json, "alpha", 2, alpha);
  return alpha[0] > 0 || alpha[1] > 0;
}

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

/* eta and k, or those of a named metal. */
static cdl_Status read_metal(Builder *builder, const char *at, const json_t *json,
                             cdl_SceneMaterial *material) {
  const char *metal = json_get_string(json, "metal", NULL);
  int eta = json_object_get(json, "eta") != NULL, k = json_object_get(json, "k") != NULL;
  if (eta != k)
    return document_fail(builder->doc, at, "UNSATISFIED_DEPENDENCY",
                         "eta and k must be given together.");
  if (!metal) metal = "Au";
  float metal_eta[3], metal_k[3];
  if (!metal_index(metal, metal_eta, metal_k))
    return document_fail(builder->doc, AT("%.200s/metal", at), "VALUE_NOT_IN_LIST",
                         "the metal %.40s is not known; give eta and k.", metal);
  if (eta) return CDL_OK;
  memcpy(material->param + CDL_CONDUCTOR_ETA, metal_eta, sizeof metal_eta);
  memcpy(material->param + CDL_CONDUCTOR_K, metal_k, sizeof metal_k);
  return CDL_OK;
}

static void read_flags(const json_t *json, cdl_SceneMaterial *material) {
  int beckmann = strcmp(json_get_string(json, "distribution", "ggx"), "beckmann") == 0;
  int separable = strcmp(json_get_string(json, "masking", "correlated"), "separable") == 0;
  material->distribution = beckmann ? CDL_BECKMANN : CDL_GGX;
  material->masking = separable ? CDL_MASKING_SEPARABLE : CDL_MASKING_CORRELATED;
  material->thin = json_is_true(json_object_get(json, "thin"));
  material->energy_compensation = json_is_true(json_object_get(json, "energyCompensation"));
  float alpha[2] = {0, 0};
  json_get_numbers(json, "alpha", 2, alpha);
  material->anisotropic = alpha[0] != alpha[1] || json_get_number(json, "anisotropic", 0) != 0;
  material->transmits = material->model == CDL_MODEL_DIELECTRIC ||
                        material->model == CDL_MODEL_ROUGH_DIELECTRIC ||
                        material->model == CDL_MODEL_BODY ||
                        (material->model == CDL_MODEL_DISNEY &&
                         (json_get_number(json, "specTrans", 0) > 0 || material->thin));
}

/* The tables know isotropic glass alone. */
static void drop_compensation(Builder *builder, const char *at, cdl_SceneMaterial *material) {
  int known = material->model != CDL_MODEL_ROUGH_DIELECTRIC || !material->anisotropic;
  if (!material->energy_compensation || known || material->thin) return;
  material->energy_compensation = 0;
  document_note(builder->doc, NULL, at,
                "energyCompensation is left out for glass that is rougher one way than the other.");
}

/* The ways in which light goes under a surface: through a medium, or by a profile. */
static cdl_Status build_walk(Builder *builder, const char *at, const json_t *json,
                             cdl_SceneMaterial *material) {
  static const char *const textures[] = {"albedoTexture", "radiusTexture"};
  for (size_t i = 0; i < sizeof textures / sizeof *textures; i++)
    if (json_object_get(json, textures[i]))
      document_note(builder->doc, NULL, at,
                    "%s is left out: random_walk's inside is the same everywhere; the methods "
                    "diffusion and dipole take it.",
                    textures[i]);
  return build_subsurface_medium(builder, json, &material->medium);
}

static void build_profile(const json_t *json, cdl_SceneMaterial *material) {
  material->dipole = strcmp(json_get_string(json, "method", ""), "dipole") == 0;
  subsurface_stretch(json, material->base, material->param + CDL_SUBSURFACE_RADIUS);
  for (uint32_t i = 0; i < material->texture_count; i++) {
    cdl_SceneParamTexture *texture = &material->textures[i];
    memcpy(texture->scale, material->param + texture->param, texture->words * sizeof(float));
  }
}

cdl_Status build_cdl_material(Builder *builder, uint32_t index, const json_t *json,
                              cdl_SceneMaterial *material) {
  const char *at = AT("/materials/%u/extensions/CDL_material", index);
  const char *name = json_get_string(json, "model", "");
  const Model *model = find_model(name);
  if (model && model->model == CDL_MODEL_DIELECTRIC && is_rough(json)) model = &frosted;
  if (model && model->members == subsurface && is_profiled(json)) model = &profiled;
  if (!model)
    return not_supported(builder, name, at, AT("the model %s", name),
                         "the plain glTF material takes its place");
  material->model = model->model;
  material->medium = CDL_NONE;
  material->texture_count = 0;
  memset(material->param, 0, sizeof material->param);
  for (int c = 0; c < 3; c++) material->base[c] = model->base;
  material->base_texture = material->coat_normal_texture = texture_ref_none();
  read_flags(json, material);
  drop_compensation(builder, at, material);
  cdl_Status status = CDL_OK;
  if (model->color) {
    json_get_numbers(json, model->color, 3, material->base);
    status = build_texture_ref(builder, at, json_object_get(json, model->texture),
                               &material->base_texture);
  }
  if (!status) status = build_params(builder, at, json, model->members, material);
  if (model->model == CDL_MODEL_DISNEY) material->param[CDL_DISNEY_THIN] = (float)material->thin;
  if (!status && model->model == CDL_MODEL_CONDUCTOR)
    status = read_metal(builder, at, json, material);
  if (!status && model->members == subsurface) status = build_walk(builder, at, json, material);
  if (!status && model->members == profile) build_profile(json, material);
  return status;
}

const char *scene_model_name(uint32_t model) {
#define MODEL_NAME(id, name, words) [CDL_MODEL_##id] = #name,
  static const char *const names[CDL_MODEL_COUNT] = {CDL_SHADED_MODELS(MODEL_NAME)};
#undef MODEL_NAME
  if (model == CDL_MODEL_BODY) return "subsurface"; /* as the file says, whatever the method */
  return names[model] ? names[model] : "interface";
}

uint32_t scene_model_params(uint32_t model) {
#define MODEL_WORDS(id, name, words) [CDL_MODEL_##id] = words,
  static const uint32_t counts[CDL_MODEL_COUNT] = {CDL_SHADED_MODELS(MODEL_WORDS)};
#undef MODEL_WORDS
  return counts[model];
}
