/* The host's trigonometry against the C library's in double, where it must not lose digits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "core/angle.h"

static double off(double got, double want) { return fabs(got - want) / fmax(fabs(want), 1e-300); }

/* Half an ulp of the angle as a part of a turn, two of the result and one of the sum. */
static void test_sincos(void **state) {
  (void)state;
  for (double x = -700; x < 700; x += 0.0137) {
    float sine, cosine;
    angle_sincos(x, &sine, &cosine);
    assert_true(fabs(sine - sin(x)) < 4e-7 && fabs(cosine - cos(x)) < 4e-7);
  }
  for (double x = 1e-12; x < 0.7; x *= 1.01) {
    assert_true(off(angle_sin(x), sin(x)) < 4e-7);
    assert_true(off(angle_sin(-x), sin(-x)) < 4e-7);
    assert_true(off(angle_tan(x), tan(x)) < 6e-7);
    assert_true(off(angle_versine(x), 2 * pow(sin(x / 2), 2)) < 8e-7);
  }
}

static void test_quarter_turns(void **state) {
  (void)state;
  static const float sines[] = {0, 1, 0, -1};
  for (int i = -9; i < 9; i++) {
    float sine, cosine;
    angle_sincos(i * M_PI / 2, &sine, &cosine);
    assert_true(sine == sines[i & 3] && cosine == sines[(i + 1) & 3]);
  }
}

/* Angles far too small for an arc cosine, and the opposite. */
static void test_between(void **state) {
  (void)state;
  for (double x = 1e-9; x < M_PI; x *= 1.01)
    assert_true(off(angle_between(2 * sin(x / 2), 2 * cos(x / 2)), x) < 4e-7);
  assert_true(angle_between(0, 2) == 0);
  assert_true(off(angle_between(2, 0), M_PI) < 1e-7 && off(angle_between(1, 1), M_PI / 2) < 1e-7);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sincos),
                                     cmocka_unit_test(test_quarter_turns),
                                     cmocka_unit_test(test_between)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
