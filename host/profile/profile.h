/* profile.h: what each kernel cost. Records come from a device's observer (device/queue.h) or from
 * anywhere else; the profile itself knows nothing of OpenCL. */
#ifndef CANDELA_PROFILE_PROFILE_H
#define CANDELA_PROFILE_PROFILE_H

#include "candela.h"

#include <jansson.h>
#include <stdio.h>

typedef struct cdl_Profile cdl_Profile;

/* The first launch is kept apart: it holds the driver's compilation. It counts in `launches`,
 * `items` and `total_s`, and in min, median and max only when it is the only one. */
typedef struct cdl_KernelStats {
  const char *name;
  uint64_t launches, items;
  double total_s, min_s, median_s, max_s, first_s; /* seconds; zeros without launches */
  uint64_t rays;                                   /* of a ray kernel, else 0 */
  int host_timed; /* some launches were timed by the host's clock */
} cdl_KernelStats;

/* Where the wall time went that is not a kernel's. */
typedef struct cdl_ProfileRest {
  double compile_s, transfer_s;
  uint64_t transfer_bytes;
} cdl_ProfileRest;

/* `names` must outlive the profile. NULL when memory is short. */
cdl_Profile *profile_create(const char *const *names, size_t count);
void profile_free(cdl_Profile *profile);
void profile_reset(cdl_Profile *profile);

/* One launch: seconds of execution, and of compilation in it, which is 0 but for first launches. */
typedef struct cdl_LaunchRecord {
  size_t kernel;
  uint64_t items;
  double seconds, compile_seconds;
  int first, host_timed; /* as in cdl_Launch of device/queue.h */
} cdl_LaunchRecord;

void profile_launch(cdl_Profile *profile, const cdl_LaunchRecord *launch);
void profile_transfer(cdl_Profile *profile, uint64_t bytes, double seconds);
void profile_compile(cdl_Profile *profile, double seconds);

/* Makes a kernel a ray kernel and says how many rays it has traced in all. */
void profile_rays(cdl_Profile *profile, size_t kernel, uint64_t rays);

void profile_stats(const cdl_Profile *profile, size_t kernel, cdl_KernelStats *stats);
cdl_ProfileRest profile_rest(const cdl_Profile *profile);
double profile_kernel_seconds(const cdl_Profile *profile); /* sum over kernels */

/* The table for people: kernels that ran, longest first, then the sum, and the rest of `wall_s` by
 * name: compilation, transfers, host. */
void profile_table(FILE *out, const cdl_Profile *profile, double wall_s);

/* [{name, launches, items, total_s, min_s, median_s, max_s, first_s, (rays, mrays_per_s)}, …] in
 * the order of the names, kernels that ran only; the caller owns the reference. NULL: memory is
 * short. */
json_t *profile_json(const cdl_Profile *profile);

#endif
