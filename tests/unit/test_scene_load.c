/* test_scene_load.c: geometry, graph, cameras and lights of scenes whose values the test wrote. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene_text.h"

#define HEAD "{\"asset\":{\"version\":\"2.0\"},"
#define NEAR(a, b) assert_true(fabs((double)(a) - (double)(b)) < 1e-5)

static struct cdl_Scene *must(struct cdl_Scene *scene) {
  if (scene_status) print_message("%s", scene_errors);
  assert_int_equal(scene_status, CDL_OK);
  assert_non_null(scene);
  return scene;
}

/* Five points in a plane, and indices 0 1 2 3 4 as bytes behind them. */
static const struct {
  float p[5][3];
  uint8_t index[8];
} five = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}}, {0, 1, 2, 3, 4, 0, 0, 0}};

static struct cdl_Scene *load_five(int mode, int indexed) {
  return must(
      scene_from(HEAD "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}%s,"
                      "\"mode\":%d}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
                      "\"count\":5,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,2,0]},"
                      "{\"bufferView\":1,\"componentType\":5121,\"count\":5,\"type\":\"SCALAR\"}],"
                      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60},{\"buffer\":0,"
                      "\"byteOffset\":60,\"byteLength\":8}],\"buffers\":[{\"byteLength\":68,"
                      "\"uri\":\"%s\"}]}",
                 indexed ? ",\"indices\":1" : "", mode, scene_data(&five, sizeof five)));
}

static void check_triangles(const struct cdl_Scene *scene, uint32_t count,
                            const uint32_t (*corners)[3]) {
  assert_int_equal(scene->mesh_count, 1);
  assert_int_equal(scene->meshes[0].triangle_count, count);
  assert_memory_equal(scene->meshes[0].indices, corners, count * sizeof *corners);
}

static void test_modes(void **state) {
  (void)state;
  static const uint32_t list[][3] = {{0, 1, 2}};
  static const uint32_t strip[][3] = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}};
  static const uint32_t fan[][3] = {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}};
  for (int indexed = 0; indexed < 2; indexed++) {
    struct cdl_Scene *scene = load_five(4, indexed);
    check_triangles(scene, 1, list);
    assert_null(scene->meshes[0].normals);
    assert_memory_equal(scene->meshes[0].positions, five.p, sizeof five.p);
    scene_free(scene);
    scene = load_five(5, indexed);
    check_triangles(scene, 3, strip);
    scene_free(scene);
    scene = load_five(6, indexed);
    check_triangles(scene, 3, fan);
    scene_free(scene);
  }
  struct cdl_Scene *lines = load_five(1, 0);
  assert_int_equal(lines->instance_count, 0);
  assert_non_null(strstr(scene_notes, "skipped"));
  scene_free(lines);
}

/* A light, a neutral environment and a camera come about by themselves. */
static void test_completed(void **state) {
  (void)state;
  struct cdl_Scene *scene = load_five(4, 0);
  assert_int_equal(scene->environment.present, 1);
  assert_int_equal(scene->environment.image, CDL_NONE);
  NEAR(scene->environment.radiance[1] * scene->environment.strength, 1);
  assert_int_equal(scene->environment.assumed, 1);
  assert_int_equal(scene->camera_count, 1);
  NEAR(scene->bounds[1][1], 2);
  const float *m = scene->cameras[0].to_world;
  assert_true(m[3] > 0.5f && m[7] > 1 && m[11] > 0); /* right of, above and in front */
  for (int i = 0; i < 5; i++) {                      /* all in view, and not tiny */
    double d[3], e[3];
    for (int c = 0; c < 3; c++) d[c] = five.p[i][c] - m[4 * c + 3];
    for (int c = 0; c < 3; c++) e[c] = d[0] * m[c] + d[1] * m[4 + c] + d[2] * m[8 + c];
    assert_true(e[2] < 0);
    assert_true(fabs(e[0] / e[2]) < tan(scene->cameras[0].yfov / 2));
    assert_true(fabs(e[1] / e[2]) < tan(scene->cameras[0].yfov / 2));
  }
  assert_int_equal(strlen(scene->sha256), 64);
  scene_free(scene);
}

