/* test_scene_hostile.c: files made to break a reader. Each is refused with one line and the code
 * that fits, within 5 s and 1 GiB; what is only odd loads. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../unit/scene_text.h"
#include "bad_child.h"

#define HEAD "{\"asset\":{\"version\":\"2.0\"},"

static const char *path_of(const char *name) {
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", scene_folder, name);
  return path;
}

static const char *written(const char *text) {
  scene_write("hostile.gltf", text, strlen(text));
  return path_of("hostile.gltf");
}

/* A triangle whose parts can be replaced: accessors, bufferViews, byteLength, data and node. */
typedef struct Parts {
  const char *accessors, *views, *length, *node, *primitive, *more;
  const void *data;
  size_t size;
} Parts;

static const float triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

#define POSITIONS                                                                                  \
  "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"        \
  "\"max\":[1,1,0]}"

static const char *assembled(Parts p) {
  static char text[1 << 17];
  if (!p.data) p.data = triangle, p.size = sizeof triangle;
  char length[32];
  snprintf(length, sizeof length, "%zu", p.size);
  snprintf(text, sizeof text,
           HEAD "%s\"nodes\":[{\"mesh\":0%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                "\"POSITION\":0}%s}]}],\"accessors\":[%s],\"bufferViews\":[%s],\"buffers\":[{"
                "\"byteLength\":%s,\"uri\":\"%s\"}]}",
           p.more ? p.more : "", p.node ? p.node : "", p.primitive ? p.primitive : "",
           p.accessors ? p.accessors : POSITIONS,
           p.views ? p.views : "{\"buffer\":0,\"byteLength\":36}", p.length ? p.length : length,
           scene_data(p.data, p.size));
  return written(text);
}

static void test_sound(void **state) {
  (void)state;
  assert_true(is_accepted(assembled((Parts){0})));
}

#define ACCESSOR(view, offset, count)                                                              \
  "{\"bufferView\":" view ",\"byteOffset\":" offset ",\"componentType\":5126,\"count\":" count     \
  ",\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}"
#define SPARSE(count, indices, values)                                                             \
  "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0],"         \
  "\"sparse\":{\"count\":" count ",\"indices\":{\"bufferView\":" indices                           \
  ",\"componentType\":5123},\"values\":{\"bufferView\":" values "}}}"

static void test_ranges(void **state) {
  (void)state;
  static const uint16_t high[18] = {0, 60000};
  static const struct {
    Parts parts;
    const char *code;
  } cases[] = {
      {{.accessors = ACCESSOR("0", "0", "4")}, "ACCESSOR_TOO_LONG"},
      {{.accessors = ACCESSOR("0", "0", "0")}, "VALUE_NOT_IN_RANGE"},
      {{.accessors = ACCESSOR("0", "0", "4611686018427387904")}, "VALUE_NOT_IN_RANGE"},
      {{.accessors = ACCESSOR("0", "0", "1537228672809129302")}, "VALUE_NOT_IN_RANGE"},
      {{.accessors = ACCESSOR("0", "0", "1537228672809129")}, "ACCESSOR_TOO_LONG"},
      {{.accessors = ACCESSOR("0", "9007199254740984", "3")}, "ACCESSOR_TOO_LONG"},
      {{.accessors = ACCESSOR("0", "-4", "3")}, "VALUE_NOT_IN_RANGE"},
      {{.accessors = ACCESSOR("7", "0", "3")}, "UNRESOLVED_REFERENCE"},
      {{.accessors = ACCESSOR("1e30", "0", "3")}, "VALUE_NOT_IN_RANGE"},
      {{.accessors = ACCESSOR("0.5", "0", "3")}, "TYPE_MISMATCH"},
      {{.accessors = ACCESSOR("0", "2", "2")}, "ACCESSOR_OFFSET_ALIGNMENT"},
      {{.accessors = "{\"componentType\":5126,\"count\":2000000000,\"type\":\"VEC3\","
                     "\"min\":[0,0,0],\"max\":[0,0,0]}"},
       "ACCESSOR_TOO_LONG"},
      {{.accessors = SPARSE("4", "0", "0")}, "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE"},
      {{.accessors = SPARSE("1000000000000", "0", "0")}, "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE"},
      {{.accessors = SPARSE("2", "0", "0"), .data = high, .size = 36}, "ACCESSOR_SPARSE_INDEX_OOB"},
      {{.accessors = SPARSE("2", "0", "0")}, "ACCESSOR_SPARSE_INDICES_NON_INCREASING"},
      {{.accessors = SPARSE("1", "0", "9")}, "UNRESOLVED_REFERENCE"},
      {{.views = "{\"buffer\":0,\"byteLength\":18446744073709551615}"}, "VALUE_NOT_IN_RANGE"},
      {{.views = "{\"buffer\":0,\"byteOffset\":9007199254740991,\"byteLength\":36}"},
       "BUFFER_VIEW_TOO_LONG"},
      {{.views = "{\"buffer\":0,\"byteLength\":37}"}, "BUFFER_VIEW_TOO_LONG"},
      {{.views = "{\"buffer\":0,\"byteLength\":36,\"byteStride\":252}"}, "ACCESSOR_TOO_LONG"},
      {{.views = "{\"buffer\":0,\"byteLength\":36,\"byteStride\":8}"}, "ACCESSOR_SMALL_BYTESTRIDE"},
      {{.length = "18446744073709551615"}, "VALUE_NOT_IN_RANGE"},
      {{.length = "9007199254740991"}, "BUFFER_BYTE_LENGTH_MISMATCH"},
      {{.length = "0"}, "VALUE_NOT_IN_RANGE"},
      {{.length = "1e999"}, "VALUE_NOT_IN_RANGE"},
  };
  int failed = 0;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    failed += !is_refused(assembled(cases[i].parts), cases[i].code);
  assert_int_equal(failed, 0);
}

