/* watch.h: fills a profile from what a device does. */
#ifndef CANDELA_PROFILE_WATCH_H
#define CANDELA_PROFILE_WATCH_H

#include "device/queue.h"
#include "profile/profile.h"

/* A profile with a row per kernel of device/kernels.def; NULL when memory is short. */
cdl_Profile *profile_create_for_kernels(void);

/* From now on the device's launches, transfers and builds go to `profile`; NULL stops it. */
cdl_Status profile_watch(cdl_Profile *profile, cdl_Device *device);

#endif
