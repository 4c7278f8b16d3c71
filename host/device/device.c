#include "device/device.h"

#include "core/log.h"
#include "device/internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

cdl_Status device_fail(const cdl_Device *device, const char *call, cl_int code) {
  return log_fail(device->log, CDL_DEVICE, "%s on %s: %s (%d)", call, device->info.name,
                  cl_error_name(code), code);
}

/* Drivers explain some failures only here; the call that fails reports the failure itself. Oclgrind
 * loses the user pointer. */
static void CL_CALLBACK context_notice(const char *text, const void *data, size_t size,
                                       void *user) {
  (void)data, (void)size;
  const cdl_Device *device = user;
  if (device) log_note(device->log, "%s says: %s", device->info.name, text);
}

static cdl_Status open_queue(cdl_Device *device) {
  const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM,
                                              (cl_context_properties)device->info.platform_id, 0};
  cl_int code;
  device->context = clCreateContext(properties, 1, &device->info.id, context_notice, device, &code);
  if (code) return device_fail(device, "clCreateContext", code);
  device->queue =
      clCreateCommandQueue(device->context, device->info.id, CL_QUEUE_PROFILING_ENABLE, &code);
  return code ? device_fail(device, "clCreateCommandQueue", code) : CDL_OK;
}

/* Where the driver is silent, what it computes decides. */
static cdl_Status settle_exactness(cdl_Device *device) {
  if (device->info.exact != CDL_EXACT_UNKNOWN) return CDL_OK;
  return device_measure_exactness(device);
}

/* Strips are for the compiler of PoCL on CPUs (lib/stage.h); $CANDELA_STRIP, a power of two up to
 * CDL_LOCAL_SIZE, is for those who compare. */
static size_t strip_length(const cdl_DeviceInfo *info) {
  const char *wanted = getenv("CANDELA_STRIP");
  size_t length = wanted ? strtoul(wanted, NULL, 10) : 0;
  if (length && length <= CDL_LOCAL_SIZE && !(length & (length - 1))) return length;
  int pocl = strstr(info->platform, "Portable Computing Language") != NULL;
  return pocl && info->type & CL_DEVICE_TYPE_CPU ? 16 : 1;
}

cdl_Status device_open(const cdl_Log *log, const char *selector, cdl_Device **opened) {
  cdl_DeviceInfo *list = NULL;
  size_t count = 0, chosen = 0;
  cdl_Device *device = NULL;
  *opened = NULL;
  cdl_Status status = device_list(log, &list, &count);
  if (status || (status = device_select(log, list, count, selector, &chosen))) goto done;
  device = calloc(1, sizeof *device);
  if (device) device->options = strdup("");
  if (!device || !device->options) {
    status = log_fail(log, CDL_DEVICE, "not enough memory to open %s", list[chosen].name);
    goto done;
  }
  device->log = log;
  device->info = list[chosen];
  device->strip = strip_length(&device->info);
  device->host_timed = !device->info.timer_ns;
  if ((status = open_queue(device)) || (status = settle_exactness(device))) goto done;
  *opened = device;
done:
  if (status) device_close(device);
  free(list);
  return status;
}

void device_close(cdl_Device *device) {
  if (!device) return;
  if (device->queue) clFinish(device->queue);
  launches_collect(device, 1);
  kernel_slots_free(device);
  if (device->queue) clReleaseCommandQueue(device->queue);
  if (device->context) clReleaseContext(device->context);
  free(device->options);
  free(device);
}

cdl_Status device_claim(cdl_Device *device, const cdl_Log *log) {
  if (!__atomic_exchange_n(&device->claimed, 1, __ATOMIC_ACQUIRE)) return CDL_OK;
  return log_fail(log, CDL_USAGE,
                  "%s: another session uses this device; free that session first, or open the "
                  "device once more",
                  device->info.name);
}

void device_release(cdl_Device *device) { __atomic_store_n(&device->claimed, 0, __ATOMIC_RELEASE); }

const cdl_DeviceInfo *device_info(const cdl_Device *device) { return &device->info; }
cl_context device_context(const cdl_Device *device) { return device->context; }
cl_command_queue device_queue(const cdl_Device *device) { return device->queue; }
const cdl_Log *device_log(const cdl_Device *device) { return device->log; }
uint64_t device_allocated(const cdl_Device *device) { return device->allocated; }
uint64_t device_peak_allocated(const cdl_Device *device) { return device->peak_allocated; }
double device_build_seconds(const cdl_Device *device) { return device->build_seconds; }
