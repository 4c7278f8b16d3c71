/* Kernel sources: flattening against hand-written results, and the tree's hash. No OpenCL device.
 */
#include "core/log.h"
#include "device/device.h"
#include "device/program.h"
#include "device/source.h"
#include "device/internal.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char message[2048];

static void keep_message(void *user, cdl_LogLevel level, const char *text) {
  (void)user, (void)level;
  snprintf(message, sizeof message, "%s", text);
}

static const cdl_Log test_log = {keep_message, NULL};

static char folder[64];

static void put(const char *path, const char *text) {
  char full[256];
  snprintf(full, sizeof full, "%s/%s", folder, path);
  FILE *file = fopen(full, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static int make_folder(void **state) {
  (void)state;
  char sub[80];
  strcpy(folder, "/tmp/candela-source-XXXXXX");
  if (!mkdtemp(folder)) return -1;
  snprintf(sub, sizeof sub, "%s/lib", folder);
  mkdir(sub, 0700);
  return setenv("CANDELA_KERNELS", folder, 1);
}

static int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  unsetenv("CANDELA_KERNELS");
  return system(command);
}

static void flattens_nested_includes(void **state) {
  (void)state;
  char *text;
  put("lib/inner.h", "#ifndef INNER\n#define INNER\nint inner;\n#endif\n");
  put("lib/outer.h",
      "#ifndef OUTER\n#define OUTER\n#include \"lib/inner.h\"\nint outer;\n#endif\n");
  put("a.cl", "#include \"lib/inner.h\"\n#include <system.h>\n#include \"lib/outer.h\"\nint a;\n");
  assert_int_equal(source_flatten(&test_log, "a.cl", &text), CDL_OK);
  assert_string_equal(text, "#line 1 \"a.cl\"\n"
                            "#line 1 \"lib/inner.h\"\n#ifndef INNER\n#define INNER\nint inner;\n"
                            "#endif\n#line 2 \"a.cl\"\n"
                            "#include <system.h>\n"
                            "#line 1 \"lib/outer.h\"\n#ifndef OUTER\n#define OUTER\n\nint outer;\n"
                            "#endif\n#line 4 \"a.cl\"\nint a;\n");
  free(text);
}

static void survives_cycles(void **state) {
  (void)state;
  char *text;
  put("lib/x.h", "#ifndef X\n#define X\n#include \"lib/y.h\"\nint x;\n#endif\n");
  put("lib/y.h", "#include \"lib/x.h\"\nint y;\n");
  put("b.cl", "#include \"lib/y.h\"\nint b;\n");
  assert_int_equal(source_flatten(&test_log, "b.cl", &text), CDL_OK);
  assert_non_null(strstr(text, "int x;"));
  assert_non_null(strstr(text, "int y;"));
  assert_null(strstr(strstr(text, "int x;") + 1, "int x;"));
  free(text);
}

static void repeats_what_a_condition_may_hide(void **state) {
  (void)state;
  char *text;
  put("lib/h.h", "#ifndef H\n#define H\nint h;\n#endif\n");
  put("c.cl", "#ifdef NEVER\n#include \"lib/h.h\"\n#endif\n/*\n#include \"no.h\"\n*/\n"
              "#include \"lib/h.h\"\n");
  assert_int_equal(source_flatten(&test_log, "c.cl", &text), CDL_OK);
  char *first = strstr(text, "int h;");
  assert_non_null(first);
  assert_non_null(strstr(first + 1, "int h;"));
  free(text);
}

static void names_both_files_of_a_missing_include(void **state) {
  (void)state;
  char *text;
  put("lib/asks.h", "\n#include \"lib/gone.h\"\n");
  put("d.cl", "#include \"lib/asks.h\"\n");
  assert_int_equal(source_flatten(&test_log, "d.cl", &text), CDL_BAD_INPUT);
  assert_null(text);
  assert_non_null(strstr(message, "lib/asks.h:2"));
  assert_non_null(strstr(message, "lib/gone.h"));
  put("e.cl", "#include \"../secret\"\n");
  assert_int_equal(source_flatten(&test_log, "e.cl", &text), CDL_BAD_INPUT);
  assert_int_equal(source_flatten(&test_log, "absent.cl", &text), CDL_BAD_INPUT);
  assert_non_null(strstr(message, "absent.cl"));
}

static void flattens_every_kernel(void **state) {
  (void)state;
  char *text;
  unsetenv("CANDELA_KERNELS");
  for (int i = 0; i < CDL_KERNEL_COUNT; i++) {
    assert_int_equal(source_flatten(&test_log, kernel_rows[i].file, &text), CDL_OK);
    assert_null(strstr(text, "#include \""));
    free(text);
  }
  setenv("CANDELA_KERNELS", folder, 1);
}

static void hashes_the_tree(void **state) {
  (void)state;
  char before[CDL_SHA256_HEX], again[CDL_SHA256_HEX], after[CDL_SHA256_HEX];
  put("lib/z.h", "int z;\n");
  assert_int_equal(source_hash(&test_log, before), CDL_OK);
  assert_int_equal(source_hash(&test_log, again), CDL_OK);
  assert_string_equal(before, again);
  put("lib/z.h", "int z ;\n");
  assert_int_equal(source_hash(&test_log, after), CDL_OK);
  assert_string_not_equal(before, after);
  assert_int_equal(strlen(after), 64);
}

/* The files on disk and the embedded ones are the same tree. */
static void embeds_the_tree(void **state) {
  (void)state;
  char embedded[CDL_SHA256_HEX], disk[CDL_SHA256_HEX];
  struct stat info;
  if (stat("kernels", &info)) skip();
  setenv("CANDELA_KERNELS", "kernels", 1);
  assert_int_equal(source_hash(&test_log, disk), CDL_OK);
  unsetenv("CANDELA_KERNELS");
  assert_int_equal(source_hash(&test_log, embedded), CDL_OK);
  setenv("CANDELA_KERNELS", folder, 1);
  assert_string_equal(embedded, disk);
}

static void names_errors(void **state) {
  (void)state;
  assert_string_equal(cl_error_name(0), "CL_SUCCESS");
  assert_string_equal(cl_error_name(CL_MEM_OBJECT_ALLOCATION_FAILURE),
                      "CL_MEM_OBJECT_ALLOCATION_FAILURE");
  assert_string_equal(cl_error_name(CL_INVALID_BUFFER_SIZE), "CL_INVALID_BUFFER_SIZE");
  assert_string_equal(cl_error_name(CL_INVALID_KERNEL_ARGS), "CL_INVALID_KERNEL_ARGS");
  assert_string_equal(cl_error_name(CL_INVALID_DEVICE_PARTITION_COUNT),
                      "CL_INVALID_DEVICE_PARTITION_COUNT");
  assert_string_equal(cl_error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
  assert_string_equal(cl_error_name(-12345), "OpenCL error");
}

static cdl_DeviceInfo entry(int index, const char *platform, const char *name, cl_device_type type,
                            int usable, cdl_Exactness exact) {
  cdl_DeviceInfo info = {.index = index, .type = type, .usable = usable, .exact = exact};
  snprintf(info.platform, sizeof info.platform, "%s", platform);
  snprintf(info.name, sizeof info.name, "%s", name);
  snprintf(info.unusable, sizeof info.unusable, "%s", usable ? "" : "because of a test");
  return info;
}

static void selects_devices(void **state) {
  (void)state;
  cdl_DeviceInfo list[] = {
      entry(-1, "rusticl", "", 0, 0, CDL_EXACT_NO),
      entry(0, "Clover", "llvmpipe", CL_DEVICE_TYPE_CPU, 0, CDL_EXACT_NO),
      entry(1, "Portable Computing Language", "pthread-x", CL_DEVICE_TYPE_CPU, 1,
            CDL_EXACT_REPORTED),
      entry(2, "Loose", "GPU One", CL_DEVICE_TYPE_GPU, 1, CDL_EXACT_UNKNOWN),
      entry(3, "Right", "GPU Two", CL_DEVICE_TYPE_GPU, 1, CDL_EXACT_REPORTED),
  };
  size_t chosen = 99;
  assert_int_equal(device_select(&test_log, list, 5, NULL, &chosen), CDL_OK);
  assert_int_equal(chosen, 4);
  assert_int_equal(device_select(&test_log, list, 4, "", &chosen), CDL_OK);
  assert_int_equal(chosen, 2);
  assert_int_equal(device_select(&test_log, list, 5, "1", &chosen), CDL_OK);
  assert_int_equal(chosen, 2);
  assert_int_equal(device_select(&test_log, list, 5, "gpu", &chosen), CDL_OK);
  assert_int_equal(chosen, 3);
  assert_int_equal(device_select(&test_log, list, 5, "PORTABLE", &chosen), CDL_OK);
  assert_int_equal(chosen, 2);
  assert_int_equal(device_select(&test_log, list, 5, "clover", &chosen), CDL_USAGE);
  assert_non_null(strstr(message, "because of a test"));
  assert_int_equal(device_select(&test_log, list, 5, "7", &chosen), CDL_USAGE);
  assert_int_equal(device_select(&test_log, list, 5, "absent", &chosen), CDL_USAGE);
  assert_int_equal(device_select(&test_log, list, 2, NULL, &chosen), CDL_DEVICE);
  list[4].type |= CL_DEVICE_TYPE_CPU; /* a simulator is never the default */
  assert_int_equal(device_select(&test_log, list, 5, NULL, &chosen), CDL_OK);
  assert_int_equal(chosen, 2);
  assert_int_equal(device_select(&test_log, NULL, 0, NULL, &chosen), CDL_DEVICE);
}

/* Every argument of every row found its place: the tables are large enough. */
static void kernel_list_fits(void **state) {
  (void)state;
  for (int i = 0; i < CDL_KERNEL_COUNT; i++) {
    int words = 0;
    for (const char *c = kernel_rows[i].arguments; *c; c++)
      words += *c != ' ' && (c == kernel_rows[i].arguments || c[-1] == ' ');
    assert_int_equal(kernel_arguments(i)->count, words);
    assert_string_equal(kernel_name(i), kernel_rows[i].name);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flattens_nested_includes),
      cmocka_unit_test(survives_cycles),
      cmocka_unit_test(repeats_what_a_condition_may_hide),
      cmocka_unit_test(names_both_files_of_a_missing_include),
      cmocka_unit_test(flattens_every_kernel),
      cmocka_unit_test(hashes_the_tree),
      cmocka_unit_test(embeds_the_tree),
      cmocka_unit_test(names_errors),
      cmocka_unit_test(selects_devices),
      cmocka_unit_test(kernel_list_fits),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
