/* compare.h: the same expressions of library functions on the host and on a device, bit for bit.
 *
 * A test lists its cases as `#define CASES(X) X(name, limit, expression) …`, where `expression` of
 * floats a and b gives a float; arguments lie within +-limit. */
#ifndef CANDELA_TESTS_COMPARE_H
#define CANDELA_TESTS_COMPARE_H

#include "lib/portable.h"

#define COMPARE_KERNEL(name, limit, expression)                                                    \
  "__kernel void test_" #name "(__global const float *as, __global const float *bs,\n"             \
  "                             __global float *results) {\n"                                      \
  "  size_t i = get_global_id(0);\n"                                                               \
  "  float a = as[i], b = bs[i];\n"                                                                \
  "  (void)b;\n"                                                                                   \
  "  results[i] = " #expression ";\n"                                                              \
  "}\n"

#define COMPARE_HOST(name, limit, expression)                                                      \
  static float host_##name(float a, float b) {                                                     \
    (void)b;                                                                                       \
    return expression;                                                                             \
  }

#define COMPARE_ROW(name, limit, expression) {"test_" #name, limit, host_##name},

/* A helper of expressions, compiled for the host and kept as text for the device. */
#define COMPARE_SHARED(name, ...)                                                                  \
  __VA_ARGS__                                                                                      \
  static const char name##_text[] = #__VA_ARGS__ "\n";

typedef struct CompareCase {
  const char *kernel;
  float limit;
  float (*host)(float, float);
} CompareCase;

/* Runs every case over a million arguments, floats of every size among them and never a NaN, on the
 * first device of `platform` (NULL: any), and fails the running test when a bit differs. Skips it,
 * saying so, where there is no such device. `source` is the device's program in parts that end with
 * NULL. */
void compare_on(const char *platform, const char *const *source, const CompareCase *cases,
                size_t count);

#endif
