/* test_meshopt.c: what the library's own encoders compressed comes back: attributes, triangles,
 * strips, every filter, instances; fallback buffers; streams of version 1. */
#include <meshoptimizer.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../unit/scene_text.h"
#include "grid.h"
#include "meshopt_v1.h"
#include "scene/compression.h"

static Grid grid;
static uint8_t bin[1 << 20];
static size_t bin_size;
static char views[1 << 14];
static size_t plain_size; /* of what stands for the uncompressed buffer */
static const char *extension = "EXT_meshopt_compression";

static void begin(void) {
  bin_size = plain_size = 0;
  views[0] = 0;
}

/* A buffer view of `count` elements over compressed bytes. */
static void add_view(const void *data, size_t size, size_t count, size_t stride, int vertices,
                     const char *mode, const char *filter) {
  char given[64] = "";
  if (vertices) snprintf(given, sizeof given, "\"byteStride\":%zu,", stride);
  snprintf(views + strlen(views), sizeof views - strlen(views),
           "%s{\"buffer\":1,\"byteOffset\":%zu,\"byteLength\":%zu,%s\"extensions\":{\"%s\":{"
           "\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":%zu,\"count\":%zu,"
           "\"mode\":\"%s\",\"filter\":\"%s\"}}}",
           *views ? "," : "", plain_size, count * stride, given, extension, bin_size, size, stride,
           count, mode, filter);
  memcpy(bin + bin_size, data, size);
  bin_size += (size + 3) & ~(size_t)3;
  plain_size += (count * stride + 3) & ~(size_t)3;
}

static void add_attributes(const void *data, size_t count, size_t stride, const char *filter) {
  static uint8_t to[1 << 18];
  size_t size = meshopt_encodeVertexBuffer(to, sizeof to, data, count, stride);
  assert_true(size > 0);
  add_view(to, size, count, stride, 1, "ATTRIBUTES", filter);
}

static void add_indices(const uint32_t *indices, size_t count, size_t stride, int triangles) {
  static uint8_t to[1 << 18];
  meshopt_encodeIndexVersion(1);
  size_t size = triangles ? meshopt_encodeIndexBuffer(to, sizeof to, indices, count)
                          : meshopt_encodeIndexSequence(to, sizeof to, indices, count);
  assert_true(size > 0);
  add_view(to, size, count, stride, 0, triangles ? "TRIANGLES" : "INDICES", "NONE");
}

#define GRID_ACCESSOR "{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"%s}"
#define BOUNDS ",\"min\":[0,0,-0.25],\"max\":[1,1,0.25]"

/* A scene of the views so far. `accessors` names one for each; `fallback` is buffer 1. */
static struct cdl_Scene *load(const char *attributes, const char *accessors, int mode,
                              const char *fallback, const char *more) {
  scene_write("mesh.bin", bin, bin_size);
  return scene_from("{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"%s\","
                    "\"KHR_mesh_quantization\",\"EXT_mesh_gpu_instancing\"],"
                    "\"extensionsRequired\":[\"%s\"],\"scenes\":[{\"nodes\":[0]}],"
                    "\"nodes\":[{\"mesh\":0%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{%s},"
                    "\"indices\":0,\"mode\":%d}]}],\"accessors\":[%s],\"bufferViews\":[%s],"
                    "\"buffers\":[{\"uri\":\"mesh.bin\",\"byteLength\":%zu},{%s"
                    "\"byteLength\":%zu}]}",
                    extension, extension, more, attributes, mode, accessors, views, bin_size,
                    fallback, plain_size);
}

static struct cdl_Scene *must(struct cdl_Scene *scene) {
  if (scene_status) print_message("%s", scene_errors);
  assert_int_equal(scene_status, CDL_OK);
  return scene;
}

static void check_triangles(const cdl_SceneMesh *mesh) {
  assert_int_equal(mesh->triangle_count, FACES);
  for (int t = 0; t < FACES; t++)
    assert_true(same_triangle(mesh->indices + 3 * t, grid.indices[t]));
}

