#include "render/parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "render/job.h"
#include "render/output.h"

static char *layer_name(uint32_t block, const cdl_Aov *aov) {
  char name[64];
  snprintf(name, sizeof name, "block.%06u%s%s", block, *aov->layer ? "." : "", aov->layer);
  return strdup(name);
}

cdl_Status part_layers(const cdl_Film *film, cdl_LayerList *list) {
  const size_t pixels = (size_t)film->width * film->height;
  const uint32_t blocks = film_complete_parts(film);
  for (uint32_t b = 0; b < blocks; b++) {
    for (int i = 0; i < CDL_AOV_COUNT; i++) {
      const int channel = film_channel(film, i);
      if (channel < 0) continue;
      const float *sums = film->parts[b].sums + (size_t)channel * pixels;
      char *name = layer_name(film->parts[b].index, &aov_table[i]);
      cdl_ImageLayer layer = aov_layer(i, NULL);
      layer.type = CDL_CHANNEL_FLOAT;
      if (!name) return CDL_OUTPUT;
      cdl_Status status = layers_add(list, layer, interleave(sums, pixels, layer.channels), name);
      if (status) return status;
    }
  }
  return CDL_OK;
}

/* A JSON object in a header entry; NULL if there is none. */
static json_t *header_object(const cdl_ExrImage *image, const char *name) {
  const cdl_ImageAttribute *entry = image_exr_attribute(image, name);
  if (!entry || entry->type != CDL_ATTRIBUTE_STRING) return NULL;
  json_t *json = json_loads(entry->string, 0, NULL);
  if (json_is_object(json)) return json;
  json_decref(json);
  return NULL;
}

static uint32_t header_count(const cdl_ExrImage *image, const char *name) {
  const cdl_ImageAttribute *entry = image_exr_attribute(image, name);
  return entry && entry->type == CDL_ATTRIBUTE_INT && entry->integer > 0 ? (uint32_t)entry->integer
                                                                         : 0;
}

/* All entries "candela.NAME" but those of parts. */
static json_t *header_entries(const cdl_ExrImage *image) {
  json_t *header = json_object();
  for (int i = 0; i < image->attribute_count; i++) {
    const cdl_ImageAttribute *entry = &image->attributes[i];
    if (strncmp(entry->name, "candela.", 8) || !strncmp(entry->name, "candela.part.", 13)) continue;
    if (entry->type == CDL_ATTRIBUTE_STRING)
      json_object_set_new(header, entry->name + 8, json_string(entry->string));
    if (entry->type == CDL_ATTRIBUTE_INT)
      json_object_set_new(header, entry->name + 8, json_integer(entry->integer));
  }
  return header;
}

static cdl_Status part_describe(const cdl_Log *log, const char *path, const cdl_ExrImage *image,
                                cdl_Part *part) {
  *part = (cdl_Part){.path = path,
                     .job = header_object(image, "candela.part.job"),
                     .statistics = header_object(image, "candela.part.statistics"),
                     .header = header_entries(image),
                     .first = header_count(image, "candela.part.first_block"),
                     .count = header_count(image, "candela.part.blocks")};
  cdl_Status status = CDL_OK;
  const uint32_t samples = job_integer(part->job, "samples");
  const uint32_t blocks = samples / CDL_FILM_BLOCK + (samples % CDL_FILM_BLOCK != 0);
  if (!part->job || !part->statistics || !part->header)
    status =
        log_fail(log, CDL_BAD_INPUT,
                 "%s: is no partial film; candela render --samples FIRST:COUNT writes those", path);
  else if (part->count == 0)
    status =
        log_fail(log, CDL_BAD_INPUT, "%s: has no finished block; render this part again", path);
  else if (part->count > blocks || part->first > blocks - part->count)
    status = log_fail(log, CDL_BAD_INPUT, "%s: is damaged: it has blocks beyond its %u samples",
                      path, samples);
  if (status) part_clear(part);
  return status;
}

cdl_Status part_read(const cdl_Log *log, const char *path, cdl_Part *part, cdl_ExrImage **image) {
  cdl_ExrImage *read = NULL;
  *part = (cdl_Part){0};
  cdl_Status status = image_read_exr_layers(log, path, &read);
  if (status) return status;
  status = part_describe(log, path, read, part);
  if (!status && image)
    *image = read;
  else
    image_exr_free(read);
  return status;
}

void part_clear(cdl_Part *part) {
  json_decref(part->job);
  json_decref(part->statistics);
  json_decref(part->header);
  *part = (cdl_Part){0};
}

/* The planes of one AOV of one block, put where the film has its channels. */
static cdl_Status read_aov(const cdl_Log *log, const cdl_Part *part, const cdl_ExrImage *image,
                           uint32_t block, const cdl_Aov *aov, float *planes) {
  const size_t pixels = (size_t)image->width * (size_t)image->height;
  for (int c = 0; c < aov->channels; c++) {
    char name[96];
    snprintf(name, sizeof name, "block.%06u%s%s.%s", block, *aov->layer ? "." : "", aov->layer,
             aov->channel[c]);
    const cdl_ExrChannel *channel = image_exr_channel(image, name);
    if (!channel || !channel->f32 || channel->type != CDL_CHANNEL_FLOAT)
      return log_fail(log, CDL_BAD_INPUT, "%s: is damaged: it lacks the channel %s", part->path,
                      name);
    memcpy(planes + (size_t)c * pixels, channel->f32, pixels * sizeof *planes);
  }
  return CDL_OK;
}

cdl_Status part_add(const cdl_Log *log, const cdl_Part *part, const cdl_ExrImage *image,
                    cdl_Film *film) {
  const size_t pixels = (size_t)film->width * film->height;
  const uint32_t samples = job_integer(part->job, "samples");
  if ((uint32_t)image->width != film->width || (uint32_t)image->height != film->height)
    return log_fail(log, CDL_BAD_INPUT, "%s: is of %d x %d pixels, the other parts of %u x %u",
                    part->path, image->width, image->height, film->width, film->height);
  float *sums = malloc(pixels * film->channels * sizeof *sums);
  if (!sums) return log_fail(log, CDL_DEVICE, "not enough memory to merge %s", part->path);
  cdl_Status status = CDL_OK;
  for (uint32_t b = part->first; b < part->first + part->count && !status; b++) {
    for (int i = 0; i < CDL_AOV_COUNT && !status; i++) {
      const int channel = film_channel(film, i);
      if (channel >= 0)
        status = read_aov(log, part, image, b, &aov_table[i], sums + (size_t)channel * pixels);
    }
    const uint32_t rest = samples - b * CDL_FILM_BLOCK;
    if (!status)
      status = film_add(film, b, rest < CDL_FILM_BLOCK ? rest : CDL_FILM_BLOCK, 0, (uint32_t)pixels,
                        sums, pixels);
  }
  free(sums);
  return status;
}
