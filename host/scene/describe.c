/* describe.c: what is in a scene, told as JSON and in words. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/text.h"
#include "scene/describe.h"

/* What is counted rather than stored. */
typedef struct Totals {
  uint64_t triangles, unique_triangles, memory;
  uint32_t emissive;
} Totals;

static uint64_t mesh_memory(const cdl_SceneMesh *mesh) {
  uint64_t floats = 3 + 3 * !!mesh->normals + 4 * !!mesh->tangents + 2 * !!mesh->uv[0] +
                    2 * !!mesh->uv[1] + 4 * !!mesh->colors;
  return 4 * floats * mesh->vertex_count + 12 * (uint64_t)mesh->triangle_count;
}

static uint64_t image_memory(const cdl_Image *image) {
  if (!image) return 0;
  uint64_t values = (uint64_t)image->width * (uint64_t)image->height * (uint64_t)image->channels;
  return image->f32 ? 4 * values : values;
}

static Totals count(const cdl_Scene *scene) {
  Totals totals = {0};
  for (uint32_t i = 0; i < scene->mesh_count; i++) {
    totals.unique_triangles += scene->meshes[i].triangle_count;
    totals.memory += mesh_memory(&scene->meshes[i]);
  }
  for (uint32_t i = 0; i < scene->image_count; i++) totals.memory += image_memory(scene->images[i]);
  totals.memory += grids_memory(scene);
  totals.memory += (uint64_t)scene->instance_count * sizeof *scene->instances;
  for (uint32_t i = 0; i < scene->instance_count; i++) {
    const cdl_SceneMesh *mesh = &scene->meshes[scene->instances[i].mesh];
    const float *e = scene->materials[mesh->material].emission;
    totals.triangles += mesh->triangle_count;
    totals.emissive += e[0] > 0 || e[1] > 0 || e[2] > 0;
  }
  return totals;
}

static uint32_t light_total(const cdl_Scene *scene, const Totals *totals) {
  return scene->light_count + totals->emissive + (uint32_t)scene->environment.present;
}

static json_t *json_of_materials(const cdl_Scene *scene) {
  json_t *list = json_array();
  for (uint32_t i = 0; i < scene->material_count; i++)
    json_array_append_new(list, json_pack("{s:s, s:s}", "name", scene->materials[i].name, "model",
                                          scene_model_name(scene->materials[i].model)));
  return list;
}

/* The phase function of each medium. */
static json_t *json_of_phases(const cdl_Scene *scene) {
  json_t *list = json_array();
  for (uint32_t i = 0; i < scene->medium_count; i++)
    json_array_append_new(list, json_string(scene->media[i].phase.type));
  return list;
}

static json_t *json_of_cameras(const cdl_Scene *scene) {
  json_t *list = json_array();
  for (uint32_t i = 0; i < scene->camera_count; i++)
    json_array_append_new(
        list, json_pack("{s:s, s:s}", "name", scene->cameras[i].name, "type",
                        scene->cameras[i].orthographic ? "orthographic" : "perspective"));
  return list;
}

static json_t *json_of_animations(const cdl_Scene *scene) {
  json_t *list = json_array();
  for (uint32_t i = 0; i < scene->animation_count; i++) {
    const cdl_SceneAnimation *a = &scene->animations[i];
    json_array_append_new(list,
                          json_pack("{s:s, s:f, s:f, s:I}", "name", a->name, "begin", a->begin,
                                    "end", a->end, "channels", (json_int_t)a->channels));
  }
  return list;
}

static json_t *json_of_variants(const cdl_Scene *scene) {
  json_t *list = json_array();
  for (uint32_t i = 0; i < scene->variant_count; i++)
    json_array_append_new(list, json_string(scene->variants[i]));
  return list;
}

static json_t *json_of_extensions(const cdl_Scene *scene) {
  json_t *lists[3] = {json_array(), json_array(), json_array()};
  for (uint32_t i = 0; i < scene->extension_count; i++)
    json_array_append_new(lists[scene->extensions[i].state],
                          json_string(scene->extensions[i].name));
  return json_pack("{s:o, s:o, s:o}", "used", lists[CDL_EXTENSION_USED], "ignored",
                   lists[CDL_EXTENSION_IGNORED], "unsupported", lists[CDL_EXTENSION_UNSUPPORTED]);
}

static json_t *json_of_bounds(const cdl_Scene *scene) {
  const float(*b)[3] = scene->bounds;
  if (b[0][0] > b[1][0]) return json_null();
  return json_pack("[[f, f, f], [f, f, f]]", b[0][0], b[0][1], b[0][2], b[1][0], b[1][1], b[1][2]);
}

static json_t *json_of_scene(const cdl_Scene *scene, const Totals *totals) {
  return json_pack(
      "{s:s, s:s, s:I, s:I, s:I, s:I, s:o, s:o, s:I, s:{s:I, s:I, s:b}, s:I, s:o, s:o, s:I, s:I, "
      "s:o, s:o, s:o, s:o, s:I, s:f}",
      "scene", scene->path, "sha256", scene->sha256, "meshes", (json_int_t)scene->mesh_count,
      "triangles", (json_int_t)totals->triangles, "unique_triangles",
      (json_int_t)totals->unique_triangles, "instances", (json_int_t)scene->instance_count,
      "materials", json_of_materials(scene), "cameras", json_of_cameras(scene), "lights",
      (json_int_t)light_total(scene, totals), "light_kinds", "punctual",
      (json_int_t)scene->light_count, "emissive_instances", (json_int_t)totals->emissive,
      "environment", scene->environment.present, "media", (json_int_t)scene->medium_count,
      "phase_functions", json_of_phases(scene), "grids", describe_grids(scene), "textures",
      (json_int_t)scene->texture_count, "images", (json_int_t)scene->image_count, "animations",
      json_of_animations(scene), "variants", json_of_variants(scene), "extensions",
      json_of_extensions(scene), "bounds", json_of_bounds(scene), "memory_bytes",
      (json_int_t)totals->memory, "load_s", scene->load_s);
}