/* Bounds are those of float data in double, written with all digits. */
static const char *bounds_of(const float (*p)[3], size_t count) {
  static char text[256];
  float box[2][3];
  for (int c = 0; c < 3; c++) box[0][c] = INFINITY, box[1][c] = -INFINITY;
  for (size_t i = 0; i < count; i++)
    for (int c = 0; c < 3; c++) {
      box[0][c] = fminf(box[0][c], p[i][c]);
      box[1][c] = fmaxf(box[1][c], p[i][c]);
    }
  snprintf(text, sizeof text, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", box[0][0],
           box[0][1], box[0][2], box[1][0], box[1][1], box[1][2]);
  return text;
}

/* Without filters everything is exact, and bounds are checked as ever. */
static void test_exact(void **state) {
  (void)state;
  for (int wide = 0; wide < 2; wide++) {
    char accessors[2048];
    begin();
    add_indices(&grid.indices[0][0], 3 * FACES, wide ? 4 : 2, 1);
    add_attributes(grid.positions, POINTS, 12, "NONE");
    add_attributes(grid.normals, POINTS, 12, "NONE");
    add_attributes(grid.tangents, POINTS, 16, "NONE");
    add_attributes(grid.uv, POINTS, 8, "NONE");
    add_attributes(grid.colors, POINTS, 4, "NONE");
    snprintf(accessors, sizeof accessors,
             GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR
                           "," GRID_ACCESSOR,
             0, wide ? 5125 : 5123, 3 * FACES, "SCALAR", "", 1, 5126, POINTS, "VEC3",
             bounds_of(grid.positions, POINTS), 2, 5126, POINTS, "VEC3", "", 3, 5126, POINTS,
             "VEC4", "", 4, 5126, POINTS, "VEC2", "", 5, 5121, POINTS, "VEC4",
             ",\"normalized\":true");
    struct cdl_Scene *scene =
        must(load("\"POSITION\":1,\"NORMAL\":2,\"TANGENT\":3,\"TEXCOORD_0\":4,\"COLOR_0\":5",
                  accessors, 4, "", ""));
    const cdl_SceneMesh *mesh = &scene->meshes[0];
    check_triangles(mesh);
    assert_memory_equal(mesh->positions, grid.positions, sizeof grid.positions);
    assert_memory_equal(mesh->uv[0], grid.uv, sizeof grid.uv);
    assert_true(grid_difference(mesh->normals, grid.normals[0], 3 * POINTS) < 1e-6);
    assert_true(grid_difference(mesh->tangents, grid.tangents[0], 4 * POINTS) < 1e-6);
    for (int i = 0; i < 4 * POINTS; i++)
      assert_true(fabsf(mesh->colors[i] - grid.colors[i / 4][i % 4] / 255.0f) < 1e-6f);
    scene_free(scene);
  }
}

