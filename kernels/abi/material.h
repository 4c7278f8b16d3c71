/* material.h: what a surface is made of, as the kernels see it. */
#ifndef CDL_ABI_MATERIAL_H
#define CDL_ABI_MATERIAL_H

#include "abi/param_fields.h"
#include "abi/types.h"

/* Material models; each has a queue and a shading kernel of its own (kernels/bsdf). Those with
 * delta lobes alone come first: no light is sampled for them. Those with parameters beyond their
 * base colour are neighbours. */
#define CDL_MODEL_UNLIT 0u
#define CDL_MODEL_MIRROR 1u
#define CDL_MODEL_DIELECTRIC 2u /* smooth */
#define CDL_MODEL_ROUGH_DIELECTRIC 3u
#define CDL_MODEL_CONDUCTOR 4u
#define CDL_MODEL_PLASTIC 5u
#define CDL_MODEL_OREN_NAYAR 6u
#define CDL_MODEL_RETROREFLECTOR 7u
#define CDL_MODEL_DISNEY 8u
#define CDL_MODEL_GLTF 9u
#define CDL_MODEL_GLTF_LAYERED 10u    /* glTF with layers that extensions add */
#define CDL_MODEL_BODY 11u            /* the boundary of a subsurface medium */
#define CDL_MODEL_SUBSURFACE 12u      /* light under it follows a profile */
#define CDL_MODEL_SUBSURFACE_EXIT 13u /* where light from under such a surface comes out again */
#define CDL_MODEL_DIFFUSE 14u
#define CDL_MODEL_INTERFACE 15u /* the boundary of a medium; has no queue of its own */
#define CDL_MODEL_COUNT 16u
#define CDL_MODEL_FIRST_LIT CDL_MODEL_ROUGH_DIELECTRIC
#define CDL_MODEL_FIRST_PARAMETERS CDL_MODEL_DIELECTRIC
#define CDL_MODEL_LAST_PARAMETERS CDL_MODEL_SUBSURFACE_EXIT

/* M(MODEL, name, words of parameters) for all that shading kernels are made for. */
#define CDL_SHADED_MODELS(M)                                                                       \
  M(UNLIT, unlit, 0)                                                                               \
  M(MIRROR, mirror, 0)                                                                             \
  M(DIELECTRIC, dielectric, CDL_DIELECTRIC_PARAMS)                                                 \
  M(ROUGH_DIELECTRIC, rough_dielectric, CDL_ROUGH_DIELECTRIC_PARAMS)                               \
  M(CONDUCTOR, conductor, CDL_CONDUCTOR_PARAMS)                                                    \
  M(PLASTIC, plastic, CDL_PLASTIC_PARAMS)                                                          \
  M(OREN_NAYAR, oren_nayar, CDL_OREN_NAYAR_PARAMS)                                                 \
  M(RETROREFLECTOR, retroreflector, CDL_RETROREFLECTOR_PARAMS)                                     \
  M(DISNEY, disney, CDL_DISNEY_PARAMS)                                                             \
  M(GLTF, gltf, CDL_GLTF_PARAMS)                                                                   \
  M(GLTF_LAYERED, gltf_layered, CDL_GLTF_LAYERED_PARAMS)                                           \
  M(BODY, body, CDL_BODY_PARAMS)                                                                   \
  M(SUBSURFACE, subsurface, CDL_SUBSURFACE_PARAMS)                                                 \
  M(SUBSURFACE_EXIT, subsurface_exit, CDL_SUBSURFACE_PARAMS)                                       \
  M(DIFFUSE, diffuse, 0)

/* cdl_Material.flags */
#define CDL_MATERIAL_DOUBLE_SIDED 1u
#define CDL_MATERIAL_EMISSIVE 2u
#define CDL_MATERIAL_BECKMANN 4u  /* else GGX */
#define CDL_MATERIAL_SEPARABLE 8u /* masking; else correlated by height */
#define CDL_MATERIAL_MASK 16u     /* opacity below the cutoff is a hole */
#define CDL_MATERIAL_BLEND 32u    /* opacity is a probability */
#define CDL_MATERIAL_BOUNDARY 64u /* going through it means entering or leaving what it holds */
#define CDL_MATERIAL_THIN 128u    /* a sheet: what goes in comes out on the other side */
#define CDL_MATERIAL_ENERGY_COMPENSATED 256u
#define CDL_MATERIAL_NORMAL_MAPPED 512u /* and nothing goes through */
#define CDL_MATERIAL_DIPOLE 1024u       /* the profile of a subsurface model; else diffusion's */

/* A texture look-up: u' = m0 u + m1 v + m2, v' = m3 u + m4 v + m5. */
typedef struct cdl_TextureSlot {
  uint texture; /* CDL_NONE: white */
  uint uv_set;
  float transform[6];
} cdl_TextureSlot;
CDL_ABI_SIZE(cdl_TextureSlot, 32);

/* A texture over a parameter: each of its words is offset + scale[word] x channel, where the
 * channels begin with `channel` (0: red). */
typedef struct cdl_ParamTexture {
  cdl_TextureSlot slot;
  uint param; /* first word, CDL_<MODEL>_<NAME> */
  uint words; /* 1 to 3 */
  uint channel;
  float offset;
  float scale[3];
  uint decode; /* 1: colours, decoded from sRGB */
} cdl_ParamTexture;
CDL_ABI_SIZE(cdl_ParamTexture, 64);

typedef struct cdl_Material {
  uint model;
  uint flags;
  float alpha_cutoff;
  uint pad;
  float base[4]; /* base colour, reflectance or transmittance; opacity */
  float emission[3];
  float normal_scale;
  uint param_count;   /* words of `param` in use */
  uint first_texture; /* of the parameters, index into the array of them all */
  uint texture_count;
  float coat_normal_scale;
  cdl_TextureSlot base_texture; /* colour */
  cdl_TextureSlot normal_texture;
  cdl_TextureSlot coat_normal_texture;
  cdl_TextureSlot emission_texture; /* colour */
  float param[CDL_PARAM_MAX];       /* abi/param_fields.h */
} cdl_Material;
CDL_ABI_SIZE(cdl_Material, 352);

#endif
