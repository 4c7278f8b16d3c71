/* test_grid_hostile.c: flights and shadow rays that no sound scene asks for. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/device/grid_device.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { RAYS = 4096, STRETCHES = 64 };

/* Rays that no scene should have. */
static void spoil(FieldRay *ray, int kind) {
  static const float bad[] = {0, INFINITY, -INFINITY, NAN, 3e38f, -3e38f, 1e-45f};
  for (int k = 0; k < 3; k++) {
    if (kind & 1) ray->origin[k] = bad[(kind / 4 + k) % 7];
    if (kind & 2) ray->direction[k] = bad[(kind / 4 + 2 * k) % 7];
  }
  if (kind % 5 == 0) ray->to = INFINITY;
  if (kind % 11 == 0) ray->from = INFINITY;
}

static void run_hostile(GridSet *set, FieldRay *rays) {
  static float out[(1 + 4 * STRETCHES) * RAYS];
  float one = 1;
  uint32_t in[5] = {STRETCHES, 3}, bits;
  HarnessBuffer points = {rays, RAYS * sizeof *rays}, words = {in, sizeof in};
  HarnessBuffer results = {out, sizeof out};
  grid_run("grid_walk", RAYS, set, points, words, results);
  for (size_t i = 0; i < RAYS; i++) assert_true(out[i] >= 0);
  memcpy(&bits, &one, 4);
  in[0] = RAYS, in[2] = in[3] = in[4] = bits;
  grid_run("grid_shadow", RAYS, set, points, words, results);
  for (size_t i = 0; i < 3 * RAYS; i++) assert_true(out[i] >= 0 && out[i] < 1e3f);
  grid_run("grid_flight", RAYS, set, points, words, results);
  for (size_t i = 2 * RAYS; i < 5 * RAYS; i++) assert_true(out[i] >= 0 && out[i] < 1e3f);
  for (size_t i = 5 * RAYS; i < 8 * RAYS; i++)
    if (!(out[i] >= 0)) fail_msg("glow %g", out[i]);
}

/* Nothing hangs, nor is anything read outside of the arrays. */
static void test_hostile(void **state) {
  (void)state;
  static FieldRay rays[RAYS];
  static const uint32_t size[3] = {33, 20, 70};
  static const float scales[] = {0, 1, 1e-45f, 1e38f, INFINITY, NAN};
  Field field = field_make(FIELD_NOISE, size, 1, 1, 5),
        heat = field_make(FIELD_CHECKER, size, 1, 1, 6);
  for (size_t n = 0; n < 2 * COUNT(scales); n++) {
    GridSet set = grid_set_make(size, 0.4);
    uint32_t seed = 9;
    set.medium.density = grid_set_add(&set, &field);
    if (n % 2) set.medium.temperature = grid_set_add(&set, &heat);
    set.medium.emissive = 1;
    for (int k = 0; k < 3; k++) set.medium.emission[k] = set.medium.scattering[k] = 1;
    for (int k = 0; k < 12; k++) set.medium.to_grid[k] *= scales[n / 2];
    for (int i = 0; i < RAYS; i++) {
      rays[i] = grid_random_ray(&seed, &set, 0);
      if (i % 8) spoil(&rays[i], i / 8);
    }
    run_hostile(&set, rays);
    grid_set_free(&set);
  }
  free(field.values);
  free(heat.values);
}

/* Media so dense that the distance between collisions is lost in the rounding of t. */
static void test_dense(void **state) {
  (void)state;
  static FieldRay rays[RAYS];
  static const uint32_t size[3] = {20, 20, 20};
  static const float peaks[] = {1e-43f, 1e-38f, 1e4f, 1e9f, 1e30f, 3e38f};
  alarm(60);
  for (size_t n = 0; n < 2 * COUNT(peaks); n++) {
    GridSet set = grid_set_make(size, 0);
    Field field = field_make(FIELD_EMPTY, size, 1, 1, 5);
    uint32_t seed = 9;
    field.values[10 + 20 * (10 + 20 * 10)] = peaks[n / 2];
    set.medium.density = grid_set_add(&set, &field);
    for (int k = 0; k < 3; k++) set.medium.scattering[k] = n % 2 ? 1 : 1e5f;
    for (int i = 0; i < RAYS; i++) {
      rays[i] = grid_random_ray(&seed, &set, 0);
      for (int k = 0; k < 3; k++) rays[i].origin[k] -= 100 * rays[i].direction[k];
    }
    run_hostile(&set, rays);
    free(field.values);
    grid_set_free(&set);
  }
  alarm(0);
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_hostile),
      cmocka_unit_test(test_dense),
  };
  return cmocka_run_group_tests(tests, grid_device_open, grid_device_close);
}
