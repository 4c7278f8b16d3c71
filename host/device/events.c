/* Events, gathered until they are done: timers are read and events released in batches, so that a
 * hundred thousand launches do not hold as many events. */
#include "device/internal.h"

#include "core/log.h"

#include <string.h>

/* START to END; -1 if the driver's answer makes no sense. */
static double event_seconds(cl_event event) {
  cl_ulong start = 0, end = 0;
  if (clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL) ||
      clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL) ||
      end < start)
    return -1;
  return 1e-9 * (end - start);
}

static void tell_launch(cdl_Device *device, const cdl_Launch *launch) {
  if (device->observer.launched) device->observer.launched(device->observer.user, launch);
}

static void tell_transfer(cdl_Device *device, size_t bytes, double seconds) {
  if (device->observer.transferred)
    device->observer.transferred(device->observer.user, bytes, seconds);
}

/* The timers of a driver are stubs if a launch took longer than the host waited for it, or next to
 * nothing while the host waited long: 100 ns against 0.1 ms. */
static int timer_is_stub(double seconds, double host) {
  return seconds < 0 || seconds > 1.05 * host + 1e-4 || (seconds < 1e-7 && host > 1e-4);
}

cdl_Status launch_observe(cdl_Device *device, cl_event event, cdl_KernelId kernel, size_t items,
                          double host, int first) {
  double seconds = event_seconds(event);
  clReleaseEvent(event);
  if (!device->host_timed && timer_is_stub(seconds, host)) {
    device->host_timed = 1;
    log_note(device->log, "%s has no usable timers: kernels are timed by the host, one at a time",
             device->info.name);
  }
  cdl_Launch launch = {.kernel = kernel, .items = items, .first = first};
  launch.host_timed = device->host_timed;
  launch.seconds = device->host_timed ? host : seconds;
  if (first && host > launch.seconds) launch.compile_seconds = host - launch.seconds;
  tell_launch(device, &launch);
  return CDL_OK;
}

void copy_observe(cdl_Device *device, cl_event event, size_t bytes, double host) {
  if (!event) return;
  double seconds = device->host_timed ? host : event_seconds(event);
  clReleaseEvent(event);
  tell_transfer(device, bytes, seconds < 0 ? host : seconds);
}

/* Status of an enqueued command: 1 done, 0 not yet, negative if it failed. */
static cl_int pending_state(const PendingLaunch *pending) {
  cl_int state = CL_QUEUED;
  cl_int code =
      clGetEventInfo(pending->event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, NULL);
  if (code) return code;
  return state == CL_COMPLETE ? 1 : state < 0 ? state : 0;
}

static void pending_done(cdl_Device *device, const PendingLaunch *pending) {
  double seconds = event_seconds(pending->event);
  clReleaseEvent(pending->event);
  if (!device->observed) return;
  if (pending->kernel == CDL_KERNEL_COUNT) {
    tell_transfer(device, pending->items, seconds < 0 ? 0 : seconds);
    return;
  }
  cdl_Launch launch = {.kernel = pending->kernel, .items = pending->items};
  launch.seconds = seconds < 0 ? 0 : seconds;
  launch.host_timed = seconds < 0;
  tell_launch(device, &launch);
}

static cdl_Status pending_failed(cdl_Device *device, const PendingLaunch *pending, cl_int code) {
  const char *name = pending->kernel == CDL_KERNEL_COUNT ? "a fill" : kernel_name(pending->kernel);
  clReleaseEvent(pending->event);
  return log_fail(device->log, CDL_DEVICE, "%s failed while running on %s: %s (%d)", name,
                  device->info.name, cl_error_name(code), code);
}

/* Commands finish in order, so collecting stops at the first that is not done. */
cdl_Status launches_collect(cdl_Device *device, int wait) {
  cdl_Status status = CDL_OK;
  size_t done = 0;
  if (wait && device->pending_count)
    clWaitForEvents(1, &device->pending[device->pending_count - 1].event);
  for (; done < device->pending_count; done++) {
    cl_int state = pending_state(&device->pending[done]);
    if (!state) break;
    if (state > 0)
      pending_done(device, &device->pending[done]);
    else
      status = pending_failed(device, &device->pending[done], state);
  }
  device->pending_count -= done;
  memmove(device->pending, device->pending + done,
          device->pending_count * sizeof device->pending[0]);
  return status;
}

cdl_Status pending_add(cdl_Device *device, cl_event event, cdl_KernelId kernel, size_t items) {
  if (device->pending_count == CDL_PENDING) {
    clReleaseEvent(event);
    return log_fail(device->log, CDL_DEVICE, "%s does not finish what it was given",
                    device->info.name);
  }
  device->pending[device->pending_count++] = (PendingLaunch){event, kernel, items};
  if (device->pending_count < CDL_PENDING) return CDL_OK;
  cdl_Status status = launches_collect(device, 0);
  if (status || device->pending_count <= CDL_PENDING / 2) return status;
  /* The host is far ahead: wait until half of them are done. */
  clWaitForEvents(1, &device->pending[device->pending_count / 2].event);
  return launches_collect(device, 0);
}

cdl_Status device_observe(cdl_Device *device, const cdl_Observer *observer) {
  cdl_Status status = device_finish(device);
  device->observed = observer != NULL;
  device->observer = observer ? *observer : (cdl_Observer){0};
  return status;
}
