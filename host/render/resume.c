/* Sessions to and from checkpoints. */
#include "render/checkpoint.h"
#include "render/job.h"
#include "render/session.h"

#include "core/log.h"

static json_t *state_json(const cdl_Session *session) {
  const cdl_RenderStats *s = &session->stats;
  return json_pack("{s:I, s:I, s:f, s:f, s:I, s:I, s:I, s:I, s:I, s:I, s:I}", "next_block",
                   (json_int_t)session->next_block, "next_pixel", (json_int_t)session->next_pixel,
                   "render_s", s->render_s, "render_cpu_s", s->render_cpu_s, "paths",
                   (json_int_t)s->paths, "rays_camera", (json_int_t)s->rays_camera, "rays_bounce",
                   (json_int_t)s->rays_bounce, "rays_shadow", (json_int_t)s->rays_shadow,
                   "real_collisions", (json_int_t)s->real_collisions, "null_collisions",
                   (json_int_t)s->null_collisions, "bad_samples", (json_int_t)s->bad_samples);
}

static uint64_t count(const json_t *state, const char *name) {
  return (uint64_t)json_integer_value(json_object_get(state, name));
}

/* Where a render goes on, as it is read: the film that belongs to it is still the file's. */
static int state_fits(const void *user, const json_t *state) {
  const json_int_t block = json_integer_value(json_object_get(state, "next_block"));
  const json_int_t pixel = json_integer_value(json_object_get(state, "next_pixel"));
  return block >= 0 && block <= UINT32_MAX && pixel >= 0 && pixel <= UINT32_MAX &&
         session_begins_at(user, (uint32_t)block, (uint32_t)pixel);
}

static void state_apply(cdl_Session *session, const json_t *state) {
  cdl_RenderStats *s = &session->stats;
  session->next_block = job_integer(state, "next_block");
  session->next_pixel = job_integer(state, "next_pixel");
  s->render_s = json_number_value(json_object_get(state, "render_s"));
  session->resumed_s = s->render_s;
  s->render_cpu_s = json_number_value(json_object_get(state, "render_cpu_s"));
  s->paths = count(state, "paths");
  s->rays_camera = count(state, "rays_camera");
  s->rays_bounce = count(state, "rays_bounce");
  s->rays_shadow = count(state, "rays_shadow");
  s->real_collisions = count(state, "real_collisions");
  s->null_collisions = count(state, "null_collisions");
  s->bad_samples = count(state, "bad_samples");
}

/* The job of a checkpoint has the range of samples as well: the film holds those blocks. */
static cdl_Status checkpoint_job(const cdl_Session *session, json_t **job) {
  *job = json_copy(session->job);
  if (!*job) return log_fail(session->log, CDL_DEVICE, "not enough memory to describe this render");
  json_object_set_new(*job, "first_sample", json_integer(session->settings.first_sample));
  json_object_set_new(*job, "sample_count", json_integer(session->settings.sample_count));
  return CDL_OK;
}

cdl_Status cdl_session_save(cdl_Session *session, const char *path) {
  json_t *job = NULL, *state = NULL;
  cdl_Status status = checkpoint_job(session, &job);
  if (status) return status;
  state = state_json(session);
  status = checkpoint_write(session->log, path, job, state, session->film);
  json_decref(state);
  json_decref(job);
  return status;
}

cdl_Status cdl_session_resume(cdl_Session *session, const char *path) {
  json_t *job = NULL, *state = NULL;
  cdl_Status status = checkpoint_job(session, &job);
  if (!status)
    status = checkpoint_read(session->log, path, job, session->film, state_fits, session, &state);
  if (!status) state_apply(session, state);
  json_decref(state);
  json_decref(job);
  return status;
}
