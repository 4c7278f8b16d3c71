/* scene.c: from a path to a scene, and its end. */
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/clock.h"
#include "core/hash.h"
#include "core/text.h"
#include "scene/build.h"
#include "scene/check.h"
#include "scene/choice.h"
#include "scene/motion.h"
#include "scene/pose.h"

char *string_copy(const char *text) { return strdup(text ? text : ""); }

void *array_push(void **array, uint32_t count, size_t size) {
  /* Capacities are powers of two: only then must the array grow. */
  if ((count & (count - 1)) == 0) {
    size_t room = count ? 2 * (size_t)count : 1;
    void *more = realloc(*array, room * size);
    if (!more) return NULL;
    *array = more;
  }
  return memset((char *)*array + count * size, 0, size);
}

static uint32_t *none_map(const json_t *list) {
  size_t count = json_array_size(list) + 1;
  uint32_t *map = malloc(count * sizeof *map);
  if (map) memset(map, 0xff, count * sizeof *map);
  return map;
}

static uint32_t scene_index(const Document *doc) {
  uint32_t index = json_get_index(doc->root, "scene");
  if (index != DOCUMENT_NONE) return index;
  return json_object_get(doc->root, "scenes") ? 0 : DOCUMENT_NONE;
}

static int emits(const struct cdl_Scene *scene) {
  for (uint32_t i = 0; i < scene->instance_count; i++) {
    const float *e = scene->materials[scene->meshes[scene->instances[i].mesh].material].emission;
    if (e[0] > 0 || e[1] > 0 || e[2] > 0) return 1;
  }
  for (uint32_t i = 0; i < scene->medium_count; i++) {
    const float *e = scene->media[i].emission;
    if (e[0] > 0 || e[1] > 0 || e[2] > 0) return 1;
  }
  return 0;
}

/* What a file leaves open: a light, and a camera. */
static cdl_Status complete_scene(Builder *builder) {
  struct cdl_Scene *scene = builder->scene;
  if (!scene->environment.present && scene->light_count == 0 && !emits(scene)) {
    scene->environment = (cdl_SceneEnvironment){
        .present = 1, .assumed = 1, .image = CDL_NONE, .radiance = {1, 1, 1}, .strength = 1};
  }
  if (scene->camera_count > 0) return CDL_OK;
  cdl_SceneCamera *camera = array_push((void **)&scene->cameras, 0, sizeof *camera);
  if (!camera || !(camera->name = string_copy("framing")))
    return document_out_of_memory(builder->doc);
  scene_frame_camera(scene->bounds, camera);
  scene->camera_count = 1;
  return CDL_OK;
}

static cdl_Status build_scene(Builder *builder) {
  Document *doc = builder->doc;
  uint32_t index = scene_index(doc);
  cdl_Status status = build_extensions(builder);
  if (!status) status = build_animations(builder);
  if (!status) status = build_variants(builder);
  if (!status) status = build_materials(builder);
  if (!status && index != DOCUMENT_NONE && !builder->shapes_only)
    status = build_scene_extensions(builder, index,
                                    json_array_get(json_object_get(doc->root, "scenes"), index));
  if (!status) status = gltf_build(builder);
  if (builder->shapes_only) return status;
  if (!status) status = build_images(builder);
  if (!status) status = complete_scene(builder);
  if (!status) hash_hex(&doc->hash, builder->scene->sha256);
  return status;
}

static cdl_Status convert(Document *doc, const cdl_SceneOptions *options, int shapes_only,
                          struct cdl_Scene **out) {
  Builder builder = {.doc = doc,
                     .shapes_only = shapes_only,
                     .scene = calloc(1, sizeof *builder.scene),
                     .texture_map = none_map(json_object_get(doc->root, "textures")),
                     .image_map = none_map(json_object_get(doc->root, "images")),
                     .default_material = CDL_NONE};
  cdl_Status status = variant_find(doc, options->variant, &builder.variant);
  if (status) goto done;
  if (!builder.scene || !builder.texture_map || !builder.image_map) {
    status = document_out_of_memory(doc);
    goto done;
  }
  builder.scene->medium = CDL_NONE;
  builder.scene->environment.image = CDL_NONE;
  builder.scene->path = text_duplicate(doc->path);
  if (!builder.scene->path) {
    status = document_out_of_memory(doc);
    goto done;
  }
  for (int c = 0; c < 3; c++)
    builder.scene->bounds[0][c] = INFINITY, builder.scene->bounds[1][c] = -INFINITY;
  status = build_scene(&builder);
done:
  free(builder.texture_map);
  free(builder.image_map);
  free(builder.image_sources);
  if (!status)
    *out = builder.scene;
  else
    scene_free(builder.scene);
  return status;
}

/* --- Poses: the document at rest is kept, and a copy of it posed for each. */

typedef struct Load {
  Document *doc;
  const cdl_SceneOptions *options;
} Load;

static void write_errors(void *user, cdl_LogLevel level, const char *message) {
  const cdl_Log *log = user;
  if (level == CDL_LOG_ERROR && log && log->write) log->write(log->user, level, message);
}

