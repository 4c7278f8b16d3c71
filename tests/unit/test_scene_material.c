/* test_scene_material.c: materials, textures, media and surroundings whose values the test wrote.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/build.h"
#include "scene_text.h"

#define HEAD "{\"asset\":{\"version\":\"2.0\"},"
#define NEAR(a, b) assert_true(fabs((double)(a) - (double)(b)) < 1e-5)
static void test_core(void **state) {
  (void)state;
  struct cdl_Scene *scene = material_scene(
      "\"KHR_materials_emissive_strength\",\"KHR_materials_ior\",\"KHR_texture_transform\"",
      "\"name\":\"m\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.4],"
      "\"metallicFactor\":0.25,\"roughnessFactor\":0.75,\"baseColorTexture\":{\"index\":1,"
      "\"texCoord\":1,\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.5,0.25],"
      "\"rotation\":1.5707963267948966,\"scale\":[2,3]}}}},\"normalTexture\":{\"index\":0,"
      "\"scale\":0.5},\"emissiveFactor\":[1,0.5,0],\"alphaMode\":\"MASK\",\"alphaCutoff\":0.7,"
      "\"doubleSided\":true,\"extensions\":{\"KHR_materials_emissive_strength\":{"
      "\"emissiveStrength\":8},\"KHR_materials_ior\":{\"ior\":1.8}}");
  assert_non_null(scene);
  const cdl_SceneMaterial *m = &scene->materials[0];
  assert_string_equal(m->name, "m");
  assert_int_equal(m->model, CDL_MODEL_GLTF);
  NEAR(m->base[3], 0.4);
  NEAR(m->param[CDL_GLTF_METALLIC], 0.25);
  NEAR(m->param[CDL_GLTF_ROUGHNESS], 0.75);
  NEAR(m->param[CDL_GLTF_IOR], 1.8);
  NEAR(m->emission[0], 8);
  NEAR(m->emission[1], 4);
  NEAR(m->alpha_cutoff, 0.7);
  NEAR(m->normal_scale, 0.5);
  assert_int_equal(m->alpha_mode, CDL_ALPHA_MASK);
  assert_true(m->double_sided);
  /* A quarter turn maps (u, v), after the scale, to (v, -u): KHR_texture_transform's own matrix. */
  static const double transform[6] = {0, 3, 0.5, -2, 0, 0.25};
  for (int i = 0; i < 6; i++) NEAR(m->base_texture.transform[i], transform[i]);
  assert_int_equal(m->base_texture.uv_set, 1);
  const cdl_SceneTexture *t = &scene->textures[m->base_texture.texture];
  assert_int_equal(t->wrap_s, CDL_WRAP_CLAMP);
  assert_int_equal(t->wrap_t, CDL_WRAP_MIRROR);
  assert_true(t->nearest);
  assert_int_equal(scene->textures[m->normal_texture.texture].wrap_s, CDL_WRAP_REPEAT);
  assert_int_equal(scene->image_count, 1); /* two textures share it */
  assert_non_null(scene->images[0]);
  scene_free(scene);
}

/* Clear glass becomes a dielectric that absorbs: what is left after 2 m is the colour. */
static void test_volume(void **state) {
  (void)state;
  const char *used = "\"KHR_materials_transmission\",\"KHR_materials_volume\"";
  const char *glass = "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":%s},"
                      "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
                      "\"KHR_materials_volume\":{\"thicknessFactor\":%s,"
                      "\"attenuationDistance\":2,\"attenuationColor\":[0.5,1,0.25]}}";
  char text[512];
  snprintf(text, sizeof text, glass, "0", "1");
  struct cdl_Scene *scene = material_scene(used, text);
  assert_non_null(scene);
  assert_int_equal(scene->materials[0].model, CDL_MODEL_DIELECTRIC);
  assert_int_equal(scene->materials[0].thin, 0);
  assert_int_equal(scene->medium_count, 1);
  const cdl_SceneMedium *medium = &scene->media[scene->materials[0].medium];
  NEAR(exp(-2 * medium->absorption[0]), 0.5);
  NEAR(exp(-2 * medium->absorption[1]), 1);
  NEAR(exp(-2 * medium->absorption[2]), 0.25);
  NEAR(medium->scattering[0], 0);
  scene_free(scene);
  snprintf(text, sizeof text, glass, "0", "0");
  scene = material_scene(used, text);
  assert_non_null(scene);
  assert_int_equal(scene->materials[0].thin, 1);
  assert_int_equal(scene->materials[0].medium, CDL_NONE);
  scene_free(scene);
  snprintf(text, sizeof text, glass, "0.3", "1");
  scene = material_scene(used, text);
  assert_non_null(scene);
  assert_int_equal(scene->materials[0].model, CDL_MODEL_GLTF_LAYERED);
  assert_int_equal(scene_gltf_layers(&scene->materials[0]), CDL_GLTF_LAYER_TRANSMISSION);
  assert_true(scene->materials[0].transmits && !scene->materials[0].thin);
  assert_int_equal(scene->medium_count, 1);
  scene_free(scene);
}

