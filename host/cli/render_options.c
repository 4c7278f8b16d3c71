#include "cli/render_options.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "image/image_write.h"

enum {
  KEY_SIZE = 256,
  KEY_SPP,
  KEY_TIME,
  KEY_NOISE,
  KEY_CAMERA,
  KEY_AT,
  KEY_ANIMATION,
  KEY_VARIANT,
  KEY_ENV,
  KEY_ENV_STRENGTH,
  KEY_BACKGROUND,
  KEY_EXPOSURE,
  KEY_TONEMAP,
  KEY_AOV,
  KEY_CROP,
  KEY_MAX_DEPTH,
  KEY_SEED,
  KEY_SAMPLES,
  KEY_DEVICE,
  KEY_SCHEDULE,
  KEY_BVH,
  KEY_MATH,
  KEY_CHECKPOINT,
  KEY_CHECKPOINT_EVERY,
  KEY_RESUME,
  KEY_STATS,
  KEY_TRACE,
  KEY_PROFILE
};

/* Samples of a render that only a time or a noise target ends. */
enum { OPEN_ENDED_SAMPLES = 65536 };

static const struct argp_option option_list[] = {
    {"output", 'o', "FILE", 0, "Write the picture: .exr .png .hdr .jpg .tif; may be repeated", 1},
    {"size", KEY_SIZE, "WxH", 0,
     "Pixels; one number may be left out (640x, x480): it follows the camera's aspect", 1},
    {"camera", KEY_CAMERA, "NAME|INDEX", 0, "Camera of the scene; the first by default", 1},
    {"crop", KEY_CROP, "X,Y,W,H", 0, "Render this rectangle of the picture alone", 1},
    {"aov", KEY_AOV, "LIST", 0, "Further layers for .exr files; 'list' tells which there are", 1},
    {"exposure", KEY_EXPOSURE, "EV", 0, "Exposure of 8-bit pictures", 1},
    {"tonemap", KEY_TONEMAP, "NAME", 0, "Curve of 8-bit pictures: none, aces, agx or neutral", 1},
    {"spp", KEY_SPP, "N", 0, "Samples of each pixel; 64 by default, 65536 with --time or --noise",
     2},
    {"time", KEY_TIME, "SECONDS", 0, "Stop when this time is over", 2},
    {"noise", KEY_NOISE, "REL", 0,
     "Stop when half of the pixels have a relative error below this: 0.01 is 1 %", 2},
    {"samples", KEY_SAMPLES, "FIRST:COUNT", 0,
     "Render a part of the samples, in multiples of 16, for candela merge", 2},
    {"seed", KEY_SEED, "N", 0, "Seed of the random numbers; 0 by default", 2},
    {"max-depth", KEY_MAX_DEPTH, "N", 0, "Scattering events on a path; 16 by default", 2},
    {"at", KEY_AT, "SECONDS", 0, "Animation time; the pose at rest by default", 3},
    {"animation", KEY_ANIMATION, "NAME|INDEX", 0,
     "Show this animation alone; by default the first, and each that moves other things", 3},
    {"variant", KEY_VARIANT, "NAME", 0, "Materials of this variant of the scene", 3},
    {"env", KEY_ENV, "FILE", 0, "Environment map (latitude and longitude) instead of the scene's",
     3},
    {"env-strength", KEY_ENV_STRENGTH, "X", 0, "Factor of the environment's radiance", 3},
    {"background", KEY_BACKGROUND, "R,G,B", 0, "Constant environment instead of the scene's", 3},
    {"device", KEY_DEVICE, "SELECTOR", 0,
     "Index from candela devices, or part of a platform's or device's name", 4},
    {"schedule", KEY_SCHEDULE, "NAME", 0, "auto or wavefront", 4},
    {"bvh", KEY_BVH, "WIDTH", 0, "auto, 2 or 8", 4},
    {"math", KEY_MATH, "NAME", 0, "exact: the same bits on every device", 4},
    {"checkpoint", KEY_CHECKPOINT, "FILE", 0, "Keep the unfinished render in this file", 5},
    {"checkpoint-every", KEY_CHECKPOINT_EVERY, "SECONDS", 0,
     "How often; by default when interrupted only", 5},
    {"resume", KEY_RESUME, NULL, 0, "Go on from the checkpoint if there is one", 5},
    {"stats", KEY_STATS, "FILE", 0, "Write statistics as JSON", 6},
    {"trace", KEY_TRACE, "FILE", 0, "Write every kernel launch as a JSON trace for Perfetto", 6},
    {"profile", KEY_PROFILE, NULL, 0, "Print a table by kernel", 6},
    {"quiet", 'q', NULL, 0, "Print errors and warnings alone", 6},
    {0}};

