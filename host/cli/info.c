/* candela info: what is in a scene, and what of it is not supported. */
#include "cli/cli.h"

typedef struct Options {
  int json;
  const char *path;
  cdl_SceneOptions what;
} Options;

enum { KEY_AT = 256, KEY_ANIMATION, KEY_VARIANT };

static const struct argp_option option_list[] = {
    {"json", 'j', NULL, 0, "Print JSON on standard output", 0},
    {"at", KEY_AT, "SECONDS", 0, "Animation time, as for candela render", 0},
    {"animation", KEY_ANIMATION, "NAME|INDEX", 0, "Animation, as for candela render", 0},
    {"variant", KEY_VARIANT, "NAME", 0, "Materials of this variant of the scene", 0},
    {0}};

static error_t parse_option(int key, char *value, struct argp_state *state) {
  Options *options = state->input;
  switch (key) {
  case 'j':
    options->json = 1;
    return 0;
  case KEY_AT:
    options->what.time = cli_real("--at", value, 0, 1e9);
    return 0;
  case KEY_ANIMATION:
    options->what.animation = value;
    return 0;
  case KEY_VARIANT:
    options->what.variant = value;
    return 0;
  case ARGP_KEY_ARG:
    if (options->path) cli_usage("one scene at a time: '%s' is one too many", value);
    options->path = value;
    return 0;
  case ARGP_KEY_END:
    if (!options->path) cli_usage("no scene given");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    option_list,
    parse_option,
    "SCENE",
    "Tells what is in a glTF scene, and what of it is not supported.\v"
    "Triangles are counted as they are shown: those of a mesh once for each of its instances. "
    "Lights are punctual lights, shapes that emit, and the environment.\n\n"
    "Exit status: 0, 3 if the scene is damaged or cannot be read, 2 for wrong usage.",
    NULL,
    NULL,
    NULL};

int cli_info(int argc, char **argv) {
  Options options = {0};
  cdl_Scene *scene = NULL;
  cdl_scene_options_default(&options.what);
  cli_parse(&parser, argc, argv, &options);
  cdl_Status status = cdl_scene_load_with(&cli_log, options.path, &options.what, &scene);
  if (status) return status;
  char *text = options.json ? cdl_scene_info_json(scene) : cdl_scene_info_text(scene);
  cdl_scene_free(scene);
  return cli_print(text);
}
