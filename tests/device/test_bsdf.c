/* test_bsdf.c: every surface model on the device against what a BSDF must be: sampled as its
 * density says, positive, reciprocal, no brighter than the light that reaches it, and finite
 * everywhere.
 *
 * One table of models and parameters (bsdf_models.h) drives all tests. Densities are integrated in
 * double on the host. CDL_SOAK=1 takes every view of every case. Delta lobes: test_bsdf_delta.c. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "lib/rng.h"
#include "lib/sampling.h"
#include "tests/device/bsdf_device.h"
#include "tests/device/bsdf_lobes.h"
#include "tests/device/chi2.h"

enum {
  SAMPLES = 1 << 20,
  PAIRS = 1 << 15,
  PARAM_SETS = 1 << 17,
  STRESS = 10 << 20,
  LEAST_COMBINATIONS = 300,
  CELLS = 2 * BSDF_CELLS + 1
};

/* Three views of each case: one from above, one from aside, one that grazes. */
static int is_viewed(size_t index, size_t view) {
  static const char of_three[3][BSDF_VIEWS] = {
      {1, 0, 1, 1, 0, 0}, {0, 1, 1, 0, 0, 1}, {0, 0, 0, 1, 1, 1}};
  return bsdf_is_soak() || of_three[index % 3][view];
}

/* ---- sampling against the density ---- */

typedef struct Sampling {
  double observed[CELLS], none; /* and the share without a density */
  double albedo, error;         /* of uniform light, and its standard error */
} Sampling;

static void run_samples(const BsdfCase *c, const BsdfLobes *l, uint seed, Sampling *s) {
  static uint rows[BSDF_SAMPLE_ROWS * SAMPLES];
  BsdfSetup setup = bsdf_setup_of(c, l->wo, seed);
  for (int i = 0; i < 2; i++) setup.charts[i] = bsdf_chart_setup(&l->charts[i]);
  HarnessBuffer buffer = {rows, sizeof rows};
  bsdf_run(c, "sample", SAMPLES, &setup, &buffer, 1);
  double sum = 0, squares = 0;
  *s = (Sampling){.none = 0};
  for (size_t i = 0; i < SAMPLES; i++) {
    if (rows[2 * SAMPLES + i]) bsdf_name_faults(c, "sample", i, rows[2 * SAMPLES + i]);
    s->observed[rows[i]]++;
    double weight = as_float(rows[SAMPLES + i]);
    sum += weight;
    squares += weight * weight;
  }
  s->none = s->observed[BSDF_CELL_NONE] / SAMPLES;
  s->albedo = sum / SAMPLES;
  s->error = sqrt(fmax(squares / SAMPLES - s->albedo * s->albedo, 0) / SAMPLES);
}

typedef struct Worst {
  double p, brightest;
  size_t samplings;
} Worst;

static void check_sampling(const BsdfCase *c, size_t view, uint seed, double threshold,
                           Worst *worst) {
  double expected[CELLS] = {0};
  static Sampling s;
  BsdfLobes l;
  bsdf_lobes_init(&l, c, bsdf_point_of(c), bsdf_view(c, view));
  run_samples(c, &l, seed, &s);
  double total = bsdf_chart_integrate(&l.charts[0], expected);
  if (l.model->transmits) total += bsdf_chart_integrate(&l.charts[1], expected + BSDF_CELLS);
  for (size_t i = 0; i < CELLS; i++) expected[i] *= SAMPLES;
  double p = chi2_test(s.observed, expected, CELLS - 1);
  double error = 4 * sqrt(s.none * (1 - s.none) / SAMPLES) + 5e-4;
  double energy = c->energy > 0 ? c->energy : 1;
  if (fabs(total + s.none - 1) > error)
    fail_msg("%s, view %zu: pdf %g, without a density %g", c->name, view, total, s.none);
  if (p < threshold) fail_msg("%s, view %zu: p = %g", c->name, view, p);
  if (s.albedo - 3 * s.error > energy * 1.0005)
    fail_msg("%s, view %zu: returns %g +- %g", c->name, view, s.albedo, s.error);
  if (bsdf_view_cosine(view) >= c->least_cosine && s.albedo + 3 * s.error < c->least)
    fail_msg("%s, view %zu: returns only %g", c->name, view, s.albedo);
  worst->p = fmin(worst->p, p);
  worst->brightest = fmax(worst->brightest, s.albedo);
  worst->samplings++;
}

