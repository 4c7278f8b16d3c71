#include <math.h>
#include <stdlib.h>

#include "image/compare.h"

#define WINDOW 11
#define SIGMA 1.5
#define C1 (0.01 * 0.01) /* (K1 L)², L = 1 */
#define C2 (0.03 * 0.03)
#define MOMENTS 5 /* a, b, a², b², ab */

static void fill_window(double window[WINDOW]) {
  double sum = 0.0;
  for (int i = 0; i < WINDOW; i++) {
    const double x = (i - WINDOW / 2) / SIGMA;
    sum += window[i] = exp(-0.5 * x * x);
  }
  for (int i = 0; i < WINDOW; i++) window[i] /= sum;
}

/* The moments of one row, smoothed along it: `columns` × MOMENTS. */
static void smooth_row(const double window[WINDOW], int columns, const float *a, const float *b,
                       double *out) {
  for (int x = 0; x < columns; x++) {
    double sum[MOMENTS] = {0};
    for (int i = 0; i < WINDOW; i++) {
      const double va = a[x + i], vb = b[x + i], w = window[i];
      const double value[MOMENTS] = {va, vb, va * va, vb * vb, va * vb};
      for (int m = 0; m < MOMENTS; m++) sum[m] += w * value[m];
    }
    for (int m = 0; m < MOMENTS; m++) out[x * MOMENTS + m] = sum[m];
  }
}

/* Wang et al. 2004, equation 13. */
static double similarity(const double m[MOMENTS]) {
  const double aa = m[2] - m[0] * m[0], bb = m[3] - m[1] * m[1], ab = m[4] - m[0] * m[1];
  return (2.0 * m[0] * m[1] + C1) * (2.0 * ab + C2) /
         ((m[0] * m[0] + m[1] * m[1] + C1) * (aa + bb + C2));
}

/* One row of windows out of the last WINDOW smoothed rows, which lie in a ring. */
static double sum_row(const double window[WINDOW], int columns, const double *ring, int top) {
  double sum = 0.0;
  for (int x = 0; x < columns; x++) {
    double moments[MOMENTS] = {0};
    for (int i = 0; i < WINDOW; i++) {
      const double *row =
          ring + ((size_t)((top + i) % WINDOW) * (size_t)columns + (size_t)x) * MOMENTS;
      for (int m = 0; m < MOMENTS; m++) moments[m] += window[i] * row[m];
    }
    sum += similarity(moments);
  }
  return sum;
}

double image_ssim(int width, int height, const float *a, const float *b) {
  const int columns = width - WINDOW + 1, rows = height - WINDOW + 1;
  if (columns < 1 || rows < 1) return (double)NAN;
  double window[WINDOW], sum = 0.0;
  double *ring = malloc((size_t)columns * WINDOW * MOMENTS * sizeof *ring);
  if (!ring) return (double)NAN;
  fill_window(window);
  for (int y = 0; y < height; y++) {
    const size_t at = (size_t)y * (size_t)width;
    smooth_row(window, columns, a + at, b + at,
               ring + (size_t)(y % WINDOW) * (size_t)columns * MOMENTS);
    if (y >= WINDOW - 1) sum += sum_row(window, columns, ring, y - WINDOW + 1);
  }
  free(ring);
  return sum / ((double)columns * rows);
}
