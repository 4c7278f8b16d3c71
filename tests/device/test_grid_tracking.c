/* test_grid_tracking.c: free flights, shadow rays and emission in grids: estimates against
 * integrals over dense fields in double precision. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/device/chi2.h"
#include "tests/device/grid_device.h"

enum { RAYS = 16, EACH = 4096, SAMPLES = RAYS * EACH, WEIGHT = 3 };

/* A medium in a field, and the light that goes through it. */
typedef struct Case {
  const char *name;
  FieldKind kind;
  uint32_t size[3];
  float absorption[3], scattering[3], throughput[3], emission[3];
  int hot, tinted;
} Case;

#define ONES                                                                                       \
  { 1, 1, 1 }
#define NONE                                                                                       \
  { 0, 0, 0 }

static const Case cases[] = {
    {"constant", FIELD_CONSTANT, {8, 8, 8}, NONE, {3, 3, 3}, ONES, NONE, 0, 0},
    {"thin", FIELD_RAMP, {20, 9, 12}, NONE, {0.02f, 0.02f, 0.02f}, ONES, NONE, 0, 0},
    {"ramp", FIELD_RAMP, {20, 17, 12}, NONE, {8, 8, 8}, ONES, NONE, 0, 0},
    {"step", FIELD_STEP, {40, 33, 20}, NONE, {6, 6, 6}, {0.5f, 1, 2}, NONE, 0, 0},
    {"thick", FIELD_NOISE, {9, 10, 33}, NONE, {60, 60, 60}, ONES, NONE, 0, 0},
    {"half absorbed", FIELD_CHECKER, {40, 33, 20}, {9, 9, 9}, {9, 9, 9}, ONES, NONE, 0, 0},
    {"coloured ramp", FIELD_RAMP, {20, 17, 12}, {1, 2, 0}, {9, 2, 1}, {1, 0.5f, 0.3f}, NONE, 0, 0},
    {"1:10:100", FIELD_NOISE, {33, 20, 17}, NONE, {1, 10, 100}, ONES, NONE, 0, 0},
    {"1:10:100, sparse", FIELD_SPARSE, {40, 33, 20}, {1, 0, 50}, {1, 20, 150}, ONES, NONE, 0, 0},
    {"a dark channel", FIELD_NOISE, {9, 10, 33}, NONE, {8, 2, 1}, {1e-3f, 1, 0}, NONE, 0, 0},
    {"faint", FIELD_NOISE, {9, 10, 33}, {1, 0, 0}, {3, 2, 1}, {2e-9f, 1e-9f, 1e-9f}, NONE, 0, 0},
    {"one channel absorbs", FIELD_STEP, {20, 20, 20}, {5, 0, 0}, {0, 5, 2}, ONES, NONE, 0, 0},
    {"one channel is empty", FIELD_NOISE, {9, 10, 33}, {0, 1, 0}, {0, 5, 2}, ONES, NONE, 0, 0},
    {"absorber", FIELD_NOISE, {9, 10, 33}, {1, 4, 0}, NONE, ONES, NONE, 0, 0},
    {"glow", FIELD_CHECKER, {40, 33, 20}, {2, 5, 0}, {9, 2, 6}, ONES, {1, 2, 5}, 0, 0},
    {"fire", FIELD_SPARSE, {40, 33, 20}, {20, 50, 0}, {9, 0, 90}, {1, 0.2f, 2}, {1, 2, 3}, 1, 0},
    {"fire alone", FIELD_EMPTY, {40, 33, 20}, {20, 50, 0}, {9, 0, 90}, ONES, {1, 2, 3}, 1, 0},
    {"tinted", FIELD_NOISE, {33, 20, 17}, {1, 0, 2}, {9, 6, 12}, ONES, NONE, 0, 1},
    {"tinted, sparse", FIELD_SPARSE, {33, 20, 17}, NONE, {90, 90, 90}, ONES, NONE, 0, 1},
    {"all at once", FIELD_CHECKER, {33, 20, 17}, {2, 5, 0}, {9, 2, 30}, ONES, {1, 2, 3}, 1, 1},
};
enum { CASES = sizeof cases / sizeof *cases };

