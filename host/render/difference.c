/* Comparing two picture files. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/compare.h"
#include "image/image.h"
#include "image/image_write.h"

typedef struct Pixels {
  int width, height, channels;
  float *values; /* interleaved */
} Pixels;

static cdl_Status no_memory(const cdl_Log *log, const char *path) {
  return log_fail(log, CDL_BAD_INPUT, "%s: not enough memory to compare it", path);
}

/* Whether a channel, "albedo.R", is of the layer; the main layer's have no dot. */
static int in_layer(const char *channel, const char *layer) {
  const char *dot = strrchr(channel, '.');
  if (!layer || !*layer) return !dot;
  return dot && (size_t)(dot - channel) == strlen(layer) && !strncmp(channel, layer, strlen(layer));
}

/* The channels of a layer: R, G, B first, so that the luminance is made of the right ones. */
static int find_channels(const cdl_ExrImage *image, const char *layer,
                         const cdl_ExrChannel **found) {
  static const char order[] = "RGBXYZ";
  int count = 0;
  for (const char *letter = order; *letter && count < 3; letter++) {
    for (int i = 0; i < image->channel_count && count < 3; i++) {
      const char *name = image->channels[i].name, *dot = strrchr(name, '.');
      if (in_layer(name, layer) && !strcmp(dot ? dot + 1 : name, (char[]){*letter, 0}))
        found[count++] = &image->channels[i];
    }
  }
  for (int i = 0; i < image->channel_count && !count; i++)
    if (in_layer(image->channels[i].name, layer)) found[count++] = &image->channels[i];
  return count;
}

static cdl_Status load_layer(const cdl_Log *log, const char *path, const char *layer,
                             Pixels *pixels) {
  cdl_ExrImage *image = NULL;
  const cdl_ExrChannel *found[3];
  cdl_Status status = image_read_exr_layers(log, path, &image);
  if (status) return status;
  const int channels = find_channels(image, layer, found);
  const size_t count = (size_t)image->width * (size_t)image->height;
  *pixels = (Pixels){image->width, image->height, channels, NULL};
  if (!channels)
    status = log_fail(log, CDL_BAD_INPUT, "%s: has no layer '%s'", path, layer ? layer : "");
  else if (!(pixels->values = malloc(count * (size_t)channels * sizeof(float))))
    status = no_memory(log, path);
  for (int c = 0; !status && c < channels; c++)
    for (size_t i = 0; i < count; i++)
      pixels->values[i * (size_t)channels + (size_t)c] =
          found[c]->f32 ? found[c]->f32[i] : (float)found[c]->u32[i];
  image_exr_free(image);
  return status;
}

/* Code values of 8 or 16 bits become linear. */
static float linear_value(const cdl_Image *image, size_t at) {
  const float value = image->u8 ? (float)image->u8[at] / 255.0f : image->f32[at];
  return image->encoded ? tonemap_srgb_decode(value) : value;
}

static cdl_Status load_picture(const cdl_Log *log, const char *path, Pixels *pixels) {
  cdl_Image *image = NULL;
  cdl_Status status = image_load(log, path, &image);
  if (status) return status;
  const size_t count = (size_t)image->width * (size_t)image->height;
  *pixels = (Pixels){image->width, image->height, 3, malloc(count * 3 * sizeof(float))};
  if (!pixels->values) status = no_memory(log, path);
  for (size_t i = 0; !status && i < count; i++)
    for (size_t c = 0; c < 3; c++)
      pixels->values[3 * i + c] = linear_value(image, (size_t)image->channels * i + c);
  image_free(image);
  return status;
}

static cdl_Status load(const cdl_Log *log, const char *path, const char *layer, Pixels *pixels) {
  if (image_is_exr(path)) return load_layer(log, path, layer, pixels);
  if (layer)
    return log_fail(log, CDL_USAGE, "%s: only .exr files have layers such as '%s'", path, layer);
  return load_picture(log, path, pixels);
}

static void convert(const cdl_ImageMetrics *from, int channels, cdl_Difference *to) {
  *to = (cdl_Difference){.identical = from->identical,
                         .pixels = from->pixels,
                         .finite_pixels = from->finite_pixels,
                         .nonfinite = {from->nonfinite[0], from->nonfinite[1]},
                         .mse = from->mse,
                         .rmse = from->rmse,
                         .relative_mse = from->relative_mse,
                         .max_abs = from->max_abs,
                         .max_x = (uint32_t)from->max_x,
                         .max_y = (uint32_t)from->max_y,
                         .psnr = from->psnr,
                         .ssim = from->ssim};
  for (int c = 0; c < channels; c++) {
    to->mean[0] += from->mean[0][c] / channels;
    to->mean[1] += from->mean[1][c] / channels;
    to->bias += from->bias[c] / channels;
  }
}

cdl_Status cdl_compare(const cdl_Log *log, const char *a, const char *b, const char *layer,
                       cdl_Difference *difference) {
  Pixels p = {0}, q = {0};
  cdl_ImageMetrics metrics;
  cdl_Status status = load(log, a, layer, &p);
  if (!status) status = load(log, b, layer, &q);
  if (!status && (p.width != q.width || p.height != q.height || p.channels != q.channels))
    status = log_fail(log, CDL_DIFFERENT, "%s is %d x %d with %d channels, %s %d x %d with %d", a,
                      p.width, p.height, p.channels, b, q.width, q.height, q.channels);
  if (!status)
    status = image_compare(log, p.width, p.height, p.channels, p.values, q.values, &metrics);
  if (!status) convert(&metrics, p.channels, difference);
  free(p.values);
  free(q.values);
  return status;
}
