/* The device layer: buffers, launches, profile, caches of several processes, and the structs that
 * host and kernels share. $CANDELA_TEST_DEVICE selects a device. */
#include "abi_fields.h" /* the shared structs */
#include "device/queue.h"
#include "profile/watch.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static char message[2048];
static cdl_Device *device;

static void keep_message(void *user, cdl_LogLevel level, const char *text) {
  (void)user;
  if (level == CDL_LOG_ERROR) snprintf(message, sizeof message, "%s", text);
}

static const cdl_Log test_log = {keep_message, NULL};

static cdl_Status open_device(cdl_Device **opened) {
  return device_open(&test_log, getenv("CANDELA_TEST_DEVICE"), opened);
}

/* Runs in a child: builds and runs a kernel with nothing compiled before. */
static int cold_child(void) {
  cdl_Device *own;
  cdl_Buffer out = {0};
  cdl_Bindings bindings = {0};
  uint32_t got[256] = {0};
  if (open_device(&own)) return 10;
  if (buffer_create(own, "probe_index_out", sizeof got, NULL, &out)) return 11;
  bindings_set(&bindings, "probe_index_out", &out);
  if (device_run(own, CDL_KERNEL_probe_index, &bindings, 0, 256)) return 12;
  if (buffer_read(&out, 0, sizeof got, got)) return 13;
  for (uint32_t i = 0; i < 256; i++)
    if (got[i] != i) return 14;
  if (device_measure_exactness(own)) return 15;
  buffer_free(&out);
  device_close(own);
  return 0;
}

/* Before anything else opens a device here: a process that has used OpenCL must not fork. */
static void cold_processes_do_not_disturb_each_other(void **state) {
  (void)state;
  enum { CHILDREN = 4 };
  pid_t children[CHILDREN];
  char cache[] = "/tmp/candela-cache-XXXXXX", command[64];
  char *before = getenv("XDG_CACHE_HOME") ? strdup(getenv("XDG_CACHE_HOME")) : NULL;
  assert_non_null(mkdtemp(cache));
  setenv("XDG_CACHE_HOME", cache, 1);
  unsetenv("POCL_CACHE_DIR");
  for (int i = 0; i < CHILDREN; i++) {
    children[i] = fork();
    if (!children[i]) {
      int failed = cold_child();
      if (failed) fprintf(stderr, "child: %d: %s\n", failed, message);
      _exit(failed);
    }
  }
  for (int i = 0; i < CHILDREN; i++) {
    int status = -1;
    assert_int_equal(waitpid(children[i], &status, 0), children[i]);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
  }
  if (before)
    setenv("XDG_CACHE_HOME", before, 1);
  else
    unsetenv("XDG_CACHE_HOME");
  free(before);
  snprintf(command, sizeof command, "rm -rf '%s'", cache);
  assert_int_equal(system(command), 0);
}

static void opens_a_device(void **state) {
  (void)state;
  cdl_Device *none;
  assert_int_equal(device_open(&test_log, "no such device", &none), CDL_USAGE);
  assert_null(none);
  assert_int_equal(open_device(&device), CDL_OK);
  assert_true(device_info(device)->usable);
  assert_true(strlen(device_info(device)->name) > 0);
  assert_true(device_info(device)->exact != CDL_EXACT_UNKNOWN);
}

static void is_used_by_one(void **state) {
  (void)state;
  assert_int_equal(device_claim(device, &test_log), CDL_OK);
  assert_int_equal(device_claim(device, &test_log), CDL_USAGE);
  assert_non_null(strstr(message, "another session uses this device"));
  device_release(device);
  assert_int_equal(device_claim(device, &test_log), CDL_OK);
  device_release(device);
}

static void measures_exactness(void **state) {
  (void)state;
  cdl_Exactness reported = device_info(device)->exact;
  assert_int_equal(device_measure_exactness(device), CDL_OK);
  if (reported == CDL_EXACT_REPORTED)
    assert_int_equal(device_info(device)->exact, CDL_EXACT_MEASURED);
  print_message("%s: %s\n", device_info(device)->name, device_info(device)->exactness);
}

