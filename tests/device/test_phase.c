/* test_phase.c: phase functions on the device, against their formulas in double. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "lib/portable.h"
#include "tests/device/chi2.h"
#include "tests/device/harness.h"

enum { SAMPLES = 1000000, STRESS = 10000000 / 64 * 64, CELLS = 64, NODES = 4096 };

static Harness *harness;

/* Two lobes of Draine's, and what they are together. */
typedef struct Case {
  const char *name;
  float g[2], alpha[2], second;
} Case;

#define HG(g)                                                                                      \
  { "Henyey and Greenstein", {g, 0}, {0, 0}, 0 }
#define DRAINE(g, alpha)                                                                           \
  { "Draine", {g, 0}, {alpha, 0}, 0 }

static const Case cases[] = {
    {"isotropic", {0, 0}, {0, 0}, 0},
    HG(-0.999f),
    HG(-0.7f),
    HG(-1e-4f),
    HG(1e-7f),
    HG(0.3f),
    HG(0.7f),
    HG(0.95f),
    HG(0.999f),
    {"two terms", {0.8f, -0.4f}, {0, 0}, 0.3f},
    {"two narrow terms", {0.999f, -0.999f}, {0, 0}, 0.5f},
    {"Rayleigh", {0, 0}, {1, 0}, 0},
    DRAINE(0, 1e6f),
    DRAINE(1e-7f, 1),
    DRAINE(-1e-4f, 250),
    DRAINE(0.1f, 250),
    DRAINE(0.3f, 0.01f),
    DRAINE(0.5f, 1),
    DRAINE(-0.5f, 20),
    DRAINE(0.7f, 20),
    DRAINE(0.85f, 250),
    DRAINE(0.95f, 5),
    DRAINE(0.95f, 1e6f),
    DRAINE(-0.99f, 250),
    DRAINE(0.999f, 1),
    DRAINE(-0.999f, 40),
    /* what the fits of Jendersie and d'Eon 2023 give for 5, 20 and 50 um */
    {"small droplets", {0.970678f, 0.508342f}, {0, 17.0681f}, 0.447829f},
    {"droplets", {0.994610f, 0.593791f}, {0, 27.1137f}, 0.498159f},
    {"large droplets", {0.997952f, 0.625084f}, {0, 32.3154f}, 0.507618f},
    {"two of Draine's", {0.9f, -0.6f}, {3, 100}, 0.4f},
};
enum { CASES = sizeof cases / sizeof *cases };

static void check_name(const Case *c, const char *what, double found, double wanted) {
  fail_msg("%s, g %g %g, alpha %g %g: %s is %.9g, not %.9g", c->name, (double)c->g[0],
           (double)c->g[1], (double)c->alpha[0], (double)c->alpha[1], what, found, wanted);
}

/* ---- the formulas ---- */

static double lobe_norm(double g, double alpha) { return 1 + alpha * (1 + 2 * g * g) / 3; }

static double lobe_value(double c, double g, double alpha) {
  double hg = (1 - g * g) / (4 * M_PI * pow((1 - g) * (1 - g) + 2 * g * (1 - c), 1.5));
  return hg * (1 + alpha * c * c) / lobe_norm(g, alpha);
}

/* Where s^2 = 1 + g^2 - 2 g cos: an integral of the lobe over s, g not near 0. */
static double lobe_antiderivative(double s, double g, double alpha) {
  double a = 1 + g * g;
  return -1 / s + alpha / (4 * g * g) * (s * s * s / 3 - 2 * a * s - a * a / s);
}

/* Share of the directions with a cosine below c; to first order in g where that is enough. */
static double lobe_distribution(double c, double g, double alpha) {
  double c2 = c * c, norm = lobe_norm(g, alpha);
  if (fabs(g) < 1e-3)
    return ((1 + c + alpha * (1 + c * c2) / 3) / 2 +
            1.5 * g * ((c2 - 1) / 2 + alpha * (c2 * c2 - 1) / 4)) /
           norm;
  double near = sqrt((1 - g) * (1 - g) + 2 * g * (1 - c));
  double part = lobe_antiderivative(1 + g, g, alpha) - lobe_antiderivative(near, g, alpha);
  return part * (1 - g * g) / (2 * g * norm);
}

static double lobe_mean(double g, double alpha) {
  double g2 = g * g;
  return g * (1 + alpha * (3 + 2 * g2) / 5) / lobe_norm(g, alpha);
}

typedef double (*LobeFunction)(double c, double g, double alpha);

static double mixed(const Case *p, LobeFunction function, double c) {
  return (1 - (double)p->second) * function(c, p->g[0], p->alpha[0]) +
         p->second * function(c, p->g[1], p->alpha[1]);
}

static double mean_cosine(const Case *p) {
  return (1 - (double)p->second) * lobe_mean(p->g[0], p->alpha[0]) +
         p->second * lobe_mean(p->g[1], p->alpha[1]);
}

/* ---- sampling ---- */

