/* texture.c: glTF textures, samplers and images on their way into the scene. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/angle.h"
#include "core/log.h"
#include "scene/build.h"

#define WRAP_CLAMP 33071
#define WRAP_MIRROR 33648
#define FILTER_NEAREST 9728

cdl_TextureRef texture_ref_none(void) {
  return (cdl_TextureRef){.texture = CDL_NONE, .transform = {1, 0, 0, 0, 1, 0}};
}

static uint32_t wrap_mode(const json_t *sampler, const char *name) {
  double code = json_get_number(sampler, name, 0);
  return code == WRAP_CLAMP    ? CDL_WRAP_CLAMP
         : code == WRAP_MIRROR ? CDL_WRAP_MIRROR
                               : CDL_WRAP_REPEAT;
}

/* In the maps of the builder: what was said to be missing. */
#define NOTED (CDL_NONE - 1)

static int is_decodable(const Builder *builder, uint32_t image) {
  return image != DOCUMENT_NONE && builder->doc->images[image].data;
}

/* check_images() leaves the size of what it found to be KTX2. */
static int is_ktx2(const Builder *builder, uint32_t image) {
  return !is_decodable(builder, image) && builder->doc->images[image].size;
}

/* Once for each image, or texture without one, however many materials show it. */
static cdl_Status note_missing(Builder *builder, uint32_t source, const json_t *texture) {
  static const char *const extensions[] = {"EXT_texture_webp", "KHR_texture_basisu"};
  uint32_t image = json_get_index(texture, "source");
  for (int i = 0; i < 2 && image == DOCUMENT_NONE; i++)
    image = json_get_index(json_get_extension(texture, extensions[i]), "source");
  builder->texture_map[source] = NOTED;
  if (image == DOCUMENT_NONE) {
    document_note(builder->doc, NULL, AT("/textures/%u", source),
                  "it has no image; where it is used, the factor alone counts.");
  } else if (builder->image_map[image] != NOTED) {
    builder->image_map[image] = NOTED;
    document_note(builder->doc, NULL, AT("/images/%u", image),
                  "the image is %s; where it is used, the factor alone counts.",
                  is_ktx2(builder, image) ? "KTX2 (KHR_texture_basisu), which is not supported"
                                          : "missing or of a kind that is not supported");
  }
  if (image == DOCUMENT_NONE || !is_ktx2(builder, image)) return CDL_OK;
  return extension_mark(builder, "KHR_texture_basisu", CDL_EXTENSION_UNSUPPORTED);
}

/* EXT_texture_webp comes first, then the plain source; KTX2 is not decoded. CDL_NONE: no image. */
static uint32_t texture_image(const Builder *builder, const json_t *texture) {
  const json_t *webp = json_get_extension(texture, "EXT_texture_webp");
  uint32_t image = json_get_index(webp, "source"), plain = json_get_index(texture, "source");
  if (!is_decodable(builder, image)) image = plain;
  return is_decodable(builder, image) ? image : CDL_NONE;
}

static cdl_Status add_image(Builder *builder, uint32_t source, uint32_t *index) {
  struct cdl_Scene *scene = builder->scene;
  *index = builder->image_map[source];
  if (*index != CDL_NONE) return CDL_OK;
  const json_t *json = json_array_get(json_object_get(builder->doc->root, "images"), source);
  const char *uri = json_get_string(json, "uri", "");
  if (strncasecmp(uri, "data:", 5) == 0) uri = "";
  uint32_t n = scene->image_count;
  cdl_Image **image = array_push((void **)&scene->images, n, sizeof *image);
  char **name = array_push((void **)&scene->image_names, n, sizeof *name);
  uint32_t *from = array_push((void **)&builder->image_sources, n, sizeof *from);
  if (!image || !name || !from) return document_out_of_memory(builder->doc);
  *name = string_copy(json_get_string(json, "name", uri));
  if (!*name) return document_out_of_memory(builder->doc);
  *from = source;
  builder->image_map[source] = *index = scene->image_count++;
  return CDL_OK;
}

