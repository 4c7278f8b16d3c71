/* test_media.c: the phase function and homogeneous media on the device, against closed forms. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib/portable.h"
#include "tests/device/chi2.h"
#include "tests/device/harness.h"

enum { SAMPLES = 1000000, STRESS = 10000000 / 64 * 64, CELLS = 64 };

static Harness *harness;

/* ---- Henyey and Greenstein ---- */

static const float asymmetries[] = {-0.999f, -0.7f, -1e-4f, 0.0f, 1e-7f, 0.3f, 0.7f, 0.95f, 0.999f};
enum { ASYMMETRIES = sizeof asymmetries / sizeof *asymmetries };

/* Distribution of c = cos, integrated from the phase function by hand. */
static double hg_distribution(double c, double g) {
  if (fabs(g) < 1e-3) return 0.5 * (1 + c) + 0.75 * g * (c * c - 1);
  return (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g - 2 * g * c) - 1 / (1 + g));
}

/* Cells of equal probability: cos at each border, by bisection. */
static void hg_borders(double g, double borders[CELLS + 1]) {
  for (int i = 0; i <= CELLS; i++) {
    double low = -1, high = 1;
    for (int n = 0; n < 100; n++) {
      double mid = 0.5 * (low + high);
      if (hg_distribution(mid, g) * CELLS < i)
        low = mid;
      else
        high = mid;
    }
    borders[i] = i == CELLS ? 1 : low;
  }
}

static int cell_of(const double borders[CELLS + 1], double c) {
  int low = 0, high = CELLS;
  while (high - low > 1) {
    int mid = (low + high) / 2;
    if (c < borders[mid])
      high = mid;
    else
      low = mid;
  }
  return low;
}

#define ROW(k) ((double)rows[(k) * (size_t)SAMPLES + i])

/* Cosine in cells of equal probability times four quarters of the turn around the direction. */
static double hg_p_value(const float *rows, float g, const double d[3]) {
  static double observed[CELLS * 4], expected[CELLS * 4];
  double borders[CELLS + 1], t[3] = {d[1], -d[0], 0}, length = hypot(t[0], t[1]), mean = 0;
  hg_borders(g, borders);
  for (int i = 0; i < CELLS * 4; i++) observed[i] = 0, expected[i] = SAMPLES / (CELLS * 4.0);
  t[0] /= length, t[1] /= length;
  double b[3] = {-t[1] * d[2], t[0] * d[2], t[1] * d[0] - t[0] * d[1]};
  for (size_t i = 0; i < SAMPLES; i++) {
    double cosine = ROW(0) * d[0] + ROW(1) * d[1] + ROW(2) * d[2];
    double along = ROW(0) * t[0] + ROW(1) * t[1];
    double across = ROW(0) * b[0] + ROW(1) * b[1] + ROW(2) * b[2];
    int quarter = (along > 0) + 2 * (across > 0);
    /* from the sine, because narrow lobes lie within a few floats of cosine 1 */
    double side = along * along + across * across;
    double exact = copysign(side < 1 ? sqrt(1 - side) : 0, cosine);
    if (fabs(cosine - ROW(3)) > 2e-6) fail_msg("g %g: cosine %g is %g", g, ROW(3), cosine);
    if (fabs(ROW(4) / ROW(5) - 1) > (fabsf(g) > 0.99f ? 0.2 : 1e-4))
      fail_msg("g %g, cos %g: pdf %g, value %g", g, cosine, ROW(4), ROW(5));
    observed[cell_of(borders, exact) * 4 + quarter]++;
    mean += cosine;
  }
  /* the mean cosine is g by definition */
  assert_true(fabs(mean / SAMPLES - g) < 4e-3);
  return chi2_test(observed, expected, CELLS * 4);
}

static void test_phase_sampling(void **state) {
  (void)state;
  const double d[3] = {0.48, -0.6, 0.64};
  float *rows = calloc((size_t)SAMPLES * 6, sizeof *rows);
  assert_non_null(rows);
  for (uint i = 0; i < ASYMMETRIES; i++) {
    float in[5] = {(float)d[0], (float)d[1], (float)d[2], asymmetries[i], as_float(i + 1)};
    HarnessBuffer buffers[] = {{in, sizeof in}, {rows, (size_t)SAMPLES * 6 * sizeof *rows}};
    harness_run(harness, "sample_phase", SAMPLES, buffers, 2);
    double p = hg_p_value(rows, asymmetries[i], d);
    if (p < chi2_threshold(ASYMMETRIES)) fail_msg("g %g: p = %g", (double)asymmetries[i], p);
  }
  free(rows);
}

