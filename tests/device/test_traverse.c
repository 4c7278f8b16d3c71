/* test_traverse.c: ray queries on devices: the same bits as on the host for either layout, and no
 * ray slips out of a closed surface, of ten million aimed at edges and vertices (a hundred million
 * when CDL_SOAK is set; a few where a device is an emulator). tests/unit/bvh_cases.h proves the
 * host. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#include "../unit/bvh_shapes.h"
#include "bvh/bvh.h"
#include "bvh/traverse.h"
#include "harness.h"

enum { RAYS = 32768, ITEMS = 4096, PLATFORMS = 3 };

static const char *const platform_names[PLATFORMS] = {"Portable Computing Language", "rusticl",
                                                      "NVIDIA"};

/* Rays as structure of arrays: o x y z, d x y z, tmax. Hits as five words and whether occluded. */
static const char answer_text[] =
    "#include \"bvh/traverse.h\"\n"
    "__kernel void answer(__global const BvhNode *nodes, __global const BvhTriangle *triangles,\n"
    "                     __global const cdl_BvhInstance *instances, __global const uint *root,\n"
    "                     __global const float *rays, __global uint *hits) {\n"
    "  uint n = root[1], i = get_global_id(0) < n ? get_global_id(0) : n - 1u;\n"
    "  vec3 o = v3(rays[i], rays[i + n], rays[i + 2u * n]);\n"
    "  vec3 d = v3(rays[i + 3u * n], rays[i + 4u * n], rays[i + 5u * n]);\n"
    "  float tmax = rays[i + 6u * n];\n"
    "  Hit hit = bvh_closest(nodes, triangles, instances, root[0], o, d, tmax, 1u);\n"
    "  hits[i] = as_uint(hit.t);\n"
    "  hits[i + n] = as_uint(hit.u);\n"
    "  hits[i + 2u * n] = as_uint(hit.v);\n"
    "  hits[i + 3u * n] = hit.primitive;\n"
    "  hits[i + 4u * n] = hit.instance;\n"
    "  hits[i + 5u * n] =\n"
    "      (uint)bvh_occluded(nodes, triangles, instances, root[0], o, d, tmax, 1u);\n"
    "}\n";

/* Each work-item sends setup[2] rays from inside the cube of half side box[3] around box[0…2] to
 * points of edges, and counts those that hit nothing. */
static const char leak_text[] =
    "#include \"bvh/traverse.h\"\n"
    "uint hash_of(uint x) {\n"
    "  x = (x ^ (x >> 16)) * 0x7feb352du;\n"
    "  x = (x ^ (x >> 15)) * 0x846ca68bu;\n"
    "  return x ^ (x >> 16);\n"
    "}\n"
    "float unit_of(uint x) { return (float)(hash_of(x) >> 8) * 5.9604644775390625e-8f; }\n"
    "vec3 vertex_of(__global const float *p, uint i) {\n"
    "  return v3(p[3u * i], p[3u * i + 1u], p[3u * i + 2u]);\n"
    "}\n"
    "__kernel void leak(__global const BvhNode *nodes, __global const BvhTriangle *triangles,\n"
    "                   __global const cdl_BvhInstance *instances, __global const uint *setup,\n"
    "                   __global const float *box, __global const float *positions,\n"
    "                   __global const uint *indices, __global uint *leaks) {\n"
    "  uint item = get_global_id(0), missed = 0u;\n"
    "  for (uint k = 0u; k < setup[2]; k++) {\n"
    "    uint seed = hash_of(item * setup[2] + k) * 8u;\n"
    "    uint at = 3u * (hash_of(seed) % setup[1]), corner = hash_of(seed + 1u) % 3u;\n"
    "    vec3 a = vertex_of(positions, indices[at + corner]);\n"
    "    vec3 b = vertex_of(positions, indices[at + (corner + 1u) % 3u]);\n"
    "    uint kind = hash_of(seed + 2u) & 3u;\n"
    "    float s = kind == 0u ? 0.0f : kind == 1u ? 0.5f : unit_of(seed + 3u);\n"
    "    vec3 to = v3_madd(a, s, v3_sub(b, a));\n"
    "    vec3 o = v3(box[0] + box[3] * (2.0f * unit_of(seed + 4u) - 1.0f),\n"
    "                box[1] + box[3] * (2.0f * unit_of(seed + 5u) - 1.0f),\n"
    "                box[2] + box[3] * (2.0f * unit_of(seed + 6u) - 1.0f));\n"
    "    vec3 d = kind == 2u ? v3_normalize(v3_sub(to, o)) : v3_sub(to, o);\n"
    "    Hit hit = bvh_closest(nodes, triangles, instances, setup[0], o, d, CDL_INFINITY, 1u);\n"
    "    missed += hit_is_some(hit) ? 0u : 1u;\n"
    "  }\n"
    "  leaks[item] = missed;\n"
    "}\n";

