/* test_math_device.c: kernels/lib/math.h gives the same bits on a device as on the host, where
 * tests/unit/test_math.c holds it against the C library. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "lib/math.h"
#include "compare.h"
#include "harness.h"

COMPARE_SHARED(
    pick_turns, CDL_INLINE float pick_turns(float a, int cosine) {
      float s, c;
      math_sincos_2pi(a, &s, &c);
      return cosine ? c : s;
    })

#define CASES(X)                                                                                   \
  X(turns_sin, 1048576.0f, pick_turns(a, 0))                                                       \
  X(turns_cos, 1048576.0f, pick_turns(a, 1))                                                       \
  X(sin, INFINITY, math_sin(a))                                                                    \
  X(cos, INFINITY, math_cos(a))                                                                    \
  X(exp, INFINITY, math_exp(a))                                                                    \
  X(exp_near, 100.0f, math_exp(a))                                                                 \
  X(exp2, INFINITY, math_exp2(a))                                                                  \
  X(exp2_near, 150.0f, math_exp2(a))                                                               \
  X(expm1, INFINITY, math_expm1(a))                                                                \
  X(expm1_near, 20.0f, math_expm1(a))                                                              \
  X(log, INFINITY, math_log(a))                                                                    \
  X(log_near, 2.0f, math_log(a))                                                                   \
  X(log2, INFINITY, math_log2(a))                                                                  \
  X(log2_near, 2.0f, math_log2(a))                                                                 \
  X(log1p, INFINITY, math_log1p(a))                                                                \
  X(log1p_near, 2.0f, math_log1p(a))                                                               \
  X(pow, INFINITY, math_pow(math_abs(a), b))                                                       \
  X(pow_near, 8.0f, math_pow(math_abs(a), b))                                                      \
  X(atan2, INFINITY, math_atan2(a, b))                                                             \
  X(atan2_near, 2.0f, math_atan2(a, b))                                                            \
  X(asin, INFINITY, math_asin(a))                                                                  \
  X(asin_near, 1.0f, math_asin(a))                                                                 \
  X(acos, INFINITY, math_acos(a))                                                                  \
  X(acos_near, 1.0f, math_acos(a))                                                                 \
  X(next_up, INFINITY, math_next_up(a))                                                            \
  X(next_down, INFINITY, math_next_down(a))                                                        \
  X(round_int, 4194304.0f, (float)math_round_int(a))                                               \
  X(safe_sqrt, INFINITY, math_safe_sqrt(a))                                                        \
  X(lerp, 1e15f, math_lerp(a, b, 0.3f))                                                            \
  X(clamp, INFINITY, math_clamp(a, -1.0f, math_abs(b)))                                            \
  X(min, INFINITY, math_min(a, b))                                                                 \
  X(max, INFINITY, math_max(a, b))                                                                 \
  X(sign, INFINITY, math_mulsign(math_sign(a), b))

CASES(COMPARE_HOST)

static const CompareCase cases[] = {CASES(COMPARE_ROW)};
static const char *const source[] = {"#include \"lib/math.h\"\n", pick_turns_text,
                                     CASES(COMPARE_KERNEL), NULL};

static void first_device_matches_host(void **state) {
  (void)state;
  compare_on(NULL, source, cases, sizeof cases / sizeof *cases);
}

static void rusticl_matches_host(void **state) {
  (void)state;
  compare_on("rusticl", source, cases, sizeof cases / sizeof *cases);
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_device_matches_host),
      cmocka_unit_test(rusticl_matches_host),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