static void test_values(void **state) {
  (void)state;
  float nan[9] = {0, 0, 0, 1, 0, 0, 0, NAN, 0}, infinite[9] = {0, 0, 0, INFINITY};
  float huge[9] = {0, 0, 0, 3e38f, 0, 0, 0, 3e38f, 0};
  struct {
    float p[9];
    uint16_t index[6];
  } past = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 3}};
  const char *indexed = POSITIONS ",{\"bufferView\":1,\"componentType\":5123,\"count\":3,"
                                  "\"type\":\"SCALAR\"}";
  const char *views = "{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
                      "\"byteLength\":8}";
  const char *wide = "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
                     "\"min\":[0,0,0],\"max\":[3e38,3e38,0]}";
  int failed = 0;
  failed += !is_refused(assembled((Parts){.data = nan, .size = 36}), "ACCESSOR_INVALID_FLOAT");
  failed += !is_refused(assembled((Parts){.data = infinite, .size = 36}), "ACCESSOR_INVALID_FLOAT");
  failed += !is_refused(assembled((Parts){.accessors = wide, .data = huge, .size = 36}),
                        "VALUE_NOT_IN_RANGE");
  failed += !is_refused(assembled((Parts){.accessors = indexed,
                                          .views = views,
                                          .primitive = ",\"indices\":1",
                                          .data = &past,
                                          .size = 44}),
                        "ACCESSOR_INDEX_OOB");
  failed +=
      !is_refused(assembled((Parts){.node = ",\"translation\":[1e39,0,0]"}), "VALUE_NOT_IN_RANGE");
  failed +=
      !is_refused(assembled((Parts){.node = ",\"translation\":[1e30,0,0]"}), "VALUE_NOT_IN_RANGE");
  failed += !is_refused(assembled((Parts){.node = ",\"scale\":[1e999,1,1]"}), "VALUE_NOT_IN_RANGE");
  failed += !is_refused(assembled((Parts){.node = ",\"scale\":[NaN,1,1]"}), "INVALID_JSON");
  failed += !is_refused(assembled((Parts){.node = ",\"rotation\":[0,0,0,0]"}), "ROTATION_NON_UNIT");
  failed += !is_refused(assembled((Parts){.node = ",\"matrix\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]"}),
                        "NODE_MATRIX_NON_TRS");
  failed += !is_refused(assembled((Parts){.more = "\"materials\":[{\"emissiveFactor\":[2,0,0]}],"}),
                        "VALUE_NOT_IN_RANGE");
  assert_int_equal(failed, 0);
}

/* Shapes without area, and nodes without extent, are odd but not wrong. */
static void test_degenerate(void **state) {
  (void)state;
  static const float point[9] = {0};
  const char *zeros = "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
                      "\"min\":[0,0,0],\"max\":[0,0,0]}";
  assert_true(is_accepted(assembled((Parts){.node = ",\"scale\":[0,0,0]"})));
  assert_true(is_accepted(assembled((Parts){.node = ",\"scale\":[0,1,1]"})));
  assert_true(is_accepted(assembled((Parts){.node = ",\"scale\":[1e-30,1,1e-30]"})));
  assert_true(is_accepted(assembled((Parts){.accessors = zeros, .data = point, .size = 36})));
}