/* Octahedral directions of 8 and 12 bits, exponents with 15 bits of mantissa. */
static void test_filters(void **state) {
  (void)state;
  static float four[POINTS][4];
  static uint8_t normals[POINTS * 4], tangents[POINTS * 8], positions[POINTS * 12], uv[POINTS * 8];
  char accessors[2048];
  begin();
  for (int i = 0; i < POINTS; i++) memcpy(four[i], grid.normals[i], 12);
  meshopt_encodeFilterOct(normals, POINTS, 4, 8, four[0]);
  meshopt_encodeFilterOct(tangents, POINTS, 8, 12, grid.tangents[0]);
  meshopt_encodeFilterExp(positions, POINTS, 12, 15, grid.positions[0]);
  meshopt_encodeFilterExp(uv, POINTS, 8, 15, grid.uv[0]);
  add_indices(&grid.indices[0][0], 3 * FACES, 4, 0);
  add_attributes(positions, POINTS, 12, "EXPONENTIAL");
  add_attributes(normals, POINTS, 4, "OCTAHEDRAL");
  add_attributes(tangents, POINTS, 8, "OCTAHEDRAL");
  add_attributes(uv, POINTS, 8, "EXPONENTIAL");
  snprintf(accessors, sizeof accessors,
           GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR, 0,
           5125, 3 * FACES, "SCALAR", "", 1, 5126, POINTS, "VEC3", BOUNDS, 2, 5120, POINTS, "VEC3",
           ",\"normalized\":true", 3, 5122, POINTS, "VEC4", ",\"normalized\":true", 4, 5126, POINTS,
           "VEC2", "");
  struct cdl_Scene *scene =
      must(load("\"POSITION\":1,\"NORMAL\":2,\"TANGENT\":3,\"TEXCOORD_0\":4", accessors, 4,
                "\"uri\":\"missing.bin\",\"extensions\":{\"EXT_meshopt_compression\":{"
                "\"fallback\":true}},",
                ""));
  const cdl_SceneMesh *mesh = &scene->meshes[0];
  assert_memory_equal(mesh->indices, grid.indices, sizeof grid.indices);
  /* One step of 15 bits below 2^1; half a step of 8 bits on the octahedron, and as much again for
   * the 8 bits of the result; likewise of 12. */
  double p = grid_difference(mesh->positions, grid.positions[0], 3 * POINTS);
  double t = grid_difference(mesh->uv[0], grid.uv[0], 2 * POINTS);
  double n = grid_difference(mesh->normals, grid.normals[0], 3 * POINTS);
  double d = grid_difference(mesh->tangents, grid.tangents[0], 4 * POINTS);
  print_message("positions %.2g, uv %.2g, normals %.2g, tangents %.2g\n", p, t, n, d);
  assert_true(p > 0 && p < 0x1p-13 && t > 0 && t < 0x1p-12);
  assert_true(n > 0 && n < 1.5 / 127 && d > 0 && d < 1.5 / 2047);
  scene_free(scene);
}

/* A strip as a sequence of indices, in a GLB's place for it; instances turned by quaternions. */
static void test_strip_and_instances(void **state) {
  (void)state;
  static const uint32_t strip[] = {0, 1, 2, 3, 4, 5, 6, 7};
  static const uint32_t corners[][3] = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4},
                                        {3, 5, 4}, {4, 5, 6}, {5, 7, 6}};
  enum { COPIES = 50 };
  float turns[COPIES][4];
  uint8_t packed[COPIES * 8];
  char accessors[1024];
  for (int i = 0; i < COPIES; i++) {
    double a = 0.11 * i, x = sin(1.3 * i), y = cos(1.3 * i) * 0.6, z = cos(1.3 * i) * 0.8;
    turns[i][0] = (float)(sin(a) * x), turns[i][1] = (float)(sin(a) * y);
    turns[i][2] = (float)(sin(a) * z), turns[i][3] = (float)cos(a);
  }
  meshopt_encodeFilterQuat(packed, COPIES, 8, 16, turns[0]);
  begin();
  add_indices(strip, 8, 2, 0);
  add_attributes(grid.positions, 8, 12, "NONE");
  add_attributes(packed, COPIES, 8, "QUATERNION");
  snprintf(accessors, sizeof accessors, GRID_ACCESSOR "," GRID_ACCESSOR "," GRID_ACCESSOR, 0, 5123,
           8, "SCALAR", "", 1, 5126, 8, "VEC3", bounds_of(grid.positions, 8), 2, 5122, COPIES,
           "VEC4", ",\"normalized\":true");
  struct cdl_Scene *scene =
      must(load("\"POSITION\":1", accessors, 5, "",
                ",\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"ROTATION\":2}}}"));
  assert_int_equal(scene->meshes[0].triangle_count, 6);
  assert_memory_equal(scene->meshes[0].indices, corners, sizeof corners);
  assert_int_equal(scene->instance_count, COPIES);
  for (int i = 0; i < COPIES; i++) {
    const float *q = turns[i], *m = scene->instances[i].to_world;
    double column[3] = {1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] + q[2] * q[3]),
                        2 * (q[0] * q[2] - q[1] * q[3])};
    for (int r = 0; r < 3; r++) assert_true(fabs(m[4 * r] - column[r]) < 3e-4);
  }
  scene_free(scene);
}

static struct cdl_Scene *load_three(int component, const char *type) {
  char accessors[1024];
  static const uint32_t triangle[] = {0, 1, 2};

