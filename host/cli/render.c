/* candela render: a picture of a scene. */
#include "cli/cli.h"
#include "cli/render_options.h"
#include "core/clock.h"
#include "core/log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A render on its way through this file. */
typedef struct Render {
  RenderOptions options;
  cdl_Scene *scene;
  cdl_Device *device;
  cdl_Session *session;
  cdl_Trace *trace;
  double next_checkpoint;  /* clock_now(); 0: none while rendering */
  cdl_Status checkpointed; /* how the last checkpoint went */
} Render;

/* Finds out early what would fail after hours. */
static cdl_Status check_outputs(const RenderOptions *options) {
  const char *const texts[] = {options->stats, options->trace, options->checkpoint};
  cdl_Status status = CDL_OK;
  for (int i = 0; i < options->output_count && !status; i++)
    status = cdl_output_check(&cli_log, options->outputs[i]);
  for (int i = 0; i < 3 && !status; i++)
    if (texts[i]) status = cdl_text_check(&cli_log, texts[i]);
  return status;
}

static cdl_Status load_scene(Render *r) {
  const RenderOptions *o = &r->options;
  cdl_Status status = cdl_scene_load_with(&cli_log, o->scene, &o->what, &r->scene);
  if (status) return status;
  if (o->environment) status = cdl_scene_set_environment(r->scene, &cli_log, o->environment);
  if (status) return status;
  if (o->has_background) cdl_scene_set_background(r->scene, o->background);
  if (o->environment_strength != 1)
    status = cdl_scene_set_environment_strength(r->scene, &cli_log, (float)o->environment_strength);
  return status;
}

static cdl_Status start_session(Render *r) {
  RenderOptions *o = &r->options;
  o->settings.stage = cli_progress_stage;
  cdl_Status status = cdl_device_open(&cli_log, o->device, &r->device);
  if (!status)
    status = cdl_session_create(&cli_log, r->device, r->scene, &o->settings, &r->session);
  cli_progress_erase();
  for (int i = 0; i < o->output_count && !status; i++)
    status = cdl_session_output_check(r->session, o->outputs[i]);
  if (!status && o->trace) status = cdl_trace_start(r->session, &r->trace);
  if (status || !o->resume) return status;
  if (access(o->checkpoint, F_OK) == 0) return cdl_session_resume(r->session, o->checkpoint);
  log_note(&cli_log, "%s: there is no checkpoint yet; starting from the first sample",
           o->checkpoint);
  return CDL_OK;
}

/* Nonzero stops the render: it was interrupted, or the checkpoint cannot be kept. */
static int on_progress(void *user, uint64_t done, uint64_t total, double seconds) {
  Render *r = user;
  cli_progress_samples(done, total, seconds, r->options.settings.time_limit);
  if (r->next_checkpoint > 0 && clock_now() >= r->next_checkpoint) {
    r->checkpointed = cdl_session_save(r->session, r->options.checkpoint);
    r->next_checkpoint = clock_now() + r->options.checkpoint_every;
  }
  return cli_interrupted() || r->checkpointed;
}

static cdl_Status run(Render *r) {
  const RenderOptions *o = &r->options;
  if (o->checkpoint_every > 0) r->next_checkpoint = clock_now() + o->checkpoint_every;
  if (cli_interrupted()) return CDL_INTERRUPTED;
  cdl_Status status = cdl_session_render(r->session, on_progress, r);
  cli_progress_erase();
  if (status == CDL_INTERRUPTED && r->checkpointed) return r->checkpointed;
  if (status == CDL_INTERRUPTED && o->checkpoint) {
    cdl_Status saved = cdl_session_save(r->session, o->checkpoint);
    if (saved) return saved;
  }
  return status;
}

/* All outputs are tried; the first failure counts. */
static cdl_Status write_pictures(Render *r) {
  const RenderOptions *o = &r->options;
  cdl_Status status = CDL_OK;
  for (int i = 0; i < o->output_count; i++) {
    cdl_Status written = cdl_session_write(r->session, o->outputs[i], &o->display);
    if (!status) status = written;
  }
  return status;
}

static cdl_Status write_reports(Render *r) {
  const RenderOptions *o = &r->options;
  cdl_Status status = CDL_OK, traced = CDL_OK;
  char *stats = o->stats ? cdl_session_statistics_json(r->session) : NULL;
  char *table = o->profile ? cdl_session_profile_text(r->session) : NULL;
  if (table) fputs(table, stderr);
  if (o->stats && !stats)
    status = log_fail(&cli_log, CDL_OUTPUT, "%s: not enough memory for the statistics", o->stats);
  if (stats) status = cdl_text_write(&cli_log, o->stats, stats);
  if (r->trace) traced = cdl_trace_write(r->trace, o->trace);
  free(stats);
  free(table);
  return status ? status : traced;
}

static void tell_interrupted(const Render *r) {
  const RenderOptions *o = &r->options;
  uint32_t least, most;
  char samples[40];
  cdl_session_samples(r->session, &least, &most);
  snprintf(samples, sizeof samples, least == most ? "%u" : "%u to %u", least, most);
  log_warning(&cli_log, "interrupted: the picture has %s of %u samples a pixel%s%s", samples,
              o->settings.sample_count ? o->settings.sample_count : o->settings.samples,
              o->checkpoint ? "; go on with --resume --checkpoint " : "",
              o->checkpoint ? o->checkpoint : "");
}

/* What comes after rendering; an interrupted render is written as well, if there is anything. */
static cdl_Status finish(Render *r, cdl_Status rendered) {
  uint32_t most;
  if (rendered && rendered != CDL_INTERRUPTED) return rendered;
  cdl_session_samples(r->session, NULL, &most);
  if (rendered == CDL_INTERRUPTED && most == 0) {
    log_warning(&cli_log, "interrupted before the first samples: nothing was written");
    return rendered;
  }
  if (rendered == CDL_INTERRUPTED) tell_interrupted(r);
  cdl_Status status = write_pictures(r);
  cdl_Status reported = write_reports(r);
  if (status || reported) return status ? status : reported;
  return rendered;
}

int cli_render(int argc, char **argv) {
  Render r = {0};
  render_parse(argc, argv, &r.options);
  cli_catch_signals();
  cdl_Status status = check_outputs(&r.options);
  if (!status) status = load_scene(&r);
  if (!status) status = start_session(&r);
  if (!status) status = finish(&r, run(&r));
  cdl_trace_free(r.trace);
  cdl_session_free(r.session);
  cdl_device_close(r.device);
  cdl_scene_free(r.scene);
  return status;
}
