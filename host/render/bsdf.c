/* bsdf.c: one material asked about directions, on the device, without a scene around it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi/bsdf.h"
#include "core/log.h"
#include "device/queue.h"
#include "render/bsdf.h"
#include "scene/choice.h"
#include "scene/pack_parts.h"

enum { CHUNK = 1 << 17, WAVELENGTHS = 16 };
enum { QUERY, MATERIAL, ENERGY, DIRECTIONS, RESULTS, BUFFERS };

static const char *const names[BUFFERS] = {"bsdf_query", "materials", "energy_table",
                                           "bsdf_directions", "bsdf_results"};

struct cdl_Bsdf {
  const cdl_Log *log;
  cdl_Device *device;
  char name[128];
  uint32_t wavelengths;
  cdl_Buffer buffers[BUFFERS];
  cdl_Bindings bindings;
};

/* --- The material. */

static cdl_Status not_found(const cdl_Log *log, const cdl_Scene *scene, const char *material) {
  char all[512] = "";
  for (uint32_t i = 0; i < scene->material_count; i++) {
    size_t used = strlen(all);
    const char *name = scene->materials[i].name;
    if (used + strlen(name) + 24 > sizeof all) {
      snprintf(all + used, sizeof all - used, ", …");
      break;
    }
    snprintf(all + used, sizeof all - used, "%s%u%s%s", i ? ", " : "", i, *name ? ": " : "", name);
  }
  return log_fail(log, CDL_USAGE, "%s: has no material '%s'; choose one by name or index: %s",
                  scene->path, material, *all ? all : "it has none at all");
}

static cdl_Status find(const cdl_Log *log, const cdl_Scene *scene, const char *material,
                       uint32_t *index) {
  Choice materials = choice_of_materials(scene);
  *index = choice_find(&materials, material);
  return *index == CDL_NONE ? not_found(log, scene, material) : CDL_OK;
}

static cdl_Status check(const cdl_Log *log, const cdl_Scene *scene, uint32_t index) {
  const cdl_SceneMaterial *m = &scene->materials[index];
  const char *model = scene_model_name(m->model);
  if (m->model == CDL_MODEL_UNLIT || m->model == CDL_MODEL_INTERFACE)
    return log_fail(log, CDL_USAGE,
                    "%s: material %u, '%s', is %s: it scatters no light; choose "
                    "another one",
                    scene->path, index, m->name, model);
  if (m->model == CDL_MODEL_SUBSURFACE)
    return log_fail(
        log, CDL_USAGE,
        "%s: material %u, '%s', sends light back from elsewhere than it came in, which no "
        "BSDF says; choose another one",
        scene->path, index, m->name);
  if (m->texture_count || m->base_texture.texture != CDL_NONE)
    log_note(log, "%s: material %u, '%s', has textures; they count as white here", scene->path,
             index, m->name);
  return CDL_OK;
}

/* --- The device. */

static cdl_Status make_buffers(cdl_Bsdf *b, const cdl_Pack *pack, uint32_t index) {
  const size_t sizes[BUFFERS] = {sizeof(cdl_BsdfQuery), sizeof *pack->materials,
                                 pack->energy_count * sizeof *pack->energy_table,
                                 (size_t)CHUNK * 6 * sizeof(float),
                                 (size_t)CHUNK * 8 * sizeof(float)};
  const void *data[BUFFERS] = {
      [MATERIAL] = &pack->materials[index],
      [ENERGY] = pack->energy_table,
  };
  cdl_Status status = CDL_OK;
  for (int i = 0; i < BUFFERS && !status; i++) {
    status = buffer_create(b->device, names[i], sizes[i], data[i], &b->buffers[i]);
    bindings_set(&b->bindings, names[i], &b->buffers[i]);
  }
  return status;
}

static cdl_Status set_options(cdl_Device *device, const cdl_Material *material) {
  const int loses = !(material->flags & CDL_MATERIAL_ENERGY_COMPENSATED);
  char options[96];
  snprintf(options, sizeof options, "-DCDL_SHADE_MODEL=%uu%s", material->model,
           loses ? " -DCDL_ENERGY_COMPENSATION=0" : "");
  return device_set_options(device, options);
}

