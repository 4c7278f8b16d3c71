/* test_draco.c: meshes that the library's own encoder compressed come back, by both of its methods;
 * streams that are not what they say are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../unit/scene_text.h"
#include "draco_encode.h"
#include "grid.h"

enum { POSITION, NORMAL, TANGENT, UV, COLOR, JOINTS, WEIGHTS, SOURCES };

static Grid grid;
static uint16_t joints[POINTS][4];
static uint8_t weights[POINTS][4];
static uint8_t stream[1 << 19];
static DracoSource sources[SOURCES];

static void describe(int bits) {
  const DracoSource all[SOURCES] = {{0, 5126, 3, 0, bits, grid.positions, 0},
                                    {1, 5126, 3, 0, bits, grid.normals, 0},
                                    {4, 5126, 4, 0, bits, grid.tangents, 0},
                                    {3, 5126, 2, 0, bits, grid.uv, 0},
                                    {2, 5121, 4, 1, 0, grid.colors, 0},
                                    {4, 5123, 4, 0, 0, joints, 0},
                                    {4, 5121, 4, 1, 0, weights, 0}};
  memcpy(sources, all, sizeof all);
}

static size_t encode(int edgebreaker, int bits) {
  describe(bits);
  size_t size = draco_encode((const uint32_t(*)[3])grid.indices, FACES, POINTS, sources, SOURCES,
                             edgebreaker, edgebreaker, stream, sizeof stream);
  assert_true(size > 0);
  return size;
}

#define SKIN ",{\"children\":[2]},{\"translation\":[0,0,0]}],\"skins\":[{\"joints\":[1,2]}"

/* A scene whose accessors have no bufferView but for what `more` adds to the first. */
static struct cdl_Scene *load(size_t size, int points, int indices, int index_type, int mode,
                              const char *more) {
  scene_write("mesh.bin", stream, size);
  return scene_from(
      "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
      "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"scenes\":[{\"nodes\":[0,1]}],"
      "\"nodes\":[{\"mesh\":0,\"skin\":0}" SKIN "],\"meshes\":[{\"primitives\":[{\"attributes\":{"
      "\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":2,\"TEXCOORD_0\":3,\"COLOR_0\":4,\"JOINTS_0\":5,"
      "\"WEIGHTS_0\":6},\"indices\":7,\"mode\":%d,\"extensions\":{\"KHR_draco_mesh_compression\":{"
      "\"bufferView\":0,\"attributes\":{\"POSITION\":%u,\"NORMAL\":%u,\"TANGENT\":%u,"
      "\"TEXCOORD_0\":%u,\"COLOR_0\":%u,\"JOINTS_0\":%u,\"WEIGHTS_0\":%u}}}}]}],\"accessors\":["
      "{\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\",\"min\":[0,0,-0.25],"
      "\"max\":[1,1,0.25]%s},{\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
      "{\"componentType\":5126,\"count\":%d,\"type\":\"VEC4\"},"
      "{\"componentType\":5126,\"count\":%d,\"type\":\"VEC2\"},"
      "{\"componentType\":5121,\"normalized\":true,\"count\":%d,\"type\":\"VEC4\"},"
      "{\"componentType\":5123,\"count\":%d,\"type\":\"VEC4\"},"
      "{\"componentType\":5121,\"normalized\":true,\"count\":%d,\"type\":\"VEC4\"},"
      "{\"componentType\":%d,\"count\":%d,\"type\":\"SCALAR\"}],"
      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],"
      "\"buffers\":[{\"uri\":\"mesh.bin\",\"byteLength\":%zu}]}",
      mode, sources[0].id, sources[1].id, sources[2].id, sources[3].id, sources[4].id,
      sources[5].id, sources[6].id, points, more, points, points, points, points, points, points,
      index_type, indices, size, size);
}

static struct cdl_Scene *must(struct cdl_Scene *scene) {
  if (scene_status) print_message("%s", scene_errors);
  assert_int_equal(scene_status, CDL_OK);
  return scene;
}

/* Which of the original's points this is: the stream may have them in any order. */
static int nearest(const float *p) {
  int k = (int)lrint(p[0] * (SIDE - 1)), i = (int)lrint(p[1] * (SIDE - 1));
  return i < 0 || i >= SIDE || k < 0 || k >= SIDE ? -1 : i * SIDE + k;
}

static void check_point(const cdl_SceneMesh *mesh, int i, int n, double step) {
  double tangent = grid_difference(mesh->tangents + 4 * i, grid.tangents[n], 3);
  assert_true(grid_difference(mesh->positions + 3 * i, grid.positions[n], 3) <= step);
  assert_true(grid_difference(mesh->normals + 3 * i, grid.normals[n], 3) <= 4 * step + 1e-6);
  assert_true(tangent <= 4 * step + 1e-6);
  assert_true(mesh->tangents[4 * i + 3] == grid.tangents[n][3]);
  assert_true(grid_difference(mesh->uv[0] + 2 * i, grid.uv[n], 2) <= 2 * step);
  for (int c = 0; c < 4; c++)
    assert_true(fabsf(mesh->colors[4 * i + c] - grid.colors[n][c] / 255.0f) < 1e-6f);
}