static void moves_data(void **state) {
  (void)state;
  uint32_t data[100], got[100];
  for (uint32_t i = 0; i < 100; i++) data[i] = 7 * i;
  cdl_Buffer buffer;
  uint64_t before = device_allocated(device);
  assert_int_equal(buffer_create(device, "data", sizeof data, data, &buffer), CDL_OK);
  assert_int_equal(device_allocated(device) - before, sizeof data);
  assert_int_equal(buffer_read(&buffer, 0, sizeof got, got), CDL_OK);
  assert_memory_equal(data, got, sizeof got);
  assert_int_equal(buffer_fill(&buffer, 40, 80, 0xabcdu), CDL_OK);
  data[50] = 1;
  assert_int_equal(buffer_write(&buffer, 200, 4, &data[50]), CDL_OK);
  for (int i = 10; i < 30; i++) data[i] = 0xabcdu;
  uint32_t *mapped;
  assert_int_equal(buffer_map(&buffer, CL_MAP_READ, 0, sizeof data, (void **)&mapped), CDL_OK);
  assert_memory_equal(mapped, data, sizeof data);
  assert_int_equal(buffer_unmap(&buffer, mapped), CDL_OK);
  assert_int_equal(buffer_read(&buffer, 396, 8, got), CDL_DEVICE);
  assert_non_null(strstr(message, "'data'"));
  buffer_free(&buffer);
  buffer_free(&buffer);
  assert_int_equal(device_allocated(device), before);
}

static void wraps_memory(void **state) {
  (void)state;
  _Alignas(64) uint32_t data[64];
  cdl_Buffer buffer;
  uint32_t got[64];
  for (uint32_t i = 0; i < 64; i++) data[i] = i * i;
  assert_int_equal(buffer_wrap(device, "wrapped", sizeof data, data, &buffer), CDL_OK);
  assert_int_equal(buffer_read(&buffer, 0, sizeof got, got), CDL_OK);
  assert_memory_equal(got, data, sizeof got);
  buffer_free(&buffer);
}

static void accepts_empty_buffers(void **state) {
  (void)state;
  cdl_Buffer buffer;
  void *mapped;
  char byte;
  assert_int_equal(buffer_create(device, "empty", 0, NULL, &buffer), CDL_OK);
  assert_non_null(buffer.mem);
  assert_int_equal(buffer.size, 0);
  assert_int_equal(buffer_fill(&buffer, 0, 0, 0), CDL_OK);
  assert_int_equal(buffer_write(&buffer, 0, 0, NULL), CDL_OK);
  assert_int_equal(buffer_map(&buffer, CL_MAP_READ, 0, 0, &mapped), CDL_OK);
  assert_int_equal(buffer_unmap(&buffer, mapped), CDL_OK);
  assert_int_equal(buffer_read(&buffer, 0, 1, &byte), CDL_DEVICE);
  buffer_free(&buffer);
}

static void refuses_what_does_not_fit(void **state) {
  (void)state;
  cdl_Buffer buffer;
  size_t size = device_info(device)->max_alloc + 4096;
  assert_int_equal(buffer_create(device, "triangles", size, NULL, &buffer), CDL_DEVICE);
  assert_non_null(strstr(message, "'triangles'"));
  assert_non_null(strstr(message, device_info(device)->name));
  buffer_free(&buffer);
}

static void runs_with_an_offset(void **state) {
  (void)state;
  uint32_t got[512];
  cdl_Buffer out;
  cdl_Bindings bindings = {0};
  assert_int_equal(device_run(device, CDL_KERNEL_probe_index, &bindings, 0, 64), CDL_DEVICE);
  assert_non_null(strstr(message, "probe_index_out"));
  assert_int_equal(buffer_create(device, "out", sizeof got, NULL, &out), CDL_OK);
  assert_int_equal(buffer_fill(&out, 0, sizeof got, 99999), CDL_OK);
  bindings_set(&bindings, "probe_index_out", &out);
  bindings_set(&bindings, "no kernel knows this", &out);
  assert_int_equal(device_run(device, CDL_KERNEL_probe_index, &bindings, 128, 100), CDL_OK);
  assert_int_equal(device_run(device, CDL_KERNEL_probe_index, &bindings, 0, 0), CDL_OK);
  assert_int_equal(device_finish(device), CDL_OK);
  assert_int_equal(buffer_read(&out, 0, sizeof got, got), CDL_OK);
  for (uint32_t i = 0; i < 512; i++) assert_int_equal(got[i], i >= 128 && i < 256 ? i : 99999);
  buffer_free(&out);
}

