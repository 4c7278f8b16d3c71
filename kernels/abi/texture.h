/* texture.h: images as the kernels see them: one buffer of 4-byte texels for all. */
#ifndef CDL_ABI_TEXTURE_H
#define CDL_ABI_TEXTURE_H

#include "abi/types.h"

#define CDL_TEXEL_RGBA8 0u   /* one word a texel, red in the lowest byte */
#define CDL_TEXEL_RGBA32F 1u /* four words a texel, float bits */

#define CDL_WRAP_REPEAT 0u
#define CDL_WRAP_MIRROR 1u
#define CDL_WRAP_CLAMP 2u

typedef struct cdl_Texture {
  uint first; /* word of its first texel, the top left one */
  uint width, height;
  uint format;
  uint wrap_s, wrap_t;
  uint nearest; /* 1: nearest texel; 0: bilinear */
  uint pad;
} cdl_Texture;
CDL_ABI_SIZE(cdl_Texture, 32);

#endif