static int compare_faces(const void *a, const void *b) { return memcmp(a, b, 12); }

/* The triangles, in any order, each from its least corner on. */
static void sort_faces(uint32_t (*faces)[3]) {
  for (int t = 0; t < FACES; t++) {
    uint32_t *f = faces[t], least = f[0] < f[1] ? f[0] : f[1];
    if (f[2] < least) least = f[2];
    while (f[0] != least) {
      uint32_t first = f[0];
      f[0] = f[1], f[1] = f[2], f[2] = first;
    }
  }
  qsort(faces, FACES, sizeof *faces, compare_faces);
}

static void check_mesh(const struct cdl_Scene *scene, double step) {
  static uint32_t got[FACES][3], wanted[FACES][3];
  static int seen[POINTS];
  const cdl_SceneMesh *mesh = &scene->meshes[0];
  memset(seen, 0, sizeof seen);
  assert_int_equal(mesh->vertex_count, POINTS);
  assert_int_equal(mesh->triangle_count, FACES);
  for (int i = 0; i < POINTS; i++) {
    int n = nearest(mesh->positions + 3 * i);
    assert_true(n >= 0 && !seen[n]);
    seen[n] = 1;
    check_point(mesh, i, n, step);
  }
  for (int t = 0; t < FACES; t++)
    for (int k = 0; k < 3; k++)
      got[t][k] = (uint32_t)nearest(mesh->positions + 3 * mesh->indices[3 * t + k]);
  memcpy(wanted, grid.indices, sizeof wanted);
  sort_faces(got);
  sort_faces(wanted);
  assert_memory_equal(got, wanted, sizeof got);
}

/* Quantised to 14 bits, half a step of the longest side; without, exact but for the normalising. */
static void test_methods(void **state) {
  (void)state;
  for (int edgebreaker = 0; edgebreaker < 2; edgebreaker++)
    for (int bits = 0; bits <= 14; bits += 14) {
      size_t size = encode(edgebreaker, bits);
      print_message("%zu bytes for %zu\n", size, sizeof grid + sizeof joints + sizeof weights);
      struct cdl_Scene *scene = must(load(size, POINTS, 3 * FACES, 5123, 4, ""));
      check_mesh(scene, bits ? 1.0 / (1 << bits) : 1e-7);
      scene_free(scene);
    }
}

/* The sequential method keeps the order of vertices and triangles. */
static void test_order(void **state) {
  (void)state;
  struct cdl_Scene *scene = must(load(encode(0, 0), POINTS, 3 * FACES, 5125, 4, ""));
  assert_memory_equal(scene->meshes[0].indices, grid.indices, sizeof grid.indices);
  assert_true(grid_difference(scene->meshes[0].positions, grid.positions[0], 3 * POINTS) == 0);
  scene_free(scene);
}

/* As a strip the decoder's triangles are shown; the accessor says how long the strip is. */
static void test_strip(void **state) {
  (void)state;
  struct cdl_Scene *scene = must(load(encode(1, 14), POINTS, FACES + 200, 5123, 5, ""));
  check_mesh(scene, 1.0 / (1 << 14));
  scene_free(scene);
}

/* Two primitives may show the same stream through the same accessors: it is decoded once. Accessors
 * of two different streams are refused; so is an attribute that the primitive does not have. */
static void test_shared(void **state) {
  (void)state;
  static const char *const more[] = {"\"POSITION\":0", "\"POSITION\":0", "\"NORMAL\":0"};
  size_t size = encode(1, 11);
  scene_write("mesh.bin", stream, size);
  for (int i = 0; i < 3; i++) {
    struct cdl_Scene *scene = scene_from(
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":["
        "{\"attributes\":{\"POSITION\":0},\"indices\":1,\"extensions\":{"
        "\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{\"POSITION\":0}}}},"
        "{\"attributes\":{\"POSITION\":0},\"indices\":1,\"extensions\":{"
        "\"KHR_draco_mesh_compression\":{\"bufferView\":%d,\"attributes\":{%s}}}}]}],"
        "\"accessors\":[{\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,1]},{\"componentType\":5123,\"count\":%d,"
        "\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},"
        "{\"buffer\":0,\"byteLength\":%zu}],\"buffers\":[{\"uri\":\"mesh.bin\","
        "\"byteLength\":%zu}]}",
        i == 1, more[i], POINTS, 3 * FACES, size, size, size);
    assert_int_equal(scene != NULL, i == 0);
    if (!scene) assert_non_null(strstr(scene_errors, i == 1 ? "another" : "UNRESOLVED_REFERENCE"));
    if (scene) assert_int_equal(scene->meshes[1].triangle_count, FACES);
    scene_free(scene);
  }
}

