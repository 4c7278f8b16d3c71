/* test_grids.c: values of sparse grids and the way of rays through them, against dense fields in
 * double precision; hostile input; the same bits on the host. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

/* ---- the way of rays ---- */

enum { RAYS = 4096, STRETCHES = 64 };

static const float specials[] = {0, 0, 0, 1e-41f, -1e-39f, -1e-38f, 1e-30f, -1e-20f, 1, -1};

/* By kind: anything, along axes and nearly so, from planes of bricks, of far-off lengths. */
static FieldRay random_ray(uint32_t *state, const GridSet *set, int raw) {
  FieldRay ray = {.from = 0, .to = INFINITY};
  const uint32_t *size = set->grids[0].size;
  int kind = (int)(4 * field_random(state));
  double scale = kind == 3 ? exp2(between(state, -90, 90)) : 1;
  for (int k = 0; k < 3; k++) {
    double at =
        raw ? between(state, -0.5 * size[k] - 2, 1.5 * size[k] + 2) : between(state, -1.2, 1.2);
    if (raw && field_random(state) < 0.4) at = 8 * rint(at / 8);
    if (raw && field_random(state) < 0.1) at = field_random(state) < 0.5 ? -0.5 : size[k] - 0.5;
    double d = between(state, -1, 1);
    if (kind == 1) d = specials[(int)(COUNT(specials) * field_random(state))];
    if (kind == 2 && field_random(state) < 0.5) d = rint(d);
    ray.origin[k] = (float)at;
    ray.direction[k] = (float)(d * scale);
  }
  double near = between(state, 0, 1) * (raw ? size[0] : 1) / scale;
  if (field_random(state) < 0.3) ray.from = (float)near;
  if (field_random(state) < 0.3) ray.to = (float)(ray.from + near);
  return ray;
}

typedef struct Way {
  const GridSet *set;
  const Field *field, *heat;
  const FieldRay *ray;
  double origin[3], direction[3];
  double blur; /* voxels that rounding may shift the ray by */
  int count;
  float stretches[STRETCHES][4];
} Way;

static void place_way(Way *way) {
  double first = way->ray->from, last = way->ray->to, at = 0, along = 0;
  field_place(&way->set->medium, way->ray, way->origin, way->direction);
  for (int r = 0; r < 3; r++) {
    const float *m = way->set->medium.to_grid + 4 * r;
    double row = fabs(m[3]), turn = 0;
    for (int k = 0; k < 3; k++) {
      row += fabs((double)m[k] * way->ray->origin[k]);
      turn += fabs((double)m[k] * way->ray->direction[k]);
    }
    /* what devices may take for 0 is 0 */
    if (fabs(way->direction[r]) < 1.2e-38) way->direction[r] = 0;
    at = fmax(at, row + way->field->size[r]);
    along = fmax(along, turn);
  }
  field_clip(way->field->size, way->origin, way->direction, 0.01, &first, &last);
  way->blur = 1e-6 * (at + (last > first && isfinite(last) ? last * along : 0));
}

#define FAIL_WAY(text, ...)                                                                        \
  fail_msg(                                                                                        \
      "%u x %u x %u, from (%.9g, %.9g, %.9g) along (%.9g, %.9g, %.9g), %.9g to %.9g m: " text,     \
      way->field->size[0], way->field->size[1], way->field->size[2], way->ray->origin[0],          \
      way->ray->origin[1], way->ray->origin[2], way->ray->direction[0], way->ray->direction[1],    \
      way->ray->direction[2], way->ray->from, way->ray->to, __VA_ARGS__)

static void check_reach(const Way *way) {
  double inner[2] = {way->ray->from, way->ray->to}, outer[2] = {way->ray->from, way->ray->to};
  field_clip(way->field->size, way->origin, way->direction, -way->blur, &inner[0], &inner[1]);
  field_clip(way->field->size, way->origin, way->direction, way->blur, &outer[0], &outer[1]);
  if (outer[1] > 3e38 && isinf(way->ray->to)) return; /* no float says where it ends */
  double slack = 1e-6 * fabs(inner[1]);
  if (!way->count) {
    if (inner[1] > inner[0] + slack) FAIL_WAY("misses %g to %g", inner[0], inner[1]);
    return;
  }
  double first = (double)way->stretches[0][0], last = way->stretches[way->count - 1][1];
  if (inner[1] > inner[0] && (first > inner[0] + slack || last < inner[1] - slack))
    FAIL_WAY("covers %g to %g, not %g to %g", first, last, inner[0], inner[1]);
  slack = 1e-6 * fabs(outer[1]);
  if (first < outer[0] - slack || last > outer[1] + slack)
    FAIL_WAY("covers %g to %g, beyond %g to %g", first, last, outer[0], outer[1]);
}

static void check_bounds(const Way *way, const float *stretch, uint32_t *state) {
  for (int n = 0; n < 6; n++) {
    double t = n < 2 ? stretch[n] : between(state, stretch[0], stretch[1]), r[3];
    for (int k = 0; k < 3; k++) r[k] = way->origin[k] + t * way->direction[k];
    double blur = 1e-6 + 3 * way->blur;
    double density = field_value(way->field, 0, r), heat = field_value(way->heat, 0, r);
    if (!(density <= stretch[2] + blur) || !(heat <= stretch[3] + blur))
      FAIL_WAY("at %g: %g and %g, at most %g and %g", t, density, heat, stretch[2], stretch[3]);
  }
}

