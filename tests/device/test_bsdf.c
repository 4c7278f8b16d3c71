/* test_bsdf.c: every surface model on the device against what a BSDF must be: sampled as its
 * density says, positive, reciprocal, no brighter than the light that reaches it, and finite
 * everywhere.
 *
 * One table of materials drives all tests. Densities are integrated in double on the host. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/gltf.h"
#include "bsdf/mirror.h"
#include "bsdf/retroreflector.h"
#include "tests/device/chi2.h"
#include "tests/device/harness.h"

enum {
  SAMPLES = 1000000,
  PAIRS = 1 << 17,
  STRESS = 10000384, /* a multiple of the strip times 64 */
  STRIP = 16,
  RESULTS = 12,
  PARAMETERS = 20,
  CELLS_X = 24,
  CELLS_Y = 32
};

#define BECKMANN CDL_MATERIAL_BECKMANN
#define SEPARABLE CDL_MATERIAL_SEPARABLE

typedef struct Material {
  const char *name, *model;
  float base, roughness, metallic, alpha_x, alpha_y, ior;
  float eta, k; /* eta 0: a metal that absorbs nothing */
  uint flags;
  float energy; /* most that it may return of uniform light: 1 but where the model is known to
                   differ */
} Material;

#define ROUGH(model, x, y, flags)                                                                  \
  { #model " " #x " " #y " " #flags, #model, 1, 0, 0, x, y, 1.5f, 0, 1, flags, 1 }
#define GLTF(base, roughness, metallic, energy)                                                    \
  {                                                                                                \
    "gltf " #base " " #roughness " " #metallic, "gltf", base, roughness, metallic, 0, 0, 1.5f, 0,  \
        1, 0, energy                                                                               \
  }

static const Material materials[] = {
    {"diffuse", "diffuse", 1, 0, 0, 0, 0, 1.5f, 0, 1, 0, 1},
    ROUGH(conductor, 0.02f, 0.02f, 0),
    ROUGH(conductor, 0.2f, 0.2f, 0),
    ROUGH(conductor, 0.5f, 0.5f, SEPARABLE),
    ROUGH(conductor, 1.0f, 1.0f, 0),
    ROUGH(conductor, 0.1f, 0.4f, 0),
    ROUGH(conductor, 0.7f, 0.05f, SEPARABLE),
    ROUGH(conductor, 0.02f, 0.02f, BECKMANN),
    ROUGH(conductor, 0.2f, 0.2f, BECKMANN | SEPARABLE),
    ROUGH(conductor, 0.5f, 0.5f, BECKMANN),
    ROUGH(conductor, 1.0f, 1.0f, BECKMANN),
    ROUGH(conductor, 0.1f, 0.4f, BECKMANN | SEPARABLE),
    {"gold", "conductor", 1, 0, 0, 0.3f, 0.3f, 1.5f, 0.18f, 3.4f, 0, 1},
    ROUGH(retroreflector, 0.05f, 0.05f, 0),
    ROUGH(retroreflector, 0.4f, 0.4f, SEPARABLE),
    ROUGH(retroreflector, 0.3f, 0.1f, BECKMANN),
    GLTF(1, 0.0f, 1, 1),
    GLTF(1, 0.3f, 1, 1),
    GLTF(0.7f, 1.0f, 1, 1),
    GLTF(1, 0.2f, 0, 1.5f),
    GLTF(1, 0.6f, 0, 1.06f),
    GLTF(0.2f, 1.0f, 0, 1),
    GLTF(0, 0.4f, 0, 1),
    GLTF(0.5f, 0.5f, 0.5f, 1),
};

enum { MATERIALS = sizeof materials / sizeof *materials };

/* cos theta and phi of wo */
static const float views[][2] = {{1.0f, 0.0f}, {0.8f, 0.4f}, {0.4f, 2.1f}, {0.08f, 4.0f}};

enum { VIEWS = sizeof views / sizeof *views };

typedef BsdfValue (*Evaluate)(BsdfParams p, vec3 wo, vec3 wi);

static Evaluate evaluate_of(const Material *m) {
  switch (m->model[0]) {
  case 'd':
    return diffuse_evaluate;
  case 'c':
    return conductor_evaluate;
  case 'r':
    return retroreflector_evaluate;
  default:
    return gltf_evaluate;
  }
}

static Harness *harness;

static BsdfParams params_of(const Material *m) {
  BsdfParams p = {.base = v3_all(m->base), .roughness = m->roughness, .metallic = m->metallic};
  p.alpha_x = m->alpha_x;
  p.alpha_y = m->alpha_y;
  p.ior = m->ior;
  p.eta = v3_all(m->eta);
  p.k = v3_all(m->k);
  p.flags = m->flags;
  p.front = 1;
  return p;
}

static vec3 view_of(const float view[2]) {
  float sine = sqrtf(1 - view[0] * view[0]);
  return v3(sine * cosf(view[1]), sine * sinf(view[1]), view[0]);
}

/* Runs PREFIX_MODEL; the caller frees the rows. */
static float *run_rows(const char *prefix, const char *model, BsdfParams p, vec3 wo, uint seed,
                       size_t items, size_t rows) {
  float a[PARAMETERS] = {p.base.x,  p.base.y,  p.base.z, p.roughness, p.metallic,
                         p.alpha_x, p.alpha_y, p.ior,    p.eta.x,     p.eta.y,
                         p.eta.z,   p.k.x,     p.k.y,    p.k.z,       as_float(p.flags),
                         0,         wo.x,      wo.y,     wo.z,        as_float(seed)};
  a[15] = as_float((uint)p.front);
  float *out = calloc(items * rows, sizeof *out);
  assert_non_null(out);
  HarnessBuffer buffers[] = {{a, sizeof a}, {out, items * rows * sizeof *out}};
  char kernel[64];
  snprintf(kernel, sizeof kernel, "%s_%s", prefix, model);
  harness_run(harness, kernel, items / STRIP, buffers, 2);
  return out;
}

/* ---- sampling against the density ---- */

/* Directions about the middle of the lobe: x = s / (s + spread) with s = 1 - cos of the angle to
 * it, y the angle around it, so that a narrow lobe fills as many cells as a wide one. */
typedef struct Chart {
  Evaluate evaluate;
  BsdfParams p;
  vec3 wo;
  double axes[3][3], spread;
} Chart;

static Chart chart_of(const Material *m, vec3 wo) {
  Chart c = {evaluate_of(m), params_of(m), wo, {{0}}, 1};
  double width = fmax(fmax(m->alpha_x, m->alpha_y), m->roughness * m->roughness);
  c.spread = m->model[0] == 'd' ? 1 : fmin(fmax(2 * width * width, 1e-4), 1);
  int centred = m->model[0] == 'd';
  double z[3] = {centred ? 0 : -wo.x, centred ? 0 : -wo.y, centred ? 1 : wo.z};
  if (m->model[0] == 'r') z[0] = wo.x, z[1] = wo.y;
  double t = hypot(z[0], z[1]), x[3] = {t > 0 ? -z[1] / t : 1, t > 0 ? z[0] / t : 0, 0};
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    c.axes[0][i] = x[i];
    c.axes[1][i] = z[j] * x[k] - z[k] * x[j];
    c.axes[2][i] = z[i];
  }
  return c;
}

