#include "render/output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/image_write.h"

enum { MAX_ATTRIBUTES = 64, MAX_NAME = 64 };

cdl_Status layers_add(cdl_LayerList *list, cdl_ImageLayer layer, void *data, char *name) {
  if (data && list->count == list->capacity) {
    const int capacity = list->capacity ? 2 * list->capacity : 16;
    cdl_ImageLayer *layers = realloc(list->layers, (size_t)capacity * sizeof *layers);
    if (layers) list->layers = layers;
    char **names = realloc(list->names, (size_t)capacity * sizeof *names);
    if (names) list->names = names;
    if (layers && names) list->capacity = capacity;
  }
  if (!data || list->count == list->capacity) {
    free(data);
    free(name);
    return CDL_OUTPUT;
  }
  layer.data = data;
  if (name) layer.name = name;
  list->names[list->count] = name;
  list->layers[list->count++] = layer;
  return CDL_OK;
}

void layers_free(cdl_LayerList *list) {
  for (int i = 0; i < list->count; i++) {
    free((void *)list->layers[i].data);
    free(list->names[i]);
  }
  free(list->layers);
  free(list->names);
  *list = (cdl_LayerList){0};
}

float *interleave(const float *planes, size_t pixels, int channels) {
  float *out = malloc(pixels * (size_t)channels * sizeof *out);
  if (!out) return NULL;
  for (int c = 0; c < channels; c++)
    for (size_t i = 0; i < pixels; i++)
      out[i * (size_t)channels + (size_t)c] = planes[(size_t)c * pixels + i];
  return out;
}

static cdl_Status aov_layers(const cdl_Film *film, cdl_LayerList *list) {
  cdl_Status status = CDL_OK;
  for (int i = 0; i < CDL_AOV_COUNT && !status; i++)
    if (film->aovs & AOV_BIT(i))
      status = layers_add(list, aov_layer(i, NULL), film_resolve_aov(film, i), NULL);
  return status;
}

/* Header entries, named "candela.…". */
typedef struct Header {
  cdl_ImageAttribute entries[MAX_ATTRIBUTES];
  char names[MAX_ATTRIBUTES][MAX_NAME];
  int count;
  char *job, *statistics; /* JSON texts that entries point to */
} Header;

static cdl_ImageAttribute *header_entry(Header *header, const char *name, cdl_AttributeType type) {
  static cdl_ImageAttribute beyond;
  if (header->count == MAX_ATTRIBUTES) return &beyond;
  snprintf(header->names[header->count], MAX_NAME, "candela.%s", name);
  cdl_ImageAttribute *entry = &header->entries[header->count];
  *entry = (cdl_ImageAttribute){.name = header->names[header->count], .type = type};
  header->count++;
  return entry;
}

static void header_fill(Header *header, const json_t *from) {
  const char *name;
  json_t *value;
  json_object_foreach((json_t *)from, name, value) {
    if (json_is_string(value))
      header_entry(header, name, CDL_ATTRIBUTE_STRING)->string = json_string_value(value);
    if (json_is_integer(value))
      header_entry(header, name, CDL_ATTRIBUTE_INT)->integer = (int32_t)json_integer_value(value);
  }
}

/* What merging needs beside the layers. */
static cdl_Status header_fill_part(Header *header, const cdl_Picture *picture) {
  const cdl_Film *film = picture->film;
  header->job = json_dumps(picture->job, JSON_COMPACT | JSON_SORT_KEYS);
  header->statistics = json_dumps(picture->statistics, JSON_COMPACT);
  if (!header->job || !header->statistics) return CDL_OUTPUT;
  header_entry(header, "part.job", CDL_ATTRIBUTE_STRING)->string = header->job;
  header_entry(header, "part.statistics", CDL_ATTRIBUTE_STRING)->string = header->statistics;
  header_entry(header, "part.first_block", CDL_ATTRIBUTE_INT)->integer =
      film->part_count ? (int32_t)film->parts[0].index : 0;
  header_entry(header, "part.blocks", CDL_ATTRIBUTE_INT)->integer =
      (int32_t)film_complete_parts(film);
  return CDL_OK;
}

static cdl_Status write_layers(const cdl_Picture *picture, const char *path, Header *header) {
  cdl_LayerList list = {0};
  cdl_Status status = aov_layers(picture->film, &list);
  if (!status && picture->film->keep_blocks) {
    status = header_fill_part(header, picture);
    if (!status) status = part_layers(picture->film, &list);
  }
  if (status) {
    log_fail(picture->log, status, "%s: not enough memory for the picture's layers", path);
  } else {
    const cdl_ImagePicture image = {(int)picture->film->width,
                                    (int)picture->film->height,
                                    list.layers,
                                    list.count,
                                    header->entries,
                                    header->count};
    status = image_write_exr_layers(picture->log, path, &image);
  }
  layers_free(&list);
  return status;
}

static cdl_Status write_colors(const cdl_Picture *picture, const char *path,
                               const cdl_ToneSettings *tone, const Header *header) {
  float *rgb = film_resolve(picture->film);
  if (!rgb)
    return log_fail(picture->log, CDL_OUTPUT, "%s: not enough memory for the picture", path);
  cdl_Status status =
      image_write(picture->log, path, (int)picture->film->width, (int)picture->film->height, rgb,
                  tone, header->entries, header->count);
  free(rgb);
  return status;
}

cdl_Status picture_write(const cdl_Picture *picture, const char *path, const cdl_Display *display) {
  cdl_ToneSettings tone = {0};
  if (display) tone.exposure = (float)display->exposure;
  if (display && display->tonemap) {
    cdl_Status status = tonemap_parse(picture->log, display->tonemap, &tone.tonemap);
    if (status) return status;
  }
  Header *header = calloc(1, sizeof *header);
  if (!header)
    return log_fail(picture->log, CDL_OUTPUT, "%s: not enough memory for its header", path);
  header_fill(header, picture->header);
  cdl_Status status = image_is_exr(path) ? write_layers(picture, path, header)
                                         : write_colors(picture, path, &tone, header);
  free(header->job);
  free(header->statistics);
  free(header);
  return status;
}
