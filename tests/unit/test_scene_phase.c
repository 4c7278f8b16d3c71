/* test_scene_phase.c: the phase functions that CDL_medium asks for, and their errors. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/build.h"
#include "scene_text.h"

#define NEAR(a, b) assert_true(fabs((double)(a) - (double)(b)) < 1e-5)

static struct cdl_Scene *phase_scene(const char *members) {
  return scene_from("{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"CDL_medium\"],"
                    "\"scenes\":[{\"extensions\":{\"CDL_medium\":{\"scattering\":1,"
                    "\"phase\":{%s}}}}]}",
                    members);
}

static cdl_ScenePhase phase_from(const char *members) {
  struct cdl_Scene *scene = phase_scene(members);
  if (!scene) fail_msg("%s: %s", members, scene_errors);
  assert_int_equal(scene->medium_count, 1);
  assert_int_equal(scene->extensions[0].state, CDL_EXTENSION_USED);
  cdl_ScenePhase phase = scene->media[0].phase;
  scene_free(scene);
  return phase;
}

static void check(const char *members, const char *type, const double values[5]) {
  cdl_ScenePhase p = phase_from(members);
  const double found[5] = {p.g[0], p.alpha[0], p.g[1], p.alpha[1], p.second};
  assert_string_equal(p.type, type);
  for (int i = 0; i < 5; i++)
    if (fabs(found[i] - values[i]) > 1e-6 * fmax(1, values[i]))
      fail_msg("%s: value %d is %g, not %g", members, i, found[i], values[i]);
}

static void test_types(void **state) {
  (void)state;
  check("", "isotropic", (double[]){0, 0, 0, 0, 0});
  check("\"type\":\"isotropic\",\"g\":0.5", "isotropic", (double[]){0, 0, 0, 0, 0});
  check("\"type\":\"hg\",\"g\":-0.7", "hg", (double[]){-0.7, 0, 0, 0, 0});
  check("\"type\":\"hg\",\"g\":0.999999", "hg", (double[]){0.99999, 0, 0, 0, 0});
  check("\"type\":\"two_term_hg\",\"g\":[0.8,-0.4]", "two_term_hg",
        (double[]){0.8, 0, -0.4, 0, 0.5});
  check("\"type\":\"two_term_hg\",\"g\":[0.8,-0.4],\"weight\":0.1", "two_term_hg",
        (double[]){0.8, 0, -0.4, 0, 0.1});
  check("\"type\":\"rayleigh\",\"g\":0.5", "rayleigh", (double[]){0, 1, 0, 0, 0});
  check("\"type\":\"draine\",\"g\":0.6", "draine", (double[]){0.6, 1, 0, 0, 0});
  check("\"type\":\"draine\",\"g\":0.6,\"alpha\":20", "draine", (double[]){0.6, 20, 0, 0, 0});
  check("\"type\":\"draine\",\"alpha\":1e30", "draine", (double[]){0, 1e6, 0, 0, 0});
}

/* Mean cosine of a mixture of Draine's lobes (Jendersie and d'Eon 2023, equation 3). */
static double mean_cosine(cdl_ScenePhase p) {
  double mean = 0;
  for (int k = 0; k < 2; k++) {
    double g = p.g[k], a = p.alpha[k], w = k ? p.second : 1 - p.second;
    mean += w * g * (1 + a * (3 + 2 * g * g) / 5) / (1 + a * (1 + 2 * g * g) / 3);
  }
  return mean;
}

static cdl_ScenePhase droplets(double diameter) {
  char text[64];
  snprintf(text, sizeof text, "\"type\":\"droplets\",\"diameter\":%.9g", diameter);
  return phase_from(text);
}

/* Mie's theory for water and visible light: the asymmetry of cloud droplets is about 0.84 at 5 um
 * and grows with their size, to a little below 0.9; droplets far smaller than the wavelength
 * scatter as Rayleigh says, 3/4 (1 + cos^2). */
