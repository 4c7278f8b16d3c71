/* material.h: from a hit to its material: texture coordinates, opacity, colour. */
#ifndef CDL_MATERIAL_LOOKUP_H
#define CDL_MATERIAL_LOOKUP_H

#include "abi/geometry.h"
#include "abi/material.h"
#include "lib/surface.h"
#include "lib/texture.h"

/* Two floats of each corner, blended; 0 where the shape has none. */
CDL_INLINE void shape_uv(CDL_GLOBAL const float *attributes, uint first, uint c0, uint c1, uint c2,
                         float u, float v, float *out_u, float *out_v) {
  int present = first != CDL_NONE;
  size_t base = present ? first : 0u;
  size_t i0 = base + 2u * (present ? c0 : 0u);
  size_t i1 = base + 2u * (present ? c1 : 0u);
  size_t i2 = base + 2u * (present ? c2 : 0u);
  float w = 1.0f - u - v;
  float s = fma(attributes[i2], v, fma(attributes[i1], u, attributes[i0] * w));
  float t = fma(attributes[i2 + 1], v, fma(attributes[i1 + 1], u, attributes[i0 + 1] * w));
  *out_u = present ? s : 0.0f;
  *out_v = present ? t : 0.0f;
}

CDL_INLINE TextureCoords shape_texture_coords(CDL_GLOBAL const cdl_Shape *shape,
                                              CDL_GLOBAL const float *attributes,
                                              CDL_GLOBAL const cdl_Triangle *triangle, float u,
                                              float v) {
  TextureCoords uv;
  uint c0 = triangle->corner[0];
  uint c1 = triangle->corner[1];
  uint c2 = triangle->corner[2];
  shape_uv(attributes, shape->uv[0], c0, c1, c2, u, v, &uv.u0, &uv.v0);
  shape_uv(attributes, shape->uv[1], c0, c1, c2, u, v, &uv.u1, &uv.v1);
  uv.pad = 0.0f;
  return uv;
}

/* Vertex colour and opacity; white where the shape has none. */
CDL_INLINE Texel shape_color(CDL_GLOBAL const cdl_Shape *shape, CDL_GLOBAL const float *attributes,
                             CDL_GLOBAL const cdl_Triangle *triangle, float u, float v) {
  int present = shape->colors != CDL_NONE;
  size_t base = present ? shape->colors : 0u;
  size_t i0 = base + 4u * (present ? triangle->corner[0] : 0u);
  size_t i1 = base + 4u * (present ? triangle->corner[1] : 0u);
  size_t i2 = base + 4u * (present ? triangle->corner[2] : 0u);
  float w = 1.0f - u - v;
  float r = fma(attributes[i2], v, fma(attributes[i1], u, attributes[i0] * w));
  float g = fma(attributes[i2 + 1], v, fma(attributes[i1 + 1], u, attributes[i0 + 1] * w));
  float b = fma(attributes[i2 + 2], v, fma(attributes[i1 + 2], u, attributes[i0 + 2] * w));
  float a = fma(attributes[i2 + 3], v, fma(attributes[i1 + 3], u, attributes[i0 + 3] * w));
  return texel_make(present ? r : 1.0f, present ? g : 1.0f, present ? b : 1.0f, present ? a : 1.0f);
}

/* glTF's materials are multiplied by vertex colours; Candela's own are not. */
CDL_INLINE int material_takes_vertex_color(uint model) {
  return model == CDL_MODEL_GLTF || model == CDL_MODEL_UNLIT;
}

/* Base colour and opacity of a hit, everything multiplied in. */
CDL_INLINE Texel material_base(CDL_GLOBAL const cdl_Material *material,
                               CDL_GLOBAL const cdl_Shape *shape,
                               CDL_GLOBAL const float *attributes,
                               CDL_GLOBAL const cdl_Triangle *triangle, float u, float v,
                               TextureCoords uv, CDL_TEXTURE_ARGS) {
  Texel base =
      texel_make(material->base[0], material->base[1], material->base[2], material->base[3]);
#ifdef CDL_TEXTURES
  Texel texel = texture_lookup(&material->base_texture, textures, texels, srgb, uv, 1);
  base = texel_make(base.r * texel.r, base.g * texel.g, base.b * texel.b, base.a * texel.a);
#endif
#ifdef CDL_VERTEX_COLORS
  Texel color = shape_color(shape, attributes, triangle, u, v);
  int tinted = material_takes_vertex_color(material->model);
  base = texel_make(base.r * (tinted ? color.r : 1.0f), base.g * (tinted ? color.g : 1.0f),
                    base.b * (tinted ? color.b : 1.0f), base.a * (tinted ? color.a : 1.0f));
#endif
  return base;
}

/* The normal of a normal map, in the frame of the interpolated normal (glTF 2.0, 3.9.3); that
 * normal itself where there is no map. */
CDL_INLINE vec3 material_normal(CDL_GLOBAL const cdl_TextureSlot *slot, float scale,
                                SurfacePoint point, TextureCoords uv, CDL_TEXTURE_ARGS) {
  Texel texel = texture_lookup(slot, textures, texels, srgb, uv, 0);
  float x = fma(2.0f, texel.r, -1.0f) * scale;
  float green = math_after(x, texel.g);
  float y = fma(2.0f, green, -1.0f) * scale * point.handedness;
  float z = fma(2.0f, math_after(y, texel.b), -1.0f);
  vec3 bent = frame_to_world(frame_from_tangent(point.normal, point.tangent), v3(x, y, z));
  int present = (slot->texture != CDL_NONE) & (v3_length2(bent) > 1e-12f);
  return v3_select(present, v3_normalize(bent), point.normal);
}

/* The probability that light is stopped: glTF's alpha modes. */
CDL_INLINE float material_opacity(CDL_GLOBAL const cdl_Material *material, float alpha) {
  float masked = alpha >= material->alpha_cutoff ? 1.0f : 0.0f;
  float blended = math_saturate(alpha);
  uint flags = material->flags;
  return flags & CDL_MATERIAL_MASK ? masked : flags & CDL_MATERIAL_BLEND ? blended : 1.0f;
}

/* Radiance that a material emits to its emitting side. */
CDL_INLINE vec3 material_emission(CDL_GLOBAL const cdl_Material *material, TextureCoords uv,
                                  CDL_TEXTURE_ARGS) {
  vec3 emission = v3(material->emission[0], material->emission[1], material->emission[2]);
#ifdef CDL_EMISSION_TEXTURES
  Texel texel = texture_lookup(&material->emission_texture, textures, texels, srgb, uv, 1);
  emission = v3_mul(emission, v3(texel.r, texel.g, texel.b));
#endif
  return emission;
}

#endif
