/* test_lecture.c: the worked figures of the lecture on material modelling that this project is made
 * from, computed on the device by the functions that render. Angles are in degrees. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/build.h"
#include "tests/device/harness.h"

static Harness *harness;

static void run(const char *kernel, const float *in, size_t in_count, float *out, size_t out_count,
                size_t items) {
  HarnessBuffer buffers[] = {{(void *)in, in_count * sizeof *in}, {out, out_count * sizeof *out}};
  harness_run(harness, kernel, items, buffers, 2);
}

static double radians(double degrees) { return degrees * M_PI / 180; }

static void near(double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance)) fail_msg("%.9g is not %.9g", value, expected);
}

/* ---- reflection, refraction ---- */

static void test_reflection(void **state) {
  (void)state;
  float in[6] = {1, 1, 0, 0, 1, 0}, out[3] = {0};
  run("reflection", in, 6, out, 3, 1);
  near(out[0], -1, 0), near(out[1], 1, 0), near(out[2], 0, 0);
}

typedef struct Boundary {
  float reflectance, cos_t, s, p, total, direction[3];
} Boundary;

static Boundary boundary(double degrees, double eta) {
  float in[2] = {(float)cos(radians(degrees)), (float)eta};
  Boundary b = {0};
  run("dielectric_boundary", in, 2, &b.reflectance, 8, 1);
  return b;
}

static void test_snell(void **state) {
  (void)state;
  Boundary b = boundary(45, 1.33);
  near(acos(b.cos_t) / radians(1), 32.1, 0.05);
  near(acos(b.cos_t) / radians(1), asin(sin(radians(45)) / 1.33) / radians(1), 1e-4);
  /* the direction lies on the other side, of length 1, and obeys the law as well */
  near(-b.direction[0], sin(radians(45)) / 1.33, 1e-6);
  near(b.direction[2], -b.cos_t, 1e-6);
}

static void test_total_reflection(void **state) {
  (void)state;
  double critical = asin(1 / 1.33) / radians(1);
  near(critical, 48.8, 0.05);
  assert_true(boundary(critical - 0.01, 1 / 1.33).total == 0);
  assert_true(boundary(critical + 0.01, 1 / 1.33).total == 1);
  Boundary at40 = boundary(40, 1 / 1.33), at60 = boundary(60, 1 / 1.33);
  assert_true(at40.total == 0 && at40.reflectance > 0 && at40.reflectance < 1);
  near(at40.direction[2], -sqrt(1 - pow(1.33 * sin(radians(40)), 2)), 1e-5);
  assert_true(at60.total == 1 && at60.reflectance == 1 && at60.cos_t == 0);
}

/* ---- Fresnel ---- */

/* Indices of the lecture; reflectances of Moller et al., Real-Time Rendering, 4th ed., table 9.1.
 */
static void test_dielectrics(void **state) {
  (void)state;
  near(boundary(0, 1.5).reflectance, 0.04, 1e-6);
  near(boundary(0, 1.333).reflectance, 0.02, 0.001);
  near(boundary(0, 2.42).reflectance, 0.172, 0.001);
  assert_true(boundary(89, 1.5).reflectance > 0.85);
  double brewster = atan(1.5) / radians(1);
  near(boundary(brewster, 1.5).p, 0, 1e-6);
  near(boundary(brewster, 1.5).reflectance, 0.5 * pow(1.25 / 3.25, 2), 1e-6);
  for (int i = 0; i <= 89; i++) {
    Boundary b = boundary(i, 1.333);
    double ct = cos(asin(sin(radians(i)) / 1.333)), ci = cos(radians(i));
    double s = (ci - 1.333 * ct) / (ci + 1.333 * ct), p = (1.333 * ci - ct) / (1.333 * ci + ct);
    near(b.s, s, 2e-6), near(b.p, p, 2e-6), near(b.reflectance, 0.5 * (s * s + p * p), 2e-6);
    /* the same boundary from below */
    near(boundary(acos(b.cos_t) / radians(1), 1 / 1.333).reflectance, b.reflectance, 2e-5);
  }
}

static double conductor_by_complex(double cos_i, double eta, double k) {
  double complex n = eta + I * k, ct = csqrt(1 - (1 - cos_i * cos_i) / (n * n));
  double s = cabs((cos_i - n * ct) / (cos_i + n * ct)),
         p = cabs((n * cos_i - ct) / (n * cos_i + ct));
  return 0.5 * (s * s + p * p);
}

