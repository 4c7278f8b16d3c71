/* bvh_cases.h: the tests of test_bvh.c and test_bvh8.c, which differ by CDL_BVH_WIDTH alone. The
 * kernels' headers run on the host here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include <omp.h>

#include "bvh/bvh.h"
#include "bvh/traverse.h"
#include "bvh_exact.h"
#include "bvh_shapes.h"

static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* A tree over one shape, placed once and not moved. */
static cdl_Bvh build_shape(const Shape *shape, int bins, int leaf_max) {
  cdl_BvhPart part = {shape->positions, shape->indices, shape->triangles, 0, 0, 0};
  cdl_BvhMesh mesh = {&part, 1};
  cdl_BvhPlacement placement = {.mask = CDL_MASK_ALL};
  cdl_BvhOptions options = {CDL_BVH_WIDTH, bins, leaf_max};
  cdl_Bvh bvh;
  memcpy(placement.to_world, identity, sizeof identity);
  assert_int_equal(bvh_build(NULL, &mesh, 1, &placement, 1, &options, &bvh), CDL_OK);
  return bvh;
}

static Hit closest(const cdl_Bvh *bvh, vec3 o, vec3 d, float tmax) {
  return bvh_closest(bvh->nodes, bvh->triangles, bvh->instances, bvh->root, o, d, tmax,
                     CDL_MASK_ALL);
}

static int occluded(const cdl_Bvh *bvh, vec3 o, vec3 d, float tmax) {
  return bvh_occluded(bvh->nodes, bvh->triangles, bvh->instances, bvh->root, o, d, tmax,
                      CDL_MASK_ALL);
}

static vec3 random_point(Random *random, float size) {
  float x = random_signed(random), y = random_signed(random), z = random_signed(random);
  return v3(size * x, size * y, size * z);
}

static void assert_same_hit(Hit a, Hit b) { assert_memory_equal(&a, &b, sizeof a); }

static void test_soup_against_double(void **state) {
  (void)state;
  Random random = {1};
  Shape shape = shape_soup(700, 0.4f, 2);
  cdl_Bvh bvh = build_shape(&shape, 0, 0);
  int checked = 0, hits = 0;
  for (int i = 0; i < 3000; i++) {
    vec3 o = random_point(&random, 2.0f), d = random_point(&random, 1.0f);
    Exact exact = exact_none();
    exact_shape(&shape, identity, 0, o, d, &exact);
    if (!is_beyond_doubt(&exact)) continue;
    Hit hit = closest(&bvh, o, d, INFINITY);
    assert_int_equal(hit.primitive, exact.primitive);
    checked++;
    if (!hit_is_some(hit)) continue;
    hits++;
    assert_true(fabs(hit.t - exact.t) <= 2e-5 * exact.t + 1e-5);
  }
  assert_true(checked > 2000 && hits > 500);
  bvh_free(&bvh);
  shape_free(&shape);
}

static void test_hit_point_lies_where_barycentrics_say(void **state) {
  (void)state;
  Random random = {5};
  Shape shape = shape_soup(300, 0.6f, 6);
  cdl_Bvh bvh = build_shape(&shape, 0, 0);
  for (int i = 0; i < 2000; i++) {
    vec3 o = random_point(&random, 2.0f), d = random_point(&random, 1.0f);
    Hit h = closest(&bvh, o, d, INFINITY);
    if (!hit_is_some(h)) continue;
    const float *p[3], ray[3] = {o.x + h.t * d.x, o.y + h.t * d.y, o.z + h.t * d.z};
    for (int k = 0; k < 3; k++)
      p[k] = shape.positions + 3 * (size_t)shape.indices[3 * h.primitive + (uint32_t)k];
    assert_true(h.u >= 0.0f && h.v >= 0.0f && h.u + h.v <= 1.0f + 1e-6f);
    for (int k = 0; k < 3; k++) {
      float x = (1.0f - h.u - h.v) * p[0][k] + h.u * p[1][k] + h.v * p[2][k];
      assert_true(fabsf(x - ray[k]) < 1e-4f);
    }
  }
  bvh_free(&bvh);
  shape_free(&shape);
}

/* Rays of all kinds against one shape: random ones and ones through vertices and along axes. */
static void awkward_ray(const Shape *shape, Random *random, int i, vec3 *o, vec3 *d) {
  *o = random_point(random, 2.0f);
  *d = random_point(random, 1.0f);
  const float *p = shape->positions + 3 * (size_t)(random_next(random) % shape->vertices);
  if (i % 4 == 1) *d = v3_sub(v3(p[0], p[1], p[2]), *o);
  if (i % 4 == 2) {
    *d = v3(i % 3 == 0 ? 1.0f : 0.0f, i % 3 == 1 ? -1.0f : 0.0f, i % 3 == 2 ? 1.0f : -0.0f);
    *o = i % 8 == 2 ? v3(p[0] - 9.0f * d->x, p[1] - 9.0f * d->y, p[2] - 9.0f * d->z) : *o;
  }
}

