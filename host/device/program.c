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

/* The options of a program; exact arithmetic also needs the pragma in lib/portable.h. */
static char *build_options(const cdl_Device *device, const char *name, const char *options) {
  char *all = NULL;
  int length =
      asprintf(&all, "-cl-std=CL1.2%s -DCDL_KERNEL_NAME=%s %s %s",
               device->info.has_correct_divide ? " -cl-fp32-correctly-rounded-divide-sqrt" : "",
               name, options, device->options);
  return length < 0 ? NULL : all;
}

static cdl_Status build_text(cdl_Device *device, const char *text, const char *name,
                             const char *options, cl_kernel *kernel) {
  cl_int code;
  cl_program program = NULL;
  cdl_Status status = CDL_OK;
  char *all = build_options(device, name, options);
  if (!all) return log_fail(device->log, CDL_DEVICE, "not enough memory to build %s", name);
  program = clCreateProgramWithSource(device->context, 1, &text, NULL, &code);
  if (code) {
    status = device_fail(device, "clCreateProgramWithSource", code);
    goto done;
  }
  code = clBuildProgram(program, 1, &device->info.id, all, NULL, NULL);
  if (code) {
    status = build_failed(device, program, name, code);
    goto done;
  }
  *kernel = clCreateKernel(program, name, &code);
  if (code) {
    *kernel = NULL;
    status = log_fail(device->log, CDL_DEVICE, "clCreateKernel of %s on %s: %s (%d)", name,
                      device->info.name, cl_error_name(code), code);
  }
done:
  if (program) clReleaseProgram(program); /* the kernel keeps it */
  free(all);
  return status;
}

cdl_Status device_kernel_from_text(cdl_Device *device, const char *source, const char *name,
                                   const char *options, cl_kernel *kernel) {
  char *text = NULL;
  *kernel = NULL;
  cdl_Status status = source_flatten_text(device->log, name, source, &text);
  if (!status) status = build_text(device, text, name, options ? options : "", kernel);
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

size_t kernel_local_size(const cdl_Device *device, cl_kernel kernel) {
  size_t required[3] = {0}, most = 0;
  cl_device_id id = device->info.id;
  clGetKernelWorkGroupInfo(kernel, id, CL_KERNEL_COMPILE_WORK_GROUP_SIZE, sizeof required, required,
                           NULL);
  if (required[0]) return required[0];
  clGetKernelWorkGroupInfo(kernel, id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most, &most, NULL);
  return most && most < CDL_LOCAL_SIZE ? most : CDL_LOCAL_SIZE;
}

static cdl_Status build_slot(cdl_Device *device, cdl_KernelId id) {
  const KernelRow *row = &kernel_rows[id];
  KernelSlot *slot = &device->kernels[id];
  char *text = NULL;
  cl_kernel kernel = NULL;
  double start = clock_now();
  cdl_Status status = source_flatten(device->log, row->file, &text);
  if (!status) status = build_text(device, text, row->name, row->options, &kernel);
  if (!status) status = check_arguments(device, id, kernel);
  free(text);
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
  slot->local_size = kernel_local_size(device, kernel);
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
  for (int i = 0; i < CDL_KERNEL_COUNT; i++)
    if (device->kernels[i].kernel) clReleaseKernel(device->kernels[i].kernel);
  memset(device->kernels, 0, sizeof device->kernels);
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
