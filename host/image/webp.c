#include "image/webp.h"

#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/oiio.h"

#define RIFF_HEADER 12
#define CHUNK_HEADER 8
#define VP8X_ALPHA 0x10u      /* in the flags, first byte of VP8X */
#define VP8L_SIGNATURE 0x2fu  /* first byte of VP8L */
#define VP8L_ALPHA_USED 0x10u /* in byte 4 of VP8L, after 14 bits of width and 14 of height */

static size_t chunk_size(const unsigned char *chunk) {
  const unsigned char *size = chunk + 4;
  return (size_t)size[0] | (size_t)size[1] << 8 | (size_t)size[2] << 16 | (size_t)size[3] << 24;
}

/* Takes every hint of alpha out of a WebP file in place (RFC 9649: VP8X flag, ALPH chunk, VP8L
 * header bit); the coded colours are untouched. Returns whether there was one. */
static int hide_alpha(unsigned char *bytes, size_t size) {
  int found = 0;
  for (size_t at = RIFF_HEADER; at + CHUNK_HEADER < size;) {
    unsigned char *chunk = bytes + at, *body = chunk + CHUNK_HEADER;
    size_t length = chunk_size(chunk), left = size - at - CHUNK_HEADER;
    if (memcmp(chunk, "VP8X", 4) == 0 && (body[0] & VP8X_ALPHA)) {
      body[0] &= (unsigned char)~VP8X_ALPHA;
      found = 1;
    } else if (memcmp(chunk, "ALPH", 4) == 0) {
      memcpy(chunk, "NONE", 4);
      found = 1;
    } else if (memcmp(chunk, "VP8L", 4) == 0 && left > 4 && body[0] == VP8L_SIGNATURE &&
               (body[4] & VP8L_ALPHA_USED)) {
      body[4] &= (unsigned char)~VP8L_ALPHA_USED;
      found = 1;
    }
    if (length > left) break;
    at += CHUNK_HEADER + length + (length & 1);
  }
  return found;
}

static void take_colours(cdl_Image *image, const cdl_Image *opaque) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  for (size_t i = 0; i < pixels; i++) memcpy(image->u8 + 4 * i, opaque->u8 + 4 * i, 3);
}

cdl_Status webp_decode(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                       cdl_Image *image) {
  cdl_Image opaque = {0};
  unsigned char *copy = NULL;
  cdl_Status status = oiio_decode(log, name, "webp", bytes, size, image);
  if (status != CDL_OK) return status;
  copy = malloc(size);
  if (!copy) {
    status = log_fail(log, CDL_BAD_INPUT, "%s: not enough memory for the picture", name);
    goto done;
  }
  memcpy(copy, bytes, size);
  if (!hide_alpha(copy, size)) goto done;
  status = oiio_decode(log, name, "webp", copy, size, &opaque);
  if (status != CDL_OK) goto done;
  if (!image->u8 || !opaque.u8 || opaque.width != image->width || opaque.height != image->height) {
    status = log_fail(log, CDL_BAD_INPUT, "%s: IMAGE_DATA_INVALID: WebP: alpha does not fit", name);
    goto done;
  }
  take_colours(image, &opaque);
done:
  free(opaque.u8);
  free(opaque.f32);
  free(copy);
  return status;
}
