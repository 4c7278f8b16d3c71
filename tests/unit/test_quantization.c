/* test_quantization.c: KHR_mesh_quantization: every component type of every attribute is accepted
 * or refused as the extension's table says, with it and without, in meshes and in morph targets;
 * what is accepted has the value of section 3.11. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene_text.h"

enum { BYTE = 5120, UBYTE, SHORT, USHORT, FLOAT = 5126 };

/* What may hold an attribute: a letter for each type, small where normalised: b B s S of 8 and 16
 * bits, signed; u U w W, unsigned; f float. Core, then with the extension. */
typedef struct Row {
  const char *name, *type;
  int width;
  const char *core, *extended;
} Row;

static const Row rows[] = {
    {"POSITION", "VEC3", 3, "f", "fbBsSuUwW"}, {"NORMAL", "VEC3", 3, "f", "fbs"},
    {"TANGENT", "VEC4", 4, "f", "fbs"},        {"TEXCOORD_0", "VEC2", 2, "fuw", "fuwUWbBsS"},
    {"COLOR_0", "VEC3", 3, "fuw", "fuw"},      {"COLOR_0", "VEC4", 4, "fuw", "fuw"}};
static const Row targets[] = {{"POSITION", "VEC3", 3, "f", "fbBsS"},
                              {"NORMAL", "VEC3", 3, "f", "fbs"},
                              {"TANGENT", "VEC3", 3, "f", "fbs"}};

typedef struct Form {
  char letter;
  int component, normalized, size;
  double scale;
} Form;

static const Form forms[] = {
    {'f', FLOAT, 0, 4, 1},     {'b', BYTE, 1, 1, 127},     {'B', BYTE, 0, 1, 1},
    {'s', SHORT, 1, 2, 32767}, {'S', SHORT, 0, 2, 1},      {'u', UBYTE, 1, 1, 255},
    {'U', UBYTE, 0, 1, 1},     {'w', USHORT, 1, 2, 65535}, {'W', USHORT, 0, 2, 1}};
enum { FORMS = sizeof forms / sizeof *forms };

/* Three vertices of 16 bytes; the attribute's first component is 0, 1 or full scale in turn. */
static uint8_t values[3][16];
static double lowest, highest; /* as stored */

static void store(const Form *form, int v, int c, double x) {
  int16_t wide = (int16_t)x;
  float single = (float)x;
  uint8_t *to = values[v] + c * form->size;
  if (form->component == FLOAT)
    memcpy(to, &single, 4);
  else if (form->size == 2)
    memcpy(to, &wide, 2);
  else
    *to = (uint8_t)wide;
}

/* Unit vectors along the axes: good for every attribute. */
static void fill(const Form *form, int width) {
  double one = form->normalized ? form->scale : 1;
  memset(values, 0, sizeof values);
  for (int v = 0; v < 3; v++) {
    store(form, v, v % 3 % width, one);
    if (width == 4) store(form, v, 3, one);
  }
  lowest = 0, highest = one;
}

static struct cdl_Scene *load(const Row *row, const Form *form, int extended, int is_target) {
  static const float places[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  static const float ups[3][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
  char attribute[128], target[64] = "", bounds[128];
  uint8_t bytes[36 + 48 + 48];
  fill(form, row->width);
  memcpy(bytes, places, 36);
  memcpy(bytes + 36, ups, 48);
  memcpy(bytes + 84, values, 48);
  const char *more = strcmp(row->name, "POSITION") == 0 ? "" : "\"POSITION\":0,";
  snprintf(attribute, sizeof attribute, "%s\"%s\":1", more, row->name);
  if (is_target) {
    snprintf(attribute, sizeof attribute, "\"POSITION\":0,\"NORMAL\":2,\"TANGENT\":3");
    snprintf(target, sizeof target, ",\"targets\":[{\"%s\":1}]", row->name);
  }
  snprintf(bounds, sizeof bounds, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", lowest,
           lowest, lowest, highest, highest, highest);
  return scene_from(
      "{\"asset\":{\"version\":\"2.0\"},%s\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{%s}%s}]}],\"accessors\":["
      "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
      "\"max\":[1,1,0]},{\"bufferView\":2,\"componentType\":%d,%s\"count\":3,\"type\":\"%s\"%s},"
      "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
      "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"}],"
      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
      "\"byteLength\":48,\"byteStride\":16},{\"buffer\":0,\"byteOffset\":84,\"byteLength\":48,"
      "\"byteStride\":16}],\"buffers\":[{\"byteLength\":132,\"uri\":\"%s\"}]}",
      extended ? "\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
                 "\"extensionsRequired\":[\"KHR_mesh_quantization\"],"
               : "",
      attribute, target, form->component, form->normalized ? "\"normalized\":true," : "", row->type,
      row->width == 3 ? bounds : "", scene_data(bytes, sizeof bytes));
}

static const float *loaded(const struct cdl_Scene *scene, const char *name) {
  const cdl_SceneMesh *mesh = &scene->meshes[0];
  return *name == 'P'     ? mesh->positions
         : *name == 'N'   ? mesh->normals
         : *name == 'C'   ? mesh->colors
         : name[1] == 'A' ? mesh->tangents
                          : mesh->uv[0];
}

static void try(const Row *row, const Form *form, int extended, int is_target) {
  const char *allowed = extended ? row->extended : row->core;
  struct cdl_Scene *scene = load(row, form, extended, is_target);
  int wanted = strchr(allowed, form->letter) != NULL;
  if (wanted != (scene != NULL))
    print_message("%s %c, extended %d, target %d: %s\n", row->name, form->letter, extended,
                  is_target, scene ? "loaded" : scene_errors);
  assert_int_equal(wanted, scene != NULL);
  if (!wanted) assert_non_null(strstr(scene_errors, "ACCESSOR_INVALID_FORMAT"));
  /* Tangents stand alone here, and are left out where there are no normals. */
  const float *got = scene && !is_target ? loaded(scene, row->name) : NULL;
  int width = *row->name == 'C' ? 4 : row->width;
  for (int v = 0; got && v < 3; v++)
    for (int c = 0; c < row->width; c++)
      assert_true(got[v * width + c] == (c == v % 3 % row->width || c == 3 ? 1.0f : 0.0f));
  scene_free(scene);
}

static void test_table(void **state) {
  (void)state;
  for (int extended = 0; extended < 2; extended++)
    for (int f = 0; f < FORMS; f++) {
      for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) try(&rows[i], &forms[f], extended, 0);
      for (size_t i = 0; i < sizeof targets / sizeof *targets; i++)
        try(&targets[i], &forms[f], extended, 1);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_table)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
