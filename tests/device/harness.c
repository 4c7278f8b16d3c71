#define _GNU_SOURCE /* nftw, mkdtemp */
#include "harness.h"

#include <stdarg.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PLATFORMS = 16, MAX_INCLUDES = 64, MAX_BUFFERS = 16, LOCAL_SIZE = 64 };

struct Harness {
  cl_device_id device;
  cl_context context;
  cl_command_queue queue;
  cl_program program;
  char name[512];
};

static char cache_folder[256];

static void check(cl_int status, const char *call) {
  if (status != CL_SUCCESS) fail_msg("%s failed with OpenCL error %d", call, (int)status);
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *walk) {
  (void)info;
  (void)type;
  (void)walk;
  return remove(path);
}

static void remove_cache(void) { nftw(cache_folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS); }

void harness_prepare(void) {
  setenv("RUSTICL_ENABLE", "llvmpipe", 0);
  setenv("POCL_WORK_GROUP_METHOD", "loopvec", 0);
  if (getenv("POCL_CACHE_DIR")) return;
  const char *parent = getenv("TMPDIR");
  snprintf(cache_folder, sizeof cache_folder, "%s/candela-test-XXXXXX", parent ? parent : "/tmp");
  if (!mkdtemp(cache_folder)) return;
  setenv("POCL_CACHE_DIR", cache_folder, 1);
  atexit(remove_cache);
}

static int platform_matches(cl_platform_id platform, const char *part) {
  char name[256] = "";
  clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, NULL);
  return !part || strstr(name, part);
}

static cl_device_id find_device(const char *part, cl_device_type type) {
  cl_platform_id platforms[MAX_PLATFORMS];
  cl_uint count = 0;
  if (clGetPlatformIDs(MAX_PLATFORMS, platforms, &count) != CL_SUCCESS) return NULL;
  for (cl_uint i = 0; i < count && i < MAX_PLATFORMS; i++) {
    cl_device_id device;
    if (platform_matches(platforms[i], part) &&
        clGetDeviceIDs(platforms[i], type, 1, &device, NULL) == CL_SUCCESS)
      return device;
  }
  return NULL;
}

static void write_name(Harness *harness) {
  cl_platform_id platform;
  char platform_name[200] = "", device_name[200] = "";
  clGetDeviceInfo(harness->device, CL_DEVICE_PLATFORM, sizeof platform, &platform, NULL);
  clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof platform_name, platform_name, NULL);
  clGetDeviceInfo(harness->device, CL_DEVICE_NAME, sizeof device_name, device_name, NULL);
  snprintf(harness->name, sizeof harness->name, "%s: %s", platform_name, device_name);
}

Harness *harness_open(const char *platform) {
  cl_device_id device = find_device(platform, CL_DEVICE_TYPE_GPU);
  if (!device) device = find_device(platform, CL_DEVICE_TYPE_CPU);
  if (!device) return NULL;
  Harness *harness = calloc(1, sizeof *harness);
  assert_non_null(harness);
  cl_int status;
  harness->device = device;
  harness->context = clCreateContext(NULL, 1, &device, NULL, NULL, &status);
  check(status, "clCreateContext");
  harness->queue = clCreateCommandQueue(harness->context, device, 0, &status);
  check(status, "clCreateCommandQueue");
  write_name(harness);
  return harness;
}

void harness_close(Harness *harness) {
  if (!harness) return;
  if (harness->program) clReleaseProgram(harness->program);
  clReleaseCommandQueue(harness->queue);
  clReleaseContext(harness->context);
  free(harness);
}

const char *harness_name(const Harness *harness) { return harness->name; }

static char *read_file(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s cannot be opened; run the tests from the top folder", path);
  fseek(file, 0, SEEK_END);
  size_t size = (size_t)ftell(file);
  rewind(file);
  char *text = calloc(size + 2, 1);
  assert_non_null(text);
  assert_int_equal(fread(text, 1, size, file), size);
  text[size] = '\n';
  fclose(file);
  return text;
}

/* The text built so far and the files already in it: guards would drop a second copy, but depth
 * must end. */
typedef struct Flat {
  char *text;
  size_t size;
  char seen[MAX_INCLUDES][128];
  int seen_count;
} Flat;

