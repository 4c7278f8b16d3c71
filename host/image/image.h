/* image.h: pictures decoded for textures and environments. */
#ifndef CANDELA_IMAGE_IMAGE_H
#define CANDELA_IMAGE_IMAGE_H

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

#define IMAGE_MAX_SIDE 65536
#define IMAGE_MAX_PIXELS ((size_t)512 << 20)

/* A decoded picture: row-major from the top left, RGBA interleaved. Exactly one of `u8` and `f32`
 * is set. Grey is spread over R, G and B, a missing alpha is 1, and alpha is never multiplied in.
 *   u8   8-bit code values as stored in the file (PNG, JPEG, WebP): colours are still sRGB encoded.
 *   f32  OpenEXR and Radiance HDR: linear values as stored, alpha associated where EXR says so;
 *        16-bit PNG: code values over 65535, still sRGB encoded (`encoded` is 1). */
typedef struct cdl_Image {
  int width, height;
  int channels; /* 4 */
  int encoded;  /* 1: code values of a display encoding (PNG, JPEG, WebP); 0: linear (EXR, HDR) */
  uint8_t *u8;
  float *f32;
} cdl_Image;

/* Decodes a PNG, JPEG, WebP, OpenEXR or Radiance HDR file held in memory; the content decides
 * which, not `name`, which only starts the messages. Of an EXR the channels R, G, B, A or Y of the
 * first part are taken, else those of its first layer that has them. On success *image belongs to
 * the caller (image_free); on failure it is NULL and the status CDL_BAD_INPUT, with the code
 * IMAGE_DATA_INVALID or IMAGE_UNRECOGNIZED_FORMAT in the message. May be called from any thread. */
cdl_Status image_decode(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                        cdl_Image **image);

/* Reads the regular file `path` (at most 1 GiB) and decodes it as image_decode does. */
cdl_Status image_load(const cdl_Log *log, const char *path, cdl_Image **image);

/* Frees; NULL is allowed. */
void image_free(cdl_Image *image);

#ifdef __cplusplus
}
#endif
#endif
