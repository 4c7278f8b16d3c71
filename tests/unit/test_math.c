/* test_math.c: the elementary functions of kernels/lib/math.h against the C library in double, over
 * their whole stated ranges. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "lib/math.h"

#define STRIDE 409u /* a prime: every 409th float, 10 million over all bit patterns */

static const double PI = 3.14159265358979323846;

/* Distance in units of the last place of the exact result; overflow counts as 2^128. */
static double ulp_error(float got, double exact) {
  double limit = ldexp(1.0, 128);
  double have = isinf(got) ? copysign(limit, (double)got) : (double)got;
  double want = fabs(exact) > limit ? copysign(limit, exact) : exact;
  if (have == want) return 0.0;
  int exponent;
  frexp(want, &exponent);
  int last = exponent - 24 < -149 ? -149 : (exponent - 24 > 104 ? 104 : exponent - 24);
  return fabs(have - want) / ldexp(1.0, last);
}

typedef struct Worst {
  double error;
  float x, y;
} Worst;

static void worst_add(Worst *worst, float x, float y, float got, double exact) {
  double error = ulp_error(got, exact);
  if (error > worst->error || error != error) {
    worst->error = error;
    worst->x = x;
    worst->y = y;
  }
}

static void worst_check(const Worst *worst, const char *name, double limit) {
  print_message("  %-12s %.3f ulp at %a, %a\n", name, worst->error, (double)worst->x,
                (double)worst->y);
  assert_true(worst->error <= limit);
}

/* Sweeps every STRIDE-th float within [low, high], both signs as the range allows, and its ends. */
static void sweep(const char *name, float (*function)(float), double (*exact)(double), float low,
                  float high, double limit) {
  Worst worst = {0.0, 0.0f, 0.0f};
  for (uint64_t bits = 0; bits < 0x100000000u; bits += STRIDE) {
    float x = as_float((uint)bits);
    if (x >= low && x <= high) worst_add(&worst, x, 0.0f, function(x), exact((double)x));
  }
  worst_add(&worst, low, 0.0f, function(low), exact((double)low));
  worst_add(&worst, high, 0.0f, function(high), exact((double)high));
  worst_check(&worst, name, limit);
}

static float turns_sin(float x) {
  float s, c;
  math_sincos_2pi(x, &s, &c);
  return s;
}

static float turns_cos(float x) {
  float s, c;
  math_sincos_2pi(x, &s, &c);
  return c;
}

/* Reduced exactly in double first: 2 pi x itself would round. */
static double exact_turns_sin(double x) {
  double quarter = nearbyint(4.0 * x);
  double r = 2.0 * PI * (x - 0.25 * quarter);
  int q = (int)((int64_t)quarter & 3);
  double value = q & 1 ? cos(r) : sin(r);
  return q & 2 ? -value : value;
}

static double exact_turns_cos(double x) {
  double quarter = nearbyint(4.0 * x);
  double r = 2.0 * PI * (x - 0.25 * quarter);
  int q = (int)((int64_t)quarter & 3);
  double value = q & 1 ? sin(r) : cos(r);
  return ((q + 1) & 2) ? -value : value;
}

/* The functions are inline only; these have an address. */
#define WRAP(name)                                                                                 \
  static float call_##name(float x) { return math_##name(x); }
WRAP(sin)
WRAP(cos)
WRAP(exp)
WRAP(exp2)
WRAP(expm1)
WRAP(log)
WRAP(log2)
WRAP(log1p)
WRAP(asin)
WRAP(acos)

/* double versions by name, because tgmath.h makes the plain names generic */
#define EXACT(name)                                                                                \
  static double exact_##name(double x) { return name(x); }
EXACT(sin)
EXACT(cos)
EXACT(exp)
EXACT(exp2)
EXACT(expm1)
EXACT(log)
EXACT(log2)
EXACT(log1p)
EXACT(asin)
EXACT(acos)

static void sines_are_accurate(void **state) {
  (void)state;
  sweep("sin 2 pi x", turns_sin, exact_turns_sin, -1048576.0f, 1048576.0f, 2.0);
  sweep("cos 2 pi x", turns_cos, exact_turns_cos, -1048576.0f, 1048576.0f, 2.0);
  sweep("sin", call_sin, exact_sin, -131072.0f, 131072.0f, 2.0);
  sweep("cos", call_cos, exact_cos, -131072.0f, 131072.0f, 2.0);
}