static void refused(struct cdl_Scene *scene, const char *words) {
  if (scene || !strstr(scene_errors, words))
    print_message("wanted %s: %s\n", words, scene ? "a scene" : scene_errors);
  assert_null(scene);
  assert_int_equal(scene_error_count, 1);
  assert_non_null(strstr(scene_errors, words));
}

static void test_refused(void **state) {
  (void)state;
  size_t size = encode(1, 12);
  refused(load(size, POINTS + 1, 3 * FACES, 5123, 4, ""), "not as many vertices");
  refused(load(size, POINTS, 3 * FACES - 3, 5123, 4, ""), "more triangles");
  refused(load(size, POINTS, 3 * FACES + 3, 5123, 4, ""), "indices are declared");
  refused(load(size, POINTS, 3 * FACES, 5121, 4, ""), "does not fit");
  refused(load(size, POINTS, 3 * FACES, 5122, 4, ""), "INDICES_ACCESSOR_INVALID_FORMAT");
  refused(load(size, POINTS, 3 * FACES, 5126, 4, ""), "INDICES_ACCESSOR_INVALID_FORMAT");
  refused(load(size, POINTS, 3 * FACES, 5123, 6, ""), "/mode: VALUE_NOT_IN_LIST");
  refused(load(size / 2, POINTS, 3 * FACES, 5123, 4, ""), "DRACO_DATA_INVALID");
  refused(load(3, POINTS, 3 * FACES, 5123, 4, ""), "DRACO_DATA_INVALID");
  sources[UV].id = 99;
  refused(load(size, POINTS, 3 * FACES, 5123, 4, ""), "lacks an attribute");
  sources[UV].id = sources[NORMAL].id;
  refused(load(size, POINTS, 3 * FACES, 5123, 4, ""), "components");
  stream[5] = 1;
  refused(load(size, POINTS, 3 * FACES, 5123, 4, ""), "version");
}

/* A stream of a few bytes that says it holds 10^9 triangles, and a scene that says so as well. */
static void test_bombs(void **state) {
  (void)state;
  describe(0);
  static const uint8_t head[] = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0};
  static const uint8_t counts[] = {0x80, 0x94, 0xeb, 0xdc, 0x03, 0x80,
                                   0x94, 0xeb, 0xdc, 0x03, 1,    0};
  memcpy(stream, head, sizeof head);
  for (int edgebreaker = 0; edgebreaker < 2; edgebreaker++) {
    stream[8] = (uint8_t)edgebreaker;
    size_t at = sizeof head;
    if (edgebreaker) stream[at++] = 0;
    memcpy(stream + at, counts, sizeof counts);
    refused(load(at + sizeof counts, 1000000000, 2000000000, 5125, 4, ""), "more triangles");
    refused(load(at + sizeof counts, 1000000000, 2147483646, 5125, 5, ""), "more memory");
  }
}

/* Metadata within metadata, each with as many as there are bytes: the library takes memory for the
 * square of the file's size. Then the same far down, and cut short. */
static void test_metadata_bomb(void **state) {
  (void)state;
  enum { LEVELS = 900, SIZE = 400000 };
  static const uint8_t head[] = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0x80, 0 /* attributes */};
  describe(0);
  for (int deep = 0; deep < 2; deep++) {
    const uint8_t level[] = {0, 0x80 | (deep ? 1 : 0), 0x80, deep ? 0 : 20, 0};
    memset(stream, 0, SIZE);
    memcpy(stream, head, sizeof head);
    for (int i = 0; i < LEVELS; i++) memcpy(stream + sizeof head + 5 * i, level, sizeof level);
    refused(load(SIZE, POINTS, 3 * FACES, 5123, 4, ""), "too much metadata");
    refused(load(30, POINTS, 3 * FACES, 5123, 4, ""), "cut short");
  }
}

static int set_up(void **state) {
  grid_make(&grid);
  for (int i = 0; i < POINTS; i++)
    joints[i][0] = i % 2, weights[i][0] = (uint8_t)(255 - i % 200), weights[i][1] = i % 200;
  return scene_folder_make(state);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_methods),      cmocka_unit_test(test_order),
      cmocka_unit_test(test_strip),        cmocka_unit_test(test_shared),
      cmocka_unit_test(test_refused),      cmocka_unit_test(test_bombs),
      cmocka_unit_test(test_metadata_bomb)};
  return cmocka_run_group_tests(tests, set_up, scene_folder_remove);
}