static void check_same_answers(const Shape *shape, const cdl_Bvh *a, const cdl_Bvh *b) {
  Random random = {77};
  for (int i = 0; i < 20000; i++) {
    vec3 o, d;
    awkward_ray(shape, &random, i, &o, &d);
    float tmax = i % 5 == 0 ? 1.0f : INFINITY;
    Hit hit = closest(a, o, d, tmax);
    assert_same_hit(hit, closest(b, o, d, tmax));
    assert_int_equal(occluded(a, o, d, tmax), hit_is_some(hit));
    assert_int_equal(occluded(b, o, d, tmax), hit_is_some(hit));
  }
}

/* Every way to build the tree, down to leaves of one triangle and halves of anything, gives the
 * same bits. The grid has many coplanar triangles and shared edges. */
static void test_answers_do_not_depend_on_the_tree(void **state) {
  (void)state;
  Shape shapes[4] = {shape_soup(3000, 0.3f, 9), shape_sphere(3, v3_all(0.0f), 1.0f),
                     shape_box(6, v3_all(0.25f), v3(1.0f, 1.0f, 1.0f)), shape_slivers(500, 3)};
  static const int variants[4][2] = {{4, 1}, {2, 8}, {32, 8}, {7, 3}};
  for (int i = 0; i < 4; i++) {
    cdl_Bvh a = build_shape(shapes + i, 0, 0);
    for (int k = 0; k < 4; k++) {
      cdl_Bvh b = build_shape(shapes + i, variants[k][0], variants[k][1]);
      check_same_answers(shapes + i, &a, &b);
      bvh_free(&b);
    }
    bvh_free(&a);
    shape_free(shapes + i);
  }
}

/* From inside a closed surface every ray hits something, also one aimed at an edge or a vertex. */
static void check_no_leak(const Shape *shape, vec3 center, float size, int rays) {
  Random random = {11};
  cdl_Bvh bvh = build_shape(shape, 0, 0);
  for (int i = 0; i < rays; i++) {
    vec3 o = v3_add(center, random_point(&random, size));
    vec3 d = v3_sub(shape_edge_point(shape, &random), o);
    if (!hit_is_some(closest(&bvh, o, d, INFINITY)))
      fail_msg("ray %d slips through: %a %a %a towards %a %a %a", i, o.x, o.y, o.z, d.x, d.y, d.z);
    assert_true(occluded(&bvh, o, d, INFINITY));
  }
  bvh_free(&bvh);
}

static void test_nothing_leaks(void **state) {
  (void)state;
  for (int i = 0; i < CLOSED_SHAPES; i++) {
    ClosedShape closed = shape_closed(i);
    check_no_leak(&closed.shape, closed.center, closed.inside, 50000);
    shape_free(&closed.shape);
  }
}

static void test_ties_go_to_the_smallest_number(void **state) {
  (void)state;
  Shape shape = shape_soup(1, 1.0f, 4);
  cdl_BvhPart parts[40];
  /* Forty copies of one triangle, numbered backwards. */
  for (uint32_t i = 0; i < 40; i++)
    parts[i] = (cdl_BvhPart){shape.positions, shape.indices, 1, 100 + 39 - i, 0, 0};
  cdl_BvhMesh mesh = {parts, 40};
  cdl_BvhPlacement placements[5] = {{.mask = 4}};
  cdl_BvhOptions options = {CDL_BVH_WIDTH, 0, 0};
  cdl_Bvh bvh;
  for (int i = 0; i < 5; i++) {
    placements[i].mask = i < 2 ? 4 : 1;
    memcpy(placements[i].to_world, identity, sizeof identity);
  }
  assert_int_equal(bvh_build(NULL, &mesh, 1, placements, 5, &options, &bvh), CDL_OK);
  const float *p = shape.positions;
  vec3 middle = v3((p[0] + p[3] + p[6]) / 3, (p[1] + p[4] + p[7]) / 3, (p[2] + p[5] + p[8]) / 3);
  vec3 o = v3(3.0f, -2.0f, 4.0f), d = v3_sub(middle, o);
  for (uint32_t mask = 1; mask <= 4; mask += 3) {
    Hit hit = bvh_closest(bvh.nodes, bvh.triangles, bvh.instances, bvh.root, o, d, 2.0f, mask);
    assert_int_equal(hit.primitive, 100);
    assert_int_equal(hit.instance, mask == 1 ? 2 : 0);
  }
  Hit hit = bvh_closest(bvh.nodes, bvh.triangles, bvh.instances, bvh.root, o, d, 2.0f, 8);
  assert_false(hit_is_some(hit));
  bvh_free(&bvh);
  shape_free(&shape);
}

