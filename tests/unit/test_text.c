/* Strings that are not UTF-8, against what the Unicode Standard calls well-formed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <jansson.h>

#include "core/text.h"

static void replaces_bytes(void **state) {
  (void)state;
  static const char *const cases[][2] = {
      {"", ""},
      {"b\xff"
       "d.gltf",
       "b?d.gltf"},
      {"\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80"},
      {"\xc0\x80", "??"},           /* overlong */
      {"\xed\xa0\x80", "???"},      /* a surrogate */
      {"\xf4\x90\x80\x80", "????"}, /* beyond U+10FFFF */
      {"a\xe2\x82", "a??"},         /* cut by its end */
      {"\xe2\x82z", "??z"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char *text = text_duplicate(cases[i][0]);
    assert_string_equal(text, cases[i][1]);
    free(text);
  }
}

static void cuts_at_characters(void **state) {
  (void)state;
  char text[5];
  text_copy(text, sizeof text, "ab\xe2\x82\xac");
  assert_string_equal(text, "ab");
  text_copy(text, sizeof text,
            "a\xe2\x82\xac"
            "b");
  assert_string_equal(text, "a\xe2\x82\xac");
  text_copy(text, 1, "abc");
  assert_string_equal(text, "");
  text_copy(text, sizeof text, NULL);
  assert_string_equal(text, "");
}

/* The JSON library, which checks UTF-8 by itself, takes every result, and keeps what it took. */
static void json_takes_all(void **state) {
  (void)state;
  srand48(3);
  for (int round = 0; round < 20000; round++) {
    char bytes[9] = {0}, text[9];
    for (int i = 0; i < 8; i++)
      bytes[i] = (char)(lrand48() % 3 ? 0x80 + lrand48() % 0x80 : 1 + lrand48() % 0x7f);
    text_copy(text, sizeof text, bytes);
    json_t *before = json_string(bytes), *after = json_string(text);
    assert_non_null(after);
    if (before) assert_string_equal(text, bytes);
    json_decref(before);
    json_decref(after);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(replaces_bytes),
      cmocka_unit_test(cuts_at_characters),
      cmocka_unit_test(json_takes_all),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
