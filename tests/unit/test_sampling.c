/* test_sampling.c: kernels/lib/sampling.h against closed forms and chi-squared tests. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "lib/sampling.h"
#include "lib/state.h"
#include "light/select.h"
#include "random.h"
#include "scene/alias.h"

enum { SAMPLES = 1000000, SIDE = 32, CELLS = SIDE * SIDE };

/* Number of chi-squared tests in this file; one-sided deviate for 1 - 0.99^(1/7), Sidak's bound.
 */
static const double LIMIT = 2.98;

static const double PI = 3.14159265358979323846;

typedef struct Histogram {
  double count[CELLS];
  double expected[CELLS];
} Histogram;

static void histogram_uniform(Histogram *h) {
  for (int i = 0; i < CELLS; i++) {
    h->count[i] = 0.0;
    h->expected[i] = (double)SAMPLES / CELLS;
  }
}

/* Counts (a, b) in the unit square; anything outside is an error. */
static void histogram_add(Histogram *h, double a, double b) {
  assert_true(a >= 0.0 && a <= 1.0 && b >= 0.0 && b <= 1.0);
  int i = a < 1.0 ? (int)(a * SIDE) : SIDE - 1;
  int j = b < 1.0 ? (int)(b * SIDE) : SIDE - 1;
  h->count[i * SIDE + j] += 1.0;
}

/* Pools cells until each expects 5; Wilson and Hilferty's normal deviate of the sum. */
static void histogram_check(const Histogram *h, const char *name) {
  double chi2 = 0.0, count = 0.0, expected = 0.0;
  int pools = 0;
  for (int i = 0; i < CELLS; i++) {
    count += h->count[i];
    expected += h->expected[i];
    if (expected < 5.0) continue;
    chi2 += (count - expected) * (count - expected) / expected;
    count = expected = 0.0;
    pools++;
  }
  assert_true(count == 0.0 || expected > 0.0);
  double spread = 2.0 / (9.0 * (pools - 1));
  double deviate = (cbrt(chi2 / (pools - 1)) - (1.0 - spread)) / sqrt(spread);
  print_message("  %-18s chi2 %+.2f sigma over %d cells\n", name, deviate, pools);
  assert_true(deviate < LIMIT);
}

static double turn_of(double y, double x) {
  double turn = atan2(y, x) / (2.0 * PI);
  return turn < 0.0 ? turn + 1.0 : turn;
}

static void disk_is_uniform(void **state) {
  (void)state;
  Histogram h;
  histogram_uniform(&h);
  random_start(1);
  for (int i = 0; i < SAMPLES; i++) {
    float u = random_unit(), v = random_unit(), x, y;
    sample_disk(u, v, &x, &y);
    double r2 = (double)x * x + (double)y * y;
    assert_true(r2 <= 1.0 + 1e-6);
    histogram_add(&h, fmin(r2, 1.0), turn_of(y, x));
  }
  histogram_check(&h, "disk");
}

/* Squares about the centre become circles, and the diagonal keeps its direction. */
static void disk_keeps_its_shape(void **state) {
  (void)state;
  static const float corner[4][2] = {
      {0.25f, 0.25f}, {0.75f, 0.25f}, {0.75f, 0.75f}, {0.25f, 0.75f}};
  for (int i = 0; i < 4; i++) {
    float x, y;
    sample_disk(corner[i][0], corner[i][1], &x, &y);
    double side = 0.5 * sqrt(0.5);
    assert_true(fabs((double)x - (corner[i][0] > 0.5f ? side : -side)) < 1e-7);
    assert_true(fabs((double)y - (corner[i][1] > 0.5f ? side : -side)) < 1e-7);
  }
  float x, y;
  sample_disk(0.5f, 0.5f, &x, &y);
  assert_true(x == 0.0f && y == 0.0f);
}

static void assert_unit(vec3 v) {
  double l2 = (double)v.x * v.x + (double)v.y * v.y + (double)v.z * v.z;
  assert_true(fabs(l2 - 1.0) < 1e-6);
}