/* Hit after hit must give every hit once, in order: forty copies in five instances, and a soup. */
static void test_hits_follow_each_other(void **state) {
  (void)state;
  Random random = {21};
  Shape shape = shape_soup(400, 0.8f, 22);
  cdl_Bvh bvh = build_shape(&shape, 0, 0);
  for (int i = 0; i < 200; i++) {
    vec3 o = random_point(&random, 2.0f), d = random_point(&random, 1.0f);
    Exact exact = exact_none();
    uint32_t expected = 0, found = 0;
    for (uint32_t k = 0; k < shape.triangles; k++) {
      Shape one = {shape.positions, shape.indices + 3 * k, shape.vertices, 1};
      Exact single = exact_none();
      exact_shape(&one, identity, 0, o, d, &single);
      exact.margin = fmin(exact.margin, single.margin);
      expected += !isinf(single.t);
    }
    if (exact.margin < 1e-4) continue;
    Hit last = hit_none(0.0f);
    for (;;) {
      Hit hit = bvh_closest_after(bvh.nodes, bvh.triangles, bvh.instances, bvh.root, o, d, INFINITY,
                                  CDL_MASK_ALL, last);
      if (!hit_is_some(hit)) break;
      assert_true(hit_before(last, hit));
      last = hit;
      found++;
    }
    assert_int_equal(found, expected);
  }
  bvh_free(&bvh);
  shape_free(&shape);
}

#include "bvh_instance_cases.h"

static void test_nothing_to_hit(void **state) {
  (void)state;
  cdl_BvhMesh empty = {NULL, 0};
  cdl_BvhPlacement placement = {.mask = CDL_MASK_ALL};
  cdl_BvhOptions options = {CDL_BVH_WIDTH, 0, 0};
  memcpy(placement.to_world, identity, sizeof identity);
  for (uint32_t meshes = 0; meshes < 2; meshes++) {
    cdl_Bvh bvh;
    assert_int_equal(bvh_build(NULL, &empty, meshes, &placement, meshes, &options, &bvh), CDL_OK);
    assert_false(hit_is_some(closest(&bvh, v3_all(0.0f), v3(0.0f, 0.0f, 1.0f), INFINITY)));
    assert_false(occluded(&bvh, v3_all(0.0f), v3(0.1f, 0.2f, 1.0f), INFINITY));
    assert_true(bvh.bounds[0] > bvh.bounds[3]);
    bvh_free(&bvh);
  }
}

static void test_rays_that_are_no_rays(void **state) {
  (void)state;
  const float bad[5] = {NAN, INFINITY, -INFINITY, 0.0f, 1e-39f};
  Shape shape = shape_soup(200, 0.5f, 3);
  cdl_Bvh bvh = build_shape(&shape, 0, 0);
  for (int i = 0; i < 5; i++) {
    vec3 ok = v3(0.3f, 0.2f, 0.1f), is_bad = v3_all(bad[i]), partly = v3(0.5f, bad[i], 0.2f);
    assert_false(hit_is_some(closest(&bvh, ok, is_bad, INFINITY)));
    if (i >= 3) continue;
    assert_false(hit_is_some(closest(&bvh, is_bad, ok, INFINITY)));
    assert_false(hit_is_some(closest(&bvh, ok, partly, INFINITY)));
    assert_false(occluded(&bvh, partly, ok, INFINITY));
  }
  assert_false(hit_is_some(closest(&bvh, v3_all(0.0f), v3(1.0f, 0.0f, 0.0f), NAN)));
  assert_false(hit_is_some(closest(&bvh, v3_all(0.0f), v3(1.0f, 0.0f, 0.0f), -1.0f)));
  bvh_free(&bvh);
  shape_free(&shape);
}