static double chart_density(const void *context, double x, double y) {
  const Chart *c = context;
  double s = c->spread * x / (1 - x), ds = c->spread / ((1 - x) * (1 - x));
  double radius = sqrt(fmax(s * (2 - s), 0)), l[3] = {radius * cos(y), radius * sin(y), 1 - s};
  double w[3];
  for (int i = 0; i < 3; i++)
    w[i] = l[0] * c->axes[0][i] + l[1] * c->axes[1][i] + l[2] * c->axes[2][i];
  return ds * c->evaluate(c->p, c->wo, v3((float)w[0], (float)w[1], (float)w[2])).pdf;
}

static size_t chart_cell(const Chart *c, const double w[3]) {
  double l[3];
  for (int i = 0; i < 3; i++)
    l[i] = w[0] * c->axes[i][0] + w[1] * c->axes[i][1] + w[2] * c->axes[i][2];
  /* 1 - l without cancellation near the pole */
  double side = l[0] * l[0] + l[1] * l[1], s = l[2] > 0 ? side / (1 + l[2]) : 1 - l[2];
  double x = s / (s + c->spread) * (2 + c->spread) / 2, y = atan2(l[1], l[0]) / (2 * M_PI);
  size_t i = (size_t)fmin(fmax(x * CELLS_X, 0), CELLS_X - 1);
  size_t j = (size_t)fmin((y < 0 ? y + 1 : y) * CELLS_Y, CELLS_Y - 1);
  return i * CELLS_Y + j;
}

/* The last cell is what falls below the surface. Returns the integral of the pdf above it. */
static double expect_cells(const Chart *c, double expected[CELLS_X * CELLS_Y + 1]) {
  double total = 0, end = 2 / (2 + c->spread);
#pragma omp parallel for schedule(dynamic, 8) reduction(+ : total)
  for (int i = 0; i < CELLS_X * CELLS_Y; i++) {
    int ix = i / CELLS_Y, iy = i % CELLS_Y;
    double x[2] = {end * ix / CELLS_X, end * (ix + 1) / CELLS_X};
    double y[2] = {2 * M_PI * iy / CELLS_Y, 2 * M_PI * (iy + 1) / CELLS_Y};
    double mass = chi2_integrate(chart_density, c, x, y, 2e-7);
    expected[i] = mass * SAMPLES;
    total += mass;
  }
  expected[CELLS_X * CELLS_Y] = fmax(1 - total, 0) * SAMPLES;
  return total;
}

