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

/* Loads a .gltf or .glb file and all it refers to; `time` is the animation time in seconds,
 * negative for the pose at rest. *scene is set on success alone. */
cdl_Status cdl_scene_load(const cdl_Log *log, const char *path, double time, cdl_Scene **scene);

/* What of a scene is loaded. cdl_scene_options_default() fills it. */
typedef struct cdl_SceneOptions {
  double time;           /* animation time, s; negative: the pose at rest */
  const char *animation; /* name or index; NULL: all that do not move the same things */
  const char *variant;   /* of KHR_materials_variants, by name; NULL: the default materials */
  const char *camera;    /* name or index of the one whose shutter counts; NULL: the first */
} cdl_SceneOptions;

/* At rest, in the default materials. */
void cdl_scene_options_default(cdl_SceneOptions *options);

/* As cdl_scene_load(). CDL_USAGE for an animation or a variant that the file does not have, with a
 * list of what it has. */
cdl_Status cdl_scene_load_with(const cdl_Log *log, const char *path,
                               const cdl_SceneOptions *options, cdl_Scene **scene);

/* Replaces the scene's environment by an image file (latitude-longitude), NULL to keep it. */
cdl_Status cdl_scene_set_environment(cdl_Scene *scene, const cdl_Log *log, const char *path);

/* Multiplies the environment's radiance. CDL_USAGE, and nothing changed, unless the factor is
 * finite and >= 0 and the brightest direction stays finite. */
cdl_Status cdl_scene_set_environment_strength(cdl_Scene *scene, const cdl_Log *log, float strength);

/* Replaces the scene's environment by a constant radiance. */
void cdl_scene_set_background(cdl_Scene *scene, const float radiance[3]);

void cdl_scene_free(cdl_Scene *scene); /* NULL is nothing */

/* What it takes to make this very scene: the SHA-256 of the file, of all it refers to and of what
 * was replaced, 64 hexadecimal digits; valid as long as the scene. */
const char *cdl_scene_sha256(const cdl_Scene *scene);

/* What is in a scene, and what of it is not supported, as a JSON text that the caller frees; NULL
 * if memory is short. The members are those of `candela info --json`. */
char *cdl_scene_info_json(const cdl_Scene *scene);

/* The same for people, several lines. */
char *cdl_scene_info_text(const cdl_Scene *scene);

/* An OpenCL device, opened. One session uses it at a time; others may open it once more. */
typedef struct cdl_Device cdl_Device;

/* Opens the device that `selector` names: an index of the listing, or a part of a platform's or
 * device's name in any case; NULL for the best one. */
cdl_Status cdl_device_open(const cdl_Log *log, const char *selector, cdl_Device **device);

void cdl_device_close(cdl_Device *device); /* NULL is nothing */

/* Every platform and device, what it lacks, whether it is exact (measured where its driver does not
 * say so) and why it cannot be used, as a JSON text that the caller frees: the members of `candela
 * devices --json`. CDL_DEVICE if none can be used: *json is set then as well, but where they could
 * not even be listed it is NULL. */
cdl_Status cdl_devices_json(const cdl_Log *log, char **json);

/* The same for people, several lines. */
cdl_Status cdl_devices_text(const cdl_Log *log, char **text);

/* Told of each step of a long preparation, "compiling kernel": `done` of `total`. */
typedef void (*cdl_Stage)(void *user, const char *what, uint64_t done, uint64_t total);

typedef enum cdl_Schedule {
  CDL_SCHEDULE_AUTO,
  CDL_SCHEDULE_WAVEFRONT,
  CDL_SCHEDULE_FUSED
} cdl_Schedule;

/* Limits of settings; see cdl_settings_check. */
#define CDL_MAX_SIZE 65536u        /* pixels of a side */
#define CDL_MAX_PIXELS 2147483648u /* of the full image */
#define CDL_MAX_SAMPLES (1u << 24) /* of a pixel */
#define CDL_MAX_DEPTH 4095u

/* What to render. cdl_settings_default() fills it. */
typedef struct cdl_Settings {
  uint32_t width, height; /* pixels of the full image; one of them 0: from the camera's aspect */
  uint32_t samples;       /* of each pixel, >= 1 */
  uint32_t first_sample;  /* part of the samples: multiples of 16, but for the end of `samples` */
  uint32_t sample_count;  /* 0: all from first_sample on. If either is given, the session renders a
                             part: its .exr files keep block sums for cdl_merge, even if all samples
                             are in it */
  uint32_t crop[4];       /* x, y, width, height; width 0: the full image */
  const char *camera;     /* name or index; NULL: the first */
  uint32_t max_depth;     /* scattering events after the camera ray, <= 4095 */
  uint32_t seed;
  double time_limit;   /* s of rendering; 0: none */
  double noise_target; /* relative standard error of the image, median of pixels; 0: none */
  uint32_t aovs;       /* bit i: entry i of the table in image/aov.h */
  cdl_Schedule schedule;
  uint32_t bvh_width; /* 2 or 8; 0: what suits the device */
  int fast_math;      /* 1: the device's own functions; gives up equal bits */
  int profile;        /* 1: time every kernel launch */
  cdl_Stage stage;    /* NULL: nobody wants to know */
  void *stage_user;
} cdl_Settings;