/* What is odd about a file is said once. */
static cdl_Status build_pose(void *user, double time, int first, struct cdl_Scene **scene) {
  Load *load = user;
  Document *doc = load->doc;
  json_t *rest = doc->root;
  const cdl_Log *log = doc->log;
  const cdl_Log errors = {write_errors, (void *)log};
  doc->root = json_deep_copy(rest);
  if (!first) doc->log = &errors;
  cdl_Status status =
      doc->root ? pose_document(doc, time, load->options->animation) : document_out_of_memory(doc);
  if (!status) status = convert(doc, load->options, !first, scene);
  json_decref(doc->root);
  doc->root = rest;
  doc->log = log;
  return status;
}

static int any_open_shutter(const Document *doc) {
  const json_t *cameras = json_object_get(doc->root, "cameras");
  for (size_t i = 0; i < json_array_size(cameras); i++) {
    float shutter[2] = {0, 0};
    json_get_numbers(json_get_extension(json_array_get(cameras, i), "CDL_camera"), "shutter", 2,
                     shutter);
    if (shutter[1] > shutter[0]) return 1;
  }
  return 0;
}

/* The first without a name. NULL where there is none: camera_find() says so. */
static const cdl_SceneCamera *find_camera(const struct cdl_Scene *scene, const char *name) {
  Choice cameras = choice_of_cameras(scene);
  uint32_t index = name ? choice_find(&cameras, name) : 0;
  return index < scene->camera_count ? &scene->cameras[index] : NULL;
}

/* When the shutter of the camera opens and closes, in animation time; 0: it does not. */
static cdl_Status exposure(Load *load, double time, double *open, double *close, int *exposes) {
  struct cdl_Scene *scene = NULL;
  *exposes = 0;
  if (!any_open_shutter(load->doc) || !json_object_get(load->doc->root, "animations"))
    return CDL_OK;
  cdl_Status status = build_pose(load, time, 0, &scene);
  const cdl_SceneCamera *camera = status ? NULL : find_camera(scene, load->options->camera);
  if (camera && camera->shutter[1] > camera->shutter[0]) {
    *open = time + camera->shutter[0];
    *close = time + camera->shutter[1];
    *exposes = 1;
  }
  scene_free(scene);
  return status;
}

static cdl_Status load_scene(Document *doc, const cdl_SceneOptions *options,
                             struct cdl_Scene **scene) {
  Load load = {doc, options};
  cdl_MotionSource source = {build_pose, &load, doc->log};
  double open, close, time = fmax(options->time, 0);
  int exposes, changes = 0;
  cdl_Status status = exposure(&load, time, &open, &close, &exposes);
  if (status) return status;
  if (exposes) {
    status = motion_build(&source, open, close, &changes, scene);
    if (changes)
      document_note(doc, NULL, "/animations",
                    "things appear or vanish while the shutter is open; nothing is blurred.");
    return status;
  }
  if (options->time >= 0 || options->animation) return build_pose(&load, time, 1, scene);
  return convert(doc, options, 0, scene);
}

cdl_Status scene_load(const cdl_Log *log, const char *path, const cdl_SceneOptions *options,
                      struct cdl_Scene **scene) {
  const cdl_SceneOptions rest = {.time = -1};
  Document doc;
  double start = clock_now();
  cdl_Status status = document_open(log, path, &doc);
  if (!status) status = check_document(&doc);
  if (!status) status = load_scene(&doc, options ? options : &rest, scene);
  document_close(&doc);
  if (!status) (*scene)->load_s = clock_now() - start;
  return status;
}

static void free_mesh(cdl_SceneMesh *mesh) {
  free(mesh->positions);
  free(mesh->normals);
  free(mesh->tangents);
  free(mesh->uv[0]);
  free(mesh->uv[1]);
  free(mesh->colors);
  free(mesh->indices);
  free(mesh->name);
}

void scene_free(struct cdl_Scene *scene) {
  if (!scene) return;
  for (uint32_t i = 0; i < scene->later_count; i++) scene_free(scene->later[i]);
  free(scene->later);
  for (uint32_t i = 0; i < scene->mesh_count; i++) free_mesh(&scene->meshes[i]);
  for (uint32_t i = 0; i < scene->material_count; i++) free(scene->materials[i].name);
  for (uint32_t i = 0; i < scene->image_count; i++) {
    image_free(scene->images[i]);
    free(scene->image_names[i]);
  }
  for (uint32_t i = 0; i < scene->light_count; i++) free(scene->lights[i].name);
  for (uint32_t i = 0; i < scene->camera_count; i++) free(scene->cameras[i].name);
  for (uint32_t i = 0; i < scene->extension_count; i++) free(scene->extensions[i].name);
  for (uint32_t i = 0; i < scene->object_count; i++) free(scene->object_names[i]);
  for (uint32_t i = 0; i < scene->animation_count; i++) free(scene->animations[i].name);
  for (uint32_t i = 0; i < scene->variant_count; i++) free(scene->variants[i]);
  free(scene->meshes);
  free(scene->instances);
  free(scene->materials);
  free(scene->textures);
  free(scene->images);
  free(scene->image_names);
  free(scene->lights);
  free(scene->cameras);
  for (uint32_t i = 0; i < scene->grid_count; i++) grid_free(&scene->grids[i]);
  free(scene->grids);
  free(scene->media);
  free(scene->extensions);
  free(scene->object_names);
  free(scene->animations);
  free(scene->variants);
  free(scene->path);
  free(scene);
}
