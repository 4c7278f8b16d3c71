/* test_vdb.c: volume files that the library wrote, against the voxels that went into them, and the
 * media of scenes that name them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include <jansson.h>

#include "../unit/scene_text.h"
#include "abi/types.h"
#include "scene/matrix.h"
#include "vdb_write.h"

enum { SX = 21, SY = 13, SZ = 30 };

static float values[3 * SX * SY * SZ];
static uint8_t active[SX * SY * SZ];
static const int32_t first[3] = {-5, 3, 11};

/* Small integers, which every type holds. */
static void fill(uint32_t channels) {
  for (size_t i = 0; i < SX * SY * SZ; i++) {
    active[i] = i * 2654435761u % 7 > 2 || i == 0 || i + 1 == SX * SY * SZ;
    for (uint32_t c = 0; c < channels; c++)
      values[channels * i + c] = (float)((i * 31 + c * 17) % 100);
  }
}

static VdbGrid whole(const char *name, const char *type) {
  return (VdbGrid){.name = name,
                   .type = type,
                   .low = {first[0], first[1], first[2]},
                   .size = {SX, SY, SZ},
                   .values = values,
                   .active = active};
}

static void write_file(const char *name, const VdbGrid *grids, uint32_t count, uint32_t how) {
  char path[256];
  snprintf(path, sizeof path, "%s/%s", scene_folder, name);
  assert_true(vdb_write(path, grids, count, how));
}

/* A scene that is filled with a medium of this grid. */
static struct cdl_Scene *scene_with(const char *grid) {
  return scene_from("{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"CDL_medium\"],"
                    "\"scene\":0,\"scenes\":[{\"extensions\":{\"CDL_medium\":{\"scattering\":1,"
                    "\"grid\":{%s}}}}]}",
                    grid);
}

static float value_of(const cdl_SceneGrid *grid, uint32_t c, uint32_t x, uint32_t y, uint32_t z) {
  uint32_t number =
      grid->table[((size_t)(z / 8) * grid->bricks[1] + y / 8) * grid->bricks[0] + x / 8];
  if (number == CDL_NONE) return 0;
  return grid->values[((size_t)number * grid->channels + c) * GRID_VALUES +
                      ((size_t)(z % 8) * 9 + y % 8) * 9 + x % 8];
}

static void check_values(const cdl_SceneGrid *grid, uint32_t channels) {
  uint64_t count = 0;
  assert_int_equal(grid->channels, channels);
  assert_true(grid->size[0] == SX && grid->size[1] == SY && grid->size[2] == SZ);
  assert_memory_equal(grid->low, first, sizeof first);
  for (uint32_t i = 0; i < SX * SY * SZ; i++) {
    uint32_t x = i % SX, y = i / SX % SY, z = i / SX / SY;
    count += active[i];
    for (uint32_t c = 0; c < channels; c++)
      assert_true(value_of(grid, c, x, y, z) == (active[i] ? values[channels * i + c] : 0));
  }
  assert_int_equal(grid->active, count);
}

/* Every type, in every compression, as density or colour. */
static void test_types(void **state) {
  (void)state;
  static const struct {
    const char *type;
    uint32_t channels;
  } types[] = {{"float", 1}, {"half", 1},  {"double", 1}, {"int32", 1},
               {"int64", 1}, {"vec3s", 3}, {"vec3d", 3}};
  static const uint32_t compressions[] = {
      VDB_NONE, VDB_ZIP, VDB_ZIP | VDB_MASK, VDB_MASK, VDB_BLOSC | VDB_MASK, VDB_BLOSC};
  for (size_t t = 0; t < sizeof types / sizeof *types; t++)
    for (size_t k = 0; k < sizeof compressions / sizeof *compressions; k++) {
      int colour = types[t].channels == 3;
      VdbGrid grids[2] = {whole("thing", types[t].type), whole("density", "float")};
      fill(types[t].channels);
      write_file("a.vdb", grids, colour ? 2 : 1, compressions[k]);
      struct cdl_Scene *scene = scene_with(colour ? "\"uri\":\"a.vdb\",\"color\":\"thing\""
                                                  : "\"uri\":\"a.vdb\",\"density\":\"thing\"");
      if (!scene) print_message("%s: %s", types[t].type, scene_errors);
      assert_non_null(scene);
      const cdl_SceneMedium *medium = &scene->media[scene->medium];
      check_values(&scene->grids[colour ? medium->color : medium->density], types[t].channels);
      scene_free(scene);
    }
}

