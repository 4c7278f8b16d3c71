/* test_bsdf.c: every surface model on the device against what a BSDF must be: sampled as its
 * density says, positive, reciprocal, no brighter than the light that reaches it, and finite
 * everywhere.
 *
 * One table of models and parameters (bsdf_models.h) drives all tests. Densities are integrated in
 * double on the host. CDL_SOAK=1 takes every view of every case and more input. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bsdf/energy.h"
#include "bsdf/fresnel.h"
#include "lib/rng.h"
#include "lib/sampling.h"
#include "scene/pack_parts.h"
#include "tests/device/bsdf_chart.h"
#include "tests/device/bsdf_models.h"
#include "tests/device/chi2.h"
#include "tests/device/harness.h"

enum {
  SAMPLES = 1 << 20,
  PAIRS = 1 << 15,
  PARAM_SETS = 1 << 17,
  STRESS = 10 << 20,
  STRIP = BSDF_STRIP,
  CELLS = 2 * BSDF_CELLS + 1
};

static Harness *harness;
static int built = -1; /* the model whose kernels the harness has */
static int soak;
static float energy[ENERGY_KINDS * ENERGY_KIND_WORDS];

/* cosine and azimuth of wo; the last is seen at 89.9 degrees */
static const double views[][2] = {{1, 0},    {0.8, 0.4}, {0.4, 2.1},
                                  {0.08, 4}, {0.6, 5.2}, {0.0017453, 1.1}};
enum { VIEWS = sizeof views / sizeof *views };

/* Three views of each case: one from above, one from aside, one that grazes. Directions in single
 * precision tell slopes apart by 3e-8 / cosine: lobes must be 200 times as wide. */
static int is_viewed(size_t index, size_t view) {
  static const char of_three[3][VIEWS] = {
      {1, 0, 1, 1, 0, 0}, {0, 1, 1, 0, 0, 1}, {0, 0, 0, 1, 1, 1}};
  int blurred = 200 * 3e-8 > views[view][0] * bsdf_cases[index].width;
  return !blurred && (soak || of_three[index % 3][view]);
}

static vec3 view_of(const double view[2]) {
  double sine = sqrt(1 - view[0] * view[0]);
  return v3((float)(sine * cos(view[1])), (float)(sine * sin(view[1])), (float)view[0]);
}

/* ---- kernels ---- */

static void read_text(const char *path, char *text, size_t size) {
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s cannot be opened; run the tests from the top folder", path);
  text[fread(text, 1, size - 1, file)] = 0;
  fclose(file);
}

/* One program for each model: all together take longer to compile than they take to run. */
static void build(int model) {
  static char setup[1 << 13], kernels[1 << 15], text[1 << 16];
  if (built == model) return;
  const char *name = bsdf_models[model].name;
  read_text("tests/device/bsdf_setup.h", setup, sizeof setup);
  read_text("tests/device/bsdf.cl", kernels, sizeof kernels);
  snprintf(text, sizeof text,
           "%s\n#include \"bsdf/%s.h\"\n#define ModelParams %s\n#define model_params %s_params\n"
           "#define model_evaluate %s_evaluate\n#define model_sample %s_sample\n%s",
           setup, name, bsdf_models[model].type, name, name, name, kernels);
  harness_build(harness, text);
  built = model;
}

static BsdfPoint point_of(const BsdfCase *c) {
  const float *n = c->coat_normal;
  return (BsdfPoint){.base = v3(c->base[0], c->base[1], c->base[2]),
                     .throughput = v3_all(1),
                     .coat_normal = v3(n[0], n[1], sqrtf(1 - n[0] * n[0] - n[1] * n[1])),
                     .flags = c->flags,
                     .front = !c->inside,
                     .energy = energy};
}

static BsdfSetup setup_of(const BsdfCase *c, vec3 wo, uint seed) {
  BsdfPoint p = point_of(c);
  return (BsdfSetup){.base = {p.base.x, p.base.y, p.base.z},
                     .throughput = {1, 1, 1},
                     .coat_normal = {p.coat_normal.x, p.coat_normal.y, p.coat_normal.z},
                     .flags = p.flags,
                     .front = p.front,
                     .wo = {wo.x, wo.y, wo.z},
                     .seed = seed,
                     .weight_max = bsdf_models[c->model].weight_max,
                     .tolerance = 1e-4f};
}

/* ---- sampling against the density ---- */

typedef struct Lobes {
  const BsdfModel *model;
  _Alignas(16) unsigned char params[BSDF_PARAMS_SIZE];
  vec3 wo;
  BsdfChart charts[2]; /* above, below */
} Lobes;