static cdl_Status add_texture(Builder *builder, uint32_t source, uint32_t *index) {
  struct cdl_Scene *scene = builder->scene;
  const uint32_t known = builder->texture_map[source];
  *index = known == NOTED ? CDL_NONE : known;
  if (known != CDL_NONE) return CDL_OK;
  const json_t *root = builder->doc->root;
  const json_t *json = json_array_get(json_object_get(root, "textures"), source);
  const json_t *sampler =
      json_array_get(json_object_get(root, "samplers"), json_get_index(json, "sampler"));
  uint32_t image = texture_image(builder, json);
  if (image == CDL_NONE) return note_missing(builder, source, json);
  cdl_SceneTexture texture = {.wrap_s = wrap_mode(sampler, "wrapS"),
                              .wrap_t = wrap_mode(sampler, "wrapT"),
                              .nearest =
                                  json_get_number(sampler, "magFilter", 0) == FILTER_NEAREST};
  cdl_Status status = add_image(builder, image, &texture.image);
  if (status) return status;
  cdl_SceneTexture *slot =
      array_push((void **)&scene->textures, scene->texture_count, sizeof *slot);
  if (!slot) return document_out_of_memory(builder->doc);
  *slot = texture;
  builder->texture_map[source] = *index = scene->texture_count++;
  return CDL_OK;
}

/* KHR_texture_transform: translation * rotation * scale, v downwards. */
static void read_transform(const json_t *json, cdl_TextureRef *ref) {
  float offset[2] = {0, 0}, scale[2] = {1, 1};
  json_get_numbers(json, "offset", 2, offset);
  json_get_numbers(json, "scale", 2, scale);
  float c, s;
  angle_sincos(json_get_number(json, "rotation", 0), &s, &c);
  float m[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
  memcpy(ref->transform, m, sizeof m);
}

cdl_Status build_texture_ref(Builder *builder, const char *pointer, const json_t *info,
                             cdl_TextureRef *ref) {
  *ref = texture_ref_none();
  if (!info) return CDL_OK;
  const json_t *transform = json_get_extension(info, "KHR_texture_transform");
  if (transform) read_transform(transform, ref);
  ref->uv_set = (uint32_t)json_get_number(info, "texCoord", 0);
  ref->uv_set = (uint32_t)json_get_number(transform, "texCoord", ref->uv_set);
  cdl_Status status = add_texture(builder, json_get_index(info, "index"), &ref->texture);
  if (ref->uv_set > 1) {
    document_note(builder->doc, NULL, pointer,
                  "TEXCOORD_%u is not supported (0 and 1 are); the factor alone is used.",
                  ref->uv_set);
    *ref = texture_ref_none();
  }
  return status;
}

static cdl_Status decode_one(const Builder *builder, uint32_t index) {
  const Document *doc = builder->doc;
  uint32_t source = builder->image_sources[index];
  if (source == CDL_NONE || builder->scene->images[index]) return CDL_OK;
  char name[1024];
  snprintf(name, sizeof name, "%.900s: /images/%u", doc->path, source);
  const Bytes *bytes = &doc->images[source];
  return image_decode(doc->log, name, bytes->data, bytes->size, &builder->scene->images[index]);
}

/* Pictures are decoded at once on all cores: they take longer than everything else. */
cdl_Status build_images(Builder *builder) {
  int count = (int)builder->scene->image_count;
  int failed = 0;
#pragma omp parallel for schedule(dynamic) if (count > 1)
  for (int i = 0; i < count; i++) {
    int stop;
#pragma omp atomic read
    stop = failed;
    if (stop) continue;
    cdl_Status status = decode_one(builder, (uint32_t)i);
    if (status) {
#pragma omp atomic write
      failed = (int)status;
    }
  }
  return (cdl_Status)failed;
}