static void test_droplets(void **state) {
  (void)state;
  for (double d = 0.001; d <= 50; d *= 1.01) {
    cdl_ScenePhase p = droplets(d);
    assert_true(fabsf(p.g[0]) <= 0.999f && fabsf(p.g[1]) <= 0.999f);
    assert_true(p.alpha[0] == 0 && p.alpha[1] > 5 && p.alpha[1] <= 250);
    assert_true(p.second > 0 && p.second < 0.6);
  }
  double before = 0.83;
  for (double d = 5; d <= 50; d += 5) {
    double g = mean_cosine(droplets(d));
    assert_true(g > before && g < 0.9);
    before = g;
  }
  cdl_ScenePhase p = droplets(0.001);
  assert_true(fabs(mean_cosine(p)) < 1e-4);
  double across = 1 - p.second + p.second / (1 + p.alpha[1] / 3);
  double along = 1 - p.second + p.second * (1 + p.alpha[1]) / (1 + p.alpha[1] / 3);
  assert_true(fabs(across - 0.75) < 0.01 && fabs(along - 1.5) < 0.02);
}

/* The fits once more, in double and with the tangent, on both sides of its pole. */
static void test_middle_droplets(void **state) {
  (void)state;
  static const double diameters[] = {1.5, 2, 3.1, 4.7, 4.81, 4.82, 4.99};
  for (int i = 0; i < 7; i++) {
    double l = log(diameters[i]);
    cdl_ScenePhase p = droplets(diameters[i]);
    NEAR(p.g[0], 0.940256 + 0.0604931 * log(l));
    NEAR(p.g[1], 0.500411 - 0.081287 / (tan(l) - 2 * l + 1.27551));
    NEAR(p.alpha[1], 6.31675 + 7.30354 * l);
    NEAR(p.second, 0.376475 + 0.026914 * (l - cos(5.68947 * (log(l) - 0.0292149))));
  }
}

static void refused(const char *members, const char *pointer, const char *code) {
  char wanted[256];
  assert_null(phase_scene(members));
  assert_int_equal(scene_status, CDL_BAD_INPUT);
  assert_int_equal(scene_error_count, 1);
  snprintf(wanted, sizeof wanted, ": /scenes/0/extensions/CDL_medium/phase%s: %s: ", pointer, code);
  if (!strstr(scene_errors, wanted)) fail_msg("%s", scene_errors);
}

static void test_errors(void **state) {
  (void)state;
  refused("\"type\":\"mie\"", "/type", "VALUE_NOT_IN_LIST");
  refused("\"type\":\"hg\",\"g\":-1", "/g", "VALUE_NOT_IN_RANGE");
  refused("\"type\":\"hg\",\"g\":1", "/g", "VALUE_NOT_IN_RANGE");
  refused("\"type\":\"hg\",\"g\":[0.1,0.2]", "/g", "TYPE_MISMATCH");
  refused("\"type\":\"hg\",\"g\":\"x\"", "/g", "TYPE_MISMATCH");
  refused("\"type\":\"two_term_hg\",\"g\":[0.1,-2]", "/g/1", "VALUE_NOT_IN_RANGE");
  refused("\"type\":\"two_term_hg\",\"g\":[0.1]", "/g", "ARRAY_LENGTH_NOT_IN_LIST");
  refused("\"type\":\"two_term_hg\",\"weight\":1.5", "/weight", "VALUE_NOT_IN_RANGE");
  refused("\"type\":\"draine\",\"alpha\":-1", "/alpha", "VALUE_NOT_IN_RANGE");
  refused("\"type\":\"droplets\"", "", "UNDEFINED_PROPERTY");
  refused("\"type\":\"droplets\",\"diameter\":0", "/diameter", "VALUE_NOT_IN_RANGE");
  refused("\"type\":\"droplets\",\"diameter\":51", "/diameter", "VALUE_NOT_IN_RANGE");
}

/* `candela info` tells them. */
static void test_info(void **state) {
  (void)state;
  struct cdl_Scene *scene = phase_scene("\"type\":\"droplets\",\"diameter\":20");
  assert_non_null(scene);
  char *text = cdl_scene_info_text(scene), *json = cdl_scene_info_json(scene);
  assert_non_null(text);
  assert_non_null(json);
  assert_non_null(strstr(text, "   0  droplets     absorbs 0 0 0, scatters "));
  const char *list = strstr(json, "\"phase_functions\"");
  assert_non_null(list);
  assert_non_null(strstr(list, "\"droplets\""));
  free(text);
  free(json);
  scene_free(scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_types),
      cmocka_unit_test(test_droplets),
      cmocka_unit_test(test_middle_droplets),
      cmocka_unit_test(test_errors),
      cmocka_unit_test(test_info),
  };
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