static void flat_append(Flat *flat, const char *text, size_t size) {
  flat->text = realloc(flat->text, flat->size + size + 1);
  assert_non_null(flat->text);
  memcpy(flat->text + flat->size, text, size);
  flat->size += size;
  flat->text[flat->size] = '\0';
}

static int flat_is_new(Flat *flat, const char *name) {
  for (int i = 0; i < flat->seen_count; i++)
    if (strcmp(flat->seen[i], name) == 0) return 0;
  assert_true(flat->seen_count < MAX_INCLUDES);
  snprintf(flat->seen[flat->seen_count++], sizeof flat->seen[0], "%s", name);
  return 1;
}

static void flatten(Flat *flat, const char *source) {
  const char *folder = getenv("CANDELA_KERNELS");
  for (const char *line = source; *line;) {
    const char *newline = strchr(line, '\n');
    size_t length = newline ? (size_t)(newline - line) + 1 : strlen(line);
    char name[128], path[1024];
    if (sscanf(line, "#include \"%127[^\"\n]\"", name) != 1) {
      flat_append(flat, line, length);
    } else if (flat_is_new(flat, name)) {
      snprintf(path, sizeof path, "%s/%s", folder ? folder : "kernels", name);
      char *text = read_file(path);
      flatten(flat, text);
      free(text);
    }
    line += length;
  }
}

static const char *build_options(cl_device_id device) {
  cl_device_fp_config config = 0;
  clGetDeviceInfo(device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof config, &config, NULL);
  return config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT
             ? "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt"
             : "-cl-std=CL1.2";
}

void harness_build(Harness *harness, const char *source) {
  Flat flat = {0};
  flatten(&flat, source);
  if (harness->program) clReleaseProgram(harness->program);
  cl_int status;
  const char *text = flat.text;
  harness->program = clCreateProgramWithSource(harness->context, 1, &text, NULL, &status);
  check(status, "clCreateProgramWithSource");
  const char *options = build_options(harness->device);
  status = clBuildProgram(harness->program, 1, &harness->device, options, NULL, NULL);
  free(flat.text);
  if (status == CL_SUCCESS) return;
  static char log[16384];
  clGetProgramBuildInfo(harness->program, harness->device, CL_PROGRAM_BUILD_LOG, sizeof log - 1,
                        log, NULL);
  fail_msg("clBuildProgram failed with OpenCL error %d:\n%s", (int)status, log);
}

static void launch(Harness *harness, cl_kernel kernel, size_t items) {
  size_t local = LOCAL_SIZE;
  const size_t *size = items % local == 0 ? &local : NULL;
  check(clEnqueueNDRangeKernel(harness->queue, kernel, 1, NULL, &items, size, 0, NULL, NULL),
        "clEnqueueNDRangeKernel");
}

void harness_run(Harness *harness, const char *name, size_t items, const HarnessBuffer *buffers,
                 size_t count) {
  cl_mem memory[MAX_BUFFERS];
  cl_int status;
  assert_true(count <= MAX_BUFFERS);
  cl_kernel kernel = clCreateKernel(harness->program, name, &status);
  check(status, "clCreateKernel");
  for (size_t i = 0; i < count; i++) {
    memory[i] = clCreateBuffer(harness->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                               buffers[i].bytes, buffers[i].data, &status);
    check(status, "clCreateBuffer");
    check(clSetKernelArg(kernel, (cl_uint)i, sizeof memory[i], &memory[i]), "clSetKernelArg");
  }
  launch(harness, kernel, items);
  for (size_t i = 0; i < count; i++) {
    check(clEnqueueReadBuffer(harness->queue, memory[i], CL_TRUE, 0, buffers[i].bytes,
                              buffers[i].data, 0, NULL, NULL),
          "clEnqueueReadBuffer");
    clReleaseMemObject(memory[i]);
  }
  clReleaseKernel(kernel);
}

Harness *harness_open_with(const char *path) {
  static char text[1 << 16];
  Harness *harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  FILE *file = harness ? fopen(path, "rb") : NULL;
  if (!file) {
    harness_close(harness);
    return NULL;
  }
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  harness_build(harness, text);
  return harness;
}
