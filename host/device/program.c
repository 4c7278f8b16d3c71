#define _GNU_SOURCE /* asprintf */
#include "device/program.h"

#include "core/clock.h"
#include "core/log.h"
#include "device/internal.h"
#include "device/source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The compiler's first error, or else its first words, as one line. */
static void first_error(const char *log, char line[512]) {
  const char *error = strstr(log, "error:");
  const char *start = error ? error : log;
  while (start > log && start[-1] != '\n') start--;
  start += strspn(start, " \t\r\n");
  snprintf(line, 512, "%.*s", (int)strcspn(start, "\r\n"), start);
}

static cdl_Status build_failed(const cdl_Device *device, cl_program program, const char *name,
                               cl_int code) {
  size_t size = 0;
  char line[512] = "";
  clGetProgramBuildInfo(program, device->info.id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
  char *log = calloc(1, size + 1);
  if (log && size)
    clGetProgramBuildInfo(program, device->info.id, CL_PROGRAM_BUILD_LOG, size, log, NULL);
  if (log) first_error(log, line);
  free(log);
  return log_fail(device->log, CDL_DEVICE, "kernel %s does not compile on %s: %s (%s)", name,
                  device->info.name, *line ? line : "the compiler says nothing",
                  cl_error_name(code));
}

/* Whether a program's text has the macro that an option -DNAME or -DNAME=VALUE defines. */
static int option_matters(const char *option, size_t length, const char *text) {
  char macro[64];
  if (length < 3 || strncmp(option, "-D", 2) != 0) return 1;
  size_t size = strcspn(option + 2, "= ");
  if (size >= sizeof macro) return 1;
  memcpy(macro, option + 2, size);
  macro[size] = 0;
  return strstr(text, macro) != NULL;
}

/* The device's options, without definitions that the text does not know: scenes that differ in what
 * it does not look at share the compiled kernel. */
static char *scene_options(const cdl_Device *device, const char *text) {
  char *kept = calloc(1, strlen(device->options) + 2);
  size_t used = 0;
  for (const char *at = device->options; kept && *at;) {
    size_t blank = strspn(at, " "), length = strcspn(at + blank, " ");
    at += blank;
    if (length && option_matters(at, length, text)) {
      kept[used++] = ' ';
      memcpy(kept + used, at, length);
      used += length;
    }
    at += length;
  }
  return kept;
}

/* The options of a program; exact arithmetic also needs the pragma in lib/portable.h. `name` is
 * that of its only kernel; NULL: it has several. */
static char *build_options(const cdl_Device *device, const char *name, const char *options,
                           size_t strip, const char *text) {
  char *all = NULL, *scene = scene_options(device, text);
  const char *divide =
      device->info.has_correct_divide ? " -cl-fp32-correctly-rounded-divide-sqrt" : "";
  int length = !scene
                   ? -1
                   : asprintf(&all, "-cl-std=CL1.2 -DCDL_STRIP=%zu%s%s%s %s%s", strip, divide,
                              name ? " -DCDL_KERNEL_NAME=" : "", name ? name : "", options, scene);
  free(scene);
  return length < 0 ? NULL : all;
}

static cdl_Status build_program(cdl_Device *device, const char *text, const char *options,
                                cl_program *program, cl_int *code) {
  *program = clCreateProgramWithSource(device->context, 1, &text, NULL, code);
  if (*code) {
    *program = NULL;
    return device_fail(device, "clCreateProgramWithSource", *code);
  }
  *code = clBuildProgram(*program, 1, &device->info.id, options, NULL, NULL);
  return CDL_OK;
}

static cdl_Status create_kernel(const cdl_Device *device, cl_program program, const char *name,
                                cl_kernel *kernel) {
  cl_int code;
  *kernel = clCreateKernel(program, name, &code);
  if (!code) return CDL_OK;
  *kernel = NULL;
  return log_fail(device->log, CDL_DEVICE, "clCreateKernel of %s on %s: %s (%d)", name,
                  device->info.name, cl_error_name(code), code);
}

/* A program of one kernel, which keeps it. */
static cdl_Status build_text(cdl_Device *device, const char *text, const char *name,
                             const char *options, size_t strip, cl_kernel *kernel) {
  cl_int code;
  cl_program program = NULL;
  char *all = build_options(device, name, options, strip, text);
  if (!all) return log_fail(device->log, CDL_DEVICE, "not enough memory to build %s", name);
  cdl_Status status = build_program(device, text, all, &program, &code);
  if (!status && code) status = build_failed(device, program, name, code);
  if (!status) status = create_kernel(device, program, name, kernel);
  if (program) clReleaseProgram(program);
  free(all);
  return status;
}

cdl_Status device_kernel_from_text(cdl_Device *device, const char *source, const char *name,
                                   const char *options, cl_kernel *kernel) {
  char *text = NULL;
  *kernel = NULL;
  cdl_Status status = source_flatten_text(device->log, name, source, &text);
  if (!status) status = build_text(device, text, name, options ? options : "", 1, kernel);
  free(text);
  return status;
}

/* A wrong count would be noticed late, as CL_INVALID_KERNEL_ARGS at a launch. */
static cdl_Status check_arguments(const cdl_Device *device, cdl_KernelId id, cl_kernel kernel) {
  cl_uint count = 0;
  int listed = kernel_arguments(id)->count;
  cl_int code = clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof count, &count, NULL);
  if (code) return device_fail(device, "clGetKernelInfo", code);
  if ((int)count == listed) return CDL_OK;
  return log_fail(device->log, CDL_DEVICE,
                  "kernel %s (%s) has %u parameters, but device/kernels.def names %d",
                  kernel_name(id), kernel_rows[id].file, count, listed);
}

