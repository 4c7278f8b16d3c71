/* test_scene_pack.c: what kernels read of a scene whose values the test wrote. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/pack.h"
#include "scene_text.h"

#define RED 0xff0000ffu /* RGBA, the first byte lowest */
#define BLUE 0xffff0000u

/* A red and a blue texel on a triangle that a point light shines at; `more` joins the scene. */
static struct cdl_Scene *load_picture(const char *more) {
  static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  return scene_from(
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]%s}],"
      "\"extensionsUsed\":[\"CDL_environment\",\"KHR_lights_punctual\"],"
      "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}},"
      "\"nodes\":[{\"mesh\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},"
      "\"material\":0}]}],\"materials\":[{\"pbrMetallicRoughness\":"
      "{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{\"source\":0}],"
      "\"images\":[{\"uri\":\"data:image/"
      "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA"
      "DUlEQVR42mP4zwAE/wEHAAH/PX2MSQAAAABJRU5ErkJggg==\"}],"
      "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
      "\"min\":[0,0,0],\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
      "\"type\":\"VEC2\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
      "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
      more, scene_data(corners, sizeof corners));
}

/* The picture of index 0 is there whatever the environment: none or a constant one. */
static void test_first_texture(void **state) {
  (void)state;
  static const char *const environments[] = {
      "", ",\"extensions\":{\"CDL_environment\":{\"radiance\":[1,1,1]}}"};
  for (size_t i = 0; i < 2; i++) {
    cdl_Pack pack = {0};
    struct cdl_Scene *scene = load_picture(environments[i]);
    if (scene_status) print_message("%s", scene_errors);
    assert_non_null(scene);
    assert_int_equal(pack_scene(&scene_log, scene, 2, &pack), CDL_OK);
    assert_int_equal(pack.textures[0].width, 2);
    assert_int_equal(pack.texels[pack.textures[0].first], RED);
    assert_int_equal(pack.texels[pack.textures[0].first + 1], BLUE);
    pack_free(&pack);
    scene_free(scene);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_first_texture)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
