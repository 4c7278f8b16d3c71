#include "render/job.h"

#include <stdio.h>
#include <string.h>

#include "core/log.h"
#include "device/source.h"

cdl_Status job_of_session(const cdl_Session *session, json_t **job) {
  const cdl_Settings *s = &session->settings;
  char kernels[CDL_SHA256_HEX], crop[64];
  *job = NULL;
  cdl_Status status = source_hash(session->log, kernels);
  if (status) return status;
  snprintf(crop, sizeof crop, "%u,%u,%u,%u", s->crop[0], s->crop[1], s->crop[2], s->crop[3]);
  *job = json_pack("{s:s, s:s, s:s, s:i, s:s, s:i, s:i, s:s, s:i, s:I, s:i, s:i, s:s}", "version",
                   CDL_VERSION, "scene_sha256", session->scene->sha256, "kernels_sha256", kernels,
                   "camera_index", (int)session->camera_index, "camera", session->camera, "width",
                   (int)s->width, "height", (int)s->height, "crop", crop, "samples",
                   (int)s->samples, "seed", (json_int_t)s->seed, "max_depth", (int)s->max_depth,
                   "aovs", (int)session->film->aovs, "math",
                   s->fast_math ? device_info(session->device)->name : "exact");
  if (!*job) return log_fail(session->log, CDL_DEVICE, "not enough memory to describe this render");
  return CDL_OK;
}

/* What people call the members. */
static const char *member_meaning(const char *name) {
  static const char *const meanings[][2] = {{"version", "the version of Candela"},
                                            {"scene_sha256", "the scene"},
                                            {"kernels_sha256", "the kernels"},
                                            {"camera_index", "the index of the camera"},
                                            {"camera", "the camera"},
                                            {"width", "the width"},
                                            {"height", "the height"},
                                            {"crop", "--crop"},
                                            {"samples", "--spp"},
                                            {"seed", "--seed"},
                                            {"max_depth", "--max-depth"},
                                            {"aovs", "--aov"},
                                            {"first_sample", "the start of --samples"},
                                            {"sample_count", "the count of --samples"},
                                            {"math", "--math"}};
  for (size_t i = 0; i < sizeof meanings / sizeof *meanings; i++)
    if (!strcmp(meanings[i][0], name)) return meanings[i][1];
  return name;
}

static void show(const json_t *value, char text[80]) {
  if (json_is_string(value))
    snprintf(text, 80, "%.70s", json_string_value(value));
  else if (json_is_integer(value))
    snprintf(text, 80, "%lld", (long long)json_integer_value(value));
  else
    snprintf(text, 80, "nothing");
}

static cdl_Status differ(const cdl_Log *log, const char *name, const char *member,
                         const json_t *theirs, const char *other, const json_t *ours) {
  char a[80], b[80];
  show(theirs, a);
  show(ours, b);
  return log_fail(log, CDL_BAD_INPUT, "%s: does not belong to %s: %s is %s there and %s here", name,
                  other, member_meaning(member), a, b);
}

cdl_Status job_check(const cdl_Log *log, const char *name, const json_t *theirs, const char *other,
                     const json_t *ours) {
  const char *member;
  json_t *value;
  json_object_foreach((json_t *)ours, member, value) {
    const json_t *their = json_object_get(theirs, member);
    if (!json_equal(their, value)) return differ(log, name, member, their, other, value);
  }
  json_object_foreach((json_t *)theirs, member, value) {
    if (!json_object_get(ours, member)) return differ(log, name, member, value, other, NULL);
  }
  return CDL_OK;
}

uint32_t job_integer(const json_t *job, const char *name) {
  const json_int_t value = json_integer_value(json_object_get(job, name));
  return value < 0 || value > UINT32_MAX ? 0 : (uint32_t)value;
}