static void check_way(Way *way, uint32_t *state) {
  uint32_t limit = 1;
  for (int k = 0; k < 3; k++) limit += way->set->grids[0].bricks[k] + way->set->grids[0].blocks[k];
  place_way(way);
  if (way->count < 0 || way->count > (int)limit) FAIL_WAY("%d steps", way->count);
  for (int i = 0; i < way->count; i++) {
    const float *s = way->stretches[i];
    if (!(s[1] >= s[0]) || (i && s[0] != s[-3])) FAIL_WAY("stretch %d: %g to %g", i, s[0], s[1]);
    if (!(s[2] >= 0) || !(s[3] >= 0)) FAIL_WAY("at most %g and %g", s[2], s[3]);
    if (isfinite(s[1])) check_bounds(way, s, state);
  }
  check_reach(way);
}

/* Rays of the kinds above through a density and a temperature. */
static void check_ways(const uint32_t size[3], FieldKind kind, int raw, double turn, float world) {
  static float out[(1 + 4 * STRETCHES) * RAYS];
  static FieldRay rays[RAYS];
  uint32_t in[1] = {STRETCHES}, state = (uint32_t)kind * 77 + size[1];
  GridSet set = grid_set_make(size, turn);
  Field field = field_make(kind, size, 1, 1, 5), heat = field_make(FIELD_SPARSE, size, 1, 1, 6);
  set.medium.density = grid_set_add(&set, &field);
  set.medium.temperature = grid_set_add(&set, &heat);
  if (raw) memset(set.medium.to_grid, 0, sizeof set.medium.to_grid);
  for (int k = 0; k < 3 && raw; k++) set.medium.to_grid[5 * k] = 1;
  for (int k = 0; k < 12; k++) set.medium.to_grid[k] *= k % 4 == 3 ? 1 : world;
  for (int i = 0; i < RAYS; i++) {
    rays[i] = random_ray(&state, &set, raw);
    for (int k = 0; k < 3; k++) rays[i].origin[k] /= world, rays[i].direction[k] /= world;
  }
  grid_run("grid_walk", RAYS, &set, (HarnessBuffer){rays, sizeof rays},
           (HarnessBuffer){in, sizeof in}, (HarnessBuffer){out, sizeof out});
  for (size_t i = 0; i < RAYS; i++) {
    Way way = {&set, &field, &heat, &rays[i], {0}, {0}, 0, (int)out[i], {{0}}};
    for (size_t k = 0; k < 4 * STRETCHES && (int)k < 4 * way.count; k++)
      way.stretches[k / 4][k % 4] = out[(1 + k) * RAYS + i];
    check_way(&way, &state);
  }
  free(field.values);
  free(heat.values);
  grid_set_free(&set);
}

static void test_ways(void **state) {
  (void)state;
  for (size_t i = 0; i < COUNT(sizes); i++) {
    check_ways(sizes[i], FIELD_CHECKER, 1, 0, 1);
    check_ways(sizes[i], FIELD_SPARSE, 0, 0.7, 1);
    check_ways(sizes[i], FIELD_NOISE, 0, 2.2, i % 2 ? 1e-12f : 1e12f);
  }
}

/* Empty space is passed in blocks. */
static void test_empty_space(void **state) {
  (void)state;
  static float out[(1 + 4 * STRETCHES) * RAYS];
  static FieldRay rays[RAYS];
  static const uint32_t size[3] = {256, 64, 130};
  uint32_t in[1] = {STRETCHES}, seed = 4;
  GridSet set = grid_set_make(size, 0.3);
  Field field = field_make(FIELD_EMPTY, size, 1, 1, 5);
  set.medium.density = grid_set_add(&set, &field);
  for (int i = 0; i < RAYS; i++) rays[i] = random_ray(&seed, &set, 0);
  grid_run("grid_walk", RAYS, &set, (HarnessBuffer){rays, sizeof rays},
           (HarnessBuffer){in, sizeof in}, (HarnessBuffer){out, sizeof out});
  for (size_t i = 0; i < RAYS; i++) assert_true(out[i] >= 0 && out[i] <= 8 + 2 + 5);
  free(field.values);
  grid_set_free(&set);
}

/* ---- hostile input ---- */

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
      rays[i] = random_ray(&seed, &set, 0);
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
      rays[i] = random_ray(&seed, &set, 0);
      for (int k = 0; k < 3; k++) rays[i].origin[k] -= 100 * rays[i].direction[k];
    }
    run_hostile(&set, rays);
    free(field.values);
    grid_set_free(&set);
  }
  alarm(0);
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
  for (int i = 0; i < SAME; i++) rays[i] = random_ray(&seed, &set, 0);
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

static int open_device(void **state) {
  (void)state;
  grid_device_open();
  return 0;
}

static int close_device(void **state) {
  (void)state;
  grid_device_close();
  return 0;
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_values),      cmocka_unit_test(test_ways),
      cmocka_unit_test(test_empty_space), cmocka_unit_test(test_hostile),
      cmocka_unit_test(test_dense),       cmocka_unit_test(test_determinism),
  };
  return cmocka_run_group_tests(tests, open_device, close_device);
}
