/* image_write.h: one RGB picture into whatever format its file name asks for. */
#ifndef CANDELA_IMAGE_IMAGE_WRITE_H
#define CANDELA_IMAGE_IMAGE_WRITE_H

#include "image/image_layers.h"
#include "image/tonemap.h"

#ifdef __cplusplus
extern "C" {
#endif

#define IMAGE_SUFFIXES ".exr, .hdr, .tif, .tiff, .png, .jpg or .jpeg"

/* To be called before a render starts: finds out that the suffix is known (CDL_USAGE), and that the
 * folder exists and takes a new file (CDL_OUTPUT). */
cdl_Status image_check_output(const cdl_Log *log, const char *path);

/* CDL_OUTPUT for a picture that is too large for the format. */
cdl_Status image_check_size(const cdl_Log *log, const char *path, int width, int height);

/* Whether `path` ends in .exr, so that image_write_exr_layers can keep all layers. */
int image_is_exr(const char *path);

/* Writes `rgb` (height × width × 3, linear, rows from the top) by the suffix of `path`, all at
 * once. .exr  linear float channels R, G, B, ZIP compressed, with the attributes in the header .tif
 * linear float; .hdr  linear, 8 bits a channel and a shared exponent: NaN and negative values
 * become 0 .png .jpg (quality 95)  exposure, tone map, sRGB encoding, 8 bits; `tone` NULL is as
 * stored, clipped Other formats than EXR keep the attributes as a description where they have a
 * place for it. CDL_USAGE for an unknown suffix, CDL_OUTPUT if it cannot be written; no file is
 * left then. */
cdl_Status image_write(const cdl_Log *log, const char *path, int width, int height,
                       const float *rgb, const cdl_ToneSettings *tone,
                       const cdl_ImageAttribute *attributes, int attribute_count);

#ifdef __cplusplus
}
#endif
#endif
