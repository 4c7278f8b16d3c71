/* Error metrics against values computed by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "image/compare.h"

static void equal_pictures_are_identical(void **state) {
  (void)state;
  const float a[6] = {0.0f, 1.0f, 2.0f, -3.0f, 0.5f, 1e-30f};
  cdl_ImageMetrics m;
  assert_int_equal(image_compare(NULL, 2, 1, 3, a, a, &m), CDL_OK);
  assert_true(m.identical);
  assert_true(m.mse == 0.0 && m.rmse == 0.0 && m.relative_mse == 0.0 && m.max_abs == 0.0);
  assert_true(isinf(m.psnr) && m.psnr > 0.0);
  assert_true(isnan(m.ssim));
  assert_int_equal(m.pixels, 2);
  assert_int_equal(m.finite_pixels, 2);
}

/* Two pixels of two channels: d = 0.1, 0, -0.3, 0.2. */
static void metrics_match_hand_computation(void **state) {
  (void)state;
  const float a[4] = {1.1f, 2.0f, 0.2f, 1.0f}, b[4] = {1.0f, 2.0f, 0.5f, 0.8f};
  cdl_ImageMetrics m;
  assert_int_equal(image_compare(NULL, 1, 2, 2, a, b, &m), CDL_OK);
  assert_false(m.identical);
  assert_float_equal(m.mse, 0.14 / 4, 1e-7);
  assert_float_equal(m.rmse, sqrt(0.035), 1e-7);
  assert_float_equal(m.relative_mse, (0.01 / 1.01 + 0.09 / 0.26 + 0.04 / 0.65) / 4, 1e-6);
  assert_float_equal(m.psnr, 14.5593, 1e-4);
  assert_float_equal(m.max_abs, 0.3, 1e-7);
  assert_int_equal(m.max_x, 0);
  assert_int_equal(m.max_y, 1);
  assert_float_equal(m.mean[0][0], 0.65, 1e-7);
  assert_float_equal(m.mean[1][0], 0.75, 1e-7);
  assert_float_equal(m.bias[0], -0.1, 1e-7);
  assert_float_equal(m.bias[1], 0.1, 1e-7);
}

static void nonfinite_pixels_are_counted_and_left_out(void **state) {
  (void)state;
  const float a[9] = {NAN, INFINITY, 0.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f};
  const float b[9] = {0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 0.0f, -INFINITY, 0.0f};
  cdl_ImageMetrics m;
  assert_int_equal(image_compare(NULL, 3, 1, 3, a, b, &m), CDL_OK);
  assert_int_equal(m.nonfinite[0], 2);
  assert_int_equal(m.nonfinite[1], 1);
  assert_int_equal(m.finite_pixels, 1);
  assert_float_equal(m.mse, 1.0 / 3.0, 1e-12);
  assert_int_equal(m.max_x, 1);
}

static void identical_means_bits(void **state) {
  (void)state;
  const float zero[1] = {0.0f}, minus[1] = {-0.0f}, nan[1] = {NAN};
  cdl_ImageMetrics m;
  assert_int_equal(image_compare(NULL, 1, 1, 1, zero, minus, &m), CDL_OK);
  assert_false(m.identical);
  assert_true(m.mse == 0.0);
  assert_int_equal(image_compare(NULL, 1, 1, 1, nan, nan, &m), CDL_OK);
  assert_true(m.identical);
}

/* Flat planes have no variance or covariance: only the luminance term is left,
 * (2 × 0.4 × 0.5 + C1) / (0.16 + 0.25 + C1) with C1 = 0.0001. */
static void ssim_of_flat_planes_is_the_luminance_term(void **state) {
  (void)state;
  float a[12 * 13], b[12 * 13];
  for (int i = 0; i < 12 * 13; i++) {
    a[i] = 0.4f;
    b[i] = 0.5f;
  }
  assert_float_equal(image_ssim(12, 13, a, b), 0.4001 / 0.4101, 1e-6);
  assert_float_equal(image_ssim(12, 13, a, a), 1.0, 1e-12);
  assert_true(isnan(image_ssim(12, 10, a, b)));
}

/* An inverted pattern about the same mean: covariance is minus the variance, here by a direct sum
 * over the one window there is. */
static void ssim_of_one_window_matches_the_definition(void **state) {
  (void)state;
  float a[121], b[121];
  double weight[121], sum = 0.0, ma = 0.0, mb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (int i = 0; i < 121; i++) {
    const int x = i % 11 - 5, y = i / 11 - 5;
    a[i] = 0.5f + 0.3f * (float)((x + y) & 1) + 0.01f * (float)x;
    b[i] = 0.9f - 0.5f * a[i] + 0.02f * (float)y;
    sum += weight[i] = exp(-(x * x + y * y) / (2.0 * 1.5 * 1.5));
  }
  for (int i = 0; i < 121; i++) {
    ma += weight[i] / sum * a[i];
    mb += weight[i] / sum * b[i];
  }
  for (int i = 0; i < 121; i++) {
    aa += weight[i] / sum * (a[i] - ma) * (a[i] - ma);
    bb += weight[i] / sum * (b[i] - mb) * (b[i] - mb);
    ab += weight[i] / sum * (a[i] - ma) * (b[i] - mb);
  }
  const double expected =
      (2 * ma * mb + 1e-4) / (ma * ma + mb * mb + 1e-4) * (2 * ab + 9e-4) / (aa + bb + 9e-4);
  assert_true(expected < 0.0);
  assert_float_equal(image_ssim(11, 11, a, b), expected, 1e-9);
}

static void odd_shapes_are_refused(void **state) {
  (void)state;
  const float a[5] = {0};
  cdl_ImageMetrics m;
  assert_int_equal(image_compare(NULL, 1, 1, 5, a, a, &m), CDL_USAGE);
  assert_int_equal(image_compare(NULL, 0, 1, 3, a, a, &m), CDL_USAGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_pictures_are_identical),
      cmocka_unit_test(metrics_match_hand_computation),
      cmocka_unit_test(nonfinite_pixels_are_counted_and_left_out),
      cmocka_unit_test(identical_means_bits),
      cmocka_unit_test(ssim_of_flat_planes_is_the_luminance_term),
      cmocka_unit_test(ssim_of_one_window_matches_the_definition),
      cmocka_unit_test(odd_shapes_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
