#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/matrix.h"
#include "scene/motion.h"
#include "scene/pack_parts.h"

/* The medium of a material that a grid fills, or CDL_NONE. */
static uint32_t grid_medium(const cdl_Scene *scene, const cdl_SceneInstance *instance) {
  const cdl_SceneMaterial *material = &scene->materials[scene->meshes[instance->mesh].material];
  if (material->medium == CDL_NONE) return CDL_NONE;
  return scene->media[material->medium].density != CDL_NONE ? material->medium : CDL_NONE;
}

/* `node_to_world` places the space that the medium's grids are given in. */
static void place(const cdl_SceneMedium *medium, const float node_to_world[12], cdl_Medium *to) {
  Matrix node = {{0}}, index = {{0}}, inverse, placed;
  for (int i = 0; i < 12; i++) {
    node.m[i] = node_to_world[i];
    index.m[i] = medium->to_index[i];
  }
  matrix_invert(&node, &inverse); /* what is flat encloses nothing */
  placed = matrix_multiply(&index, &inverse);
  matrix_to_float(&placed, to->to_grid);
}

static void pack_medium(const cdl_SceneMedium *from, cdl_Medium *to) {
  memcpy(to->absorption, from->absorption, sizeof to->absorption);
  memcpy(to->scattering, from->scattering, sizeof to->scattering);
  memcpy(to->emission, from->emission, sizeof to->emission);
  memcpy(to->g, from->phase.g, sizeof to->g);
  memcpy(to->alpha, from->phase.alpha, sizeof to->alpha);
  to->second = from->phase.second;
  to->density = from->density;
  to->temperature = from->temperature;
  to->color = from->color;
  to->temperature_scale = from->temperature_scale;
  to->walk = from->walk != 0;
  to->emissive = from->emission[0] > 0 || from->emission[1] > 0 || from->emission[2] > 0;
}

/* The instance before i that holds the same medium of the same node, another part of its surface:
 * primitives of a node are neighbours. CDL_NONE: there is none. */
static uint32_t same_body(const cdl_Scene *scene, uint32_t i) {
  uint32_t medium = grid_medium(scene, &scene->instances[i]);
  for (uint32_t k = i; k > 0 && scene->instances[k - 1].object == scene->instances[i].object; k--)
    if (grid_medium(scene, &scene->instances[k - 1]) == medium) return k - 1;
  return CDL_NONE;
}

static void note_motion(const cdl_Log *log, const cdl_Scene *scene) {
  for (uint32_t i = 0; scene->later_count && i < scene->instance_count; i++) {
    if (grid_medium(scene, &scene->instances[i]) == CDL_NONE || !motion_moves(scene, i)) continue;
    log_note(log, "%s: grids of media do not move while the shutter is open, only their boundaries",
             scene->path);
    return;
  }
}

/* Media whose grid is placed by a node follow all others, one for every node. */
static void place_media(const cdl_Scene *scene, cdl_Pack *pack) {
  uint32_t next = scene->medium_count + 1u;
  for (uint32_t i = 0; i < scene->instance_count; i++) {
    const cdl_SceneInstance *instance = &scene->instances[i];
    uint32_t medium = scene->materials[scene->meshes[instance->mesh].material].medium;
    pack->instance_media[i] = medium == CDL_NONE ? CDL_MEDIUM_VACUUM : medium + 1u;
    if (grid_medium(scene, instance) == CDL_NONE) continue;
    uint32_t body = same_body(scene, i);
    if (body != CDL_NONE) {
      pack->instance_media[i] = pack->instance_media[body];
      continue;
    }
    pack->media[next] = pack->media[medium + 1u];
    place(&scene->media[medium], instance->to_world, &pack->media[next]);
    pack->instance_media[i] = next++;
  }
}

cdl_Status pack_media(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack) {
  static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  size_t count = (size_t)scene->medium_count + 1;
  for (uint32_t i = 0; i < scene->instance_count; i++)
    count +=
        grid_medium(scene, &scene->instances[i]) != CDL_NONE && same_body(scene, i) == CDL_NONE;
  if (count > 0xfffe)
    return log_fail(log, CDL_BAD_INPUT,
                    "%s: %zu media are more than the 65533 that fit; grids count once for every "
                    "node",
                    scene->path, count - 1);
  pack->medium_count = count;
  pack->media = pack_array(log, "media", count, sizeof *pack->media);
  pack->instance_media =
      pack_array(log, "instances", scene->instance_count, sizeof *pack->instance_media);
  if (!pack->media || !pack->instance_media) return CDL_BAD_INPUT;
  pack_medium(&(cdl_SceneMedium){.density = CDL_NONE, .temperature = CDL_NONE, .color = CDL_NONE},
              &pack->media[CDL_MEDIUM_VACUUM]);
  for (uint32_t i = 0; i < scene->medium_count; i++) {
    const cdl_ScenePhase *phase = &scene->media[i].phase;
    pack_medium(&scene->media[i], &pack->media[i + 1]);
    pack->features.walks |= scene->media[i].walk;
    pack->features.draine |= phase->second > 0 || phase->alpha[0] > 0;
    if (scene->media[i].density != CDL_NONE) place(&scene->media[i], identity, &pack->media[i + 1]);
  }
  place_media(scene, pack);
  note_motion(log, scene);
  pack->scene_medium = scene->medium == CDL_NONE ? CDL_MEDIUM_VACUUM : scene->medium + 1u;
  pack->features.media = scene->medium_count > 0;
  return CDL_OK;
}
