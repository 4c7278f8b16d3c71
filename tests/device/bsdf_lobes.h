/* bsdf_lobes.h: a case of bsdf_models.h seen from one direction: charts that lie well about its
 * lobes, and its densities integrated over their cells, in double on the host. */
#ifndef CANDELA_TESTS_BSDF_LOBES_H
#define CANDELA_TESTS_BSDF_LOBES_H

#include "tests/device/bsdf_chart.h"
#include "tests/device/bsdf_models.h"

enum { BSDF_VIEWS = 6 };

/* wo of a view, by falling cosine but for the last but one; the last is at 89.9 degrees. Directions
 * in single precision tell slopes apart by 3e-8 / cosine; lobes of that width are seen along an
 * axis, where two of the three coordinates have all their digits, from where the third has them
 * too. */
vec3 bsdf_view(const BsdfCase *c, size_t view);
double bsdf_view_cosine(size_t view);

/* Index beyond over index before; of dispersive materials at the case's wavelength. */
double bsdf_eta_of(const BsdfCase *c);

typedef struct BsdfLobes {
  const BsdfModel *model;
  _Alignas(16) unsigned char params[BSDF_PARAMS_SIZE];
  vec3 wo;
  BsdfChart charts[2]; /* above, below */
} BsdfLobes;

/* The charts refer to *l. */
void bsdf_lobes_init(BsdfLobes *l, const BsdfCase *c, BsdfPoint point, vec3 wo);

#endif
