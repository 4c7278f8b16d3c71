/* candela: chooses the subcommand. */
#include "cli/cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct {
  const char *name;
  int (*run)(int argc, char **argv);
  const char *meaning;
} commands[] = {
    {"render", cli_render, "make a picture of a glTF scene"},
    {"devices", cli_devices, "list OpenCL devices, what they lack, and why one cannot be used"},
    {"info", cli_info, "tell what is in a scene, and what is not supported"},
    {"compare", cli_compare, "error metrics between two pictures"},
    {"bsdf", cli_bsdf, "evaluate, sample and plot a material, from and to CSV"},
    {"merge", cli_merge, "put partial films together into a picture"},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

static void print_help(FILE *out) {
  fprintf(out, "Usage: candela COMMAND [ARGUMENT…]\n"
               "A physically based renderer whose light transport runs as OpenCL kernels.\n\n");
  for (int i = 0; i < COMMANDS; i++)
    fprintf(out, "  %-9s %s\n", commands[i].name, commands[i].meaning);
  fprintf(out,
          "\n'candela COMMAND --help' tells more of each. For a start:\n"
          "  candela render scene.gltf -o picture.png\n\n"
          "Exit status: 0 done; 1 a check found differences; 2 usage; 3 bad input; 4 device or\n"
          "OpenCL failure; 5 an output could not be written; 130 interrupted.\n");
}

static int unknown(const char *name) {
  const char *names[COMMANDS + 1] = {NULL};
  for (int i = 0; i < COMMANDS; i++) names[i] = commands[i].name;
  const char *closest = cli_closest(name, names);
  if (closest)
    fprintf(stderr, "candela: there is no command '%s'; did you mean '%s'?\n", name, closest);
  else
    fprintf(stderr, "candela: there is no command '%s'; see candela --help\n", name);
  return CDL_USAGE;
}

/* argp prints help and ends the program by itself. */
static void check_output(void) {
  if (cli_flush()) _exit(CDL_OUTPUT);
}

static int run(int index, int argc, char **argv) {
  char name[32];
  snprintf(name, sizeof name, "candela %s", commands[index].name);
  argv[0] = name;
  return commands[index].run(argc, argv);
}

int main(int argc, char **argv) {
  argp_err_exit_status = CDL_USAGE;
  argp_program_version = "candela " CDL_VERSION;
  atexit(check_output);
  if (argc < 2) {
    fputs("candela: no command given; see candela --help\n", stderr);
    return CDL_USAGE;
  }
  const char *name = argv[1];
  if (!strcmp(name, "help") && argc > 2) { /* candela help render */
    name = argv[1] = argv[2];
    argv[2] = "--help";
  }
  if (!strcmp(name, "--help") || !strcmp(name, "-h") || !strcmp(name, "help")) {
    print_help(stdout);
    return CDL_OK;
  }
  if (!strcmp(name, "--version") || !strcmp(name, "-V")) {
    puts(argp_program_version);
    return CDL_OK;
  }
  for (int i = 0; i < COMMANDS; i++)
    if (!strcmp(name, commands[i].name)) return run(i, argc - 1, argv + 1);
  return unknown(name);
}