/* TRS below a matrix below a scale: worked out by hand. */
static void test_nodes(void **state) {
  (void)state;
  struct cdl_Scene *scene =
      must(scene_from(HEAD "\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
                           "{\"children\":[1],\"scale\":[2,3,-1]},"
                           "{\"children\":[2],\"matrix\":[0,1,0,0,-1,0,0,0,0,0,1,0,5,6,7,1]},"
                           "{\"mesh\":0,\"name\":\"leaf\",\"translation\":[1,2,3],"
                           "\"rotation\":[0.70710678,0,0,0.70710678],\"scale\":[1,1,4]}],"
                           "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
                           "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
                           "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":["
                           "{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,"
                           "\"uri\":\"%s\"}]}",
                      scene_data(five.p, 36)));
  /* TRS: x' = (x + 1, -4z + 2, y + 3). Matrix: (x, y, z) -> (-y + 5, x + 6, z + 7). Scale last. */
  static const double expected[12] = {0, 0,  8, 2 * (-2 + 5.0), 3, 0, 0, 3 * (1 + 6.0),
                                      0, -1, 0, -(3 + 7.0)};
  assert_int_equal(scene->instance_count, 1);
  for (int i = 0; i < 12; i++) NEAR(scene->instances[0].to_world[i], expected[i]);
  assert_string_equal(scene->object_names[0], "leaf");
  NEAR(scene->bounds[0][0], 6);
  NEAR(scene->bounds[1][1], 24);
  NEAR(scene->bounds[0][2], -11);
  scene_free(scene);
}

/* A sparse accessor over zeros, normalised colours and texture coordinates, quantised positions. */
static void test_accessors(void **state) {
  (void)state;
  static const struct {
    int16_t position[3][4]; /* stride 8 */
    uint8_t color[3][4];
    uint16_t uv[3][2];
    uint16_t sparse[2];
    float normal[1][3];
  } data = {{{0, 0, 0, 0}, {2, 0, 0, 0}, {0, -4, 0, 0}},
            {{255, 0, 51, 255}, {0, 0, 0, 0}, {0, 255, 0, 102}},
            {{0, 0}, {65535, 0}, {0, 13107}},
            {1, 0},
            {{0, 0, 1}}};
  struct cdl_Scene *scene = must(scene_from(
      HEAD "\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
           "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"nodes\":[{\"mesh\":0}],"
           "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1,"
           "\"TEXCOORD_0\":2,\"TEXCOORD_1\":3}}]}],\"accessors\":["
           "{\"bufferView\":0,\"componentType\":5122,\"count\":3,\"type\":\"VEC3\","
           "\"min\":[0,-4,0],\"max\":[2,0,0]},"
           "{\"bufferView\":1,\"componentType\":5121,\"normalized\":true,\"count\":3,"
           "\"type\":\"VEC4\"},"
           "{\"bufferView\":2,\"componentType\":5123,\"normalized\":true,\"count\":3,"
           "\"type\":\"VEC2\"},"
           "{\"componentType\":5126,\"count\":3,\"type\":\"VEC2\",\"sparse\":{\"count\":1,"
           "\"indices\":{\"bufferView\":3,\"componentType\":5123},"
           "\"values\":{\"bufferView\":4,\"byteOffset\":4}}}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":24,\"byteStride\":8},"
           "{\"buffer\":0,\"byteOffset\":24,\"byteLength\":12},"
           "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":12},"
           "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":4},"
           "{\"buffer\":0,\"byteOffset\":52,\"byteLength\":12}],"
           "\"buffers\":[{\"byteLength\":64,\"uri\":\"%s\"}]}",
      scene_data(&data, sizeof data)));
  const cdl_SceneMesh *mesh = &scene->meshes[0];
  NEAR(mesh->positions[3], 2);
  NEAR(mesh->positions[7], -4);
  NEAR(mesh->colors[0], 1);
  NEAR(mesh->colors[2], 0.2);
  NEAR(mesh->colors[11], 0.4);
  NEAR(mesh->uv[0][2], 1);
  NEAR(mesh->uv[0][5], 0.2);
  static const float sparse[6] = {0, 0, 0, 1, 0, 0};
  assert_memory_equal(mesh->uv[1], sparse, sizeof sparse);
  scene_free(scene);
}