/* 1280 pixels wide at the camera's aspect, 64 samples of seed 0, 16 events deep, no limits. */
void cdl_settings_default(cdl_Settings *settings);

/* CDL_USAGE, naming the command line's option, for settings that contradict each other or that this
 * version does not have. What depends on the scene (camera, crop) is left to the session. */
cdl_Status cdl_settings_check(const cdl_Log *log, const cdl_Settings *settings);

/* Reads a list of AOVs, "albedo,normal" or "all", into the bits of cdl_Settings.aovs. CDL_USAGE
 * names what there is. */
cdl_Status cdl_aovs_parse(const cdl_Log *log, const char *list, uint32_t *aovs);

/* The AOVs one by one, from 0 on; NULL after the last. `meaning` may be NULL; both are static. */
const char *cdl_aov_name(unsigned index, const char **meaning);

/* A render in progress: the scene packed for a device, and the film. Scene and device outlive it.
 */
typedef struct cdl_Session cdl_Session;

/* Called between passes and waves: samples done and to do, of all pixels together, and seconds so
 * far. Returning nonzero stops the render; what was finished is kept. The film is in order, so that
 * it may call cdl_session_save. */
typedef int (*cdl_Progress)(void *user, uint64_t samples_done, uint64_t samples_total,
                            double seconds);

/* CDL_USAGE if another session uses the device: from here to cdl_session_free it is this one's. */
cdl_Status cdl_session_create(const cdl_Log *log, cdl_Device *device, const cdl_Scene *scene,
                              const cdl_Settings *settings, cdl_Session **session);

/* Renders until the samples, the time or the noise target is reached; CDL_INTERRUPTED if `progress`
 * stopped it. May be called again to go on. */
cdl_Status cdl_session_render(cdl_Session *session, cdl_Progress progress, void *user);

/* The picture's size in pixels (of the crop), and the samples that the pixel with the fewest and
 * the one with the most have so far. Pointers may be NULL. */
void cdl_session_size(const cdl_Session *session, uint32_t *width, uint32_t *height);
void cdl_session_samples(const cdl_Session *session, uint32_t *least, uint32_t *most);

/* The mean radiance so far: height x width x 3 floats, linear Rec. 709, rows from the top. */
cdl_Status cdl_session_pixels(const cdl_Session *session, float *rgb);

/* Writes a checkpoint, all at once: the state of the film, bit for bit, of this very render.
 * CDL_OUTPUT leaves an older one untouched. */
cdl_Status cdl_session_save(cdl_Session *session, const char *path);

/* Goes on from a checkpoint. CDL_BAD_INPUT, and nothing changed, if it is damaged or of another
 * scene, setting or version. */
cdl_Status cdl_session_resume(cdl_Session *session, const char *path);

/* How pictures of 8 bits are made; floating-point formats stay linear. */
typedef struct cdl_Display {
  double exposure;     /* EV: values are multiplied by 2^exposure */
  const char *tonemap; /* "none", "aces", "agx" or "neutral"; NULL: none */
} cdl_Display;

/* Finds out before a render whether a picture of this name can be written: CDL_USAGE for an unknown
 * suffix, CDL_OUTPUT if the folder does not take a file. */
cdl_Status cdl_output_check(const cdl_Log *log, const char *path);

/* Finds out before a render whether its format can hold a picture of this size: CDL_OUTPUT if not.
 */
cdl_Status cdl_session_output_check(const cdl_Session *session, const char *path);

/* Writes the picture by suffix: .exr (all AOVs as layers, and what was rendered in the header;
 * block sums too if the session renders a part of the samples), .hdr, .tif, .png, .jpg. `display`
 * may be NULL. All at once: there is never half a file. */
cdl_Status cdl_session_write(cdl_Session *session, const char *path, const cdl_Display *display);

/* What was rendered and what it cost, as a JSON text that the caller frees; NULL if memory is
 * short. */
char *cdl_session_statistics_json(cdl_Session *session);

/* The table of kernels, for people, that the caller frees; NULL without settings.profile. */
char *cdl_session_profile_text(cdl_Session *session);

/* Keeps every kernel launch of a session from now on, for a trace. The session outlives it. */
typedef struct cdl_Trace cdl_Trace;
cdl_Status cdl_trace_start(cdl_Session *session, cdl_Trace **trace);

