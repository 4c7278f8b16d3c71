/* test_grids.c: values of sparse grids against dense fields in double precision, and flights
 * through them with the same bits on the host. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "media/tracking.h"
#include "tests/device/grid_device.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const uint32_t sizes[][3] = {{1, 1, 1},    {1, 9, 17}, {8, 8, 8},    {9, 9, 9},
                                    {33, 20, 70}, {7, 64, 3}, {100, 40, 12}};

static double between(uint32_t *state, double low, double high) {
  return low + (high - low) * field_random(state);
}

/* ---- values ---- */

enum { POINTS = 16384 };

/* In the box, on its faces, at centres, and close to where bricks meet. */
static float point_axis(uint32_t *state, uint32_t size) {
  double r = between(state, -0.5, size - 0.5), kind = field_random(state);
  if (kind < 0.2) r = rint(r);
  if (kind < 0.05) r = 8 * rint(r / 8);
  if (kind > 0.85) r = nextafterf(8 * (float)rint(r / 8), field_random(state) < 0.5 ? -1e9f : 1e9f);
  if (kind > 0.95) r = field_random(state) < 0.5 ? -0.5 : size - 0.5;
  return (float)fmin(fmax(r, -0.5), size - 0.5);
}

static void check_values(const GridSet *set, uint32_t number, const Field *field) {
  static float points[3 * POINTS], out[2 * POINTS];
  uint32_t state = 11 + number;
  for (size_t i = 0; i < POINTS; i++)
    for (size_t k = 0; k < 3; k++) points[k * POINTS + i] = point_axis(&state, field->size[k]);
  for (uint32_t c = 0; c < field->channels; c++) {
    uint32_t in[2] = {number, c};
    grid_run("grid_look", POINTS, set, (HarnessBuffer){points, sizeof points},
             (HarnessBuffer){in, sizeof in}, (HarnessBuffer){out, sizeof out});
    for (size_t i = 0; i < POINTS; i++) {
      double r[3] = {points[i], points[POINTS + i], points[2 * POINTS + i]};
      double truth = field_value(field, c, r);
      if (fabs(out[i] - truth) > 1e-6 || fabs(out[POINTS + i] - truth) > 1e-6)
        fail_msg("%u x %u x %u, channel %u at (%g, %g, %g): %g and %g, not %g", field->size[0],
                 field->size[1], field->size[2], c, r[0], r[1], r[2], out[i], out[POINTS + i],
                 truth);
    }
  }
}

static void test_values(void **state) {
  (void)state;
  for (size_t i = 0; i < COUNT(sizes); i++) {
    GridSet set = grid_set_make(sizes[i], 0);
    for (uint32_t kind = FIELD_CHECKER; kind <= FIELD_NOISE; kind++) {
      Field field = field_make(kind, sizes[i], kind == FIELD_SPARSE ? 3 : 1, 1, kind + 1);
      check_values(&set, grid_set_add(&set, &field), &field);
      free(field.values);
    }
    grid_set_free(&set);
  }
}

/* ---- the same everywhere ---- */

enum { SAME = 4096 };

/* What the device does, by the host's compiler. */
static GridFlight host_flight(const GridSet *set, const FieldRay *ray, uint32_t i, uint32_t seed) {
  RandomStream stream = random_stream(seed, i, 3u, CDL_STREAM_FLIGHT);
  const float *o = ray->origin, *d = ray->direction;
  return grid_fly(&set->medium, v3(o[0], o[1], o[2]), v3(d[0], d[1], d[2]), ray->from, ray->to,
                  v3(1, 0.5f, 0.25f), rng_to_unit(rng_hash2(i, seed)), &stream, set->blackbody,
                  set->grids, set->table, set->most, set->values);
}

static void check_same(const GridSet *set, FieldRay *rays, uint32_t count, const float *out) {
  for (uint32_t i = 0; i < SAME; i++) {
    GridFlight f = host_flight(set, &rays[i % SAME], i, 21);
    float rows[] = {
        f.t,      (float)f.scattered, f.throughput.x, f.throughput.y,          f.throughput.z,
        f.glow.x, f.glow.y,           f.glow.z,       (float)(f.real + f.null)};
    for (uint32_t k = 0; k < COUNT(rows); k++)
      if (memcmp(&rows[k], &out[k * count + i], 4) != 0)
        fail_msg("flight %u, number %u: %.9g, %.9g on the host", i, k, out[k * count + i], rows[k]);
  }
}

/* The host's bits, in work-groups of 64 and of what the device likes. */
static void test_determinism(void **state) {
  (void)state;
  static const uint32_t size[3] = {33, 20, 70};
  static float out[9 * (SAME + 1)];
  static FieldRay rays[SAME];
  const float throughput[3] = {1, 0.5f, 0.25f};
  uint32_t in[5] = {SAME, 21}, seed = 2;
  GridSet set = grid_set_make(size, 0.4);
  Field field = field_make(FIELD_SPARSE, size, 1, 1, 5),
        heat = field_make(FIELD_NOISE, size, 1, 1, 6);
  Field color = field_make(FIELD_NOISE, size, 3, 1, 7);
  memcpy(in + 2, throughput, sizeof throughput);
  set.medium.density = grid_set_add(&set, &field);
  set.medium.temperature = grid_set_add(&set, &heat);
  set.medium.color = grid_set_add(&set, &color);
  set.medium.emissive = 1, set.medium.temperature_scale = 4000;
  for (int k = 0; k < 3; k++) {
    set.medium.emission[k] = 1, set.medium.absorption[k] = (float)k;
    set.medium.scattering[k] = 40 - 9 * (float)k;
  }
  for (uint32_t i = 0; i < 3 * CDL_BLACKBODY_COUNT; i++) set.blackbody[i] = sqrtf((float)i);
  for (int i = 0; i < SAME; i++) rays[i] = grid_random_ray(&seed, &set, 0);
  for (uint32_t count = SAME; count <= SAME + 1; count++) {
    grid_run("grid_flight", count, &set, (HarnessBuffer){rays, sizeof rays},
             (HarnessBuffer){in, sizeof in}, (HarnessBuffer){out, count * 9 * sizeof *out});
    check_same(&set, rays, count, out);
  }
  free(field.values);
  free(heat.values);
  free(color.values);
  grid_set_free(&set);
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_values),
      cmocka_unit_test(test_determinism),
  };
  return cmocka_run_group_tests(tests, grid_device_open, grid_device_close);
}
