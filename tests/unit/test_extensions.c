/* test_extensions.c: extensions at every level of a file: those that nobody declared, that are not
 * known, that stand in the wrong place; textures whose image only an extension names. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <jansson.h>

#include "scene_text.h"

/* One pixel each: opaque, and fully transparent; then the mere beginning of a KTX2 file. */
#define PNG                                                                                        \
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVQYV2P4z/"           \
  "AfAAQAAf+I0P3MAAAAAElFTkSuQmCC"
#define WEBP "data:image/webp;base64,UklGRhoAAABXRUJQVlA4TA0AAAAvAAAAEAcQERGIiP4HAA=="
#define KTX2                                                                                       \
  "data:image/"                                                                                    \
  "ktx2;base64,"                                                                                   \
  "q0tUWCAyMLsNChoKAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA" \
  "AAAAAAAAAAAAA="

/* An object of every kind that glTF has, and of some that extensions have. */
static const char document[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\","
    "\"KHR_texture_transform\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{"
    "\"type\":\"spot\",\"spot\":{}}]}},\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0,"
    "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},{\"camera\":0}],\"cameras\":[{"
    "\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}},{\"type\":\"orthographic\","
    "\"orthographic\":{\"xmag\":1,\"ymag\":1,\"znear\":0,\"zfar\":1}}],\"skins\":[{\"joints\":[1]}"
    "],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,"
    "\"extensions\":{\"KHR_texture_transform\":{}}}},\"normalTexture\":{\"index\":0},"
    "\"occlusionTexture\":{\"index\":0}}],\"textures\":[{\"sampler\":0,\"source\":0}],"
    "\"samplers\":[{}],\"images\":[{\"uri\":\"" PNG "\"}],\"meshes\":[{\"primitives\":[{"
    "\"attributes\":{\"POSITION\":0},\"material\":0}]}],\"animations\":[{\"channels\":[{"
    "\"sampler\":0,\"target\":{\"node\":0,\"path\":\"scale\"}}],\"samplers\":[{\"input\":1,"
    "\"output\":0}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
    "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,1],\"sparse\":{\"count\":1,\"indices\":{"
    "\"bufferView\":1,\"componentType\":5125},\"values\":{\"bufferView\":0}}},{\"bufferView\":2,"
    "\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\",\"min\":[0],\"max\":[2]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
    "\"byteLength\":4},{\"buffer\":0,\"byteOffset\":40,\"byteLength\":12}],\"buffers\":[{"
    "\"byteLength\":52,\"uri\":\"data.bin\"}]}";

static const float data[13] = {0, 0, 0, 1, 0, 0, 0, 1, 1, 0 /* the index 0 */, 0, 1, 2};

static json_t *root;
static int objects;

static struct cdl_Scene *load_root(void) {
  char *text = json_dumps(root, 0);
  struct cdl_Scene *scene = scene_from("%s", text);
  free(text);
  return scene;
}

static void expect_refused(const char *code, const char *at, const char *key) {
  char wanted[512];
  struct cdl_Scene *scene = load_root();
  snprintf(wanted, sizeof wanted, ": %s/extensions%s%s: %s: ", at, *key ? "/" : "", key, code);
  if (scene || !strstr(scene_errors, wanted))
    print_message("wanted %s, got %s\n", wanted, scene ? "a scene" : scene_errors);
  assert_null(scene);
  assert_int_equal(scene_error_count, 1);
  assert_non_null(strstr(scene_errors, wanted));
}

static cdl_ExtensionState state_of(const struct cdl_Scene *scene, const char *name) {
  for (uint32_t i = 0; i < scene->extension_count; i++)
    if (strcmp(scene->extensions[i].name, name) == 0) return scene->extensions[i].state;
  fail_msg("%s is not listed", name);
  return CDL_EXTENSION_USED;
}

static void expect_unsupported(void) {
  struct cdl_Scene *scene = load_root();
  if (!scene) print_message("%s", scene_errors);
  assert_non_null(scene);
  assert_int_equal(state_of(scene, "ABC_unheard_of"), CDL_EXTENSION_UNSUPPORTED);
  scene_free(scene);
}

/* One object with an extension that nobody knows: undeclared, declared, required. */
static void try_unknown(json_t *extensions, const char *at) {
  json_t *used = json_object_get(root, "extensionsUsed");
  json_object_set_new(extensions, "ABC_unheard_of", json_pack("{s:[i]}", "any", 1));
  expect_refused("UNDECLARED_EXTENSION", at, "ABC_unheard_of");
  json_array_append_new(used, json_string("ABC_unheard_of"));
  expect_unsupported();
  json_object_set_new(root, "extensionsRequired", json_pack("[s]", "ABC_unheard_of"));
  assert_null(load_root());
  assert_non_null(strstr(scene_errors, ": /extensionsRequired/0: UNSUPPORTED_EXTENSION: "));
  assert_non_null(strstr(scene_errors, "ABC_unheard_of"));
  json_object_del(root, "extensionsRequired");
  json_array_remove(used, json_array_size(used) - 1);
  json_object_del(extensions, "ABC_unheard_of");
}

/* ... with one that is known, but belongs elsewhere. */
static void try_misplaced(json_t *extensions, const char *at) {
  const char *name = strstr(at, "/buffers/") ? "KHR_draco_mesh_compression"
                                             : "EXT_meshopt_"
                                               "compression";
  if (strstr(at, "/bufferViews/")) return;
  json_t *used = json_object_get(root, "extensionsUsed");
  json_array_append_new(used, json_string(name));
  json_object_set_new(extensions, name, json_object());
  expect_refused("UNEXPECTED_EXTENSION_OBJECT", at, name);
  json_object_del(extensions, name);
  json_array_remove(used, json_array_size(used) - 1);
}

static void try_object(json_t *object, const char *at) {
  json_t *extensions = json_object_get(object, "extensions");
  int had = extensions != NULL;
  if (!had) json_object_set_new(object, "extensions", extensions = json_object());
  try_unknown(extensions, at);
  try_misplaced(extensions, at);
  if (!had) json_object_del(object, "extensions");
  objects++;
}

static void walk(json_t *value, const char *at) {
  char below[256];
  const char *key;
  json_t *member;
  void *next;
  size_t i;
  if (json_is_array(value)) {
    json_array_foreach(value, i, member) {
      snprintf(below, sizeof below, "%s/%zu", at, i);
      walk(member, below);
    }
  }
  if (!json_is_object(value)) return;
  const char *last = strrchr(at, '/');
  int is_map = last && (strcmp(last, "/attributes") == 0 || strcmp(last, "/extensions") == 0);
  if (!is_map) try_object(value, at);
  json_object_foreach_safe(value, next, key, member) {
    snprintf(below, sizeof below, "%s/%s", at, key);
    walk(member, below);
  }
}

static void test_levels(void **state) {
  (void)state;
  scene_write("data.bin", data, sizeof data);
  root = json_loads(document, JSON_DECODE_INT_AS_REAL, NULL);
  struct cdl_Scene *scene = load_root();
  if (!scene) print_message("%s", scene_errors);
  assert_non_null(scene);
  scene_free(scene);
  walk(root, "");
  print_message("%d objects\n", objects);
  assert_true(objects >= 36);
  json_decref(root);
}

#define HEAD "{\"asset\":{\"version\":\"2.0\"},"
#define LIT "\"scenes\":[{\"extensions\":{\"CDL_environment\":{\"radiance\":1}}}],"

/* What says nothing about light is passed over without a word. */
static void test_quiet(void **state) {
  (void)state;
  struct cdl_Scene *scene = scene_from(
      "%s", HEAD LIT
      "\"extensionsUsed\":[\"KHR_xmp_json_ld\",\"CDL_environment\"],"
      "\"extensionsRequired\":[\"KHR_xmp_json_ld\"],\"extensions\":{\"KHR_xmp_json_ld\":{"
      "\"packets\":[{\"dc:title\":\"x\"}]}},\"nodes\":[{\"extensions\":{\"KHR_xmp_json_ld\":{"
      "\"packet\":0}}}],\"materials\":[{\"extensions\":{\"KHR_xmp_json_ld\":{\"packet\":0}}}]}");
  assert_non_null(scene);
  assert_string_equal(scene_notes, "");
  assert_int_equal(state_of(scene, "KHR_xmp_json_ld"), CDL_EXTENSION_IGNORED);
  scene_free(scene);
}

static void test_required(void **state) {
  (void)state;
  assert_null(scene_from("%s", HEAD "\"extensionsUsed\":[\"KHR_lights_punctual\"],"
                                    "\"extensionsRequired\":[\"KHR_materials_unlit\"]}"));
  assert_non_null(strstr(scene_errors, "/extensionsRequired/0: UNUSED_EXTENSION_REQUIRED: "));
  assert_null(scene_from("%s", HEAD "\"extensionsUsed\":[\"A_b\",\"KHR_materials_unlit\"],"
                                    "\"extensionsRequired\":[\"KHR_materials_unlit\",\"A_b\"]}"));
  assert_non_null(strstr(scene_errors, "/extensionsRequired/1: UNSUPPORTED_EXTENSION: "));
  assert_non_null(strstr(scene_errors, "A_b"));
  assert_null(scene_from("%s", HEAD "\"extensionsUsed\":[1]}"));
  assert_null(scene_from("%s", HEAD "\"extensionsRequired\":[]}"));
}

/* A material with one texture, three images: PNG, WebP, KTX2. */
static struct cdl_Scene *textured(const char *extensions, const char *texture) {
  return scene_from(HEAD "\"extensionsUsed\":[\"CDL_environment\"%s]," LIT
                         "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{"
                         "\"index\":0}}},{\"emissiveTexture\":{\"index\":0}}],\"textures\":[%s],"
                         "\"images\":[{\"uri\":\"%s\"},{\"uri\":\"%s\"},{\"uri\":\"%s\"},"
                         "{\"uri\":\"https://example.com/a.webp\"}]}",
                    extensions, texture, PNG, WEBP, KTX2);
}

#define USES_WEBP ",\"EXT_texture_webp\""
#define USES_KTX2 ",\"KHR_texture_basisu\""
#define IN(name, image) "\"extensions\":{\"" name "\":{\"source\":" image "}}"

/* Of which file the material's texture is: the pictures differ in alpha; -1: it has none. */
static int alpha_of_texture(const struct cdl_Scene *scene) {
  assert_non_null(scene);
  uint32_t texture = scene->materials[0].base_texture.texture;
  assert_int_equal(texture, scene->materials[1].emission_texture.texture);
  if (texture == CDL_NONE) return -1;
  const cdl_Image *image = scene->images[scene->textures[texture].image];
  assert_non_null(image->u8);
  return image->channels == 4 ? image->u8[3] : 255;
}

static void test_webp(void **state) {
  (void)state;
  static const struct {
    const char *texture;
    int alpha;
  } cases[] = {{"{" IN("EXT_texture_webp", "1") "}", 0},
               {"{\"source\":0," IN("EXT_texture_webp", "1") "}", 0},
               {"{\"source\":0," IN("EXT_texture_webp", "3") "}", 255},
               {"{\"source\":0}", 255},
               {"{" IN("EXT_texture_webp", "3") "}", -1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct cdl_Scene *scene = textured(USES_WEBP, cases[i].texture);
    assert_int_equal(alpha_of_texture(scene), cases[i].alpha);
    assert_int_equal(state_of(scene, "EXT_texture_webp"), CDL_EXTENSION_USED);
    scene_free(scene);
  }
}

static void test_ktx2(void **state) {
  (void)state;
  static const struct {
    const char *texture;
    int alpha, state;
  } cases[] = {{"{\"source\":0," IN("KHR_texture_basisu", "2") "}", 255, CDL_EXTENSION_IGNORED},
               {"{" IN("KHR_texture_basisu", "2") "}", -1, CDL_EXTENSION_UNSUPPORTED},
               {"{\"source\":2}", -1, CDL_EXTENSION_UNSUPPORTED}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct cdl_Scene *scene =
        textured(i < 2 ? USES_KTX2 "],\"extensionsRequired\":[\"KHR_texture_basisu\"" : "",
                 cases[i].texture);
    if (!scene) print_message("%s", scene_errors);
    assert_int_equal(alpha_of_texture(scene), cases[i].alpha);
    assert_int_equal((int)state_of(scene, "KHR_texture_basisu"), cases[i].state);
    const char *note = strstr(scene_notes, "KHR_texture_basisu");
    assert_true(cases[i].alpha < 0 ? note && !strstr(note + 1, "KHR_texture_basisu") : !note);
    scene_free(scene);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_levels), cmocka_unit_test(test_quiet),
                                     cmocka_unit_test(test_required), cmocka_unit_test(test_webp),
                                     cmocka_unit_test(test_ktx2)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
