/* test_blackbody.c: the radiance of black bodies, by host and device, against Planck's law under
 * the tabulated observer, and against what is published of its colours. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "scene/blackbody.h"
#include "tests/device/grid_device.h"

/* The CIE 1931 standard observer, 380 to 780 nm by 10. */
enum { BANDS = 41 };
static const double observer[BANDS][3] = {
    {.0014, .0000, .0065},  {.0042, .0001, .0201},  {.0143, .0004, .0679},  {.0435, .0012, .2074},
    {.1344, .0040, .6456},  {.2839, .0116, 1.3856}, {.3483, .0230, 1.7471}, {.3362, .0380, 1.7721},
    {.2908, .0600, 1.6692}, {.1954, .0910, 1.2876}, {.0956, .1390, .8130},  {.0320, .2080, .4652},
    {.0049, .3230, .2720},  {.0093, .5030, .1582},  {.0633, .7100, .0782},  {.1655, .8620, .0422},
    {.2904, .9540, .0203},  {.4334, .9950, .0087},  {.5945, .9950, .0039},  {.7621, .9520, .0021},
    {.9163, .8700, .0017},  {1.0263, .7570, .0011}, {1.0622, .6310, .0008}, {1.0026, .5030, .0003},
    {.8544, .3810, .0002},  {.6424, .2650, 0},      {.4479, .1750, 0},      {.2835, .1070, 0},
    {.1649, .0610, 0},      {.0874, .0320, 0},      {.0468, .0170, 0},      {.0227, .0082, 0},
    {.0114, .0041, 0},      {.0058, .0021, 0},      {.0029, .0010, 0},      {.0014, .0005, 0},
    {.0007, .0002, 0},      {.0003, .0001, 0},      {.0002, .0001, 0},      {.0001, .0000, 0},
    {.0000, .0000, 0},
};

static void planck_xyz(double kelvin, double xyz[3]) {
  xyz[0] = xyz[1] = xyz[2] = 0;
  for (int i = 0; i < BANDS; i++) {
    double metres = (380 + 10 * i) * 1e-9;
    double power = 3.741771852e-16 / pow(metres, 5) / expm1(0.01438776877 / (metres * kelvin));
    for (int c = 0; c < 3; c++) xyz[c] += power * observer[i][c];
  }
}

/* Linear sRGB to XYZ, from the standard's primaries and white point. */
static const double to_xyz[3][3] = {{0.4123908, 0.3575843, 0.1804808},
                                    {0.2126390, 0.7151687, 0.0721923},
                                    {0.0193308, 0.1191948, 0.9505322}};

static void rgb_xyz(const float rgb[3], double xyz[3]) {
  for (int r = 0; r < 3; r++) {
    xyz[r] = 0;
    for (int c = 0; c < 3; c++) xyz[r] += to_xyz[r][c] * rgb[c];
  }
}

static double luminance(double kelvin) {
  float rgb[3];
  double xyz[3];
  blackbody_radiance((float)kelvin, rgb);
  rgb_xyz(rgb, xyz);
  return xyz[1];
}

/* Luminance to 2 %, the fit of the observer at the red end being what it is. */
static void test_luminance(void **state) {
  (void)state;
  double unit[3];
  planck_xyz(1500, unit);
  assert_true(fabs(luminance(1500) - 1) < 0.01);
  for (double kelvin = 900; kelvin < 16000; kelvin *= 1.07) {
    double xyz[3];
    planck_xyz(kelvin, xyz);
    double ratio = luminance(kelvin) / (xyz[1] / unit[1]);
    if (fabs(ratio - 1) > 0.02) fail_msg("%g K: luminance off by a factor %g", kelvin, ratio);
  }
}

static void check_chromaticity(double kelvin, double x, double y) {
  float rgb[3];
  double xyz[3];
  blackbody_radiance((float)kelvin, rgb);
  rgb_xyz(rgb, xyz);
  double sum = xyz[0] + xyz[1] + xyz[2], off = hypot(xyz[0] / sum - x, xyz[1] / sum - y);
  if (off > 0.004)
    fail_msg("%g K: (%g, %g), not (%g, %g)", kelvin, xyz[0] / sum, xyz[1] / sum, x, y);
}

/* Inside of sRGB the chromaticity is that of the locus. */
static void test_chromaticity(void **state) {
  (void)state;
  for (double kelvin = 2000; kelvin < 16000; kelvin += 500) {
    double xyz[3];
    planck_xyz(kelvin, xyz);
    double sum = xyz[0] + xyz[1] + xyz[2];
    check_chromaticity(kelvin, xyz[0] / sum, xyz[1] / sum);
  }
  check_chromaticity(2856, 0.44757, 0.40745); /* CIE illuminant A */
  check_chromaticity(6504, 0.3135, 0.3237);   /* the black body of daylight's temperature */
}

static void test_order(void **state) {
  (void)state;
  float last[3] = {0, 0, 0}, cold[3];
  blackbody_radiance(0, cold);
  assert_true(cold[0] == 0 && cold[1] == 0 && cold[2] == 0);
  for (int kelvin = 0; kelvin < 16384; kelvin += 4) {
    float rgb[3];
    blackbody_radiance((float)kelvin, rgb);
    for (int c = 0; c < 3; c++) {
      if (!(rgb[c] >= last[c] - 1e-9f) || !isfinite(rgb[c]))
        fail_msg("%d K, channel %d: %g after %g", kelvin, c, rgb[c], last[c]);
      last[c] = rgb[c];
    }
  }
}

/* The device's table between its nodes, and in proportion to the temperature beyond its end. */
static void test_table(void **state) {
  (void)state;
  enum { COUNT = 8192 };
  static float table[3 * CDL_BLACKBODY_COUNT], kelvin[COUNT], out[3 * COUNT];
  for (uint32_t i = 0; i < CDL_BLACKBODY_COUNT; i++)
    blackbody_radiance(CDL_BLACKBODY_STEP * (float)i, table + 3 * i);
  for (int i = 0; i < COUNT; i++) kelvin[i] = (float)(i < 4 ? -i * 10 : 800 + i * 2.2);
  kelvin[COUNT - 1] = 3e38f, kelvin[COUNT - 2] = INFINITY, kelvin[COUNT - 3] = 1e-40f;
  HarnessBuffer buffers[] = {{table, sizeof table}, {kelvin, sizeof kelvin}, {out, sizeof out}};
  grid_run_plain("grid_radiance", COUNT, buffers, 3);
  for (size_t i = 0; i < COUNT; i++) {
    float last = CDL_BLACKBODY_STEP * (CDL_BLACKBODY_COUNT - 1), rgb[3];
    blackbody_radiance(fminf(kelvin[i], last), rgb);
    for (size_t c = 0; c < 3; c++) {
      double value = out[c * COUNT + i], truth = (double)rgb[c] * fmax(1, kelvin[i] / last);
      if (isinf(truth) || kelvin[i] > 1e9f) {
        assert_true(value >= 0);
        continue;
      }
      if (!(fabs(value - truth) <= 3e-3 * truth + 3e-4 * rgb[0] + 1e-6))
        fail_msg("%g K, channel %zu: %g, not %g", kelvin[i], c, value, truth);
    }
  }
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_luminance),
      cmocka_unit_test(test_chromaticity),
      cmocka_unit_test(test_order),
      cmocka_unit_test(test_table),
  };
  return cmocka_run_group_tests(tests, grid_device_open, grid_device_close);
}
