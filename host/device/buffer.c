#include "device/buffer.h"

#include "core/clock.h"
#include "core/log.h"
#include "device/internal.h"

#include <stdio.h>
#include <string.h>

enum { DUMMY_SIZE = 16 };

static void human_size(uint64_t bytes, char text[32]) {
  static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB"};
  double value = bytes;
  int unit = 0;
  for (; value >= 999.5 && unit < 4; unit++) value /= 1000;
  snprintf(text, 32, unit && value < 99.5 ? "%.1f %s" : "%.0f %s", value, units[unit]);
}

static cdl_Status buffer_fail(const cdl_Buffer *buffer, const char *call, cl_int code) {
  char size[32];
  human_size(buffer->size, size);
  return log_fail(buffer->device->log, CDL_DEVICE, "%s of '%s' (%s) on %s: %s (%d)", call,
                  buffer->name, size, buffer->device->info.name, cl_error_name(code), code);
}

static cdl_Status allocation_fail(const cdl_Buffer *buffer, const char *why) {
  char size[32], held[32];
  human_size(buffer->size, size);
  human_size(buffer->device->allocated, held);
  return log_fail(buffer->device->log, CDL_DEVICE,
                  "%s allocating %s for '%s' on %s, where %s are in use: render on a device with "
                  "more memory, or make the scene or the image smaller",
                  why, size, buffer->name, buffer->device->info.name, held);
}

/* Some drivers accept what they cannot hold and die later, so their own limits are checked first.
 */
static cdl_Status check_limits(const cdl_Buffer *buffer) {
  const cdl_DeviceInfo *info = &buffer->device->info;
  char limit[32], why[96];
  if (info->max_alloc && buffer->size > info->max_alloc) {
    human_size(info->max_alloc, limit);
    snprintf(why, sizeof why, "the limit of %s for one buffer is exceeded", limit);
    return allocation_fail(buffer, why);
  }
  if (info->global_mem && buffer->device->allocated + buffer->size > info->global_mem) {
    human_size(info->global_mem, limit);
    snprintf(why, sizeof why, "the device's %s of memory are exceeded", limit);
    return allocation_fail(buffer, why);
  }
  return CDL_OK;
}

static size_t held_size(const cdl_Buffer *buffer) {
  return buffer->size ? buffer->size : DUMMY_SIZE;
}

static cdl_Status create(cdl_Device *device, const char *name, size_t size, void *data,
                         cl_mem_flags flags, cdl_Buffer *buffer) {
  static const unsigned char zeros[DUMMY_SIZE];
  *buffer = (cdl_Buffer){.size = size, .name = name, .device = device};
  cdl_Status status = check_limits(buffer);
  if (status) return status;
  if (!size) {
    data = (void *)zeros;
    flags = CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR;
  }
  cl_int code;
  buffer->mem = clCreateBuffer(device->context, flags, held_size(buffer), data, &code);
  if (code) {
    buffer->mem = NULL;
    return allocation_fail(buffer, cl_error_name(code));
  }
  device->allocated += held_size(buffer);
  if (device->allocated > device->peak_allocated) device->peak_allocated = device->allocated;
  return CDL_OK;
}

static int is_cpu(const cdl_Device *device) {
  return device->info.unified_memory && (device->info.type & CL_DEVICE_TYPE_CPU);
}

cdl_Status buffer_create(cdl_Device *device, const char *name, size_t size, const void *data,
                         cdl_Buffer *buffer) {
  cl_mem_flags flags = CL_MEM_READ_WRITE;
  if (is_cpu(device)) flags |= CL_MEM_ALLOC_HOST_PTR;
  if (data) flags |= CL_MEM_COPY_HOST_PTR;
  return create(device, name, size, (void *)data, flags, buffer);
}

cdl_Status buffer_wrap(cdl_Device *device, const char *name, size_t size, void *data,
                       cdl_Buffer *buffer) {
  cl_mem_flags how = is_cpu(device) ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
  return create(device, name, size, data, CL_MEM_READ_WRITE | how, buffer);
}

