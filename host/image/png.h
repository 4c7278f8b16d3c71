/* png.h: PNG files through libpng itself. OpenImageIO's PNG reader prints damaged files' faults to
 * standard error, where one line from us is all that may appear. */
#ifndef CANDELA_IMAGE_PNG_H
#define CANDELA_IMAGE_PNG_H

#include "image/image.h"

/* Fills `image`, which image_decode cleans up on failure: u8 for up to 8 bits a channel, f32
 * for 16. Palettes, grey and transparency keys become RGBA. */
cdl_Status png_decode(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                      cdl_Image *image);

#endif
