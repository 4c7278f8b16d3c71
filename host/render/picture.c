#include "render/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/clock.h"
#include "core/log.h"
#include "core/text.h"
#include "render/job.h"
#include "render/output.h"
#include "render/statistics.h"

/* Counts as text: an EXR header's integers have 32 bits and a sign. */
static json_t *count_json(uint64_t count) {
  char text[24];
  snprintf(text, sizeof text, "%llu", (unsigned long long)count);
  return json_string(text);
}

cdl_Status header_of_session(const cdl_Session *session, json_t **header) {
  const cdl_Settings *s = &session->settings;
  const cdl_DeviceInfo *device = device_info(session->device);
  *header =
      json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:i, s:i, s:O, s:O, s:O, s:o}", "version",
                CDL_VERSION, "scene", session->scene->path, "platform", device->platform, "device",
                device->name, "driver", device->driver, "camera", session->camera, "math",
                s->fast_math ? "fast" : "exact", "spp", (int)s->samples, "max_depth",
                (int)s->max_depth, "crop", json_object_get(session->job, "crop"), "scene_sha256",
                json_object_get(session->job, "scene_sha256"), "kernels_sha256",
                json_object_get(session->job, "kernels_sha256"), "seed", count_json(s->seed));
  if (*header) return CDL_OK;
  return log_fail(session->log, CDL_DEVICE, "not enough memory to describe the picture");
}

/* The session's header with what rendering adds to it; NULL if memory is short. */
static json_t *rendered_header(const cdl_Session *session, const char *film_sha256) {
  uint32_t least, most;
  json_t *header = json_copy(session->header);
  film_sample_range(session->film, &least, &most);
  if (json_object_set_new(header, "samples.least", json_integer(least)) ||
      json_object_set_new(header, "samples.most", json_integer(most)) ||
      json_object_set_new(header, "film_sha256", json_string(film_sha256)) ||
      json_object_set_new(header, "interrupted", json_integer(session->interrupted))) {
    json_decref(header);
    return NULL;
  }
  return header;
}

cdl_Status picture_of_session(cdl_Session *session, cdl_Picture *picture) {
  *picture =
      (cdl_Picture){.log = session->log, .film = session->film, .job = json_incref(session->job)};
  picture->statistics = statistics_of_session(session);
  const char *digest = json_string_value(json_object_get(picture->statistics, "film_sha256"));
  if (digest) picture->header = rendered_header(session, digest);
  if (picture->header) return CDL_OK;
  picture_clear(picture);
  return log_fail(session->log, CDL_OUTPUT, "not enough memory to describe the picture");
}

void picture_clear(cdl_Picture *picture) {
  json_decref(picture->job);
  json_decref(picture->header);
  json_decref(picture->statistics);
  picture->job = picture->header = picture->statistics = NULL;
}

cdl_Status cdl_session_write(cdl_Session *session, const char *path, const cdl_Display *display) {
  const double start = clock_now();
  cdl_Picture picture;
  cdl_Status status = picture_of_session(session, &picture);
  if (status) return status;
  status = picture_write(&picture, path, display);
  picture_clear(&picture);
  session->stats.write_s += clock_now() - start;
  return status;
}

void cdl_picture_free(cdl_Picture *picture) {
  if (!picture) return;
  picture_clear(picture);
  film_free(picture->film);
  free(picture);
}

cdl_Status cdl_picture_write(cdl_Picture *picture, const char *path, const cdl_Display *display) {
  return picture_write(picture, path, display);
}

char *cdl_picture_statistics_json(const cdl_Picture *picture) {
  return text_of_json(picture->statistics);
}