/* The device's evaluation has the host's bits. */
static void check_bits(const Material *m, vec3 wo, const float *rows) {
  for (size_t i = 0; i < SAMPLES; i += 16) {
    vec3 wi = v3(rows[i], rows[SAMPLES + i], rows[2 * SAMPLES + i]);
    BsdfValue value = evaluate_of(m)(params_of(m), wo, wi);
    if (value.f_cos.x != rows[8 * SAMPLES + i] || value.pdf != rows[11 * SAMPLES + i])
      fail_msg("%s: item %zu has other bits than the host's", m->name, i);
  }
}

/* pdf and weight of every sample are those of evaluate; returns the mean weight. */
static double check_samples(const Material *m, const float *rows) {
  double sum = 0;
  for (size_t i = 0; i < SAMPLES; i++) {
#define ROW(k) ((double)rows[(k) * (size_t)SAMPLES + i])
    if (ROW(2) <= 0 && (ROW(3) != 0 || ROW(6) != 0)) fail_msg("%s: light from below", m->name);
    if (fabs(ROW(6) - ROW(11)) > 1e-4 * ROW(11))
      fail_msg("%s: pdf %g %g", m->name, ROW(6), ROW(11));
    double product = ROW(3) * ROW(6);
    if (fabs(product - ROW(8)) > 1e-4 * ROW(8) + 1e-30)
      fail_msg("%s: weight pdf = %g, f cos = %g", m->name, product, ROW(8));
    sum += ROW(3);
  }
  return sum / SAMPLES;
}

static double chi2_of(const Chart *c, const float *rows, const double *expected, double *below) {
  static double observed[CELLS_X * CELLS_Y + 1];
  for (size_t i = 0; i <= CELLS_X * CELLS_Y; i++) observed[i] = 0;
  for (size_t i = 0; i < SAMPLES; i++) {
    double w[3] = {ROW(0), ROW(1), ROW(2)};
    observed[w[2] > 0 ? chart_cell(c, w) : CELLS_X * CELLS_Y]++;
  }
  *below = observed[CELLS_X * CELLS_Y] / SAMPLES;
  return chi2_test(observed, expected, CELLS_X * CELLS_Y + 1);
}

static void test_sampling(void **state) {
  (void)state;
  double threshold = chi2_threshold(MATERIALS * VIEWS), least = 1, brightest = 0;
  static double expected[CELLS_X * CELLS_Y + 1];
  for (size_t i = 0; i < MATERIALS * VIEWS; i++) {
    const Material *m = &materials[i / VIEWS];
    vec3 wo = view_of(views[i % VIEWS]);
    Chart chart = chart_of(m, wo);
    float *rows = run_rows("sample", m->model, chart.p, wo, (uint)i + 1, SAMPLES, RESULTS);
    check_bits(m, wo, rows);
    double albedo = check_samples(m, rows), below;
    double total = expect_cells(&chart, expected);
    double p = chi2_of(&chart, rows, expected, &below);
    free(rows);
    double error = 4 * sqrt(below * (1 - below) / SAMPLES) + 1e-4;
    if (fabs(total + below - 1) > error)
      fail_msg("%s, view %zu: pdf %g, below %g", m->name, i % VIEWS, total, below);
    if (p < threshold) fail_msg("%s, view %zu: p = %g", m->name, i % VIEWS, p);
    if (albedo > m->energy * 1.0005) fail_msg("%s: returns %g", m->name, albedo);
    least = fmin(least, p);
    brightest = fmax(brightest, albedo);
  }
  print_message("%d samplings of 10^6: least p %.2g (%.2g passes), most light returned %.4f\n",
                MATERIALS * VIEWS, least, threshold, brightest);
}

/* ---- reciprocity, positivity, the lower side ---- */

