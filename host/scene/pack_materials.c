#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "lib/color.h"
#include "scene/pack_parts.h"

/* --- Textures. Of each there are two: as data, and as colour, which is decoded from sRGB. Kernels
 * decode 8-bit codes by a table, so both share their texels; what is encoded in floats (16-bit PNG)
 * is decoded here. */

static int is_encoded_float(const cdl_Image *image) { return image->f32 && image->encoded; }

/* Words of texels that an image needs. */
static size_t image_words(const cdl_Image *image) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  return image->u8 ? pixels : pixels * (is_encoded_float(image) ? 8 : 4);
}

static void copy_codes(const cdl_Image *image, uint32_t *to) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  for (size_t i = 0; i < pixels; i++) {
    const uint8_t *c = image->u8 + 4 * i;
    to[i] = c[0] | (uint32_t)c[1] << 8 | (uint32_t)c[2] << 16 | (uint32_t)c[3] << 24;
  }
}

static void copy_floats(const cdl_Image *image, int decode, uint32_t *to) {
  size_t values = 4 * (size_t)image->width * (size_t)image->height;
  for (size_t i = 0; i < values; i++) {
    float value = image->f32[i];
    value = decode && i % 4 != 3 ? color_srgb_decode(value) : value;
    to[i] = as_uint(value);
  }
}

/* Appends the image's texels; first[0] and first[1] say where its data and its colours begin. */
static void pack_image(const cdl_Image *image, cdl_Pack *pack, size_t first[2]) {
  uint32_t *to = pack->texels + pack->texel_count;
  first[0] = first[1] = pack->texel_count;
  if (image->u8) copy_codes(image, to);
  if (image->f32) copy_floats(image, 0, to);
  if (is_encoded_float(image)) {
    size_t plane = image_words(image) / 2;
    copy_floats(image, 1, to + plane);
    first[1] += plane;
  }
  pack->texel_count += image_words(image);
}

static void pack_texture(const cdl_SceneTexture *from, const cdl_Image *image, size_t first,
                         cdl_Texture *to) {
  *to = (cdl_Texture){.first = (uint32_t)first,
                      .width = (uint32_t)image->width,
                      .height = (uint32_t)image->height,
                      .format = image->u8 ? CDL_TEXEL_RGBA8 : CDL_TEXEL_RGBA32F,
                      .wrap_s = from->wrap_s,
                      .wrap_t = from->wrap_t,
                      .nearest = from->nearest != 0};
}

/* A texture without an image (one that could not be read) is one white texel. */
static const cdl_Image *texture_image(const cdl_Scene *scene, uint32_t texture,
                                      const cdl_Image *white) {
  uint32_t image = scene->textures[texture].image;
  return image != CDL_NONE && scene->images[image] ? scene->images[image] : white;
}

/* Images of environments, and those that nothing refers to any more, are no textures. */
static int is_texture(const cdl_Scene *scene, uint32_t image) {
  if (!scene->images[image]) return 0;
  for (uint32_t i = 0; i < scene->texture_count; i++)
    if (scene->textures[i].image == image) return 1;
  return 0;
}

static cdl_Status pack_all_images(const cdl_Log *log, const cdl_Scene *scene,
                                  const cdl_Image *white, cdl_Pack *pack) {
  size_t(*first)[2] = pack_array(log, "images", scene->image_count + 1u, sizeof *first);
  if (!first) return CDL_BAD_INPUT;
  for (uint32_t i = 0; i < scene->image_count; i++)
    if (is_texture(scene, i)) pack_image(scene->images[i], pack, first[i]);
  size_t *white_first = first[scene->image_count];
  pack_image(white, pack, white_first);
  for (uint32_t i = 0; i < scene->texture_count; i++) {
    const cdl_Image *image = texture_image(scene, i, white);
    const size_t *at = image == white ? white_first : first[scene->textures[i].image];
    for (int color = 0; color < 2; color++)
      pack_texture(&scene->textures[i], image, at[color], &pack->textures[2 * i + (uint32_t)color]);
    pack->features.float_textures |= image->f32 != NULL;
  }
  free(first);
  return CDL_OK;
}

cdl_Status pack_textures(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack) {
  uint8_t white_texel[4] = {255, 255, 255, 255};
  const cdl_Image white = {.width = 1, .height = 1, .channels = 4, .encoded = 1, .u8 = white_texel};
  size_t words = 1;
  for (uint32_t i = 0; i < scene->image_count; i++)
    if (is_texture(scene, i)) words += image_words(scene->images[i]);
  if (words > UINT32_MAX)
    return log_fail(
        log, CDL_BAD_INPUT,
        "%s: its textures need %.1f GB, more than the 17 GB that fit; make them smaller",
        scene->path, (double)words * 4e-9);
  for (int i = 0; i < 256; i++) pack->srgb[i] = color_srgb_decode((float)i / 255.0f);
  pack->texture_count = 2 * (size_t)scene->texture_count;
  pack->texels = pack_array(log, "texels", words, sizeof *pack->texels);
  pack->textures = pack_array(log, "textures", pack->texture_count, sizeof *pack->textures);
  if (!pack->texels || !pack->textures) return CDL_BAD_INPUT;
  pack->textures[0] = (cdl_Texture){.width = 1, .height = 1}; /* stays if there is none */
  return pack_all_images(log, scene, &white, pack);
}

/* --- Materials. */

static cdl_TextureSlot pack_slot(const cdl_TextureRef *from, int color) {
  cdl_TextureSlot slot = {.texture = CDL_NONE};
  if (from->texture != CDL_NONE) slot.texture = 2 * from->texture + (color != 0);
  slot.uv_set = from->uv_set;
  memcpy(slot.transform, from->transform, sizeof slot.transform);
  return slot;
}

