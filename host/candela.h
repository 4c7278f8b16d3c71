/* candela.h: the public C interface of Candela, a renderer whose light transport runs as OpenCL
 * kernels.
 *
 * Every function returns a cdl_Status. A failure is reported once, through the caller's cdl_Log,
 * where it happened, as one line that names the file, the device or the OpenCL call and the cure.
 * Nothing is ever printed. Objects are opaque; who creates one frees it. */
#ifndef CANDELA_H
#define CANDELA_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

#define CDL_VERSION "0.1.0"

/* What a call came to; the command line exits with the same numbers. */
typedef enum cdl_Status {
  CDL_OK = 0,
  CDL_DIFFERENT = 1,    /* a check found differences */
  CDL_USAGE = 2,        /* an argument is wrong */
  CDL_BAD_INPUT = 3,    /* a scene, image or other input is damaged, missing or not supported */
  CDL_DEVICE = 4,       /* an OpenCL call failed, or no device fits */
  CDL_OUTPUT = 5,       /* an output could not be written */
  CDL_INTERRUPTED = 130 /* stopped on request; what was finished is kept */
} cdl_Status;

typedef enum cdl_LogLevel { CDL_LOG_ERROR, CDL_LOG_WARNING, CDL_LOG_NOTE } cdl_LogLevel;

/* Where messages go. `write` gets one line without a newline; it may be NULL (silence) and may be
 * called from any thread, one call at a time. The caller keeps ownership. */
typedef struct cdl_Log {
  void (*write)(void *user, cdl_LogLevel level, const char *message);
  void *user;
} cdl_Log;

/* A loaded scene. It is not changed by rendering; several sessions may share one. */
typedef struct cdl_Scene cdl_Scene;

/* Loads a .gltf or .glb file and all it refers to; `time` is the animation time in seconds, negative
 * for the pose at rest. *scene is set on success alone. */
cdl_Status cdl_scene_load(const cdl_Log *log, const char *path, double time, cdl_Scene **scene);

/* Replaces the scene's environment by an image file (latitude-longitude), NULL to keep it. */
cdl_Status cdl_scene_set_environment(cdl_Scene *scene, const cdl_Log *log, const char *path);

/* Multiplies the environment's radiance; finite and >= 0. */
void cdl_scene_set_environment_strength(cdl_Scene *scene, float strength);

/* Replaces the scene's environment by a constant radiance. */
void cdl_scene_set_background(cdl_Scene *scene, const float radiance[3]);

void cdl_scene_free(cdl_Scene *scene); /* NULL is nothing */

/* An OpenCL device, opened. One session uses it at a time. */
typedef struct cdl_Device cdl_Device;

/* Opens the device that `selector` names: an index of the listing, or a part of a platform's or device's
 * name in any case; NULL for the best one. */
cdl_Status cdl_device_open(const cdl_Log *log, const char *selector, cdl_Device **device);

void cdl_device_close(cdl_Device *device); /* NULL is nothing */

typedef enum cdl_Schedule { CDL_SCHEDULE_AUTO, CDL_SCHEDULE_WAVEFRONT, CDL_SCHEDULE_FUSED } cdl_Schedule;

/* What to render. cdl_settings_default() fills it. */
typedef struct cdl_Settings {
  uint32_t width, height;    /* pixels of the full image; one of them 0: from the camera's aspect */
  uint32_t samples;          /* of each pixel, >= 1 */
  uint32_t first_sample;     /* part of the samples: multiples of 16, but for the end of `samples` */
  uint32_t sample_count;     /* 0: all from first_sample on */
  uint32_t crop[4];          /* x, y, width, height; width 0: the full image */
  const char *camera;        /* name or index; NULL: the first */
  uint32_t max_depth;        /* scattering events after the camera ray, <= 4095 */
  uint32_t seed;
  double time_limit;         /* s of rendering; 0: none */
  double noise_target;       /* relative standard error of the image, median of pixels; 0: none */
  uint32_t aovs;             /* bit i: entry i of the table in image/aov.h */
  cdl_Schedule schedule;
  uint32_t bvh_width;        /* 2 or 8; 0: what suits the device */
  int fast_math;             /* 1: the device's own functions; gives up equal bits */
  int profile;               /* 1: time every kernel launch */
} cdl_Settings;

void cdl_settings_default(cdl_Settings *settings);

/* A render in progress: the scene packed for a device, and the film. Scene and device outlive it. */
typedef struct cdl_Session cdl_Session;

/* Called between passes and waves: samples done and to do, seconds so far. Returning nonzero stops the
 * render; what was finished is kept. */
typedef int (*cdl_Progress)(void *user, uint64_t samples_done, uint64_t samples_total, double seconds);

cdl_Status cdl_session_create(const cdl_Log *log, cdl_Device *device, const cdl_Scene *scene,
                              const cdl_Settings *settings, cdl_Session **session);

/* Renders until the samples, the time or the noise target is reached; CDL_INTERRUPTED if `progress`
 * stopped it. May be called again to go on. */
cdl_Status cdl_session_render(cdl_Session *session, cdl_Progress progress, void *user);

/* Writes and reads back a checkpoint: the state of the film, bit for bit, of this very render. */
cdl_Status cdl_session_save(cdl_Session *session, const char *path);
cdl_Status cdl_session_resume(cdl_Session *session, const char *path);

void cdl_session_free(cdl_Session *session); /* NULL is nothing */

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
