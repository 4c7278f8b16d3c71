#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi/film.h"
#include "abi/grid.h"
#include "core/clock.h"
#include "core/log.h"
#include "device/program.h"
#include "image/aov.h"
#include "render/wavefront_parts.h"

/* --- Which kernels a scene needs, and what they are built without. */

static void add_option(char *options, size_t size, int wanted, const char *define) {
  size_t used = strlen(options);
  if (wanted) snprintf(options + used, size - used, " -D%s", define);
}

static const struct {
  uint32_t bit;
  const char *define;
} gltf_layers[] = {
    {CDL_GLTF_LAYER_ANISOTROPY, "CDL_GLTF_ANISOTROPY"},
    {CDL_GLTF_LAYER_CLEARCOAT, "CDL_GLTF_CLEARCOAT"},
    {CDL_GLTF_LAYER_SHEEN, "CDL_GLTF_SHEEN"},
    {CDL_GLTF_LAYER_IRIDESCENCE, "CDL_GLTF_IRIDESCENCE"},
    {CDL_GLTF_LAYER_TRANSMISSION, "CDL_GLTF_TRANSMISSION"},
    {CDL_GLTF_LAYER_DIFFUSE_TRANSMISSION, "CDL_GLTF_DIFFUSE_TRANSMISSION"},
    {CDL_GLTF_LAYER_RETROREFLECTION, "CDL_GLTF_RETROREFLECTION"},
    {CDL_GLTF_LAYER_DISPERSION, "CDL_GLTF_DISPERSION"},
};

static cdl_Status set_options(const cdl_Wavefront *w, int bvh_width) {
  const cdl_PackFeatures *f = &w->features;
  char options[1024];
  snprintf(options, sizeof options, "-DCDL_BVH_WIDTH=%d", bvh_width);
  add_option(options, sizeof options, f->textures, "CDL_TEXTURES");
  add_option(options, sizeof options, f->float_textures, "CDL_FLOAT_TEXTURES");
  add_option(options, sizeof options, f->normal_maps, "CDL_NORMAL_MAPS");
  add_option(options, sizeof options, f->emission_textures, "CDL_EMISSION_TEXTURES");
  add_option(options, sizeof options, f->vertex_colors, "CDL_VERTEX_COLORS");
  add_option(options, sizeof options, f->passable, "CDL_PASSABLE");
  add_option(options, sizeof options, f->media, "CDL_MEDIA");
  add_option(options, sizeof options, f->grids, "CDL_GRIDS");
  add_option(options, sizeof options, f->triangle_lights || f->punctual_lights, "CDL_NEAR_LIGHTS");
  add_option(options, sizeof options, !f->draine, "CDL_DRAINE=0");
  add_option(options, sizeof options, f->motion, "CDL_MOTION");
  add_option(options, sizeof options, !f->dispersion, "CDL_DISPERSION=0");
  add_option(options, sizeof options, !f->energy_compensation, "CDL_ENERGY_COMPENSATION=0");
  for (size_t i = 0; i < sizeof gltf_layers / sizeof *gltf_layers; i++)
    add_option(options, sizeof options, (f->gltf_layers & gltf_layers[i].bit) != 0,
               gltf_layers[i].define);
  add_option(options, sizeof options, w->has_lights, "CDL_LIGHTS");
  add_option(options, sizeof options, f->triangle_lights, "CDL_TRIANGLE_LIGHTS");
  add_option(options, sizeof options, f->punctual_lights, "CDL_PUNCTUAL_LIGHTS");
  add_option(options, sizeof options, f->environment, "CDL_ENVIRONMENT_LIGHT");
  return device_set_options(w->device, options);
}

typedef struct KernelList {
  cdl_KernelId ids[CDL_KERNEL_COUNT];
  size_t count;
} KernelList;

static void list_add(KernelList *list, int wanted, cdl_KernelId id) {
  if (wanted) list->ids[list->count++] = id;
}

static int has_parameters(const int *models) {
  int any = 0;
  for (uint32_t i = CDL_MODEL_FIRST_PARAMETERS; i <= CDL_MODEL_LAST_PARAMETERS; i++)
    any |= models[i];
  return any;
}

