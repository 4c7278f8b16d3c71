/* The film against sums made by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/film.h"

static cdl_Film *make(uint32_t width, uint32_t height, uint32_t aovs, int keep) {
  cdl_Film *film;
  assert_int_equal(film_create(NULL, width, height, aovs, keep, &film), CDL_OK);
  return film;
}

/* Two blocks of 16 and a rest of 4 samples on two pixels: mean = (32 + 48 + 8) / 36. */
static void adds_blocks(void **state) {
  (void)state;
  cdl_Film *film = make(2, 1, 0, 0);
  const float first[6] = {32, 16, 1, 2, 3, 4}, second[6] = {48, 16, 1, 2, 3, 4},
              third[6] = {8, 4, 1, 2, 3, 4};
  film_add(film, 0, 16, 0, 2, first, 2);
  film_add(film, 1, 16, 0, 2, second, 2);
  film_add(film, 2, 4, 0, 2, third, 2);
  float *rgb = film_resolve(film);
  assert_true(rgb[0] == (float)(88.0 / 36.0));
  assert_true(rgb[3] == 1.0f);
  assert_true(rgb[1] == (float)(3.0 / 36.0) && rgb[4] == (float)(6.0 / 36.0));
  assert_true(rgb[2] == (float)(9.0 / 36.0) && rgb[5] == (float)(12.0 / 36.0));
  free(rgb);
  film_free(film);
}

/* Pixels arrive in waves: strided sums, some pixels ahead of others. */
static void adds_ranges(void **state) {
  (void)state;
  cdl_Film *film = make(3, 2, 0, 0);
  const float sums[12] = {1, 2, 0, 0, 3, 4, 0, 0, 5, 6, 0, 0};
  film_add(film, 0, 1, 2, 2, sums, 4);
  float *rgb = film_resolve(film);
  const float expected[18] = {[6] = 1, 3, 5, 2, 4, 6};
  assert_memory_equal(rgb, expected, sizeof expected);
  free(rgb);
  uint32_t least, most;
  film_sample_range(film, &least, &most);
  assert_int_equal(least, 0);
  assert_int_equal(most, 1);
  film_free(film);
}

/* Sums that a float would lose: 2^24 + 1, twice. */
static void adds_in_double(void **state) {
  (void)state;
  cdl_Film *film = make(1, 1, 0, 0);
  const float big[3] = {16777216, 16777216, 16777216}, one[3] = {1, 1, 1};
  film_add(film, 0, 1, 0, 1, big, 1);
  film_add(film, 1, 1, 0, 1, one, 1);
  assert_true(film->sums[0] == 16777217.0);
  film_free(film);
}

static void keeps_first_sample(void **state) {
  (void)state;
  const uint32_t aovs = AOV_BIT(CDL_AOV_DEPTH) | AOV_BIT(CDL_AOV_OBJECT) | AOV_BIT(CDL_AOV_SAMPLES);
  cdl_Film *film = make(1, 1, aovs, 0);
  assert_int_equal(film->channels, 5);
  assert_int_equal(film_channel(film, CDL_AOV_DEPTH), 3);
  assert_int_equal(film_channel(film, CDL_AOV_OBJECT), 4);
  assert_int_equal(film_channel(film, CDL_AOV_SAMPLES), -1);
  assert_int_equal(film_channel(film, CDL_AOV_NORMAL), -1);
  const float first[5] = {16, 16, 16, INFINITY, 7}, second[5] = {16, 16, 16, 2, 9};
  film_add(film, 0, 16, 0, 1, first, 1);
  film_add(film, 1, 16, 0, 1, second, 1);
  float *depth = film_resolve_aov(film, CDL_AOV_DEPTH);
  uint32_t *object = film_resolve_aov(film, CDL_AOV_OBJECT);
  uint32_t *samples = film_resolve_aov(film, CDL_AOV_SAMPLES);
  assert_true(isinf(depth[0]));
  assert_int_equal(object[0], 7);
  assert_int_equal(samples[0], 32);
  assert_null(film_resolve_aov(film, CDL_AOV_NORMAL));
  free(depth);
  free(object);
  free(samples);
  film_free(film);
}

/* Block means 1 and 3 of 16 samples each: the mean is 2, a block's variance 2, that of the mean 1.
 */
static void estimates_variance(void **state) {
  (void)state;
  cdl_Film *film = make(1, 1, AOV_BIT(CDL_AOV_VARIANCE), 0);
  const float first[3] = {16, 16, 16}, second[3] = {48, 16, 80};
  film_add(film, 0, 16, 0, 1, first, 1);
  assert_true(isinf(film_noise(film)));
  film_add(film, 1, 16, 0, 1, second, 1);
  float *variance = film_resolve_aov(film, CDL_AOV_VARIANCE);
  assert_true(variance[0] == 1.0f && variance[1] == 0.0f && variance[2] == 4.0f);
  const double error = 0.2126 * 1 + 0.0722 * 2, mean = 0.2126 * 2 + 0.7152 * 1 + 0.0722 * 3;
  assert_true(fabs(film_noise(film) - error / mean) < 1e-6);
  free(variance);
  film_free(film);
}

