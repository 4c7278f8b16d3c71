/* device.h: which OpenCL devices there are, what they can do, and the one that is used.
 *
 * A cdl_Device is a device with its context, its in-order queue and its kernels. It belongs to one
 * thread at a time. It keeps the log that it was opened with; the log must outlive it. */
#ifndef CANDELA_DEVICE_DEVICE_H
#define CANDELA_DEVICE_DEVICE_H

#include "candela.h"
#include "device/cl.h"

typedef struct cdl_Device cdl_Device;

/* Whether a device computes the bits that every exact device computes. */
typedef enum cdl_Exactness {
  CDL_EXACT_NO,       /* measured, and results differ; or the device cannot be used */
  CDL_EXACT_UNKNOWN,  /* the driver does not report it and nothing was measured yet */
  CDL_EXACT_NORMALS,  /* measured: only denormal numbers (below 1.2e-38) come out differently */
  CDL_EXACT_REPORTED, /* the driver reports fma, denormals and correct rounding */
  CDL_EXACT_MEASURED  /* agreed with the host on every value of the arithmetic probe */
} cdl_Exactness;

typedef struct cdl_DeviceInfo {
  int index; /* what SELECTOR counts by; -1: a platform without a device */
  cl_platform_id platform_id;
  cl_device_id id; /* NULL: a platform without a device */
  char platform[128];
  char platform_version[128];
  char name[128]; /* without leading blanks */
  char vendor[128];
  char driver[128];
  char version[128];   /* of OpenCL */
  char c_version[128]; /* of OpenCL C */
  cl_device_type type;
  uint32_t compute_units;
  uint32_t native_float_width; /* lanes of a float vector that the hardware likes; 1: scalar */
  uint64_t global_mem, max_alloc, local_mem;    /* bytes */
  uint64_t max_group;                           /* work-items in a work-group */
  cl_device_fp_config fp_config;                /* of float */
  int has_fma, has_denorms, has_correct_divide; /* as the driver reports them */
  int unified_memory; /* device and host share memory: buffers need no copies */
  uint64_t timer_ns;  /* resolution that the driver reports; 0: its timers are stubs */
  int usable;
  char unusable[256]; /* one line: why it cannot be used and what to do; empty if usable */
  cdl_Exactness exact;
  char exactness[256]; /* one line: how that is known, or what differs and what follows */
} cdl_DeviceInfo;

/* To be called before the first OpenCL call of the process; device_list and device_open do it.
 * Chooses PoCL's vectorising work-group method and gives this process a kernel cache of its own, a
 * slot of $XDG_CACHE_HOME/candela/pocl that stays locked until the process ends: processes that
 * share a cache have crashed. What the user has set in the environment is kept. */
cdl_Status device_prepare(const cdl_Log *log);

/* Every platform and device, in the order of the loader; platforms without devices included. The
 * caller frees *list. An empty list is CDL_OK. */
cdl_Status device_list(const cdl_Log *log, cdl_DeviceInfo **list, size_t *count);

/* The entry of `list` that a selector means: an index, or a case-insensitive part of a platform or
 * device name; NULL or "" is the best: a GPU that is exact, else a CPU, else anything usable.
 * CDL_USAGE if nothing or nothing usable matches; CDL_DEVICE if no device is usable at all. */
cdl_Status device_select(const cdl_Log *log, const cdl_DeviceInfo *list, size_t count,
                         const char *selector, size_t *chosen);

cdl_Status device_open(const cdl_Log *log, const char *selector, cdl_Device **device);

/* Waits for the queue and frees everything; buffers must have been freed. NULL is fine. */
void device_close(cdl_Device *device);

/* One at a time may build kernels with options of its own and launch them. CDL_USAGE, reported to
 * `log`, while another has it. */
cdl_Status device_claim(cdl_Device *device, const cdl_Log *log);
void device_release(cdl_Device *device);

const cdl_DeviceInfo *device_info(const cdl_Device *device);
cl_context device_context(const cdl_Device *device);
cl_command_queue device_queue(const cdl_Device *device);
const cdl_Log *device_log(const cdl_Device *device);

/* Bytes that buffers hold on this device now, and the most they ever held. */
uint64_t device_allocated(const cdl_Device *device);
uint64_t device_peak_allocated(const cdl_Device *device);

/* Runs the arithmetic probe (+ - * / sqrt fma, conversions, denormals; about 10^5 values each on
 * the host too) and sets `exact` and `exactness` of the device's info. Cheap, but it compiles a
 * kernel. */
cdl_Status device_measure_exactness(cdl_Device *device);

/* Reports a failed OpenCL call in one line, "CALL on DEVICE: CL_NAME", and returns CDL_DEVICE. */
cdl_Status device_fail(const cdl_Device *device, const char *call, cl_int code);

#endif
