/* harness.h: the least OpenCL that runs one library function over an array, for device tests of
 * kernels/lib. It knows nothing of the renderer, so that a fault there cannot hide one here.
 *
 * A call that fails ends the running cmocka test with the OpenCL call named. */
#ifndef CANDELA_TESTS_HARNESS_H
#define CANDELA_TESTS_HARNESS_H

#include <stddef.h>

typedef struct Harness Harness;

/* An array that goes to the device before a launch and comes back after it; the caller owns data.
 */
typedef struct HarnessBuffer {
  void *data;
  size_t bytes;
} HarnessBuffer;

/* Settings that OpenCL implementations read at their first call: call this first in main(). What
 * the user has set stays. Gives PoCL a cache folder of its own, removed at exit, because concurrent
 * processes must not share one. */
void harness_prepare(void);

/* Opens the first GPU, or the first CPU where there is none, of the platforms whose name contains
 * `platform` (NULL: any; letter case counts). Returns NULL when there is no such device. */
Harness *harness_open(const char *platform);

/* Opens PoCL's device, or else any, and builds a file of kernels, of less than 64 KiB. NULL where
 * one or the other is not there. */
Harness *harness_open_with(const char *path);

void harness_close(Harness *harness);

/* "platform: device", owned by the harness */
const char *harness_name(const Harness *harness);

/* Builds `source`, whose `#include "lib/…"` lines are replaced by the files under $CANDELA_KERNELS
 * or ./kernels, and keeps it for harness_run until the next build. */
void harness_build(Harness *harness, const char *source);

/* Runs a kernel of the built program over `items` work-items with the buffers as its arguments. */
void harness_run(Harness *harness, const char *kernel, size_t items, const HarnessBuffer *buffers,
                 size_t count);

#endif