/* Writes what was kept in the Trace Event Format (JSON) that Perfetto and Chrome show. */
cdl_Status cdl_trace_write(const cdl_Trace *trace, const char *path);
void cdl_trace_free(cdl_Trace *trace); /* NULL is nothing */

void cdl_session_free(cdl_Session *session); /* NULL is nothing */

/* A picture put together from parts. */
typedef struct cdl_Picture cdl_Picture;

/* Reads EXR files that sessions wrote which rendered parts of the samples, in any order, and merges
 * them into the picture, bit for bit, that one session would have made of all samples.
 * CDL_BAD_INPUT names a part that does not belong to the first one, overlaps another, or what is
 * missing. */
cdl_Status cdl_merge(const cdl_Log *log, const char *const *paths, size_t count,
                     cdl_Picture **picture);

/* As for a session. */
cdl_Status cdl_picture_write(cdl_Picture *picture, const char *path, const cdl_Display *display);
char *cdl_picture_statistics_json(const cdl_Picture *picture);
void cdl_picture_free(cdl_Picture *picture); /* NULL is nothing */

/* Finds out whether cdl_text_write or cdl_session_save can write a file of this name: CDL_OUTPUT.
 */
cdl_Status cdl_text_check(const cdl_Log *log, const char *path);

/* Writes a text to a file, all at once. */
cdl_Status cdl_text_write(const cdl_Log *log, const char *path, const char *text);

/* One material of a scene on a device, asked about directions. */
typedef struct cdl_Bsdf cdl_Bsdf;

/* `material` is a name, or an index from 0. Textures count as white: a note says so. CDL_USAGE for
 * a material that the scene does not have, one that scatters no light (unlit, interface), or while
 * a session uses the device, which is this one's until cdl_bsdf_free. The scene is not needed
 * afterwards. */
cdl_Status cdl_bsdf_create(const cdl_Log *log, cdl_Device *device, const cdl_Scene *scene,
                           const char *material, cdl_Bsdf **bsdf);

/* Directions have length 1 and are in the material's own frame: +Z the normal of its front, X the
 * tangent. wo points to where light goes, wi to where it comes from, both away from the surface. An
 * opaque material answers alike on both sides; one that light passes takes z < 0 for its inside.
 *
 * `pairs`: count x (wo, wi); `values`: count x (f red, green, blue; pdf), f without the cosine, of
 * radiance, and pdf per solid angle; 0 for delta lobes, and where a direction lies in the surface.
 * A dispersive material answers with the mean over wavelengths, seen by white light. */
cdl_Status cdl_bsdf_evaluate(cdl_Bsdf *bsdf, size_t count, const float *pairs, float *values);

/* `wo`: count x 3; `values`: for each of them `samples` x (wi, weight red, green, blue, pdf,
 * delta), the weight f cos / pdf, pdf 0 and delta 1 for a delta lobe; black: no such path. The
 * numbers are a render's: low-discrepancy sequences from `seed`, another for each direction, which
 * are numbered from `first`. Each sample of a dispersive material is of one wavelength. 1 <=
 * samples <= CDL_MAX_SAMPLES. */
cdl_Status cdl_bsdf_sample(cdl_Bsdf *bsdf, size_t count, const float *wo, uint32_t first,
                           uint32_t samples, uint32_t seed, float *values);

/* Polar slices of f |cos| for four directions wo, in the planes along the tangent and across it, as
 * a picture of linear RGB that cdl_output_check() takes the name of. */
cdl_Status cdl_bsdf_plot(cdl_Bsdf *bsdf, const char *path);

void cdl_bsdf_free(cdl_Bsdf *bsdf); /* NULL is nothing */

/* How far picture A is from the reference B; over the pixels that are finite in both. */
typedef struct cdl_Difference {
  int identical; /* every value has the same bits */
  uint64_t pixels, finite_pixels;
  uint64_t nonfinite[2]; /* values of A and of B that are infinite or NaN */
  double mean[2];        /* of A and of B */
  double mse, rmse;
  double relative_mse; /* mean of d^2 / (b^2 + 0.01) */
  double bias;         /* mean of A - B */
  double max_abs;
  uint32_t max_x, max_y; /* where that is */
  double psnr;           /* dB against a peak of 1; infinite when mse is 0 */
  double ssim;           /* of the sRGB-encoded luminance; NaN below 11 pixels */
} cdl_Difference;

/* Compares two picture files, in linear light. `layer` names a layer of both EXR files, NULL for
 * the main one. CDL_DIFFERENT, and *difference unset, if their sizes differ; otherwise CDL_OK
 * whatever the difference. */
cdl_Status cdl_compare(const cdl_Log *log, const char *a, const char *b, const char *layer,
                       cdl_Difference *difference);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
