/* bsdf.h: a cdl_Bsdf, for the module that draws it. */
#ifndef CANDELA_RENDER_BSDF_H
#define CANDELA_RENDER_BSDF_H

#include "candela.h"

const cdl_Log *bsdf_log(const cdl_Bsdf *bsdf);
const char *bsdf_name(const cdl_Bsdf *bsdf); /* of the material, may be empty; the bsdf's */

#endif
