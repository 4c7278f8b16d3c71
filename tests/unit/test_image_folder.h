/* test_image_folder.h: a log that remembers, a folder per test and a picture to put there. Included
 * after cmocka.h. */
#ifndef TEST_IMAGE_FOLDER_H
#define TEST_IMAGE_FOLDER_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "candela.h"

#define WIDTH 37
#define HEIGHT 70 /* more than one run of 64 lines */
#define PIXELS (WIDTH * HEIGHT)

static char folder[64];
static char last_message[2048];
static int message_count;

static void keep_message(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  (void)level;
  snprintf(last_message, sizeof last_message, "%s", message);
  message_count++;
}

static const cdl_Log test_log = {keep_message, NULL};

static const char *in_folder(const char *name) {
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static int files_in_folder(void) {
  int count = 0;
  DIR *entries = opendir(folder);
  assert_non_null(entries);
  for (struct dirent *entry; (entry = readdir(entries));)
    count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
  closedir(entries);
  return count;
}

static int setup(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/candela_image_XXXXXX");
  message_count = 0;
  last_message[0] = '\0';
  return mkdtemp(folder) ? 0 : -1;
}

static int teardown(void **state) {
  (void)state;
  DIR *entries = opendir(folder);
  for (struct dirent *entry; entries && (entry = readdir(entries));)
    remove(in_folder(entry->d_name));
  if (entries) closedir(entries);
  return rmdir(folder);
}

/* Smooth, within 0..0.9, different in every channel and pixel. */
static float *make_ramp(void) {
  float *rgb = malloc(PIXELS * 3 * sizeof *rgb);
  assert_non_null(rgb);
  for (int i = 0; i < PIXELS; i++) {
    rgb[3 * i] = 0.9f * (float)(i % WIDTH) / (WIDTH - 1);
    rgb[3 * i + 1] = 0.9f * (float)(i / WIDTH) / (HEIGHT - 1);
    rgb[3 * i + 2] = 0.9f * (float)i / PIXELS;
  }
  return rgb;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

#endif