/* The ends of a ray: t = tmax counts, t = 0 does not. */
static void test_range_of_a_ray(void **state) {
  (void)state;
  Shape box = shape_box(1, v3_all(0.0f), v3_all(1.0f));
  cdl_Bvh bvh = build_shape(&box, 0, 0);
  vec3 o = v3(0.1f, 0.2f, 0.0f), d = v3(0.0f, 0.0f, 1.0f);
  assert_true(closest(&bvh, o, d, 1.0f).t == 1.0f);
  assert_false(hit_is_some(closest(&bvh, o, d, 0.99999994f)));
  assert_true(closest(&bvh, v3(0.1f, 0.2f, -1.0f), d, 9.0f).t == 2.0f);
  assert_false(hit_is_some(closest(&bvh, v3(0.1f, 0.2f, 1.0f), d, 9.0f)));
  assert_true(closest(&bvh, o, v3(0.0f, 0.0f, 4.0f), 9.0f).t == 0.25f);
  bvh_free(&bvh);
  shape_free(&box);
}

/* Centroids that cannot be told apart, sizes in geometric progression, corners that are no numbers.
 */
static void test_degenerate_input(void **state) {
  (void)state;
  enum { COUNT = 5000 };
  Shape shape = shape_soup(COUNT, 0.3f, 13);
  for (int kind = 0; kind < 4; kind++) {
    for (size_t i = 0; i < COUNT; i++) {
      float *p = shape.positions + 9 * i, size = ldexpf(1.0f, -(int)(i % 100));
      if (kind == 0) memcpy(p, shape.positions, 9 * sizeof *p);
      if (kind == 1)
        for (int k = 0; k < 9; k++) p[k] = (float)((k * 7 + 3) % 5) * size;
      if (kind == 2) memcpy(p + 3, p, 3 * sizeof *p);
      if (kind == 3) p[i % 9] = i % 2 ? NAN : INFINITY;
    }
    cdl_Bvh bvh = build_shape(&shape, 0, 0);
    assert_true(bvh.statistics.depth <= 62);
    assert_int_equal(bvh.statistics.dropped, kind < 2 ? 0 : COUNT);
    assert_int_equal(bvh.statistics.triangles, kind < 2 ? COUNT : 0);
    closest(&bvh, v3(0.1f, 0.2f, 9.0f), v3(0.01f, 0.0f, -1.0f), INFINITY);
    bvh_free(&bvh);
  }
  shape_free(&shape);
}

static void test_threads_change_nothing(void **state) {
  (void)state;
  Shape shape = shape_sphere(7, v3_all(0.0f), 1.0f);
  omp_set_num_threads(1);
  cdl_Bvh a = build_shape(&shape, 0, 0);
  omp_set_num_threads(3);
  cdl_Bvh b = build_shape(&shape, 0, 0);
  assert_int_equal(a.node_bytes, b.node_bytes);
  assert_int_equal(a.triangle_bytes, b.triangle_bytes);
  assert_memory_equal(a.nodes, b.nodes, a.node_bytes);
  assert_memory_equal(a.triangles, b.triangles, a.triangle_bytes);
  bvh_free(&a);
  bvh_free(&b);
  shape_free(&shape);
}

static void test_statistics(void **state) {
  (void)state;
  char line[512];
  Shape shape = shape_sphere(4, v3_all(0.0f), 1.0f);
  cdl_Bvh bvh = build_shape(&shape, 0, 0);
  const cdl_BvhStatistics *s = &bvh.statistics;
  uint64_t leaves = 0, triangles = 0;
  for (uint64_t i = 0; i < 33; i++) {
    leaves += s->leaf_sizes[i];
    triangles += i * s->leaf_sizes[i];
  }
  assert_int_equal(triangles, shape.triangles);
  assert_int_equal(leaves, s->leaves);
  assert_int_equal(s->bytes, bvh.node_bytes + bvh.triangle_bytes + bvh.instance_bytes);
  assert_true(s->sah > 1.0 && s->sah < 100.0);
  assert_true(bvh_statistics_line(s, CDL_BVH_WIDTH, line, sizeof line) < (int)sizeof line);
  assert_non_null(strstr(line, "5120 triangles"));
  bvh_free(&bvh);
  shape_free(&shape);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_soup_against_double),
      cmocka_unit_test(test_hit_point_lies_where_barycentrics_say),
      cmocka_unit_test(test_answers_do_not_depend_on_the_tree),
      cmocka_unit_test(test_nothing_leaks),
      cmocka_unit_test(test_ties_go_to_the_smallest_number),
      cmocka_unit_test(test_hits_follow_each_other),
      cmocka_unit_test(test_instances_against_double),
      cmocka_unit_test(test_moved_closed_surfaces_do_not_leak),
      cmocka_unit_test(test_nothing_to_hit),
      cmocka_unit_test(test_rays_that_are_no_rays),
      cmocka_unit_test(test_range_of_a_ray),
      cmocka_unit_test(test_degenerate_input),
      cmocka_unit_test(test_threads_change_nothing),
      cmocka_unit_test(test_statistics),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
