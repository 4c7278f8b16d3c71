#include "profile/watch.h"

static void on_launch(void *user, const cdl_Launch *launch) {
  cdl_LaunchRecord record = {.kernel = launch->kernel,
                             .items = launch->items,
                             .seconds = launch->seconds,
                             .compile_seconds = launch->compile_seconds,
                             .first = launch->first,
                             .host_timed = launch->host_timed};
  profile_launch(user, &record);
}

static void on_transfer(void *user, size_t bytes, double seconds) {
  profile_transfer(user, bytes, seconds);
}

static void on_build(void *user, cdl_KernelId kernel, double seconds) {
  (void)kernel;
  profile_compile(user, seconds);
}

cdl_Profile *profile_create_for_kernels(void) {
  return profile_create(kernel_names(), CDL_KERNEL_COUNT);
}

cdl_Status profile_watch(cdl_Profile *profile, cdl_Device *device) {
  if (!profile) return device_observe(device, NULL);
  cdl_Observer observer = {
      .user = profile, .launched = on_launch, .transferred = on_transfer, .built = on_build};
  return device_observe(device, &observer);
}