/* Cells of equal probability: cos at each border, by bisection. */
static void find_borders(const Case *p, double borders[CELLS + 1]) {
  for (int i = 0; i <= CELLS; i++) {
    double low = -1, high = 1;
    for (int n = 0; n < 100; n++) {
      double mid = 0.5 * (low + high);
      if (mixed(p, lobe_distribution, mid) * CELLS < i)
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

/* The pdf is the formula's at the cosine before that was rounded to a float, and the value that at
 * the float, both to 1e-4. */
static void check_density(const Case *p, double cosine, double pdf, double value) {
  double at = mixed(p, lobe_value, cosine);
  double below = mixed(p, lobe_value, fmax(cosine - 1.2e-7, -1));
  double above = mixed(p, lobe_value, fmin(cosine + 1.2e-7, 1));
  if (!(fabs(value / at - 1) < 1e-4)) check_name(p, "the value", value, at);
  if (!(pdf > fmin(at, fmin(below, above)) * (1 - 1e-4))) check_name(p, "the pdf", pdf, at);
  if (!(pdf < fmax(at, fmax(below, above)) * (1 + 1e-4))) check_name(p, "the pdf", pdf, at);
}

/* Cosine in cells of equal probability times four quarters of the turn around the direction. */
static double sampling_p_value(const Case *p, const float *rows, const double d[3]) {
  static double observed[CELLS * 4], expected[CELLS * 4];
  double borders[CELLS + 1], t[3] = {d[1], -d[0], 0}, length = hypot(t[0], t[1]), mean = 0;
  find_borders(p, borders);
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
    if (!(fabs(cosine - ROW(3)) < 2e-6)) check_name(p, "the cosine", ROW(3), cosine);
    check_density(p, ROW(3), ROW(4), ROW(5));
    observed[cell_of(borders, side < 0.5 ? exact : cosine) * 4 + quarter]++;
    mean += cosine / SAMPLES;
  }
  if (fabs(mean - mean_cosine(p)) > 4e-3) check_name(p, "the mean cosine", mean, mean_cosine(p));
  return chi2_test(observed, expected, CELLS * 4);
}

static void test_sampling(void **state) {
  (void)state;
  const double d[3] = {0.48, -0.6, 0.64};
  float *rows = calloc((size_t)SAMPLES * 6, sizeof *rows);
  assert_non_null(rows);
  for (uint i = 0; i < CASES; i++) {
    const Case *p = &cases[i];
    float in[9] = {p->g[0],     p->g[1],     p->alpha[0], p->alpha[1],    p->second,
                   (float)d[0], (float)d[1], (float)d[2], as_float(i + 1)};
    HarnessBuffer buffers[] = {{in, sizeof in}, {rows, (size_t)SAMPLES * 6 * sizeof *rows}};
    harness_run(harness, "sample_phase", SAMPLES, buffers, 2);
    double found = sampling_p_value(p, rows, d), least = chi2_threshold(CASES);
    if (found < least) check_name(p, "the p-value", found, least);
  }
  free(rows);
}

/* ---- normalisation ---- */

/* Over r = 1 - |cos| by Simpson's rule in log r, so that narrow peaks are as smooth as wide ones.
 */
static void test_normalisation(void **state) {
  (void)state;
  const double least = log(1e-13), step = -least / (NODES - 2);
  static float in[5 + NODES], out[2 * NODES];
  for (int i = 0; i < NODES; i++) in[5 + i] = (float)exp(fmin(least + step * i, 0));
  for (uint k = 0; k < CASES; k++) {
    const Case *p = &cases[k];
    in[0] = p->g[0], in[1] = p->g[1], in[2] = p->alpha[0], in[3] = p->alpha[1], in[4] = p->second;
    HarnessBuffer buffers[] = {{in, sizeof in}, {out, sizeof out}};
    harness_run(harness, "integrate_phase", NODES, buffers, 2);
    double sum = 0;
    for (int i = 0; i < NODES - 1; i++) {
      double weight = i == 0 || i == NODES - 2 ? 1 : i % 2 ? 4 : 2;
      sum += weight * step / 3 * in[5 + i] * ((double)out[i] + out[NODES + i]);
    }
    if (!(fabs(2 * M_PI * sum - 1) < 1e-5)) check_name(p, "the integral", 2 * M_PI * sum, 1);
  }
}

static void test_any_input(void **state) {
  (void)state;
  float *rows = calloc(STRESS, sizeof *rows), in[1] = {as_float(9)};
  assert_non_null(rows);
  HarnessBuffer buffers[] = {{in, sizeof in}, {rows, STRESS * sizeof *rows}};
  harness_run(harness, "stress_phase", STRESS, buffers, 2);
  for (size_t i = 0; i < STRESS; i++)
    if (rows[i] != 0) fail_msg("item %zu has a fault", i);
  free(rows);
}

static int open_device(void **state) {
  (void)state;
  harness = harness_open_with("tests/device/phase.cl");
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
      cmocka_unit_test(test_sampling),
      cmocka_unit_test(test_normalisation),
      cmocka_unit_test(test_any_input),
  };
  return cmocka_run_group_tests(tests, open_device, close_device);
}
