/* medium.h: homogeneous participating media. */
#ifndef CDL_ABI_MEDIUM_H
#define CDL_ABI_MEDIUM_H

#include "abi/types.h"

#define CDL_MEDIUM_VACUUM 0u /* index of the medium that is none */

typedef struct cdl_Medium {
  float absorption[3]; /* 1/m */
  float g;             /* Henyey-Greenstein asymmetry, (-1,1); > 0 is forward */
  float scattering[3]; /* 1/m */
  uint emissive;       /* 1: emission is not black */
  float emission[3];   /* radiance per metre */
  uint pad;
} cdl_Medium;
CDL_ABI_SIZE(cdl_Medium, 48);

#endif