static void test_pairs(void **state) {
  (void)state;
  for (size_t m = 0; m < MATERIALS; m++) {
    BsdfParams p = params_of(&materials[m]);
    p.base = v3(p.base.x, 0.5f * p.base.y, 0.1f);
    float *rows = run_rows("pairs", materials[m].model, p, v3(0, 0, 1), 7 + (uint)m, PAIRS, 7);
    for (size_t i = 0; i < PAIRS; i++) {
      for (size_t c = 0; c < 3; c++) {
        double there = rows[c * PAIRS + i], back = rows[(c + 3) * PAIRS + i];
        if (!(there >= 0) || !(fabs(there - back) <= 1e-4 * fmax(there, back) + 1e-12))
          fail_msg("%s: f(wo, wi) = %.9g, f(wi, wo) = %.9g", materials[m].name, there, back);
      }
      if (rows[6 * PAIRS + i] != 0) fail_msg("%s: not black from below", materials[m].name);
    }
    free(rows);
  }
}

/* ---- any input ---- */

static void test_any_input(void **state) {
  (void)state;
  static const char *const models[] = {"diffuse",    "mirror",         "conductor",
                                       "dielectric", "retroreflector", "gltf"};
  for (size_t m = 0; m < 6; m++) {
    float *rows =
        run_rows("stress", models[m], params_of(&materials[0]), v3(0, 0, 1), 3, STRESS, 1);
    for (size_t i = 0; i < STRESS; i++)
      if (rows[i] != 0) fail_msg("%s: item %zu, faults %g", models[m], i, (double)rows[i]);
    free(rows);
  }
}

/* ---- delta lobes ---- */

static void check_delta(const char *model, BsdfParams p, vec3 wo, vec3 expected) {
  float *rows = run_rows("sample", model, p, wo, 5, SAMPLES, RESULTS);
  for (size_t i = 0; i < SAMPLES; i++) {
    double error =
        fabs(ROW(0) - expected.x) + fabs(ROW(1) - expected.y) + fabs(ROW(2) - expected.z);
    assert_true(error < 1e-6);
    assert_true(ROW(7) == 1 && ROW(6) == 0 && ROW(8) == 0 && ROW(11) == 0);
  }
  free(rows);
}

static void test_delta_lobes(void **state) {
  (void)state;
  BsdfParams p = params_of(&materials[0]);
  vec3 wo = view_of(views[1]);
  check_delta("mirror", p, wo, v3(-wo.x, -wo.y, wo.z));
  check_delta("conductor", p, wo, v3(-wo.x, -wo.y, wo.z));
  check_delta("retroreflector", p, wo, wo);
}

/* Snell's law, the share of each lobe, and that radiance over index squared is conserved. */
static void check_glass(vec3 wo, int front) {
  BsdfParams p = params_of(&materials[0]);
  p.front = front;
  double eta = front ? 1.5 : 1 / 1.5, sine = hypot(wo.x, wo.y) / eta;
  double ct = sqrt(fmax(1 - sine * sine, 0)), ci = wo.z;
  double s = (ci - eta * ct) / (ci + eta * ct), q = (eta * ci - ct) / (eta * ci + ct);
  double reflectance = sine >= 1 ? 1 : 0.5 * (s * s + q * q), reflected = 0;
  float *rows = run_rows("sample", "dielectric", p, wo, 12, SAMPLES, RESULTS);
  for (size_t i = 0; i < SAMPLES; i++) {
    int transmitted = ROW(7) == 3;
    double weight = transmitted ? 1 / (eta * eta) : 1;
    assert_true(ROW(7) == 1 || transmitted);
    assert_true(fabs(ROW(3) - weight) < 1e-6 && ROW(6) == 0 && ROW(8) == 0);
    assert_true(fabs(hypot(ROW(0), ROW(1)) - (transmitted ? sine : hypot(wo.x, wo.y))) < 1e-6);
    assert_true(ROW(0) * wo.x + ROW(1) * wo.y <= 0 && (ROW(2) < 0) == transmitted);
    reflected += !transmitted;
  }
  free(rows);
  double sigma = sqrt(reflectance * (1 - reflectance) / SAMPLES);
  if (fabs(reflected / SAMPLES - reflectance) > 4 * sigma + 1e-6)
    fail_msg("reflects %g, not %g +- %g", reflected / SAMPLES, reflectance, sigma);
}

static void test_glass(void **state) {
  (void)state;
  for (size_t v = 0; v < VIEWS; v++) {
    check_glass(view_of(views[v]), 1);
    check_glass(view_of(views[v]), 0);
  }
}

static char *read_kernels(void) {
  FILE *file = fopen("tests/device/bsdf.cl", "rb");
  if (!file) return NULL;
  char *text = calloc(1, 1 << 16);
  if (text && fread(text, 1, (1 << 16) - 1, file) == 0) text[0] = 0;
  fclose(file);
  return text;
}

static int open_device(void **state) {
  (void)state;
  harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  char *text = read_kernels();
  if (!harness || !text) return -1;
  print_message("%s\n", harness_name(harness));
  harness_build(harness, text);
  free(text);
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
