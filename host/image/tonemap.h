/* tonemap.h: from scene-linear radiance to what a display shows. */
#ifndef CANDELA_IMAGE_TONEMAP_H
#define CANDELA_IMAGE_TONEMAP_H

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Colours are linear with Rec. 709 primaries (those of sRGB) throughout. */
typedef enum cdl_ToneMap {
  CDL_TONEMAP_NONE,   /* clips at 1 */
  CDL_TONEMAP_ACES,   /* ACES reference rendering and output transform, Hill's fit */
  CDL_TONEMAP_AGX,    /* AgX, default look */
  CDL_TONEMAP_NEUTRAL /* Khronos PBR Neutral */
} cdl_ToneMap;

typedef struct cdl_ToneSettings {
  float exposure; /* EV: values are multiplied by 2^exposure before the curve */
  cdl_ToneMap tonemap;
} cdl_ToneSettings;

/* "none", "aces", "agx", "neutral" -> *tonemap; CDL_USAGE for anything else. */
cdl_Status tonemap_parse(const cdl_Log *log, const char *name, cdl_ToneMap *tonemap);

/* Maps one colour in place to display-linear values within 0..1. Any float may come in: NaN and
 * negative values count as 0, infinity as the brightest. Black stays exactly black. */
void tonemap_apply(const cdl_ToneSettings *settings, float rgb[3]);

/* sRGB's transfer function (IEC 61966-2-1), 0..1 to 0..1, both ways. */
float tonemap_srgb_encode(float linear);
float tonemap_srgb_decode(float encoded);

/* tonemap_apply, sRGB encoding and rounding to the nearest of 256 for `pixels` RGB colours. */
void tonemap_to_srgb8(const cdl_ToneSettings *settings, const float *rgb, size_t pixels,
                      uint8_t *out);

#ifdef __cplusplus
}
#endif
#endif