static struct cdl_Scene *cdl_scene(const char *members) {
  char text[512];
  snprintf(text, sizeof text, "\"extensions\":{\"CDL_material\":{%s}}", members);
  return material_scene("\"CDL_material\"", text);
}

static void test_cdl_models(void **state) {
  (void)state;
  static const struct {
    const char *members;
    uint32_t model;
    float base;
    uint32_t alpha_word;
    float alpha[2];
    uint32_t ior_word;
    float ior;
  } cases[] = {
      {"\"model\":\"diffuse\"", CDL_MODEL_DIFFUSE, 0.5f, 0, {0, 0}, 0, 0},
      {"\"model\":\"diffuse\",\"reflectance\":0.25", CDL_MODEL_DIFFUSE, 0.25f, 0, {0, 0}, 0, 0},
      {"\"model\":\"mirror\"", CDL_MODEL_MIRROR, 1, 0, {0, 0}, 0, 0},
      {"\"model\":\"retroreflector\"",
       CDL_MODEL_RETROREFLECTOR,
       1,
       CDL_RETROREFLECTOR_ALPHA,
       {0.05f, 0.05f},
       CDL_RETROREFLECTOR_IOR,
       1.5f},
      {"\"model\":\"dielectric\",\"ior\":1.33,\"transmittance\":[0.5,1,1]",
       CDL_MODEL_DIELECTRIC,
       0.5f,
       CDL_PARAM_MAX - 2,
       {0, 0},
       CDL_DIELECTRIC_IOR,
       1.33f},
      {"\"model\":\"conductor\",\"alpha\":[0.1,0.4]",
       CDL_MODEL_CONDUCTOR,
       1,
       CDL_CONDUCTOR_ALPHA,
       {0.1f, 0.4f},
       CDL_PARAM_MAX - 1,
       0},
      {"\"model\":\"conductor\",\"alpha\":0.3",
       CDL_MODEL_CONDUCTOR,
       1,
       CDL_CONDUCTOR_ALPHA,
       {0.3f, 0.3f},
       CDL_PARAM_MAX - 1,
       0},
      {"\"model\":\"interface\"", CDL_MODEL_INTERFACE, 1, 0, {0, 0}, 0, 0},
      {"\"model\":\"hair\"", CDL_MODEL_GLTF, 1, CDL_PARAM_MAX - 2, {0, 0}, CDL_GLTF_IOR, 1.5f}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct cdl_Scene *scene = cdl_scene(cases[i].members);
    assert_non_null(scene);
    const cdl_SceneMaterial *m = &scene->materials[0];
    assert_int_equal(m->model, cases[i].model);
    NEAR(m->base[0], cases[i].base);
    for (uint32_t k = 0; k < 2; k++) NEAR(m->param[cases[i].alpha_word + k], cases[i].alpha[k]);
    NEAR(m->param[cases[i].ior_word], cases[i].ior);
    int supported = cases[i].model != CDL_MODEL_GLTF;
    assert_int_equal(scene->extensions[0].state,
                     supported ? CDL_EXTENSION_USED : CDL_EXTENSION_UNSUPPORTED);
    scene_free(scene);
  }
}

static void test_cdl_conductor(void **state) {
  (void)state;
  struct cdl_Scene *scene =
      cdl_scene("\"model\":\"conductor\",\"eta\":[1,2,3],\"k\":4,\"distribution\":\"beckmann\","
                "\"masking\":\"separable\"");
  assert_non_null(scene);
  NEAR(scene->materials[0].param[CDL_CONDUCTOR_ETA + 2], 3);
  NEAR(scene->materials[0].param[CDL_CONDUCTOR_K + 1], 4);
  assert_int_equal(scene->materials[0].distribution, CDL_BECKMANN);
  assert_int_equal(scene->materials[0].masking, CDL_MASKING_SEPARABLE);
  scene_free(scene);
}

