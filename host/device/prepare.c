#include "device/device.h"

#include "core/log.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CACHE_SLOTS = 64, PATH_SIZE = 1024 };

/* Set beside POCL_CACHE_DIR, so that a process started by this one does not take our slot for a
 * choice of the user's. */
static const char own_cache_mark[] = "CANDELA_POCL_CACHE_SLOT";

static int make_folders(const char *path) {
  char part[PATH_SIZE];
  snprintf(part, sizeof part, "%s", path);
  for (char *c = part + 1; *c; c++) {
    if (*c != '/') continue;
    *c = 0;
    if (mkdir(part, 0777) && errno != EEXIST) return 0;
    *c = '/';
  }
  return (!mkdir(part, 0700) || errno == EEXIST) && !access(part, W_OK | X_OK);
}

/* Compiled kernels are run, so they must not come from a folder of somebody else's. */
static int is_own(const char *folder) {
  struct stat info;
  return !lstat(folder, &info) && S_ISDIR(info.st_mode) && info.st_uid == geteuid();
}

/* Locks the first free slot below `base` for the life of the process: the descriptor is never
 * closed, and the kernel drops the lock however the process ends. */
static int take_slot(const char *base, char slot[PATH_SIZE]) {
  if (!make_folders(base) || !is_own(base)) return 0;
  for (int i = 0; i < CACHE_SLOTS; i++) {
    char lock[PATH_SIZE];
    if (snprintf(lock, sizeof lock, "%s/slot%d.lock", base, i) >= PATH_SIZE) return 0;
    int fd = open(lock, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return 0;
    if (flock(fd, LOCK_EX | LOCK_NB)) {
      close(fd);
      continue;
    }
    snprintf(slot, PATH_SIZE, "%s/slot%d", base, i);
    if (make_folders(slot)) return 1;
    close(fd);
  }
  return 0;
}

static int take_cache(char slot[PATH_SIZE]) {
  char base[PATH_SIZE - 32];
  const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME"), *tmp = getenv("TMPDIR");
  if (xdg && *xdg == '/') {
    snprintf(base, sizeof base, "%s/candela/pocl", xdg);
    if (take_slot(base, slot)) return 1;
  } else if (home && *home == '/') {
    snprintf(base, sizeof base, "%s/.cache/candela/pocl", home);
    if (take_slot(base, slot)) return 1;
  }
  snprintf(base, sizeof base, "%s/candela-pocl-%u", tmp && *tmp ? tmp : "/tmp",
           (unsigned)geteuid());
  return take_slot(base, slot);
}

static cdl_Status prepare_cache(const cdl_Log *log) {
  const char *given = getenv("POCL_CACHE_DIR"), *own = getenv(own_cache_mark);
  if (given && !(own && !strcmp(given, own))) {
    if (make_folders(given)) return CDL_OK;
    return log_fail(log, CDL_DEVICE, "%s: cannot be used as POCL_CACHE_DIR: %s", given,
                    strerror(errno));
  }
  char slot[PATH_SIZE];
  if (take_cache(slot)) {
    setenv("POCL_CACHE_DIR", slot, 1);
    setenv(own_cache_mark, slot, 1);
    return CDL_OK;
  }
  log_warning(log, "no folder can be written for compiled kernels, so every start compiles them "
                   "again; set POCL_CACHE_DIR to one");
  setenv("POCL_KERNEL_CACHE", "0", 0);
  return CDL_OK;
}

cdl_Status device_prepare(const cdl_Log *log) {
  static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  static pid_t prepared_by; /* a forked child needs a slot of its own */
  static cdl_Status status;
  pthread_mutex_lock(&mutex);
  if (prepared_by != getpid()) {
    prepared_by = getpid();
    setenv("POCL_WORK_GROUP_METHOD", "loopvec", 0);
    status = prepare_cache(log);
  }
  pthread_mutex_unlock(&mutex);
  return status;
}
