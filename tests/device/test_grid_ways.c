/* test_grid_ways.c: the way of rays through sparse grids, against dense fields in double precision.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/device/grid_device.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { RAYS = 4096, STRETCHES = 64 };

static const uint32_t sizes[][3] = {{1, 1, 1},    {1, 9, 17}, {8, 8, 8},    {9, 9, 9},
                                    {33, 20, 70}, {7, 64, 3}, {100, 40, 12}};

static double between(uint32_t *state, double low, double high) {
  return low + (high - low) * field_random(state);
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
  Field field = field_make(kind, size, 1, 1, 5),
        heat = field_make(kind == FIELD_RARE ? kind : FIELD_SPARSE, size, 1, 1, 6);
  set.medium.density = grid_set_add(&set, &field);
  set.medium.temperature = grid_set_add(&set, &heat);
  if (raw) memset(set.medium.to_grid, 0, sizeof set.medium.to_grid);
  for (int k = 0; k < 3 && raw; k++) set.medium.to_grid[5 * k] = 1;
  for (int k = 0; k < 12; k++) set.medium.to_grid[k] *= k % 4 == 3 ? 1 : world;
  for (int i = 0; i < RAYS; i++) {
    rays[i] = grid_random_ray(&state, &set, raw);
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
  check_ways((uint32_t[]){100, 70, 66}, FIELD_RARE, 1, 0, 1);
  check_ways((uint32_t[]){100, 70, 66}, FIELD_RARE, 0, 1.7, 1);
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
  for (int i = 0; i < RAYS; i++) rays[i] = grid_random_ray(&seed, &set, 0);
  grid_run("grid_walk", RAYS, &set, (HarnessBuffer){rays, sizeof rays},
           (HarnessBuffer){in, sizeof in}, (HarnessBuffer){out, sizeof out});
  for (size_t i = 0; i < RAYS; i++) assert_true(out[i] >= 0 && out[i] <= 8 + 2 + 5);
  free(field.values);
  grid_set_free(&set);
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ways),
      cmocka_unit_test(test_empty_space),
  };
  return cmocka_run_group_tests(tests, grid_device_open, grid_device_close);
}