static size_t samplings(void) {
  size_t count = 0;
  for (size_t i = 0; bsdf_case(i); i++)
    for (size_t v = 0; v < BSDF_VIEWS; v++) count += (size_t)is_viewed(i, v);
  return count;
}

static void test_sampling(void **state) {
  (void)state;
  assert_true(samplings() >= LEAST_COMBINATIONS);
  double threshold = chi2_threshold(samplings());
  Worst worst = {1, 0, 0};
  for (int model = 0; model < BSDF_MODEL_COUNT; model++)
    for (size_t i = 0; bsdf_case(i); i++)
      for (size_t v = 0; v < BSDF_VIEWS && bsdf_case(i)->model == model; v++)
        if (is_viewed(i, v))
          check_sampling(bsdf_case(i), v, (uint)(BSDF_VIEWS * i + v + 1), threshold, &worst);
  print_message("%zu samplings of %d: least p %.2g (%.2g passes), most light returned %.4f\n",
                worst.samplings, SAMPLES, worst.p, threshold, worst.brightest);
}

/* ---- reciprocity, positivity, the lower side, the host's bits ---- */

static vec3 random_direction(uint seed, uint item) {
  float u = rng_to_unit(rng_hash2(seed, 3 * item)), v = rng_to_unit(rng_hash2(seed, 3 * item + 1));
  float choice = rng_to_unit(rng_hash2(seed, 3 * item + 2));
  vec3 w = sample_sphere(u, v);
  w.z = choice < 0.125f ? 1.75e-3f : math_max(math_abs(w.z), 1e-5f);
  return choice > 0.9375f ? v3(0, 0, 1) : v3_normalize(w);
}

/* Rows of wo and wi; where light goes through, half of the wi are below. */
static void random_pairs(int below, float *rows) {
  for (uint i = 0; i < PAIRS; i++) {
    vec3 wo = random_direction(7, i), wi = random_direction(8, i);
    if (below && i % 2) wi.z = -wi.z;
    const float values[6] = {wo.x, wo.y, wo.z, wi.x, wi.y, wi.z};
    for (size_t k = 0; k < 6; k++) rows[k * PAIRS + i] = values[k];
  }
}

/* Radiance over the square of the index is what is symmetric (Veach 1997, section 5.2). */
static void check_reciprocity(const BsdfCase *c, const float *rows, size_t i, int through) {
  double eta = through ? bsdf_eta_of(c) : 1, limit = c->reciprocity > 0 ? c->reciprocity : 1e-3;
  for (size_t k = 0; k < 3; k++) {
    double there = rows[k * PAIRS + i] * eta * eta, back = rows[(k + 3) * PAIRS + i];
    if (!(there >= 0) || !(back >= 0)) fail_msg("%s: f = %g, %g", c->name, there, back);
    if (c->reciprocity < 0) continue;
    if (!(fabs(there - back) <= limit * fmax(there, back) + 1e-6))
      fail_msg("%s, item %zu: f(wo, wi) = %.9g, f(wi, wo) = %.9g", c->name, i, there, back);
  }
}

/* The device's evaluation has the host's bits. */
static void check_bits(const BsdfCase *c, const BsdfLobes *l, vec3 wo, vec3 wi, const float *rows,
                       size_t i) {
  BsdfValue value = l->model->evaluate(l->params, wo, wi);
  if (value.f_cos.x / math_abs(wi.z) != rows[i] || value.pdf != rows[6 * PAIRS + i])
    fail_msg("%s: item %zu has other bits than the host's", c->name, i);
}

