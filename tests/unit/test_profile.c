/* Profiles of launches whose durations are known. */
#include "profile/profile.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Known durations in, their order statistics out; the first launch stays apart. */
static void profile_orders_durations(void **state) {
  (void)state;
  static const char *const names[] = {"one", "two", "never"};
  cdl_Profile *profile = profile_create(names, 3);
  cdl_KernelStats stats;
  assert_non_null(profile);
  for (int i = 0; i < 1001; i++) {
    cdl_LaunchRecord launch = {.kernel = 0, .items = 10, .seconds = 1e-3 * ((i * 7) % 1000 + 1)};
    if (i == 0) launch.seconds = 5, launch.compile_seconds = 2, launch.first = 1;
    profile_launch(profile, &launch);
  }
  profile_stats(profile, 0, &stats);
  assert_int_equal(stats.launches, 1001);
  assert_int_equal(stats.items, 10010);
  assert_true(fabs(stats.first_s - 7) < 1e-12);
  assert_true(fabs(stats.min_s - 0.001) < 1e-12);
  assert_true(fabs(stats.max_s - 1) < 1e-12);
  assert_true(fabs(stats.median_s - 0.5005) < 1e-12);
  assert_true(fabs(stats.total_s - (5 + 500.5)) < 1e-9);
  assert_true(fabs(profile_rest(profile).compile_s - 2) < 1e-12);
  profile_launch(profile, &(cdl_LaunchRecord){.kernel = 1, .seconds = 3, .first = 1});
  profile_stats(profile, 1, &stats);
  assert_true(stats.min_s == 3 && stats.median_s == 3 && stats.max_s == 3 && stats.first_s == 3);
  profile_rays(profile, 1, 6000000);
  json_t *rows = profile_json(profile);
  assert_int_equal(json_array_size(rows), 2);
  json_t *two = json_array_get(rows, 1);
  assert_string_equal(json_string_value(json_object_get(two, "name")), "two");
  assert_true(fabs(json_real_value(json_object_get(two, "mrays_per_s")) - 2) < 1e-12);
  json_decref(rows);
  profile_free(profile);
}

/* Parts of the table add up to the wall time. */
static void table_names_the_rest(void **state) {
  (void)state;
  static const char *const names[] = {"kernel_a"};
  cdl_Profile *profile = profile_create(names, 1);
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  profile_launch(profile, &(cdl_LaunchRecord){.seconds = 4, .items = 5, .first = 1});
  profile_compile(profile, 3);
  profile_transfer(profile, 100, 2);
  profile_table(out, profile, 10);
  fclose(out);
  assert_non_null(strstr(text, "kernel_a"));
  const char *host = strstr(text, "\nhost");
  assert_non_null(host);
  double host_ms = 0, host_share = 0;
  assert_int_equal(sscanf(host, " host %lf %lf", &host_ms, &host_share), 2);
  assert_true(fabs(host_ms - 1000) < 0.01 && fabs(host_share - 10) < 0.01);
  free(text);
  profile_free(profile);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(profile_orders_durations),
      cmocka_unit_test(table_names_the_rest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