/* In the order of their first use. */
static void list_kernels(const cdl_Wavefront *w, KernelList *list) {
  const cdl_PackFeatures *f = &w->features;
  const int *models = f->models;
  int emissive = 0;
  for (int i = 0; i < (int)CDL_MODEL_COUNT; i++) emissive |= models[i] & 2;
  list_add(list, f->media, CDL_KERNEL_camera_medium);
  list_add(list, 1, CDL_KERNEL_generate);
  list_add(list, w->wide_camera, CDL_KERNEL_lens_medium);
  list_add(list, w->has_aovs, CDL_KERNEL_clear_first_hit);
  list_add(list, 1, CDL_KERNEL_intersect);
  list_add(list, f->opacity, CDL_KERNEL_opacity);
  list_add(list, f->media, CDL_KERNEL_sample_medium);
  list_add(list, f->grids, CDL_KERNEL_sample_grid);
  list_add(list, 1, CDL_KERNEL_queue_count);
  list_add(list, 1, CDL_KERNEL_queue_scan);
  list_add(list, 1, CDL_KERNEL_queue_scatter);
  list_add(list, 1, CDL_KERNEL_queue_move);
  list_add(list, f->environment, CDL_KERNEL_escape);
  list_add(list, 1, CDL_KERNEL_surface);
  list_add(list, has_parameters(models), CDL_KERNEL_parameters);
  list_add(list, w->has_aovs, CDL_KERNEL_first_hit);
  list_add(list, emissive, CDL_KERNEL_emit);
  list_add(list, f->media, CDL_KERNEL_medium_vertex);
  list_add(list, w->has_lights, CDL_KERNEL_sample_light);
  list_add(list, f->passable, CDL_KERNEL_pass);
#define SHADE_KERNEL(model, name, words)                                                           \
  list_add(list, models[CDL_MODEL_##model], CDL_KERNEL_shade_##name);
  CDL_SHADED_MODELS(SHADE_KERNEL)
#undef SHADE_KERNEL
  list_add(list, models[CDL_MODEL_SUBSURFACE], CDL_KERNEL_probe_subsurface);
  list_add(list, f->media, CDL_KERNEL_shade_medium);
  list_add(list, f->walks, CDL_KERNEL_walk_subsurface);
  list_add(list, w->has_lights, CDL_KERNEL_occlude);
  list_add(list, 1, CDL_KERNEL_film);
}

typedef struct BuildStage {
  cdl_Stage stage;
  void *user;
} BuildStage;

static void report_build(void *user, const char *kernel, size_t done, size_t total) {
  const BuildStage *to = user;
  char what[64];
  snprintf(what, sizeof what, "compiling %s", kernel);
  if (to->stage) to->stage(to->user, what, done, total);
}

static cdl_Status build_kernels(cdl_Wavefront *w, cdl_Stage stage, void *stage_user) {
  KernelList list = {.count = 0};
  BuildStage to = {stage, stage_user};
  list_kernels(w, &list);
  return device_build(w->device, list.ids, list.count, report_build, &to);
}

/* --- Buffers. */

static const char *const buffer_names[] = {
#define BUFFER_NAME(name) #name,
    CDL_BUFFERS(BUFFER_NAME)
#undef BUFFER_NAME
};

static cdl_Status make_buffer(cdl_Wavefront *w, BufferId id, const void *data, size_t size) {
  cdl_Status status = buffer_create(w->device, buffer_names[id], size, data, &w->buffers[id]);
  if (!status) bindings_set(&w->bindings, buffer_names[id], &w->buffers[id]);
  return status;
}

static cdl_Status upload_scene(cdl_Wavefront *w, const cdl_Pack *pack) {
  const struct {
    BufferId id;
    const void *data;
    size_t size;
  } uploads[] = {
      {BUFFER_params, &w->params, sizeof w->params},
      {BUFFER_bvh_nodes, pack->bvh.nodes, pack->bvh.node_bytes},
      {BUFFER_bvh_triangles, pack->bvh.triangles, pack->bvh.triangle_bytes},
      {BUFFER_bvh_instances, pack->bvh.instances, pack->bvh.instance_bytes},
      {BUFFER_triangles, pack->triangles, pack->triangle_count * sizeof *pack->triangles},
      {BUFFER_shapes, pack->shapes, pack->shape_count * sizeof *pack->shapes},
      {BUFFER_attributes, pack->attributes, pack->attribute_count * sizeof *pack->attributes},
      {BUFFER_materials, pack->materials, pack->material_count * sizeof *pack->materials},
      {BUFFER_param_textures, pack->param_textures,
       pack->param_texture_count * sizeof *pack->param_textures},
      {BUFFER_textures, pack->textures, pack->texture_count * sizeof *pack->textures},
      {BUFFER_texels, pack->texels, pack->texel_count * sizeof *pack->texels},
      {BUFFER_srgb, pack->srgb, sizeof pack->srgb},
      {BUFFER_lights, pack->lights, pack->light_count * sizeof *pack->lights},
      {BUFFER_light_table, pack->light_table, pack->light_count * sizeof *pack->light_table},
      {BUFFER_environment, pack->environment, pack->environment_count * 4 * sizeof(float)},
      {BUFFER_environment_cells, pack->environment_cells,
       pack->cell_count * sizeof *pack->environment_cells},
      {BUFFER_media, pack->media, pack->medium_count * sizeof *pack->media},
      {BUFFER_grids, pack->grids, pack->grid_count * sizeof *pack->grids},
      {BUFFER_grid_table, pack->grid_table, pack->grid_entries * sizeof *pack->grid_table},
      {BUFFER_grid_most, pack->grid_most, pack->grid_most_count * sizeof *pack->grid_most},
      {BUFFER_grid_values, pack->grid_values, pack->grid_value_count * sizeof *pack->grid_values},
      {BUFFER_blackbody, pack->blackbody, pack->blackbody_count * sizeof *pack->blackbody},
      {BUFFER_energy_table, pack->energy_table, pack->energy_count * sizeof *pack->energy_table},
  };
  double start = clock_now();
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < sizeof uploads / sizeof *uploads && !status; i++)
    status = make_buffer(w, uploads[i].id, uploads[i].data, uploads[i].size);
  w->upload_seconds = clock_now() - start;
  return status;
}

static cdl_Status make_film_channels(cdl_Wavefront *w, const cdl_Film *film) {
  static const uint32_t fields[CDL_AOV_COUNT] = {
      [CDL_AOV_BEAUTY] = CDL_SLOT_RADIANCE,       [CDL_AOV_ALBEDO] = CDL_SLOT_ALBEDO,
      [CDL_AOV_NORMAL] = CDL_SLOT_AOV_NORMAL,     [CDL_AOV_DEPTH] = CDL_SLOT_DEPTH,
      [CDL_AOV_POSITION] = CDL_SLOT_AOV_POSITION, [CDL_AOV_EMISSION] = CDL_SLOT_AOV_EMISSION,
      [CDL_AOV_OBJECT] = CDL_SLOT_OBJECT,         [CDL_AOV_MATERIAL] = CDL_SLOT_MATERIAL_ID,
  };
  cdl_FilmChannel channels[CDL_FILM_CHANNELS_MAX] = {0};
  uint32_t count = 0;
  for (int aov = 0; aov < CDL_AOV_COUNT; aov++) {
    if (film_channel(film, aov) < 0) continue;
    for (int c = 0; c < aov_table[aov].channels; c++)
      channels[count++] =
          (cdl_FilmChannel){.field = fields[aov] + (uint32_t)c,
                            .first_only = aov_table[aov].rule == CDL_AOV_FIRST_SAMPLE};
  }
  w->wave.channels = count;
  w->has_aovs = count > 3;
  return make_buffer(w, BUFFER_film_channels, channels, sizeof channels);
}

/* Fields lie an odd number of cache lines apart: at a power of two they would all compete for the
 * same few lines of the cache. */
static uint32_t field_stride(uint32_t entries) {
  uint32_t lines = (entries + 15) / 16;
  return 16 * (lines | 1u);
}

static cdl_Status make_wave_buffers(cdl_Wavefront *w) {
  uint32_t entries = w->paths + CDL_QUEUE_PADDING;
  uint32_t chunks = (entries + CDL_QUEUE_CHUNK - 1) / CDL_QUEUE_CHUNK;
  size_t slot_fields = w->has_aovs ? CDL_SLOT_FIELDS : CDL_SLOT_ALBEDO;
  /* Pixels times blocks: paths / 16, and one more block a pixel where samples are left over. */
  size_t sums = (size_t)w->wave.channels * (w->paths + w->paths / CDL_BLOCK_SAMPLES);
  w->wave.stride = field_stride(entries);
  w->wave.slots = field_stride(entries);
  const struct {
    BufferId id;
    size_t words;
  } sizes[] = {
      {BUFFER_wave, sizeof w->wave / 4},
      {BUFFER_camera_media, 4},
      {BUFFER_path_a, (size_t)w->wave.stride * CDL_PATH_FIELDS},
      {BUFFER_path_b, (size_t)w->wave.stride * CDL_PATH_FIELDS},
      {BUFFER_work, (size_t)w->wave.stride * CDL_WORK_FIELDS},
      {BUFFER_slots, (size_t)w->wave.slots * slot_fields},
      {BUFFER_counts, (size_t)(CDL_QUEUE_COUNT + 1) * chunks},
      {BUFFER_ranges, sizeof w->ranges / 4},
      {BUFFER_sources, entries},
      {BUFFER_sums, sums},
      {BUFFER_bad_samples, sums},
      {BUFFER_collisions, 2 * CDL_COLLISION_COUNTERS},
  };
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes && !status; i++) {
    status = make_buffer(w, sizes[i].id, NULL, 4 * sizes[i].words);
    if (!status) status = buffer_fill(&w->buffers[sizes[i].id], 0, 4 * sizes[i].words, 0);
  }
  if (!status) wavefront_swap_paths(w);
  return status;
}

