/* Names and indices of a scene's things, as the command line has them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scene/choice.h"

static char said[2048];

static void hear(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  (void)level;
  snprintf(said, sizeof said, "%s", message);
}

static const cdl_Log ear = {.write = hear};

static json_t *things(const char *text) {
  json_t *list = json_loads(text, 0, NULL);
  assert_non_null(list);
  return list;
}

static void test_find(void **state) {
  (void)state;
  static const struct {
    const char *wanted;
    uint32_t index;
  } cases[] = {{"run", 0},        {"2", 1},
               {"walk", 2},       {"0", 0},
               {"1", 1},          {"3", 3},
               {"", 3},           {"4", CDL_NONE},
               {"-1", CDL_NONE},  {"+1", CDL_NONE},
               {" 1", CDL_NONE},  {"1 ", CDL_NONE},
               {"1x", CDL_NONE},  {"swim", CDL_NONE},
               {"00", 0},         {"4294967296", CDL_NONE},
               {"RUN", CDL_NONE}, {"18446744073709551617", CDL_NONE}};
  json_t *list = things("[{\"name\":\"run\"},{\"name\":\"2\"},{\"name\":\"walk\"},{}]");
  Choice choice = choice_of_objects("animation", "a.gltf", list);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_int_equal(choice_find(&choice, cases[i].wanted), cases[i].index);
  choice.by_name = 1;
  assert_int_equal(choice_find(&choice, "0"), CDL_NONE);
  assert_int_equal(choice_find(&choice, "2"), 1);
  json_decref(list);
}

static void test_messages(void **state) {
  (void)state;
  uint32_t index;
  json_t *list = things("[{\"name\":\"run\"},{}]"), *none = json_array();
  Choice choice = choice_of_objects("animation", "a.gltf", list);
  assert_int_equal(choice_require(&ear, &choice, "1", &index), CDL_OK);
  assert_int_equal(index, 1);
  assert_int_equal(choice_require(&ear, &choice, "swim", &index), CDL_USAGE);
  assert_string_equal(said, "--animation swim: a.gltf has no such animation; it has 0 \"run\", "
                            "1 \"\"");
  choice.by_name = 1, choice.kind = "variant";
  assert_int_equal(choice_require(&ear, &choice, "1", &index), CDL_USAGE);
  assert_string_equal(said, "--variant 1: a.gltf has no such variant; it has \"run\", \"\"");
  choice = choice_of_objects("animation", "a.gltf", none);
  assert_int_equal(choice_require(&ear, &choice, "0", &index), CDL_USAGE);
  assert_string_equal(said, "--animation 0: a.gltf has no animations");
  json_decref(list);
  json_decref(none);
}

/* More names than fit: the list ends where one would be cut. */
static void test_many(void **state) {
  (void)state;
  uint32_t index;
  json_t *list = json_array();
  for (int i = 0; i < 500; i++) json_array_append_new(list, json_pack("{s:s}", "name", "an é"));
  Choice choice = choice_of_objects("animation", "a.gltf", list);
  assert_int_equal(choice_require(&ear, &choice, "500", &index), CDL_USAGE);
  assert_string_equal(said + strlen(said) - strlen("\"an é\", …"), "\"an é\", …");
  json_decref(list);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_find), cmocka_unit_test(test_messages),
                                     cmocka_unit_test(test_many)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
