#include "device/queue.h"

#include "core/clock.h"
#include "core/log.h"
#include "device/internal.h"

#include <string.h>

static cdl_Status set_arguments(cdl_Device *device, cdl_KernelId id, KernelSlot *slot,
                                const cdl_Bindings *bindings) {
  const KernelArguments *arguments = kernel_arguments(id);
  for (int i = 0; i < arguments->count; i++) {
    cl_mem mem = bindings->mem[arguments->slot[i]];
    if (mem && mem == slot->bound[i]) continue;
    const char *name = binding_name(arguments->slot[i]);
    if (!mem)
      return log_fail(device->log, CDL_DEVICE, "kernel %s: no buffer is bound as '%s'",
                      kernel_name(id), name);
    cl_int code = clSetKernelArg(slot->kernel, i, sizeof mem, &mem);
    if (code)
      return log_fail(device->log, CDL_DEVICE, "clSetKernelArg of %s, '%s', on %s: %s (%d)",
                      kernel_name(id), name, device->info.name, cl_error_name(code), code);
    slot->bound[i] = mem;
  }
  return CDL_OK;
}

static cl_int enqueue(cdl_Device *device, cl_kernel kernel, size_t local, size_t offset,
                      size_t count, cl_event *event) {
  size_t global = (count + local - 1) / local * local;
  return clEnqueueNDRangeKernel(device->queue, kernel, 1, offset ? &offset : NULL, &global, &local,
                                0, NULL, event);
}

/* PoCL compiles apart for ranges that start at 0 and for those below 2^16. */
static int launch_variant(size_t offset, size_t count) {
  return (offset != 0) + 2 * (count < 65536);
}

static cdl_Status launch_fail(const cdl_Device *device, cdl_KernelId id, cl_int code) {
  return log_fail(device->log, CDL_DEVICE, "clEnqueueNDRangeKernel of %s on %s: %s (%d)",
                  kernel_name(id), device->info.name, cl_error_name(code), code);
}

/* A launch with an idle device before and after it, timed by the host as well. */
/* A range of items as one of work-items. */
static size_t in_strips(const KernelSlot *slot, size_t items) {
  return (items + slot->strip - 1) / slot->strip;
}

static cdl_Status run_alone(cdl_Device *device, cdl_KernelId id, KernelSlot *slot, size_t offset,
                            size_t count, int first) {
  cl_event event = NULL;
  cdl_Status status = device_finish(device);
  if (status) return status;
  double start = clock_now();
  cl_int code = enqueue(device, slot->kernel, slot->local_size, in_strips(slot, offset),
                        in_strips(slot, count), &event);
  if (code) return launch_fail(device, id, code);
  code = clFinish(device->queue);
  if (code) {
    clReleaseEvent(event);
    return launch_fail(device, id, code);
  }
  return launch_observe(device, event, id, count, clock_now() - start, first);
}

cdl_Status device_run(cdl_Device *device, cdl_KernelId id, const cdl_Bindings *bindings,
                      size_t offset, size_t count) {
  KernelSlot *slot;
  cdl_Status status = kernel_slot(device, id, &slot);
  if (!status) status = set_arguments(device, id, slot, bindings);
  if (status || !count) return status;
  int variant = launch_variant(offset, in_strips(slot, count));
  int first = !slot->launched[variant];
  slot->launched[variant] = 1;
  if (device->observed && (first || device->host_timed))
    return run_alone(device, id, slot, offset, count, first);
  cl_event event = NULL;
  cl_int code = enqueue(device, slot->kernel, slot->local_size, in_strips(slot, offset),
                        in_strips(slot, count), device->observed ? &event : NULL);
  if (code) return launch_fail(device, id, code);
  return event ? pending_add(device, event, id, count) : CDL_OK;
}

cdl_Status device_run_kernel(cdl_Device *device, cl_kernel kernel, size_t offset, size_t count) {
  if (!count) return CDL_OK;
  size_t local = kernel_local_size(device, kernel);
  cl_int code = enqueue(device, kernel, local, offset, count, NULL);
  return code ? device_fail(device, "clEnqueueNDRangeKernel", code) : CDL_OK;
}

cdl_Status device_flush(cdl_Device *device) {
  cl_int code = clFlush(device->queue);
  return code ? device_fail(device, "clFlush", code) : CDL_OK;
}

cdl_Status device_finish(cdl_Device *device) {
  cl_int code = clFinish(device->queue);
  if (code) return device_fail(device, "clFinish", code);
  return launches_collect(device, 1);
}
