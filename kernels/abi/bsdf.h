/* bsdf.h: what the kernels that answer questions about one material are told. */
#ifndef CDL_ABI_BSDF_H
#define CDL_ABI_BSDF_H

#include "abi/types.h"

typedef struct cdl_BsdfQuery {
  uint count;        /* results asked for */
  uint samples;      /* of each direction */
  uint first;        /* direction of the first result, among all that are asked about */
  uint first_sample; /* and its sample */
  uint seed;
  uint
      wavelengths; /* that an evaluation is the mean of: 3 of these to each; 0 without dispersion */
  uint pad[2];
} cdl_BsdfQuery;
CDL_ABI_SIZE(cdl_BsdfQuery, 32);

#endif
