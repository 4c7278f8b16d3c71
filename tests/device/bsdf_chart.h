/* bsdf_chart.h: a chart of the directions on one side of a surface, for chi-squared tests of
 * densities that may be narrow.
 *
 * Around the middle of the lobe, x = log(1 + s / spread) / range with s = 1 - cos of the angle to
 * it, and y the angle around it in turns, from the lowest direction on, where what is sideways
 * counts 1 / aspect times: lobes that graze are narrow to the side. So lobes narrow and wide, and
 * both together, fill many cells. The horizon is cut off exactly: above it, y spans one interval at
 * every x. */
#ifndef CANDELA_TESTS_BSDF_CHART_H
#define CANDELA_TESTS_BSDF_CHART_H

#include "tests/device/bsdf_setup.h"

/* Density per solid angle of a unit vector on the chart's side. */
typedef double (*BsdfDensity)(const void *context, const double w[3]);

typedef struct BsdfChart {
  BsdfDensity density;
  const void *context;
  int horizon_depth; /* cells on the horizon are halved as often, up to 6; 3 is good for 4e-4 */
  double edge[3];    /* normal of a plane on which the density jumps, or 0; refined likewise */
  int below;         /* the directions with z < 0; the chart has them mirrored up */
  double axes[3][3], spread, range, aspect;
} BsdfChart;

/* `middle` (any length, z >= 0 once mirrored up) is the middle of the lobe, `width` its alpha, > 0.
 * The other members are the caller's to set. */
void bsdf_chart_init(BsdfChart *chart, const double middle[3], double width);

/* What a kernel needs of it. */
BsdfChartSetup bsdf_chart_setup(const BsdfChart *chart);

/* The integral over each cell, and their sum as result: to 3e-4 of it or 2e-7, whichever is more.
 */
double bsdf_chart_integrate(const BsdfChart *chart, double cells[BSDF_CELLS]);

#endif
