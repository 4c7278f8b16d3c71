#include "render/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/clock.h"
#include "core/log.h"
#include "core/text.h"
#include "profile/watch.h"
#include "render/camera.h"
#include "render/job.h"
#include "render/picture.h"
#include "render/wavefront.h"
#include "scene/pack.h"

/* Paths of a wave: enough to keep a device busy and few enough to stay near its caches. The same
 * for every device, so that a render can be resumed on another one. */
enum { WAVE_PATHS = 1 << 17 };

enum { ROULETTE_DEPTH = 4, PASS_LIMIT = 4096 };

/* --- Settings. */

static cdl_Status resolve_crop(const cdl_Log *log, cdl_Settings *s) {
  uint32_t *crop = s->crop;
  if (!crop[2]) memcpy(crop, (uint32_t[4]){0, 0, s->width, s->height}, 4 * sizeof *crop);
  if (!crop[3] || crop[0] >= s->width || crop[1] >= s->height || crop[2] > s->width - crop[0] ||
      crop[3] > s->height - crop[1])
    return log_fail(log, CDL_USAGE, "--crop %u,%u,%u,%u is not inside the image of %u x %u pixels",
                    crop[0], crop[1], crop[2], crop[3], s->width, s->height);
  return CDL_OK;
}

static cdl_Status resolve_settings(cdl_Session *session, const cdl_SceneCamera **camera) {
  cdl_Settings *s = &session->settings;
  cdl_Status status = camera_find(session->log, session->scene, s->camera, camera);
  if (status) return status;
  camera_image_size(*camera, &s->width, &s->height);
  status = settings_check_size(session->log, s->width, s->height);
  if (status) return status;
  if (!s->sample_count) s->sample_count = s->samples - s->first_sample;
  status = resolve_crop(session->log, s);
  text_copy(session->camera, sizeof session->camera, (*camera)->name);
  session->camera_index = (uint32_t)(*camera - session->scene->cameras);
  session->next_block = s->first_sample / CDL_BLOCK_SAMPLES;
  return status;
}

static cdl_Params make_params(const cdl_Session *session, const cdl_SceneCamera *camera,
                              const cdl_Pack *pack) {
  const cdl_Settings *s = &session->settings;
  const float *b = pack->bvh.bounds;
  cdl_Params params = {.environment = pack->environment_params,
                       .width = s->width,
                       .height = s->height,
                       .crop_x = s->crop[0],
                       .crop_y = s->crop[1],
                       .crop_width = s->crop[2],
                       .crop_height = s->crop[3],
                       .seed = s->seed,
                       .max_depth = s->max_depth,
                       .roulette_depth = ROULETTE_DEPTH,
                       .light_count = (uint32_t)pack->light_count,
                       .top_root = pack->bvh.root,
                       .scene_medium = pack->scene_medium,
                       .scene_radius = (float)pack_scene_radius(pack),
                       .pass_limit = PASS_LIMIT,
                       .motion_keys = pack->motion_keys,
                       .camera_keys =
                           pack->camera_keys + 12 * pack->motion_keys * session->camera_index};
  camera_params(camera, s->width, s->height, &params.camera);
  for (int i = 0; i < 3; i++)
    params.scene_center[i] = b[i] <= b[i + 3] ? 0.5f * b[i] + 0.5f * b[i + 3] : 0.0f;
  return params;
}

/* --- Creation. */

static cdl_Status watch_kernels(cdl_Session *session) {
  if (!session->settings.profile) return CDL_OK;
  session->profile = profile_create_for_kernels();
  if (!session->profile)
    return log_fail(session->log, CDL_DEVICE, "not enough memory for a profile");
  return profile_watch(session->profile, session->device);
}

