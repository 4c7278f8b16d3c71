/* The public interface, where it is a thin layer over scene, device and film. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/clock.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/text.h"
#include "image/image_file.h"
#include "image/image_write.h"
#include "render/session.h"
#include "render/statistics.h"
#include "scene/build.h"

/* Channels of a part's file: beyond this, OpenEXR files are slow to open and some readers refuse.
 */
enum { MAX_PART_CHANNELS = 1000 };
#define MAX_ENVIRONMENT_BYTES ((size_t)1 << 30)

/* --- Scenes. What changes a scene changes its hash, which says whether two renders are of the
 * same. */

static void rehash(cdl_Scene *scene, const char *what, const void *data, size_t size) {
  struct sha256_ctx hash;
  sha256_init(&hash);
  sha256_update(&hash, strlen(scene->sha256), (const uint8_t *)scene->sha256);
  sha256_update(&hash, strlen(what) + 1, (const uint8_t *)what);
  sha256_update(&hash, size, data);
  hash_hex(&hash, scene->sha256);
}

cdl_Status cdl_scene_load(const cdl_Log *log, const char *path, double time, cdl_Scene **scene) {
  const cdl_SceneOptions options = {.time = time};
  return cdl_scene_load_with(log, path, &options, scene);
}

void cdl_scene_options_default(cdl_SceneOptions *options) {
  *options = (cdl_SceneOptions){.time = -1};
}

cdl_Status cdl_scene_load_with(const cdl_Log *log, const char *path, const cdl_SceneOptions *o,
                               cdl_Scene **scene) {
  const double start = clock_now();
  cdl_Status status = scene_load(log, path, o, scene);
  if (status) return status;
  if (o->time >= 0) rehash(*scene, "time", &o->time, sizeof o->time);
  if (o->animation) rehash(*scene, "animation", o->animation, strlen(o->animation));
  if (o->variant) rehash(*scene, "variant", o->variant, strlen(o->variant));
  (*scene)->load_s = clock_now() - start;
  return CDL_OK;
}

void cdl_scene_free(cdl_Scene *scene) { scene_free(scene); }

const char *cdl_scene_sha256(const cdl_Scene *scene) { return scene->sha256; }

static cdl_Status add_image(cdl_Scene *scene, const cdl_Log *log, const char *path,
                            cdl_Image *image) {
  const uint32_t n = scene->image_count;
  cdl_Image **slot = array_push((void **)&scene->images, n, sizeof *slot);
  char **name = array_push((void **)&scene->image_names, n, sizeof *name);
  if (!slot || !name || !(*name = strdup(path))) {
    image_free(image);
    return log_fail(log, CDL_BAD_INPUT, "%s: not enough memory for the environment", path);
  }
  *slot = image;
  scene->image_count++;
  return CDL_OK;
}

cdl_Status cdl_scene_set_environment(cdl_Scene *scene, const cdl_Log *log, const char *path) {
  unsigned char *bytes = NULL;
  size_t size = 0;
  cdl_Image *image = NULL;
  if (!path) return CDL_OK;
  const double start = clock_now();
  cdl_Status status = image_file_read(log, path, MAX_ENVIRONMENT_BYTES, &bytes, &size);
  if (!status) status = image_decode(log, path, bytes, size, &image);
  if (!status) status = add_image(scene, log, path, image);
  if (!status) {
    scene->environment = (cdl_SceneEnvironment){
        .present = 1, .image = scene->image_count - 1, .radiance = {1, 1, 1}, .strength = 1};
    rehash(scene, "environment", bytes, size);
    scene->load_s += clock_now() - start;
  }
  free(bytes);
  return status;
}

