#include "tests/device/bsdf_models.h"
#include "tests/device/bsdf_setup.h"

#include "bsdf/body.h"
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

#define UNIT                                                                                       \
  { 0, 1, 0 }
#define ALPHA                                                                                      \
  { 0, 1, 1e-5f }
#define IOR                                                                                        \
  { 1, 3, 0 }
#define RGB(low, high, fine)                                                                       \
  {low, high, fine}, {low, high, fine}, { low, high, fine }

static const BsdfRange diffuse_ranges[] = {{0, 0, 0}};
static const BsdfRange mirror_ranges[] = {{0, 0, 0}};
#define GLASS_IOR                                                                                  \
  { 0.3f, 3, 0 }
#define ABBE                                                                                       \
  { 0, 100, 5 }

static const BsdfRange dielectric_ranges[] = {GLASS_IOR, ABBE};
static const BsdfRange rough_dielectric_ranges[] = {ALPHA, ALPHA, GLASS_IOR, ABBE};
static const BsdfRange oren_nayar_ranges[] = {UNIT};
static const BsdfRange plastic_ranges[] = {ALPHA, ALPHA, IOR};
static const BsdfRange body_ranges[] = {ALPHA, ALPHA, IOR};
static const BsdfRange disney_ranges[] = {UNIT,      UNIT, UNIT, UNIT, UNIT, UNIT,
                                          UNIT,      UNIT, UNIT, UNIT, UNIT, {0.5f, 2.5f, 0},
                                          {0, 2, 0}, UNIT, UNIT};
static const BsdfRange gltf_layered_ranges[] = {
    UNIT, UNIT,       IOR,          UNIT,       RGB(0, 2, 0), /* specular and its colour */
    UNIT, {-1, 1, 0}, {-1, 1, 0},   {-1, 1, 0}, {-1, 1, 0},   /* anisotropy */
    UNIT, UNIT,       RGB(0, 1, 0), UNIT,                     /* coat, sheen */
    UNIT, {1, 3, 0},  {0, 1200, 0},                           /* film */
    UNIT, UNIT,       {0, 3, 0},    UNIT,       RGB(0, 1, 0), UNIT};
static const BsdfRange conductor_ranges[] = {ALPHA, ALPHA, RGB(0, 4, 0), RGB(0, 10, 0)};
static const BsdfRange retroreflector_ranges[] = {ALPHA, ALPHA, IOR};
static const BsdfRange gltf_ranges[] = {UNIT, UNIT, IOR};

/* Models without words have a range that is never read. */
#define M(MODEL, name, count)                                                                      \
  _Static_assert(count == 0 || sizeof name##_ranges / sizeof *name##_ranges == (count), #name);    \
  enum { name##_words = (count), name##_is_tested = BSDF_##name };
/* The first shows its base colour and scatters nothing; what goes under the others leaves
 * elsewhere: tests/unit/test_bssrdf.c, tests/render/test_bssrdf.py. */
enum { BSDF_unlit, BSDF_subsurface, BSDF_subsurface_exit };
static const BsdfRange unlit_ranges[1], subsurface_ranges[CDL_SUBSURFACE_PARAMS],
    subsurface_exit_ranges[CDL_SUBSURFACE_PARAMS];
CDL_SHADED_MODELS(M)
#undef M

const BsdfModel bsdf_models[BSDF_MODEL_COUNT] = {
#define MODEL(name, Type, through, flags, weight)                                                  \
  {#name, #Type, through, flags, weight, name##_ranges, name##_words, name##_prepare, name##_of},
    BSDF_MODELS(MODEL)
#undef MODEL
};

static size_t length(const BsdfCase *list) {
  size_t count = 0;
  while (list[count].name) count++;
  return count;
}

const BsdfCase *bsdf_case(size_t index) {
  const BsdfCase *lists[] = {bsdf_cases_opaque, bsdf_cases_glass, bsdf_cases_gltf};
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
    size_t count = length(lists[i]);
    if (index < count) return &lists[i][index];
    index -= count;
  }
  return NULL;
}