static void print_lights(FILE *out, const cdl_Scene *scene, const Totals *totals) {
  fprintf(out, "lights      %u punctual, %u emissive %s, ", scene->light_count, totals->emissive,
          totals->emissive == 1 ? "shape" : "shapes");
  if (!scene->environment.present)
    fprintf(out, "no environment\n");
  else if (scene->environment.image == CDL_NONE)
    fprintf(out, scene->environment.assumed ? "a neutral environment, as there is no light\n"
                                            : "a constant environment\n");
  else
    fprintf(out, "environment %s\n", scene->image_names[scene->environment.image]);
}

static void print_extensions(FILE *out, const cdl_Scene *scene) {
  static const char *const labels[] = {"used", "ignored", "unsupported"};
  for (int state = 0; state < 3; state++) {
    int any = 0;
    for (uint32_t i = 0; i < scene->extension_count; i++) {
      if ((int)scene->extensions[i].state != state) continue;
      if (!any++) fprintf(out, "%-12s", labels[state]);
      fprintf(out, "%s%s", any > 1 ? ", " : "", scene->extensions[i].name);
    }
    if (any) fprintf(out, "\n");
  }
}

static const char *named(const char *name) { return *name ? name : "(no name)"; }

static void print_choices(FILE *out, const cdl_Scene *scene) {
  if (scene->animation_count) fprintf(out, "animations\n");
  for (uint32_t i = 0; i < scene->animation_count; i++)
    fprintf(out, "  %2u  %.4g to %.4g s  %s\n", i, scene->animations[i].begin,
            scene->animations[i].end, named(scene->animations[i].name));
  if (scene->variant_count) fprintf(out, "variants\n");
  for (uint32_t i = 0; i < scene->variant_count; i++)
    fprintf(out, "      %s\n", scene->variants[i]);
}

static void print_media(FILE *out, const cdl_Scene *scene) {
  fprintf(out, "media       %u%s\n", scene->medium_count,
          scene->medium != CDL_NONE ? ", one of them fills the scene" : "");
  for (uint32_t i = 0; i < scene->medium_count; i++) {
    const cdl_SceneMedium *m = &scene->media[i];
    fprintf(out, "  %2u  %-12s absorbs %.4g %.4g %.4g, scatters %.4g %.4g %.4g 1/m", i,
            m->phase.type, m->absorption[0], m->absorption[1], m->absorption[2], m->scattering[0],
            m->scattering[1], m->scattering[2]);
    if (m->density != CDL_NONE) fprintf(out, ", density of grid %u", m->density);
    if (m->temperature != CDL_NONE) fprintf(out, ", temperature of grid %u", m->temperature);
    if (m->color != CDL_NONE) fprintf(out, ", color of grid %u", m->color);
    fputc('\n', out);
  }
}

static void print_text(FILE *out, const cdl_Scene *scene, const Totals *totals) {
  const float(*b)[3] = scene->bounds;
  fprintf(out, "%s\n", scene->path);
  fprintf(out, "triangles   %llu in %u %s, %u %s (%llu unique)\n",
          (unsigned long long)totals->triangles, scene->mesh_count,
          scene->mesh_count == 1 ? "mesh" : "meshes", scene->instance_count,
          scene->instance_count == 1 ? "instance" : "instances",
          (unsigned long long)totals->unique_triangles);
  if (b[0][0] <= b[1][0])
    fprintf(out, "bounds      %.4g %.4g %.4g  to  %.4g %.4g %.4g m\n", b[0][0], b[0][1], b[0][2],
            b[1][0], b[1][1], b[1][2]);
  print_lights(out, scene, totals);
  print_media(out, scene);
  print_grids(out, scene);
  fprintf(out, "textures    %u on %u %s\n", scene->texture_count, scene->image_count,
          scene->image_count == 1 ? "image" : "images");
  fprintf(out, "memory      %.1f MB, loaded in %.3f s\n", (double)totals->memory / 1e6,
          scene->load_s);
  print_extensions(out, scene);
  fprintf(out, "cameras\n");
  for (uint32_t i = 0; i < scene->camera_count; i++)
    fprintf(out, "  %2u  %-14s %s\n", i,
            scene->cameras[i].orthographic ? "orthographic" : "perspective",
            named(scene->cameras[i].name));
  fprintf(out, "materials\n");
  for (uint32_t i = 0; i < scene->material_count; i++)
    fprintf(out, "  %2u  %-14s %s\n", i, scene_model_name(scene->materials[i].model),
            named(scene->materials[i].name));
  print_choices(out, scene);
}

char *cdl_scene_info_json(const cdl_Scene *scene) {
  Totals totals = count(scene);
  json_t *json = json_of_scene(scene, &totals);
  char *text = text_of_json(json);
  json_decref(json);
  return text;
}

char *cdl_scene_info_text(const cdl_Scene *scene) {
  Totals totals = count(scene);
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out) return NULL;
  print_text(out, scene, &totals);
  if (fclose(out) == 0) return text;
  free(text);
  return NULL;
}