static void note_scene(cdl_Session *session, const cdl_Pack *pack) {
  cdl_RenderStats *stats = &session->stats;
  if (session->scene->environment.assumed)
    log_note(session->log,
             "%s: the scene has no light; a neutral environment of radiance 1 is put around it",
             session->scene->path);
  stats->triangles = 0;
  for (uint32_t i = 0; i < session->scene->instance_count; i++)
    stats->triangles += session->scene->meshes[session->scene->instances[i].mesh].triangle_count;
  stats->instances = session->scene->instance_count;
  stats->lights = pack->light_count;
  stats->bvh_s = pack->bvh.statistics.seconds;
  bvh_statistics_line(&pack->bvh.statistics, pack->bvh.width, stats->bvh_line,
                      sizeof stats->bvh_line);
}

static uint32_t wave_paths(const cdl_Session *session) {
  const cdl_Settings *s = &session->settings;
  uint64_t all = (uint64_t)s->crop[2] * s->crop[3] * s->sample_count;
  uint64_t paths = all < WAVE_PATHS ? all : WAVE_PATHS;
  return (uint32_t)((paths + CDL_QUEUE_ALIGNMENT - 1) / CDL_QUEUE_ALIGNMENT * CDL_QUEUE_ALIGNMENT);
}

/* What suits the device: boxes eight at a time where its vectors are that wide. */
static int bvh_width(const cdl_Session *session) {
  if (session->settings.bvh_width) return (int)session->settings.bvh_width;
  return device_info(session->device)->native_float_width >= 8 ? 8 : 2;
}

static cdl_Status put_on_device(cdl_Session *session, const cdl_SceneCamera *camera,
                                cdl_Pack *pack) {
  const cdl_Settings *s = &session->settings;
  cdl_Status status = pack_scene(session->log, session->scene, bvh_width(session), pack);
  if (status) return status;
  note_scene(session, pack);
  cdl_Params params = make_params(session, camera, pack);
  const double begin = clock_now(), built = device_build_seconds(session->device);
  status = wavefront_create(session->device, pack, &params, session->film, wave_paths(session),
                            s->stage, s->stage_user, &session->wavefront);
  if (status) return status;
  session->prepare_s = clock_now() - begin;
  session->stats.compile_s = device_build_seconds(session->device) - built;
  session->stats.upload_s = wavefront_upload_seconds(session->wavefront);
  return CDL_OK;
}

/* What cannot be described is found out before the render, not when its picture is written. */
static cdl_Status describe(cdl_Session *session) {
  cdl_Status status = job_of_session(session, &session->job);
  return status ? status : header_of_session(session, &session->header);
}

cdl_Status cdl_session_create(const cdl_Log *log, cdl_Device *device, const cdl_Scene *scene,
                              const cdl_Settings *settings, cdl_Session **session) {
  *session = NULL;
  cdl_Status status = cdl_settings_check(log, settings);
  if (status) return status;
  cdl_Session *s = calloc(1, sizeof *s);
  if (!s) return log_fail(log, CDL_DEVICE, "not enough memory for a session");
  status = device_claim(device, log);
  if (status) {
    free(s);
    return status;
  }
  s->log = log;
  s->device = device;
  s->scene = scene;
  s->settings = *settings;
  s->start_s = clock_now();
  cdl_Pack pack = {0};
  const cdl_SceneCamera *camera = NULL;
  status = resolve_settings(s, &camera);
  if (!status) status = watch_kernels(s);
  const cdl_Settings *r = &s->settings;
  int is_part = settings->first_sample || settings->sample_count;
  if (!status) status = film_create(log, r->crop[2], r->crop[3], r->aovs, is_part, &s->film);
  if (!status) status = describe(s);
  if (!status) status = put_on_device(s, camera, &pack);
  pack_free(&pack);
  if (status)
    cdl_session_free(s);
  else
    *session = s;
  return status;
}

void cdl_session_free(cdl_Session *session) {
  if (!session) return;
  if (session->profile) profile_watch(NULL, session->device);
  wavefront_free(session->wavefront);
  profile_free(session->profile);
  film_free(session->film);
  json_decref(session->job);
  json_decref(session->header);
  device_release(session->device);
  free(session);
}

/* --- Rendering: passes over the whole crop, a few blocks of samples each; a pass is a row of tiles
 * after the other. */

typedef struct Pass {
  uint32_t first_sample, samples;
  uint32_t tile_width, tile_height;
  uint32_t columns, rows; /* of tiles */
} Pass;