/* As many leaves as a large file has: 20^3, read in more than one piece. */
static void test_large(void **state) {
  (void)state;
  enum { SIDE = 160 };
  float *large = malloc(sizeof(float) * SIDE * SIDE * SIDE);
  assert_non_null(large);
  for (uint32_t i = 0; i < SIDE * SIDE * SIDE; i++) large[i] = (float)(1 + i % 8191);
  VdbGrid grid = {.name = "density", .type = "float", .size = {SIDE, SIDE, SIDE}, .values = large};
  write_file("a.vdb", &grid, 1, VDB_BLOSC | VDB_MASK);
  struct cdl_Scene *scene = scene_with("\"uri\":\"a.vdb\"");
  if (!scene) print_message("%s", scene_errors);
  assert_non_null(scene);
  assert_int_equal(scene->grids[0].active, SIDE * SIDE * SIDE);
  for (uint32_t i = 0; i < SIDE * SIDE * SIDE; i += 37)
    assert_true(value_of(&scene->grids[0], 0, i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE) ==
                large[i]);
  scene_free(scene);
  free(large);
}

static void check_point(const double matrix[12], const double from[3], const double to[3]) {
  Matrix m;
  double got[3];
  memcpy(m.m, matrix, sizeof m.m);
  matrix_apply(&m, from, 1, got);
  for (int k = 0; k < 3; k++) assert_true(fabs(got[k] - to[k]) < 1e-9);
}

/* A turned, sheared and moved grid: voxel (i, j, k) of the file has its centre at M (i, j, k). */
static void test_transform(void **state) {
  (void)state;
  VdbGrid grid = whole("density", "float");
  const double to_world[12] = {0.1, -0.2, 0, 4, 0.3, 0.1, 0.05, -5, 0, 0.02, 0.4, 6};
  memcpy(grid.to_world, to_world, sizeof to_world);
  fill(1);
  write_file("a.vdb", &grid, 1, VDB_BLOSC | VDB_MASK);
  struct cdl_Scene *scene = scene_with("\"uri\":\"a.vdb\"");
  assert_non_null(scene);
  Matrix m;
  memcpy(m.m, to_world, sizeof m.m);
  for (uint32_t i = 0; i < 8; i++) {
    const double voxel[3] = {i & 1 ? SX : 0, i & 2 ? SY : 0, i & 4 ? SZ : 0};
    const double stored[3] = {voxel[0] + first[0], voxel[1] + first[1], voxel[2] + first[2]};
    double world[3];
    matrix_apply(&m, stored, 1, world);
    check_point(scene->media[0].to_index, world, voxel);
  }
  scene_free(scene);
}

/* Bounds are the outer faces of the index box, wherever the file's own transform puts it. */
static void test_bounds(void **state) {
  (void)state;
  VdbGrid grid = whole("density", "float");
  fill(1);
  write_file("a.vdb", &grid, 1, VDB_MASK);
  struct cdl_Scene *scene = scene_with("\"uri\":\"a.vdb\",\"bounds\":[[-1,2,3.5],[1,2.25,13.5]]");
  assert_non_null(scene);
  const double low[3] = {-1, 2, 3.5}, high[3] = {1, 2.25, 13.5};
  check_point(scene->media[0].to_index, low, (double[3]){-0.5, -0.5, -0.5});
  check_point(scene->media[0].to_index, high, (double[3]){SX - 0.5, SY - 0.5, SZ - 0.5});
  scene_free(scene);
}

/* Grids of one medium lie over one box, that of the density and of the temperature, so that what is
 * hot outside of what is dense is there as well. */