static Harness *harness;

static void build_kernel(const char *text, int width) {
  char source[8192];
  snprintf(source, sizeof source, "#define CDL_BVH_WIDTH %d\n%s", width, text);
  harness_build(harness, source);
}

/* Meshes placed by matrices: a closed sphere at rest, one turned and stretched, a mirrored soup. */
static cdl_Bvh build_scene(Shape shapes[2], int width) {
  static const float matrices[3][12] = {
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
      {0.6f, -0.4f, 0, 0.5f, 0.8f, 0.3f, 0, -0.2f, 0, 0, 2, 0.1f},
      {-1, 0.1f, 0, 0.3f, 0, 0.7f, 0.2f, 0, 0.3f, 0, 1.1f, -0.4f}};
  cdl_BvhPart parts[2];
  cdl_BvhMesh meshes[2];
  cdl_BvhPlacement placements[3];
  cdl_BvhOptions options = {.width = width};
  cdl_Bvh bvh;
  for (int i = 0; i < 2; i++) {
    parts[i] = (cdl_BvhPart){shapes[i].positions, shapes[i].indices, shapes[i].triangles, 0, 0, 0};
    meshes[i] = (cdl_BvhMesh){parts + i, 1};
  }
  for (uint32_t i = 0; i < 3; i++) {
    placements[i] = (cdl_BvhPlacement){.mesh = i == 2, .mask = 1};
    memcpy(placements[i].to_world, matrices[i], sizeof matrices[i]);
  }
  assert_int_equal(bvh_build(NULL, meshes, 2, placements, 3, &options, &bvh), CDL_OK);
  return bvh;
}

static void make_rays(const Shape *shape, float *rays) {
  Random random = {3};
  for (size_t i = 0; i < RAYS; i++) {
    float r[7];
    vec3 p = shape_edge_point(shape, &random);
    for (int k = 0; k < 6; k++) r[k] = 2.0f * random_signed(&random);
    if (i % 3 == 1) {
      r[3] = p.x - r[0];
      r[4] = p.y - r[1];
      r[5] = p.z - r[2];
    }
    if (i % 7 == 2) r[3 + i % 3] = 0.0f;
    if (i % 7 == 3) r[3 + i % 3] = r[3 + (i + 1) % 3] = 0.0f;
    r[6] = i % 4 == 0 ? 1.0f : INFINITY;
    for (size_t k = 0; k < 7; k++) rays[i + k * RAYS] = r[k];
  }
}

static void answer_on_host(const cdl_Bvh *bvh, const float *rays, uint32_t *hits) {
  for (size_t i = 0; i < RAYS; i++) {
    const float *r = rays + i;
    vec3 o = v3(r[0], r[RAYS], r[2 * RAYS]), d = v3(r[3 * RAYS], r[4 * RAYS], r[5 * RAYS]);
    Hit hit =
        bvh_closest(bvh->nodes, bvh->triangles, bvh->instances, bvh->root, o, d, r[6 * RAYS], 1);
    uint32_t words[6] = {as_uint(hit.t), as_uint(hit.u), as_uint(hit.v),
                         hit.primitive,  hit.instance,   (uint32_t)hit_is_some(hit)};
    for (size_t k = 0; k < 6; k++) hits[i + k * RAYS] = words[k];
  }
}

static void answer_on_device(const cdl_Bvh *bvh, float *rays, uint32_t *hits) {
  uint32_t root[2] = {bvh->root, RAYS};
  const HarnessBuffer buffers[6] = {
      {bvh->nodes, bvh->node_bytes},         {bvh->triangles, bvh->triangle_bytes},
      {bvh->instances, bvh->instance_bytes}, {root, sizeof root},
      {rays, 7 * RAYS * sizeof *rays},       {hits, 6 * RAYS * sizeof *hits}};
  build_kernel(answer_text, bvh->width);
  harness_run(harness, "answer", RAYS, buffers, 6);
}

