#include "image/png.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"

/* Deflate makes at most 1032 bytes out of one: a file too short for its size is damaged, and is
 * refused before memory is taken for it. */
#define DEFLATE_MAX_RATIO 1032

typedef struct {
  const unsigned char *at;
  size_t left;
  char fault[200];
} Source;

static void take_bytes(png_structp png, png_bytep to, size_t count) {
  Source *source = png_get_io_ptr(png);
  if (count > source->left) png_error(png, "the file ends too soon");
  memcpy(to, source->at, count);
  source->at += count;
  source->left -= count;
}

static void keep_fault(png_structp png, png_const_charp message) {
  Source *source = png_get_error_ptr(png);
  snprintf(source->fault, sizeof source->fault, "%s", message);
  png_longjmp(png, 1);
}

/* Warnings concern what we do not use: colour profiles, text, times. */
static void ignore_warning(png_structp png, png_const_charp message) {
  (void)png;
  (void)message;
}

/* Asks libpng for RGBA, 8 or 16 bits a channel, whatever is stored. */
static void request_rgba(png_structp png, png_infop info) {
  int depth = png_get_bit_depth(png, info);
  png_set_expand(png);
  if (!(png_get_color_type(png, info) & PNG_COLOR_MASK_COLOR)) png_set_gray_to_rgb(png);
  png_set_add_alpha(png, depth == 16 ? 0xffff : 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

static void check_size(png_structp png, png_infop info, size_t file_size, cdl_Image *image) {
  size_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
  size_t bits = (size_t)png_get_bit_depth(png, info) * png_get_channels(png, info);
  if (width * height > IMAGE_MAX_PIXELS) png_error(png, "more than 512 Mpixel");
  if (height * ((width * bits + 7) / 8) / DEFLATE_MAX_RATIO > file_size)
    png_error(png, "the file is too short for its size in pixels");
  image->width = (int)width;
  image->height = (int)height;
  image->channels = 4;
  image->encoded = 1;
}

static void read_rows(png_structp png, const cdl_Image *image, unsigned char *pixels, size_t row) {
  int passes = png_set_interlace_handling(png);
  for (int pass = 0; pass < passes; pass++)
    for (int y = 0; y < image->height; y++) png_read_row(png, pixels + (size_t)y * row, NULL);
  png_read_end(png, NULL);
}

static void read_picture(png_structp png, png_infop info, size_t file_size, cdl_Image *image,
                         unsigned char **pixels) {
  png_set_user_limits(png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
  png_read_info(png, info);
  check_size(png, info, file_size, image);
  request_rgba(png, info);
  size_t row = png_get_rowbytes(png, info);
  *pixels = calloc((size_t)image->height, row);
  if (!*pixels) png_error(png, "not enough memory");
  read_rows(png, image, *pixels, row);
  if (png_get_bit_depth(png, info) == 8) {
    image->u8 = *pixels;
    *pixels = NULL;
  }
}

/* PNG stores 16 bits with the high byte first. */
static cdl_Status widen(const cdl_Log *log, const char *name, const unsigned char *pixels,
                        cdl_Image *image) {
  size_t count = (size_t)image->width * (size_t)image->height * 4;
  image->f32 = malloc(count * sizeof(float));
  if (!image->f32)
    return log_fail(log, CDL_BAD_INPUT, "%s: not enough memory for the picture", name);
  for (size_t i = 0; i < count; i++)
    image->f32[i] = (float)(pixels[2 * i] << 8 | pixels[2 * i + 1]) / 65535.0f;
  return CDL_OK;
}

cdl_Status png_decode(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                      cdl_Image *image) {
  Source source = {bytes, size, ""};
  /* On the heap: what changes between setjmp and longjmp must not live in registers. */
  unsigned char **pixels = calloc(1, sizeof *pixels);
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_fault, ignore_warning);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  cdl_Status status = CDL_BAD_INPUT;
  if (!pixels || !info) {
    log_fail(log, status, "%s: not enough memory for the picture", name);
    goto done;
  }
  if (setjmp(png_jmpbuf(png))) {
    log_fail(log, status, "%s: IMAGE_DATA_INVALID: PNG: %s", name, source.fault);
    goto done;
  }
  png_set_read_fn(png, &source, take_bytes);
  read_picture(png, info, size, image, pixels);
  status = *pixels ? widen(log, name, *pixels, image) : CDL_OK;
done:
  png_destroy_read_struct(&png, &info, NULL);
  if (pixels) free(*pixels);
  free(pixels);
  return status;
}
