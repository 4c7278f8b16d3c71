/* test_meshopt_attributes.c: our decoder of attribute streams: version 1 against what another
 * encoder wrote, version 0 against that of the library. */
#include <meshoptimizer.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "meshopt_v1.h"
#include "scene/compression.h"

/* The values that the streams were made from. */
static void test_version_1(void **state) {
  (void)state;
  static float floats[300][3], got_floats[300][3];
  uint16_t shorts[100][4], got_shorts[100][4];
  uint8_t bytes[40][4], got_bytes[40][4];
  uint32_t words[64][2], got_words[64][2], x = 1;
  for (int i = 0; i < 300; i++)
    floats[i][0] = i / 16.0f, floats[i][1] = (i % 5) / 8.0f, floats[i][2] = -i / 4.0f;
  for (int i = 0; i < 100; i++)
    shorts[i][0] = (uint16_t)(i * 300), shorts[i][1] = (uint16_t)(1000 - i),
    shorts[i][2] = (i * i) & 0xff, shorts[i][3] = 7;
  for (int i = 0; i < 160; i++) {
    x = x * 1664525u + 1013904223u;
    bytes[i / 4][i % 4] = (uint8_t)(i % 4 == 3 ? 255 : i % 4 == 2 ? x >> 31 : x >> 24);
  }
  x = 1;
  for (int i = 0; i < 64; i++) {
    x = x * 1664525u + 1013904223u;
    words[i][0] = 0x3f000000u | (x >> 28) << 14;
    words[i][1] = (x >> 27 & 1 ? 0x80000000u : 0) | (x >> 8 & 0x700000);
  }
  assert_true(meshopt_attributes(v1_floats, sizeof v1_floats, 300, 12, (uint8_t *)got_floats));
  assert_true(meshopt_attributes(v1_shorts, sizeof v1_shorts, 100, 8, (uint8_t *)got_shorts));
  assert_true(meshopt_attributes(v1_bytes, sizeof v1_bytes, 40, 4, got_bytes[0]));
  assert_true(meshopt_attributes(v1_words, sizeof v1_words, 64, 8, (uint8_t *)got_words));
  assert_memory_equal(got_floats, floats, sizeof floats);
  assert_memory_equal(got_shorts, shorts, sizeof shorts);
  assert_memory_equal(got_bytes, bytes, sizeof bytes);
  assert_memory_equal(got_words, words, sizeof words);
  for (size_t cut = 0; cut < sizeof v1_words; cut++)
    assert_false(meshopt_attributes(v1_words, cut, 64, 8, (uint8_t *)got_words));
}

/* Our decoder against the library's encoder, on what both know: version 0, every stride. */
static void test_version_0(void **state) {
  (void)state;
  static uint8_t from[700 * 256], to[sizeof from + 70000], back[sizeof from];
  uint32_t x = 7;
  for (size_t stride = 4; stride <= 256; stride += 4) {
    size_t count = 1 + stride * 37 % 700;
    for (size_t i = 0; i < count * stride; i++) {
      x = x * 1664525u + 1013904223u;
      from[i] = (uint8_t)(i % stride % 3 ? x >> 24 >> i % stride % 9 : i / stride);
    }
    size_t size = meshopt_encodeVertexBuffer(to, sizeof to, from, count, stride);
    assert_true(meshopt_attributes(to, size, count, stride, back));
    assert_memory_equal(back, from, count * stride);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_version_1),
                                     cmocka_unit_test(test_version_0)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
