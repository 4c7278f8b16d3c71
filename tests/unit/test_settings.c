/* What the public interface refuses before a scene is looked at. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "candela.h"

static char message[2048];

static void keep_message(void *user, cdl_LogLevel level, const char *text) {
  (void)user, (void)level;
  snprintf(message, sizeof message, "%s", text);
}
static const cdl_Log test_log = {keep_message, NULL};

static void assert_size(uint32_t width, uint32_t height, cdl_Status status) {
  cdl_Settings settings;
  cdl_settings_default(&settings);
  settings.width = width;
  settings.height = height;
  assert_int_equal(cdl_settings_check(&test_log, &settings), status);
  if (status) assert_non_null(strstr(message, "--size"));
}

static void limits_the_size(void **state) {
  (void)state;
  assert_size(1280, 0, CDL_OK);
  assert_size(65536, 32768, CDL_OK);
  assert_size(65536, 32769, CDL_USAGE);
  assert_size(65537, 1, CDL_USAGE);
  assert_size(0, 65537, CDL_USAGE);
  assert_size(0, 0, CDL_USAGE);
}

static void limits_the_samples(void **state) {
  (void)state;
  cdl_Settings settings;
  cdl_settings_default(&settings);
  settings.samples = 1u << 24;
  assert_int_equal(cdl_settings_check(&test_log, &settings), CDL_OK);
  settings.samples++;
  assert_int_equal(cdl_settings_check(&test_log, &settings), CDL_USAGE);
  assert_non_null(strstr(message, "--spp: 16777217 is more than 16777216"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(limits_the_size),
      cmocka_unit_test(limits_the_samples),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
