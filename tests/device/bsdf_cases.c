/* bsdf_cases.c: matt surfaces, metals, plastics and retroreflectors. */
#include "tests/device/bsdf_models.h"

#define WHITE                                                                                      \
  { 1, 1, 1 }
#define GREY(x)                                                                                    \
  { x, 0.5f * x, 0.1f }

#define DIFFUSE(reflectance)                                                                       \
  {                                                                                                \
    .name = "diffuse " #reflectance, .model = BSDF_diffuse, .base = GREY(reflectance), .width = 1, \
    .center = BSDF_CENTER_NORMAL                                                                   \
  }

/* eta 0: a metal that absorbs nothing. Compensation is a fit: what it returns seen at 89.9 degrees
 * is 0.984 in places. */
#define METAL(x, y, f, e, k)                                                                       \
  {                                                                                                \
    .name = "conductor " #x " " #y " " #f " " #e " " #k, .model = BSDF_conductor, .base = WHITE,   \
    .flags = f, .width = x < y ? x : y, .least = ((f)&COMPENSATED) && e == 0 ? 0.99f : 0,          \
    .least_cosine = 0.05f, .words = {                                                              \
      x,                                                                                           \
      y,                                                                                           \
      e,                                                                                           \
      e,                                                                                           \
      e,                                                                                           \
      k,                                                                                           \
      k,                                                                                           \
      k                                                                                            \
    }                                                                                              \
  }
#define WHITE_METAL(x, y, f) METAL(x, y, f, 0, 1)

#define RETRO(x, y, f, ior)                                                                        \
  {                                                                                                \
    .name = "retroreflector " #x " " #y " " #f " " #ior, .model = BSDF_retroreflector,             \
    .base = GREY(1), .flags = f, .width = x < y ? x : y, .center = BSDF_CENTER_VIEW, .words = {    \
      x,                                                                                           \
      y,                                                                                           \
      ior                                                                                          \
    }                                                                                              \
  }

#define OREN_NAYAR(reflectance, roughness)                                                         \
  {                                                                                                \
    .name = "oren_nayar " #reflectance " " #roughness, .model = BSDF_oren_nayar,                   \
    .base = GREY(reflectance), .width = 1, .center = BSDF_CENTER_NORMAL, .words = {                \
      roughness                                                                                    \
    }                                                                                              \
  }

/* Smooth: a delta lobe over a cosine. */
#define PLASTIC(x, y, f, ior)                                                                      \
  {                                                                                                \
    .name = "plastic " #x " " #y " " #f " " #ior, .model = BSDF_plastic, .base = GREY(1),          \
    .flags = f, .width = x > 0 ? (x < y ? x : y) : 1,                                              \
    .center = x > 0 ? BSDF_CENTER_MIRROR : BSDF_CENTER_NORMAL, .words = {                          \
      x,                                                                                           \
      y,                                                                                           \
      ior                                                                                          \
    }                                                                                              \
  }

const BsdfCase bsdf_cases_opaque[] = {
    DIFFUSE(1),
    DIFFUSE(0.3f),
    WHITE_METAL(0.0001f, 0.0001f, 0),
    WHITE_METAL(0.001f, 0.001f, 0),
    WHITE_METAL(0.02f, 0.02f, 0),
    WHITE_METAL(0.2f, 0.2f, 0),
    WHITE_METAL(0.5f, 0.5f, SEPARABLE),
    WHITE_METAL(1.0f, 1.0f, 0),
    WHITE_METAL(0.1f, 0.4f, 0),
    WHITE_METAL(0.7f, 0.05f, SEPARABLE),
    WHITE_METAL(0.0001f, 0.0001f, BECKMANN),
    WHITE_METAL(0.001f, 0.001f, BECKMANN | SEPARABLE),
    WHITE_METAL(0.02f, 0.02f, BECKMANN),
    WHITE_METAL(0.2f, 0.2f, BECKMANN | SEPARABLE),
    WHITE_METAL(0.5f, 0.5f, BECKMANN),
    WHITE_METAL(1.0f, 1.0f, BECKMANN),
    WHITE_METAL(0.1f, 0.4f, BECKMANN | SEPARABLE),
    WHITE_METAL(0.7f, 0.05f, BECKMANN),
    WHITE_METAL(0.3f, 0.3f, COMPENSATED),
    WHITE_METAL(1.0f, 1.0f, COMPENSATED | SEPARABLE),
    WHITE_METAL(1.0f, 0.2f, COMPENSATED),
    WHITE_METAL(0.7f, 0.7f, COMPENSATED | BECKMANN),
    WHITE_METAL(0.05f, 0.05f, COMPENSATED | BECKMANN),
    METAL(0.3f, 0.3f, 0, 0.18f, 3.4f),
    METAL(0.05f, 0.01f, SEPARABLE, 3.1f, 3.3f),
    METAL(0.4f, 0.2f, BECKMANN, 1.3f, 7.4f),
    RETRO(0.001f, 0.001f, 0, 1.5f),
    RETRO(0.05f, 0.05f, 0, 1.5f),
    RETRO(0.4f, 0.4f, SEPARABLE, 1.0f),
    RETRO(1.0f, 0.3f, 0, 1.3f),
    RETRO(0.3f, 0.1f, BECKMANN, 2.4f),
    WHITE_METAL(0.05f, 0.05f, SEPARABLE),
    WHITE_METAL(0.35f, 0.35f, 0),
    WHITE_METAL(0.7f, 0.7f, BECKMANN | SEPARABLE),
    METAL(0.15f, 0.15f, 0, 1.5f, 7.6f),
    RETRO(0.1f, 0.1f, SEPARABLE, 1.5f),
    RETRO(0.6f, 0.6f, BECKMANN | SEPARABLE, 1.1f),
    OREN_NAYAR(0.2f, 0.8f),
    OREN_NAYAR(1, 0.0f),
    OREN_NAYAR(1, 0.5f),
    OREN_NAYAR(1, 1.0f),
    OREN_NAYAR(0.5f, 0.3f),
    PLASTIC(0, 0, 0, 1.5f),
    PLASTIC(0, 0, BECKMANN, 2.5f),
    PLASTIC(0.01f, 0.01f, 0, 1.5f),
    PLASTIC(0.1f, 0.1f, 0, 1.5f),
    PLASTIC(0.3f, 0.3f, SEPARABLE, 1.3f),
    PLASTIC(1.0f, 1.0f, 0, 1.5f),
    PLASTIC(0.4f, 0.1f, 0, 1.8f),
    PLASTIC(0.1f, 0.1f, BECKMANN, 1.5f),
    PLASTIC(0.5f, 0.2f, BECKMANN | SEPARABLE, 3.0f),
    PLASTIC(1.0f, 1.0f, BECKMANN, 1.5f),
    WHITE_METAL(0.0003f, 0.0003f, SEPARABLE),
    WHITE_METAL(0.002f, 0.04f, 0),
    WHITE_METAL(0.1f, 0.005f, BECKMANN),
    WHITE_METAL(0.1f, 0.1f, COMPENSATED),
    WHITE_METAL(0.6f, 0.6f, COMPENSATED | SEPARABLE | BECKMANN),
    METAL(0.5f, 0.5f, COMPENSATED, 0.2f, 3.9f),
    RETRO(0.0001f, 0.0001f, 0, 1.5f),
    RETRO(0.0003f, 0.0003f, BECKMANN, 1.5f),
    PLASTIC(0.0001f, 0.0001f, 0, 1.5f),
    PLASTIC(0.001f, 0.001f, BECKMANN, 1.5f),
    {NULL},
};
