/* candela bsdf: one material of a scene, evaluated and sampled on the device, from and to CSV. */
#include "cli/cli.h"
#include "core/log.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_MATERIAL = 256, KEY_PAIRS, KEY_SAMPLE, KEY_VIEWS, KEY_SEED, KEY_PLOT, KEY_DEVICE };

enum { LINE_SIZE = 1024, ROWS = 1 << 16, RESULTS = 1 << 20 };

typedef struct Options {
  const char *scene, *material, *pairs, *views, *plot, *device;
  uint32_t samples, seed;
} Options;

static const struct argp_option option_list[] = {
    {"material", KEY_MATERIAL, "NAME|INDEX", 0, "The material; `candela info` lists them", 0},
    {"pairs", KEY_PAIRS, "FILE", 0,
     "Evaluate: read lines wo.x,wo.y,wo.z,wi.x,wi.y,wi.z and print f.r,f.g,f.b,pdf for each", 0},
    {"sample", KEY_SAMPLE, "N", 0,
     "Sample: read lines wo.x,wo.y,wo.z and print for each N lines "
     "wi.x,wi.y,wi.z,weight.r,weight.g,weight.b,pdf,delta",
     0},
    {"views", KEY_VIEWS, "FILE", 0, "Where --sample reads from (standard input)", 0},
    {"seed", KEY_SEED, "N", 0, "Of the random numbers of --sample (0)", 0},
    {"plot", KEY_PLOT, "OUT", 0, "Draw polar slices into a picture, .png or another format", 0},
    {"device", KEY_DEVICE, "SELECTOR", 0, "OpenCL device, as for candela render", 0},
    {0}};

static void check_end(const Options *o) {
  if (!o->scene) cli_usage("no scene given");
  if (!o->material) cli_usage("no material given; choose one with --material NAME");
  if (!o->pairs && !o->samples && !o->plot)
    cli_usage("nothing to do; give --pairs FILE, --sample N or --plot OUT.png");
  if (o->pairs && o->samples) cli_usage("--pairs and --sample exclude each other");
  if (o->views && !o->samples) cli_usage("--views is for --sample alone");
}

static error_t parse_option(int key, char *value, struct argp_state *state) {
  Options *o = state->input;
  switch (key) {
  case KEY_MATERIAL:
    o->material = value;
    return 0;
  case KEY_PAIRS:
    o->pairs = value;
    return 0;
  case KEY_SAMPLE:
    o->samples = cli_uint("--sample", value, 1, CDL_MAX_SAMPLES);
    return 0;
  case KEY_VIEWS:
    o->views = value;
    return 0;
  case KEY_SEED:
    o->seed = cli_uint("--seed", value, 0, UINT32_MAX);
    return 0;
  case KEY_PLOT:
    o->plot = value;
    return 0;
  case KEY_DEVICE:
    o->device = value;
    return 0;
  case ARGP_KEY_ARG:
    if (o->scene) cli_usage("one scene at a time: '%s' is one too many", value);
    o->scene = value;
    return 0;
  case ARGP_KEY_END:
    check_end(o);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    option_list,
    parse_option,
    "SCENE",
    "Evaluates and samples a material of a glTF scene on the device, from and to CSV.\v"
    "Directions are in the material's own frame, +Z the normal of its front and X the tangent, of "
    "any length. wo points to where light goes, wi to where it comes from. f is without the "
    "cosine, of radiance towards wo, so with the square of the index where light is refracted. "
    "Opaque materials answer on both sides; for those that light passes, z < 0 is inside. Delta "
    "lobes are sampled alone: f 0, pdf 0, delta 1. Textures count as white. A FILE of - is "
    "standard "
    "input; empty lines, lines that begin with # and a heading are passed over.\n\n"
    "Exit status: 0; 2 wrong usage; 3 the scene or a line cannot be read; 4 device or OpenCL "
    "failure; 5 an output cannot be written.",
    NULL,
    NULL,
    NULL};

/* --- Lines of numbers. */

typedef struct Lines {
  FILE *file;
  const char *name; /* for messages */
  uint64_t line;
  int width;        /* numbers in a line */
  const char *what; /* their names */
} Lines;

static cdl_Status open_lines(Lines *lines, const char *path) {
  int standard = !strcmp(path, "-");
  lines->name = standard ? "standard input" : path;
  lines->file = standard ? stdin : fopen(path, "r");
  if (lines->file) return CDL_OK;
  return log_fail(&cli_log, CDL_BAD_INPUT,
                  "%s: cannot be opened; give a file, or - for standard input", path);
}

static void close_lines(Lines *lines) {
  if (lines->file && lines->file != stdin) fclose(lines->file);
}

static cdl_Status bad_line(const Lines *lines, const char *why) {
  return log_fail(&cli_log, CDL_BAD_INPUT, "%s:%llu: %s; a line is %s", lines->name,
                  (unsigned long long)lines->line, why, lines->what);
}

/* How many numbers stand in a line, as far as `width`; one more for anything else. */
static int read_numbers(const char *text, int width, double *numbers) {
  for (int i = 0; i < width; i++) {
    char *end;
    numbers[i] = strtod(text, &end);
    if (end == text) return i;
    text = end + strspn(end, " \t");
    if (i + 1 < width && *text != ',') return i + 1;
    text += *text == ',' && i + 1 < width;
  }
  return text[strspn(text, " \t\r\n")] ? width + 1 : width;
}

/* Each three numbers are a direction, made one long. */
static cdl_Status put_directions(const Lines *lines, const double *numbers, float *to) {
  for (int i = 0; i < lines->width; i += 3) {
    const double *n = numbers + i, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!isfinite(length) || length < 1e-30)
      return bad_line(lines, "a direction must be finite and have a length");
    for (int k = 0; k < 3; k++) to[i + k] = (float)(n[k] / length);
  }
  return CDL_OK;
}

