#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* memmem */
#endif

#include "image/image.h"

#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/image_file.h"
#include "image/oiio.h"
#include "image/png.h"
#include "image/webp.h"

#define IMAGE_MAX_BYTES ((size_t)1 << 30)

typedef enum { UNKNOWN, REFUSED, PNG, JPEG, WEBP, EXR, HDR } Kind;

typedef struct {
  Kind kind;
  const char *name;
  size_t offset, length;
  const char *magic;
} Format;

/* What a file starts with. Those that are refused are known in order to be called by their name. */
static const Format formats[] = {
    {PNG, "PNG", 0, 8, "\x89PNG\r\n\x1a\n"},
    {JPEG, "JPEG", 0, 3, "\xff\xd8\xff"},
    {WEBP, "WebP", 8, 4, "WEBP"},
    {EXR, "OpenEXR", 0, 4, "\x76\x2f\x31\x01"},
    {HDR, "Radiance HDR", 0, 10, "#?RADIANCE"},
    {HDR, "Radiance HDR", 0, 6, "#?RGBE"},
    {REFUSED, "KTX2", 0, 7, "\xabKTX 20"},
    {REFUSED, "KTX", 0, 7, "\xabKTX 11"},
    {REFUSED, "Basis", 0, 2, "sB"},
    {REFUSED, "DDS", 0, 4, "DDS "},
    {REFUSED, "GIF", 0, 4, "GIF8"},
    {REFUSED, "TIFF", 0, 4, "II*\0"},
    {REFUSED, "TIFF", 0, 4, "MM\0*"},
    {REFUSED, "AVIF or HEIF", 4, 4, "ftyp"},
    {REFUSED, "JPEG 2000", 4, 4, "jP  "},
    {REFUSED, "JPEG XL", 4, 4, "JXL "},
    {REFUSED, "Photoshop", 0, 4, "8BPS"},
    {REFUSED, "BMP", 0, 2, "BM"},
};

static const Format *recognize(const unsigned char *bytes, size_t size) {
  static const Format unknown = {UNKNOWN, "", 0, 0, ""};
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
    const Format *format = &formats[i];
    if (size >= format->offset + format->length &&
        memcmp(bytes + format->offset, format->magic, format->length) == 0)
      return format;
  }
  return &unknown;
}

#define JPEG_START_OF_SCAN 0xda
#define JPEG_MAX_PIXELS_PER_BYTE 512 /* a bit for each 8 x 8 block: a flat progressive picture */

static int is_frame_header(unsigned char marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/* The JPEG reader fills what is missing with grey and says nothing; so the end marker is looked for
 * behind the first scan, and a file too short for its size is refused before it takes memory. */
static cdl_Status check_jpeg(const cdl_Log *log, const char *name, const unsigned char *bytes,
                             size_t size) {
  size_t at = 2, pixels = 0;
  while (at + 9 <= size && bytes[at] == 0xff && bytes[at + 1] != JPEG_START_OF_SCAN) {
    const unsigned char *segment = bytes + at;
    if (is_frame_header(segment[1]))
      pixels = ((size_t)segment[5] << 8 | segment[6]) * ((size_t)segment[7] << 8 | segment[8]);
    at += segment[1] == 0xff ? 1 : 2 + ((size_t)segment[2] << 8 | segment[3]);
  }
  if (at < size && memmem(bytes + at, size - at, "\xff\xd9", 2) &&
      pixels / JPEG_MAX_PIXELS_PER_BYTE <= size)
    return CDL_OK;
  return log_fail(log, CDL_BAD_INPUT, "%s: IMAGE_DATA_INVALID: JPEG: the file ends too soon", name);
}

static cdl_Status refuse(const cdl_Log *log, const char *name, const Format *format) {
  static const char cure[] = "use PNG, JPEG, WebP, OpenEXR or Radiance HDR";
  if (format->kind == REFUSED)
    return log_fail(log, CDL_BAD_INPUT,
                    "%s: IMAGE_UNRECOGNIZED_FORMAT: %s textures are not supported; %s", name,
                    format->name, cure);
  return log_fail(log, CDL_BAD_INPUT, "%s: IMAGE_UNRECOGNIZED_FORMAT: not a known image format; %s",
                  name, cure);
}

static cdl_Status decode_as(const cdl_Log *log, const char *name, const Format *format,
                            const void *bytes, size_t size, cdl_Image *image) {
  cdl_Status status;
  image->encoded = format->kind == PNG || format->kind == JPEG || format->kind == WEBP;
  switch (format->kind) {
  case PNG:
    return png_decode(log, name, bytes, size, image);
  case WEBP:
    return webp_decode(log, name, bytes, size, image);
  case EXR:
    return oiio_decode(log, name, "openexr", bytes, size, image);
  case HDR:
    return oiio_decode(log, name, "hdr", bytes, size, image);
  case JPEG:
    status = check_jpeg(log, name, bytes, size);
    return status == CDL_OK ? oiio_decode(log, name, "jpeg", bytes, size, image) : status;
  case UNKNOWN:
  case REFUSED:
    break;
  }
  return refuse(log, name, format);
}

cdl_Status image_decode(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                        cdl_Image **image) {
  *image = NULL;
  if (size == 0) return log_fail(log, CDL_BAD_INPUT, "%s: IMAGE_DATA_INVALID: no data", name);
  cdl_Image *decoded = calloc(1, sizeof *decoded);
  if (!decoded) return log_fail(log, CDL_BAD_INPUT, "%s: not enough memory for the picture", name);
  cdl_Status status = decode_as(log, name, recognize(bytes, size), bytes, size, decoded);
  if (status == CDL_OK)
    *image = decoded;
  else
    image_free(decoded);
  return status;
}

cdl_Status image_load(const cdl_Log *log, const char *path, cdl_Image **image) {
  unsigned char *bytes = NULL;
  size_t size = 0;
  *image = NULL;
  cdl_Status status = image_file_read(log, path, IMAGE_MAX_BYTES, &bytes, &size);
  if (status == CDL_OK) status = image_decode(log, path, bytes, size, image);
  free(bytes);
  return status;
}

void image_free(cdl_Image *image) {
  if (!image) return;
  free(image->u8);
  free(image->f32);
  free(image);
}
