/* bvh_instance_cases.h: the part of bvh_cases.h about placed meshes, included by it. */
#ifndef CANDELA_TESTS_BVH_INSTANCE_CASES_H
#define CANDELA_TESTS_BVH_INSTANCE_CASES_H

enum { INSTANCES = 60, SHAPES = 3 };

typedef struct Placed {
  Shape shapes[SHAPES];
  cdl_BvhPlacement placements[INSTANCES];
  cdl_Bvh bvh;
} Placed;

static void placed_open(Placed *placed) {
  Random random = {31};
  cdl_BvhPart parts[SHAPES];
  cdl_BvhMesh meshes[SHAPES];
  cdl_BvhOptions options = {CDL_BVH_WIDTH, 0, 0};
  placed->shapes[0] = shape_sphere(2, v3_all(0.0f), 0.5f);
  placed->shapes[1] = shape_box(2, v3(0.3f, 0.0f, 0.0f), v3(0.4f, 0.2f, 0.6f));
  placed->shapes[2] = shape_soup(50, 0.4f, 8);
  for (int i = 0; i < SHAPES; i++) {
    const Shape *s = placed->shapes + i;
    parts[i] = (cdl_BvhPart){s->positions, s->indices, s->triangles, 0, 0, 0};
    meshes[i] = (cdl_BvhMesh){parts + i, 1};
  }
  for (uint32_t i = 0; i < INSTANCES; i++) {
    cdl_BvhPlacement *p = placed->placements + i;
    *p = (cdl_BvhPlacement){.mesh = i % SHAPES, .mask = CDL_MASK_ALL, .object = 1000 + i};
    random_matrix(&random, p->to_world);
    if (i == 7) memcpy(p->to_world, identity, sizeof identity);
    if (i == 9) p->to_world[0] = p->to_world[4] = p->to_world[8] = 0.0f; /* flat: hidden */
  }
  assert_int_equal(
      bvh_build(NULL, meshes, SHAPES, placed->placements, INSTANCES, &options, &placed->bvh),
      CDL_OK);
}

static void test_instances_against_double(void **state) {
  (void)state;
  Random random = {41};
  Placed placed;
  int checked = 0, hits = 0;
  placed_open(&placed);
  for (int i = 0; i < 2000; i++) {
    vec3 o = random_point(&random, 4.0f), d = random_point(&random, 1.0f);
    Exact exact = exact_none();
    for (uint32_t k = 0; k < INSTANCES; k++)
      if (k != 9)
        exact_shape(placed.shapes + k % SHAPES, placed.placements[k].to_world, k, o, d, &exact);
    if (!is_beyond_doubt(&exact)) continue;
    Hit hit = closest(&placed.bvh, o, d, INFINITY);
    assert_int_equal(hit.instance, exact.instance);
    assert_int_equal(hit.primitive, exact.primitive);
    assert_int_equal(occluded(&placed.bvh, o, d, INFINITY), hit_is_some(hit));
    checked++;
    if (!hit_is_some(hit)) continue;
    hits++;
    assert_int_equal(placed.bvh.instances[hit.instance].object, 1000 + hit.instance);
    assert_true(fabs(hit.t - exact.t) <= 1e-4 * exact.t + 1e-5);
  }
  assert_true(checked > 700 && hits > 400);
  assert_true(placed.bvh.instances[7].flags & CDL_INSTANCE_IDENTITY);
  bvh_free(&placed.bvh);
  for (int i = 0; i < SHAPES; i++) shape_free(placed.shapes + i);
}

static void test_moved_closed_surfaces_do_not_leak(void **state) {
  (void)state;
  Random random = {51};
  Shape sphere = shape_sphere(2, v3_all(0.0f), 1.0f);
  cdl_BvhPart part = {sphere.positions, sphere.indices, sphere.triangles, 0, 0, 0};
  cdl_BvhMesh mesh = {&part, 1};
  cdl_BvhOptions options = {CDL_BVH_WIDTH, 0, 0};
  for (int i = 0; i < 40; i++) {
    cdl_BvhPlacement placements[2] = {{.mask = 1}, {.mask = 2}};
    cdl_Bvh bvh;
    for (int k = 0; k < 2; k++) random_matrix(&random, placements[k].to_world);
    assert_int_equal(bvh_build(NULL, &mesh, 1, placements, 2, &options, &bvh), CDL_OK);
    const float *m = placements[0].to_world;
    for (int k = 0; k < 2000; k++) {
      vec3 p = shape_edge_point(&sphere, &random), o = v3(m[3], m[7], m[11]);
      vec3 d = v3(m[0] * p.x + m[1] * p.y + m[2] * p.z, m[4] * p.x + m[5] * p.y + m[6] * p.z,
                  m[8] * p.x + m[9] * p.y + m[10] * p.z);
      Hit hit = bvh_closest(bvh.nodes, bvh.triangles, bvh.instances, bvh.root, o, d, INFINITY, 1);
      assert_int_equal(hit.instance, 0);
    }
    bvh_free(&bvh);
  }
  shape_free(&sphere);
}

#endif