static void test_several(void **state) {
  (void)state;
  const VdbTile tile = {{-8, 0, 8}, 8, 900};
  VdbGrid grids[3] = {whole("density", "float"),
                      {.name = "heat", .type = "float", .tiles = &tile, .tile_count = 1},
                      {.name = "paint", .type = "vec3s", .tiles = &tile, .tile_count = 1}};
  fill(1);
  write_file("a.vdb", grids, 3, VDB_MASK);
  struct cdl_Scene *scene = scene_from(
      "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"CDL_medium\"],\"materials\":["
      "{\"extensions\":{\"CDL_medium\":{\"grid\":{\"uri\":\"a.vdb\",\"temperature\":\"heat\","
      "\"temperatureScale\":2,\"color\":\"paint\"}}}},"
      "{\"extensions\":{\"CDL_medium\":{\"grid\":{\"uri\":\"a.vdb\",\"temperature\":null}}}}]}");
  if (!scene) print_message("%s", scene_errors);
  assert_non_null(scene);
  assert_int_equal(scene->grid_count, 4); /* the density over its own box, too */
  const cdl_SceneMedium *a = &scene->media[0], *b = &scene->media[1];
  assert_int_not_equal(a->density, b->density);
  assert_true(b->temperature == CDL_NONE && b->color == CDL_NONE);
  assert_true(a->temperature_scale == 2);
  const cdl_SceneGrid *heat = &scene->grids[a->temperature];
  const cdl_SceneGrid *dense = &scene->grids[a->density], *paint = &scene->grids[a->color];
  const int32_t size[3] = {SX, SY, SZ}, corner[3] = {-8, 0, 8};
  for (int k = 0; k < 3; k++) {
    int32_t low = first[k] < corner[k] ? first[k] : corner[k];
    int32_t end = first[k] + size[k] > corner[k] + 8 ? first[k] + size[k] : corner[k] + 8;
    assert_int_equal(heat->low[k], low);
    assert_int_equal(heat->size[k], end - low);
    assert_true(dense->low[k] == low && dense->size[k] == heat->size[k]);
    assert_true(paint->low[k] == low && paint->size[k] == heat->size[k]);
  }
  assert_int_equal(paint->channels, 3);
  for (uint32_t z = 0; z < heat->size[2]; z++)
    for (uint32_t y = 0; y < heat->size[1]; y++)
      for (uint32_t x = 0; x < heat->size[0]; x++) {
        int32_t at[3] = {heat->low[0] + (int32_t)x, heat->low[1] + (int32_t)y,
                         heat->low[2] + (int32_t)z};
        int hot = 1, in = 1;
        for (int k = 0; k < 3; k++) {
          hot &= at[k] >= corner[k] && at[k] < corner[k] + 8;
          in &= at[k] >= first[k] && at[k] < first[k] + size[k];
        }
        assert_true(value_of(heat, 0, x, y, z) == (hot ? 900 : 0));
        float own = in ? value_of(&scene->grids[b->density], 0, (uint32_t)(at[0] - first[0]),
                                  (uint32_t)(at[1] - first[1]), (uint32_t)(at[2] - first[2]))
                       : 0;
        assert_true(value_of(dense, 0, x, y, z) == own);
      }
  scene_free(scene);
}

static void check_refused(const char *grid, const char *words) {
  struct cdl_Scene *scene = scene_with(grid);
  if (scene || !strstr(scene_errors, words)) print_message("%s: %s", words, scene_errors);
  assert_null(scene);
  assert_int_equal(scene_status, CDL_BAD_INPUT);
  assert_int_equal(scene_error_count, 1);
  assert_non_null(strstr(scene_errors, words));
}

