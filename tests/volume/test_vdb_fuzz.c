/* test_vdb_fuzz.c: volume files of every type and compression with bytes changed, cut and put
 * together at random. Whatever the library makes of them, the caller gets a grid or one line, in
 * time and within the memory that it allows. CDL_SOAK makes it twenty times as many. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>
#include <sys/resource.h>

#include "../unit/scene_text.h"
#include "core/clock.h"
#include "scene/document.h"
#include "scene/vdb.h"
#include "vdb_write.h"

enum { INPUTS = 2000, SIDE = 12, FILES = 32, ROOM = 128 << 20 };

typedef struct Whole {
  uint8_t *data;
  size_t size;
} Whole;

static Whole wholes[FILES];
static uint32_t whole_count;
static uint64_t seed = 1;

/* PCG: O'Neill 2014. */
static uint32_t below(uint32_t n) {
  uint64_t old = seed;
  seed = old * 6364136223846793005u + 1442695040888963407u;
  uint32_t x = (uint32_t)(((old >> 18) ^ old) >> 27), r = (uint32_t)(old >> 59);
  return (x >> r | x << (-r & 31)) % n;
}

static void add_whole(const char *type, uint32_t compression) {
  static float values[3 * SIDE * SIDE * SIDE];
  static uint8_t active[SIDE * SIDE * SIDE];
  const VdbTile tiles[2] = {{{16, 0, 0}, 8, 2}, {{128, 0, 0}, 128, 3}};
  char path[256];
  int error;
  for (size_t i = 0; i < sizeof values / sizeof *values; i++) values[i] = (float)below(100);
  for (size_t i = 0; i < sizeof active; i++) active[i] = below(3) > 0;
  VdbGrid grids[2] = {{.name = "density",
                       .type = type,
                       .low = {-3, 2, 5},
                       .size = {SIDE, SIDE, SIDE},
                       .values = values,
                       .active = active,
                       .tiles = tiles,
                       .tile_count = below(3),
                       .to_world = {0.1, 0, 0, 1, 0, 0.1, 0, 2, 0, 0, 0.1, 3}},
                      {.name = "other", .type = "bool"}};
  snprintf(path, sizeof path, "%s/whole.vdb", scene_folder);
  assert_true(vdb_write(path, grids, 1 + below(2), compression));
  Whole *to = &wholes[whole_count++];
  to->data = file_read(path, 1 << 24, &to->size, &error);
  assert_non_null(to->data);
}

static int make_wholes(void **state) {
  static const char *const types[] = {"float", "half",  "double", "int32",
                                      "int64", "vec3s", "vec3d"};
  static const uint32_t compressions[] = {VDB_NONE, VDB_ZIP | VDB_MASK, VDB_BLOSC | VDB_MASK,
                                          VDB_MASK};
  if (scene_folder_make(state)) return -1;
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    for (size_t k = 0; k < 4; k++) add_whole(types[i], compressions[k]);
  return 0;
}

static int free_wholes(void **state) {
  for (uint32_t i = 0; i < whole_count; i++) free(wholes[i].data);
  return scene_folder_remove(state);
}

/* A place in a file where a number that matters is likely: at its beginning, in its last part
 * (values), or anywhere. */
static size_t any_place(size_t size) {
  switch (below(4)) {
  case 0:
    return below(1200) % size;
  case 1:
    return size - 1 - below(12000) % size;
  default:
    return below((uint32_t)size);
  }
}

/* Changed bytes, lengths and counts; cut ends; the end of another file. */
static uint8_t *change(const Whole *from, size_t *size) {
  static const uint8_t extremes[] = {0, 1, 0x7f, 0x80, 0xff, 0xfe};
  const Whole *other = &wholes[below(whole_count)];
  uint8_t *bytes = malloc(from->size > other->size ? from->size : other->size);
  uint32_t how = below(16);
  *size = from->size;
  memcpy(bytes, from->data, *size);
  for (uint32_t i = below(8); i > 0; i--) {
    size_t at = any_place(*size), length = below(3) ? 1 : 1u << below(4);
    uint8_t with = extremes[below(sizeof extremes)];
    if (below(2)) with = (uint8_t)below(256);
    for (size_t k = at; k < at + length && k < *size; k++)
      bytes[k] = below(4) ? with : bytes[k] ^ (uint8_t)(1u << below(8));
  }
  if (how == 0) *size = any_place(*size) + 1;
  if (how == 1) {
    size_t at = any_place(*size < other->size ? *size : other->size);
    memcpy(bytes + at, other->data + at, other->size - at);
    *size = other->size;
  }
  return bytes;
}

static void test_whole(void **state) {
  (void)state;
  for (uint32_t i = 0; i < whole_count; i++) {
    GridSource source;
    char error[512];
    double background;
    cdl_Status status =
        vdb_load(wholes[i].data, wholes[i].size, "density", ROOM, &source, &background, error);
    assert_string_equal(error, "");
    assert_int_equal(status, CDL_OK);
    assert_true(source.leaf_count >= 8);
    grid_source_free(&source);
  }
}

typedef struct Counts {
  int loaded, refused, failed, late;
  double slowest;
} Counts;

static void load_one(Counts *counts, const uint8_t *data, size_t size) {
  GridSource source;
  char error[512];
  double background, start = clock_now();
  cdl_Status status = vdb_load(data, size, "density", ROOM, &source, &background, error);
  double seconds = clock_now() - start;
  assert_true(status == CDL_OK || (status == CDL_BAD_INPUT && *error));
  counts->slowest = fmax(counts->slowest, seconds);
  if (status == CDL_OK)
    counts->loaded++;
  else if (strstr(error, "its reader failed"))
    counts->failed++;
  else if (strstr(error, "takes too long"))
    counts->late++;
  else
    counts->refused++;
  if (status == CDL_OK) {
    uint32_t size_of_box[3];
    cdl_SceneGrid grid;
    const char *why;
    for (int k = 0; k < 3; k++) size_of_box[k] = (uint32_t)(source.high[k] - source.low[k]) + 1;
    if (!grid_build(&source, source.low, size_of_box, ROOM, &grid, &why))
      assert_true(grid.minimum >= 0 && grid.maximum >= grid.minimum);
    grid_free(&grid);
  }
  grid_source_free(&source);
}

static void test_changed(void **state) {
  (void)state;
  Counts counts = {0};
  struct rusage mine, children;
  int inputs = getenv("CDL_SOAK") ? 20 * INPUTS : INPUTS;
  for (int i = 0; i < inputs; i++) {
    size_t size;
    uint8_t *data = change(&wholes[below(whole_count)], &size);
    load_one(&counts, data, size);
    free(data);
  }
  getrusage(RUSAGE_SELF, &mine);
  getrusage(RUSAGE_CHILDREN, &children);
  print_message("%d loaded, %d refused, %d brought the reader down, %d took too long; the slowest "
                "in %.2f s, %ld and %ld MB at most\n",
                counts.loaded, counts.refused, counts.failed, counts.late, counts.slowest,
                mine.ru_maxrss / 1024, children.ru_maxrss / 1024);
  assert_true(counts.loaded > inputs / 20 && counts.refused > inputs / 20);
#if !defined(__SANITIZE_ADDRESS__) /* which is slow, and keeps what is freed */
  assert_true(counts.slowest < 5);
  assert_true(mine.ru_maxrss < 1 << 20 && children.ru_maxrss < 1 << 20);
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_whole), cmocka_unit_test(test_changed)};
  return cmocka_run_group_tests(tests, make_wholes, free_wholes);
}
