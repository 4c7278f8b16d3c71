/* oiio.h: the few things that this folder asks of OpenImageIO; oiio.cpp alone sees the library.
 * Nothing throws across this line. */
#ifndef CANDELA_IMAGE_OIIO_H
#define CANDELA_IMAGE_OIIO_H

#include "image/image.h"
#include "image/image_layers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decodes with the reader called `format` ("jpeg", "openexr", "hdr", "webp") into `image`, which
 * image_decode cleans up on failure. Values come as that reader gives them. */
cdl_Status oiio_decode(const cdl_Log *log, const char *name, const char *format, const void *bytes,
                       size_t size, cdl_Image *image);

/* Fills `image` (zeroed by the caller, who also frees it on failure) from an EXR file in memory. */
cdl_Status oiio_read_layers(const cdl_Log *log, const char *name, const void *bytes, size_t size,
                            cdl_ExrImage *image);

/* Encodes in memory and writes with image_file_write. */
cdl_Status oiio_write_layers(const cdl_Log *log, const char *path, const cdl_ImagePicture *picture);

/* The same for one RGB picture: `rgb` is height × width × 3, float, or uint8_t when `bits8`.
 * `format` is "png", "jpeg" (quality 95), "tiff" or "hdr"; `description` may be NULL and is stored
 * where the format has a place for it. */
cdl_Status oiio_write_rgb(const cdl_Log *log, const char *path, const char *format, int width,
                          int height, int bits8, const void *rgb, const char *description);

#ifdef __cplusplus
}
#endif
#endif