static double density(const void *context, const double w[3]) {
  const Lobes *l = context;
  vec3 wi = v3((float)w[0], (float)w[1], (float)w[2]);
  return l->model->evaluate(l->params, l->wo, wi).pdf;
}

/* Index beyond over index before. */
static double eta_of(const BsdfCase *c) {
  return c->eta <= 0 ? 1 : c->inside ? 1 / (double)c->eta : (double)c->eta;
}

static void lobes_init(Lobes *l, const BsdfCase *c, vec3 wo) {
  l->model = &bsdf_models[c->model];
  l->model->prepare(l->params, point_of(c), (const uint *)c->words);
  l->wo = wo;
  double eta = eta_of(c), z = sqrt(fmax(1 - (1 - wo.z * wo.z) / (eta * eta), 0));
  const double middles[3][3] = {{-wo.x, -wo.y, wo.z}, {0, 0, 1}, {wo.x, wo.y, wo.z}};
  double through[3] = {-wo.x / eta, -wo.y / eta, z};
  bsdf_chart_init(&l->charts[0], middles[c->center], c->width);
  double bend = fmin(fmax(fabs(eta - 1) / fmax(eta, 1), 0.01), 1);
  bsdf_chart_init(&l->charts[1], through, c->width * (eta == 1 ? 1 : bend));
  for (int i = 0; i < 2; i++) {
    l->charts[i].density = density;
    l->charts[i].context = l;
    l->charts[i].below = i;
    l->charts[i].least_depth = wo.z < 0.1f;
  }
}

/* Where the middle of the lobe is reflected totally, what gets through is a sliver along the
 * horizon that quadrature misses; samples of it are compared with evaluations all the same. */
static int is_integrated(const BsdfCase *c, vec3 wo) {
  double eta = eta_of(c);
  return 1 - (double)wo.z * wo.z < eta * eta;
}

typedef struct Sampling {
  double observed[CELLS], none; /* and the share without a density */
  double albedo, error;         /* of uniform light, and its standard error */
} Sampling;

static void name_faults(const BsdfCase *c, const char *what, size_t item, uint faults) {
  static const char *const names[] = {"weight out of range",       "pdf out of range",
                                      "direction not of length 1", "evaluation not sound",
                                      "weight on the wrong side",  "sample's pdf is not evaluate's",
                                      "weight pdf is not f cos",   "weight without a pdf"};
  char text[512] = "";
  for (int i = 0; i < 8; i++)
    if (faults >> i & 1)
      snprintf(text + strlen(text), sizeof text - strlen(text), "; %s", names[i]);
  fail_msg("%s, %s, item %zu%s", c->name, what, item, text);
}

/* The harness writes back what it was given. */
static HarnessBuffer words_of(const BsdfCase *c) {
  static float words[CDL_PARAM_MAX];
  memcpy(words, c->words, sizeof words);
  return (HarnessBuffer){words, sizeof words};
}

static HarnessBuffer energy_buffer(void) { return (HarnessBuffer){energy, sizeof energy}; }

