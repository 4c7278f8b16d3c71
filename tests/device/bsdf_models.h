/* bsdf_models.h: the material models and the parameters with which test_bsdf.c tests them.
 *
 * A new model is one row of BSDF_MODELS, the ranges of its parameters, and cases; none of those
 * that shading kernels are made for can be left out. */
#ifndef CANDELA_TESTS_BSDF_MODELS_H
#define CANDELA_TESTS_BSDF_MODELS_H

#include "abi/material.h"
#include "bsdf/bsdf.h"

/* name: kernels/bsdf/name.h and its functions; Type: of its parameters; through: 1 if light can
 * pass; flags: of CDL_MATERIAL_*, those that it reads; weight: the heaviest that a sample may be,
 * whatever the parameters. */
#define BSDF_MODELS(MODEL)                                                                         \
  MODEL(diffuse, DiffuseParams, 0, 0, 1.0f)                                                        \
  MODEL(mirror, MirrorParams, 0, 0, 1.0f)                                                          \
  MODEL(conductor, ConductorParams, 0, BECKMANN | SEPARABLE | COMPENSATED, 1e6f)                   \
  MODEL(dielectric, DielectricParams, 1, THIN, 1e6f)                                               \
  MODEL(retroreflector, RetroreflectorParams, 0, BECKMANN | SEPARABLE, 1.001f)                     \
  MODEL(gltf, GltfParams, 0, 0, 30.0f)                                                             \
  MODEL(oren_nayar, OrenNayarParams, 0, 0, 10.0f)                                                  \
  MODEL(plastic, PlasticParams, 0, BECKMANN | SEPARABLE, 100.0f)                                   \
  MODEL(rough_dielectric, RoughDielectricParams, 1, BECKMANN | SEPARABLE | COMPENSATED | THIN,     \
        1e6f)                                                                                      \
  MODEL(body, BodyParams, 1, BECKMANN | SEPARABLE, 1000.0f)                                        \
  MODEL(disney, DisneyParams, 1, 0, 1000.0f)                                                       \
  MODEL(gltf_layered, GltfLayeredParams, 1, 0, 1e6f)

#define BECKMANN CDL_MATERIAL_BECKMANN
#define SEPARABLE CDL_MATERIAL_SEPARABLE
#define COMPENSATED CDL_MATERIAL_ENERGY_COMPENSATED
#define THIN CDL_MATERIAL_THIN

enum {
#define MODEL(name, Type, through, flags, weight) BSDF_##name,
  BSDF_MODELS(MODEL)
#undef MODEL
      BSDF_MODEL_COUNT
};

/* Of a parameter's word: uniform in [low, high], or, half the time, in the logarithm from
 * `fine` > 0 on. */
typedef struct BsdfRange {
  float low, high, fine;
} BsdfRange;

typedef struct BsdfModel {
  const char *name, *type;
  int transmits;
  unsigned flags;
  float weight_max;
  const BsdfRange *ranges; /* of each word, */
  size_t words;            /* as many as there are */
  /* The parameters at a point from their words, as a model keeps them, in `params` (which has
   * BSDF_PARAMS_SIZE bytes); and their evaluation. */
  void (*prepare)(void *params, BsdfPoint point, const uint *words);
  BsdfValue (*evaluate)(const void *params, vec3 wo, vec3 wi);
} BsdfModel;

enum { BSDF_PARAMS_SIZE = 1024 };

extern const BsdfModel bsdf_models[BSDF_MODEL_COUNT];

typedef struct BsdfCase {
  const char *name;
  int model; /* BSDF_… */
  float base[3];
  uint flags;
  int inside; /* 1: wo is on the back */
  float words[CDL_PARAM_MAX];
  float coat_normal[2]; /* x, y */
  float abbe;           /* > 0: the path is left one channel and its wavelength, of [0,1) */
  int channel;
  float wavelength;
  float width;        /* of the narrowest lobe, its alpha; 1: a cosine */
  int center;         /* BSDF_CENTER_* */
  float eta;          /* index inside over outside where light is refracted; else 0 */
  float energy;       /* the most that it may return of uniform light; 0: 1 */
  float least;        /* and the least, */
  float least_cosine; /* at views from this cosine up */
  float reciprocity;  /* relative; 0: 1e-3; negative: not reciprocal, as published */
} BsdfCase;

/* Where the narrowest lobe above the surface has its middle. */
enum { BSDF_CENTER_MIRROR, BSDF_CENTER_NORMAL, BSDF_CENTER_VIEW };

/* Each ends with a NULL name. */
extern const BsdfCase bsdf_cases_opaque[], bsdf_cases_glass[], bsdf_cases_gltf[];

/* The cases of all lists; NULL beyond the last. */
const BsdfCase *bsdf_case(size_t index);

#endif