/* Numbers that others have integrated from the same measurements. */
static void test_metals(void **state) {
  (void)state;
  static const struct {
    const char *name;
    float eta[3], k[3];
  } known[] = {{"Au", {0.143f, 0.375f, 1.442f}, {3.983f, 2.386f, 1.603f}},
               {"Cu", {0.200f, 0.924f, 1.102f}, {3.912f, 2.452f, 2.142f}},
               {"Ag", {0.155f, 0.117f, 0.138f}, {4.828f, 3.122f, 2.147f}},
               {"Al", {1.657f, 0.880f, 0.521f}, {9.224f, 6.270f, 4.837f}}};
  static const char *const names[] = {"Fe", "Cr", "Ti", "W", "Pt", "Ni"};
  float eta[3], k[3];
  for (int i = 0; i < 4; i++) {
    assert_true(metal_index(known[i].name, eta, k));
    for (int c = 0; c < 3; c++) {
      assert_true(fabsf(eta[c] - known[i].eta[c]) < 0.0015f);
      assert_true(fabsf(k[c] - known[i].k[c]) < 0.0015f);
    }
  }
  /* At normal incidence these reflect between 40 and 75 %, nearly grey. */
  for (int i = 0; i < 6; i++) {
    assert_true(metal_index(names[i], eta, k));
    for (int c = 0; c < 3; c++) {
      double a = (eta[c] - 1) * (eta[c] - 1) + k[c] * k[c];
      double r = a / (a + 4 * eta[c]);
      assert_true(r > 0.4 && r < 0.75);
    }
  }
  assert_false(metal_index("Xx", eta, k));
}

static void refused(const char *members, const char *pointer, const char *code) {
  char wanted[256];
  assert_null(cdl_scene(members));
  assert_int_equal(scene_status, CDL_BAD_INPUT);
  assert_int_equal(scene_error_count, 1);
  snprintf(wanted, sizeof wanted, ": /materials/0/extensions/CDL_material%s: %s: ", pointer, code);
  if (!strstr(scene_errors, wanted)) print_message("%s", scene_errors);
  assert_non_null(strstr(scene_errors, wanted));
}

static void test_cdl_errors(void **state) {
  (void)state;
  refused("\"model\":\"diffus\"", "/model", "VALUE_NOT_IN_LIST");
  refused("\"model\":7", "/model", "TYPE_MISMATCH");
  refused("\"reflectance\":1", "", "UNDEFINED_PROPERTY");
  refused("\"model\":\"diffuse\",\"reflectance\":[0,2,0]", "/reflectance/1", "VALUE_NOT_IN_RANGE");
  refused("\"model\":\"diffuse\",\"reflectance\":[0,0]", "/reflectance",
          "ARRAY_LENGTH_NOT_IN_LIST");
  refused("\"model\":\"dielectric\",\"ior\":0", "/ior", "VALUE_NOT_IN_RANGE");
  refused("\"model\":\"conductor\",\"metal\":\"Xx\"", "/metal", "VALUE_NOT_IN_LIST");
  refused("\"model\":\"conductor\",\"eta\":1", "", "UNSATISFIED_DEPENDENCY");
  refused("\"model\":\"mirror\",\"reflectanceTexture\":{\"index\":9}", "/reflectanceTexture/index",
          "UNRESOLVED_REFERENCE");
  struct cdl_Scene *scene = cdl_scene("\"model\":\"mirror\",\"reflectence\":1");
  assert_non_null(scene); /* unknown, so named, but no error */
  assert_non_null(strstr(scene_notes, "/reflectence: UNEXPECTED_PROPERTY"));
  scene_free(scene);
}

static void test_surroundings(void **state) {
  (void)state;
  struct cdl_Scene *scene =
      scene_from("%s", HEAD "\"extensionsUsed\":[\"CDL_environment\",\"CDL_medium\"],"
                            "\"scenes\":[{\"extensions\":{\"CDL_environment\":{"
                            "\"radiance\":[1,2,3],\"strength\":4,\"rotation\":-30},"
                            "\"CDL_medium\":{\"absorption\":[0.1,0.2,0.3],\"scattering\":0.5,"
                            "\"scale\":2,\"phase\":{\"type\":\"hg\",\"g\":0.7}}}}]}");
  assert_non_null(scene);
  assert_int_equal(scene->environment.image, CDL_NONE);
  NEAR(scene->environment.radiance[2], 3);
  NEAR(scene->environment.strength, 4);
  NEAR(scene->environment.rotation, -30);
  const cdl_SceneMedium *medium = &scene->media[scene->medium];
  NEAR(medium->absorption[1], 0.4);
  NEAR(medium->scattering[2], 1);
  NEAR(medium->phase.g[0], 0.7);
  scene_free(scene);
}