static const char *chain(uint32_t count, int closed) {
  FILE *file = fopen(path_of("chain.gltf"), "wb");
  assert_non_null(file);
  fprintf(file, HEAD "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
  for (uint32_t i = 0; i + 1 < count; i++) fprintf(file, "{\"children\":[%u]},", i + 1);
  fprintf(file, closed ? "{\"children\":[0]}]}" : "{}]}");
  fclose(file);
  return path_of("chain.gltf");
}

static void test_graphs(void **state) {
  (void)state;
  assert_true(is_accepted(chain(60000, 0)));
  assert_true(is_refused(chain(1000000, 0), "NODE_TOO_DEEP"));
  assert_true(is_refused(chain(1000, 1), "NODE_LOOP"));
  assert_true(is_refused(chain(1, 1), "NODE_LOOP"));
  assert_true(is_refused(written(HEAD "\"nodes\":[{\"children\":[2]},{\"children\":[2]},{}]}"),
                         "NODE_PARENT_OVERRIDE"));
  assert_true(
      is_refused(written(HEAD "\"nodes\":[{\"children\":[1,1]},{}]}"), "ARRAY_ELEMENT_NOT_UNIQUE"));
}

/* A hundred thousand brackets. */
static void test_nesting(void **state) {
  (void)state;
  static char text[200001];
  memset(text, '[', 200000);
  assert_true(is_refused(written(text), "INVALID_JSON"));
  for (int i = 0; i < 199998; i += 5) memcpy(text + i, "{\"a\":", 5);
  assert_true(is_refused(written(text), "INVALID_JSON"));
}

/* Nothing outside the folder is read, by whatever name; directories and devices are no files. */
static void test_uris(void **state) {
  (void)state;
  static const struct {
    const char *uri, *code;
  } cases[] = {{"../outside.bin", "INVALID_URI"},
               {"%2e%2e/outside.bin", "INVALID_URI"},
               {"link.bin", "INVALID_URI"},
               {"/etc/passwd", "INVALID_URI"},
               {"folder", "IO_ERROR"},
               {"folder/../../outside.bin", "INVALID_URI"},
               {"missing.bin", "IO_ERROR"},
               {"a%00b", "INVALID_URI"},
               {"%zz", "INVALID_URI"},
               {"pipe", "IO_ERROR"},
               {"data:application/octet-stream;base64,!!!!", "INVALID_URI"},
               {"data:application/octet-stream,abc", "INVALID_URI"},
               {"http://example.com/a.bin", "NON_RELATIVE_URI"},
               {"//example.com/a.bin", "NON_RELATIVE_URI"},
               {"file:///etc/passwd", "NON_RELATIVE_URI"}};
  char command[512], text[2048];
  int failed = 0;
  snprintf(command, sizeof command,
           "cd %s && mkdir -p in/folder && printf 123456789012345678901234567890123456 > "
           "outside.bin && ln -sf ../outside.bin in/link.bin && mkfifo in/pipe",
           scene_folder);
  assert_int_equal(system(command), 0);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    snprintf(text, sizeof text,
             HEAD "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                  "\"POSITION\":0}}]}],\"accessors\":[" POSITIONS "],\"bufferViews\":[{"
                  "\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,"
                  "\"uri\":\"%s\"}]}",
             cases[i].uri);
    scene_write("in/uri.gltf", text, strlen(text));
    failed += !is_refused(path_of("in/uri.gltf"), cases[i].code);
  }
  assert_int_equal(failed, 0);
  assert_true(is_refused(path_of("in/none.gltf"), "IO_ERROR"));
  assert_true(is_refused(path_of("in/folder"), "IO_ERROR"));
}

static size_t put_chunk(uint8_t *to, uint32_t type, const void *data, size_t size) {
  uint32_t head[2] = {(uint32_t)(size + 3) & ~3u, type};
  memcpy(to, head, 8);
  memset(to + 8, type == 0x4e4f534a ? ' ' : 0, head[0]);
  memcpy(to + 8, data, size);
  return 8 + head[0];
}

