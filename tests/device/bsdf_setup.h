/* bsdf_setup.h: what test_bsdf.c and the kernels of bsdf.cl share; stands before the text of those.
 * 4-byte scalars and arrays of them only. */
#ifndef CANDELA_TESTS_BSDF_SETUP_H
#define CANDELA_TESTS_BSDF_SETUP_H

#include "bsdf/all_layers.h"

#define BSDF_STRIP 16u /* items of a work-item, neighbours */

/* Cells of a chart of the directions on one side of the surface: bsdf_chart.h. The last cell of all
 * holds the samples without a density: delta lobes, and directions that came out on the wrong side.
 */
#define BSDF_CELLS_X 20u
#define BSDF_CELLS_Y 24u
#define BSDF_CELLS (BSDF_CELLS_X * BSDF_CELLS_Y)
#define BSDF_CELL_NONE (2u * BSDF_CELLS)

typedef struct BsdfChartSetup {
  float axes[9]; /* rows x, y, z; z is the middle of the lobe */
  float spread;  /* of 1 - cos to the middle, about that of the lobe */
  float inverse_aspect;
  float inverse_range; /* x = log(1 + s / spread) inverse_range */
} BsdfChartSetup;

typedef struct BsdfSetup {
  float base[3], throughput[3], coat_normal[3];
  float wavelength, channel_choice;
  unsigned int flags;
  int front;
  float wo[3];
  unsigned int seed;
  unsigned int param_sets;  /* of the stress test, a power of two */
  float weight_max;         /* likewise: no sample may weigh more */
  float tolerance;          /* relative, of sample against evaluate */
  BsdfChartSetup charts[2]; /* above, below (mirrored up) */
} BsdfSetup;

/* Rows of results, one word an item each. */
#define BSDF_SAMPLE_ROWS 3u /* cell, heaviest channel of the weight times eta^2, faults */
#define BSDF_DRAW_ROWS 9u   /* wi, weight, pdf, eta, delta + 2 transmitted */
#define BSDF_PAIR_ROWS 9u   /* f(wo, wi) rgb, f(wi, wo) rgb, pdf(wo, wi), f cos and pdf below */

/* Bits of what is wrong with a sample or an evaluation. */
#define BSDF_FAULT_WEIGHT 1u      /* not finite, negative or too heavy */
#define BSDF_FAULT_PDF 2u         /* not finite or negative; or not 0 for a delta lobe */
#define BSDF_FAULT_DIRECTION 4u   /* not of length 1 */
#define BSDF_FAULT_VALUE 8u       /* of evaluate: not finite or negative */
#define BSDF_FAULT_SIDE 16u       /* weight on the side where `transmitted` says it is not */
#define BSDF_FAULT_SAME_PDF 32u   /* sample's pdf is not evaluate's */
#define BSDF_FAULT_SAME_VALUE 64u /* weight pdf is not f cos */
#define BSDF_FAULT_LOST 128u      /* weight without a pdf, and no delta lobe */

#endif
