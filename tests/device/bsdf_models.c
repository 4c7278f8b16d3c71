#include "tests/device/bsdf_models.h"

#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/gltf.h"
#include "bsdf/mirror.h"
#include "bsdf/retroreflector.h"

#define MODEL(name, Type, through, flags, weight)                                                  \
  _Static_assert(sizeof(Type) <= BSDF_PARAMS_SIZE, "");                                            \
  static void name##_prepare(void *params, BsdfPoint point, const uint *words) {                   \
    *(Type *)params = name##_params(point, words, 1, 0);                                           \
  }                                                                                                \
  static BsdfValue name##_of(const void *params, vec3 wo, vec3 wi) {                               \
    return name##_evaluate(*(const Type *)params, wo, wi);                                         \
  }
BSDF_MODELS(MODEL)
#undef MODEL

#define END                                                                                        \
  { 0, 0, 0 }
#define UNIT                                                                                       \
  { 0, 1, 0 }
#define ALPHA                                                                                      \
  { 0, 1, 1e-5f }
#define IOR                                                                                        \
  { 1, 3, 0 }
#define RGB(low, high, fine)                                                                       \
  {low, high, fine}, {low, high, fine}, { low, high, fine }

static const BsdfRange diffuse_ranges[] = {END};
static const BsdfRange mirror_ranges[] = {END};
static const BsdfRange dielectric_ranges[] = {{0.3f, 3, 0}, END};
static const BsdfRange conductor_ranges[] = {ALPHA, ALPHA, RGB(0, 4, 0), RGB(0, 10, 0), END};
static const BsdfRange retroreflector_ranges[] = {ALPHA, ALPHA, IOR, END};
static const BsdfRange gltf_ranges[] = {UNIT, UNIT, IOR, END};

const BsdfModel bsdf_models[BSDF_MODEL_COUNT] = {
#define MODEL(name, Type, through, flags, weight)                                                  \
  {#name, #Type, through, flags, weight, name##_ranges, name##_prepare, name##_of},
    BSDF_MODELS(MODEL)
#undef MODEL
};

#define WHITE                                                                                      \
  { 1, 1, 1 }
#define GREY(x)                                                                                    \
  { x, 0.5f * x, 0.1f }

#define DIFFUSE(reflectance)                                                                       \
  {                                                                                                \
    .name = "diffuse " #reflectance, .model = BSDF_diffuse, .base = GREY(reflectance), .width = 1, \
    .center = BSDF_CENTER_NORMAL                                                                   \
  }

/* eta 0: a metal that absorbs nothing. */
#define METAL(x, y, f, e, k)                                                                       \
  {                                                                                                \
    .name = "conductor " #x " " #y " " #f " " #e " " #k, .model = BSDF_conductor, .base = WHITE,   \
    .flags = f, .width = x < y ? x : y, .words = {                                                 \
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

/* The specification's own diffuse part returns more than it gets: see gltf.h. */
#define GLTF(b, roughness, metallic, e)                                                            \
  {                                                                                                \
    .name = "gltf " #b " " #roughness " " #metallic, .model = BSDF_gltf, .base = {b, b, b},        \
    .width = roughness * roughness < 1e-3f ? 1e-3f : roughness * roughness, .energy = e,           \
    .words = {                                                                                     \
      metallic,                                                                                    \
      roughness,                                                                                   \
      1.5f                                                                                         \
    }                                                                                              \
  }

const BsdfCase bsdf_cases[] = {
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
    METAL(0.3f, 0.3f, 0, 0.18f, 3.4f),
    METAL(0.05f, 0.01f, SEPARABLE, 3.1f, 3.3f),
    METAL(0.4f, 0.2f, BECKMANN, 1.3f, 7.4f),
    RETRO(0.001f, 0.001f, 0, 1.5f),
    RETRO(0.05f, 0.05f, 0, 1.5f),
    RETRO(0.4f, 0.4f, SEPARABLE, 1.0f),
    RETRO(1.0f, 0.3f, 0, 1.3f),
    RETRO(0.3f, 0.1f, BECKMANN, 2.4f),
    GLTF(1, 0.0f, 1, 1),
    GLTF(1, 0.3f, 1, 1),
    GLTF(0.7f, 1.0f, 1, 1),
    GLTF(1, 0.2f, 0, 1.7f),
    GLTF(1, 0.6f, 0, 1.25f),
    GLTF(0.2f, 1.0f, 0, 1),
    GLTF(0, 0.4f, 0, 1),
    GLTF(0.5f, 0.5f, 0.5f, 1.25f),
    {NULL},
};
