/* texture.h: looking up images, bilinear or nearest, without image samplers, whose filtering
 * differs from device to device. Texel centres lie at (i + 1/2) / n; image row 0 is the top. */
#ifndef CDL_TEXTURE_H
#define CDL_TEXTURE_H

#include "abi/material.h"
#include "abi/texture.h"
#include "lib/math.h"
#include "lib/vec.h"

/* What textures are read from. `srgb`: 256 floats, the linear value of each sRGB code. */
#define CDL_TEXTURE_ARGS                                                                           \
  CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,                           \
      CDL_GLOBAL const float *srgb

typedef struct Texel {
  float r, g, b, a, pad;
} Texel;

typedef struct TextureCoords {
  float u0, v0, u1, v1, pad; /* both sets */
} TextureCoords;

/* The same coordinates, see math_after: for another look-up in the same kernel. */
CDL_INLINE TextureCoords texture_coords_after(float before, TextureCoords uv) {
  uv.u0 = math_after(before, uv.u0);
  uv.u1 = math_after(uv.u0, uv.u1);
  return uv;
}

CDL_INLINE Texel texel_make(float r, float g, float b, float a) {
  Texel t;
  t.r = r;
  t.g = g;
  t.b = b;
  t.a = a;
  t.pad = 0.0f;
  return t;
}

/* A texture coordinate brought into [0,1]. */
CDL_INLINE float texture_wrap(float u, uint wrap) {
  float repeated = u - floor(u);
  float half_turns = 0.5f * math_after(repeated, u);
  float mirrored = 2.0f * (half_turns - floor(half_turns));
  mirrored = mirrored > 1.0f ? 2.0f - mirrored : mirrored;
  float w = wrap == CDL_WRAP_REPEAT ? repeated : wrap == CDL_WRAP_MIRROR ? mirrored : u;
  return w > 0.0f ? (w < 1.0f ? w : 1.0f) : 0.0f; /* also from not-a-number */
}

/* The index of a texel next to the border: around the corner, or stopped at it. */
CDL_INLINE int texture_neighbour(int i, int n, uint wrap) {
  int below = wrap == CDL_WRAP_REPEAT ? n - 1 : 0;
  int above = wrap == CDL_WRAP_REPEAT ? 0 : n - 1;
  return i < 0 ? below : i >= n ? above : i;
}

CDL_INLINE float texture_code(uint word, uint shift, CDL_GLOBAL const float *srgb, int decode) {
  uint code = (word >> shift) & 255u;
  return decode ? srgb[code] : (float)(int)code / 255.0f;
}

/* One texel; `decode`: colour, whose 8-bit codes are sRGB's. */
CDL_INLINE Texel texture_texel(CDL_GLOBAL const cdl_Texture *texture, CDL_GLOBAL const uint *texels,
                               CDL_GLOBAL const float *srgb, int x, int y, int decode) {
  uint index = (uint)y * texture->width + (uint)x;
#ifdef CDL_FLOAT_TEXTURES
  int is_float = texture->format == CDL_TEXEL_RGBA32F;
  size_t first = (size_t)texture->first + (is_float ? 4u * index : index);
  uint word = texels[first];
  Texel code =
      texel_make(texture_code(word, 0u, srgb, decode), texture_code(word, 8u, srgb, decode),
                 texture_code(word, 16u, srgb, decode), texture_code(word, 24u, srgb, 0));
  size_t next = is_float ? 1u : 0u;
  uint green = texels[first + next];
  uint blue = texels[first + 2u * next];
  uint alpha = texels[first + 3u * next];
  return texel_make(is_float ? as_float(word) : code.r, is_float ? as_float(green) : code.g,
                    is_float ? as_float(blue) : code.b, is_float ? as_float(alpha) : code.a);
#else
  uint word = texels[(size_t)texture->first + index];
  return texel_make(texture_code(word, 0u, srgb, decode), texture_code(word, 8u, srgb, decode),
                    texture_code(word, 16u, srgb, decode), texture_code(word, 24u, srgb, 0));
#endif
}

/* math_lerp of values that come about alike, see math_after. */
CDL_INLINE float texture_lerp(float a, float b, float t) {
  float part = (1.0f - t) * a;
  return part + t * math_after(part, b);
}

CDL_INLINE Texel texel_lerp(Texel a, Texel b, float t) {
  float red = texture_lerp(a.r, b.r, t);
  float green = texture_lerp(a.g, b.g, math_after(red, t));
  float blue = texture_lerp(a.b, b.b, math_after(green, t));
  float alpha = texture_lerp(a.a, b.a, math_after(blue, t));
  return texel_make(red, green, blue, alpha);
}

CDL_INLINE Texel texture_sample(CDL_GLOBAL const cdl_Texture *texture,
                                CDL_GLOBAL const uint *texels, CDL_GLOBAL const float *srgb,
                                float u, float v, int decode) {
  int width = (int)texture->width;
  int height = (int)texture->height;
  float half_texel = texture->nearest ? 0.0f : 0.5f;
  float x = texture_wrap(u, texture->wrap_s) * (float)width - half_texel;
  float x_floor = floor(x);
  int x0 = texture_neighbour((int)x_floor, width, texture->wrap_s);
  int x1 = texture_neighbour((int)math_after((float)x0, x_floor) + 1, width, texture->wrap_s);
  float v_after = math_after((float)x1, v);
  float y = texture_wrap(v_after, texture->wrap_t) * (float)height - half_texel;
  float y_floor = floor(y);
  int y0 = texture_neighbour((int)y_floor, height, texture->wrap_t);
  int y1 = texture_neighbour((int)math_after((float)y0, y_floor) + 1, height, texture->wrap_t);
  float fx = texture->nearest ? 0.0f : x - x_floor;
  float fy = texture->nearest ? 0.0f : y - y_floor;
  Texel top = texel_lerp(texture_texel(texture, texels, srgb, x0, y0, decode),
                         texture_texel(texture, texels, srgb, x1, y0, decode), fx);
  float fx_after = math_after(top.a, fx);
  Texel bottom = texel_lerp(texture_texel(texture, texels, srgb, x0, y1, decode),
                            texture_texel(texture, texels, srgb, x1, y1, decode), fx_after);
  return texel_lerp(top, bottom, fy);
}

/* A material's texture at these coordinates; white where it has none. */
CDL_INLINE Texel texture_lookup(CDL_GLOBAL const cdl_TextureSlot *slot, CDL_TEXTURE_ARGS,
                                TextureCoords uv, int decode) {
  uint present = slot->texture != CDL_NONE;
  float u = slot->uv_set ? uv.u1 : uv.u0;
  float v = slot->uv_set ? uv.v1 : uv.v0;
  float s = fma(slot->transform[0], u, fma(slot->transform[1], v, slot->transform[2]));
  float t = fma(slot->transform[3], u, fma(slot->transform[4], v, slot->transform[5]));
  Texel texel =
      texture_sample(textures + (present ? slot->texture : 0u), texels, srgb, s, t, decode);
  return texel_make(present ? texel.r : 1.0f, present ? texel.g : 1.0f, present ? texel.b : 1.0f,
                    present ? texel.a : 1.0f);
}

#endif