static void parse_size(const char *text, cdl_Settings *settings) {
  const char *x = strchr(text, 'x');
  char width[16];
  snprintf(width, sizeof width, "%.*s", x ? (int)(x - text) : 15, text);
  settings->width = settings->height = 0;
  if (x && x - text >= (long)sizeof width) cli_usage("--size: '%s' is too large", text);
  if (*width) settings->width = cli_uint("--size", width, 1, CDL_MAX_SIZE);
  if (x && x[1]) settings->height = cli_uint("--size", x + 1, 1, CDL_MAX_SIZE);
  if (!settings->width && !settings->height)
    cli_usage("--size: '%s' is not WxH, Wx or xH, such as 640x480", text);
}

static void parse_samples(const char *text, cdl_Settings *settings) {
  uint32_t range[2];
  cli_uints("--samples", text, ':', 2, range);
  if (!range[1]) cli_usage("--samples: the count is 0");
  settings->first_sample = range[0];
  settings->sample_count = range[1];
}

static void parse_crop(const char *text, cdl_Settings *settings) {
  cli_uints("--crop", text, ',', 4, settings->crop);
  if (!settings->crop[2] || !settings->crop[3]) cli_usage("--crop: '%s' is empty", text);
}

static void parse_background(const char *text, RenderOptions *options) {
  double values[3];
  cli_reals("--background", text, ',', 3, 0, FLT_MAX, values);
  for (int i = 0; i < 3; i++) options->background[i] = (float)values[i];
  options->has_background = 1;
}

static void list_aovs(void) {
  const char *name, *meaning;
  for (unsigned i = 0; (name = cdl_aov_name(i, &meaning)); i++) printf("%-10s%s\n", name, meaning);
  exit(CDL_OK);
}

static void parse_aovs(const char *text, cdl_Settings *settings) {
  if (!strcmp(text, "list")) list_aovs();
  if (cdl_aovs_parse(&cli_log, text, &settings->aovs)) exit(CDL_USAGE);
}

static void add_output(const char *path, RenderOptions *options) {
  if (options->output_count == CLI_MAX_OUTPUTS)
    cli_usage("-o: more than %d outputs", CLI_MAX_OUTPUTS);
  options->outputs[options->output_count++] = path;
}

/* Options about the picture and its samples; 0 if `key` is none of them. */
static int parse_picture(int key, const char *value, RenderOptions *options) {
  static const char *const tonemaps[] = {"none", "aces", "agx", "neutral", NULL};
  cdl_Settings *s = &options->settings;
  switch (key) {
  case 'o':
    add_output(value, options);
    break;
  case KEY_SIZE:
    parse_size(value, s);
    break;
  case KEY_CAMERA:
    s->camera = options->what.camera = value;
    break;
  case KEY_CROP:
    parse_crop(value, s);
    break;
  case KEY_AOV:
    parse_aovs(value, s);
    break;
  case KEY_EXPOSURE:
    options->display.exposure = cli_real("--exposure", value, -100, 100);
    break;
  case KEY_TONEMAP:
    options->display.tonemap = tonemaps[cli_choice("--tonemap", value, tonemaps)];
    break;
  case KEY_SPP:
    s->samples = cli_uint("--spp", value, 1, CDL_MAX_SAMPLES);
    break;
  case KEY_TIME:
    s->time_limit = cli_real("--time", value, 1e-3, 1e9);
    break;
  case KEY_NOISE:
    s->noise_target = cli_real("--noise", value, 1e-6, 1e6);
    break;
  case KEY_SAMPLES:
    parse_samples(value, s);
    break;
  case KEY_SEED:
    s->seed = cli_uint("--seed", value, 0, UINT32_MAX);
    break;
  case KEY_MAX_DEPTH:
    s->max_depth = cli_uint("--max-depth", value, 0, CDL_MAX_DEPTH);
    break;
  default:
    return 0;
  }
  return 1;
}

/* Options about the scene and the device; 0 if `key` is none. */
static int parse_other(int key, const char *value, RenderOptions *options) {
  static const char *const schedules[] = {"auto", "wavefront", "fused", NULL};
  static const char *const widths[] = {"auto", "2", "8", NULL};
  static const char *const maths[] = {"exact", "fast", NULL};
  static const uint32_t width[] = {0, 2, 8};
  cdl_Settings *s = &options->settings;
  switch (key) {
  case KEY_AT:
    options->what.time = cli_real("--at", value, 0, 1e9);
    break;
  case KEY_ANIMATION:
    options->what.animation = value;
    break;
  case KEY_VARIANT:
    options->what.variant = value;
    break;
  case KEY_ENV:
    options->environment = value;
    break;
  case KEY_ENV_STRENGTH:
    options->environment_strength = cli_real("--env-strength", value, 0, FLT_MAX);
    break;
  case KEY_BACKGROUND:
    parse_background(value, options);
    break;
  case KEY_DEVICE:
    options->device = value;
    break;
  case KEY_SCHEDULE:
    s->schedule = (cdl_Schedule)cli_choice("--schedule", value, schedules);
    break;
  case KEY_BVH:
    s->bvh_width = width[cli_choice("--bvh", value, widths)];
    break;
  case KEY_MATH:
    s->fast_math = cli_choice("--math", value, maths);
    break;
  default:
    return 0;
  }
  return 1;
}