/* A later buffer may get the same handle, and a kernel must not take it for the one it has set. */
static void forget_arguments(cdl_Device *device, cl_mem mem) {
  for (int i = 0; i < CDL_KERNEL_COUNT; i++)
    for (int j = 0; j < device->kernels[i].argument_count; j++)
      if (device->kernels[i].bound[j] == mem) device->kernels[i].bound[j] = NULL;
}

void buffer_free(cdl_Buffer *buffer) {
  if (buffer->mem) {
    forget_arguments(buffer->device, buffer->mem);
    buffer->device->allocated -= held_size(buffer);
    clReleaseMemObject(buffer->mem);
  }
  memset(buffer, 0, sizeof *buffer);
}

static cdl_Status check_range(const cdl_Buffer *buffer, const char *call, size_t offset,
                              size_t size) {
  if (offset <= buffer->size && size <= buffer->size - offset) return CDL_OK;
  return log_fail(buffer->device->log, CDL_DEVICE,
                  "%s of '%s': bytes %zu to %zu of %zu lie outside", call, buffer->name, offset,
                  offset + size, buffer->size);
}

/* Starts the clock of a blocking copy; an observer gets the copy alone, without what it waits for.
 */
static cl_event *copy_event(const cdl_Buffer *buffer, cl_event *event) {
  *event = NULL;
  return buffer->device->observed ? event : NULL;
}

cdl_Status buffer_write(cdl_Buffer *buffer, size_t offset, size_t size, const void *data) {
  cl_event event;
  cdl_Status status = check_range(buffer, "buffer_write", offset, size);
  if (status || !size) return status;
  cl_event *ask = copy_event(buffer, &event);
  double start = clock_now();
  cl_int code = clEnqueueWriteBuffer(buffer->device->queue, buffer->mem, CL_TRUE, offset, size,
                                     data, 0, NULL, ask);
  if (code) return buffer_fail(buffer, "clEnqueueWriteBuffer", code);
  copy_observe(buffer->device, event, size, clock_now() - start);
  return CDL_OK;
}

cdl_Status buffer_read(const cdl_Buffer *buffer, size_t offset, size_t size, void *data) {
  cl_event event;
  cdl_Status status = check_range(buffer, "buffer_read", offset, size);
  if (status || !size) return status;
  cl_event *ask = copy_event(buffer, &event);
  double start = clock_now();
  cl_int code = clEnqueueReadBuffer(buffer->device->queue, buffer->mem, CL_TRUE, offset, size, data,
                                    0, NULL, ask);
  if (code) return buffer_fail(buffer, "clEnqueueReadBuffer", code);
  copy_observe(buffer->device, event, size, clock_now() - start);
  return CDL_OK;
}

cdl_Status buffer_fill(cdl_Buffer *buffer, size_t offset, size_t size, uint32_t word) {
  cl_event event;
  cdl_Status status = check_range(buffer, "buffer_fill", offset, size);
  if (status || !size) return status;
  cl_event *ask = copy_event(buffer, &event);
  cl_int code = clEnqueueFillBuffer(buffer->device->queue, buffer->mem, &word, sizeof word, offset,
                                    size, 0, NULL, ask);
  if (code) return buffer_fail(buffer, "clEnqueueFillBuffer", code);
  return ask ? pending_add(buffer->device, event, CDL_KERNEL_COUNT, size) : CDL_OK;
}

cdl_Status buffer_map(const cdl_Buffer *buffer, cl_map_flags flags, size_t offset, size_t size,
                      void **data) {
  *data = NULL;
  cdl_Status status = check_range(buffer, "buffer_map", offset, size);
  if (status) return status;
  cl_int code;
  if (!size) offset = 0, size = held_size(buffer); /* a map of nothing is an error to OpenCL */
  *data = clEnqueueMapBuffer(buffer->device->queue, buffer->mem, CL_TRUE, flags, offset, size, 0,
                             NULL, NULL, &code);
  return code ? buffer_fail(buffer, "clEnqueueMapBuffer", code) : CDL_OK;
}

cdl_Status buffer_unmap(const cdl_Buffer *buffer, void *data) {
  cl_int code = clEnqueueUnmapMemObject(buffer->device->queue, buffer->mem, data, 0, NULL, NULL);
  return code ? buffer_fail(buffer, "clEnqueueUnmapMemObject", code) : CDL_OK;
}