static size_t make_glb(uint8_t *glb) {
  static const char json[] =
      HEAD "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
           "\"POSITION\":0}}]}],\"accessors\":[" POSITIONS "],\"bufferViews\":[{\"buffer\":0,"
           "\"byteLength\":36}],\"buffers\":[{\"byteLength\":36}]}";
  size_t at = 12;
  at += put_chunk(glb + at, 0x4e4f534a, json, sizeof json - 1);
  at += put_chunk(glb + at, 0x004e4942, triangle, sizeof triangle);
  uint32_t head[3] = {0x46546c67, 2, (uint32_t)at};
  memcpy(glb, head, 12);
  return at;
}

static void test_glb(void **state) {
  (void)state;
  static uint8_t glb[4096], bad[4096];
  size_t size = make_glb(glb);
  int failed = 0;
  scene_write("whole.glb", glb, size);
  assert_true(is_accepted(path_of("whole.glb")));
  for (size_t cut = 0; cut < size; cut += cut < 64 ? 1 : 64) {
    scene_write("cut.glb", glb, cut);
    failed += !is_refused(path_of("cut.glb"), NULL);
  }
  static const struct {
    size_t at;
    uint32_t value;
    const char *code;
  } cases[] = {{0, 0x46546c68, "GLB_INVALID_MAGIC"},
               {4, 1, "GLB_INVALID_VERSION"},
               {8, 0xffffffff, "GLB_LENGTH_MISMATCH"},
               {8, 11, "GLB_LENGTH_TOO_SMALL"},
               {12, 0xfffffffc, "GLB_UNEXPECTED_END_OF_CHUNK_DATA"},
               {12, 0, "GLB_EMPTY_CHUNK"},
               {12, 13, "GLB_CHUNK_LENGTH_UNALIGNED"},
               {16, 0x004e4942, "GLB_UNEXPECTED_FIRST_CHUNK"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    memcpy(bad, glb, size);
    memcpy(bad + cases[i].at, &cases[i].value, 4);
    scene_write("bad.glb", bad, size);
    failed += !is_refused(path_of("bad.glb"), cases[i].code);
  }
  assert_int_equal(failed, 0);
}

/* A PNG header alone, of any size. */
static size_t make_png(uint8_t *png, uint32_t width, uint32_t height) {
  static const uint8_t head[] = {0x89, 'P', 'N', 'G', 13,  10,  26,  10,
                                 0,    0,   0,   13,  'I', 'H', 'D', 'R'};
  memcpy(png, head, sizeof head);
  for (int i = 0; i < 4; i++) {
    png[16 + i] = (uint8_t)(width >> (24 - 8 * i));
    png[20 + i] = (uint8_t)(height >> (24 - 8 * i));
  }
  memcpy(png + 24, "\x08\x02\x00\x00\x00\x00\x00\x00\x00", 9);
  return 33;
}

static const char *textured(const char *uri) {
  char text[2048];
  snprintf(text, sizeof text,
           HEAD "\"images\":[{\"uri\":\"%s\"}],\"textures\":[{\"source\":0}],"
                "\"materials\":[{\"pbrMetallicRoughness\":{"
                "\"baseColorTexture\":{\"index\":0}}}]}",
           uri);
  return written(text);
}

static void test_images(void **state) {
  (void)state;
  static const char tiny[] =
      "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVQYV2P4z/"
      "AfAAQAAf+I0P3MAAAAAElFTkSuQmCC";
  static const uint32_t sides[][2] = {{1, 1}, {65535, 65535}, {0, 0}, {0x7fffffff, 0x7fffffff}};
  uint8_t png[64];
  int failed = 0;
  assert_true(is_accepted(textured(tiny)));
  for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
    scene_write("side.png", png, make_png(png, sides[i][0], sides[i][1]));
    failed += !is_refused(textured("side.png"), NULL);
  }
  scene_write("side.png", "\xff\xd8\xff\xe0\x00\x01", 6);
  failed += !is_refused(textured("side.png"), "IMAGE_DATA_INVALID");
  scene_write("side.png", "no picture", 10);
  assert_true(is_accepted(textured("side.png"))); /* as the validator has it: noted */
  assert_int_equal(failed, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_sound),  cmocka_unit_test(test_ranges),
      cmocka_unit_test(test_values), cmocka_unit_test(test_degenerate),
      cmocka_unit_test(test_graphs), cmocka_unit_test(test_nesting),
      cmocka_unit_test(test_uris),   cmocka_unit_test(test_glb),
      cmocka_unit_test(test_images)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