/* Headings begin with a letter; "inf" and "nan" are bad numbers instead. */
static int is_passed_over(const Lines *lines, const char *text) {
  text += strspn(text, " \t\r\n");
  return !*text || *text == '#' || (lines->line == 1 && *text == 'w');
}

/* Up to `most` lines; *count 0: there are no more. */
static cdl_Status read_lines(Lines *lines, size_t most, float *to, size_t *count) {
  char text[LINE_SIZE];
  double numbers[6];
  cdl_Status status = CDL_OK;
  for (*count = 0; *count < most && !status && fgets(text, sizeof text, lines->file);) {
    lines->line++;
    if (strlen(text) == sizeof text - 1) return bad_line(lines, "it is too long");
    if (is_passed_over(lines, text)) continue;
    const int found = read_numbers(text, lines->width, numbers);
    if (found != lines->width)
      return bad_line(lines, found > lines->width ? "it has more than its numbers"
                                                  : "a number is missing or damaged");
    status = put_directions(lines, numbers, to + *count * (size_t)lines->width);
    ++*count;
  }
  if (!status && ferror(lines->file))
    return log_fail(&cli_log, CDL_BAD_INPUT, "%s: cannot be read to its end", lines->name);
  return status;
}

static cdl_Status print_rows(const float *values, size_t rows, size_t width) {
  for (size_t i = 0; i < rows; i++)
    for (size_t k = 0; k < width; k++)
      printf("%.9g%c", (double)values[i * width + k] + 0.0, k + 1 < width ? ',' : '\n');
  return ferror(stdout) ? cli_flush() : CDL_OK;
}

/* --- The two questions, a part of the lines at a time. */

static cdl_Status answer_pairs(cdl_Bsdf *bsdf, Lines *lines, float *asked, float *values) {
  for (size_t count = 1; count;) {
    cdl_Status status = read_lines(lines, ROWS, asked, &count);
    if (!status) status = cdl_bsdf_evaluate(bsdf, count, asked, values);
    if (!status) status = print_rows(values, count, 4);
    if (status) return status;
  }
  return CDL_OK;
}

static cdl_Status answer_samples(cdl_Bsdf *bsdf, const Options *o, Lines *lines, float *asked,
                                 float *values) {
  const size_t fit = RESULTS / o->samples, most = fit < 1 ? 1 : fit < ROWS ? fit : ROWS;
  uint32_t first = 0;
  for (size_t count = 1; count; first += (uint32_t)count) {
    cdl_Status status = read_lines(lines, most, asked, &count);
    if (!status) status = cdl_bsdf_sample(bsdf, count, asked, first, o->samples, o->seed, values);
    if (!status) status = print_rows(values, count * o->samples, 8);
    if (status) return status;
  }
  return CDL_OK;
}

static cdl_Status answer(cdl_Bsdf *bsdf, const Options *o) {
  Lines lines = {.width = o->pairs ? 6 : 3,
                 .what = o->pairs ? "wo.x,wo.y,wo.z,wi.x,wi.y,wi.z" : "wo.x,wo.y,wo.z"};
  const size_t results = o->samples > RESULTS ? o->samples : RESULTS;
  float *asked = malloc(ROWS * 6 * sizeof *asked), *values = malloc(results * 8 * sizeof *values);
  cdl_Status status = open_lines(&lines, o->pairs ? o->pairs : o->views ? o->views : "-");
  if (!status && (!asked || !values))
    status = log_fail(&cli_log, CDL_DEVICE, "not enough memory for %u samples", o->samples);
  if (!status)
    status = o->pairs ? answer_pairs(bsdf, &lines, asked, values)
                      : answer_samples(bsdf, o, &lines, asked, values);
  close_lines(&lines);
  free(asked);
  free(values);
  return status;
}

int cli_bsdf(int argc, char **argv) {
  Options o = {0};
  cdl_Scene *scene = NULL;
  cdl_Device *device = NULL;
  cdl_Bsdf *bsdf = NULL;
  cli_parse(&parser, argc, argv, &o);
  cdl_Status status = o.plot ? cdl_output_check(&cli_log, o.plot) : CDL_OK;
  if (!status) status = cdl_scene_load(&cli_log, o.scene, -1, &scene);
  if (!status) status = cdl_device_open(&cli_log, o.device, &device);
  if (!status) status = cdl_bsdf_create(&cli_log, device, scene, o.material, &bsdf);
  if (!status && (o.pairs || o.samples)) status = answer(bsdf, &o);
  if (!status && o.plot) status = cdl_bsdf_plot(bsdf, o.plot);
  cdl_bsdf_free(bsdf);
  cdl_device_close(device);
  cdl_scene_free(scene);
  const cdl_Status printed = cli_flush();
  return status ? status : printed;
}