/* Options about what is written beside the picture, and said; 0 if `key` is none. */
static int parse_reports(int key, const char *value, RenderOptions *options) {
  switch (key) {
  case KEY_CHECKPOINT:
    options->checkpoint = value;
    break;
  case KEY_CHECKPOINT_EVERY:
    options->checkpoint_every = cli_real("--checkpoint-every", value, 1e-3, 1e9);
    break;
  case KEY_RESUME:
    options->resume = 1;
    break;
  case KEY_STATS:
    options->stats = value;
    break;
  case KEY_TRACE:
    options->trace = value;
    break;
  case KEY_PROFILE:
    options->profile = 1;
    break;
  case 'q':
    cli_quiet = 1;
    break;
  default:
    return 0;
  }
  return 1;
}

static error_t parse_option(int key, char *value, struct argp_state *state) {
  RenderOptions *options = state->input;
  if (key == ARGP_KEY_ARG) {
    if (options->scene) cli_usage("one scene at a time: '%s' is one too many", value);
    options->scene = value;
    return 0;
  }
  int known = parse_picture(key, value, options) || parse_other(key, value, options) ||
              parse_reports(key, value, options);
  return known ? 0 : ARGP_ERR_UNKNOWN;
}

static const struct argp parser = {
    option_list,
    parse_option,
    "SCENE -o OUT",
    "Renders a .gltf or .glb scene.\v"
    "A render ends at --spp, --time or --noise, whichever comes first. Ctrl-C ends it as well: the "
    "picture so far is written, and a checkpoint before it if one is asked for.\n\n"
    "Exit status: 0 done; 2 usage; 3 the scene is damaged or missing; 4 device or OpenCL failure; "
    "5 an output could not be written; 130 interrupted.",
    NULL,
    NULL,
    NULL};

static int writes_exr(const RenderOptions *options) {
  for (int i = 0; i < options->output_count; i++)
    if (image_is_exr(options->outputs[i])) return 1;
  return 0;
}

static int same_file(const char *a, const char *b) {
  struct stat x, y;
  if (!a || !b) return 0;
  if (!strcmp(a, b)) return 1;
  return !stat(a, &x) && !stat(b, &y) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* No output may take the place of another one, or of what is read. */
static void refuse_overwriting(const RenderOptions *o) {
  const char *paths[CLI_MAX_OUTPUTS + 5] = {o->scene, o->environment, o->stats, o->trace,
                                            o->checkpoint};
  const int count = 5 + o->output_count;
  memcpy(paths + 5, o->outputs, (size_t)o->output_count * sizeof *paths);
  for (int i = 2; i < count; i++)
    for (int j = 0; j < i; j++)
      if (same_file(paths[i], paths[j]))
        cli_usage("%s: %s; give the output another name", paths[i],
                  j < 2 ? "is read, and would be overwritten" : "would be written twice");
}

/* What options mean together. */
static void check_together(RenderOptions *options) {
  cdl_Settings *s = &options->settings;
  if (!options->scene) cli_usage("no scene given: candela render SCENE -o OUT");
  if (!options->output_count) cli_usage("no output given: add -o picture.png");
  if (!s->samples) s->samples = s->time_limit > 0 || s->noise_target > 0 ? OPEN_ENDED_SAMPLES : 64;
  if (options->environment && options->has_background)
    cli_usage("--env and --background both replace the environment; give one of them");
  if (options->resume && !options->checkpoint) cli_usage("--resume needs --checkpoint FILE");
  if (options->checkpoint_every > 0 && !options->checkpoint)
    cli_usage("--checkpoint-every needs --checkpoint FILE");
  if (s->sample_count && !writes_exr(options))
    cli_usage("--samples needs an output that ends in .exr, which candela merge can read");
  if (s->aovs & ~1u && !writes_exr(options))
    cli_usage("--aov needs an output that ends in .exr, which has layers");
  refuse_overwriting(options);
  if (cdl_settings_check(&cli_log, s)) exit(CDL_USAGE);
}

void render_parse(int argc, char **argv, RenderOptions *options) {
  *options = (RenderOptions){.environment_strength = 1};
  cdl_scene_options_default(&options->what);
  cdl_settings_default(&options->settings);
  options->settings.samples = 0;
  cli_parse(&parser, argc, argv, options);
  check_together(options);
  options->settings.profile = options->profile || options->stats || options->trace;
}
