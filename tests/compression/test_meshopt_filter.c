/* test_meshopt_filter.c: our filters against the specification's formulas in double, against the
 * library's, which may round the other way, and against what unit vectors have to be. */
#include <meshoptimizer.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/meshopt_filter.h"

enum { MANY = 1 << 16 };

static int16_t shorts[MANY][4], ours[MANY][4], theirs[MANY][4];
static uint32_t state_of_random = 1;

static uint32_t chance(uint32_t n) {
  state_of_random = state_of_random * 1664525u + 1013904223u;
  return (uint32_t)((uint64_t)n * state_of_random >> 32);
}

static int within(int most) { return (int)chance(2 * (uint32_t)most + 1) - most; }

/* What a point of the octahedron stands for. */
static void direction(double x, double y, double out[3]) {
  double z = 1 - fabs(x) - fabs(y), px = x, py = y;
  if (z < 0) px = copysign(1 - fabs(y), x), py = copysign(1 - fabs(x), y);
  double length = sqrt(px * px + py * py + z * z);
  out[0] = px / length, out[1] = py / length, out[2] = z / length;
}

/* A decoded value is the nearest integer to the exact one, but for single precision. */
static void check_nearest(int got, double exact, int most) {
  assert_true(fabs(got - exact * most) <= 0.5 + most * 2.5e-7);
}

static void check_vector(const int16_t *stored, const int16_t *got, const int16_t *library,
                         int most) {
  double exact[3], sum = 0;
  direction(stored[0] / (double)stored[2], stored[1] / (double)stored[2], exact);
  for (int c = 0; c < 3; c++) {
    check_nearest(got[c], exact[c], most);
    assert_true(abs(got[c] - library[c]) <= 1);
    sum += (double)got[c] * got[c];
  }
  assert_true(fabs(sqrt(sum) - most) < 0.88);
  assert_int_equal(got[3], stored[3]);
}

/* Every point of every octahedron of up to 8 bits. */
static void test_octahedral_bytes(void **state) {
  (void)state;
  static int8_t in[MANY][4], got[MANY][4], library[MANY][4];
  int differ = 0;
  for (int bits = 2; bits <= 8; bits++) {
    int one = (1 << (bits - 1)) - 1, count = 0;
    for (int y = -one; y <= one; y++)
      for (int x = -one; x <= one; x++, count++)
        in[count][0] = (int8_t)x, in[count][1] = (int8_t)y, in[count][2] = (int8_t)one,
        in[count][3] = (int8_t)count;
    memcpy(got, in, sizeof in);
    memcpy(library, in, sizeof in);
    meshopt_octahedral((uint8_t *)got, (size_t)count, 4);
    meshopt_decodeFilterOct(library, ((size_t)count + 3) & ~(size_t)3, 4);
    for (int i = 0; i < count; i++) {
      int16_t wide[3][4];
      for (int c = 0; c < 4; c++)
        wide[0][c] = in[i][c], wide[1][c] = got[i][c], wide[2][c] = library[i][c];
      check_vector(wide[0], wide[1], wide[2], 127);
      differ += memcmp(got[i], library[i], 4) != 0;
    }
  }
  print_message("%d of the vectors are rounded the other way by the library\n", differ);
}

static void test_octahedral_shorts(void **state) {
  (void)state;
  int differ = 0;
  for (int i = 0; i < MANY; i++) {
    int one = (1 << (1 + i % 15)) - 1;
    int16_t v[4] = {(int16_t)within(one), (int16_t)within(one), (int16_t)one, (int16_t)i};
    memcpy(shorts[i], v, sizeof v);
  }
  memcpy(ours, shorts, sizeof ours);
  memcpy(theirs, shorts, sizeof theirs);
  meshopt_octahedral((uint8_t *)ours, MANY, 8);
  meshopt_decodeFilterOct(theirs, MANY, 8);
  for (int i = 0; i < MANY; i++) {
    check_vector(shorts[i], ours[i], theirs[i], 32767);
    differ += memcmp(ours[i], theirs[i], 8) != 0;
  }
  print_message("%d of the vectors are rounded the other way by the library\n", differ);
}