/* The floats around multiples of pi/2, where the reduction cancels most. */
static void sines_are_accurate_near_their_zeros(void **state) {
  (void)state;
  Worst sine = {0.0, 0.0f, 0.0f}, cosine = {0.0, 0.0f, 0.0f};
  for (int k = 1; k <= 83443; k++) {
    float x = math_next_down((float)(k * (PI / 2)));
    for (int i = 0; i < 3; i++, x = math_next_up(x)) {
      worst_add(&sine, x, 0.0f, math_sin(x), sin((double)x));
      worst_add(&cosine, -x, 0.0f, math_cos(-x), cos((double)x));
    }
  }
  worst_check(&sine, "sin", 2.0);
  worst_check(&cosine, "cos", 2.0);
}

static void quarter_turns_are_exact(void **state) {
  (void)state;
  for (int k = -8; k <= 8; k++) {
    float s, c;
    math_sincos_2pi(0.25f * (float)k, &s, &c);
    assert_true(s == (float)((k & 1) * ((k & 2) ? -1 : 1)));
    assert_true(c == (float)((~k & 1) * ((k & 2) ? -1 : 1)));
  }
}

static void exponentials_are_accurate(void **state) {
  (void)state;
  sweep("exp", call_exp, exact_exp, -INFINITY, INFINITY, 2.0);
  sweep("exp2", call_exp2, exact_exp2, -INFINITY, INFINITY, 2.0);
  sweep("expm1", call_expm1, exact_expm1, -INFINITY, INFINITY, 3.0);
}

static void logarithms_are_accurate(void **state) {
  (void)state;
  sweep("log", call_log, exact_log, 0.0f, INFINITY, 2.0);
  sweep("log2", call_log2, exact_log2, 0.0f, INFINITY, 2.0);
  sweep("log1p", call_log1p, exact_log1p, -1.0f, INFINITY, 3.0);
  assert_true(math_log(-1.0f) == -INFINITY && math_log1p(-2.0f) == -INFINITY);
  for (int e = -149; e <= 127; e++) assert_true(math_log2((float)ldexp(1.0, e)) == (float)e);
}

static void arcs_are_accurate(void **state) {
  (void)state;
  sweep("asin", call_asin, exact_asin, -1.0f, 1.0f, 3.0);
  sweep("acos", call_acos, exact_acos, -1.0f, 1.0f, 3.0);
  assert_true(math_acos(1.5f) == 0.0f && math_asin(-1.5f) == math_asin(-1.0f));
}

