#include "compare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "lib/math.h"
#include "harness.h"

enum { ITEMS = 1 << 20, MAX_SOURCE = 65536 };

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

static size_t count_differences(Harness *harness, const CompareCase *test, float *a, float *b,
                                float *r) {
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

static void build(Harness *harness, const char *const *source) {
  char *text = calloc(MAX_SOURCE, 1);
  assert_non_null(text);
  for (size_t i = 0; source[i]; i++) {
    assert_true(strlen(text) + strlen(source[i]) < MAX_SOURCE);
    strcat(text, source[i]);
  }
  harness_build(harness, text);
  free(text);
}

void compare_on(const char *platform, const char *const *source, const CompareCase *cases,
                size_t count) {
  Harness *harness = harness_open(platform);
  if (!harness) {
    print_message("  skipped: no device of platform %s\n", platform ? platform : "(any)");
    skip();
  }
  print_message("  %s\n", harness_name(harness));
  build(harness, source);
  float *values = malloc(3 * ITEMS * sizeof *values);
  assert_non_null(values);
  size_t total = 0;
  for (size_t i = 0; i < count; i++)
    total += count_differences(harness, &cases[i], values, values + ITEMS, values + 2 * ITEMS);
  free(values);
  harness_close(harness);
  assert_int_equal(total, 0);
}
