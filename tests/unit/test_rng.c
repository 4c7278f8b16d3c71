/* test_rng.c: the sampler of kernels/lib/rng.h against Sobol's recurrence, the definition of a net,
 * and statistics over pixels, pairs and seeds. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/rng.h"

static uint reverse_by_loop(uint x) {
  uint r = 0;
  for (int i = 0; i < 32; i++) r |= ((x >> i) & 1u) << (31 - i);
  return r;
}

/* Direction numbers of the second dimension in the table of Joe and Kuo: primitive polynomial x + 1
 * (s = 1, a = 0), m_1 = 1, whose recurrence is m_k = 2 m_{k-1} xor m_{k-1}. */
static uint sobol2_by_recurrence(uint index) {
  uint value = 0, m = 1;
  for (int k = 0; k < 32; k++) {
    if ((index >> k) & 1u) value ^= m << (31 - k);
    m = (m << 1) ^ m;
  }
  return value;
}

static void sobol_matches_the_recurrence(void **state) {
  (void)state;
  for (uint i = 0; i < 100000u; i++) {
    uint index = i < 70000u ? i : rng_hash(i);
    assert_int_equal(rng_reverse_bits(index), reverse_by_loop(index));
    assert_int_equal(reverse_by_loop(rng_sobol2_reversed(index)), sobol2_by_recurrence(index));
  }
}

/* Flipping bit k must leave all bits below k alone and flip k itself: the definition of a nested
 * scramble on reversed bits. */
static void scramble_is_nested(void **state) {
  (void)state;
  for (uint i = 0; i < 200000u; i++) {
    uint x = rng_hash(2u * i), seed = rng_hash(2u * i + 1u), k = i & 31u;
    uint change = rng_scramble_reversed(x, seed) ^ rng_scramble_reversed(x ^ (1u << k), seed);
    uint low = (1u << k) | ((1u << k) - 1u);
    assert_int_equal(change & low, 1u << k);
  }
}

enum { NET_BITS = 10 };

/* A block of 2^m points puts exactly one in every elementary interval 2^-a by 2^-(m-a). */
static int block_is_net(uint key, uint first, uint pair, int bits) {
  for (int a = 0; a <= bits; a++) {
    unsigned char cells[1 << NET_BITS] = {0};
    for (uint i = 0; i < (1u << bits); i++) {
      float u, v;
      rng_2d(key, first + i, pair, &u, &v);
      uint cell =
          ((uint)(u * (float)(1 << a)) << (bits - a)) + (uint)(v * (float)(1 << (bits - a)));
      if (cells[cell]++) return 0;
    }
  }
  return 1;
}

static void aligned_blocks_are_nets(void **state) {
  (void)state;
  for (uint t = 0; t < 200u; t++) {
    uint key = rng_pixel_key(t % 20u, t / 20u, t);
    for (int bits = 0; bits <= NET_BITS; bits++)
      assert_true(block_is_net(key, (t % 7u) << bits, t % 5u, bits));
  }
}

static void values_stay_below_one(void **state) {
  (void)state;
  assert_true(rng_to_unit(0xffffffffu) < 1.0f && rng_to_unit(0u) == 0.0f);
  assert_true(rng_to_unit(0xffffffffu) == CDL_ONE_MINUS_EPSILON);
}

static double chi2_of(const uint *counts, size_t cells, double expected) {
  double sum = 0.0;
  for (size_t i = 0; i < cells; i++) sum += ((double)counts[i] - expected) * (counts[i] - expected);
  return sum / expected;
}

/* Standard normal deviate of a chi-squared value (Wilson and Hilferty 1931). */
static double chi2_deviate(double chi2, double freedom) {
  double spread = 2.0 / (9.0 * freedom);
  return (cbrt(chi2 / freedom) - (1.0 - spread)) / sqrt(spread);
}

enum { SIDE = 32 };

/* Which numbers of the sampler a statistic takes from pixel p. */
typedef void (*Source)(uint p, float *a, float *b);

static void one_pair(uint p, float *a, float *b) {
  rng_2d(rng_pixel_key(p & 1023u, p >> 10, 1u), 0u, 0u, a, b);
}

static void later_sample(uint p, float *a, float *b) {
  rng_2d(rng_pixel_key(p & 1023u, p >> 10, 1u), 13u, 2u, a, b);
}

static void first_and_second_pair(uint p, float *a, float *b) {
  float unused;
  uint key = rng_pixel_key(p & 1023u, p >> 10, 2u);
  rng_2d(key, 5u, 0u, a, &unused);
  rng_2d(key, 5u, 1u, b, &unused);
}

static void across_pairs(uint p, float *a, float *b) {
  float unused;
  uint key = rng_pixel_key(p & 1023u, p >> 10, 2u);
  rng_2d(key, 5u, 3u, &unused, a);
  rng_2d(key, 5u, 4u, b, &unused);
}

static void right_neighbour(uint p, float *a, float *b) {
  float unused;
  rng_2d(rng_pixel_key(2u * (p & 1023u), p >> 10, 3u), 1u, 0u, a, &unused);
  rng_2d(rng_pixel_key(2u * (p & 1023u) + 1u, p >> 10, 3u), 1u, 0u, b, &unused);
}

