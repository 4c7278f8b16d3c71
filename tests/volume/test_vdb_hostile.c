/* test_vdb_hostile.c: volume files that ask for too much, or end too early, loaded with 1 GiB of
 * memory and 5 s. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../bad_input/bad_child.h"
#include "../unit/scene_text.h"
#include "scene/document.h"
#include "vdb_write.h"

/* A scene of `count` materials whose media name the grid. */
static const char *scene_path(int count) {
  static char path[256], text[1 << 18];
  int n = sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"CDL_medium\"],"
                        "\"materials\":[");
  for (int i = 0; i < count; i++)
    n += sprintf(text + n, "%s{\"extensions\":{\"CDL_medium\":{\"grid\":{\"uri\":\"a.vdb\"}}}}",
                 i ? "," : "");
  n += sprintf(text + n, "]}");
  scene_write("scene.gltf", text, (size_t)n);
  snprintf(path, sizeof path, "%s/scene.gltf", scene_folder);
  return path;
}

static void write_file(const VdbTile *tiles, uint32_t count) {
  VdbGrid grid = {.name = "density", .type = "float", .tiles = tiles, .tile_count = count};
  char path[256];
  snprintf(path, sizeof path, "%s/a.vdb", scene_folder);
  assert_true(vdb_write(path, &grid, 1, VDB_BLOSC | VDB_MASK));
}

enum { TILES = 16 };

static VdbTile tiles[TILES * TILES * TILES];

static void fill_tiles(int differ) {
  for (int i = 0; i < TILES * TILES * TILES; i++)
    tiles[i] = (VdbTile){{i % TILES * 128, i / TILES % TILES * 128, i / TILES / TILES * 128},
                         128,
                         differ ? (float)(1 + i) : 1};
  write_file(tiles, TILES * TILES * TILES);
}

/* The largest box: what is alike takes no room. */
static void test_full(void **state) {
  (void)state;
  fill_tiles(0);
  assert_true(is_accepted(scene_path(1)));
}

/* 12 kB that would be 9 GB. */
static void test_bomb(void **state) {
  (void)state;
  fill_tiles(1);
  assert_true(is_refused(scene_path(1), "GRID_DATA_INVALID"));
}

static void test_far_apart(void **state) {
  (void)state;
  const VdbTile apart[2] = {{{-(1 << 27), 0, 0}, 8, 1}, {{1 << 27, 0, 1 << 27}, 8, 1}};
  const VdbTile beyond = {{INT32_MAX - 4095, INT32_MAX - 4095, 0}, 4096, 1};
  write_file(apart, 2);
  assert_true(is_refused(scene_path(1), "GRID_DATA_INVALID"));
  write_file(&beyond, 1);
  assert_true(is_refused(scene_path(1), "GRID_DATA_INVALID"));
}

static void test_many_media(void **state) {
  (void)state;
  const VdbTile one = {{0, 0, 0}, 8, 1};
  write_file(&one, 1);
  assert_true(is_accepted(scene_path(3000)));
}

/* Cut short anywhere: there is nothing behind the voxels that could be missing. */
static void test_cut(void **state) {
  (void)state;
  static float values[20 * 20 * 20];
  VdbGrid grid = {.name = "density", .type = "float", .size = {20, 20, 20}, .values = values};
  char path[256];
  size_t size;
  int error;
  for (int i = 0; i < 8000; i++) values[i] = (float)(i % 17);
  snprintf(path, sizeof path, "%s/a.vdb", scene_folder);
  assert_true(vdb_write(path, &grid, 1, VDB_BLOSC | VDB_MASK));
  uint8_t *data = file_read(path, 1 << 24, &size, &error);
  assert_non_null(data);
  const char *scene = scene_path(1);
  for (size_t cut = 0; cut < size; cut += 64 * (1 + size / 16384)) {
    scene_write("a.vdb", data, cut);
    assert_true(is_refused(scene, "GRID_DATA_INVALID"));
  }
  free(data);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_full), cmocka_unit_test(test_bomb),
                                     cmocka_unit_test(test_far_apart),
                                     cmocka_unit_test(test_many_media), cmocka_unit_test(test_cut)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
