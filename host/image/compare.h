/* compare.h: how far two pictures are apart. */
#ifndef CANDELA_IMAGE_COMPARE_H
#define CANDELA_IMAGE_COMPARE_H

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

#define IMAGE_METRIC_CHANNELS 4

/* Means are over all channels of the pixels that are finite in both pictures; with none of them,
 * the sums are 0. d = a - b, b being the reference. */
typedef struct cdl_ImageMetrics {
  int identical;                         /* every value has the same bits, NaN included */
  size_t pixels;                         /* in each picture */
  size_t finite_pixels;                  /* that the numbers below are made of */
  size_t nonfinite[2];                   /* values of a and of b that are infinite or NaN */
  double mse;                            /* mean of d² */
  double rmse;                           /* its root */
  double relative_mse;                   /* mean of d² / (b² + 0.01) */
  double psnr;                           /* dB against a peak of 1; infinite when mse is 0 */
  double max_abs;                        /* largest |d| */
  int max_x, max_y;                      /* where that is first */
  double mean[2][IMAGE_METRIC_CHANNELS]; /* of a and of b, by channel */
  double bias[IMAGE_METRIC_CHANNELS];    /* mean of d by channel */
  double ssim; /* structural similarity of the sRGB-encoded luminance, -1 to 1; NaN when a side is
                  under 11 pixels, or something is not finite */
} cdl_ImageMetrics;

/* Compares two pictures of height × width × channels (1 to 4) floats. CDL_USAGE for other channel
 * counts or an empty picture; CDL_BAD_INPUT when memory runs out. */
cdl_Status image_compare(const cdl_Log *log, int width, int height, int channels, const float *a,
                         const float *b, cdl_ImageMetrics *metrics);

/* Mean structural similarity of two planes of values within 0..1, each side at least 11 (Wang et
 * al. 2004, equation 13: Gaussian window of 11 × 11, σ = 1.5, K = 0.01 and 0.03; windows that lie
 * wholly inside). NaN when memory runs out or the planes are smaller. */
double image_ssim(int width, int height, const float *a, const float *b);

#ifdef __cplusplus
}
#endif
#endif