/* The largest power of two up to CDL_LOCAL_SIZE that the driver takes: ranges are multiples of
 * CDL_LOCAL_SIZE, and a work-group must divide them. */
size_t kernel_local_size(const cdl_Device *device, cl_kernel kernel) {
  size_t required[3] = {0}, most = 0;
  cl_device_id id = device->info.id;
  clGetKernelWorkGroupInfo(kernel, id, CL_KERNEL_COMPILE_WORK_GROUP_SIZE, sizeof required, required,
                           NULL);
  if (required[0]) return required[0];
  clGetKernelWorkGroupInfo(kernel, id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most, &most, NULL);
  size_t size = CDL_LOCAL_SIZE;
  while (most && size > most) size /= 2;
  return size;
}

static size_t row_strip(const cdl_Device *device, int row) {
  return kernel_rows[row].range == CDL_RANGE_STRIPS ? device->strip : 1;
}

/* Rows with the same options are one program: PoCL takes 0.1 s to build a program of any size, and
 * 0.02 s to find out that it is in its cache. */
static int in_group(cdl_KernelId first, int row) {
  return !strcmp(kernel_rows[row].options, kernel_rows[first].options) &&
         kernel_rows[row].range == kernel_rows[first].range;
}

static cdl_KernelId group_of(cdl_KernelId id) {
  int first = 0;
  while (!in_group(id, first)) first++;
  return first;
}

static int group_size(cdl_KernelId first) {
  int size = 0;
  for (int i = first; i < CDL_KERNEL_COUNT; i++) size += in_group(first, i);
  return size;
}

/* All files of a group, each once; NULL if memory is short. */
static char *group_includes(cdl_KernelId first) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  for (int i = first; out && i < CDL_KERNEL_COUNT; i++) {
    int before = first;
    while (strcmp(kernel_rows[before].file, kernel_rows[i].file) || !in_group(first, before))
      if (++before >= i) break;
    if (in_group(first, i) && before >= i) fprintf(out, "#include \"%s\"\n", kernel_rows[i].file);
  }
  if (out) fclose(out);
  return text;
}

/* No failure is reported here: the kernel is then built alone, which names the one at fault and
 * spares the others. */
static cl_program build_group(cdl_Device *device, cdl_KernelId first) {
  cdl_Log silent = {0};
  const cdl_Log *log = device->log;
  cl_program program = NULL;
  cl_int code = 0;
  char *text = NULL, *options = NULL, *includes = group_includes(first);
  device->log = &silent;
  if (includes && !source_flatten_text(&silent, "kernels", includes, &text))
    options =
        build_options(device, NULL, kernel_rows[first].options, row_strip(device, first), text);
  if (options) build_program(device, text, options, &program, &code);
  device->log = log;
  if (program && code) {
    clReleaseProgram(program);
    program = NULL;
  }
  free(text);
  free(includes);
  free(options);
  return program;
}