  add_indices(triangle, 3, 2, 1);
  snprintf(accessors, sizeof accessors, GRID_ACCESSOR "," GRID_ACCESSOR, 1, 5123, 3, "SCALAR", "",
           0, component, 3, type, BOUNDS);
  return load("\"POSITION\":1", accessors, 4, "", "");
}

/* Version 1 has the name KHR_ alone; what the other name allows, that one does as well. */
static void test_names(void **state) {
  (void)state;
  for (int khr = 0; khr < 2; khr++) {
    extension = khr ? "KHR_meshopt_compression" : "EXT_meshopt_compression";
    begin();
    uint8_t filtered[36];
    meshopt_encodeFilterExp(filtered, 3, 12, 20, grid.positions[0]);
    add_attributes(filtered, 3, 12, "EXPONENTIAL");
    scene_free(must(load_three(5126, "VEC3")));
    begin();
    add_view(v1_floats, sizeof v1_floats, 300, 12, 1, "ATTRIBUTES", "NONE");
    struct cdl_Scene *scene = load_three(5126, "VEC3");
    assert_null(scene);
    assert_non_null(strstr(scene_errors, khr ? "ACCESSOR_M" : "MESHOPT_DATA_INVALID"));
  }
  extension = "EXT_meshopt_compression";
}

static size_t put_chunk(uint8_t *to, size_t at, uint32_t type, const void *from, size_t size) {
  uint32_t head[2] = {(uint32_t)(size + 3) & ~3u, type};
  memcpy(to + at, head, 8);
  memset(to + at + 8, type == 0x4e4f534a ? ' ' : 0, head[0]);
  memcpy(to + at + 8, from, size);
  return at + 8 + head[0];
}

/* In a GLB the compressed data are the binary chunk; what stands for the plain ones is a buffer
 * without data. A sparse accessor changes one position. */
static void test_glb(void **state) {
  (void)state;
  static const uint32_t triangle[] = {0, 1, 2};
  static const struct {
    uint32_t index;
    float value[3];
  } sparse = {1, {5, 6, 7}};
  char text[4096];
  static uint8_t file[8192];
  begin();
  add_indices(triangle, 3, 2, 1);
  add_attributes(grid.positions, 3, 12, "NONE");
  size_t at = bin_size;
  memcpy(bin + at, &sparse, sizeof sparse);
  bin_size += sizeof sparse;
  int length = snprintf(
      text, sizeof text,
      "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"EXT_meshopt_compression\"],"
      "\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"scenes\":[{\"nodes\":[0]}],"
      "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1},"
      "\"indices\":0}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5123,\"count\":3,"
      "\"type\":\"SCALAR\"},{\"bufferView\":1,\"componentType\":5126,\"count\":3,"
      "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[5,6,7],\"sparse\":{\"count\":1,"
      "\"indices\":{\"bufferView\":2,\"componentType\":5125},\"values\":{\"bufferView\":2,"
      "\"byteOffset\":4}}}],\"bufferViews\":[%s,{\"buffer\":0,\"byteOffset\":%zu,"
      "\"byteLength\":16}],\"buffers\":[{\"byteLength\":%zu},{\"byteLength\":%zu,"
      "\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}]}",
      views, at, bin_size, plain_size);
  assert_true(length > 0 && length < (int)sizeof text);
  size_t size = put_chunk(file, 12, 0x4e4f534a, text, (size_t)length);
  size = put_chunk(file, size, 0x004e4942, bin, bin_size);
  const uint32_t head[3] = {0x46546c67, 2, (uint32_t)size};
  memcpy(file, head, sizeof head);
  scene_write("scene.glb", file, size);
  struct cdl_Scene *scene = must(scene_open("scene.glb", -1));
  assert_memory_equal(scene->meshes[0].positions, grid.positions[0], 12);
  assert_memory_equal(scene->meshes[0].positions + 3, sparse.value, 12);
  assert_memory_equal(scene->meshes[0].positions + 6, grid.positions[2], 12);
  scene_free(scene);
}