/* The largest value of a channel, without the strength. */
static float environment_peak(const cdl_Scene *scene) {
  const cdl_SceneEnvironment *e = &scene->environment;
  const cdl_Image *image = e->image == CDL_NONE ? NULL : scene->images[e->image];
  const size_t values = image && image->f32 ? 4 * (size_t)image->width * (size_t)image->height : 0;
  float peak = image && !image->f32 ? 1 : 0;
  for (size_t i = 0; i < values; i++)
    if (i % 4 != 3 && isfinite(image->f32[i])) peak = fmaxf(peak, image->f32[i]);
  if (image) return peak;
  for (int c = 0; c < 3; c++) peak = fmaxf(peak, e->radiance[c]);
  return peak;
}

cdl_Status cdl_scene_set_environment_strength(cdl_Scene *scene, const cdl_Log *log,
                                              float strength) {
  const float product = scene->environment.strength * strength;
  if (!isfinite(strength) || strength < 0)
    return log_fail(log, CDL_USAGE, "--env-strength %g: must be finite and not negative", strength);
  if (!isfinite(product) || !isfinite(product * environment_peak(scene)))
    return log_fail(log, CDL_USAGE, "--env-strength %g: makes the environment of %s infinite",
                    strength, scene->path);
  scene->environment.strength *= strength;
  rehash(scene, "strength", &strength, sizeof strength);
  return CDL_OK;
}

void cdl_scene_set_background(cdl_Scene *scene, const float radiance[3]) {
  scene->environment = (cdl_SceneEnvironment){.present = 1, .image = CDL_NONE, .strength = 1};
  memcpy(scene->environment.radiance, radiance, sizeof scene->environment.radiance);
  rehash(scene, "background", radiance, sizeof scene->environment.radiance);
}

/* --- Devices. */

cdl_Status cdl_device_open(const cdl_Log *log, const char *selector, cdl_Device **device) {
  return device_open(log, selector, device);
}

void cdl_device_close(cdl_Device *device) { device_close(device); }

/* --- Settings. */

void cdl_settings_default(cdl_Settings *settings) {
  *settings = (cdl_Settings){.width = 1280, .samples = 64, .max_depth = 16};
}

cdl_Status cdl_aovs_parse(const cdl_Log *log, const char *list, uint32_t *aovs) {
  return aov_parse(log, list, aovs);
}

const char *cdl_aov_name(unsigned index, const char **meaning) {
  if (index >= CDL_AOV_COUNT) return NULL;
  if (meaning) *meaning = aov_table[index].meaning;
  return aov_table[index].name;
}

static cdl_Status check_samples(const cdl_Log *log, const cdl_Settings *s) {
  const uint32_t first = s->first_sample, count = s->sample_count;
  if (!s->samples) return log_fail(log, CDL_USAGE, "--spp must be at least 1");
  if (s->samples > CDL_MAX_SAMPLES)
    return log_fail(log, CDL_USAGE, "--spp: %u is more than %u", s->samples, CDL_MAX_SAMPLES);
  if (first % CDL_FILM_BLOCK)
    return log_fail(log, CDL_USAGE, "--samples: %u is not a multiple of %u", first, CDL_FILM_BLOCK);
  if (first >= s->samples)
    return log_fail(log, CDL_USAGE, "--samples: %u is not below --spp %u", first, s->samples);
  if (count > s->samples - first)
    return log_fail(log, CDL_USAGE, "--samples: %u + %u is beyond --spp %u", first, count,
                    s->samples);
  if (count % CDL_FILM_BLOCK && first + count != s->samples)
    return log_fail(log, CDL_USAGE,
                    "--samples: %u is not a multiple of %u, nor the rest of --spp %u", count,
                    CDL_FILM_BLOCK, s->samples);
  if (first || count) {
    const uint32_t most =
        MAX_PART_CHANNELS / film_channels(s->aovs | AOV_BIT(CDL_AOV_BEAUTY)) * CDL_FILM_BLOCK;
    const uint32_t wanted = count ? count : s->samples - first;
    if (wanted > most)
      return log_fail(log, CDL_USAGE, "--samples: a part of these AOVs holds at most %u samples",
                      most);
  }
  return CDL_OK;
}

