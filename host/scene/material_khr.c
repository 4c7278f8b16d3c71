/* material_khr.c: the KHR_materials_ extensions that add layers and lobes to glTF's material. */
#include "core/angle.h"
#include "scene/material_params.h"

#define WORD(name) CDL_GLTF_LAYERED_##name
#define FACTOR(name, word, value, channel)                                                         \
  { name "Factor", WORD(word), 1, {value}, name "Texture", channel }
#define COLOR(name, word, value)                                                                   \
  { name "Factor", WORD(word), 3, {value, value, value}, name "Texture", CHANNELS_COLOR }
#define NUMBER(name, word, value)                                                                  \
  { name, WORD(word), 1, {value}, NULL, 0 }
#define END                                                                                        \
  { .name = NULL }

static const ParamMember specular[] = {FACTOR("specular", SPECULAR, 1, CHANNEL_A),
                                       COLOR("specularColor", SPECULAR_COLOR, 1), END};
static const ParamMember anisotropy[] = {
    {"anisotropyStrength", WORD(ANISOTROPY_STRENGTH), 1, {0}, "anisotropyTexture", CHANNEL_B}, END};
static const ParamMember clearcoat[] = {
    FACTOR("clearcoat", CLEARCOAT, 0, CHANNEL_R),
    FACTOR("clearcoatRoughness", CLEARCOAT_ROUGHNESS, 0, CHANNEL_G), END};
static const ParamMember sheen[] = {COLOR("sheenColor", SHEEN_COLOR, 0),
                                    FACTOR("sheenRoughness", SHEEN_ROUGHNESS, 0, CHANNEL_A), END};
static const ParamMember iridescence[] = {
    FACTOR("iridescence", IRIDESCENCE, 0, CHANNEL_R),
    NUMBER("iridescenceIor", IRIDESCENCE_IOR, 1.3f),
    NUMBER("iridescenceThicknessMaximum", IRIDESCENCE_THICKNESS, 400), END};
static const ParamMember transmission[] = {FACTOR("transmission", TRANSMISSION, 0, CHANNEL_R), END};
static const ParamMember volume[] = {NUMBER("thicknessFactor", THICKNESS, 0), END};
static const ParamMember dispersion[] = {NUMBER("dispersion", DISPERSION, 0), END};
static const ParamMember diffuse_transmission[] = {
    FACTOR("diffuseTransmission", DIFFUSE_TRANSMISSION, 0, CHANNEL_A),
    COLOR("diffuseTransmissionColor", DIFFUSE_TRANSMISSION_COLOR, 1), END};
static const ParamMember retroreflection[] = {
    FACTOR("retroreflection", RETROREFLECTION, 0, CHANNEL_R), END};

/* `on`: the words that say whether the layer is there at all. */
typedef struct Layer {
  const char *extension;
  const ParamMember *members;
  uint32_t on, on_words;
  uint32_t bit; /* CDL_GLTF_LAYER_*, or 0: costs nothing where it is not used */
} Layer;

#define LAYER(name, members, word, words, bit)                                                     \
  { "KHR_materials_" name, members, WORD(word), words, bit }

static const Layer layers[] = {
    LAYER("specular", specular, SPECULAR, 1, 0),
    LAYER("anisotropy", anisotropy, ANISOTROPY_STRENGTH, 1, CDL_GLTF_LAYER_ANISOTROPY),
    LAYER("clearcoat", clearcoat, CLEARCOAT, 1, CDL_GLTF_LAYER_CLEARCOAT),
    LAYER("sheen", sheen, SHEEN_COLOR, 3, CDL_GLTF_LAYER_SHEEN),
    LAYER("iridescence", iridescence, IRIDESCENCE, 1, CDL_GLTF_LAYER_IRIDESCENCE),
    LAYER("transmission", transmission, TRANSMISSION, 1, CDL_GLTF_LAYER_TRANSMISSION),
    LAYER("diffuse_transmission", diffuse_transmission, DIFFUSE_TRANSMISSION, 1,
          CDL_GLTF_LAYER_DIFFUSE_TRANSMISSION),
    LAYER("retroreflection", retroreflection, RETROREFLECTION, 1, CDL_GLTF_LAYER_RETROREFLECTION),
    LAYER("volume", volume, THICKNESS, 1, 0),
    LAYER("dispersion", dispersion, DISPERSION, 1, CDL_GLTF_LAYER_DISPERSION),
};

static int any_word(const cdl_SceneMaterial *material, uint32_t first, uint32_t words) {
  int any = 0;
  for (uint32_t i = 0; i < words; i++) any |= material->param[first + i] > 0;
  return any;
}

/* Another look-up of a texture that another member names. */
static void add_channel(cdl_SceneMaterial *material, const cdl_TextureRef *texture, uint32_t word,
                        uint32_t channel, float offset, float scale) {
  if (texture->texture == CDL_NONE || material->texture_count == CDL_PARAM_TEXTURES_MAX) return;
  material->textures[material->texture_count++] = (cdl_SceneParamTexture){.texture = *texture,
                                                                          .param = word,
                                                                          .words = 1,
                                                                          .channel = channel,
                                                                          .offset = offset,
                                                                          .scale = {scale}};
}