static uint hash(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

static void pow_is_accurate(void **state) {
  (void)state;
  Worst worst = {0.0, 0.0f, 0.0f}, small = {0.0, 0.0f, 0.0f};
  for (uint i = 0; i < 3000000u; i++) {
    /* any positive float to an exponent whose result is in or just outside the range of floats */
    float x = as_float(hash(2u * i) % 0x7f800000u);
    float result = (float)(hash(2u * i + 1u) / 4294967296.0 * 310.0 - 155.0);
    float y = (float)((double)result / log2((double)x));
    if (x > 0.0f) worst_add(&worst, x, y, math_pow(x, y), pow((double)x, (double)y));
    /* bases in [0, 2], exponents in [-8, 8]: what shading asks for */
    float base = (float)hash(2u * i) / 2147483648.0f;
    float exponent = (float)hash(2u * i + 1u) / 268435456.0f - 8.0f;
    worst_add(&small, base, exponent, math_pow(base, exponent),
              pow((double)base, (double)exponent));
  }
  worst_check(&worst, "pow", 4.0);
  worst_check(&small, "pow, small", 3.0);
}

static void pow_keeps_its_edges(void **state) {
  (void)state;
  static const float bases[] = {0.0f, 1e-45f, 0.5f, 0.99999994f, 1.0f, 1.0000001f, 2.0f, INFINITY};
  static const float exponents[] = {-INFINITY, -3e38f, -2.0f, -1e-45f, -0.0f,   0.0f,
                                    1e-45f,    1.0f,   2.0f,  3e38f,   INFINITY};
  for (size_t i = 0; i < sizeof bases / sizeof *bases; i++)
    for (size_t j = 0; j < sizeof exponents / sizeof *exponents; j++) {
      float want = (float)pow((double)bases[i], (double)exponents[j]);
      assert_true(ulp_error(math_pow(bases[i], exponents[j]), (double)want) <= 2.0);
    }
  assert_true(math_pow(-3.0f, 2.0f) == 0.0f);
}

static void atan2_is_accurate(void **state) {
  (void)state;
  Worst worst = {0.0, 0.0f, 0.0f};
  for (uint i = 0; i < 4000000u; i++) {
    uint a = hash(2u * i), b = hash(2u * i + 1u);
    float y = as_float(a), x = as_float(b);
    /* every other pair of like size, because two random exponents seldom are */
    if (i & 1u) x = as_float((b & 0x807fffffu) | (a & 0x7f800000u));
    if (y - y == 0.0f && x - x == 0.0f)
      worst_add(&worst, y, x, math_atan2(y, x), atan2((double)y, (double)x));
  }
  worst_check(&worst, "atan2", 3.0);
}

/* -0 counts as 0: its sign is not the same on all devices. */
static void atan2_ignores_signed_zeros(void **state) {
  (void)state;
  static const float v[] = {-1.0f, -0.0f, 0.0f, 1.0f, 1e-45f, 3.40282347e+38f};
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) {
      double want = atan2(v[i] == 0.0f ? 0.0 : (double)v[i], v[j] == 0.0f ? 0.0 : (double)v[j]);
      float got = math_atan2(v[i], v[j]);
      assert_true(ulp_error(got, want) <= 1.0);
    }
}

static void neighbours_and_rounding_match_the_library(void **state) {
  (void)state;
  for (uint64_t bits = 0; bits < 0x100000000u; bits += STRIDE) {
    float x = as_float((uint)bits);
    if (x != x) continue;
    assert_true(math_next_up(x) == nextafterf(x, INFINITY));
    assert_true(math_next_down(x) == nextafterf(x, -INFINITY));
    assert_true(math_abs(x) == fabsf(x));
    assert_true(math_sign(x) == (x < 0.0f ? -1.0f : 1.0f));
    if (math_abs(x) <= 4194304.0f) assert_int_equal(math_round_int(x), (int)rintf(x));
  }
  assert_true(math_next_up(-0.0f) == as_float(1u) && math_next_up(0.0f) == as_float(1u));
  assert_true(math_next_up(INFINITY) == INFINITY && math_next_down(INFINITY) == 3.40282347e+38f);
}

static void helpers_meet_their_contracts(void **state) {
  (void)state;
  assert_true(math_lerp(0.1f, 0.7f, 0.0f) == 0.1f && math_lerp(0.1f, 0.7f, 1.0f) == 0.7f);
  assert_true(math_clamp(2.0f, -1.0f, 1.0f) == 1.0f && math_clamp(-2.0f, -1.0f, 1.0f) == -1.0f);
  assert_true(math_safe_sqrt(-1.0f) == 0.0f && math_safe_sqrt(4.0f) == 2.0f);
  assert_true(math_mulsign(-2.0f, -3.0f) == 2.0f && math_mulsign(2.0f, -0.0f) == 2.0f);
  assert_true(math_saturate(1.5f) == 1.0f && math_sqr(-3.0f) == 9.0f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sines_are_accurate),
      cmocka_unit_test(sines_are_accurate_near_their_zeros),
      cmocka_unit_test(quarter_turns_are_exact),
      cmocka_unit_test(exponentials_are_accurate),
      cmocka_unit_test(logarithms_are_accurate),
      cmocka_unit_test(arcs_are_accurate),
      cmocka_unit_test(pow_is_accurate),
      cmocka_unit_test(pow_keeps_its_edges),
      cmocka_unit_test(atan2_is_accurate),
      cmocka_unit_test(atan2_ignores_signed_zeros),
      cmocka_unit_test(neighbours_and_rounding_match_the_library),
      cmocka_unit_test(helpers_meet_their_contracts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