/* A smooth stand-in for the radiance of black bodies. */
static void radiance(double kelvin, double rgb[3]) {
  double t = kelvin * 1e-3;
  rgb[0] = t * t, rgb[1] = t * t * t * 0.2, rgb[2] = 0.1 * t;
}

/* ---- a case on the device ---- */

typedef struct Lab {
  const Case *test;
  GridSet set;
  Field density, heat, color;
  FieldRay rays[RAYS];
  FieldTruth truth[RAYS];
  float *rows;
} Lab;

/* From outside and inside of the box, which is about 1 m long, some with an end. */
static void aim(Lab *lab) {
  uint32_t state = 3;
  for (int i = 0; i < RAYS; i++) {
    FieldRay *ray = &lab->rays[i];
    double to[3], length = 0;
    for (int k = 0; k < 3; k++) {
      double part = (double)lab->test->size[k] / lab->test->size[0];
      ray->origin[k] = (float)((i % 4 ? 2 : 0.6) * part * (field_random(&state) - 0.5));
      to[k] = 0.8 * part * (field_random(&state) - 0.5) - ray->origin[k];
      length += to[k] * to[k];
    }
    for (int k = 0; k < 3; k++) ray->direction[k] = (float)(to[k] / sqrt(length));
    ray->from = i % 3 ? 0 : 0.1f;
    ray->to = i % 5 ? INFINITY : (float)sqrt(length);
  }
}

static Lab *lab_make(const Case *test) {
  Lab *lab = calloc(1, sizeof *lab);
  assert_non_null(lab);
  lab->test = test;
  lab->set = grid_set_make(test->size, 0.6);
  cdl_Medium *medium = &lab->set.medium;
  memcpy(medium->absorption, test->absorption, sizeof medium->absorption);
  memcpy(medium->scattering, test->scattering, sizeof medium->scattering);
  memcpy(medium->emission, test->emission, sizeof medium->emission);
  medium->emissive = test->emission[0] > 0;
  medium->temperature_scale = 2500;
  lab->heat = field_make(FIELD_CHECKER, test->size, 1, 1, 71);
  lab->color = field_make(FIELD_NOISE, test->size, 3, 1.2f, 72); /* above 1 counts as 1 */
  lab->density = field_make(test->kind, test->size, 1, 1, 73);
  for (uint32_t i = 0; i < 3 * CDL_BLACKBODY_COUNT; i += 3) {
    double rgb[3];
    radiance((double)CDL_BLACKBODY_STEP * (i / 3), rgb);
    for (uint32_t c = 0; c < 3; c++) lab->set.blackbody[i + c] = (float)rgb[c];
  }
  if (test->tinted) medium->color = grid_set_add(&lab->set, &lab->color);
  medium->density = grid_set_add(&lab->set, &lab->density);
  if (test->hot) medium->temperature = grid_set_add(&lab->set, &lab->heat);
  aim(lab);
  for (int i = 0; i < RAYS; i++)
    lab->truth[i] = field_truth(medium, &lab->density, test->hot ? &lab->heat : NULL,
                                test->tinted ? &lab->color : NULL, radiance, &lab->rays[i]);
  lab->rows = calloc((size_t)SAMPLES * 9, sizeof *lab->rows);
  return lab;
}

static void lab_free(Lab *lab) {
  free(lab->density.values);
  free(lab->heat.values);
  free(lab->color.values);
  free(lab->rows);
  grid_set_free(&lab->set);
  free(lab);
}

static void lab_run(Lab *lab, const char *kernel, size_t rows, uint32_t seed) {
  uint32_t in[5] = {RAYS, seed};
  memcpy(in + 2, lab->test->throughput, 12);
  grid_run(kernel, SAMPLES, &lab->set, (HarnessBuffer){lab->rays, sizeof lab->rays},
           (HarnessBuffer){in, sizeof in},
           (HarnessBuffer){lab->rows, SAMPLES * rows * sizeof *lab->rows});
}

/* ---- estimates ---- */

/* One mean for each ray, in units of the largest throughput. */
typedef struct Estimate {
  double sum[RAYS], square[RAYS], truth[RAYS];
} Estimate;

static void estimate_add(Estimate *e, size_t sample, double value) {
  e->sum[sample % RAYS] += value;
  e->square[sample % RAYS] += value * value;
}