static void check_pairs(const BsdfCase *c, float *directions) {
  static float rows[BSDF_PAIR_ROWS * PAIRS];
  BsdfLobes l;
  bsdf_lobes_init(&l, c, bsdf_point_of(c), v3(0, 0, 1));
  BsdfSetup setup = bsdf_setup_of(c, v3(0, 0, 1), 0);
  HarnessBuffer buffers[] = {{directions, 6 * PAIRS * sizeof *directions}, {rows, sizeof rows}};
  bsdf_run(c, "pairs", PAIRS, &setup, buffers, 2);
  for (size_t i = 0; i < PAIRS; i++) {
    const float *d = directions + i;
    vec3 wo = v3(d[0], d[PAIRS], d[2 * PAIRS]), wi = v3(d[3 * PAIRS], d[4 * PAIRS], d[5 * PAIRS]);
    check_reciprocity(c, rows, i, wi.z < 0);
    if (i % 8 < 2) check_bits(c, &l, wo, wi, rows, i);
    if (!bsdf_models[c->model].transmits && (rows[7 * PAIRS + i] != 0 || rows[8 * PAIRS + i] != 0))
      fail_msg("%s: not black from below", c->name);
  }
}

static void test_pairs(void **state) {
  (void)state;
  static float directions[2][6 * PAIRS];
  random_pairs(0, directions[0]);
  random_pairs(1, directions[1]);
  for (int model = 0; model < BSDF_MODEL_COUNT; model++)
    for (size_t i = 0; bsdf_case(i); i++)
      if (bsdf_case(i)->model == model)
        check_pairs(bsdf_case(i), directions[bsdf_models[model].transmits]);
}

/* ---- any input ---- */

static float random_word(BsdfRange range, uint seed, uint item) {
  float u = rng_to_unit(rng_hash2(rng_hash2(seed, item), 0));
  float v = rng_to_unit(rng_hash2(rng_hash2(seed, item), 1));
  if (u < 0.125f) return range.low;
  if (u > 0.875f) return range.high;
  if (u < 0.5f && range.fine > 0) return range.fine * powf(range.high / range.fine, v);
  return range.low + (range.high - range.low) * v;
}

static void check_any_input(int model, uint *params, uint *faults) {
  const BsdfModel *m = &bsdf_models[model];
  const BsdfCase any = {.name = m->name, .model = model, .flags = m->flags};
  for (size_t k = 0; k < m->words; k++)
    for (uint i = 0; i < PARAM_SETS; i++)
      params[k * PARAM_SETS + i] = as_uint(random_word(m->ranges[k], (uint)k + 77, i));
  BsdfSetup setup = bsdf_setup_of(&any, v3(0, 0, 1), 3);
  setup.param_sets = PARAM_SETS;
  HarnessBuffer all = {params, (m->words + 1) * PARAM_SETS * sizeof *params};
  HarnessBuffer buffer = {faults, STRESS * sizeof *faults};
  bsdf_run_with(&any, "stress", STRESS, &setup, all, &buffer, 1);
  for (size_t i = 0; i < STRESS; i++)
    if (faults[i]) bsdf_name_faults(&any, "any input", i, faults[i]);
}

static void test_any_input(void **state) {
  (void)state;
  uint *params = calloc((CDL_PARAM_MAX + 1) * (size_t)PARAM_SETS, sizeof *params);
  uint *faults = calloc(STRESS, sizeof *faults);
  assert_true(params && faults);
  for (int model = 0; model < BSDF_MODEL_COUNT; model++) check_any_input(model, params, faults);
  print_message("%d inputs to each of %d models\n", STRESS, BSDF_MODEL_COUNT);
  free(params);
  free(faults);
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_sampling),
      cmocka_unit_test(test_pairs),
      cmocka_unit_test(test_any_input),
  };
  return cmocka_run_group_tests(tests, bsdf_device_open, bsdf_device_close);
}
