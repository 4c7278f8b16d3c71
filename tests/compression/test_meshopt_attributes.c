/* test_meshopt_attributes.c: our decoder of attribute streams: version 1 against what another
 * encoder wrote, version 0 against that of the library; and the colour filter. */
#include <meshoptimizer.h>
#include <math.h>
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

/* Colours of 5 to 8 and 16 bits whose chroma is whole: those come back to the rounding of their
 * bits to 8 or 16. */
static void test_colors(void **state) {
  (void)state;
  for (int bits = 5; bits <= 16; bits++) {
    int most = (1 << bits) - 1, step = most / 31;
    size_t stride = bits <= 8 ? 4 : 8;
    for (int r = 0; r < 31 * step; r += 4 * step)
      for (int b = r % (2 * step); b < 31 * step; b += 2 * step) {
        int co = (r - b) / 2, y = b + co, g = y, a = most / 3;
        int stored[4] = {y, co, 0, 1 << (bits - 1) | a >> 1}, alpha = a >> 1 << 1 | (a >> 1 & 1);
        int wanted[4] = {2 * co + b, g, b, alpha};
        uint8_t bytes[4];
        uint16_t shorts[4];
        for (int c = 0; c < 4; c++) bytes[c] = (uint8_t)stored[c], shorts[c] = (uint16_t)stored[c];
        meshopt_colors(stride == 4 ? bytes : (uint8_t *)shorts, 1, stride);
        for (int c = 0; c < 4; c++) {
          double value = stride == 4 ? bytes[c] / 255.0 : shorts[c] / 65535.0;
          assert_true(fabs(value - wanted[c] / (double)most) <= (stride == 4 ? 0.51 / 255 : 1e-5));
        }
      }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_version_1),
                                     cmocka_unit_test(test_version_0),
                                     cmocka_unit_test(test_colors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
