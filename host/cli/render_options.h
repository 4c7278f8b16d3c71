/* render_options.h: the arguments of `candela render`. */
#ifndef CANDELA_CLI_RENDER_OPTIONS_H
#define CANDELA_CLI_RENDER_OPTIONS_H

#include "candela.h"

enum { CLI_MAX_OUTPUTS = 64 };

/* Strings are the arguments themselves; NULL where an option was not given. */
typedef struct RenderOptions {
  const char *scene;
  const char *outputs[CLI_MAX_OUTPUTS];
  int output_count;
  cdl_Settings settings;
  cdl_Display display;
  cdl_SceneOptions what; /* of the scene */
  const char *environment;
  double environment_strength;
  int has_background;
  float background[3];
  const char *device;
  const char *checkpoint;
  double checkpoint_every; /* s; 0: only when stopped */
  int resume;
  const char *stats, *trace;
  int profile; /* print the table */
} RenderOptions;

/* Fills it from the command line, or ends the program with status 2 and one line. */
void render_parse(int argc, char **argv, RenderOptions *options);

#endif