/* Every ray within 5 standard errors, and all of them together within 4.5. */
static void estimate_check(const Estimate *e, const char *name, const char *what, int number) {
  double difference = 0, variance = 0, slack = 0;
  for (int i = 0; i < RAYS; i++) {
    double mean = e->sum[i] / EACH, error2 = (e->square[i] / EACH - mean * mean) / EACH;
    /* what is rare has not shown its variance: of weights up to WEIGHT that mean makes at most this
     */
    double truth = fabs(e->truth[i]), rounding = 1e-6 + 2e-5 * truth;
    int rare = truth * EACH < 30 * WEIGHT;
    error2 = fmax(error2, rare ? WEIGHT * truth / EACH : 0);
    if (!(fabs(mean - e->truth[i]) <= 5 * sqrt(error2) + rounding + rare * 2.0 * WEIGHT / EACH))
      fail_msg("%s, %s %d, ray %d: %g +- %g, not %g", name, what, number, i, mean, sqrt(error2),
               e->truth[i]);
    difference += mean - e->truth[i], variance += error2;
    slack += rounding;
  }
  if (!(fabs(difference) <= 4.5 * sqrt(variance) + slack))
    fail_msg("%s, %s %d: off by %g +- %g of %d rays", name, what, number, difference,
             sqrt(variance), RAYS);
}

static double lab_unit(const Lab *lab) {
  const float *t = lab->test->throughput;
  return fmax(t[0], fmax(t[1], t[2]));
}

/* ---- transmittance ---- */

static void check_shadows(Lab *lab, uint32_t seed) {
  lab_run(lab, "grid_shadow", 3, seed);
  for (size_t c = 0; c < 3; c++) {
    static Estimate e;
    double light = lab->test->throughput[c] / lab_unit(lab);
    memset(&e, 0, sizeof e);
    for (int i = 0; i < RAYS; i++) e.truth[i] = light * lab->truth[i].through[c];
    for (size_t i = 0; i < SAMPLES; i++) {
      double value = lab->rows[c * SAMPLES + i] / lab_unit(lab);
      if (!(value >= 0 && value <= 6 * (1 + 1e-5)))
        fail_msg("%s: %g in channel %zu", lab->test->name, value, c);
      estimate_add(&e, i, value);
    }
    estimate_check(&e, lab->test->name, "transmittance", (int)c);
  }
}

static void test_shadows(void **state) {
  (void)state;
  for (uint32_t i = 0; i < CASES; i++) {
    Lab *lab = lab_make(&cases[i]);
    check_shadows(lab, 50 + i);
    lab_free(lab);
  }
}

/* ---- flights ---- */

#define ROW(k) ((double)lab->rows[(k) * (size_t)SAMPLES + i])

/* In the sum no channel gains, and none loses but by absorption. */
static void check_sums(const Lab *lab) {
  const float *t = lab->test->throughput, *a = lab->test->absorption;
  double sum = (double)t[0] + t[1] + t[2];
  int lossless = !lab->test->tinted && a[0] == 0 && a[1] == 0 && a[2] == 0;
  for (size_t i = 0; i < SAMPLES; i++) {
    double after = ROW(2) + ROW(3) + ROW(4), rounding = 6e-7 * (1 + ROW(8));
    int sound = after <= sum * (1 + rounding) && ROW(2) >= 0 && ROW(3) >= 0 && ROW(4) >= 0;
    if (!sound || (lossless && after < sum * (1 - rounding)))
      fail_msg("%s: %g becomes (%g, %g, %g) after %g collisions", lab->test->name, sum, ROW(2),
               ROW(3), ROW(4), ROW(8));
    const FieldTruth *truth = &lab->truth[i % RAYS];
    int inside = ROW(0) >= truth->first - 1e-5 && ROW(0) <= truth->last + 1e-5;
    if (ROW(1) != 0 ? !inside : lab->rows[i] != lab->rays[i % RAYS].to)
      fail_msg("%s: ends at %g m", lab->test->name, ROW(0));
  }
}

static int cell_of(const FieldTruth *truth, double t) {
  double cell = (t - truth->first) / (truth->last - truth->first) * FIELD_CELLS;
  return (int)fmin(fmax(cell, 0), FIELD_CELLS - 1);
}

