/* Tone maps against published formulas and values, and the properties that every one must have. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "image/tonemap.h"

static const cdl_ToneMap all_maps[] = {CDL_TONEMAP_NONE, CDL_TONEMAP_ACES, CDL_TONEMAP_AGX,
                                       CDL_TONEMAP_NEUTRAL};

static void map(cdl_ToneMap tonemap, float exposure, float r, float g, float b, float out[3]) {
  const cdl_ToneSettings settings = {exposure, tonemap};
  out[0] = r;
  out[1] = g;
  out[2] = b;
  tonemap_apply(&settings, out);
}

static float map_grey(cdl_ToneMap tonemap, float x) {
  float out[3];
  map(tonemap, 0.0f, x, x, x, out);
  assert_float_equal(out[0], out[1], 2e-3);
  assert_float_equal(out[0], out[2], 2e-3);
  return out[1];
}

static void black_stays_black(void **state) {
  (void)state;
  for (int m = 0; m < 4; m++) assert_true(map_grey(all_maps[m], 0.0f) == 0.0f);
}

static void greys_rise_and_end_near_white(void **state) {
  (void)state;
  for (int m = 0; m < 4; m++) {
    float last = 0.0f;
    for (float x = 1e-4f; x < 1e4f; x *= 1.05f) {
      const float y = map_grey(all_maps[m], x);
      assert_true(y >= last && y <= 1.0f);
      last = y;
    }
    assert_true(last > 0.99f);
  }
}

static void bad_values_become_black_or_white(void **state) {
  (void)state;
  for (int m = 0; m < 4; m++) {
    float out[3];
    map(all_maps[m], 0.0f, NAN, -1.0f, -INFINITY, out);
    for (int c = 0; c < 3; c++) assert_true(out[c] == 0.0f);
    map(all_maps[m], 3.0f, INFINITY, INFINITY, INFINITY, out);
    for (int c = 0; c < 3; c++) assert_true(out[c] > 0.99f && out[c] <= 1.0f);
  }
}

static void exposure_is_a_factor_of_two_per_ev(void **state) {
  (void)state;
  for (int m = 0; m < 4; m++) {
    float a[3], b[3];
    map(all_maps[m], 1.5f, 0.1f, 0.2f, 0.05f, a);
    const float k = 2.0f * sqrtf(2.0f);
    map(all_maps[m], 0.0f, 0.1f * k, 0.2f * k, 0.05f * k, b);
    for (int c = 0; c < 3; c++) assert_float_equal(a[c], b[c], 1e-6);
  }
}

static void none_clips(void **state) {
  (void)state;
  float out[3];
  map(CDL_TONEMAP_NONE, 0.0f, 0.25f, 1.5f, 1.0f, out);
  assert_true(out[0] == 0.25f && out[1] == 1.0f && out[2] == 1.0f);
}

/* Hill's rational function by hand: 0.18 -> 0.036734 / 0.347884, 1 -> 1.024488 / 1.654761. The row
 * sums of both of his matrices are 1 to 5 digits, so greys see the curve alone. */
static void aces_matches_hills_fit(void **state) {
  (void)state;
  assert_float_equal(map_grey(CDL_TONEMAP_ACES, 0.18f), 0.10559, 2e-4);
  assert_float_equal(map_grey(CDL_TONEMAP_ACES, 1.0f), 0.61912, 2e-4);
}

/* Wrensch's polynomial of sixth order, fitted by others to AgX's curve in its coded domain. */
static double agx_polynomial(double x) {
  const double x2 = x * x, x4 = x2 * x2;
  return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x -
         0.00232;
}

static void agx_matches_the_published_polynomial(void **state) {
  (void)state;
  for (double ev = -9.0; ev < 6.4; ev += 0.1) {
    const double expected = agx_polynomial((ev + 10.0) / 16.5);
    const double coded = pow((double)map_grey(CDL_TONEMAP_AGX, (float)(0.18 * exp2(ev))), 1 / 2.2);
    assert_float_equal(coded, expected, 0.015);
  }
}

/* Middle grey sits on the curve's pivot, half of the coded range. */
static void agx_keeps_middle_grey(void **state) {
  (void)state;
  assert_float_equal(map_grey(CDL_TONEMAP_AGX, 0.18f), pow(0.5, 2.2), 2e-4);
}

static void agx_takes_bright_colours_to_white(void **state) {
  (void)state;
  float dim[3], bright[3];
  map(CDL_TONEMAP_AGX, 0.0f, 0.5f, 0.05f, 0.05f, dim);
  map(CDL_TONEMAP_AGX, 8.0f, 0.5f, 0.05f, 0.05f, bright);
  assert_true(dim[1] / dim[0] < 0.3f);
  assert_true(bright[1] / bright[0] > 0.8f);
}