/* The cosine density is uniform in (z^2, azimuth). */
static void cosine_hemisphere_matches_its_density(void **state) {
  (void)state;
  Histogram h;
  histogram_uniform(&h);
  random_start(2);
  double inverse = 0.0;
  for (int i = 0; i < SAMPLES; i++) {
    float u = random_unit(), v = random_unit();
    vec3 w = sample_cosine_hemisphere(u, v);
    assert_unit(w);
    assert_true(w.z > 0.0f);
    histogram_add(&h, fmin((double)w.z * w.z, 1.0), turn_of(w.y, w.x));
    inverse += (double)w.z / sample_cosine_hemisphere_pdf(w.z);
  }
  histogram_check(&h, "cosine hemisphere");
  assert_true(fabs(inverse / SAMPLES - PI) < 1e-5);
  assert_true(sample_cosine_hemisphere(0.0f, 0.5f).z > 0.0f);
  assert_true(sample_cosine_hemisphere_pdf(-0.5f) == 0.0f);
}

static void sphere_is_uniform(void **state) {
  (void)state;
  Histogram h;
  histogram_uniform(&h);
  random_start(3);
  for (int i = 0; i < SAMPLES; i++) {
    float u = random_unit(), v = random_unit();
    vec3 w = sample_sphere(u, v);
    assert_unit(w);
    histogram_add(&h, 0.5 + 0.5 * w.z, turn_of(w.y, w.x));
  }
  histogram_check(&h, "sphere");
}

/* Cells of a grid over (b0, b1): whole below the diagonal, halves on it. */
static void triangle_is_uniform(void **state) {
  (void)state;
  Histogram h;
  for (int i = 0; i < CELLS; i++) {
    int below = SIDE - 1 - i / SIDE - i % SIDE;
    h.count[i] = 0.0;
    h.expected[i] = SAMPLES * (below > 0 ? 2.0 : (below == 0 ? 1.0 : 0.0)) / CELLS;
  }
  random_start(5);
  for (int i = 0; i < SAMPLES; i++) {
    float u = random_unit(), v = random_unit(), b0, b1;
    sample_triangle(u, v, &b0, &b1);
    assert_true(b0 >= 0.0f && b1 >= 0.0f && 1.0f - b0 - b1 >= 0.0f);
    histogram_add(&h, b0, b1);
  }
  histogram_check(&h, "triangle");
}

enum { ENTRIES = 37 };

static uint random_bits(void) {
  return (uint)(random_unit() * 65536.0f) << 16 | (uint)(random_unit() * 65536.0f);
}

static void alias_tables_are_picked_from_by_weight(void **state) {
  (void)state;
  double weights[ENTRIES], total = 0.0;
  cdl_AliasEntry table[ENTRIES];
  for (int i = 0; i < ENTRIES; i++) total += weights[i] = i % 7 == 3 ? 0.0 : 1.0 + i * i % 11;
  assert_int_equal(alias_build(NULL, weights, ENTRIES, table), CDL_OK);
  static Histogram picks;
  for (int i = 0; i < CELLS; i++) {
    picks.count[i] = 0.0;
    picks.expected[i] = i < ENTRIES ? SAMPLES * weights[i] / total : 0.0;
  }
  random_start(6);
  for (int i = 0; i < SAMPLES; i++) {
    uint pick = alias_pick(table, ENTRIES, random_bits(), random_unit());
    assert_true(pick < ENTRIES && weights[pick] > 0.0);
    picks.count[pick] += 1.0;
  }
  histogram_check(&picks, "alias picks");
}

/* A million entries: one number of 24 bits would not be enough for slot and chance together. */
static void long_alias_tables_are_not_biased(void **state) {
  (void)state;
  enum { MANY = 1000003 };
  double *weights = malloc(MANY * sizeof *weights), heavy = 0.0, total = 0.0;
  cdl_AliasEntry *table = malloc(MANY * sizeof *table);
  for (int i = 0; i < MANY; i++) total += weights[i] = i % 2 ? 1000.0 : 1.0;
  for (int i = 1; i < MANY; i += 2) heavy += weights[i];
  assert_int_equal(alias_build(NULL, weights, MANY, table), CDL_OK);
  random_start(8);
  int picked = 0;
  for (int i = 0; i < SAMPLES; i++)
    picked += alias_pick(table, MANY, random_bits(), random_unit()) % 2;
  double p = heavy / total;
  assert_true(fabs(picked - p * SAMPLES) < 5.0 * sqrt(SAMPLES * p * (1.0 - p)) + 1.0);
  free(weights);
  free(table);
}

