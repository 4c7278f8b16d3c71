/* queue.h: running kernels, in order, and timing them. */
#ifndef CANDELA_DEVICE_QUEUE_H
#define CANDELA_DEVICE_QUEUE_H

#include "device/buffer.h"
#include "device/program.h"

enum { CDL_MAX_BINDINGS = 256, CDL_LOCAL_SIZE = 64 };

/* Which buffer stands behind each name that kernels.def uses. Start from all zeros. */
typedef struct cdl_Bindings {
  cl_mem mem[CDL_MAX_BINDINGS];
} cdl_Bindings;

/* A name that no kernel uses is ignored; one that is missing is reported by device_run. A NULL or
 * all-zero buffer unbinds. */
void bindings_set(cdl_Bindings *bindings, const char *name, const cdl_Buffer *buffer);

/* Enqueues work-items offset … offset + count - 1. The local size is the kernel's own
 * reqd_work_group_size, else CDL_LOCAL_SIZE (less where the device allows less); `count` is rounded
 * up to a multiple, so a kernel clamps its index. Returns before the kernel has run.
 *
 * PoCL compiles at launches: once more for a kernel's first launch with an offset, and once more
 * for the first of 65536 items or more if the launches before it were smaller. So launch the
 * largest range first, and prefer a base in the parameters to an offset. */
cdl_Status device_run(cdl_Device *device, cdl_KernelId id, const cdl_Bindings *bindings,
                      size_t offset, size_t count);

/* The same for a kernel with its arguments already set, such as those of device_kernel_from_text.
 */
cdl_Status device_run_kernel(cdl_Device *device, cl_kernel kernel, size_t offset, size_t count);

/* Sends what is enqueued to the device without waiting. */
cdl_Status device_flush(cdl_Device *device);

/* Waits for everything enqueued. */
cdl_Status device_finish(cdl_Device *device);

/* One finished launch. `seconds` is START to END of its event; `host_timed` says that the driver's
 * timers are stubs and the host's clock, from enqueue to finish, was used. Drivers compile at the
 * first launch of a kernel, again for its first launch with an offset or with a small range:
 * `first` marks these, and `compile_seconds` is what they took beyond `seconds`. */
typedef struct cdl_Launch {
  cdl_KernelId kernel;
  size_t items;
  double seconds;
  double compile_seconds; /* 0 unless `first` */
  int first;
  int host_timed;
} cdl_Launch;

/* Who looks on. Called on the thread that runs kernels, some time after the launch has finished and
 * at the latest in device_finish or device_observe. Members may be NULL. */
typedef struct cdl_Observer {
  void *user;
  void (*launched)(void *user, const cdl_Launch *launch);
  void (*transferred)(void *user, size_t bytes, double seconds); /* host time of a blocking copy */
  void (*built)(void *user, cdl_KernelId kernel, double seconds);
} cdl_Observer;

/* From now on, `observer` (copied; NULL: nobody) is told. Events cost little: they are gathered and
 * released in batches. */
cdl_Status device_observe(cdl_Device *device, const cdl_Observer *observer);

#endif
