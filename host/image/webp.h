/* webp.h: WebP's colours where the picture is transparent. */
#ifndef CANDELA_IMAGE_WEBP_H
#define CANDELA_IMAGE_WEBP_H

#include "image/image.h"

/* Decodes with OpenImageIO, and once more with the alpha hidden where there is some, because its
 * reader multiplies alpha in, and glTF wants the colours as stored: in the worst case (alpha 0 on
 * an opaque material) they are all that counts. Otherwise as oiio_decode. */
cdl_Status webp_decode(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                       cdl_Image *image);

#endif
