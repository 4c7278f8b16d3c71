/* scene_text.h: scenes written by a test into a folder of its own, and what loading them said. */
#ifndef CANDELA_TESTS_SCENE_TEXT_H
#define CANDELA_TESTS_SCENE_TEXT_H

#include <nettle/base64.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/scene.h"

static char scene_folder[64];
static char scene_errors[4096], scene_notes[8192];
static int scene_error_count;
static cdl_Status scene_status; /* of the last load */

static void scene_log_write(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  char *to = level == CDL_LOG_ERROR ? scene_errors : scene_notes;
  size_t room = level == CDL_LOG_ERROR ? sizeof scene_errors : sizeof scene_notes;
  scene_error_count += level == CDL_LOG_ERROR;
  snprintf(to + strlen(to), room - strlen(to), "%s\n", message);
}

static const cdl_Log scene_log = {scene_log_write, NULL};

/* Also cmocka's group set-up. */
static int scene_folder_make(void **state) {
  (void)state;
  const char *in = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp"; /* memory is quicker */
  snprintf(scene_folder, sizeof scene_folder, "%s/candela-scene-XXXXXX", in);
  return mkdtemp(scene_folder) ? 0 : -1;
}

static int scene_folder_remove(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf %s", scene_folder);
  return system(command) ? -1 : 0;
}

static inline void scene_write(const char *name, const void *data, size_t size) {
  char path[256];
  snprintf(path, sizeof path, "%s/%s", scene_folder, name);
  FILE *file = fopen(path, "wb");
  if (!file || fwrite(data, 1, size, file) != size || fclose(file)) abort();
}

/* Loads a file of the folder; NULL when that fails. */
static inline struct cdl_Scene *scene_open(const char *name, double time) {
  char path[256];
  struct cdl_Scene *scene = NULL;
  cdl_SceneOptions options = {.time = time};
  snprintf(path, sizeof path, "%s/%s", scene_folder, name);
  scene_errors[0] = scene_notes[0] = 0;
  scene_error_count = 0;
  scene_status = scene_load(&scene_log, path, &options, &scene);
  return scene;
}

/* Loads a scene from its text, written as printf does. */
static inline struct cdl_Scene *__attribute__((format(printf, 1, 2)))
scene_from(const char *format, ...) {
  static char text[1 << 18];
  va_list args;
  va_start(args, format);
  int length = vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (length < 0 || length >= (int)sizeof text) abort();
  scene_write("scene.gltf", text, (size_t)length);
  return scene_open("scene.gltf", -1);
}

/* A data URI for a buffer; one of a few static texts. */
static inline const char *scene_data(const void *data, size_t size) {
  static char texts[4][65536];
  static int next;
  char *text = texts[next++ & 3];
  int n = sprintf(text, "data:application/octet-stream;base64,");
  if (BASE64_ENCODE_RAW_LENGTH(size) + (size_t)n + 1 > sizeof texts[0]) abort();
  base64_encode_raw(text + n, size, data);
  text[(size_t)n + BASE64_ENCODE_RAW_LENGTH(size)] = 0;
  return text;
}

#define SCENE_PIXEL                                                                                \
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVQYV2P4z/"           \
  "AfAAQAAf+I0P3MAAAAAElFTkSuQmCC"

/* A scene that holds one material, with the extensions that it uses, an image of one pixel and two
 * textures of it. */
static inline struct cdl_Scene *material_scene(const char *used, const char *material) {
  struct cdl_Scene *scene =
      scene_from("{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[%s],\"materials\":[{%s}],"
                 "\"images\":[{\"uri\":\"" SCENE_PIXEL "\"}],\"samplers\":[{\"wrapS\":33071,"
                 "\"wrapT\":33648,\"magFilter\":9728}],\"textures\":[{\"source\":0},"
                 "{\"source\":0,\"sampler\":0}]}",
                 used, material);
  if (!scene) fputs(scene_errors, stderr);
  return scene;
}

#endif
