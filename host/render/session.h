/* session.h: a render in progress, for the modules that render, save, merge and report it. */
#ifndef CANDELA_RENDER_SESSION_H
#define CANDELA_RENDER_SESSION_H

#include <jansson.h>

#include "candela.h"
#include "device/device.h"
#include "profile/profile.h"
#include "render/film.h"
#include "scene/scene.h"

/* Wall seconds by phase, and what was traced; the counts are exact. */
typedef struct cdl_RenderStats {
  double load_s, bvh_s, compile_s, upload_s, render_s, render_cpu_s, write_s;
  uint64_t paths;
  uint64_t rays_camera, rays_bounce, rays_shadow;
  uint64_t real_collisions, null_collisions; /* of paths in grids */
  uint64_t bad_samples;                      /* not finite, counted as black */
  uint64_t triangles, instances, lights;
  char bvh_line[256]; /* bvh_statistics_line() */
} cdl_RenderStats;

struct cdl_Session {
  const cdl_Log *log;
  cdl_Device *device;
  const cdl_Scene *scene;
  cdl_Settings settings; /* resolved: size, crop and sample range are definite */
  char camera[128];      /* name of the camera in use */
  uint32_t camera_index; /* among the scene's */
  cdl_Film *film;
  json_t *job;          /* job_of_session() */
  json_t *header;       /* header_of_session() */
  cdl_Profile *profile; /* NULL unless settings.profile */
  cdl_RenderStats stats;
  double resumed_s;    /* of stats.render_s: spent before the checkpoint */
  double prepare_s;    /* making the device ready: uploads, compilation, first launches */
  double start_s;      /* clock_now() when the session was created */
  uint32_t next_block; /* the pass to come: first block of all pixels not yet finished */
  uint32_t next_pixel; /* pixels of that pass that are finished */
  int interrupted;
  struct cdl_Wavefront *wavefront; /* everything on the device */
};

/* Whether a render with these settings is ever at that block and pixel, between two tiles; both as
 * the members of these names. */
int session_begins_at(const cdl_Session *session, uint32_t next_block, uint32_t next_pixel);

/* CDL_USAGE for more pixels than cdl_settings_check() allows; one number may be 0: not known yet.
 */
cdl_Status settings_check_size(const cdl_Log *log, uint32_t width, uint32_t height);

#endif