/* Many views of the same few bytes: what they decode to together is limited. */
static void test_many(void **state) {
  (void)state;
  static uint8_t zeros[4096 * 256], to[1 << 18];
  static const char head[] = "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":["
                             "\"EXT_meshopt_compression\"],\"buffers\":[{\"uri\":\"mesh.bin\","
                             "\"byteLength\":%zu},{\"byteLength\":1048576}],\"bufferViews\":[";
  size_t size = meshopt_encodeVertexBuffer(to, sizeof to, zeros, 4096, 256);
  enum { VIEWS = 2000 };
  char *text = malloc(VIEWS * 256 + 1024);
  assert_non_null(text);
  int at = sprintf(text, head, size);
  for (int i = 0; i < VIEWS; i++)
    at += sprintf(text + at,
                  "%s{\"buffer\":1,\"byteLength\":1048576,\"extensions\":{"
                  "\"EXT_meshopt_compression\":{\"buffer\":0,\"byteLength\":%zu,\"count\":4096,"
                  "\"byteStride\":256,\"mode\":\"ATTRIBUTES\"}}}",
                  i ? "," : "", size);
  at += sprintf(text + at, "]}");
  scene_write("mesh.bin", to, size);
  scene_write("many.gltf", text, (size_t)at);
  free(text);
  assert_null(scene_open("many.gltf", -1));
  assert_non_null(strstr(scene_errors, "DECOMPRESSED_DATA_TOO_LARGE"));
}

/* What the extension does not allow, and declared sizes that nobody has. */
static void test_refused(void **state) {
  (void)state;
  static const struct {
    size_t count, stride;
    const char *mode, *filter, *code;
  } bad[] = {{3, 12, "ATTRIBUTES", "OCTAHEDRAL", "VALUE_NOT_IN_LIST"},
             {3, 12, "ATTRIBUTES", "QUATERNION", "VALUE_NOT_IN_LIST"},
             {3, 12, "ATTRIBUTES", "COLOR", "VALUE_NOT_IN_LIST"},
             {3, 12, "ATTRIBUTES", "ODD", "VALUE_NOT_IN_LIST"},
             {3, 12, "LINES", "NONE", "VALUE_NOT_IN_LIST"},
             {3, 12, "TRIANGLES", "NONE", "VALUE_NOT_IN_LIST"},
             {4, 4, "TRIANGLES", "NONE", "VALUE_MULTIPLE_OF"},
             {3, 4, "INDICES", "EXPONENTIAL", "VALUE_NOT_IN_LIST"},
             {3, 12, "TRIANGLES", "NONE", "VALUE_NOT_IN_LIST"},
             {300, 12, "ATTRIBUTES", "NONE", "MESHOPT_DATA_INVALID"},
             {1000000, 12, "ATTRIBUTES", "NONE", "MESHOPT_DATA_INVALID"},
             {100000000, 12, "ATTRIBUTES", "NONE", "DECOMPRESSED_DATA_TOO_LARGE"},
             {(size_t)1 << 45, 12, "ATTRIBUTES", "NONE", "DECOMPRESSED_DATA_TOO_LARGE"}};
  uint8_t to[1024];
  size_t size = meshopt_encodeVertexBuffer(to, sizeof to, grid.positions, 3, 12);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    begin();
    add_view(to, size, bad[i].count, bad[i].stride, 1, bad[i].mode, bad[i].filter);
    struct cdl_Scene *scene = load_three(5126, "VEC3");
    if (scene || !strstr(scene_errors, bad[i].code))
      print_message("%zu: wanted %s: %s\n", i, bad[i].code, scene_errors);
    assert_null(scene);
    assert_int_equal(scene_error_count, 1);
    assert_non_null(strstr(scene_errors, bad[i].code));
  }
}

static int set_up(void **state) {
  grid_make(&grid);
  return scene_folder_make(state);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_exact),
                                     cmocka_unit_test(test_filters),
                                     cmocka_unit_test(test_strip_and_instances),
                                     cmocka_unit_test(test_names),
                                     cmocka_unit_test(test_glb),
                                     cmocka_unit_test(test_many),
                                     cmocka_unit_test(test_refused)};
  return cmocka_run_group_tests(tests, set_up, scene_folder_remove);
}
