#include "tests/device/bsdf_models.h"
#include "tests/device/bsdf_setup.h"

#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/disney.h"
#include "bsdf/gltf.h"
#include "bsdf/gltf_layered.h"
#include "bsdf/mirror.h"
#include "bsdf/oren_nayar.h"
#include "bsdf/plastic.h"
#include "bsdf/retroreflector.h"
#include "bsdf/rough_dielectric.h"

/* Where the processor has fused multiply-add, as one instruction: as calls it takes most of the
 * time. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("default", "arch=haswell")))
#else
#define CLONES
#endif

#define MODEL(name, Type, through, flags, weight)                                                  \
  _Static_assert(sizeof(Type) <= BSDF_PARAMS_SIZE, "");                                            \
  CLONES static void name##_prepare(void *params, BsdfPoint point, const uint *words) {            \
    *(Type *)params = name##_params(point, words, 1, 0);                                           \
  }                                                                                                \
  CLONES static BsdfValue name##_of(const void *params, vec3 wo, vec3 wi) {                        \
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
#define GLASS_IOR                                                                                  \
  { 0.3f, 3, 0 }
#define ABBE                                                                                       \
  { 0, 100, 5 }

static const BsdfRange dielectric_ranges[] = {GLASS_IOR, ABBE, END};
static const BsdfRange rough_dielectric_ranges[] = {ALPHA, ALPHA, GLASS_IOR, ABBE, END};
static const BsdfRange oren_nayar_ranges[] = {UNIT, END};
static const BsdfRange plastic_ranges[] = {ALPHA, ALPHA, IOR, END};
static const BsdfRange disney_ranges[] = {UNIT,      UNIT, UNIT, UNIT, UNIT, UNIT,
                                          UNIT,      UNIT, UNIT, UNIT, UNIT, {0.5f, 2.5f, 0},
                                          {0, 2, 0}, UNIT, UNIT, END};
static const BsdfRange gltf_layered_ranges[] = {
    UNIT, UNIT,       IOR,          UNIT,       RGB(0, 2, 0), /* specular and its colour */
    UNIT, {-1, 1, 0}, {-1, 1, 0},   {-1, 1, 0}, {-1, 1, 0},   /* anisotropy */
    UNIT, UNIT,       RGB(0, 1, 0), UNIT,                     /* coat, sheen */
    UNIT, {1, 3, 0},  {0, 1200, 0},                           /* film */
    UNIT, UNIT,       {0, 3, 0},    UNIT,       RGB(0, 1, 0), UNIT, END};
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

/* `e`: the most that the core's diffuse part returns, see gltf.h. Refraction's half vector is found
 * from a difference that has few digits where both directions are nearly along the surface. */
#define LAYER(name) [CDL_GLTF_LAYERED_##name]
#define LAYERED(text, metal, rough, narrow, e, index, ...)                                         \
  {                                                                                                \
    .name = "gltf_layered " #metal " " #rough " " text, .model = BSDF_gltf_layered,                \
    .base = GREY(1), .energy = e, .width = narrow, .eta = index,                                   \
    .reciprocity = index > 0 ? 0.02f : 0, .words = {                                               \
      LAYER(METALLIC) = metal,                                                                     \
      LAYER(ROUGHNESS) = rough,                                                                    \
      LAYER(IOR) = 1.5f,                                                                           \
      LAYER(SPECULAR) = 1,                                                                         \
      LAYER(SPECULAR_COLOR) = 1,                                                                   \
      1,                                                                                           \
      1,                                                                                           \
      LAYER(ANISOTROPY_ROTATION) = 1,                                                              \
      LAYER(ANISOTROPY_DIRECTION) = 1,                                                             \
      __VA_ARGS__                                                                                  \
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
    GLTF(1, 0.0f, 1, 1),
    GLTF(1, 0.3f, 1, 1),
    GLTF(0.7f, 1.0f, 1, 1),
    GLTF(1, 0.2f, 0, 1.7f),
    GLTF(1, 0.6f, 0, 1.25f),
    GLTF(0.2f, 1.0f, 0, 1),
    GLTF(0, 0.4f, 0, 1),
    GLTF(0.5f, 0.5f, 0.5f, 1.25f),
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
    LAYERED("plain", 0, 0.5f, 0.25f, 1.2f, 0, LAYER(DISPERSION) = 0),
    LAYERED("metal", 1, 0.3f, 0.09f, 1, 0, LAYER(DISPERSION) = 0),
    LAYERED("brushed", 1, 0.4f, 0.16f, 1, 0, LAYER(ANISOTROPY_STRENGTH) = 0.7f),
    LAYERED("clearcoat", 0.5f, 0.6f, 0.01f, 1, 0, LAYER(CLEARCOAT) = 1,
            LAYER(CLEARCOAT_ROUGHNESS) = 0.1f),
    LAYERED("dull coat", 0, 0.8f, 0.25f, 1, 0, LAYER(CLEARCOAT) = 1,
            LAYER(CLEARCOAT_ROUGHNESS) = 0.5f),
    LAYERED("sheen", 0, 1.0f, 1.0f, 1, 0, LAYER(SHEEN_COLOR) = 1, 0.5f, 0.2f,
            LAYER(SHEEN_ROUGHNESS) = 0.5f),
    LAYERED("film", 0, 0.2f, 0.04f, 1.55f, 0, LAYER(IRIDESCENCE) = 1, LAYER(IRIDESCENCE_IOR) = 1.3f,
            LAYER(IRIDESCENCE_THICKNESS) = 400),
    LAYERED("film on metal", 1, 0.4f, 0.16f, 1, 0, LAYER(IRIDESCENCE) = 1,
            LAYER(IRIDESCENCE_IOR) = 1.8f, LAYER(IRIDESCENCE_THICKNESS) = 700),
    LAYERED("sheet", 0, 0.4f, 0.16f, 1, 0, LAYER(TRANSMISSION) = 1),
    LAYERED("clear sheet", 0, 0.0f, 0.001f, 1.25f, 0, LAYER(TRANSMISSION) = 0.7f),
    LAYERED("volume", 0, 0.4f, 0.05f, 1, 1.5f, LAYER(TRANSMISSION) = 1, LAYER(THICKNESS) = 1),
    LAYERED("leaf", 0, 0.6f, 0.36f, 1.1f, 0, LAYER(DIFFUSE_TRANSMISSION) = 0.6f,
            LAYER(DIFFUSE_TRANSMISSION_COLOR) = 1, 0.5f, 0.2f),
    LAYERED("retro", 0.5f, 0.4f, 0.16f, 1.1f, 0, LAYER(RETROREFLECTION) = 1),
    LAYERED("all", 0.2f, 0.5f, 0.04f, 1, 0, LAYER(ANISOTROPY_STRENGTH) = 0.5f,
            LAYER(CLEARCOAT) = 0.5f, LAYER(CLEARCOAT_ROUGHNESS) = 0.2f, LAYER(SHEEN_COLOR) = 0.3f,
            0.3f, 0.3f, LAYER(SHEEN_ROUGHNESS) = 0.3f, LAYER(IRIDESCENCE) = 0.5f,
            LAYER(IRIDESCENCE_IOR) = 1.5f, LAYER(IRIDESCENCE_THICKNESS) = 300,
            LAYER(TRANSMISSION) = 0.5f, LAYER(DIFFUSE_TRANSMISSION) = 0.3f,
            LAYER(DIFFUSE_TRANSMISSION_COLOR) = 1, 1, 1, LAYER(RETROREFLECTION) = 0.3f),
    {NULL},
};