/* A new buffer may get the handle of one that was freed. */
static void binds_again_after_a_buffer_was_freed(void **state) {
  (void)state;
  for (int round = 0; round < 20; round++) {
    uint32_t got[64] = {0};
    cdl_Buffer out;
    cdl_Bindings bindings = {0};
    assert_int_equal(buffer_create(device, "out", sizeof got, NULL, &out), CDL_OK);
    bindings_set(&bindings, "probe_index_out", &out);
    assert_int_equal(device_run(device, CDL_KERNEL_probe_index, &bindings, 0, 64), CDL_OK);
    assert_int_equal(buffer_read(&out, 0, sizeof got, got), CDL_OK);
    assert_int_equal(got[63], 63);
    buffer_free(&out);
  }
}

static void reports_what_does_not_compile(void **state) {
  (void)state;
  cl_kernel kernel;
  assert_int_equal(device_kernel_from_text(device, "#include \"lib/vec.h\"\n\nint oops(\n",
                                           "broken", NULL, &kernel),
                   CDL_DEVICE);
  assert_null(kernel);
  assert_non_null(strstr(message, "broken"));
  assert_non_null(strstr(message, device_info(device)->name));
  print_message("%s\n", message);
}

static void rebuilds_with_other_options(void **state) {
  (void)state;
  cl_kernel before, same, after;
  assert_int_equal(device_kernel(device, CDL_KERNEL_probe_index, &before), CDL_OK);
  assert_int_equal(device_set_options(device, NULL), CDL_OK);
  assert_int_equal(device_kernel(device, CDL_KERNEL_probe_index, &same), CDL_OK);
  assert_ptr_equal(before, same);
  assert_int_equal(device_set_options(device, "-DCDL_TEST=1"), CDL_OK);
  double seconds = device_build_seconds(device);
  assert_int_equal(device_kernel(device, CDL_KERNEL_probe_index, &after), CDL_OK);
  assert_true(device_build_seconds(device) > seconds);
  assert_int_equal(device_set_options(device, ""), CDL_OK);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* More launches than events are ever held; their sum cannot exceed what the host saw. */
static void counts_every_launch(void **state) {
  (void)state;
  int interpreted = strstr(device_info(device)->name, "Oclgrind") != NULL;
  int launches = interpreted ? 1100 : 5000, items = interpreted ? 64 : 65536;
  cdl_Buffer out;
  cdl_Bindings bindings = {0};
  cdl_KernelStats stats;
  cdl_Profile *profile = profile_create_for_kernels();
  assert_non_null(profile);
  assert_int_equal(device_set_options(device, "-DCDL_TEST=2"), CDL_OK);
  assert_int_equal(profile_watch(profile, device), CDL_OK);
  assert_int_equal(buffer_create(device, "out", 4 * items, NULL, &out), CDL_OK);
  bindings_set(&bindings, "probe_index_out", &out);
  double start = now();
  for (int i = 0; i < launches; i++)
    assert_int_equal(device_run(device, CDL_KERNEL_probe_index, &bindings, 0, items), CDL_OK);
  assert_int_equal(device_finish(device), CDL_OK);
  double wall = now() - start;
  profile_stats(profile, CDL_KERNEL_probe_index, &stats);
  assert_int_equal(stats.launches, launches);
  assert_int_equal(stats.items, (uint64_t)launches * items);
  assert_true(stats.total_s > 0);
  assert_true(stats.total_s + profile_rest(profile).compile_s <= 1.02 * wall);
  assert_true(stats.min_s <= stats.median_s && stats.median_s <= stats.max_s);
  assert_true(stats.first_s >= stats.min_s);
  assert_true(profile_rest(profile).compile_s > 0);
  assert_int_equal(profile_watch(NULL, device), CDL_OK);
  profile_table(stderr, profile, wall);
  buffer_free(&out);
  profile_free(profile);
  assert_int_equal(device_set_options(device, ""), CDL_OK);
}

typedef struct AbiRow {
  const char *file, *type, *member; /* member NULL: the struct itself */
  uint32_t offset, size;
} AbiRow;

#define CDL_ABI_STRUCT(file, type) {file, #type, NULL, 0, sizeof(type)},
#define CDL_ABI_FIELD(file, type, member)                                                          \
  {file, #type, #member, offsetof(type, member), sizeof(((type *)0)->member)},
static const AbiRow abi_rows[] = {
#include "abi_fields.h"
};
enum { ABI_ROWS = sizeof abi_rows / sizeof abi_rows[0] };

/* A kernel that writes offset and size of every row, by the device's own reckoning. */
static char *abi_probe(void) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  for (int i = 0; i < ABI_ROWS; i++)
    if (!i || strcmp(abi_rows[i].file, abi_rows[i - 1].file))
      fprintf(out, "#include \"%s\"\n", abi_rows[i].file);
  fprintf(out, "__kernel void abi_probe(__global uint *out) {\n");
  for (int i = 0; i < ABI_ROWS; i++) {
    const AbiRow *row = &abi_rows[i];
    if (row->member)
      fprintf(out, "  out[%d] = (uint)((size_t)&s.%s - (size_t)&s); out[%d] = sizeof s.%s;\n",
              2 * i, row->member, 2 * i + 1, row->member);
    else
      fprintf(out, "  %s{ %s s; out[%d] = 0; out[%d] = sizeof s;\n", i ? "}\n  " : "", row->type,
              2 * i, 2 * i + 1);
  }
  fprintf(out, "  }\n}\n");
  fclose(out);
  return text;
}

static void shares_structs_with_the_host(void **state) {
  (void)state;
  static uint32_t got[2 * ABI_ROWS];
  cl_kernel kernel;
  cdl_Buffer out;
  char *text = abi_probe();
  assert_true(ABI_ROWS > 50);
  assert_int_equal(device_kernel_from_text(device, text, "abi_probe", NULL, &kernel), CDL_OK);
  free(text);
  assert_int_equal(buffer_create(device, "abi", sizeof got, NULL, &out), CDL_OK);
  clSetKernelArg(kernel, 0, sizeof out.mem, &out.mem);
  assert_int_equal(device_run_kernel(device, kernel, 0, 1), CDL_OK);
  assert_int_equal(buffer_read(&out, 0, sizeof got, got), CDL_OK);
  for (int i = 0; i < ABI_ROWS; i++) {
    const AbiRow *row = &abi_rows[i];
    if (got[2 * i] == row->offset && got[2 * i + 1] == row->size) continue;
    fail_msg("%s: %s.%s: offset %u size %u on the device, %u and %u on the host", row->file,
             row->type, row->member ? row->member : "", got[2 * i], got[2 * i + 1], row->offset,
             row->size);
  }
  print_message("%d structs and members agree\n", ABI_ROWS);
  buffer_free(&out);
  clReleaseKernel(kernel);
}

static int close_device(void **state) {
  (void)state;
  device_close(device);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cold_processes_do_not_disturb_each_other),
      cmocka_unit_test(opens_a_device),
      cmocka_unit_test(is_used_by_one),
      cmocka_unit_test(measures_exactness),
      cmocka_unit_test(moves_data),
      cmocka_unit_test(wraps_memory),
      cmocka_unit_test(accepts_empty_buffers),
      cmocka_unit_test(refuses_what_does_not_fit),
      cmocka_unit_test(runs_with_an_offset),
      cmocka_unit_test(binds_again_after_a_buffer_was_freed),
      cmocka_unit_test(reports_what_does_not_compile),
      cmocka_unit_test(rebuilds_with_other_options),
      cmocka_unit_test(counts_every_launch),
      cmocka_unit_test(shares_structs_with_the_host),
  };
  return cmocka_run_group_tests(tests, NULL, close_device);
}