static void test_phase_any_input(void **state) {
  (void)state;
  float *rows = calloc(STRESS, sizeof *rows), in[5] = {0, 0, 0, 0, as_float(9)};
  assert_non_null(rows);
  HarnessBuffer buffers[] = {{in, sizeof in}, {rows, STRESS * sizeof *rows}};
  harness_run(harness, "stress_phase", STRESS, buffers, 2);
  for (size_t i = 0; i < STRESS; i++) assert_true(rows[i] == 0);
  free(rows);
}

/* ---- free flight ---- */

typedef struct Flight {
  const char *name;
  float sigma_a[3], sigma_s[3], throughput[3], t_max;
} Flight;

static const Flight flights[] = {
    {"grey", {0.5f, 0.5f, 0.5f}, {1, 1, 1}, {1, 1, 1}, 1.2f},
    {"coloured", {0.1f, 0.5f, 0}, {4, 1, 0.2f}, {1, 0.5f, 0.3f}, 0.8f},
    {"one channel absorbs only", {3, 0, 0}, {0, 1, 2}, {0.2f, 1, 1}, 1.5f},
    {"one channel is empty", {0, 0.2f, 0}, {0, 1, 2}, {1, 1, 0.1f}, 2},
    {"endless", {0.5f, 1, 0}, {1, 2, 0.5f}, {1, 1, 1}, INFINITY},
    {"black path", {0.5f, 1, 0}, {1, 2, 0.5f}, {0, 0, 0}, 1},
    {"absorber", {0.5f, 2, 0}, {0, 0, 0}, {1, 1, 1}, 0.9f},
    {"endless absorber", {0.5f, 2, 0}, {0, 0, 0}, {1, 1, 1}, INFINITY},
    {"vacuum", {0, 0, 0}, {0, 0, 0}, {1, 1, 1}, INFINITY},
};
enum { FLIGHTS = sizeof flights / sizeof *flights };

/* P(no event before t), the mixture over channels that homogeneous.h promises. */
static double flight_survival(const Flight *f, double t) {
  double sum = f->throughput[0] + f->throughput[1] + f->throughput[2], p = 0;
  for (int c = 0; c < 3; c++) {
    double q = sum > 0 ? f->throughput[c] / sum : 1.0 / 3;
    double sigma = f->sigma_a[c] + f->sigma_s[c];
    p += q * (sigma > 0 ? exp(-sigma * t) : 1);
  }
  return p;
}

/* Where it scatters, in cells of equal length to 4 free paths or t_max; the last cell is beyond. */
static double flight_p_value(const Flight *f, const float *rows) {
  static double observed[CELLS + 2], expected[CELLS + 2];
  double end = fmin(f->t_max, 3), inside = 1;
  for (int i = 0; i < CELLS; i++) {
    double next = flight_survival(f, end * (i + 1) / CELLS);
    expected[i] = SAMPLES * (inside - next);
    observed[i] = 0;
    inside = next;
  }
  double through = flight_survival(f, f->t_max);
  expected[CELLS] = SAMPLES * (inside - through), expected[CELLS + 1] = SAMPLES * through;
  observed[CELLS] = observed[CELLS + 1] = 0;
  for (size_t i = 0; i < SAMPLES; i++) {
    int cell = ROW(1) == 0 ? CELLS + 1 : (int)fmin(ROW(0) / end * CELLS, CELLS);
    assert_true(ROW(1) == 0 ? rows[i] == f->t_max : ROW(0) < f->t_max);
    observed[cell]++;
  }
  return chi2_test(observed, expected, CELLS + 2);
}

/* The means of the weights are the scattered and the transmitted share; in the sum no channel
 * gains. */