static void lower_neighbour(uint p, float *a, float *b) {
  float unused;
  rng_2d(rng_pixel_key(p & 1023u, 2u * (p >> 10), 3u), 1u, 0u, a, &unused);
  rng_2d(rng_pixel_key(p & 1023u, 2u * (p >> 10) + 1u, 3u), 1u, 0u, b, &unused);
}

static void next_seed(uint p, float *a, float *b) {
  float unused;
  rng_2d(rng_pixel_key(p & 1023u, p >> 10, 4u), 2u, 1u, &unused, a);
  rng_2d(rng_pixel_key(p & 1023u, p >> 10, 5u), 2u, 1u, &unused, b);
}

static void one_pixel_in_blocks(uint p, float *a, float *b) {
  /* every 4096th sample: blocks of that size are scrambled apart */
  rng_2d(rng_pixel_key(11u, 12u, 7u), p * 4096u + (rng_hash(p) & 4095u), 0u, a, b);
}

static const struct {
  const char *name;
  Source source;
} sources[] = {
    {"one pair", one_pair},
    {"later sample", later_sample},
    {"first and second pair", first_and_second_pair},
    {"across pairs", across_pairs},
    {"right neighbour", right_neighbour},
    {"lower neighbour", lower_neighbour},
    {"next seed", next_seed},
    {"one pixel in blocks", one_pixel_in_blocks},
};

enum { SOURCES = sizeof sources / sizeof *sources, POINTS = 1 << 20 };

/* Deviates beyond 3.9 have probability 5e-5 each way, under 0.01 over all of them together. */
static const double LIMIT = 3.9;

static void pairs_of_numbers_are_uniform_and_uncorrelated(void **state) {
  (void)state;
  for (int s = 0; s < SOURCES; s++) {
    uint counts[SIDE * SIDE] = {0};
    double product = 0.0;
    for (uint p = 0; p < POINTS; p++) {
      float a, b;
      sources[s].source(p, &a, &b);
      assert_true(a >= 0.0f && a < 1.0f && b >= 0.0f && b < 1.0f);
      counts[(int)(a * SIDE) * SIDE + (int)(b * SIDE)]++;
      product += ((double)a - 0.5) * ((double)b - 0.5);
    }
    double freedom = SIDE * SIDE - 1;
    double chi2 =
        chi2_deviate(chi2_of(counts, SIDE * SIDE, (double)POINTS / (SIDE * SIDE)), freedom);
    double correlation = product / POINTS * 12.0 * sqrt(POINTS);
    print_message("  %-22s chi2 %+.2f, correlation %+.2f sigma\n", sources[s].name, chi2,
                  correlation);
    assert_true(chi2 < LIMIT && fabs(correlation) < LIMIT);
  }
}

/* The first four samples among 4 x 4 cells. The first takes any of 16; the second the other half in
 * both u and v, 4 ways; the third one of the two quadrants left, whose rows and columns leave one
 * cell; the fourth what remains: 128 arrangements, which must be equally frequent. */
static void small_nets_take_every_arrangement(void **state) {
  (void)state;
  static uint counts[65536];
  memset(counts, 0, sizeof counts);
  enum { NETS = 1 << 19 };
  for (uint p = 0; p < NETS; p++) {
    uint code = 0;
    for (uint i = 0; i < 4u; i++) {
      float u, v;
      rng_2d(rng_pixel_key(p & 1023u, p >> 10, 8u), i, 0u, &u, &v);
      code = code * 16u + (uint)(u * 4.0f) * 4u + (uint)(v * 4.0f);
    }
    counts[code]++;
  }
  uint seen[65536];
  size_t kinds = 0;
  for (size_t i = 0; i < 65536; i++)
    if (counts[i]) seen[kinds++] = counts[i];
  double deviate = chi2_deviate(chi2_of(seen, kinds, (double)NETS / (double)kinds), kinds - 1.0);
  print_message("  %zu arrangements, chi2 %+.2f sigma\n", kinds, deviate);
  assert_int_equal(kinds, 128);
  assert_true(deviate < LIMIT);
}

/* Integrates a smooth function; a scrambled net converges far faster than random points. */
static void nets_integrate_better_than_random(void **state) {
  (void)state;
  enum { SAMPLES = 256, PIXELS = 4000 };
  double error = 0.0;
  for (uint p = 0; p < PIXELS; p++) {
    double sum = 0.0;
    for (uint i = 0; i < SAMPLES; i++) {
      float u, v;
      rng_2d(rng_pixel_key(p, 77u, 0u), i, 0u, &u, &v);
      sum += exp(-(double)u - (double)v);
    }
    double exact = (1.0 - exp(-1.0)) * (1.0 - exp(-1.0));
    error += (sum / SAMPLES - exact) * (sum / SAMPLES - exact) / PIXELS;
  }
  double random = (0.25 * pow(1.0 - exp(-2.0), 2.0) - pow(1.0 - exp(-1.0), 4.0)) / SAMPLES;
  print_message("  variance %.2e of that of random points\n", error / random);
  assert_true(error < 1e-3 * random);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sobol_matches_the_recurrence),
      cmocka_unit_test(scramble_is_nested),
      cmocka_unit_test(aligned_blocks_are_nets),
      cmocka_unit_test(values_stay_below_one),
      cmocka_unit_test(pairs_of_numbers_are_uniform_and_uncorrelated),
      cmocka_unit_test(small_nets_take_every_arrangement),
      cmocka_unit_test(nets_integrate_better_than_random),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