/* The material as renders have it. */
static cdl_Status create(cdl_Bsdf *b, const cdl_Scene *scene, uint32_t index) {
  cdl_Pack pack = {0};
  cdl_Status status = pack_materials(b->log, scene, &pack);
  if (!status) status = pack_energy(b->log, &pack);
  if (!status) status = set_options(b->device, &pack.materials[index]);
  if (!status) status = make_buffers(b, &pack, index);
  if (!status) b->wavelengths = material_disperses(&pack.materials[index]) ? WAVELENGTHS : 0;
  pack_free(&pack);
  return status;
}

cdl_Status cdl_bsdf_create(const cdl_Log *log, cdl_Device *device, const cdl_Scene *scene,
                           const char *material, cdl_Bsdf **bsdf) {
  uint32_t index;
  *bsdf = NULL;
  cdl_Status status = find(log, scene, material, &index);
  if (!status) status = check(log, scene, index);
  if (status) return status;
  cdl_Bsdf *b = calloc(1, sizeof *b);
  if (!b) return log_fail(log, CDL_DEVICE, "not enough memory for a material");
  status = device_claim(device, log);
  if (status) {
    free(b);
    return status;
  }
  b->log = log;
  b->device = device;
  snprintf(b->name, sizeof b->name, "%s", scene->materials[index].name);
  status = create(b, scene, index);
  if (status)
    cdl_bsdf_free(b);
  else
    *bsdf = b;
  return status;
}

void cdl_bsdf_free(cdl_Bsdf *bsdf) {
  if (!bsdf) return;
  for (int i = 0; i < BUFFERS; i++) buffer_free(&bsdf->buffers[i]);
  device_release(bsdf->device);
  free(bsdf);
}

const cdl_Log *bsdf_log(const cdl_Bsdf *bsdf) { return bsdf->log; }
const char *bsdf_name(const cdl_Bsdf *bsdf) { return bsdf->name; }

/* One launch: `directions` floats in, query.count x `width` floats out. */
static cdl_Status ask(cdl_Bsdf *b, cdl_KernelId kernel, const cdl_BsdfQuery *query,
                      const float *directions, size_t floats, size_t width, float *values) {
  cdl_Buffer *buffers = b->buffers;
  size_t size = query->count * width * sizeof *values;
  cdl_Status status = buffer_write(&buffers[QUERY], 0, sizeof *query, query);
  if (!status)
    status = buffer_write(&buffers[DIRECTIONS], 0, floats * sizeof *directions, directions);
  if (!status) status = device_run(b->device, kernel, &b->bindings, 0, query->count);
  if (!status) status = device_finish(b->device);
  return status ? status : buffer_read(&buffers[RESULTS], 0, size, values);
}

cdl_Status cdl_bsdf_evaluate(cdl_Bsdf *bsdf, size_t count, const float *pairs, float *values) {
  cdl_Status status = CDL_OK;
  for (size_t at = 0; at < count && !status; at += CHUNK) {
    const size_t n = count - at < CHUNK ? count - at : CHUNK;
    const cdl_BsdfQuery query = {.count = (uint32_t)n, .wavelengths = bsdf->wavelengths};
    status =
        ask(bsdf, CDL_KERNEL_material_evaluate, &query, pairs + 6 * at, 6 * n, 4, values + 4 * at);
  }
  return status;
}

cdl_Status cdl_bsdf_sample(cdl_Bsdf *bsdf, size_t count, const float *wo, uint32_t first,
                           uint32_t samples, uint32_t seed, float *values) {
  cdl_Status status = CDL_OK;
  if (!samples || samples > CDL_MAX_SAMPLES)
    return log_fail(bsdf->log, CDL_USAGE, "%u samples: 1 to %u can be drawn of a direction",
                    samples, CDL_MAX_SAMPLES);
  const uint64_t total = (uint64_t)count * samples;
  for (uint64_t at = 0; at < total && !status; at += CHUNK) {
    const uint64_t n = total - at < CHUNK ? total - at : CHUNK;
    const size_t begin = (size_t)(at / samples), last = (size_t)((at + n - 1) / samples);
    const cdl_BsdfQuery query = {.count = (uint32_t)n,
                                 .samples = samples,
                                 .first = first + (uint32_t)begin,
                                 .first_sample = (uint32_t)(at % samples),
                                 .seed = seed};
    status = ask(bsdf, CDL_KERNEL_material_sample, &query, wo + 3 * begin, 3 * (last - begin + 1),
                 8, values + 8 * at);
  }
  return status;
}
