/* candela devices: every platform and device, what it lacks, and why it cannot be used. */
#include "cli/cli.h"

typedef struct Options {
  int json;
} Options;

static const struct argp_option option_list[] = {
    {"json", 'j', NULL, 0, "Print JSON on standard output", 0}, {0}};

static error_t parse_option(int key, char *value, struct argp_state *state) {
  Options *options = state->input;
  if (key == 'j') {
    options->json = 1;
    return 0;
  }
  if (key == ARGP_KEY_ARG) cli_usage("unexpected argument '%s'", value);
  return ARGP_ERR_UNKNOWN;
}

static const struct argp parser = {
    option_list,
    parse_option,
    "",
    "Lists every OpenCL platform and device, what it lacks, and why it cannot be used.\v"
    "The number in front of a device is what --device takes, as well as any part of its name or of "
    "its platform's. A device is exact if it computes the same bits as all exact devices; where "
    "its driver does not say so, that is measured.\n\n"
    "Exit status: 0 if a device can be used, 4 if none can, 2 for wrong usage.",
    NULL,
    NULL,
    NULL};

int cli_devices(int argc, char **argv) {
  Options options = {0};
  char *text = NULL;
  cli_parse(&parser, argc, argv, &options);
  cdl_Status status =
      options.json ? cdl_devices_json(&cli_log, &text) : cdl_devices_text(&cli_log, &text);
  if (!text) return status;
  cdl_Status printed = cli_print(text);
  return printed ? printed : status;
}
