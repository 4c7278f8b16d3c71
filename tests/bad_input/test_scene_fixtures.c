/* test_scene_fixtures.c: the Khronos validator's own files get the verdict that it gives them, and
 * one of its codes. There is no exception: what it rejects is refused, even data that a rendering
 * does not need (animations, skins, variants), and what it only warns of loads. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <jansson.h>

#include "bad_child.h"

#define FIXTURES "../shared/badinput/validator"

static int files, wrong;

/* The codes of severity 0 in a report. */
static json_t *error_codes(const char *report) {
  json_t *codes = json_array(), *root = json_load_file(report, 0, NULL);
  const json_t *messages = json_object_get(json_object_get(root, "issues"), "messages");
  for (size_t i = 0; i < json_array_size(messages); i++) {
    const json_t *message = json_array_get(messages, i);
    if (json_integer_value(json_object_get(message, "severity")) == 0)
      json_array_append(codes, json_object_get(message, "code"));
  }
  json_decref(root);
  return codes;
}

static int has_one_of(const char *error, const json_t *codes) {
  for (size_t i = 0; i < json_array_size(codes); i++) {
    char wanted[128];
    snprintf(wanted, sizeof wanted, ": %s: ", json_string_value(json_array_get(codes, i)));
    if (strstr(error, wanted)) return 1;
  }
  return 0;
}

static void check_fixture(const char *path, const char *report) {
  json_t *codes = error_codes(report);
  Outcome outcome = load_in_child(path);
  int bad = json_array_size(codes) > 0;
  int right = bad ? outcome.status == CDL_BAD_INPUT && outcome.errors == 1 &&
                        has_one_of(outcome.error, codes)
                  : outcome.status == CDL_OK && outcome.errors == 0;
  files++;
  wrong += !right;
  if (!right) {
    char *text = json_dumps(codes, 0);
    print_message("%s: status %d, wanted %s: %s\n", path, outcome.status, text, outcome.error);
    free(text);
  }
  json_decref(codes);
}

static void check_folder(const char *folder) {
  struct dirent *entry;
  DIR *dir = opendir(folder);
  if (!dir) return;
  while ((entry = readdir(dir))) {
    char path[1024], report[1100];
    const char *suffix = strrchr(entry->d_name, '.');
    if (entry->d_name[0] == '.') continue;
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    snprintf(report, sizeof report, "%s.report.json", path);
    if (entry->d_type == DT_DIR)
      check_folder(path);
    else if (suffix && access(report, R_OK) == 0)
      check_fixture(path, report);
  }
  closedir(dir);
}

static void test_fixtures(void **state) {
  (void)state;
  if (access(FIXTURES, R_OK) != 0) {
    print_message("skipped: there is no folder " FIXTURES "\n");
    skip();
  }
  check_folder(FIXTURES);
  print_message("%d files, %d wrong\n", files, wrong);
  assert_true(files >= 169);
  assert_int_equal(wrong, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_fixtures)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