/* Two nodes share a mesh; a third has two copies on the GPU. No triangle is stored twice. */
static void test_instances(void **state) {
  (void)state;
  static const struct {
    float p[3][3], translation[2][3], scale[2][3];
  } data = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {0, 5, 0}}, {{1, 1, 1}, {2, 3, 4}}};
  struct cdl_Scene *scene = must(scene_from(
      HEAD "\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],\"nodes\":[{\"mesh\":0},"
           "{\"mesh\":0,\"translation\":[0,0,9]},{\"mesh\":0,\"translation\":[10,0,0],"
           "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,"
           "\"SCALE\":2}}}}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
           "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
           "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},{\"bufferView\":1,"
           "\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},{\"bufferView\":1,"
           "\"byteOffset\":24,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
           "\"byteLength\":48}],\"buffers\":[{\"byteLength\":84,\"uri\":\"%s\"}]}",
      scene_data(&data, sizeof data)));
  assert_int_equal(scene->mesh_count, 1);
  assert_int_equal(scene->instance_count, 4);
  assert_int_equal(scene->object_count, 4);
  static const double last[12] = {2, 0, 0, 10, 0, 3, 0, 5, 0, 0, 4, 0};
  NEAR(scene->instances[1].to_world[11], 9);
  NEAR(scene->instances[2].to_world[3], 11);
  for (int i = 0; i < 12; i++) NEAR(scene->instances[3].to_world[i], last[i]);
  scene_free(scene);
}

