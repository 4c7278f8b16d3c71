/* test_scene_layers.c: the layers and lobes that extensions add to glTF's material. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/build.h"
#include "scene_text.h"

#define NEAR(a, b) assert_true(fabs((double)(a) - (double)(b)) < 1e-5)
/* Of the extinction, as much scatters as gives the colour by many collisions: for white, all. */
static void test_volume_scatter(void **state) {
  (void)state;
  struct cdl_Scene *scene = material_scene(
      "\"KHR_materials_transmission\",\"KHR_materials_volume\",\"KHR_materials_volume_scatter\"",
      "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
      "\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":2,"
      "\"attenuationColor\":[0.5,0.5,0.25]},\"KHR_materials_volume_scatter\":{"
      "\"multiscatterColor\":[1,0,0.5],\"scatterAnisotropy\":-0.5}}");
  assert_non_null(scene);
  const cdl_SceneMedium *medium = &scene->media[scene->materials[0].medium];
  NEAR(medium->scattering[0], log(2) / 2);
  NEAR(medium->absorption[0], 0);
  NEAR(medium->scattering[1], 0);
  NEAR(medium->absorption[1], log(2) / 2);
  /* The albedo a of a collision returns (1 - s) (1 - 0.139 s) / (1 + 1.17 s) of what comes from all
   * around, s = sqrt(1 - a) (van de Hulst 1980). */
  double s = sqrt(medium->absorption[2] / (medium->absorption[2] + medium->scattering[2]));
  assert_true(fabs((1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s) - 0.5) < 0.005);
  NEAR(medium->absorption[2] + medium->scattering[2], log(4) / 2);
  NEAR(medium->phase.g[0], -0.5);
  scene_free(scene);
}

static const cdl_SceneParamTexture *texture_over(const cdl_SceneMaterial *m, uint32_t word) {
  for (uint32_t i = 0; i < m->texture_count; i++)
    if (m->textures[i].param == word) return &m->textures[i];
  fail_msg("no texture over word %u", word);
  return NULL;
}

static void check_texture(const cdl_SceneMaterial *m, uint32_t word, uint32_t channel, float offset,
                          float scale, int is_color) {
  const cdl_SceneParamTexture *t = texture_over(m, word);
  assert_int_equal(t->channel, channel);
  NEAR(t->offset, offset);
  NEAR(t->scale[0], scale);
  assert_int_equal(t->is_color, is_color);
}

/* Each member of the extensions, with the channels that they prescribe. */
static void test_layers(void **state) {
  (void)state;
  struct cdl_Scene *scene = material_scene(
      "\"KHR_materials_anisotropy\",\"KHR_materials_clearcoat\",\"KHR_materials_sheen\","
      "\"KHR_materials_iridescence\",\"KHR_materials_specular\",\"KHR_materials_transmission\","
      "\"KHR_materials_diffuse_transmission\"",
      "\"extensions\":{\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.5,"
      "\"anisotropyRotation\":0.5,\"anisotropyTexture\":{\"index\":0}},"
      "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.25,\"clearcoatRoughnessFactor\":0.75,"
      "\"clearcoatTexture\":{\"index\":0},\"clearcoatRoughnessTexture\":{\"index\":1},"
      "\"clearcoatNormalTexture\":{\"index\":1,\"scale\":0.5}},"
      "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.1,0.2,0.3],\"sheenColorTexture\":"
      "{\"index\":0},\"sheenRoughnessFactor\":0.5,\"sheenRoughnessTexture\":{\"index\":0}},"
      "\"KHR_materials_iridescence\":{\"iridescenceFactor\":1,\"iridescenceThicknessMinimum\":200,"
      "\"iridescenceThicknessMaximum\":500,\"iridescenceThicknessTexture\":{\"index\":0}},"
      "\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularTexture\":{\"index\":0}},"
      "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5,\"transmissionTexture\":"
      "{\"index\":0}},\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":0.25,"
      "\"diffuseTransmissionTexture\":{\"index\":0}}}");
  assert_non_null(scene);
  const cdl_SceneMaterial *m = &scene->materials[0];
  assert_int_equal(m->model, CDL_MODEL_GLTF_LAYERED);
  assert_int_equal(scene_gltf_layers(m), CDL_GLTF_LAYER_ANISOTROPY | CDL_GLTF_LAYER_CLEARCOAT |
                                             CDL_GLTF_LAYER_SHEEN | CDL_GLTF_LAYER_IRIDESCENCE |
                                             CDL_GLTF_LAYER_TRANSMISSION |
                                             CDL_GLTF_LAYER_DIFFUSE_TRANSMISSION);
  enum { R, G, B, A };
  check_texture(m, CDL_GLTF_LAYERED_ANISOTROPY_STRENGTH, B, 0, 0.5f, 0);
  check_texture(m, CDL_GLTF_LAYERED_ANISOTROPY_DIRECTION, R, -1, 2, 0);
  check_texture(m, CDL_GLTF_LAYERED_ANISOTROPY_DIRECTION + 1, G, -1, 2, 0);
  check_texture(m, CDL_GLTF_LAYERED_CLEARCOAT, R, 0, 0.25f, 0);
  check_texture(m, CDL_GLTF_LAYERED_CLEARCOAT_ROUGHNESS, G, 0, 0.75f, 0);
  check_texture(m, CDL_GLTF_LAYERED_SHEEN_COLOR, R, 0, 0.1f, 1);
  check_texture(m, CDL_GLTF_LAYERED_SHEEN_ROUGHNESS, A, 0, 0.5f, 0);
  check_texture(m, CDL_GLTF_LAYERED_IRIDESCENCE_THICKNESS, G, 200, 300, 0);
  check_texture(m, CDL_GLTF_LAYERED_SPECULAR, A, 0, 0.5f, 0);
  check_texture(m, CDL_GLTF_LAYERED_TRANSMISSION, R, 0, 0.5f, 0);
  check_texture(m, CDL_GLTF_LAYERED_DIFFUSE_TRANSMISSION, A, 0, 0.25f, 0);
  NEAR(m->param[CDL_GLTF_LAYERED_ANISOTROPY_ROTATION], cos(0.5));
  NEAR(m->param[CDL_GLTF_LAYERED_ANISOTROPY_ROTATION + 1], sin(0.5));
  NEAR(m->coat_normal_scale, 0.5);
  NEAR(m->param[CDL_GLTF_LAYERED_IRIDESCENCE_IOR], 1.3);
  NEAR(m->param[CDL_GLTF_LAYERED_SPECULAR_COLOR + 1], 1);
  assert_true(m->thin && m->transmits && m->anisotropic);
  scene_free(scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_layers),
                                     cmocka_unit_test(test_volume_scatter)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
