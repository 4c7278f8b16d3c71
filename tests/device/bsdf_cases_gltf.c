/* bsdf_cases_gltf.c: glTF's material, and its layers. */
#include "tests/device/bsdf_models.h"

#define WHITE                                                                                      \
  { 1, 1, 1 }
#define GREY(x)                                                                                    \
  { x, 0.5f * x, 0.1f }

/* `low`: the least that it returns of uniform light. */
#define GLTF(b, roughness, metallic, low)                                                          \
  {                                                                                                \
    .name = "gltf " #b " " #roughness " " #metallic, .model = BSDF_gltf, .base = {b, b, b},        \
    .width = roughness * roughness < 1e-3f ? 1e-3f : roughness * roughness, .least = low,          \
    .words = {                                                                                     \
      metallic,                                                                                    \
      roughness,                                                                                   \
      1.5f                                                                                         \
    }                                                                                              \
  }

/* Refraction's half vector is found from a difference that has few digits where both directions are
 * nearly along the surface. */
#define LAYER(name) [CDL_GLTF_LAYERED_##name]
#define LAYERED(text, metal, rough, narrow, index, ...)                                            \
  LAYERED_AT((.reciprocity = index > 0 ? 0.02f : 0), text, metal, rough, narrow, index, __VA_ARGS__)
/* Members in parentheses. */
#define MEMBERS(...) __VA_ARGS__
#define LAYERED_AT(members, text, metal, rough, narrow, index, ...)                                \
  {                                                                                                \
    .name = "gltf_layered " #metal " " #rough " " text, .model = BSDF_gltf_layered,                \
    .base = GREY(1), .width = narrow, .eta = index, MEMBERS members, .words = {                    \
      LAYER(METALLIC) = metal,                                                                     \
      LAYER(ROUGHNESS) = rough,                                                                    \
      LAYER(IOR) = 1.5f,                                                                           \
      LAYER(SPECULAR) = 1,                                                                         \
      LAYER(SPECULAR_COLOR) = 1,                                                                   \
      1,                                                                                           \
      1,                                                                                           \
      __VA_ARGS__                                                                                  \
    }                                                                                              \
  }

#define INSIDE (.inside = 1)
#define TURNED_BACK (.center = BSDF_CENTER_VIEW)
/* Its own cosine is in the lobe of a coat with a normal of its own: clearcoat.h. */
#define TILTED(x, y) (.coat_normal = {x, y}, .reciprocity = -1)
#define SPREAD(c) (.abbe = 40, .channel = c, .wavelength = 0.3f)