static void test_refused(void **state) {
  (void)state;
  static float odd[8] = {1, NAN, 3, 4, 5, 6, 7, 8};
  static const VdbTile wide = {{0, 0, 0}, 4096, 1};
  VdbGrid grids[] = {
      whole("density", "float"),
      {.name = "set", .type = "float", .size = {2, 2, 2}, .values = odd, .level_set = 1},
      {.name = "cone", .type = "float", .size = {2, 2, 2}, .values = odd, .frustum = 1},
      {.name = "odd", .type = "float", .size = {2, 2, 2}, .values = odd},
      {.name = "bool", .type = "bool"},
      {.name = "empty", .type = "float"},
      {.name = "wide", .type = "float", .tiles = &wide, .tile_count = 1},
      {.name = "paint", .type = "vec3s", .size = {1, 1, 1}, .values = odd + 2},
      whole("moved", "float")};
  const double moved[12] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0};
  memcpy(grids[8].to_world, moved, sizeof moved);
  fill(1);
  write_file("a.vdb", grids, sizeof grids / sizeof *grids, VDB_MASK);
  scene_write("b.vdb", "nothing", 7);
  check_refused("\"uri\":\"a.vdb\",\"density\":\"fog\"", "no grid of that name, but density, set,");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"set\"", "a.vdb: grid set: it is a level set");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"cone\"", "not linear (a frustum)");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"odd\"", "grid odd: a value is not finite");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"bool\"", "its type is Tree_bool_5_4_3");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"empty\"", "no active voxels");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"wide\"", "box of more than 2048^3");
  check_refused("\"uri\":\"a.vdb\",\"density\":\"paint\"", "it has three channels");
  check_refused("\"uri\":\"a.vdb\",\"temperature\":\"paint\"", "it has three channels");
  check_refused("\"uri\":\"a.vdb\",\"color\":\"density\"", "a colour has three");
  check_refused("\"uri\":\"a.vdb\",\"temperature\":\"moved\"", "not that of the density");
  check_refused("\"uri\":\"b.vdb\"", "b.vdb: grid density:");
  check_refused("\"uri\":\"c.vdb\"", "cannot be found");
  check_refused("\"uri\":\"../a.vdb\"", "IO_ERROR");
  check_refused("\"uri\":\"http://a/a.vdb\"", "NON_RELATIVE_URI");
  check_refused("\"uri\":\"a.vdb\",\"bounds\":[[0,0,0],[1,0,1]]", "VALUE_NOT_IN_RANGE");
  check_refused("\"uri\":\"a.vdb\",\"bounds\":[[0,0],[1,1]]", "TYPE_MISMATCH");
}

/* What is odd is noted, and counts as 0. */
static void test_noted(void **state) {
  (void)state;
  static float odd[8] = {1, -2, 3, 4, -0.5f, 6, 7, 8};
  VdbGrid grid = {
      .name = "density", .type = "float", .size = {2, 2, 2}, .values = odd, .background = 0.25f};
  write_file("a.vdb", &grid, 1, VDB_MASK);
  struct cdl_Scene *scene = scene_with("\"uri\":\"a.vdb\"");
  assert_non_null(scene);
  assert_non_null(strstr(scene_notes, "2 values below 0, down to -2, count as 0"));
  assert_non_null(strstr(scene_notes, "its background is 0.25"));
  assert_true(scene->grids[0].minimum == 0 && scene->grids[0].maximum == 8);
  scene_free(scene);
}

static void test_info(void **state) {
  (void)state;
  VdbGrid grid = whole("density", "float");
  fill(1);
  write_file("a.vdb", &grid, 1, VDB_MASK);
  struct cdl_Scene *scene = scene_with("\"uri\":\"a.vdb\"");
  assert_non_null(scene);
  char *text = cdl_scene_info_json(scene);
  json_t *json = json_loads(text, 0, NULL);
  const json_t *told = json_array_get(json_object_get(json, "grids"), 0);
  assert_string_equal(json_string_value(json_object_get(told, "file")), "a.vdb");
  assert_string_equal(json_string_value(json_object_get(told, "name")), "density");
  assert_int_equal(json_integer_value(json_array_get(json_object_get(told, "size"), 2)), SZ);
  assert_int_equal(json_integer_value(json_object_get(told, "active_voxels")),
                   scene->grids[0].active);
  assert_true(json_number_value(json_array_get(json_object_get(told, "range"), 1)) == 99);
  json_decref(json);
  free(text);
  text = cdl_scene_info_text(scene);
  assert_non_null(strstr(text, "a.vdb: density, 21 x 13 x 30, 0 to 99"));
  free(text);
  scene_free(scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_types),     cmocka_unit_test(test_large),
      cmocka_unit_test(test_transform), cmocka_unit_test(test_bounds),
      cmocka_unit_test(test_several),   cmocka_unit_test(test_refused),
      cmocka_unit_test(test_noted),     cmocka_unit_test(test_info)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
