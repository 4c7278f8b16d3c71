/* light.h: everything that light comes from, one list for all kinds. */
#ifndef CDL_ABI_LIGHT_H
#define CDL_ABI_LIGHT_H

#include "abi/types.h"

#define CDL_LIGHT_TRIANGLE 0u
#define CDL_LIGHT_POINT 1u /* a spot is a point with a cone */
#define CDL_LIGHT_DIRECTIONAL 2u
#define CDL_LIGHT_ENVIRONMENT 3u

/* cdl_Light.flags of a triangle */
#define CDL_LIGHT_DOUBLE_SIDED 1u /* emits from both sides */
#define CDL_LIGHT_MIRRORED 2u     /* the front is at -(e1 x e2): its instance mirrors it */

/* A light. Triangles: corner p, edges e1 and e2 in the world, e1 x e2 to the front. Points:
 * position p, axis e1 (unit, where a spot shines). Directional: e1 is where the light goes, unit.
 */
typedef struct cdl_Light {
  uint type;
  float select_pdf; /* probability of being chosen */
  uint triangle;    /* global number, for textured emission; else CDL_NONE */
  uint material;    /* of a triangle; else CDL_NONE */
  float p[3];
  float area; /* of a triangle, m2 */
  float e1[3];
  float range; /* of a point, m; 0: unlimited */
  float e2[3];
  uint flags;        /* CDL_LIGHT_DOUBLE_SIDED, CDL_LIGHT_MIRRORED */
  float radiance[3]; /* triangle: radiance; point: intensity, W/sr; directional: irradiance, W/m2 */
  float cone_scale;  /* KHR_lights_punctual: clamp(cos scale + offset)^2; 0 and 1: no cone */
  float cone_offset;
  uint pad[3];
} cdl_Light;
CDL_ABI_SIZE(cdl_Light, 96);

/* Walker's alias method: take slot i with probability `keep`, else `alias`. */
typedef struct cdl_AliasEntry {
  float keep;
  uint alias;
  float pdf; /* probability of slot i itself */
  uint pad;
} cdl_AliasEntry;
CDL_ABI_SIZE(cdl_AliasEntry, 16);

#endif