/* The estimate is right on average: normal-ish samples of known variance in uneven blocks. */
static void variance_is_unbiased(void **state) {
  (void)state;
  enum { PIXELS = 20000, BLOCKS = 5 };
  static float sums[3 * PIXELS];
  cdl_Film *film = make(PIXELS, 1, AOV_BIT(CDL_AOV_VARIANCE), 0);
  srand48(7);
  uint32_t total = 0;
  for (uint32_t block = 0; block < BLOCKS; block++) {
    const uint32_t samples = block + 1 < BLOCKS ? 16 : 5;
    for (int i = 0; i < 3 * PIXELS; i++) {
      double sum = 0;
      for (uint32_t s = 0; s < samples; s++) sum += drand48();
      sums[i] = (float)sum;
    }
    total += samples;
    film_add(film, block, samples, 0, PIXELS, sums, PIXELS);
  }
  float *variance = film_resolve_aov(film, CDL_AOV_VARIANCE);
  double mean = 0;
  for (int i = 0; i < 3 * PIXELS; i++) mean += variance[i] / (3.0 * PIXELS);
  assert_true(fabs(mean * total * 12 - 1) < 0.02); /* a uniform number's variance is 1/12 */
  free(variance);
  film_free(film);
}

/* Of five pixels whose block means lie 0, 1, 2, 3 and 8 from the mean, the one with 2 counts. */
static void noise_is_the_median(void **state) {
  (void)state;
  cdl_Film *film = make(5, 1, 0, 0);
  const float spread[5] = {3, 0, 8, 2, 1};
  float first[15], second[15];
  for (int i = 0; i < 15; i++) {
    first[i] = 16 * (10 - spread[i % 5]);
    second[i] = 16 * (10 + spread[i % 5]);
  }
  film_add(film, 0, 16, 0, 5, first, 5);
  film_add(film, 1, 16, 0, 5, second, 5);
  assert_true(fabs(film_noise(film) - 0.2) < 1e-6); /* standard error of 8 and 12 is 2, of 10 */
  film_free(film);
}

/* Light that is found rarely must not end a render: of five pixels one has got some so far. */
static void noise_ignores_black_pixels(void **state) {
  (void)state;
  cdl_Film *film = make(5, 1, 0, 0);
  float first[15] = {0}, second[15] = {0};
  film_add(film, 0, 16, 0, 5, first, 5);
  film_add(film, 1, 16, 0, 5, second, 5);
  assert_true(isinf(film_noise(film)));
  for (int c = 0; c < 3; c++) first[5 * c + 3] = 16 * 8, second[5 * c + 3] = 16 * 12;
  film_free(film);
  film = make(5, 1, 0, 0);
  film_add(film, 0, 16, 0, 5, first, 5);
  film_add(film, 1, 16, 0, 5, second, 5);
  assert_true(fabs(film_noise(film) - 0.2) < 1e-6);
  film_free(film);
}

/* SHA-256 of twelve bytes, 00 00 80 3f 00 00 00 40 00 00 40 40, by sha256sum. */
static void hashes(void **state) {
  (void)state;
  cdl_Film *film = make(1, 1, 0, 0);
  const float sums[3] = {16, 32, 48};
  char digest[65];
  film_add(film, 0, 16, 0, 1, sums, 1);
  assert_int_equal(film_sha256(film, digest), CDL_OK);
  assert_string_equal(digest, "8e628779e6a74ee0b36991c10158f63cafec7d340ad4e075592502c8708524dd");
  film_free(film);
}

static void keeps_blocks(void **state) {
  (void)state;
  cdl_Film *film = make(2, 1, AOV_BIT(CDL_AOV_DEPTH), 1);
  const float a[8] = {1, 2, 3, 4, 5, 6, 7, 8}, b[4] = {9, 10, 11, 12};
  assert_int_equal(film_complete_parts(film), 0);
  film_add(film, 4, 16, 0, 1, a, 2);
  film_add(film, 5, 3, 0, 1, b, 1);
  film_add(film, 4, 16, 1, 1, a + 1, 2); /* the second wave comes back to the first block */
  assert_int_equal(film->part_count, 2);
  assert_int_equal(film_complete_parts(film), 1);
  assert_int_equal(film->parts[0].index, 4);
  assert_int_equal(film->parts[1].samples, 3);
  assert_memory_equal(film->parts[0].sums, a, sizeof a);
  const float expected[8] = {9, 0, 10, 0, 11, 0, 12, 0};
  assert_memory_equal(film->parts[1].sums, expected, sizeof expected);
  film_free(film);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(adds_blocks),         cmocka_unit_test(adds_ranges),
      cmocka_unit_test(adds_in_double),      cmocka_unit_test(keeps_first_sample),
      cmocka_unit_test(estimates_variance),  cmocka_unit_test(variance_is_unbiased),
      cmocka_unit_test(noise_is_the_median), cmocka_unit_test(hashes),
      cmocka_unit_test(keeps_blocks),        cmocka_unit_test(noise_ignores_black_pixels),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