/* The specification's promise: a base colour c in 0.08 .. 0.8, lit by white furnace light, gives
 * c + 0.04 in radiance, and comes out as c. */
static void neutral_is_the_identity_on_base_colours(void **state) {
  (void)state;
  float out[3];
  map(CDL_TONEMAP_NEUTRAL, 0.0f, 0.74f, 0.34f, 0.14f, out);
  assert_float_equal(out[0], 0.70, 1e-6);
  assert_float_equal(out[1], 0.30, 1e-6);
  assert_float_equal(out[2], 0.10, 1e-6);
}

/* Below twice F90 the offset is x - x²/0.16, so the least channel becomes 6.25 x². */
static void neutral_has_a_parabolic_toe(void **state) {
  (void)state;
  for (float x = 0.0f; x <= 0.08f; x += 0.005f)
    assert_float_equal(map_grey(CDL_TONEMAP_NEUTRAL, x), 6.25 * x * x, 1e-6);
  assert_float_equal(map_grey(CDL_TONEMAP_NEUTRAL, 0.0799999f),
                     map_grey(CDL_TONEMAP_NEUTRAL, 0.0800001f), 1e-5);
}

/* White of 1.96 less 0.04 has peak 1.92: 1 - 0.24² / (1.92 + 0.24 - 0.76) = 0.958857. */
static void neutral_compresses_highlights(void **state) {
  (void)state;
  assert_float_equal(map_grey(CDL_TONEMAP_NEUTRAL, 1.96f), 0.958857, 1e-5);
  /* Red 1.96, 0.04, 0.04: offset 0.04 - 6.25 × 0.0016 = 0.03, so 1.93 and 0.01; peak 1.93,
   * new peak 1 - 0.0576 / 1.41 = 0.959149, kept part 1 / (0.15 × 0.970851 + 1) = 0.872881. */
  float out[3];
  map(CDL_TONEMAP_NEUTRAL, 0.0f, 1.96f, 0.04f, 0.04f, out);
  assert_float_equal(out[0], 0.959149, 1e-5);
  assert_float_equal(out[1], 0.872881 * 0.01 * 0.959149 / 1.93 + 0.127119 * 0.959149, 1e-5);
}

/* Values of IEC 61966-2-1 as tabulated everywhere: 8-bit code 188 is half the light, 118 is 18 %.
 */
static void srgb_matches_known_codes(void **state) {
  (void)state;
  const cdl_ToneSettings plain = {0.0f, CDL_TONEMAP_NONE};
  const float rgb[6] = {0.5f, 0.18f, 1.0f, 0.0f, 0.0031308f, 2.0f};
  const uint8_t expected[6] = {188, 118, 255, 0, 10, 255};
  uint8_t out[6];
  tonemap_to_srgb8(&plain, rgb, 2, out);
  for (int i = 0; i < 6; i++) assert_int_equal(out[i], expected[i]);
}

static void srgb_decodes_what_it_encodes(void **state) {
  (void)state;
  const cdl_ToneSettings plain = {0.0f, CDL_TONEMAP_NONE};
  for (int code = 0; code < 256; code++) {
    const float grey = tonemap_srgb_decode((float)code / 255.0f), rgb[3] = {grey, grey, grey};
    uint8_t out[3];
    tonemap_to_srgb8(&plain, rgb, 1, out);
    assert_int_equal(out[0], code);
  }
}

static void names_are_parsed(void **state) {
  (void)state;
  cdl_ToneMap tonemap;
  assert_int_equal(tonemap_parse(NULL, "agx", &tonemap), CDL_OK);
  assert_int_equal(tonemap, CDL_TONEMAP_AGX);
  assert_int_equal(tonemap_parse(NULL, "neutral", &tonemap), CDL_OK);
  assert_int_equal(tonemap, CDL_TONEMAP_NEUTRAL);
  assert_int_equal(tonemap_parse(NULL, "filmic", &tonemap), CDL_USAGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(black_stays_black),
      cmocka_unit_test(greys_rise_and_end_near_white),
      cmocka_unit_test(bad_values_become_black_or_white),
      cmocka_unit_test(exposure_is_a_factor_of_two_per_ev),
      cmocka_unit_test(none_clips),
      cmocka_unit_test(aces_matches_hills_fit),
      cmocka_unit_test(agx_matches_the_published_polynomial),
      cmocka_unit_test(agx_keeps_middle_grey),
      cmocka_unit_test(agx_takes_bright_colours_to_white),
      cmocka_unit_test(neutral_is_the_identity_on_base_colours),
      cmocka_unit_test(neutral_has_a_parabolic_toe),
      cmocka_unit_test(neutral_compresses_highlights),
      cmocka_unit_test(srgb_matches_known_codes),
      cmocka_unit_test(srgb_decodes_what_it_encodes),
      cmocka_unit_test(names_are_parsed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
