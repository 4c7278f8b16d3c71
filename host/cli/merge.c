/* candela merge: partial films into a picture. */
#include "cli/cli.h"
#include "core/log.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX_OUTPUTS = 64, KEY_STATS = 256, KEY_EXPOSURE, KEY_TONEMAP };

typedef struct Options {
  const char **parts;
  size_t part_count;
  const char *outputs[MAX_OUTPUTS];
  int output_count;
  const char *stats;
  cdl_Display display;
} Options;

static const struct argp_option option_list[] = {
    {"output", 'o', "FILE", 0, "Write the picture: .exr .png .hdr .jpg .tif; may be repeated", 0},
    {"exposure", KEY_EXPOSURE, "EV", 0, "Exposure of 8-bit pictures", 0},
    {"tonemap", KEY_TONEMAP, "NAME", 0, "Curve of 8-bit pictures: none, aces, agx or neutral", 0},
    {"stats", KEY_STATS, "FILE", 0, "Write statistics as JSON, sums over the parts", 0},
    {"quiet", 'q', NULL, 0, "Print errors and warnings alone", 0},
    {0}};

static error_t parse_option(int key, char *value, struct argp_state *state) {
  static const char *const tonemaps[] = {"none", "aces", "agx", "neutral", NULL};
  Options *o = state->input;
  switch (key) {
  case 'o':
    if (o->output_count == MAX_OUTPUTS) cli_usage("-o: more than %d outputs", MAX_OUTPUTS);
    o->outputs[o->output_count++] = value;
    return 0;
  case KEY_EXPOSURE:
    o->display.exposure = cli_real("--exposure", value, -100, 100);
    return 0;
  case KEY_TONEMAP:
    o->display.tonemap = tonemaps[cli_choice("--tonemap", value, tonemaps)];
    return 0;
  case KEY_STATS:
    o->stats = value;
    return 0;
  case 'q':
    cli_quiet = 1;
    return 0;
  case ARGP_KEY_ARG:
    o->parts[o->part_count++] = value;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    option_list,
    parse_option,
    "PART… -o OUT",
    "Puts the parts that candela render --samples wrote together.\v"
    "The parts may come in any order; the picture has the very bits of one that was rendered in "
    "one "
    "go.\n\n"
    "Exit status: 0 done; 2 usage; 3 a part is damaged, missing or of another render; 5 an output "
    "could not be written.",
    NULL,
    NULL,
    NULL};

static cdl_Status write_all(const Options *o, cdl_Picture *picture) {
  cdl_Status status = CDL_OK;
  for (int i = 0; i < o->output_count; i++) {
    cdl_Status written = cdl_picture_write(picture, o->outputs[i], &o->display);
    if (!status) status = written;
  }
  if (!o->stats) return status;
  char *stats = cdl_picture_statistics_json(picture);
  cdl_Status reported =
      stats ? cdl_text_write(&cli_log, o->stats, stats)
            : log_fail(&cli_log, CDL_OUTPUT, "%s: not enough memory for the statistics", o->stats);
  free(stats);
  return status ? status : reported;
}

int cli_merge(int argc, char **argv) {
  Options o = {.parts = calloc((size_t)argc, sizeof *o.parts)};
  cdl_Picture *picture = NULL;
  cdl_Status status = CDL_OK;
  if (!o.parts) return log_fail(&cli_log, CDL_DEVICE, "not enough memory");
  cli_parse(&parser, argc, argv, &o);
  if (!o.part_count) cli_usage("no parts given: candela merge PART… -o OUT");
  if (!o.output_count) cli_usage("no output given: add -o picture.exr");
  for (int i = 0; i < o.output_count && !status; i++)
    status = cdl_output_check(&cli_log, o.outputs[i]);
  if (!status && o.stats) status = cdl_text_check(&cli_log, o.stats);
  if (!status) status = cdl_merge(&cli_log, o.parts, o.part_count, &picture);
  if (!status) status = write_all(&o, picture);
  cdl_picture_free(picture);
  free(o.parts);
  return status;
}
