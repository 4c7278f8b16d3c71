/* test_media.c: homogeneous media on the device, against closed forms. */
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

enum { SAMPLES = 1000000, CELLS = 64 };

static Harness *harness;

#define ROW(k) ((double)rows[(k) * (size_t)SAMPLES + i])

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

/* A lamp beside the ray, on it, before its beginning and behind its end: distances near to it are
 * spread by angle, and the weights' means stay what they are. */
static void test_flight_near_a_lamp(void **state) {
  (void)state;
  static const float lamps[][2] = {{0.5f, 1}, {1e-6f, 0.4f}, {2, -1}, {0.1f, 40}};
  float *rows = calloc((size_t)SAMPLES * 7, sizeof *rows);
  assert_non_null(rows);
  for (uint i = 0; i < FLIGHTS * 4; i++) {
    const Flight *f = &flights[i / 4];
    const float *lamp = lamps[i % 4];
    float in[13];
    memcpy(in, f->sigma_a, 12), memcpy(in + 3, f->sigma_s, 12), memcpy(in + 6, f->throughput, 12);
    in[9] = f->t_max, in[10] = as_float(i + 90), in[11] = lamp[0], in[12] = lamp[1];
    HarnessBuffer buffers[] = {{in, sizeof in}, {rows, (size_t)SAMPLES * 7 * sizeof *rows}};
    harness_run(harness, "sample_flight_near", SAMPLES, buffers, 2);
    check_flight_weights(f, rows);
    double low = atan2(-lamp[1], lamp[0]), high = atan2(f->t_max - lamp[1], lamp[0]), sum = 0;
    if (high - low < 1e-3) continue; /* it sees the stretch under no angle */
    for (size_t k = 0; k < SAMPLES; k++) {
      double t = rows[5 * (size_t)SAMPLES + k], pdf = rows[6 * (size_t)SAMPLES + k];
      sum += (atan2(t - lamp[1], lamp[0]) - low) / (high - low);
      double aside = lamp[0], from = t - lamp[1];
      double truth = aside / ((high - low) * (aside * aside + from * from));
      if (lamp[0] > 1e-3f && fabs(pdf - truth) > 1e-3 * truth) fail_msg("%s: pdf %g", f->name, pdf);
    }
    if (lamp[0] > 1e-3f && fabs(sum / SAMPLES - 0.5) > 5 * sqrt(1 / 12.0 / SAMPLES) + 1e-5)
      fail_msg("%s: mean angle %g", f->name, sum / SAMPLES);
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
  harness = harness_open_with("tests/device/media.cl");
  return harness ? 0 : -1;
}

static int close_device(void **state) {
  (void)state;
  harness_close(harness);
  return 0;
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_free_flight),
      cmocka_unit_test(test_flight_near_a_lamp),
      cmocka_unit_test(test_transmittance),
  };
  return cmocka_run_group_tests(tests, open_device, close_device);
}
