#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* open_memstream, strcasecmp */
#endif

#include "image/image_write.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/log.h"
#include "image/aov.h"
#include "image/image_file.h"
#include "image/oiio.h"

#define HDR_MAX 1e38f /* what a Radiance pixel's shared exponent reaches */

typedef enum { LAYERS, LINEAR, SHARED_EXPONENT, DISPLAY } Encoding;

typedef struct {
  const char *suffix, *format;
  Encoding encoding;
} Target;

static const Target targets[] = {
    {".exr", "openexr", LAYERS}, {".hdr", "hdr", SHARED_EXPONENT}, {".tif", "tiff", LINEAR},
    {".tiff", "tiff", LINEAR},   {".png", "png", DISPLAY},         {".jpg", "jpeg", DISPLAY},
    {".jpeg", "jpeg", DISPLAY},
};

static const Target *find_target(const char *path) {
  const char *slash = strrchr(path, '/'), *suffix = strrchr(slash ? slash : path, '.');
  for (size_t i = 0; suffix && i < sizeof targets / sizeof *targets; i++)
    if (strcasecmp(suffix, targets[i].suffix) == 0) return &targets[i];
  return NULL;
}

static cdl_Status refuse_suffix(const cdl_Log *log, const char *path) {
  return log_fail(log, CDL_USAGE, "%s: unknown image format; the name must end in " IMAGE_SUFFIXES,
                  path);
}

/* libjpeg would end the program. */
enum { JPEG_MAX = 65500 };

cdl_Status image_check_size(const cdl_Log *log, const char *path, int width, int height) {
  const Target *target = find_target(path);
  if (!target || strcmp(target->format, "jpeg") || (width <= JPEG_MAX && height <= JPEG_MAX))
    return CDL_OK;
  return log_fail(log, CDL_OUTPUT, "%s: JPEG holds at most %d pixels on a side; write a .png", path,
                  JPEG_MAX);
}

cdl_Status image_check_output(const cdl_Log *log, const char *path) {
  if (!find_target(path)) return refuse_suffix(log, path);
  return image_file_probe(log, path);
}

int image_is_exr(const char *path) {
  const Target *target = find_target(path);
  return target && target->encoding == LAYERS;
}

/* "name=value; name=value", malloc'ed; NULL when there is nothing to tell. */
static char *describe(const cdl_ImageAttribute *attributes, int count) {
  char *text = NULL;
  size_t size;
  FILE *stream = count ? open_memstream(&text, &size) : NULL;
  if (!stream) return NULL;
  for (int i = 0; i < count; i++) {
    const cdl_ImageAttribute *entry = &attributes[i];
    fprintf(stream, "%s%s=", i ? "; " : "", entry->name);
    if (entry->type == CDL_ATTRIBUTE_STRING) fputs(entry->string, stream);
    if (entry->type == CDL_ATTRIBUTE_INT) fprintf(stream, "%d", entry->integer);
    if (entry->type == CDL_ATTRIBUTE_FLOAT) fprintf(stream, "%.9g", (double)entry->real);
  }
  fclose(stream);
  return text;
}

static void limit_range(const float *from, size_t count, float *to) {
  for (size_t i = 0; i < count; i++)
    to[i] = isnan(from[i]) ? 0.0f : fminf(fmaxf(from[i], 0.0f), HDR_MAX);
}

/* What the format stores, malloc'ed: 8-bit code values, or floats in range. */
static void *convert(Encoding encoding, const float *rgb, size_t pixels,
                     const cdl_ToneSettings *tone) {
  static const cdl_ToneSettings plain = {0.0f, CDL_TONEMAP_NONE};
  void *data = malloc(pixels * 3 * (encoding == DISPLAY ? 1 : sizeof(float)));
  if (data && encoding == DISPLAY) tonemap_to_srgb8(tone ? tone : &plain, rgb, pixels, data);
  if (data && encoding == SHARED_EXPONENT) limit_range(rgb, pixels * 3, data);
  return data;
}

cdl_Status image_write(const cdl_Log *log, const char *path, int width, int height,
                       const float *rgb, const cdl_ToneSettings *tone,
                       const cdl_ImageAttribute *attributes, int attribute_count) {
  const Target *target = find_target(path);
  if (!target) return refuse_suffix(log, path);
  if (image_check_size(log, path, width, height)) return CDL_OUTPUT;
  if (target->encoding == LAYERS) {
    const cdl_ImageLayer layer = aov_layer(CDL_AOV_BEAUTY, rgb);
    const cdl_ImagePicture picture = {width, height, &layer, 1, attributes, attribute_count};
    return image_write_exr_layers(log, path, &picture);
  }
  cdl_Status status;
  char *description = describe(attributes, attribute_count);
  void *data = NULL;
  if (target->encoding != LINEAR) {
    data = convert(target->encoding, rgb, (size_t)width * (size_t)height, tone);
    if (!data) {
      status = log_fail(log, CDL_OUTPUT, "%s: not enough memory for the picture", path);
      goto done;
    }
  }
  status = oiio_write_rgb(log, path, target->format, width, height, target->encoding == DISPLAY,
                          data ? data : rgb, description);
done:
  free(data);
  free(description);
  return status;
}