const BsdfCase bsdf_cases_gltf[] = {
    GLTF(1, 0.0f, 1, 0),
    GLTF(1, 0.3f, 1, 0),
    GLTF(0.7f, 1.0f, 1, 0),
    GLTF(1, 0.0f, 0, 0.99f),
    GLTF(1, 0.2f, 0, 0.99f),
    GLTF(1, 0.6f, 0, 0.99f),
    GLTF(1, 1.0f, 0, 0.99f),
    GLTF(0.2f, 1.0f, 0, 0),
    GLTF(0, 0.4f, 0, 0),
    GLTF(0.5f, 0.5f, 0.5f, 0),
    LAYERED("plain", 0, 0.5f, 0.25f, 0, LAYER(DISPERSION) = 0),
    LAYERED("metal", 1, 0.3f, 0.09f, 0, LAYER(DISPERSION) = 0),
    LAYERED("brushed", 1, 0.4f, 0.16f, 0, LAYER(ANISOTROPY_STRENGTH) = 0.7f),
    LAYERED("clearcoat", 0.5f, 0.6f, 0.01f, 0, LAYER(CLEARCOAT) = 1,
            LAYER(CLEARCOAT_ROUGHNESS) = 0.1f),
    LAYERED("dull coat", 0, 0.8f, 0.25f, 0, LAYER(CLEARCOAT) = 1,
            LAYER(CLEARCOAT_ROUGHNESS) = 0.5f),
    LAYERED("sheen", 0, 1.0f, 1.0f, 0, LAYER(SHEEN_COLOR) = 1, 0.5f, 0.2f,
            LAYER(SHEEN_ROUGHNESS) = 0.5f),
    LAYERED("film", 0, 0.2f, 0.04f, 0, LAYER(IRIDESCENCE) = 1, LAYER(IRIDESCENCE_IOR) = 1.3f,
            LAYER(IRIDESCENCE_THICKNESS) = 400),
    LAYERED("film on metal", 1, 0.4f, 0.16f, 0, LAYER(IRIDESCENCE) = 1,
            LAYER(IRIDESCENCE_IOR) = 1.8f, LAYER(IRIDESCENCE_THICKNESS) = 700),
    LAYERED("sheet", 0, 0.4f, 0.16f, 0, LAYER(TRANSMISSION) = 1),
    LAYERED("clear sheet", 0, 0.0f, 0.001f, 0, LAYER(TRANSMISSION) = 0.7f),
    LAYERED("volume", 0, 0.4f, 0.05f, 1.5f, LAYER(TRANSMISSION) = 1, LAYER(THICKNESS) = 1),
    LAYERED("leaf", 0, 0.6f, 0.36f, 0, LAYER(DIFFUSE_TRANSMISSION) = 0.6f,
            LAYER(DIFFUSE_TRANSMISSION_COLOR) = 1, 0.5f, 0.2f),
    LAYERED("retro", 0.5f, 0.4f, 0.16f, 0, LAYER(RETROREFLECTION) = 1),
    LAYERED("all", 0.2f, 0.5f, 0.04f, 0, LAYER(ANISOTROPY_STRENGTH) = 0.5f, LAYER(CLEARCOAT) = 0.5f,
            LAYER(CLEARCOAT_ROUGHNESS) = 0.2f, LAYER(SHEEN_COLOR) = 0.3f, 0.3f, 0.3f,
            LAYER(SHEEN_ROUGHNESS) = 0.3f, LAYER(IRIDESCENCE) = 0.5f, LAYER(IRIDESCENCE_IOR) = 1.5f,
            LAYER(IRIDESCENCE_THICKNESS) = 300, LAYER(TRANSMISSION) = 0.5f,
            LAYER(DIFFUSE_TRANSMISSION) = 0.3f, LAYER(DIFFUSE_TRANSMISSION_COLOR) = 1, 1, 1,
            LAYER(RETROREFLECTION) = 0.3f),
    LAYERED("brushed and turned", 1, 0.4f, 0.16f, 0, LAYER(ANISOTROPY_STRENGTH) = 0.7f,
            LAYER(ANISOTROPY_ROTATION) = 0.6f, 0.8f, LAYER(ANISOTROPY_DIRECTION) = 1),
    LAYERED("brushed along a texture", 0, 0.3f, 0.09f, 0, LAYER(ANISOTROPY_STRENGTH) = 1,
            LAYER(ANISOTROPY_ROTATION) = 0.6f, 0.8f, LAYER(ANISOTROPY_DIRECTION) = -0.3f, 0.5f),
    LAYERED_AT(TILTED(-0.6f, 0.1f), "steep coat", 1, 0.3f, 0.09f, 0, LAYER(CLEARCOAT) = 1,
               LAYER(CLEARCOAT_ROUGHNESS) = 0.6f),
    LAYERED_AT(TILTED(0.1f, 0.1f), "tilted coat over sheen", 0, 0.7f, 0.01f, 0,
               LAYER(CLEARCOAT) = 0.7f, LAYER(CLEARCOAT_ROUGHNESS) = 0.1f, LAYER(SHEEN_COLOR) = 1,
               1, 1, LAYER(SHEEN_ROUGHNESS) = 0.4f),
    LAYERED_AT(TILTED(0.3f, -0.2f), "tilted coat", 0.5f, 0.6f, 0.04f, 0, LAYER(CLEARCOAT) = 1,
               LAYER(CLEARCOAT_ROUGHNESS) = 0.2f),
    LAYERED("thick film", 1, 0.5f, 0.25f, 0, LAYER(IRIDESCENCE) = 0.8f,
            LAYER(IRIDESCENCE_IOR) = 2.2f, LAYER(IRIDESCENCE_THICKNESS) = 1200),
    LAYERED("soap", 0, 0.3f, 0.09f, 0, LAYER(IRIDESCENCE) = 1, LAYER(IRIDESCENCE_IOR) = 1.33f,
            LAYER(IRIDESCENCE_THICKNESS) = 250, LAYER(TRANSMISSION) = 1),
    LAYERED_AT(TURNED_BACK, "turned back", 1, 0.2f, 0.04f, 0, LAYER(RETROREFLECTION) = 1),
    LAYERED_AT(TURNED_BACK, "plastic turned back", 0, 0.5f, 0.25f, 0, LAYER(RETROREFLECTION) = 1),
    LAYERED("half turned back", 1, 0.6f, 0.36f, 0, LAYER(RETROREFLECTION) = 0.5f,
            LAYER(ANISOTROPY_STRENGTH) = 0.5f, LAYER(ANISOTROPY_ROTATION) = 0, 1,
            LAYER(ANISOTROPY_DIRECTION) = 1),
    LAYERED("coated sheet", 0, 0.5f, 0.04f, 0, LAYER(TRANSMISSION) = 0.8f, LAYER(CLEARCOAT) = 1,
            LAYER(CLEARCOAT_ROUGHNESS) = 0.2f),
    LAYERED_AT(INSIDE, "sheet from behind", 0, 0.3f, 0.09f, 0, LAYER(TRANSMISSION) = 0.6f,
               LAYER(SHEEN_COLOR) = 0.5f, 0.5f, 0.5f, LAYER(SHEEN_ROUGHNESS) = 0.5f),
    LAYERED("clear volume", 0, 0.2f, 0.01f, 1.5f, LAYER(TRANSMISSION) = 1, LAYER(THICKNESS) = 1),
    LAYERED_AT(INSIDE, "volume from inside", 0, 0.4f, 0.05f, 1.5f, LAYER(TRANSMISSION) = 1,
               LAYER(THICKNESS) = 1),
    LAYERED_AT(INSIDE, "clear volume from inside", 0, 0.2f, 0.01f, 1.5f, LAYER(TRANSMISSION) = 1,
               LAYER(THICKNESS) = 1),
    LAYERED_AT(INSIDE, "coated volume from inside", 0, 0.5f, 0.04f, 1.5f, LAYER(TRANSMISSION) = 1,
               LAYER(THICKNESS) = 1, LAYER(CLEARCOAT) = 1, LAYER(CLEARCOAT_ROUGHNESS) = 0.2f,
               LAYER(SHEEN_COLOR) = 0.3f, 0.3f, 0.3f, LAYER(SHEEN_ROUGHNESS) = 0.5f),
    LAYERED_AT(INSIDE, "bubble from inside", 0, 0.4f, 0.05f, 1.5f, LAYER(TRANSMISSION) = 1,
               LAYER(THICKNESS) = 1, LAYER(IRIDESCENCE) = 1, LAYER(IRIDESCENCE_IOR) = 1.3f,
               LAYER(IRIDESCENCE_THICKNESS) = 400),
    LAYERED_AT(SPREAD(1), "dispersive volume", 0, 0.3f, 0.05f, 1.5f, LAYER(TRANSMISSION) = 1,
               LAYER(THICKNESS) = 1, LAYER(DISPERSION) = 0.5f),
    LAYERED_AT((.inside = 1, MEMBERS SPREAD(2)), "dispersive volume from inside", 0, 0.3f, 0.05f,
               1.5f, LAYER(TRANSMISSION) = 1, LAYER(THICKNESS) = 1, LAYER(DISPERSION) = 0.5f),
    {NULL},
};