static uint32_t divide_up(uint32_t a, uint32_t b) { return (a + b - 1) / b; }

/* The side of a tile that cuts `length` into equal pieces no longer than `most`. */
static uint32_t even_side(uint32_t length, uint32_t most) {
  most = most < 1 ? 1 : most;
  return divide_up(length, divide_up(length, most < length ? most : length));
}

/* The pass that begins at a session's next block. Tiles of one image have the same size in every
 * pass, so that an interrupted pass can be taken up again. */
static Pass next_pass(const cdl_Session *session) {
  const cdl_Settings *s = &session->settings;
  uint32_t paths = wavefront_paths(session->wavefront);
  uint32_t end = s->first_sample + s->sample_count;
  Pass pass = {.first_sample = session->next_block * CDL_BLOCK_SAMPLES};
  uint32_t left = end - pass.first_sample;
  uint32_t block = s->sample_count < CDL_BLOCK_SAMPLES ? s->sample_count : CDL_BLOCK_SAMPLES;
  uint32_t pixels = paths / block ? paths / block : 1;
  uint32_t side = (uint32_t)sqrt((double)pixels);
  pass.tile_width = even_side(s->crop[2], side);
  pass.tile_height = even_side(s->crop[3], pixels / pass.tile_width);
  pass.columns = divide_up(s->crop[2], pass.tile_width);
  pass.rows = divide_up(s->crop[3], pass.tile_height);
  uint32_t fit = paths / (pass.tile_width * pass.tile_height) / CDL_BLOCK_SAMPLES;
  uint32_t samples = (fit ? fit : 1) * CDL_BLOCK_SAMPLES;
  pass.samples = samples < left ? samples : left;
  return pass;
}

static cdl_Status render_tile(cdl_Session *session, const Pass *pass, uint32_t tile) {
  const uint32_t *crop = session->settings.crop;
  uint32_t x = tile % pass->columns * pass->tile_width;
  uint32_t y = tile / pass->columns * pass->tile_height;
  uint32_t width = crop[2] - x < pass->tile_width ? crop[2] - x : pass->tile_width;
  uint32_t height = crop[3] - y < pass->tile_height ? crop[3] - y : pass->tile_height;
  cdl_WaveCounts counts;
  cdl_Status status = wavefront_run(session->wavefront, crop[0] + x, crop[1] + y, width, height,
                                    pass->first_sample, pass->samples, session->film, &counts);
  if (status) return status;
  session->stats.paths += counts.camera_rays;
  session->stats.rays_camera += counts.camera_rays;
  session->stats.rays_bounce += counts.bounce_rays;
  session->stats.rays_shadow += counts.shadow_rays;
  session->stats.real_collisions += counts.real_collisions;
  session->stats.null_collisions += counts.null_collisions;
  session->stats.bad_samples += counts.bad_samples;
  session->next_pixel += width * height;
  return CDL_OK;
}

/* The tile that a session's next pixel belongs to: tiles are finished whole and in order. */
static uint32_t next_tile(const cdl_Session *session, const Pass *pass) {
  const uint32_t *crop = session->settings.crop;
  uint32_t row = session->next_pixel / (crop[2] * pass->tile_height);
  if (row >= pass->rows) return pass->rows * pass->columns;
  uint32_t height = crop[3] - row * pass->tile_height;
  height = height < pass->tile_height ? height : pass->tile_height;
  uint32_t in_row = session->next_pixel - row * crop[2] * pass->tile_height;
  return row * pass->columns + divide_up(in_row, pass->tile_width * height);
}

static uint32_t blocks_end(const cdl_Settings *s) {
  return divide_up(s->first_sample + s->sample_count, CDL_BLOCK_SAMPLES);
}

