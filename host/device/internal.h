/* internal.h: what a device is made of; private to host/device. */
#ifndef CANDELA_DEVICE_INTERNAL_H
#define CANDELA_DEVICE_INTERNAL_H

#include "device/queue.h"

enum { CDL_MAX_ARGUMENTS = 64, CDL_PENDING = 512 };

/* Drivers compile a kernel again for a global offset and for small ranges, so first launches are
 * told apart by these. */
enum { CDL_VARIANTS = 4 };

typedef struct KernelSlot {
  cl_kernel kernel; /* NULL: not built */
  size_t local_size;
  size_t strip; /* items that a work-item does */
  int argument_count;
  cl_mem bound[CDL_MAX_ARGUMENTS]; /* what is set now; NULL: nothing */
  unsigned char launched[CDL_VARIANTS];
} KernelSlot;

typedef struct PendingLaunch {
  cl_event event;
  cdl_KernelId kernel;
  size_t items;
} PendingLaunch;

struct cdl_Device {
  cdl_DeviceInfo info;
  const cdl_Log *log;
  cl_context context;
  cl_command_queue queue;
  char *options;
  size_t strip; /* items that a work-item of a STRIPS kernel does */
  KernelSlot kernels[CDL_KERNEL_COUNT];
  /* One program per group of rows with the same options, at the group's first row. */
  cl_program programs[CDL_KERNEL_COUNT];
  unsigned char group_tried[CDL_KERNEL_COUNT];
  double build_seconds;
  uint64_t allocated, peak_allocated;
  cdl_Observer observer;
  int claimed; /* by device_claim(); atomic */
  int observed;
  int host_timed; /* timers are stubs */
  PendingLaunch pending[CDL_PENDING];
  size_t pending_count;
};

/* The argument names of a kernel as indices into cdl_Bindings; parsed once per process. */
enum { CDL_RANGE_ITEMS, CDL_RANGE_STRIPS };

typedef struct KernelRow {
  const char *name, *file, *options, *arguments;
  int range; /* CDL_RANGE_* */
} KernelRow;

extern const KernelRow kernel_rows[CDL_KERNEL_COUNT];

typedef struct KernelArguments {
  int count;
  unsigned char slot[CDL_MAX_ARGUMENTS]; /* index into cdl_Bindings */
} KernelArguments;

const KernelArguments *kernel_arguments(cdl_KernelId id);
const char *binding_name(int slot);

/* The kernel's slot, built. */
cdl_Status kernel_slot(cdl_Device *device, cdl_KernelId id, KernelSlot **slot);
void kernel_slots_free(cdl_Device *device);
size_t kernel_local_size(const cdl_Device *device, cl_kernel kernel);

/* Remembers an enqueued command until it is done; `kernel` CDL_KERNEL_COUNT is a fill of `items`
 * bytes. Takes over the event. */
cdl_Status pending_add(cdl_Device *device, cl_event event, cdl_KernelId kernel, size_t items);

/* Tells the observer of a launch that ran alone and took `host` seconds from enqueue to finish. */
cdl_Status launch_observe(cdl_Device *device, cl_event event, cdl_KernelId kernel, size_t items,
                          double host, int first);

/* Tells the observer of a finished copy; takes over the event, which is NULL without observer. */
void copy_observe(cdl_Device *device, cl_event event, size_t bytes, double host);

/* Hands finished launches to the observer; waits for all of them first if `wait`. */
cdl_Status launches_collect(cdl_Device *device, int wait);

#endif
