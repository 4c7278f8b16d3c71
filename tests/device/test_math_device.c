/* test_math_device.c: kernels/lib/math.h gives the same bits on a device as on the host, where
 * tests/unit/test_math.c holds it against the C library. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>

#include "kernels/lib/math.h"
#include "tests/device/harness.h"

enum { ITEMS = 1 << 20 };

/* name, largest |argument|, expression of a and b: compiled for the host and, as text, for the
 * device */
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

#define PICK_TURNS                                                                                 \
  "CDL_INLINE float pick_turns(float a, int cosine) {\n"                                           \
  "  float s, c;\n"                                                                                \
  "  math_sincos_2pi(a, &s, &c);\n"                                                                \
  "  return cosine ? c : s;\n"                                                                     \
  "}\n"

static float pick_turns(float a, int cosine) {
  float s, c;
  math_sincos_2pi(a, &s, &c);
  return cosine ? c : s;
}

#define KERNEL_TEXT(name, limit, expression)                                                       \
  "__kernel void test_" #name "(__global const float *as, __global const float *bs,\n"             \
  "                             __global float *results) {\n"                                      \
  "  size_t i = get_global_id(0);\n"                                                               \
  "  float a = as[i], b = bs[i];\n"                                                                \
  "  (void)b;\n"                                                                                   \
  "  results[i] = " #expression ";\n"                                                              \
  "}\n"

#define HOST_FUNCTION(name, limit, expression)                                                     \
  static float host_##name(float a, float b) {                                                     \
    (void)b;                                                                                       \
    return expression;                                                                             \
  }
CASES(HOST_FUNCTION)

typedef struct Case {
  const char *kernel;
  float limit;
  float (*host)(float, float);
} Case;

#define CASE_ROW(name, limit, expression) {"test_" #name, limit, host_##name},
static const Case cases[] = {CASES(CASE_ROW)};

static const char source[] = "#include \"lib/math.h\"\n" PICK_TURNS CASES(KERNEL_TEXT);

static uint hash(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

/* Every fourth value is spread evenly over [-limit, limit], the others over all bit patterns;
 * never a NaN. */
static float make_input(uint i, float limit) {
  uint u = hash(i);
  float even = ((float)(u >> 8) / 8388608.0f - 1.0f) * (limit > 1e30f ? 1e3f : limit);
  float wild = as_float(u);
  int usable = wild == wild && math_abs(wild) <= limit;
  return (i & 3u) == 0u || !usable ? even : wild;
}

static int same_bits(float a, float b) { return as_uint(a) == as_uint(b) || (a != a && b != b); }

static size_t count_differences(Harness *harness, const Case *test, float *a, float *b, float *r) {
  for (uint i = 0; i < ITEMS; i++) {
    a[i] = make_input(2u * i, test->limit);
    b[i] = make_input(2u * i + 1u, test->limit);
    r[i] = -1.0f;
  }
  const HarnessBuffer buffers[] = {{a, ITEMS * 4}, {b, ITEMS * 4}, {r, ITEMS * 4}};
  harness_run(harness, test->kernel, ITEMS, buffers, 3);
  size_t differences = 0;
  for (uint i = 0; i < ITEMS; i++) {
    float want = test->host(a[i], b[i]);
    if (same_bits(r[i], want)) continue;
    if (differences++ == 0)
      print_message("  %s(%a, %a): device %a, host %a\n", test->kernel, (double)a[i], (double)b[i],
                    (double)r[i], (double)want);
  }
  return differences;
}

static void compare_on(const char *platform) {
  Harness *harness = harness_open(platform);
  if (!harness) {
    print_message("  skipped: no device of platform %s\n", platform ? platform : "(any)");
    skip();
  }
  print_message("  %s\n", harness_name(harness));
  harness_build(harness, source);
  float *values = malloc(3 * ITEMS * sizeof *values);
  assert_non_null(values);
  size_t total = 0;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    total += count_differences(harness, &cases[i], values, values + ITEMS, values + 2 * ITEMS);
  free(values);
  harness_close(harness);
  assert_int_equal(total, 0);
}

static void first_device_matches_host(void **state) {
  (void)state;
  compare_on(NULL);
}

static void rusticl_matches_host(void **state) {
  (void)state;
  compare_on("rusticl");
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_device_matches_host),
      cmocka_unit_test(rusticl_matches_host),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