/* Opaque surfaces count where they hold a medium: without one, nothing says that they are closed.
 */
static int is_boundary(const cdl_SceneMaterial *from) {
  int holds = from->medium != CDL_NONE || from->model == CDL_MODEL_INTERFACE || from->transmits;
  return holds && !from->thin;
}

/* What leaves into the surface comes out again only where nothing may go in. */
static int is_folded(const cdl_SceneMaterial *from) {
  int mapped =
      from->normal_texture.texture != CDL_NONE || from->coat_normal_texture.texture != CDL_NONE;
  return mapped && !from->transmits;
}

static uint32_t material_flags(const cdl_SceneMaterial *from) {
  const float *e = from->emission;
  int emissive = (e[0] > 0 || e[1] > 0 || e[2] > 0) && from->model != CDL_MODEL_UNLIT &&
                 from->model != CDL_MODEL_INTERFACE;
  return (from->double_sided ? CDL_MATERIAL_DOUBLE_SIDED : 0u) |
         (emissive ? CDL_MATERIAL_EMISSIVE : 0u) |
         (from->distribution == CDL_BECKMANN ? CDL_MATERIAL_BECKMANN : 0u) |
         (from->masking == CDL_MASKING_SEPARABLE ? CDL_MATERIAL_SEPARABLE : 0u) |
         (from->alpha_mode == CDL_ALPHA_MASK ? CDL_MATERIAL_MASK : 0u) |
         (from->alpha_mode == CDL_ALPHA_BLEND ? CDL_MATERIAL_BLEND : 0u) |
         (is_boundary(from) ? CDL_MATERIAL_BOUNDARY : 0u) | (from->thin ? CDL_MATERIAL_THIN : 0u) |
         (from->energy_compensation ? CDL_MATERIAL_ENERGY_COMPENSATED : 0u) |
         (is_folded(from) ? CDL_MATERIAL_NORMAL_MAPPED : 0u) |
         (from->dipole ? CDL_MATERIAL_DIPOLE : 0u);
}

static void pack_param_texture(const cdl_SceneParamTexture *from, cdl_ParamTexture *to) {
  *to = (cdl_ParamTexture){.slot = pack_slot(&from->texture, from->is_color),
                           .param = from->param,
                           .words = from->words,
                           .channel = from->channel,
                           .offset = from->offset,
                           .decode = from->is_color != 0};
  memcpy(to->scale, from->scale, sizeof to->scale);
}

static void pack_material(const cdl_SceneMaterial *from, cdl_Pack *pack, cdl_Material *to) {
  to->model = from->model;
  to->flags = material_flags(from);
  to->alpha_cutoff = from->alpha_cutoff;
  memcpy(to->base, from->base, sizeof to->base);
  memcpy(to->emission, from->emission, sizeof to->emission);
  memcpy(to->param, from->param, sizeof to->param);
  to->param_count = scene_model_params(from->model);
  to->first_texture = (uint32_t)pack->param_texture_count;
  to->texture_count = from->texture_count;
  for (uint32_t i = 0; i < from->texture_count; i++)
    pack_param_texture(&from->textures[i], &pack->param_textures[pack->param_texture_count++]);
  to->normal_scale = from->normal_scale;
  to->coat_normal_scale = from->coat_normal_scale;
  to->base_texture = pack_slot(&from->base_texture, 1);
  to->normal_texture = pack_slot(&from->normal_texture, 0);
  to->coat_normal_texture = pack_slot(&from->coat_normal_texture, 0);
  to->emission_texture = pack_slot(&from->emission_texture, 1);
}

int material_disperses(const cdl_Material *m) {
  switch (m->model) {
  case CDL_MODEL_DIELECTRIC:
    return m->param[CDL_DIELECTRIC_ABBE] > 0;
  case CDL_MODEL_ROUGH_DIELECTRIC:
    return m->param[CDL_ROUGH_DIELECTRIC_ABBE] > 0;
  case CDL_MODEL_GLTF_LAYERED:
    return m->param[CDL_GLTF_LAYERED_DISPERSION] > 0;
  default:
    return 0;
  }
}

static void note_features(const cdl_Material *m, cdl_PackFeatures *features) {
  int emissive = (m->flags & CDL_MATERIAL_EMISSIVE) != 0;
  features->textures |= m->base_texture.texture != CDL_NONE ||
                        m->normal_texture.texture != CDL_NONE ||
                        m->coat_normal_texture.texture != CDL_NONE || m->texture_count > 0;
  features->energy_compensation |= (m->flags & CDL_MATERIAL_ENERGY_COMPENSATED) != 0u;
  features->normal_maps |= (m->flags & CDL_MATERIAL_NORMAL_MAPPED) != 0u;
  features->dispersion |= material_disperses(m);
  features->emission_textures |= emissive && m->emission_texture.texture != CDL_NONE;
}

cdl_Status pack_materials(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack) {
  pack->material_count = scene->material_count;
  pack->materials = pack_array(log, "materials", pack->material_count, sizeof *pack->materials);
  size_t textures = 0;
  for (uint32_t i = 0; i < scene->material_count; i++)
    textures += scene->materials[i].texture_count;
  pack->param_textures = pack_array(log, "materials", textures, sizeof *pack->param_textures);
  if (!pack->materials || !pack->param_textures) return CDL_BAD_INPUT;
  for (uint32_t i = 0; i < scene->material_count; i++) {
    pack_material(&scene->materials[i], pack, &pack->materials[i]);
    note_features(&pack->materials[i], &pack->features);
    pack->features.gltf_layers |= scene_gltf_layers(&scene->materials[i]);
  }
  return CDL_OK;
}