static void run_samples(const BsdfCase *c, const Lobes *l, uint seed, Sampling *s) {
  static uint rows[BSDF_SAMPLE_ROWS * SAMPLES];
  BsdfSetup setup = setup_of(c, l->wo, seed);
  for (int i = 0; i < 2; i++) setup.charts[i] = bsdf_chart_setup(&l->charts[i]);
  HarnessBuffer buffers[] = {
      {&setup, sizeof setup}, words_of(c), energy_buffer(), {rows, sizeof rows}};
  build(c->model);
  harness_run(harness, "sample", SAMPLES / STRIP, buffers, 4);
  double sum = 0, squares = 0;
  *s = (Sampling){.none = 0};
  for (size_t i = 0; i < SAMPLES; i++) {
    if (rows[2 * SAMPLES + i]) name_faults(c, "sample", i, rows[2 * SAMPLES + i]);
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
  static double expected[CELLS];
  static Sampling s;
  Lobes l;
  lobes_init(&l, c, view_of(views[view]));
  run_samples(c, &l, seed, &s);
  double total = bsdf_chart_integrate(&l.charts[0], expected);
  total += bsdf_chart_integrate(&l.charts[1], expected + BSDF_CELLS);
  for (size_t i = 0; i < CELLS; i++) expected[i] *= SAMPLES;
  expected[BSDF_CELL_NONE] = fmax(1 - total, 0) * SAMPLES;
  double p = chi2_test(s.observed, expected, CELLS);
  double error = 4 * sqrt(s.none * (1 - s.none) / SAMPLES) + 3e-4;
  double energy = c->energy > 0 ? c->energy : 1;
  int integrated = is_integrated(c, l.wo);
  if (integrated && fabs(total + s.none - 1) > error)
    fail_msg("%s, view %zu: pdf %g, without a density %g", c->name, view, total, s.none);
  if (integrated && p < threshold) fail_msg("%s, view %zu: p = %g", c->name, view, p);
  if (s.albedo - 3 * s.error > energy * 1.0005)
    fail_msg("%s, view %zu: returns %g +- %g", c->name, view, s.albedo, s.error);
  if (views[view][0] >= c->least_cosine && s.albedo + 3 * s.error < c->least)
    fail_msg("%s, view %zu: returns only %g", c->name, view, s.albedo);
  if (integrated) worst->p = fmin(worst->p, p);
  worst->brightest = fmax(worst->brightest, s.albedo);
  worst->samplings++;
}

static size_t samplings(void) {
  size_t count = 0;
  for (size_t i = 0; bsdf_cases[i].name; i++)
    for (size_t v = 0; v < VIEWS; v++) count += (size_t)is_viewed(i, v);
  return count;
}

static void test_sampling(void **state) {
  (void)state;
  double threshold = chi2_threshold(samplings());
  Worst worst = {1, 0, 0};
  for (int model = 0; model < BSDF_MODEL_COUNT; model++)
    for (size_t i = 0; bsdf_cases[i].name; i++)
      for (size_t v = 0; v < VIEWS && bsdf_cases[i].model == model; v++)
        if (is_viewed(i, v))
          check_sampling(&bsdf_cases[i], v, (uint)(VIEWS * i + v + 1), threshold, &worst);
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
  double eta = through ? eta_of(c) : 1, limit = c->reciprocity > 0 ? c->reciprocity : 1e-3;
  for (size_t k = 0; k < 3; k++) {
    double there = rows[k * PAIRS + i] * eta * eta, back = rows[(k + 3) * PAIRS + i];
    if (!(there >= 0) || !(back >= 0)) fail_msg("%s: f = %g, %g", c->name, there, back);
    if (c->reciprocity < 0) continue;
    if (!(fabs(there - back) <= limit * fmax(there, back) + 1e-6))
      fail_msg("%s, item %zu: f(wo, wi) = %.9g, f(wi, wo) = %.9g", c->name, i, there, back);
  }
}

/* The device's evaluation has the host's bits. */
static void check_bits(const BsdfCase *c, const Lobes *l, vec3 wo, vec3 wi, const float *rows,
                       size_t i) {
  BsdfValue value = l->model->evaluate(l->params, wo, wi);
  if (value.f_cos.x / math_abs(wi.z) != rows[i] || value.pdf != rows[6 * PAIRS + i])
    fail_msg("%s: item %zu has other bits than the host's", c->name, i);
}

static void check_pairs(const BsdfCase *c, float *directions) {
  static float rows[BSDF_PAIR_ROWS * PAIRS];
  Lobes l;
  lobes_init(&l, c, v3(0, 0, 1));
  BsdfSetup setup = setup_of(c, v3(0, 0, 1), 0);
  HarnessBuffer buffers[] = {{&setup, sizeof setup},
                             words_of(c),
                             energy_buffer(),
                             {directions, 6 * PAIRS * sizeof *directions},
                             {rows, sizeof rows}};
  build(c->model);
  harness_run(harness, "pairs", PAIRS / STRIP, buffers, 5);
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
    for (const BsdfCase *c = bsdf_cases; c->name; c++)
      if (c->model == model) check_pairs(c, directions[bsdf_models[model].transmits]);
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
  size_t words = 0;
  for (; m->ranges[words].low != 0 || m->ranges[words].high != 0; words++)
    for (uint i = 0; i < PARAM_SETS; i++)
      params[words * PARAM_SETS + i] = as_uint(random_word(m->ranges[words], (uint)words + 77, i));
  BsdfSetup setup = setup_of(&any, v3(0, 0, 1), 3);
  setup.param_sets = PARAM_SETS;
  HarnessBuffer buffers[] = {{&setup, sizeof setup},
                             {params, (words + 1) * PARAM_SETS * sizeof *params},
                             energy_buffer(),
                             {faults, STRESS * sizeof *faults}};
  build(model);
  harness_run(harness, "stress", STRESS / STRIP, buffers, 4);
  for (size_t i = 0; i < STRESS; i++)
    if (faults[i]) name_faults(&any, "any input", i, faults[i]);
}

static void test_any_input(void **state) {
  (void)state;
  uint *params = calloc((CDL_PARAM_MAX + 1) * (size_t)PARAM_SETS, sizeof *params);
  uint *faults = calloc(STRESS, sizeof *faults);
  assert_true(params && faults);
  for (int model = 0; model < BSDF_MODEL_COUNT; model++) check_any_input(model, params, faults);
  free(params);
  free(faults);
}

/* ---- delta lobes ---- */

#define ROW(k) ((double)rows[(k) * (size_t)SAMPLES + i])

static const float *draw(const BsdfCase *c, vec3 wo) {
  static float rows[BSDF_DRAW_ROWS * SAMPLES];
  BsdfSetup setup = setup_of(c, wo, 12);
  HarnessBuffer buffers[] = {
      {&setup, sizeof setup}, words_of(c), energy_buffer(), {rows, sizeof rows}};
  build(c->model);
  harness_run(harness, "draw", SAMPLES / STRIP, buffers, 4);
  return rows;
}

static void check_delta(int model, vec3 wo, vec3 expected) {
  const BsdfCase c = {.name = "smooth", .model = model, .base = {1, 1, 1}, .words = {0, 0, 1.5f}};
  const float *rows = draw(&c, wo);
  for (size_t i = 0; i < SAMPLES; i++) {
    double error =
        fabs(ROW(0) - expected.x) + fabs(ROW(1) - expected.y) + fabs(ROW(2) - expected.z);
    assert_true(error < 1e-6);
    assert_true(ROW(8) == 1 && ROW(6) == 0 && ROW(7) == 1);
  }
}

static void test_delta_lobes(void **state) {
  (void)state;
  vec3 wo = view_of(views[1]), mirrored = v3(-wo.x, -wo.y, wo.z);
  check_delta(BSDF_mirror, wo, mirrored);
  check_delta(BSDF_conductor, wo, mirrored);
  check_delta(BSDF_retroreflector, wo, wo);
}

/* Snell's law, the share of each lobe, and that radiance over index squared is conserved. */
static void check_glass(vec3 wo, int inside) {
  const BsdfCase c = {.name = "glass",
                      .model = BSDF_dielectric,
                      .base = {1, 1, 1},
                      .inside = inside,
                      .eta = 1.5f,
                      .words = {[CDL_DIELECTRIC_IOR] = 1.5f}};
  double eta = eta_of(&c), sine = hypot(wo.x, wo.y) / eta;
  double ct = sqrt(fmax(1 - sine * sine, 0)), ci = wo.z;
  double s = (ci - eta * ct) / (ci + eta * ct), q = (eta * ci - ct) / (eta * ci + ct);
  double reflectance = sine >= 1 ? 1 : 0.5 * (s * s + q * q), reflected = 0;
  const float *rows = draw(&c, wo);
  for (size_t i = 0; i < SAMPLES; i++) {
    int transmitted = ROW(8) == 3;
    double weight = transmitted ? 1 / (eta * eta) : 1;
    assert_true(ROW(8) == 1 || transmitted);
    assert_true(fabs(ROW(3) - weight) < 1e-6 && ROW(6) == 0);
    assert_true(fabs(ROW(7) - (transmitted ? eta : 1)) < 1e-6);
    assert_true(fabs(hypot(ROW(0), ROW(1)) - (transmitted ? sine : hypot(wo.x, wo.y))) < 1e-6);
    assert_true(ROW(0) * wo.x + ROW(1) * wo.y <= 0 && (ROW(2) < 0) == transmitted);
    reflected += !transmitted;
  }
  double sigma = sqrt(reflectance * (1 - reflectance) / SAMPLES);
  if (fabs(reflected / SAMPLES - reflectance) > 4 * sigma + 1e-6)
    fail_msg("reflects %g, not %g +- %g", reflected / SAMPLES, reflectance, sigma);
}

static void test_glass(void **state) {
  (void)state;
  for (size_t v = 0; v < VIEWS; v++) {
    check_glass(view_of(views[v]), 0);
    check_glass(view_of(views[v]), 1);
  }
}

static int open_device(void **state) {
  (void)state;
  harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  if (!harness) return -1;
  const char *value = getenv("CDL_SOAK");
  soak = value && *value && *value != '0';
  for (uint kind = 0; kind < ENERGY_KINDS; kind++) {
    pack_energy_metal(kind, energy);
    pack_energy_glass(kind, energy);
  }
  print_message("%s\n", harness_name(harness));
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
      cmocka_unit_test(test_sampling),  cmocka_unit_test(test_pairs),
      cmocka_unit_test(test_any_input), cmocka_unit_test(test_delta_lobes),
      cmocka_unit_test(test_glass),
  };
  return cmocka_run_group_tests(tests, open_device, close_device);
}