static cl_program group_program(cdl_Device *device, cdl_KernelId first) {
  if (!device->programs[first] && !device->group_tried[first] && group_size(first) > 1) {
    device->group_tried[first] = 1;
    device->programs[first] = build_group(device, first);
  }
  return device->programs[first];
}

static cdl_Status build_kernel(cdl_Device *device, cdl_KernelId id, cl_kernel *kernel) {
  const KernelRow *row = &kernel_rows[id];
  cl_program program = group_program(device, group_of(id));
  if (program) return create_kernel(device, program, row->name, kernel);
  char *text = NULL;
  cdl_Status status = source_flatten(device->log, row->file, &text);
  if (!status)
    status = build_text(device, text, row->name, row->options, row_strip(device, id), kernel);
  free(text);
  return status;
}

/* A work-group in strips does CDL_LOCAL_SIZE items, neither more nor fewer. */
static cdl_Status local_size(const cdl_Device *device, cdl_KernelId id, cl_kernel kernel,
                             size_t *size) {
  const size_t most = kernel_local_size(device, kernel), strip = row_strip(device, id);
  *size = strip > 1 ? CDL_LOCAL_SIZE / strip : most;
  if (*size <= most) return CDL_OK;
  return log_fail(device->log, CDL_DEVICE,
                  "kernel %s needs work-groups of %zu items, but %s takes at most %zu; choose "
                  "another device with --device",
                  kernel_name(id), *size, device->info.name, most);
}

static cdl_Status build_slot(cdl_Device *device, cdl_KernelId id) {
  KernelSlot *slot = &device->kernels[id];
  cl_kernel kernel = NULL;
  double start = clock_now();
  cdl_Status status = build_kernel(device, id, &kernel);
  if (!status) status = check_arguments(device, id, kernel);
  size_t local = 0;
  if (!status) status = local_size(device, id, kernel, &local);
  double seconds = clock_now() - start;
  device->build_seconds += seconds;
  if (device->observed && device->observer.built)
    device->observer.built(device->observer.user, id, seconds);
  if (status) {
    if (kernel) clReleaseKernel(kernel);
    return status;
  }
  memset(slot, 0, sizeof *slot);
  slot->kernel = kernel;
  slot->strip = row_strip(device, id);
  slot->local_size = local;
  slot->argument_count = kernel_arguments(id)->count;
  return CDL_OK;
}

cdl_Status kernel_slot(cdl_Device *device, cdl_KernelId id, KernelSlot **slot) {
  *slot = &device->kernels[id];
  return (*slot)->kernel ? CDL_OK : build_slot(device, id);
}

cdl_Status device_kernel(cdl_Device *device, cdl_KernelId id, cl_kernel *kernel) {
  KernelSlot *slot;
  cdl_Status status = kernel_slot(device, id, &slot);
  *kernel = slot->kernel;
  return status;
}

cdl_Status device_build(cdl_Device *device, const cdl_KernelId *ids, size_t count,
                        cdl_BuildProgress progress, void *user) {
  for (size_t i = 0; i < count; i++) {
    KernelSlot *slot;
    if (progress) progress(user, kernel_name(ids[i]), i, count);
    cdl_Status status = kernel_slot(device, ids[i], &slot);
    if (status) return status;
  }
  return CDL_OK;
}

void kernel_slots_free(cdl_Device *device) {
  for (int i = 0; i < CDL_KERNEL_COUNT; i++) {
    if (device->kernels[i].kernel) clReleaseKernel(device->kernels[i].kernel);
    if (device->programs[i]) clReleaseProgram(device->programs[i]);
  }
  memset(device->kernels, 0, sizeof device->kernels);
  memset(device->programs, 0, sizeof device->programs);
  memset(device->group_tried, 0, sizeof device->group_tried);
}

cdl_Status device_set_options(cdl_Device *device, const char *options) {
  if (!options) options = "";
  if (!strcmp(options, device->options)) return CDL_OK;
  char *copy = strdup(options);
  if (!copy) return log_fail(device->log, CDL_DEVICE, "not enough memory for build options");
  cdl_Status status = device_finish(device);
  kernel_slots_free(device);
  free(device->options);
  device->options = copy;
  return status;
}
