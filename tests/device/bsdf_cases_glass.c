/* bsdf_cases_glass.c: frosted glass, and Burley's principled material. */
#include "tests/device/bsdf_models.h"

#define WHITE                                                                                      \
  { 1, 1, 1 }
#define GREY(x)                                                                                    \
  { x, 0.5f * x, 0.1f }

/* From outside and, else, from inside. */
#define FROSTED(x, y, f, ior, in)                                                                  \
  {                                                                                                \
    .name = "rough_dielectric " #x " " #y " " #f " " #ior " " #in, .model = BSDF_rough_dielectric, \
    .base = WHITE, .flags = f, .inside = in, .width = x < y ? x : y, .eta = ((f)&THIN) ? 0 : ior,  \
    .words = {                                                                                     \
      x,                                                                                           \
      y,                                                                                           \
      ior                                                                                          \
    }                                                                                              \
  }

#define DISNEY_WORD(name) [CDL_DISNEY_##name]
/* `narrow`: the least alpha, of facets or coat. As published, lobes are added without taking from
 * each other what the ones above reflect, and the diffuse one grows towards grazing angles: `e` is
 * the most that such a material returns at any view, with a little to spare. */
#define DISNEY(text, rough, narrow, e, index, ...)                                                 \
  {                                                                                                \
    .name = "disney " #rough " " text, .model = BSDF_disney, .base = GREY(1), .energy = e,         \
    .width = narrow, .eta = index, .words = {                                                      \
      DISNEY_WORD(ROUGHNESS) = rough,                                                              \
      DISNEY_WORD(IOR) = 1.5f,                                                                     \
      __VA_ARGS__                                                                                  \
    }                                                                                              \
  }

const BsdfCase bsdf_cases_glass[] = {
    FROSTED(0.001f, 0.001f, 0, 1.5f, 0),
    FROSTED(0.02f, 0.02f, 0, 1.5f, 0),
    FROSTED(0.02f, 0.02f, 0, 1.5f, 1),
    FROSTED(0.2f, 0.2f, 0, 1.5f, 0),
    FROSTED(0.2f, 0.2f, SEPARABLE, 1.5f, 1),
    FROSTED(1.0f, 1.0f, 0, 1.5f, 0),
    FROSTED(1.0f, 1.0f, 0, 1.5f, 1),
    FROSTED(0.5f, 0.1f, 0, 2.4f, 0),
    FROSTED(0.5f, 0.1f, SEPARABLE, 1.2f, 1),
    FROSTED(0.3f, 0.3f, 0, 0.7f, 0),
    FROSTED(0.02f, 0.02f, BECKMANN, 1.5f, 0),
    FROSTED(0.2f, 0.2f, BECKMANN | SEPARABLE, 1.5f, 0),
    FROSTED(0.2f, 0.2f, BECKMANN, 1.5f, 1),
    FROSTED(1.0f, 1.0f, BECKMANN, 1.5f, 0),
    FROSTED(0.1f, 0.4f, BECKMANN, 1.33f, 1),
    FROSTED(0.1f, 0.1f, THIN, 1.5f, 0),
    FROSTED(0.6f, 0.3f, THIN | BECKMANN, 1.5f, 1),
    DISNEY("plain", 0.5f, 0.25f, 1.25f, 0, DISNEY_WORD(SPECULAR) = 0.5f),
    DISNEY("matt", 1.0f, 1.0f, 1.6f, 0, DISNEY_WORD(SPECULAR) = 0),
    DISNEY("glossy", 0.1f, 0.01f, 1.45f, 0, DISNEY_WORD(SPECULAR) = 1,
           DISNEY_WORD(SPECULAR_TINT) = 1),
    DISNEY("metal", 0.3f, 0.09f, 1, 0, DISNEY_WORD(METALLIC) = 1),
    DISNEY("brushed", 0.5f, 0.08f, 1, 0, DISNEY_WORD(METALLIC) = 1, DISNEY_WORD(ANISOTROPIC) = 1),
    DISNEY("sheen", 0.7f, 0.49f, 1.45f, 0, DISNEY_WORD(SHEEN) = 1, DISNEY_WORD(SHEEN_TINT) = 0.5f),
    DISNEY("clearcoat", 0.5f, 0.01f, 1.25f, 0, DISNEY_WORD(CLEARCOAT) = 1,
           DISNEY_WORD(CLEARCOAT_GLOSS) = 0.9f),
    DISNEY("dull coat", 0.6f, 0.1f, 1.15f, 0, DISNEY_WORD(CLEARCOAT) = 1,
           DISNEY_WORD(METALLIC) = 0.5f),
    DISNEY("subsurface", 0.5f, 0.25f, 1.45f, 0, DISNEY_WORD(SPECULAR) = 0.5f,
           DISNEY_WORD(SUBSURFACE) = 1),
    DISNEY("glass", 0.3f, 0.09f, 1, 1.5f, DISNEY_WORD(SPEC_TRANS) = 1),
    DISNEY("half glass", 0.6f, 0.2f, 1.05f, 1.5f, DISNEY_WORD(SPEC_TRANS) = 0.5f,
           DISNEY_WORD(ANISOTROPIC) = 0.5f),
    DISNEY("thin glass", 0.5f, 0.09f, 1, 0, DISNEY_WORD(SPEC_TRANS) = 1, DISNEY_WORD(THIN) = 1),
    DISNEY("leaf", 0.5f, 0.25f, 1.2f, 0, DISNEY_WORD(DIFF_TRANS) = 1.2f, DISNEY_WORD(THIN) = 1,
           DISNEY_WORD(FLATNESS) = 0.5f),
    {NULL},
};
