/* test_bsdf_delta.c: the models that have delta lobes, on the device, against Snell's law,
 * Fresnel's equations and Cauchy's. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "tests/device/bsdf_device.h"
#include "tests/device/bsdf_lobes.h"

enum { SAMPLES = 1 << 20, FEW = 1 << 12 };

#define INDEX_ERROR 5e-6 /* of a dispersive index in single precision */

#define ROW(k) ((double)rows[(k)*items + i])

static const float *draw(const BsdfCase *c, vec3 wo, size_t items) {
  static float rows[BSDF_DRAW_ROWS * SAMPLES];
  BsdfSetup setup = bsdf_setup_of(c, wo, 12);
  HarnessBuffer buffer = {rows, BSDF_DRAW_ROWS * items * sizeof *rows};
  bsdf_run(c, "draw", items, &setup, &buffer, 1);
  return rows;
}

static void check_delta(int model, vec3 wo, vec3 expected) {
  const BsdfCase c = {.name = "smooth", .model = model, .base = {1, 1, 1}, .words = {0, 0, 1.5f}};
  size_t items = SAMPLES;
  const float *rows = draw(&c, wo, items);
  for (size_t i = 0; i < items; i++) {
    double error =
        fabs(ROW(0) - expected.x) + fabs(ROW(1) - expected.y) + fabs(ROW(2) - expected.z);
    assert_true(error < 1e-6);
    assert_true(ROW(8) == 1 && ROW(6) == 0 && ROW(7) == 1);
  }
}

static void test_delta_lobes(void **state) {
  (void)state;
  const BsdfCase any = {.width = 1};
  vec3 wo = bsdf_view(&any, 1), mirrored = v3(-wo.x, -wo.y, wo.z);
  check_delta(BSDF_mirror, wo, mirrored);
  check_delta(BSDF_conductor, wo, mirrored);
  check_delta(BSDF_retroreflector, wo, wo);
}

/* Of glass seen from wo: what it reflects and the sine of what it refracts; by Fresnel's two
 * amplitudes and Snell's law. */
static double reflectance_of(double eta, double cosine, double *sine) {
  *sine = sqrt(1 - cosine * cosine) / eta;
  if (*sine >= 1) return 1;
  double ct = sqrt(1 - *sine * *sine);
  double s = (cosine - eta * ct) / (cosine + eta * ct);
  double p = (eta * cosine - ct) / (eta * cosine + ct);
  return 0.5 * (s * s + p * p);
}

/* Snell's law, the share of each lobe, and that radiance over index squared is conserved. A tint is
 * of what passes; a path that disperses is left its channel alone. */
static void check_glass(const BsdfCase *c, vec3 wo, size_t items) {
  double eta = bsdf_eta_of(c), sine, reflectance = reflectance_of(eta, wo.z, &sine), reflected = 0;
  const float *rows = draw(c, wo, items);
  for (size_t i = 0; i < items; i++) {
    int transmitted = ROW(8) == 3;
    assert_true(ROW(8) == 1 || transmitted);
    for (int k = 0; k < 3; k++) {
      double weight = transmitted ? c->base[k] / (eta * eta) : 1;
      if (c->abbe > 0 && k != c->channel) weight = 0;
      if (fabs(ROW(3 + k) - weight) > INDEX_ERROR * fmax(weight, 1))
        fail_msg("%s: channel %d weighs %g, not %g", c->name, k, ROW(3 + k), weight);
    }
    assert_true(ROW(6) == 0 && fabs(ROW(7) - (transmitted ? eta : 1)) < INDEX_ERROR);
    if (fabs(hypot(ROW(0), ROW(1)) - (transmitted ? sine : hypot(wo.x, wo.y))) > INDEX_ERROR)
      fail_msg("%s: sine %.9g, not %.9g", c->name, hypot(ROW(0), ROW(1)), sine);
    assert_true(ROW(0) * wo.x + ROW(1) * wo.y <= 0 && (ROW(2) < 0) == transmitted);
    reflected += !transmitted;
  }
  double share = reflected / (double)items;
  double sigma = sqrt(reflectance * (1 - reflectance) / (double)items);
  if (fabs(share - reflectance) > 4.5 * sigma + 1e-6)
    fail_msg("%s reflects %g, not %g +- %g", c->name, share, reflectance, sigma);
}

static void test_glass(void **state) {
  (void)state;
  BsdfCase c = {.name = "glass", .model = BSDF_dielectric, .base = {1, 0.5f, 0.1f}, .width = 1};
  c.eta = c.words[CDL_DIELECTRIC_IOR] = 1.5f;
  for (size_t v = 0; v < BSDF_VIEWS; v++)
    for (c.inside = 0; c.inside < 2; c.inside++) check_glass(&c, bsdf_view(&c, v), SAMPLES);
}

/* Three kinds of glass, from flint to none that exists, at wavelengths of all channels. */
static void test_dispersion(void **state) {
  (void)state;
  static const float glasses[][2] = {{1.5168f, 64.17f}, {1.7847f, 25.68f}, {1.4f, 5}};
  enum { WAVELENGTHS = 7 };
  size_t checked = 0;
  for (int i = 0; i < 3 * 3 * WAVELENGTHS; i++) {
    const float *glass = glasses[i % 3];
    BsdfCase c = {.name = "dispersive glass",
                  .model = BSDF_dielectric,
                  .base = {1, 1, 1},
                  .width = 1,
                  .eta = glass[0],
                  .abbe = glass[1],
                  .channel = i / 3 % 3,
                  .wavelength = (float)(i / 9) / WAVELENGTHS,
                  .words = {glass[0], glass[1]}};
    for (size_t v = 0; v < BSDF_VIEWS; v++)
      for (c.inside = 0; c.inside < 2; c.inside++, checked++)
        check_glass(&c, bsdf_view(&c, v), FEW);
  }
  print_message("%zu directions and wavelengths\n", checked);
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_delta_lobes),
      cmocka_unit_test(test_glass),
      cmocka_unit_test(test_dispersion),
  };
  return cmocka_run_group_tests(tests, bsdf_device_open, bsdf_device_close);
}