void wavefront_swap_paths(cdl_Wavefront *w) {
  w->path_is_b = !w->path_is_b;
  BufferId to = w->path_is_b ? BUFFER_path_b : BUFFER_path_a;
  BufferId from = w->path_is_b ? BUFFER_path_a : BUFFER_path_b;
  bindings_set(&w->bindings, "path", &w->buffers[to]);
  bindings_set(&w->bindings, "path_from", &w->buffers[from]);
}

cdl_Status wavefront_create(cdl_Device *device, const cdl_Pack *pack, const cdl_Params *params,
                            const cdl_Film *film, uint32_t paths, cdl_Stage stage, void *stage_user,
                            cdl_Wavefront **wavefront) {
  cdl_Wavefront *w = calloc(1, sizeof *w);
  *wavefront = NULL;
  if (!w) return log_fail(device_log(device), CDL_DEVICE, "not enough memory for a wavefront");
  w->device = device;
  w->params = *params;
  w->features = pack->features;
  w->has_lights = pack->light_count > 0;
  w->paths = paths;
  w->wide_camera = pack->features.media && (params->camera.orthographic || pack->features.motion ||
                                            params->camera.lens_radius > 0.0f);
  cdl_Status status = upload_scene(w, pack);
  if (!status) status = make_film_channels(w, film);
  if (!status) status = make_wave_buffers(w);
  if (!status) status = set_options(w, pack->bvh.width);
  if (!status) status = build_kernels(w, stage, stage_user);
  if (!status && w->features.media)
    status = device_run(device, CDL_KERNEL_camera_medium, &w->bindings, 0, 1);
  if (status) {
    wavefront_free(w);
    return status;
  }
  *wavefront = w;
  return CDL_OK;
}

uint32_t wavefront_paths(const cdl_Wavefront *w) { return w->paths; }

double wavefront_upload_seconds(const cdl_Wavefront *w) { return w->upload_seconds; }

void wavefront_free(cdl_Wavefront *w) {
  if (!w) return;
  for (int i = 0; i < BUFFER_COUNT; i++) buffer_free(&w->buffers[i]);
  free(w);
}