static void test_extensions(void **state) {
  (void)state;
  struct cdl_Scene *scene = scene_from(
      "%s",
      HEAD "\"extensionsUsed\":[\"KHR_materials_unlit\",\"KHR_materials_pbrSpecularGlossiness\","
           "\"KHR_xmp_json_ld\",\"ABC_unheard_of\"],\"materials\":[{"
           "\"extensions\":{\"KHR_materials_unlit\":{}}}]}");
  assert_non_null(scene);
  assert_int_equal(scene->materials[0].model, CDL_MODEL_UNLIT);
  assert_int_equal(scene->extension_count, 4);
  assert_int_equal(scene->extensions[0].state, CDL_EXTENSION_USED);
  assert_int_equal(scene->extensions[1].state, CDL_EXTENSION_UNSUPPORTED);
  assert_int_equal(scene->extensions[2].state, CDL_EXTENSION_IGNORED);
  assert_int_equal(scene->extensions[3].state, CDL_EXTENSION_UNSUPPORTED);
  scene_free(scene);
  assert_null(scene_from("%s", HEAD "\"extensionsUsed\":[\"KHR_unheard_of\"],"
                                    "\"extensionsRequired\":[\"KHR_unheard_of\"]}"));
  assert_non_null(strstr(scene_errors, "/extensionsRequired/0"));
  assert_non_null(strstr(scene_errors, "KHR_unheard_of"));
}

/* A square whose picture lies upright: u to the right, v downwards; then the same mirrored. The
 * bitangent, cross(n, t) w, points up the picture. */
static void test_tangents(void **state) {
  (void)state;
  for (int mirrored = 0; mirrored < 2; mirrored++) {
    float positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    float normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    float uv[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    for (int i = 0; mirrored && i < 4; i++) uv[2 * i] = 1 - uv[2 * i];
    cdl_SceneMesh mesh = {.vertex_count = 4,
                          .triangle_count = 2,
                          .positions = positions,
                          .normals = normals,
                          .uv = {uv, NULL},
                          .indices = indices};
    assert_int_equal(mesh_make_tangents(&mesh, 0), CDL_OK);
    for (int i = 0; i < 4; i++) {
      NEAR(mesh.tangents[4 * i], mirrored ? -1 : 1);
      NEAR(mesh.tangents[4 * i + 1], 0);
      NEAR(mesh.tangents[4 * i + 3], mirrored ? -1 : 1);
    }
    free(mesh.tangents);
  }
}

/* Tangents that an exporter wrote agree with those made from the same coordinates. */
static void test_tangents_of_asset(void **state) {
  (void)state;
  const char *path = "../shared/assets/FlightHelmet/FlightHelmet.gltf";
  struct cdl_Scene *scene = NULL;
  cdl_SceneOptions rest = {.time = -1};
  if (access(path, R_OK) != 0) {
    print_message("skipped: there is no file %s\n", path);
    skip();
  }
  assert_int_equal(scene_load(&scene_log, path, &rest, &scene), CDL_OK);
  uint64_t alike = 0, handed = 0, all = 0;
  for (uint32_t m = 0; m < scene->mesh_count; m++) {
    cdl_SceneMesh *mesh = &scene->meshes[m];
    float *given = mesh->tangents;
    assert_non_null(given);
    assert_int_equal(mesh_make_tangents(mesh, 0), CDL_OK);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
      const float *a = given + 4 * i, *b = mesh->tangents + 4 * i;
      alike += a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > 0.97f;
      handed += a[3] == b[3];
      all++;
    }
    free(given);
  }
  print_message("%.2f %% alike, %.2f %% of the same handedness\n",
                100.0 * (double)alike / (double)all, 100.0 * (double)handed / (double)all);
  assert_true((double)alike > 0.97 * (double)all);
  assert_true((double)handed > 0.99 * (double)all);
  scene_free(scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_core),         cmocka_unit_test(test_volume),
      cmocka_unit_test(test_cdl_models),   cmocka_unit_test(test_cdl_conductor),
      cmocka_unit_test(test_metals),       cmocka_unit_test(test_cdl_errors),
      cmocka_unit_test(test_surroundings), cmocka_unit_test(test_extensions),
      cmocka_unit_test(test_tangents),     cmocka_unit_test(test_tangents_of_asset)};
  return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