/* Weights in cells of the way, in all of it, beyond it, and what glows. */
static void check_channel(const Lab *lab, size_t c) {
  static Estimate scattered, through, glow, cells[FIELD_CELLS];
  double unit = lab_unit(lab), light = lab->test->throughput[c] / unit;
  memset(&scattered, 0, sizeof scattered), memset(&through, 0, sizeof through);
  memset(&glow, 0, sizeof glow), memset(cells, 0, sizeof cells);
  for (size_t i = 0; i < SAMPLES; i++) {
    double weight = ROW(2 + c) / unit;
    estimate_add(ROW(1) != 0 ? &scattered : &through, i, weight);
    estimate_add(&glow, i, ROW(5 + c) / unit);
    if (ROW(1) != 0) estimate_add(&cells[cell_of(&lab->truth[i % RAYS], ROW(0))], i, weight);
  }
  for (int r = 0; r < RAYS; r++) {
    through.truth[r] = light * lab->truth[r].through[c];
    glow.truth[r] = light * lab->truth[r].glow[c];
    for (int k = 0; k < FIELD_CELLS; k++) {
      cells[k].truth[r] = light * lab->truth[r].scattered[c][k];
      scattered.truth[r] += cells[k].truth[r];
    }
  }
  estimate_check(&scattered, lab->test->name, "scattered in channel", (int)c);
  estimate_check(&through, lab->test->name, "let through in channel", (int)c);
  estimate_check(&glow, lab->test->name, "glow in channel", (int)c);
  for (int k = 0; k < FIELD_CELLS; k++)
    estimate_check(&cells[k], lab->test->name, "scattered in cell", k);
}

/* Where grey light is scattered: its distribution, when nothing is absorbed. */
static void check_distances(const Lab *lab) {
  for (int r = 0; r < RAYS; r++) {
    const FieldTruth *truth = &lab->truth[r];
    double observed[FIELD_CELLS + 1] = {0}, expected[FIELD_CELLS + 1];
    for (int k = 0; k < FIELD_CELLS; k++)
      expected[k] = EACH * (truth->reached[k] - truth->reached[k + 1]);
    expected[FIELD_CELLS] = EACH * truth->reached[FIELD_CELLS];
    for (size_t i = (size_t)r; i < SAMPLES; i += RAYS)
      observed[ROW(1) != 0 ? cell_of(truth, ROW(0)) : FIELD_CELLS]++;
    double p = chi2_test(observed, expected, FIELD_CELLS + 1);
    if (p < chi2_threshold(RAYS * CASES)) fail_msg("%s, ray %d: p = %g", lab->test->name, r, p);
  }
}

static int is_grey(const float v[3]) { return v[0] == v[1] && v[1] == v[2]; }

static void check_flights(Lab *lab, uint32_t seed) {
  const Case *test = lab->test;
  lab_run(lab, "grid_flight", 9, seed);
  check_sums(lab);
  for (size_t c = 0; c < 3; c++) check_channel(lab, c);
  if (is_grey(test->scattering) && is_grey(test->absorption) && test->absorption[0] == 0 &&
      !test->tinted)
    check_distances(lab);
  float scattering = test->scattering[0] + test->scattering[1] + test->scattering[2];
  for (size_t i = 0; i < SAMPLES && scattering == 0; i++) assert_true(ROW(1) == 0);
}

static void test_flights(void **state) {
  (void)state;
  for (uint32_t i = 0; i < CASES; i++) {
    Lab *lab = lab_make(&cases[i]);
    check_flights(lab, 90 + i);
    lab_free(lab);
  }
}

/* Loose bounds of the density cost time, and change no mean. */
static void test_loose_bounds(void **state) {
  (void)state;
  for (uint32_t i = 0; i < CASES; i++) {
    if (i % 6 != 2 && i + 1 != CASES) continue;
    Lab *lab = lab_make(&cases[i]);
    static const float factors[2] = {2, 5}; /* 10 in all */
    for (uint32_t k = 0; k < 2; k++) {
      grid_set_loosen(&lab->set, factors[k]);
      check_shadows(lab, 200 + 2 * i + k);
      check_flights(lab, 300 + 2 * i + k);
    }
    lab_free(lab);
  }
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shadows),
      cmocka_unit_test(test_flights),
      cmocka_unit_test(test_loose_bounds),
  };
  return cmocka_run_group_tests(tests, grid_device_open, grid_device_close);
}