int session_begins_at(const cdl_Session *session, uint32_t next_block, uint32_t next_pixel) {
  const cdl_Settings *s = &session->settings;
  cdl_Session at = *session;
  at.next_block = next_block;
  at.next_pixel = next_pixel;
  if (next_block < s->first_sample / CDL_BLOCK_SAMPLES || next_block > blocks_end(s)) return 0;
  if (next_block == blocks_end(s) || !next_pixel) return !next_pixel;
  const Pass pass = next_pass(&at);
  const uint32_t tile = next_tile(&at, &pass);
  if (tile >= pass.columns * pass.rows) return 0;
  const uint32_t y = tile / pass.columns * pass.tile_height;
  const uint32_t x = tile % pass.columns * pass.tile_width;
  const uint32_t rest = s->crop[3] - y;
  const uint32_t height = rest < pass.tile_height ? rest : pass.tile_height;
  return (uint64_t)y * s->crop[2] + (uint64_t)x * height == next_pixel;
}

static uint64_t samples_total(const cdl_Session *session) {
  const cdl_Settings *s = &session->settings;
  return (uint64_t)s->crop[2] * s->crop[3] * s->sample_count;
}

typedef struct Clock {
  double wall, cpu; /* when this call began */
  double wall_before, cpu_before;
} Clock;

static void update_times(cdl_Session *session, const Clock *clock) {
  session->stats.render_s = clock->wall_before + clock_now() - clock->wall;
  session->stats.render_cpu_s = clock->cpu_before + clock_cpu() - clock->cpu;
}

/* The time limit counts only once every pixel has something to show. */
static int out_of_time(const cdl_Session *session) {
  const cdl_Settings *s = &session->settings;
  int covered = session->next_block > s->first_sample / CDL_BLOCK_SAMPLES;
  return s->time_limit > 0.0 && covered && session->stats.render_s >= s->time_limit;
}

static cdl_Status render_pass(cdl_Session *session, cdl_Progress progress, void *user,
                              const Clock *clock, int *stop) {
  Pass pass = next_pass(session);
  uint32_t tiles = pass.columns * pass.rows, first = next_tile(session, &pass);
  if (first >= tiles)
    return log_fail(session->log, CDL_BAD_INPUT,
                    "samples %u and on: no tile is left to render; start without --resume",
                    pass.first_sample);
  for (uint32_t tile = first; tile < tiles && !*stop; tile++) {
    cdl_Status status = render_tile(session, &pass, tile);
    if (status) return status;
    update_times(session, clock);
    if (session->next_pixel == session->film->width * session->film->height) {
      session->next_pixel = 0;
      session->next_block += divide_up(pass.samples, CDL_BLOCK_SAMPLES);
    }
    session->interrupted = progress && progress(user, session->stats.paths, samples_total(session),
                                                session->stats.render_s);
    *stop = session->interrupted || out_of_time(session);
  }
  return CDL_OK;
}

static int is_complete(const cdl_Session *session) {
  const cdl_Settings *s = &session->settings;
  return (uint64_t)session->next_block * CDL_BLOCK_SAMPLES >=
         (uint64_t)s->first_sample + s->sample_count;
}

static void report_bad_samples(const cdl_Session *session) {
  if (session->stats.bad_samples)
    log_warning(session->log, "%llu values of samples were not finite and count as black",
                (unsigned long long)session->stats.bad_samples);
}

cdl_Status cdl_session_render(cdl_Session *session, cdl_Progress progress, void *user) {
  const cdl_RenderStats *stats = &session->stats;
  Clock clock = {clock_now(), clock_cpu(), stats->render_s, stats->render_cpu_s};
  double target = session->settings.noise_target;
  int stop = 0;
  cdl_Status status = CDL_OK;
  session->interrupted = 0;
  while (!status && !stop && !is_complete(session)) {
    status = render_pass(session, progress, user, &clock, &stop);
    if (target > 0.0 && film_noise(session->film) <= target) stop = 1;
  }
  if (!status) status = device_finish(session->device);
  update_times(session, &clock);
  if (session->profile) {
    profile_rays(session->profile, CDL_KERNEL_intersect, stats->rays_camera + stats->rays_bounce);
    profile_rays(session->profile, CDL_KERNEL_occlude, stats->rays_shadow);
  }
  report_bad_samples(session);
  return status ? status : session->interrupted ? CDL_INTERRUPTED : CDL_OK;
}
