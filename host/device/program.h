/* program.h: kernels by name, compiled when first asked for.
 *
 * Rows of kernels.def with the same options are one program, which takes much less time than one
 * each; if it does not compile, they are built one by one. Programs are built with -cl-std=CL1.2,
 * with correctly rounded division and square root where the device has that option, the row's
 * options and the session's; never with relaxed mathematics. */
#ifndef CANDELA_DEVICE_PROGRAM_H
#define CANDELA_DEVICE_PROGRAM_H

#include "device/device.h"

#define CDL_KERNEL(name, file, range, options, arguments) CDL_KERNEL_##name,
typedef enum cdl_KernelId {
#include "device/kernels.def"
  CDL_KERNEL_COUNT
} cdl_KernelId;
#undef CDL_KERNEL

/* "probe_index"; never NULL for a valid id. */
const char *kernel_name(cdl_KernelId id);

/* Names in the order of the enum, CDL_KERNEL_COUNT of them. */
const char *const *kernel_names(void);

/* Options for all programs of this session, such as "-DCDL_HAS_MEDIA=1"; NULL is "". Kernels that
 * were built with others are dropped and built again when asked for. */
cdl_Status device_set_options(cdl_Device *device, const char *options);

/* The kernel, built on first use; it stays the device's. A failure is one line: kernel, device and
 * the compiler's first error. */
cdl_Status device_kernel(cdl_Device *device, cdl_KernelId id, cl_kernel *kernel);

/* Called before each program is built (`done` of `total` so far), so that nobody waits in silence.
 */
typedef void (*cdl_BuildProgress)(void *user, const char *kernel, size_t done, size_t total);

/* Builds these kernels now rather than at their first launch. `progress` may be NULL. */
cdl_Status device_build(cdl_Device *device, const cdl_KernelId *ids, size_t count,
                        cdl_BuildProgress progress, void *user);

/* Seconds that this device has spent in building programs so far. */
double device_build_seconds(const cdl_Device *device);

/* A kernel that is not in the list, for tests: `source` may include the tree's headers. The caller
 * releases the kernel; its program goes with it. */
cdl_Status device_kernel_from_text(cdl_Device *device, const char *source, const char *name,
                                   const char *options, cl_kernel *kernel);

#endif
