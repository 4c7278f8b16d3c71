/* test_scene_fuzz.c: a GLB with bytes changed at random, as often as there is time. Whatever comes
 * of it, the loader ends: with a scene, or with one line. CDL_SOAK makes it run for minutes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../unit/scene_text.h"
#include "core/clock.h"

/* Every part of the format that is read, in one file: 4 vertices, 2 joints, a sparse accessor,
 * instances, an animation, a picture, a light, a camera, all extensions of ours. */
static const char document[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"CDL_material\",\"CDL_medium\","
    "\"CDL_environment\",\"CDL_camera\",\"EXT_mesh_gpu_instancing\",\"KHR_lights_punctual\","
    "\"KHR_texture_transform\",\"KHR_materials_ior\",\"KHR_materials_volume\","
    "\"KHR_materials_transmission\"],\"scene\":0,\"scenes\":[{\"nodes\":[0,3,4],\"extensions\":{"
    "\"CDL_environment\":{\"radiance\":[1,1,1]},\"CDL_medium\":{\"scattering\":0.1,\"phase\":{"
    "\"type\":\"hg\",\"g\":0.5}}}}],\"nodes\":[{\"children\":[1,2],\"scale\":[1,2,3]},"
    "{\"translation\":[1,0,0]},{\"rotation\":[0,0,0,1]},{\"mesh\":0,\"skin\":0},{\"mesh\":1,"
    "\"camera\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0},"
    "\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}}],\"skins\":[{\"joints\":["
    "1,2]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1},"
    "\"extensions\":{\"CDL_camera\":{\"apertureRadius\":0.1,\"focusDistance\":2}}}],"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{}}]}},"
    "\"materials\":[{\"extensions\":{\"CDL_material\":{\"model\":\"conductor\",\"metal\":\"Au\","
    "\"alpha\":[0.1,0.2]}}},{\"pbrMetallicRoughness\":{\"roughnessFactor\":0,\"metallicFactor\":0,"
    "\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[2,2]}"
    "}}},\"normalTexture\":{\"index\":0},\"extensions\":{\"KHR_materials_transmission\":{"
    "\"transmissionFactor\":1},\"KHR_materials_volume\":{\"thicknessFactor\":1,"
    "\"attenuationDistance\":1,\"attenuationColor\":[0.5,0.5,0]}}}],\"textures\":[{\"source\":0}],"
    "\"images\":[{\"bufferView\":6,\"mimeType\":\"image/png\"}],\"meshes\":[{\"primitives\":[{"
    "\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"JOINTS_0\":3,\"WEIGHTS_0\":4},"
    "\"indices\":5,\"material\":0}]},{\"primitives\":[{\"attributes\":{\"POSITION\":6,"
    "\"TEXCOORD_0\":2},\"mode\":5,\"material\":1}]}],\"animations\":[{\"channels\":[{\"sampler\":0,"
    "\"target\":{\"node\":1,\"path\":\"translation\"}}],\"samplers\":[{\"input\":7,\"output\":6}]}"
    "],\"accessors\":["
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],"
    "\"max\":[1,1,0]},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
    "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
    "{\"bufferView\":3,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"},"
    "{\"bufferView\":4,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC4\"},"
    "{\"bufferView\":5,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],"
    "\"max\":[1,1,0],\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":5,\"componentType\":5123},"
    "\"values\":{\"bufferView\":0}}},"
    "{\"bufferView\":7,\"componentType\":5126,\"count\":4,\"type\":\"SCALAR\",\"min\":[0],"
    "\"max\":[3]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},"
    "{\"buffer\":0,\"byteOffset\":128,\"byteLength\":16},"
    "{\"buffer\":0,\"byteOffset\":144,\"byteLength\":16},"
    "{\"buffer\":0,\"byteOffset\":160,\"byteLength\":12},"
    "{\"buffer\":0,\"byteOffset\":188,\"byteLength\":69},"
    "{\"buffer\":0,\"byteOffset\":172,\"byteLength\":16}],\"buffers\":[{\"byteLength\":257}]}";

typedef struct Data {
  float positions[4][3], normals[4][3], uv[4][2];
  uint8_t joints[4][4], weights[4][4];
  uint16_t indices[6];
  float times[4];
} Data;