/* A random unit quaternion as the filter stores it in `bits`, the largest component positive. */
static void store_quaternion(int bits, int16_t out[4]) {
  double q[4], sum = 0;
  int largest = 0, one = (1 << (bits - 1)) - 1;
  for (int c = 0; c < 4; c++) {
    q[c] = within(1000) + 0.5;
    sum += q[c] * q[c];
  }
  for (int c = 1; c < 4; c++)
    if (fabs(q[c]) > fabs(q[largest])) largest = c;
  double scale = copysign(one * sqrt(2 / sum), q[largest]);
  for (int c = 1; c < 4; c++) out[c - 1] = (int16_t)rint(q[(largest + c) & 3] * scale);
  out[3] = (int16_t)((one & ~3) | largest);
}

static void test_quaternions(void **state) {
  (void)state;
  int differ = 0;
  for (int i = 0; i < MANY; i++) store_quaternion(4 + i % 13, shorts[i]);
  memcpy(ours, shorts, sizeof ours);
  memcpy(theirs, shorts, sizeof theirs);
  meshopt_quaternions((uint8_t *)ours, MANY);
  meshopt_decodeFilterQuat(theirs, MANY, 8);
  for (int i = 0; i < MANY; i++) {
    double one = shorts[i][3] | 3, rest = 1, sum = 0;
    int largest = shorts[i][3] & 3;
    for (int c = 1; c < 4; c++) {
      double exact = shorts[i][c - 1] / one * sqrt(0.5);
      rest -= exact * exact;
      check_nearest(ours[i][(largest + c) & 3], exact, 32767);
    }
    check_nearest(ours[i][largest], sqrt(rest), 32767);
    for (int c = 0; c < 4; c++) {
      assert_true(abs(ours[i][c] - theirs[i][c]) <= 1);
      sum += (double)ours[i][c] * ours[i][c];
    }
    assert_true(fabs(sqrt(sum) - 32767) < 1.01);
    differ += memcmp(ours[i], theirs[i], 8) != 0;
  }
  print_message("%d of the quaternions are rounded the other way by the library\n", differ);
}

/* Every exponent that the specification allows: nothing is rounded. */
static void test_exponential(void **state) {
  (void)state;
  enum { EXPONENTS = 201, EACH = 64 };
  static int32_t in[EXPONENTS * EACH];
  static float got[EXPONENTS * EACH], library[EXPONENTS * EACH];
  for (int i = 0; i < EXPONENTS * EACH; i++) {
    int32_t mantissa = i % EACH < 3 ? i % EACH - 1 : within((1 << 23) - 1);
    in[i] = (int32_t)((uint32_t)(i / EACH - 100) << 24 | ((uint32_t)mantissa & 0xffffff));
  }
  memcpy(got, in, sizeof in);
  memcpy(library, in, sizeof in);
  meshopt_exponential((uint8_t *)got, EXPONENTS * EACH / 2, 8);
  meshopt_decodeFilterExp(library, EXPONENTS * EACH / 2, 8);
  assert_memory_equal(got, library, sizeof got);
  for (int i = 0; i < EXPONENTS * EACH; i++) {
    int32_t mantissa = in[i] & 0xffffff;
    if (mantissa >= 1 << 23) mantissa -= 1 << 24;
    assert_true(got[i] == ldexp(mantissa, i / EACH - 100));
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

/* Bytes that no encoder writes give values that are in range all the same. */
static void test_any_bytes(void **state) {
  (void)state;
  int8_t bytes[MANY / 8][4];
  for (int i = 0; i < MANY; i++)
    for (int c = 0; c < 4; c++) shorts[i][c] = (int16_t)chance(1 << 16);
  memcpy(bytes, shorts, sizeof bytes);
  meshopt_octahedral((uint8_t *)bytes, MANY / 8, 4);
  for (int i = 0; i < MANY / 8; i++)
    for (int c = 0; c < 3; c++) assert_true(bytes[i][c] >= -127);
  for (int turn = 0; turn < 2; turn++) {
    memcpy(ours, shorts, sizeof ours);
    if (turn)
      meshopt_quaternions((uint8_t *)ours, MANY);
    else
      meshopt_octahedral((uint8_t *)ours, MANY, 8);
    for (int i = 0; i < MANY; i++)
      for (int c = 0; c < 3; c++) assert_true(ours[i][c] >= -32767);
  }
  meshopt_exponential((uint8_t *)shorts, MANY, 8);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_octahedral_bytes), cmocka_unit_test(test_octahedral_shorts),
      cmocka_unit_test(test_quaternions),      cmocka_unit_test(test_exponential),
      cmocka_unit_test(test_colors),           cmocka_unit_test(test_any_bytes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