static void test_same_bits_as_the_host(void **state) {
  (void)state;
  Shape shapes[2] = {shape_sphere(4, v3_all(0.0f), 1.0f), shape_soup(2000, 0.3f, 5)};
  float *rays = malloc(7 * RAYS * sizeof *rays);
  uint32_t *expected = malloc(6 * RAYS * 4), *hits = malloc(6 * RAYS * 4);
  size_t found = 0;
  assert_true(rays && expected && hits);
  make_rays(shapes, rays);
  for (int width = 2; width <= 8; width += 6) {
    cdl_Bvh bvh = build_scene(shapes, width);
    if (width == 2) answer_on_host(&bvh, rays, expected);
    memset(hits, 0x55, 6 * RAYS * 4);
    answer_on_device(&bvh, rays, hits);
    for (size_t i = 0; i < 6 * RAYS; i++)
      if (hits[i] != expected[i])
        fail_msg("width %d, ray %zu, word %zu: %08x instead of %08x", width, i % RAYS, i / RAYS,
                 hits[i], expected[i]);
    bvh_free(&bvh);
  }
  for (size_t i = 0; i < RAYS; i++) found += expected[i + 5 * RAYS];
  assert_true(found > RAYS / 4 && found < RAYS);
  free(rays);
  free(expected);
  free(hits);
  for (int i = 0; i < 2; i++) shape_free(shapes + i);
}

static uint64_t count_leaks(const ClosedShape *closed, int width, uint32_t rays_each) {
  Shape mesh = closed->shape;
  cdl_BvhPart part = {mesh.positions, mesh.indices, mesh.triangles, 0, 0, 0};
  cdl_BvhMesh one = {&part, 1};
  cdl_BvhPlacement placement = {.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, .mask = 1};
  cdl_BvhOptions options = {.width = width};
  static uint32_t leaks[ITEMS];
  uint64_t total = 0;
  cdl_Bvh bvh;
  assert_int_equal(bvh_build(NULL, &one, 1, &placement, 1, &options, &bvh), CDL_OK);
  uint32_t setup[3] = {bvh.root, mesh.triangles, rays_each};
  float box[4] = {closed->center.x, closed->center.y, closed->center.z, closed->inside};
  const HarnessBuffer buffers[8] = {{bvh.nodes, bvh.node_bytes},
                                    {bvh.triangles, bvh.triangle_bytes},
                                    {bvh.instances, bvh.instance_bytes},
                                    {setup, sizeof setup},
                                    {box, sizeof box},
                                    {mesh.positions, mesh.vertices * 12},
                                    {mesh.indices, mesh.triangles * 12},
                                    {leaks, sizeof leaks}};
  memset(leaks, 0xff, sizeof leaks);
  harness_run(harness, "leak", ITEMS, buffers, 8);
  for (int i = 0; i < ITEMS; i++) total += leaks[i];
  bvh_free(&bvh);
  return total;
}

/* Ten million in all: for each layout, more than half a million from inside each of the shapes. */
static void test_nothing_leaks(void **state) {
  (void)state;
  const char *name = harness_name(harness);
  int emulated = !strstr(name, "Portable Computing Language") && !strstr(name, "NVIDIA");
  uint32_t each = emulated ? 2 : getenv("CDL_SOAK") ? 1540 : 154;
  uint64_t rays = 0;
  for (int width = 2; width <= 8; width += 6) {
    build_kernel(leak_text, width);
    for (int i = 0; i < CLOSED_SHAPES; i++) {
      ClosedShape closed = shape_closed(i);
      uint64_t leaks = count_leaks(&closed, width, each);
      shape_free(&closed.shape);
      if (leaks)
        fail_msg("width %d, shape %d: %llu rays slip through", width, i, (unsigned long long)leaks);
      rays += (uint64_t)each * ITEMS;
    }
  }
  print_message("%s: no leak in %llu rays\n", name, (unsigned long long)rays);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_bits_as_the_host),
                                     cmocka_unit_test(test_nothing_leaks)};
  int failed = 0, devices = 0;
  harness_prepare();
  for (int i = 0; i < PLATFORMS; i++) {
    harness = harness_open(platform_names[i]);
    if (!harness) continue;
    print_message("%s\n", harness_name(harness));
    failed += cmocka_run_group_tests(tests, NULL, NULL);
    devices++;
    harness_close(harness);
  }
  if (devices == 0) print_message("no OpenCL device: 0 passed, 1 failed\n");
  return failed || devices == 0;
}
