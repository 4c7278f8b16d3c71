#include "render/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/clock.h"
#include "core/log.h"
#include "render/job.h"
#include "render/output.h"
#include "render/statistics.h"

/* Counts as text: an EXR header's integers have 32 bits and a sign. */
static json_t *count_json(uint64_t count) {
  char text[24];
  snprintf(text, sizeof text, "%llu", (unsigned long long)count);
  return json_string(text);
}

static json_t *header_json(const cdl_Session *session, const json_t *job, const char *film_sha256) {
  const cdl_Settings *s = &session->settings;
  const cdl_DeviceInfo *device = device_info(session->device);
  uint32_t least, most;
  film_sample_range(session->film, &least, &most);
  json_t *header = json_pack(
      "{s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:i, s:i, s:i, s:s, s:i, s:i, s:s}", "version",
      CDL_VERSION, "scene", session->scene->path, "platform", device->platform, "device",
      device->name, "driver", device->driver, "camera", session->camera, "math",
      s->fast_math ? "fast" : "exact", "spp", (int)s->samples, "samples.least", (int)least,
      "samples.most", (int)most, "film_sha256", film_sha256, "interrupted", session->interrupted,
      "max_depth", (int)s->max_depth, "crop", json_string_value(json_object_get(job, "crop")));
  json_object_set_new(header, "seed", count_json(s->seed));
  json_object_set(header, "scene_sha256", json_object_get(job, "scene_sha256"));
  json_object_set(header, "kernels_sha256", json_object_get(job, "kernels_sha256"));
  return header;
}

cdl_Status picture_of_session(cdl_Session *session, cdl_Picture *picture) {
  *picture = (cdl_Picture){.log = session->log, .film = session->film};
  cdl_Status status = job_of_session(session, &picture->job);
  if (status) return status;
  picture->statistics = statistics_of_session(session);
  const char *digest = json_string_value(json_object_get(picture->statistics, "film_sha256"));
  if (digest) picture->header = header_json(session, picture->job, digest);
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
  return statistics_text(picture->statistics);
}