/* A scale of zero in one direction flattens; in all, nothing is left. */
static void test_flat(void **state) {
  (void)state;
  for (int flat = 0; flat < 2; flat++) {
    struct cdl_Scene *scene =
        must(scene_from(HEAD "\"nodes\":[{\"mesh\":0,\"scale\":[%d,2,0],\"translation\":[0,0,3]}],"
                             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
                             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
                             "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":["
                             "{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,"
                             "\"uri\":\"%s\"}]}",
                        flat, scene_data(five.p, 36)));
    assert_int_equal(scene->instance_count, flat);
    if (flat) {
      const cdl_SceneMesh *mesh = &scene->meshes[scene->instances[0].mesh];
      NEAR(mesh->positions[7], 2);
      NEAR(mesh->positions[8], 3);
    }
    scene_free(scene);
  }
}

static void test_cameras(void **state) {
  (void)state;
  struct cdl_Scene *scene = must(scene_from(
      "%s", HEAD "\"extensionsUsed\":[\"CDL_camera\"],\"nodes\":[{\"camera\":0,"
                 "\"translation\":[1,2,3]},{\"camera\":1}],\"cameras\":[{\"type\":"
                 "\"perspective\",\"name\":\"lens\",\"perspective\":{\"yfov\":0.5,\"znear\":0.1,"
                 "\"aspectRatio\":1.5},\"extensions\":{\"CDL_camera\":{\"apertureRadius\":0.02,"
                 "\"focusDistance\":4,\"blades\":6,\"shutter\":[0.25,0.5]}}},{\"type\":"
                 "\"orthographic\",\"orthographic\":{\"xmag\":3,\"ymag\":2,\"znear\":0,"
                 "\"zfar\":9}}]}"));
  assert_int_equal(scene->camera_count, 2);
  const cdl_SceneCamera *lens = &scene->cameras[0], *flat = &scene->cameras[1];
  assert_string_equal(lens->name, "lens");
  NEAR(lens->yfov, 0.5);
  NEAR(lens->aspect, 1.5);
  NEAR(lens->to_world[7], 2);
  NEAR(lens->aperture_radius, 0.02);
  NEAR(lens->focus_distance, 4);
  assert_int_equal(lens->blades, 6);
  NEAR(lens->shutter[1], 0.5);
  assert_true(flat->orthographic);
  NEAR(flat->xmag, 3);
  NEAR(flat->aspect, 1.5);
  scene_free(scene);
}

static void test_lights(void **state) {
  (void)state;
  struct cdl_Scene *scene = must(scene_from(
      "%s", HEAD "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{"
                 "\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"color\":[1,0.5,0],"
                 "\"intensity\":8,\"range\":7},{\"type\":\"spot\",\"name\":\"s\",\"spot\":{"
                 "\"innerConeAngle\":0.1,\"outerConeAngle\":0.4}},{\"type\":\"directional\","
                 "\"intensity\":3}]}},\"nodes\":[{\"translation\":[1,2,3],\"extensions\":{"
                 "\"KHR_lights_punctual\":{\"light\":0}}},{\"rotation\":[-0.70710678,0,0,"
                 "0.70710678],\"scale\":[5,5,5],\"extensions\":{\"KHR_lights_punctual\":{"
                 "\"light\":1}}},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}}]}"));
  assert_int_equal(scene->light_count, 3);
  const cdl_SceneLight *l = scene->lights;
  NEAR(l[0].intensity[0], 8);
  NEAR(l[0].intensity[1], 4);
  NEAR(l[0].range, 7);
  NEAR(l[0].position[2], 3);
  NEAR(l[1].direction[1], -1); /* -Z turned by -90 degrees about X looks down */
  NEAR(l[1].outer_cone, 0.4);
  NEAR(l[1].intensity[2], 1);
  NEAR(l[2].direction[2], -1);
  assert_int_equal(scene->environment.present, 0);
  scene_free(scene);
}

/* Half way between two keys, and at rest. */
static void test_animation(void **state) {
  (void)state;
  static const struct {
    float p[3][3], times[2], moves[2][3], turns[2][4];
  } data = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
            {1, 3},
            {{0, 0, 0}, {4, 0, 0}},
            {{0, 0, 0, 1}, {0, 0, 0.70710678f, 0.70710678f}}};
  scene_free(scene_from(
      HEAD "\"nodes\":[{\"mesh\":0,\"translation\":[0,0,8]}],\"meshes\":[{\"primitives\":["
           "{\"attributes\":{\"POSITION\":0}}]}],\"animations\":[{\"channels\":[{\"sampler\":0,"
           "\"target\":{\"node\":0,\"path\":\"translation\"}},{\"sampler\":1,\"target\":{"
           "\"node\":0,\"path\":\"rotation\"}}],\"samplers\":[{\"input\":1,\"output\":2},"
           "{\"input\":1,\"output\":3}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
           "\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},{\"bufferView\":1,"
           "\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\",\"min\":[1],\"max\":[3]},"
           "{\"bufferView\":2,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
           "{\"bufferView\":3,\"componentType\":5126,\"count\":2,\"type\":\"VEC4\"}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
           "\"byteLength\":8},{\"buffer\":0,\"byteOffset\":44,\"byteLength\":24},"
           "{\"buffer\":0,\"byteOffset\":68,\"byteLength\":32}],\"buffers\":[{"
           "\"byteLength\":100,\"uri\":\"%s\"}]}",
      scene_data(&data, sizeof data)));
  assert_int_equal(scene_status, CDL_OK);
  struct cdl_Scene *rest = must(scene_open("scene.gltf", -1));
  NEAR(rest->instances[0].to_world[11], 8);
  scene_free(rest);
  struct cdl_Scene *half = must(scene_open("scene.gltf", 2));
  NEAR(half->instances[0].to_world[3], 2);
  NEAR(half->instances[0].to_world[11], 0);
  NEAR(half->instances[0].to_world[0], cos(M_PI / 4));
  NEAR(half->instances[0].to_world[4], sin(M_PI / 4));
  scene_free(half);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_modes),     cmocka_unit_test(test_completed),
      cmocka_unit_test(test_nodes),     cmocka_unit_test(test_accessors),
      cmocka_unit_test(test_instances), cmocka_unit_test(test_flat),
      cmocka_unit_test(test_cameras),   cmocka_unit_test(test_lights),
      cmocka_unit_test(test_animation)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