/* The renderer's metals at normal incidence against Moller et al., Real-Time Rendering, 4th ed.,
 * table 9.2 (gold's red is given there as 1.022, out of gamut); and at all angles against the
 * equations in complex numbers. */
static void test_metals(void **state) {
  (void)state;
  static const struct {
    const char *name;
    double reflectance[3];
  } table[] = {{"Au", {1, 0.782, 0.344}},
               {"Ag", {0.972, 0.960, 0.915}},
               {"Cu", {0.955, 0.638, 0.538}},
               {"Al", {0.913, 0.922, 0.924}}};
  for (int m = 0; m < 4; m++) {
    float in[91 * 7], out[91 * 3] = {0}, eta[3], k[3];
    assert_true(metal_index(table[m].name, eta, k));
    for (int i = 0; i <= 90; i++) {
      in[7 * i] = (float)fmax(cos(radians(i)), 0);
      for (int c = 0; c < 3; c++) in[7 * i + 1 + c] = eta[c], in[7 * i + 4 + c] = k[c];
    }
    run("metal", in, 91 * 7, out, 91 * 3, 91);
    for (int c = 0; c < 3; c++) near(out[c], table[m].reflectance[c], 0.035);
    for (int i = 0; i < 91 * 3; i++)
      near(out[i], conductor_by_complex(in[i / 3 * 7], eta[i % 3], k[i % 3]), 1e-6);
  }
}

/* ---- microfacets ---- */

static void test_microfacet_product(void **state) {
  (void)state;
  float in[6] = {0.8f, 0.9f, 0.5f, 0.8f, 0.8f, 1}, out[2] = {0};
  run("microfacet", in, 6, out, 2, 1);
  near(out[0], 0.140625, 1e-7);
  near(out[0], 0.14, 0.001);
}

static void set_normal(float h[3], double degrees, double phi) {
  h[0] = (float)(sin(radians(degrees)) * cos(phi));
  h[1] = (float)(sin(radians(degrees)) * sin(phi));
  h[2] = (float)cos(radians(degrees));
}

/* Beckmann, alpha 0.5, 30 degrees: 0.597 in the form with 1 / (pi alpha^2 cos^4), whose integral of
 * D cos over the hemisphere is 1: the form used here. So does GGX's. */
static void test_distributions(void **state) {
  (void)state;
  enum { STEPS = 4096 };
  float *in = calloc(3 + 3 * STEPS, sizeof *in), *out = calloc(STEPS, sizeof *out);
  assert_true(in && out);
  in[0] = in[1] = 0.5f;
  for (int beckmann = 0; beckmann < 2; beckmann++) {
    double sum = 0, width = 90.0 / STEPS;
    in[2] = (float)beckmann;
    set_normal(in + 3, 30, 0.7);
    run("facets", in, 6, out, 1, 1);
    near(out[0], beckmann ? 0.597 : 1 / (M_PI * 0.25 * pow(0.75 + 0.25 / 0.25, 2)),
         beckmann ? 0.0005 : 1e-6);
    for (int i = 0; i < STEPS; i++) set_normal(in + 3 + 3 * i, (i + 0.5) * width, 0);
    run("facets", in, 3 + 3 * STEPS, out, STEPS, STEPS);
    for (int i = 0; i < STEPS; i++)
      sum += out[i] * cos(radians((i + 0.5) * width)) * sin(radians((i + 0.5) * width));
    near(sum * 2 * M_PI * radians(width), 1, 1e-5);
  }
  free(in);
  free(out);
}

