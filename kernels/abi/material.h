/* material.h: what a surface is made of, as the kernels see it. */
#ifndef CDL_ABI_MATERIAL_H
#define CDL_ABI_MATERIAL_H

#include "abi/types.h"

/* Material models; each has a queue and a shading kernel of its own (kernels/bsdf). Those with
 * delta lobes alone come first: no light is sampled for them. */
#define CDL_MODEL_UNLIT 0u
#define CDL_MODEL_MIRROR 1u
#define CDL_MODEL_DIELECTRIC 2u
#define CDL_MODEL_DIFFUSE 3u
#define CDL_MODEL_CONDUCTOR 4u
#define CDL_MODEL_RETROREFLECTOR 5u
#define CDL_MODEL_GLTF 6u
#define CDL_MODEL_INTERFACE 7u /* the boundary of a medium; has no queue of its own */
#define CDL_MODEL_COUNT 8u
#define CDL_MODEL_FIRST_LIT CDL_MODEL_DIFFUSE

/* cdl_Material.flags */
#define CDL_MATERIAL_DOUBLE_SIDED 1u
#define CDL_MATERIAL_EMISSIVE 2u
#define CDL_MATERIAL_BECKMANN 4u  /* else GGX */
#define CDL_MATERIAL_SEPARABLE 8u /* masking; else correlated by height */
#define CDL_MATERIAL_MASK 16u     /* opacity below the cutoff is a hole */
#define CDL_MATERIAL_BLEND 32u    /* opacity is a probability */

/* A texture look-up: u' = m0 u + m1 v + m2, v' = m3 u + m4 v + m5. */
typedef struct cdl_TextureSlot {
  uint texture; /* CDL_NONE: white */
  uint uv_set;
  float transform[6];
} cdl_TextureSlot;
CDL_ABI_SIZE(cdl_TextureSlot, 32);

typedef struct cdl_Material {
  uint model;
  uint flags;
  uint medium; /* what a closed surface holds: index into the media; 0 is vacuum */
  float alpha_cutoff;
  float base[4]; /* base colour, reflectance or transmittance; opacity */
  float emission[3];
  float ior; /* inside over outside */
  float metallic;
  float roughness; /* glTF's; alpha is its square */
  float alpha[2];  /* microfacet alpha along tangent and bitangent */
  float eta[3];    /* complex index of a conductor: eta + i k */
  float normal_scale;
  float k[3];
  uint pad;
  cdl_TextureSlot base_texture;  /* colour */
  cdl_TextureSlot param_texture; /* G: roughness, B: metallic (glTF); R scales alpha (others) */
  cdl_TextureSlot normal_texture;
  cdl_TextureSlot emission_texture; /* colour */
} cdl_Material;
CDL_ABI_SIZE(cdl_Material, 224);

#endif
