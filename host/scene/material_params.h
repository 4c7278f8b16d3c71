/* material_params.h: tables of what a material model reads from its JSON object. */
#ifndef CANDELA_SCENE_MATERIAL_PARAMS_H
#define CANDELA_SCENE_MATERIAL_PARAMS_H

#include "scene/build.h"

enum { CHANNEL_R, CHANNEL_G, CHANNEL_B, CHANNEL_A, CHANNELS_COLOR }; /* the last: RGB, from sRGB */

/* One member: up to three words of cdl_SceneMaterial.param from `param` on, a number standing for
 * all of them, and the texture that multiplies them. */
typedef struct ParamMember {
  const char *name;
  uint32_t param; /* CDL_<MODEL>_<NAME> */
  uint32_t words;
  float value[3];      /* where the member is absent */
  const char *texture; /* its member, or NULL */
  uint32_t channel;    /* CHANNEL… */
} ParamMember;

/* Reads the members (ended by a NULL name) of `json`; without an object, all get their defaults. */
cdl_Status build_params(Builder *builder, const char *at, const json_t *json,
                        const ParamMember *members, cdl_SceneMaterial *material);

#endif