/* Solid angle of half vectors over that of wi, by differences in double. */
static void test_half_vector_jacobian(void **state) {
  (void)state;
  const double wo[3] = {0.6, 0, 0.8}, wi[3] = {-0.36, 0.48, 0.8}, step = 1e-5;
  const double t[2][3] = {{0.8, 0.6, 0}, {-0.48, 0.64, -0.6}};
  double h[3][3], cosine = 0;
  for (int n = 0; n < 3; n++) {
    double length = 0;
    for (int i = 0; i < 3; i++) {
      h[n][i] = wo[i] + wi[i] + (n ? step * t[n - 1][i] : 0);
      length += h[n][i] * h[n][i];
    }
    for (int i = 0; i < 3; i++) h[n][i] /= sqrt(length);
  }
  double area = 0;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double a = (h[1][j] - h[0][j]) * (h[2][k] - h[0][k]);
    area += pow(a - (h[1][k] - h[0][k]) * (h[2][j] - h[0][j]), 2);
    cosine += wo[i] * h[0][i];
  }
  float in[6] = {1, 1, 1, 1, 1, (float)cosine}, out[2] = {0};
  run("microfacet", in, 6, out, 2, 1);
  near(out[1], sqrt(area) / (step * step), 1e-4);
}

/* ---- sampling ---- */

static void test_importance_sampling(void **state) {
  (void)state;
  enum { COUNT = 1 << 20 };
  float in[1] = {0.7f}, *out = calloc(4 * (size_t)COUNT, sizeof *out);
  assert_non_null(out);
  run("samples", in, 1, out, 4 * (size_t)COUNT, COUNT);
  double cosine = 0, tan2 = 0;
  for (size_t i = 0; i < COUNT; i++) {
    cosine += out[4 * i] / COUNT;
    /* the weight is the albedo: pi f L of a uniform sky, sample by sample */
    if (out[4 * i] > 0) near(out[4 * i + 1], 0.7, 1e-6);
    tan2 += fmin(out[4 * i + 2], 100) / COUNT;
    near(out[4 * i + 3], 1, 1e-3);
  }
  free(out);
  near(cosine, 2.0 / 3, 4 * sqrt(1.0 / 18 / COUNT));
  /* tan^2 is exponential of mean alpha^2 */
  near(tan2, 0.25, 4 * 0.25 / sqrt(COUNT));
}

/* ---- frames and media ---- */

static void test_local_frame(void **state) {
  (void)state;
  float in[6] = {0.36f, -0.48f, -0.8f, 1, 2, 3}, out[15] = {0};
  run("local_frame", in, 6, out, 15, 1);
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++) {
      double dot = 0;
      for (int i = 0; i < 3; i++) dot += (double)out[3 * a + i] * out[3 * b + i];
      near(dot, a == b, 1e-6);
    }
    near(out[6 + a], in[a], 0);
    near(out[12 + a], in[3 + a], 1e-6);
  }
  near(out[11], 0.36 - 0.96 - 2.4, 1e-6); /* z in the frame is the cosine to the normal */
}

/* 0.28 is 4 pi p, relative to isotropic scattering's 1: p is normalised over the sphere. */
static void test_henyey_greenstein(void **state) {
  (void)state;
  float in[8] = {0, 0.7f, 0, -0.7f, 0.3f, 0, 1, 0.7f}, out[4] = {0};
  run("phase", in, 8, out, 4, 4);
  near(4 * M_PI * out[0], 0.28, 0.005);
  near(4 * M_PI * out[0], 0.51 / pow(1.49, 1.5), 1e-6);
  near(out[1], out[0], 0);
  near(4 * M_PI * out[2], 1, 1e-6);
  near(4 * M_PI * out[3], 0.51 / pow(0.3, 3), 2e-4);
}

static void test_beer_lambert(void **state) {
  (void)state;
  float in[4] = {0, 0.69314718f, 3, 2}, out[3] = {0};
  run("beer_lambert", in, 4, out, 3, 1);
  near(out[0], 1, 0), near(out[1], 0.25, 1e-6), near(out[2], exp(-6), 1e-8);
}

static int open_device(void **state) {
  (void)state;
  harness = harness_open_with("tests/device/lecture.cl");
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
      cmocka_unit_test(test_reflection),
      cmocka_unit_test(test_snell),
      cmocka_unit_test(test_total_reflection),
      cmocka_unit_test(test_dielectrics),
      cmocka_unit_test(test_metals),
      cmocka_unit_test(test_microfacet_product),
      cmocka_unit_test(test_distributions),
      cmocka_unit_test(test_half_vector_jacobian),
      cmocka_unit_test(test_importance_sampling),
      cmocka_unit_test(test_local_frame),
      cmocka_unit_test(test_henyey_greenstein),
      cmocka_unit_test(test_beer_lambert),
  };
  return cmocka_run_group_tests(tests, open_device, close_device);
}