/* Red and green are the direction, from -1 to 1, which the rotation turns. */
static cdl_Status read_anisotropy(Builder *builder, const char *at, const json_t *json,
                                  cdl_SceneMaterial *material) {
  cdl_TextureRef texture;
  float *rotation = &material->param[WORD(ANISOTROPY_ROTATION)];
  angle_sincos(json_get_number(json, "anisotropyRotation", 0), &rotation[1], &rotation[0]);
  material->param[WORD(ANISOTROPY_DIRECTION)] = 1;
  cdl_Status status =
      build_texture_ref(builder, at, json_object_get(json, "anisotropyTexture"), &texture);
  if (status) return status;
  add_channel(material, &texture, WORD(ANISOTROPY_DIRECTION), CHANNEL_R, -1, 2);
  add_channel(material, &texture, WORD(ANISOTROPY_DIRECTION) + 1, CHANNEL_G, -1, 2);
  material->anisotropic = material->param[WORD(ANISOTROPY_STRENGTH)] > 0;
  return CDL_OK;
}

/* Without a texture the film is as thick as the maximum says; green goes from one to the other. */
static cdl_Status read_film(Builder *builder, const char *at, const json_t *json,
                            cdl_SceneMaterial *material) {
  cdl_TextureRef texture;
  float thinnest = (float)json_get_number(json, "iridescenceThicknessMinimum", 100);
  float thickest = material->param[WORD(IRIDESCENCE_THICKNESS)];
  cdl_Status status = build_texture_ref(
      builder, at, json_object_get(json, "iridescenceThicknessTexture"), &texture);
  if (status) return status;
  add_channel(material, &texture, WORD(IRIDESCENCE_THICKNESS), CHANNEL_G, thinnest,
              thickest - thinnest);
  return CDL_OK;
}

static cdl_Status read_coat_normal(Builder *builder, const char *at, const json_t *json,
                                   cdl_SceneMaterial *material) {
  const json_t *normal = json_object_get(json, "clearcoatNormalTexture");
  material->coat_normal_scale = (float)json_get_number(normal, "scale", 1);
  return build_texture_ref(builder, at, normal, &material->coat_normal_texture);
}

/* Clear and smooth glass around a volume, without other layers, is a dielectric of ours, with
 * Fresnel's equations in the place of Schlick's approximation. A sheet is not: ours reflects with
 * both of its sides, the extension's with one, so a trace of roughness would halve what it sends
 * back. */
static int is_plain_glass(const cdl_SceneMaterial *m) {
  int plain = !m->thin && m->param[WORD(TRANSMISSION)] >= 1 && m->param[WORD(ROUGHNESS)] <= 0 &&
              m->param[WORD(METALLIC)] <= 0 && m->texture_count == 0 && m->param[WORD(IOR)] >= 1 &&
              m->param[WORD(SPECULAR)] == 1;
  for (uint32_t c = 0; c < 3; c++) plain &= m->param[WORD(SPECULAR_COLOR) + c] == 1;
  return plain && !any_word(m, WORD(CLEARCOAT), 1) && !any_word(m, WORD(SHEEN_COLOR), 3) &&
         !any_word(m, WORD(ANISOTROPY_STRENGTH), 1) && !any_word(m, WORD(IRIDESCENCE), 1) &&
         !any_word(m, WORD(RETROREFLECTION), 1);
}

static void become_glass(cdl_SceneMaterial *material) {
  float ior = material->param[WORD(IOR)], dispersed = material->param[WORD(DISPERSION)];
  for (uint32_t i = 0; i < CDL_PARAM_MAX; i++) material->param[i] = 0;
  material->model = CDL_MODEL_DIELECTRIC;
  material->param[CDL_DIELECTRIC_IOR] = ior;
  material->param[CDL_DIELECTRIC_ABBE] = dispersed > 0 ? 20 / dispersed : 0;
}

static void choose_model(cdl_SceneMaterial *material) {
  material->transmits = any_word(material, WORD(TRANSMISSION), 1) ||
                        any_word(material, WORD(DIFFUSE_TRANSMISSION), 1);
  material->thin = material->transmits && material->param[WORD(THICKNESS)] <= 0;
  material->model = CDL_MODEL_GLTF_LAYERED;
  if (is_plain_glass(material)) become_glass(material);
}

cdl_Status build_gltf_layers(Builder *builder, uint32_t index, const json_t *json,
                             cdl_SceneMaterial *material) {
  cdl_Status status = CDL_OK;
  int present = 0;
  for (size_t i = 0; i < sizeof layers / sizeof *layers && !status; i++) {
    const char *at = AT("/materials/%u/extensions/%s", index, layers[i].extension);
    const json_t *extension = json_get_extension(json, layers[i].extension);
    present |= extension != NULL;
    status = build_params(builder, at, extension, layers[i].members, material);
    if (!status && layers[i].members == anisotropy)
      status = read_anisotropy(builder, at, extension, material);
    if (!status && layers[i].members == iridescence)
      status = read_film(builder, at, extension, material);
    if (!status && layers[i].members == clearcoat)
      status = read_coat_normal(builder, at, extension, material);
  }
  if (status || !present) return status;
  choose_model(material);
  const json_t *interior = json_get_extension(json, "KHR_materials_volume");
  const json_t *scatter = json_get_extension(json, "KHR_materials_volume_scatter");
  if (material->transmits && !material->thin)
    return build_volume(builder, interior, scatter, &material->medium);
  return CDL_OK;
}

uint32_t scene_gltf_layers(const cdl_SceneMaterial *material) {
  uint32_t bits = 0;
  if (material->model != CDL_MODEL_GLTF_LAYERED) return 0;
  for (uint32_t i = 0; i < sizeof layers / sizeof *layers; i++)
    bits |= any_word(material, layers[i].on, layers[i].on_words) ? layers[i].bit : 0;
  return bits;
}