static void heuristic_weighs_to_one(void **state) {
  (void)state;
  random_start(7);
  for (int i = 0; i < 100000; i++) {
    float a = math_exp2(60.0f * random_signed()), b = math_exp2(60.0f * random_signed());
    assert_true(fabs((double)mis_power(a, b) + mis_power(b, a) - 1.0) < 2e-7);
    double exact = (double)a * a / ((double)a * a + (double)b * b);
    assert_true(fabs(mis_power(a, b) - exact) <= 1e-6 * exact + 1e-30);
  }
}

static void heuristic_keeps_its_limits(void **state) {
  (void)state;
  assert_true(mis_power(1.0f, 0.0f) == 1.0f && mis_power(0.0f, 1.0f) == 0.0f);
  assert_true(mis_power(0.0f, 0.0f) == 0.0f);
  assert_true(mis_power(INFINITY, 1.0f) == 1.0f && mis_power(1.0f, INFINITY) == 0.0f);
  assert_true(mis_power(INFINITY, INFINITY) == 0.5f && mis_power(INFINITY, 0.0f) == 1.0f);
  assert_true(mis_power(3e38f, 3e38f) == 0.5f && mis_power(1e-45f, 1e-45f) == 0.5f);
  assert_true(mis_power(1e30f, 1e-30f) == 1.0f);
  assert_true(mis_power_or_alone(0.0f, 1.0f) == 1.0f && mis_power_or_alone(0.0f, 0.0f) == 1.0f);
  assert_true(mis_power_or_alone(2.0f, 2.0f) == 0.5f);
}

/* What tells apart the events of a path, as far as 16 bits go. */
static void passes_are_counted_apart(void **state) {
  (void)state;
  uint counts = 0u;
  for (uint i = 1; i <= 4095u; i++) counts = counts_passed(counts_scattered(counts));
  assert_int_equal(counts_depth(counts), 4095);
  assert_int_equal(counts_vertex(counts), 8190);
  assert_int_equal(counts_passes(counts), 4095);
}

static vec3 random_corner(vec3 centre, float size) {
  float x = random_signed(), y = random_signed(), z = random_signed();
  return v3_madd(centre, size, v3(x, y, z));
}

/* Signed distance in double from the plane of the float triangle. */
static double plane_distance(vec3 p, vec3 corner, vec3 n) {
  return ((double)p.x - corner.x) * n.x + ((double)p.y - corner.y) * n.y +
         ((double)p.z - corner.z) * n.z;
}

/* Points interpolated on triangles of many sizes and places leave their plane, to the right side
 * and not far. */
static void offset_points_leave_their_surface(void **state) {
  (void)state;
  random_start(8);
  for (int i = 0; i < SAMPLES; i++) {
    float scale = math_exp2(8.0f * random_signed());
    vec3 centre = v3_scale(random_normal(), scale);
    float size = 0.25f * scale;
    vec3 a = random_corner(centre, size), b = random_corner(centre, size);
    vec3 c = random_corner(centre, size);
    vec3 n = v3_normalize(v3_cross(v3_sub(b, a), v3_sub(c, a)));
    float u = random_unit(), v = random_unit(), b0, b1;
    sample_triangle(u, v, &b0, &b1);
    vec3 p = v3_madd(v3_madd(v3_scale(a, b0), b1, b), 1.0f - b0 - b1, c);
    double up = plane_distance(offset_ray(p, n), a, n);
    double down = plane_distance(offset_ray(p, v3_neg(n)), a, n);
    double far = 1.6e-4 * scale + 3e-5;
    assert_true(up > 0.0 && up < far && down < 0.0 && down > -far);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(disk_is_uniform),
      cmocka_unit_test(disk_keeps_its_shape),
      cmocka_unit_test(cosine_hemisphere_matches_its_density),
      cmocka_unit_test(sphere_is_uniform),
      cmocka_unit_test(triangle_is_uniform),
      cmocka_unit_test(alias_tables_are_picked_from_by_weight),
      cmocka_unit_test(long_alias_tables_are_not_biased),
      cmocka_unit_test(heuristic_weighs_to_one),
      cmocka_unit_test(heuristic_keeps_its_limits),
      cmocka_unit_test(passes_are_counted_apart),
      cmocka_unit_test(offset_points_leave_their_surface),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
