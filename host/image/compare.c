#include "image/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/tonemap.h"

#define RELATIVE_FLOOR 0.01

static int count_nonfinite(const float *pixel, int channels) {
  int count = 0;
  for (int c = 0; c < channels; c++) count += !isfinite(pixel[c]);
  return count;
}

/* Adds one pixel that is finite in both pictures; sums become means in finish(). */
static void add_pixel(cdl_ImageMetrics *m, int channels, const float *a, const float *b, int x,
                      int y) {
  for (int c = 0; c < channels; c++) {
    const double va = a[c], vb = b[c], d = va - vb;
    m->mse += d * d;
    m->relative_mse += d * d / (vb * vb + RELATIVE_FLOOR);
    m->mean[0][c] += va;
    m->mean[1][c] += vb;
    m->bias[c] += d;
    if (fabs(d) <= m->max_abs) continue;
    m->max_abs = fabs(d);
    m->max_x = x;
    m->max_y = y;
  }
  m->finite_pixels++;
}

static void finish(cdl_ImageMetrics *m, int channels) {
  const double pixels = m->finite_pixels ? (double)m->finite_pixels : 1.0;
  m->mse /= pixels * channels;
  m->relative_mse /= pixels * channels;
  for (int c = 0; c < channels; c++) {
    m->mean[0][c] /= pixels;
    m->mean[1][c] /= pixels;
    m->bias[c] /= pixels;
  }
  m->rmse = sqrt(m->mse);
  m->psnr = m->mse > 0.0 ? -10.0 * log10(m->mse) : (double)INFINITY;
}

/* Luminance (Rec. 709 weights) as a display shows it: SSIM is a measure of what is seen. */
static void display_luminance(const float *rgb, int channels, size_t pixels, float *out) {
  for (size_t i = 0; i < pixels; i++) {
    const float *p = rgb + i * (size_t)channels;
    const float y = channels < 3 ? p[0] : 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    out[i] = tonemap_srgb_encode(fminf(fmaxf(y, 0.0f), 1.0f));
  }
}

static cdl_Status add_ssim(const cdl_Log *log, int width, int height, int channels, const float *a,
                           const float *b, cdl_ImageMetrics *m) {
  const size_t pixels = (size_t)width * (size_t)height;
  float *planes = malloc(2 * pixels * sizeof *planes);
  if (!planes) return log_fail(log, CDL_BAD_INPUT, "not enough memory to compare the pictures");
  display_luminance(a, channels, pixels, planes);
  display_luminance(b, channels, pixels, planes + pixels);
  m->ssim = image_ssim(width, height, planes, planes + pixels);
  free(planes);
  return CDL_OK;
}

cdl_Status image_compare(const cdl_Log *log, int width, int height, int channels, const float *a,
                         const float *b, cdl_ImageMetrics *metrics) {
  memset(metrics, 0, sizeof *metrics);
  metrics->ssim = (double)NAN;
  if (width < 1 || height < 1 || channels < 1 || channels > IMAGE_METRIC_CHANNELS)
    return log_fail(log, CDL_USAGE, "cannot compare pictures of %d x %d with %d channels", width,
                    height, channels);
  metrics->pixels = (size_t)width * (size_t)height;
  metrics->identical = memcmp(a, b, metrics->pixels * (size_t)channels * sizeof *a) == 0;
  for (size_t i = 0; i < metrics->pixels; i++) {
    const float *pa = a + i * (size_t)channels, *pb = b + i * (size_t)channels;
    const int bad_a = count_nonfinite(pa, channels), bad_b = count_nonfinite(pb, channels);
    metrics->nonfinite[0] += (size_t)bad_a;
    metrics->nonfinite[1] += (size_t)bad_b;
    if (bad_a + bad_b) continue;
    add_pixel(metrics, channels, pa, pb, (int)(i % (size_t)width), (int)(i / (size_t)width));
  }
  finish(metrics, channels);
  if (metrics->finite_pixels < metrics->pixels) return CDL_OK;
  return add_ssim(log, width, height, channels, a, b, metrics);
}