static void check_flight_weights(const Flight *f, const float *rows) {
  for (size_t c = 0; c < 3; c++) {
    double sums[2] = {0}, squares[2] = {0};
    for (size_t i = 0; i < SAMPLES; i++) {
      double w = ROW(2 + c);
      if (!(w >= 0 && w < 1e6)) fail_msg("%s: weight %g", f->name, w);
      sums[ROW(1) != 0] += w, squares[ROW(1) != 0] += w * w;
    }
    double sigma = f->sigma_a[c] + f->sigma_s[c], t = sigma > 0 ? exp(-sigma * f->t_max) : 1;
    double truth[2] = {t, sigma > 0 ? f->sigma_s[c] / sigma * (1 - t) : 0};
    for (int k = 0; k < 2; k++) {
      double mean = sums[k] / SAMPLES, error = sqrt(squares[k]) / SAMPLES;
      if (fabs(mean - truth[k]) > 4 * error + 1e-6)
        fail_msg("%s, channel %zu, scattered %d: %g, not %g", f->name, c, k, mean, truth[k]);
    }
  }
}

static void test_free_flight(void **state) {
  (void)state;
  float *rows = calloc((size_t)SAMPLES * 5, sizeof *rows);
  assert_non_null(rows);
  for (uint i = 0; i < FLIGHTS; i++) {
    const Flight *f = &flights[i];
    float in[11];
    memcpy(in, f->sigma_a, 12), memcpy(in + 3, f->sigma_s, 12), memcpy(in + 6, f->throughput, 12);
    in[9] = f->t_max, in[10] = as_float(i + 40);
    HarnessBuffer buffers[] = {{in, sizeof in}, {rows, (size_t)SAMPLES * 5 * sizeof *rows}};
    harness_run(harness, "sample_flight", SAMPLES, buffers, 2);
    check_flight_weights(f, rows);
    int scatters = f->sigma_s[0] + f->sigma_s[1] + f->sigma_s[2] > 0;
    for (size_t k = 0; k < SAMPLES && !scatters; k++) assert_true(rows[SAMPLES + k] == 0);
    double p = scatters ? flight_p_value(f, rows) : 1;
    if (p < chi2_threshold(FLIGHTS)) fail_msg("%s: p = %g", f->name, p);
  }
  free(rows);
}

/* ---- Beer and Lambert ---- */

static void test_transmittance(void **state) {
  (void)state;
  static const float sigmas[] = {0, 1e-30f, 1e-9f, 1e-4f, 0.3f, 7, 1e4f};
  static const float lengths[] = {0, 1e-6f, 0.02f, 1, 500, 1e9f, INFINITY, 3};
  enum { COUNT = 56 };
  float in[COUNT * 2], out[COUNT * 4] = {0};
  for (int i = 0; i < COUNT; i++) in[i] = sigmas[i / 8], in[COUNT + i] = lengths[i % 8];
  HarnessBuffer buffers[] = {{in, sizeof in}, {out, sizeof out}};
  harness_run(harness, "transmit", COUNT, buffers, 2);
  for (int i = 0; i < COUNT; i++) {
    double s = in[i], t = in[COUNT + i], depth = s > 0 ? s * t : 0;
    double integral = s > 0 ? -expm1(-depth) / s : t;
    assert_true(fabs(out[i] - exp(-depth)) <= 1e-6 * exp(-depth) + 1e-37);
    if (isinf(integral))
      assert_true(isinf(out[COUNT + i]));
    else
      assert_true(fabs(out[COUNT + i] - integral) <= 1e-6 * integral);
    if (!isinf(integral)) assert_true(fabs(out[2 * COUNT + i] - 2 * integral) <= 2e-6 * integral);
    assert_true(out[3 * COUNT + i] == 0);
  }
}

static int open_device(void **state) {
  (void)state;
  static char text[1 << 16];
  harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  FILE *file = fopen("tests/device/media.cl", "rb");
  if (!harness || !file) return -1;
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  harness_build(harness, text);
  return 0;
}

static int close_device(void **state) {
  (void)state;
  harness_close(harness);
  return 0;
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_phase_sampling),
      cmocka_unit_test(test_phase_any_input),
      cmocka_unit_test(test_free_flight),
      cmocka_unit_test(test_transmittance),
  };
  return cmocka_run_group_tests(tests, open_device, close_device);
}
