/* test_frame.c: kernels/lib/frame.h and color.h against their definitions in double. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "lib/color.h"
#include "lib/frame.h"
#include "random.h"

enum { SAMPLES = 1000000 };

static double dot(vec3 a, vec3 b) {
  return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

/* Orthonormal to 1e-6 and right-handed. */
static void check_frame(Frame f) {
  assert_true(fabs(dot(f.x, f.x) - 1.0) < 1e-6 && fabs(dot(f.y, f.y) - 1.0) < 1e-6);
  assert_true(fabs(dot(f.x, f.y)) < 1e-6 && fabs(dot(f.x, f.z)) < 1e-6);
  assert_true(fabs(dot(f.y, f.z)) < 1e-6);
  assert_true(fabs(dot(v3_cross(f.x, f.y), f.z) - 1.0) < 1e-6);
}

static void check_round_trip(Frame f, vec3 v) {
  vec3 back = v3_sub(frame_to_world(f, frame_to_local(f, v)), v);
  assert_true(fabs(dot(back, back)) < 1e-12);
  vec3 up = v3_sub(frame_to_local(f, f.z), v3(0.0f, 0.0f, 1.0f));
  assert_true(fabs(dot(up, up)) < 1e-12);
}

static void frames_of_normals_are_orthonormal(void **state) {
  (void)state;
  random_start(9);
  for (int i = 0; i < SAMPLES; i++) {
    vec3 n = random_normal();
    Frame f = frame_from_normal(n);
    check_frame(f);
    check_round_trip(f, random_normal());
  }
  for (int i = 0; i < 6; i++) {
    float s = i & 1 ? -1.0f : 1.0f;
    vec3 axis = v3(i / 2 == 0 ? s : 0.0f, i / 2 == 1 ? s : 0.0f, i / 2 == 2 ? s : 0.0f);
    check_frame(frame_from_normal(axis));
  }
  check_frame(frame_from_normal(v3(1e-20f, -1e-30f, -1.0f)));
  check_frame(frame_from_normal(v3(1.0f, 0.0f, -0.0f)));
}

static void frames_follow_their_tangent(void **state) {
  (void)state;
  random_start(10);
  for (int i = 0; i < SAMPLES; i++) {
    vec3 n = random_normal(), t = random_normal();
    Frame f = frame_from_tangent(n, v3_scale(t, math_exp2(60.0f * random_signed())));
    check_frame(f);
    /* x has no part across the plane of n and t, and points to t's side */
    double sine2 = 1.0 - dot(n, t) * dot(n, t);
    if (sine2 < 1e-4) continue;
    assert_true(dot(f.x, t) > 0.0 && fabs(dot(f.y, t)) < 1e-6);
  }
}

/* Tangents ever nearer to the normal, and none at all: still a frame. */
static void frames_survive_bad_tangents(void **state) {
  (void)state;
  random_start(11);
  for (int i = 0; i < SAMPLES / 10; i++) {
    vec3 n = random_normal();
    vec3 t = v3_madd(n, math_exp2(-40.0f * random_unit()), random_normal());
    check_frame(frame_from_tangent(n, i & 1 ? t : v3_neg(t)));
    check_frame(frame_from_tangent(n, v3_all(0.0f)));
    check_frame(frame_from_tangent(n, n));
  }
}

static double exact_decode(double x) {
  return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static void srgb_matches_the_standard(void **state) {
  (void)state;
  for (int i = 0; i <= 65535; i++) {
    float x = (float)i / 65535.0f;
    double linear = exact_decode((double)x);
    assert_true(fabs(color_srgb_decode(x) - linear) <= 1e-6 * linear);
    assert_true(fabs((double)color_srgb_encode((float)linear) - x) < 3e-7);
  }
  /* every 8-bit code survives the way there and back */
  for (int i = 0; i <= 255; i++)
    assert_int_equal((int)(255.0f * color_srgb_encode(color_srgb_decode((float)i / 255.0f)) + 0.5f),
                     i);
  assert_true(color_srgb_decode(1.0f) == 1.0f && color_srgb_encode(0.0f) == 0.0f);
}

static void luminance_weighs_to_one(void **state) {
  (void)state;
  assert_true(fabs((double)color_luminance(v3_all(1.0f)) - 1.0) < 1e-7);
  assert_true(color_luminance(v3(0.0f, 1.0f, 0.0f)) == 0.7152f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_of_normals_are_orthonormal),
      cmocka_unit_test(frames_follow_their_tangent),
      cmocka_unit_test(frames_survive_bad_tangents),
      cmocka_unit_test(srgb_matches_the_standard),
      cmocka_unit_test(luminance_weighs_to_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
