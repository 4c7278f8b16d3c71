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

/* Smooth: a delta lobe over a cosine. */
#define BODY(x, y, f, ior, in)                                                                     \
  {                                                                                                \
    .name = "body " #x " " #y " " #f " " #ior " " #in, .model = BSDF_body, .base = WHITE,          \
    .flags = f, .inside = in, .width = (x > 0 && !(in)) ? (x < y ? x : y) : 1,                     \
    .center = (x > 0 && !(in)) ? BSDF_CENTER_MIRROR : BSDF_CENTER_NORMAL, .eta = ior, .words = {   \
      x,                                                                                           \
      y,                                                                                           \
      ior                                                                                          \
    }                                                                                              \
  }

#define DISNEY_WORD(name) [CDL_DISNEY_##name]
/* Tinted by `tint` and its powers; the last are more members. Compensation is interpolated, and off
 * by up to 0.016 where little is transmitted (energy.h). */
#define GLASS(text, tint, alpha, f, ior, in, ...)                                                  \
  {                                                                                                \
    .name = "rough_dielectric " text " " #alpha " " #ior " " #in, .model = BSDF_rough_dielectric,  \
    .base = {1, tint, tint * tint}, .flags = f, .inside = in, .width = alpha,                      \
    .eta = ((f)&THIN) ? 0 : ior, .words = {alpha, alpha, ior}, __VA_ARGS__                         \
  }
#define WHITE_AGAIN(alpha, f, ior, in)                                                             \
  GLASS("compensated " #f, 1, alpha, COMPENSATED | (f), ior, in, .least = 0.99f,                   \
        .least_cosine = 0.05f)
#define DISPERSIVE(alpha, f, ior, in, number, c, at)                                               \
  {                                                                                                \
    .name = "rough_dielectric dispersive " #alpha " " #number " " #c " " #in,                      \
    .model = BSDF_rough_dielectric, .base = {1, 1, 1}, .flags = f, .inside = in, .width = alpha,   \
    .eta = ior, .abbe = number, .channel = c, .wavelength = at, .words = {                         \
      alpha,                                                                                       \
      alpha,                                                                                       \
      ior,                                                                                         \
      number                                                                                       \
    }                                                                                              \
  }

/* `narrow`: the least alpha, of facets or coat. As published, lobes are added without taking from
 * each other what the ones above reflect, and the diffuse one grows towards grazing angles: `e` is
 * the most that such a material returns at any view, with a little to spare. */
#define DISNEY(text, rough, narrow, e, index, ...)                                                 \
  DISNEY_FROM(0, text, rough, narrow, e, index, __VA_ARGS__)
#define DISNEY_FROM(in, text, rough, narrow, e, index, ...)                                        \
  {                                                                                                \
    .name = "disney " #rough " " text, .model = BSDF_disney, .base = GREY(1), .energy = e,         \
    .inside = in, .width = narrow, .eta = index, .words = {                                        \
      DISNEY_WORD(ROUGHNESS) = rough,                                                              \
      DISNEY_WORD(IOR) = 1.5f,                                                                     \
      __VA_ARGS__                                                                                  \
    }                                                                                              \
  }

const BsdfCase bsdf_cases_glass[] = {
    BODY(0.0f, 0.0f, 0, 1.4f, 0),
    BODY(0.0f, 0.0f, 0, 1.4f, 1),
    BODY(0.3f, 0.3f, 0, 1.4f, 0),
    BODY(0.3f, 0.3f, 0, 1.4f, 1),
    BODY(0.05f, 0.05f, BECKMANN, 1.5f, 0),
    BODY(0.6f, 0.2f, SEPARABLE, 2.2f, 0),
    BODY(0.6f, 0.2f, SEPARABLE, 2.2f, 1),
    BODY(1.0f, 1.0f, 0, 1.0f, 0),
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
    FROSTED(0.0001f, 0.0001f, 0, 1.5f, 0),
    FROSTED(0.0003f, 0.0003f, BECKMANN, 1.5f, 1),
    FROSTED(0.001f, 0.001f, SEPARABLE, 2.0f, 1),
    FROSTED(0.0001f, 0.0001f, THIN, 1.5f, 0),
    WHITE_AGAIN(0.05f, 0, 1.5f, 0),
    WHITE_AGAIN(0.2f, 0, 1.5f, 1),
    WHITE_AGAIN(0.5f, SEPARABLE, 1.5f, 0),
    WHITE_AGAIN(0.5f, BECKMANN, 1.5f, 1),
    WHITE_AGAIN(1.0f, 0, 1.5f, 0),
    WHITE_AGAIN(1.0f, 0, 1.5f, 1),
    WHITE_AGAIN(0.7f, BECKMANN | SEPARABLE, 2.4f, 0),
    WHITE_AGAIN(0.4f, 0, 1.1f, 1),
    WHITE_AGAIN(0.4f, 0, 0.7f, 0),
    WHITE_AGAIN(0.6f, THIN, 1.5f, 0),
    WHITE_AGAIN(0.9f, THIN | BECKMANN, 1.8f, 1),
    GLASS("tinted", 0.3f, 0.1f, 0, 1.5f, 0, .least = 0),
    GLASS("tinted", 0.3f, 0.4f, BECKMANN, 1.5f, 1, .least = 0),
    GLASS("tinted sheet", 0.3f, 0.3f, THIN, 1.5f, 0, .least = 0),
    GLASS("tinted compensated", 0.5f, 0.6f, COMPENSATED, 1.5f, 0, .least = 0),
    GLASS("tinted compensated", 0.5f, 0.8f, COMPENSATED | SEPARABLE, 1.5f, 1, .least = 0),
    DISPERSIVE(0.01f, 0, 1.5f, 0, 30, 0, 0.1f),
    DISPERSIVE(0.1f, 0, 1.5f, 1, 30, 1, 0.5f),
    DISPERSIVE(0.3f, BECKMANN, 1.7f, 0, 15, 2, 0.9f),
    DISPERSIVE(0.5f, COMPENSATED, 1.4f, 1, 10, 2, 0.3f),
    DISNEY_FROM(1, "glass from inside", 0.3f, 0.09f, 1, 1.5f, DISNEY_WORD(SPEC_TRANS) = 1),
    DISNEY_FROM(1, "clear glass from inside", 0.1f, 0.01f, 1, 1.5f, DISNEY_WORD(SPEC_TRANS) = 1),
    DISNEY_FROM(1, "half glass from inside", 0.6f, 0.2f, 1.05f, 1.5f,
                DISNEY_WORD(SPEC_TRANS) = 0.5f, DISNEY_WORD(ANISOTROPIC) = 0.5f),
    DISNEY_FROM(1, "leaf from behind", 0.5f, 0.25f, 1.2f, 0, DISNEY_WORD(DIFF_TRANS) = 1.2f,
                DISNEY_WORD(THIN) = 1, DISNEY_WORD(FLATNESS) = 0.5f),
    DISNEY("mirror", 0.0f, 0.001f, 1, 0, DISNEY_WORD(METALLIC) = 1),
    DISNEY("clear glass", 0.0f, 0.001f, 1, 1.5f, DISNEY_WORD(SPEC_TRANS) = 1),
    {NULL},
};