cdl_Status settings_check_size(const cdl_Log *log, uint32_t width, uint32_t height) {
  if (!width && !height) return log_fail(log, CDL_USAGE, "--size: width and height are both 0");
  if (width > CDL_MAX_SIZE || height > CDL_MAX_SIZE)
    return log_fail(log, CDL_USAGE, "--size: %ux%u has more than %u pixels on a side", width,
                    height, CDL_MAX_SIZE);
  if ((uint64_t)width * height > CDL_MAX_PIXELS)
    return log_fail(log, CDL_USAGE, "--size: %ux%u has more than %u pixels", width, height,
                    CDL_MAX_PIXELS);
  return CDL_OK;
}

cdl_Status cdl_settings_check(const cdl_Log *log, const cdl_Settings *s) {
  cdl_Status status = settings_check_size(log, s->width, s->height);
  if (!status) status = check_samples(log, s);
  if (status) return status;
  if (s->schedule == CDL_SCHEDULE_FUSED)
    return log_fail(log, CDL_USAGE, "--schedule: this version has auto and wavefront, not fused");
  if (s->bvh_width && s->bvh_width != 2 && s->bvh_width != 8)
    return log_fail(log, CDL_USAGE, "--bvh %u: there are auto, 2 and 8", s->bvh_width);
  if (s->fast_math) return log_fail(log, CDL_USAGE, "--math: this version has exact, not fast");
  if (s->max_depth > CDL_MAX_DEPTH)
    return log_fail(log, CDL_USAGE, "--max-depth: %u is more than %u", s->max_depth, CDL_MAX_DEPTH);
  if (!(s->time_limit >= 0) || !isfinite(s->time_limit))
    return log_fail(log, CDL_USAGE, "--time must be finite and not negative");
  if (!(s->noise_target >= 0) || !isfinite(s->noise_target))
    return log_fail(log, CDL_USAGE, "--noise must be finite and not negative");
  return CDL_OK;
}

/* --- Sessions. */

void cdl_session_size(const cdl_Session *session, uint32_t *width, uint32_t *height) {
  if (width) *width = session->film->width;
  if (height) *height = session->film->height;
}

void cdl_session_samples(const cdl_Session *session, uint32_t *least, uint32_t *most) {
  film_sample_range(session->film, least, most);
}

cdl_Status cdl_session_pixels(const cdl_Session *session, float *rgb) {
  float *resolved = film_resolve(session->film);
  if (!resolved) return log_fail(session->log, CDL_DEVICE, "not enough memory for the picture");
  memcpy(rgb, resolved, 3 * sizeof *rgb * session->film->width * session->film->height);
  free(resolved);
  return CDL_OK;
}

char *cdl_session_statistics_json(cdl_Session *session) {
  json_t *json = statistics_of_session(session);
  char *text = text_of_json(json);
  json_decref(json);
  return text;
}

/* The profile watches from the moment the device is prepared on, so that is part of its wall time:
 * kernels are launched there as well. */
char *cdl_session_profile_text(cdl_Session *session) {
  const double wall = session->prepare_s + session->stats.render_s - session->resumed_s;
  char *text = NULL;
  size_t size;
  FILE *out = session->profile ? open_memstream(&text, &size) : NULL;
  if (!out) return NULL;
  profile_table(out, session->profile, wall);
  fclose(out);
  return text;
}

/* --- Files. */

cdl_Status cdl_output_check(const cdl_Log *log, const char *path) {
  return image_check_output(log, path);
}

cdl_Status cdl_session_output_check(const cdl_Session *session, const char *path) {
  const cdl_Film *film = session->film;
  return image_check_size(session->log, path, (int)film->width, (int)film->height);
}

cdl_Status cdl_text_check(const cdl_Log *log, const char *path) {
  return image_file_probe(log, path);
}

cdl_Status cdl_text_write(const cdl_Log *log, const char *path, const char *text) {
  return image_file_write(log, path, text, strlen(text));
}
