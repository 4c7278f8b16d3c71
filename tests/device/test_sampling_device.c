/* test_sampling_device.c: rng.h, sampling.h, frame.h and color.h give the same bits on a device as
 * on the host, where the unit tests hold them against their definitions. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "lib/color.h"
#include "lib/frame.h"
#include "lib/rng.h"
#include "lib/sampling.h"
#include "compare.h"
#include "harness.h"

COMPARE_SHARED(
    pick_pair, CDL_INLINE float pick_pair(uint key, uint sample, int second) {
      float u, v;
      rng_2d(key, sample, 7u, &u, &v);
      return second ? v : u;
    })

COMPARE_SHARED(
    pick_disk, CDL_INLINE float pick_disk(float u, float v, int second) {
      float x, y;
      sample_disk(u, v, &x, &y);
      return second ? y : x;
    })

COMPARE_SHARED(
    pick_triangle, CDL_INLINE float pick_triangle(float u, float v) {
      float b0, b1;
      sample_triangle(u, v, &b0, &b1);
      return b0 - b1;
    })

/* Numbers as rng.h makes them: where fma meets denormals, devices may differ. */
COMPARE_SHARED(
    pick_frame, CDL_INLINE Frame pick_frame(float u, float v) {
      return frame_from_normal(sample_sphere(rng_to_unit(as_uint(u)), rng_to_unit(as_uint(v))));
    })

COMPARE_SHARED(
    pick_tangent, CDL_INLINE Frame pick_tangent(float u, float v) {
      float s = rng_to_unit(as_uint(u));
      float t = rng_to_unit(as_uint(v));
      return frame_from_tangent(sample_sphere(s, t), sample_sphere(t, s));
    })

#define CASES(X)                                                                                   \
  X(rng_u, INFINITY, pick_pair(as_uint(a), as_uint(b), 0))                                         \
  X(rng_v, INFINITY, pick_pair(as_uint(a), as_uint(b), 1))                                         \
  X(pixel_key, INFINITY, rng_to_unit(rng_pixel_key(as_uint(a), as_uint(b), 5u)))                   \
  X(disk_x, 0.99999994f, pick_disk(math_abs(a), math_abs(b), 0))                                   \
  X(disk_y, 0.99999994f, pick_disk(math_abs(a), math_abs(b), 1))                                   \
  X(cosine_x, 0.99999994f, sample_cosine_hemisphere(math_abs(a), math_abs(b)).x)                   \
  X(cosine_z, 0.99999994f, sample_cosine_hemisphere(math_abs(a), math_abs(b)).z)                   \
  X(sphere_x, 0.99999994f, sample_sphere(math_abs(a), math_abs(b)).x)                              \
  X(sphere_z, 0.99999994f, sample_sphere(math_abs(a), math_abs(b)).z)                              \
  X(triangle, 0.99999994f, pick_triangle(math_abs(a), math_abs(b)))                                \
  X(mis_power, INFINITY, mis_power(math_abs(a), math_abs(b)))                                      \
  X(offset, 1e6f, offset_coordinate(a, math_clamp(b, -1.0f, 1.0f)))                                \
  X(frame_x, INFINITY, pick_frame(a, b).x.x)                                                       \
  X(frame_y, INFINITY, pick_frame(a, b).y.z)                                                       \
  X(tangent_x, INFINITY, pick_tangent(a, b).x.y)                                                   \
  X(tangent_y, INFINITY, pick_tangent(a, b).y.x)                                                   \
  X(luminance, 100.0f, color_luminance(v3(a, b, 0.5f)))                                            \
  X(srgb_decode, 2.0f, color_srgb_decode(a))                                                       \
  X(srgb_encode, 2.0f, color_srgb_encode(a))

CASES(COMPARE_HOST)

static const CompareCase cases[] = {CASES(COMPARE_ROW)};
static const char *const source[] = {"#include \"lib/color.h\"\n",
                                     "#include \"lib/frame.h\"\n",
                                     "#include \"lib/rng.h\"\n",
                                     "#include \"lib/sampling.h\"\n",
                                     pick_pair_text,
                                     pick_disk_text,
                                     pick_triangle_text,
                                     pick_frame_text,
                                     pick_tangent_text,
                                     CASES(COMPARE_KERNEL),
                                     NULL};

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