static const Data data = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                          {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                          {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
                          {{0, 1}, {0, 1}, {0, 1}, {0, 1}},
                          {{255}, {0, 255}, {128, 127}, {255}},
                          {0, 1, 2, 2, 1, 3},
                          {0, 1, 2, 3}};

static const uint8_t png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
    0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x18,
    0x57, 0x63, 0xf8, 0xcf, 0xf0, 0x1f, 0x00, 0x04, 0x00, 0x01, 0xff, 0x88, 0xd0, 0xfd,
    0xcc, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static uint8_t whole[8192];

static size_t put_chunk(size_t at, uint32_t type, const void *from, size_t size) {
  uint32_t head[2] = {(uint32_t)(size + 3) & ~3u, type};
  memcpy(whole + at, head, 8);
  memset(whole + at + 8, type == 0x4e4f534a ? ' ' : 0, head[0]);
  memcpy(whole + at + 8, from, size);
  return at + 8 + head[0];
}

static size_t make_whole(void) {
  uint8_t binary[sizeof data + sizeof png];
  memcpy(binary, &data, sizeof data);
  memcpy(binary + sizeof data, png, sizeof png);
  size_t at = put_chunk(12, 0x4e4f534a, document, sizeof document - 1);
  at = put_chunk(at, 0x004e4942, binary, sizeof binary);
  uint32_t head[3] = {0x46546c67, 2, (uint32_t)at};
  memcpy(whole, head, 12);
  return at;
}

/* PCG: O'Neill 2014. */
static uint32_t random_next(uint64_t *state) {
  uint64_t old = *state;
  *state = old * 6364136223846793005u + 1442695040888963407u;
  uint32_t x = (uint32_t)(((old >> 18) ^ old) >> 27), r = (uint32_t)(old >> 59);
  return x >> r | x << (-r & 31);
}

/* Mostly digits become other digits, or a second digit is put over what follows: broken JSON is
 * refused at once, while numbers are what the checks are about. */
static void change(uint8_t *bytes, size_t size, uint64_t *random) {
  static const char likely[] = "0123456789-.e,:[]{}\"";
  uint32_t count = 1 + random_next(random) % 3, json = (uint32_t)sizeof document + 20;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t how = random_next(random);
    uint8_t *at = bytes + random_next(random) % size;
    while ((how & 31) && at < bytes + json && !(*at >= '0' && *at <= '9'))
      at = bytes + random_next(random) % size;
    if (how & 31 && at < bytes + json)
      *at = (uint8_t)('0' + (how >> 5) % 10);
    else if (how & 32)
      *at = (uint8_t)likely[(how >> 6) % (sizeof likely - 1)];
    else if (how & 64)
      *at ^= (uint8_t)(1 << (how >> 7) % 8);
    else
      *at = (uint8_t)(how >> 8);
  }
}

static void test_whole(void **state) {
  (void)state;
  scene_write("fuzz.glb", whole, make_whole());
  struct cdl_Scene *scene = scene_open("fuzz.glb", 1.5);
  if (!scene) print_message("%s", scene_errors);
  assert_non_null(scene);
  assert_int_equal(scene->mesh_count, 2);
  assert_int_equal(scene->instance_count, 5);
  assert_int_equal(scene->image_count, 1);
  scene_free(scene);
}

static void test_changed(void **state) {
  (void)state;
  static uint8_t bytes[sizeof whole];
  size_t size = make_whole();
  uint64_t random = 1;
  double seconds = getenv("CDL_SOAK") ? 300 : 3, start = clock_now();
  int refused = 0, accepted = 0;
  while (clock_now() - start < seconds) {
    memcpy(bytes, whole, size);
    change(bytes, size, &random);
    size_t cut = random_next(&random) % 64 ? size : random_next(&random) % size;
    scene_write("fuzz.glb", bytes, cut);
    struct cdl_Scene *scene = scene_open("fuzz.glb", 1.5);
    assert_int_equal(scene_status, scene ? CDL_OK : CDL_BAD_INPUT);
    assert_int_equal(scene_error_count, scene ? 0 : 1);
    accepted += scene != NULL;
    refused += scene == NULL;
    scene_free(scene);
  }
  print_message("%d refused, %d accepted\n", refused, accepted);
  assert_true(refused > 10 && accepted > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_whole), cmocka_unit_test(test_changed)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
