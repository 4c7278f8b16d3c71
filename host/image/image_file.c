#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* asprintf */
#endif

#include "image/image_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/log.h"

static cdl_Status read_all(const cdl_Log *log, const char *path, int file, unsigned char *bytes,
                           size_t size) {
  for (size_t at = 0; at < size;) {
    ssize_t got = read(file, bytes + at, size - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return log_fail(log, CDL_BAD_INPUT, "%s: cannot read: %s", path, strerror(errno));
    if (got == 0)
      return log_fail(log, CDL_BAD_INPUT, "%s: the file shrank while it was read", path);
    at += (size_t)got;
  }
  return CDL_OK;
}

cdl_Status image_file_read(const cdl_Log *log, const char *path, size_t limit,
                           unsigned char **bytes, size_t *size) {
  cdl_Status status = CDL_BAD_INPUT;
  struct stat about;
  *bytes = NULL;
  *size = 0;
  /* O_NONBLOCK: opening a pipe must not wait for a writer; it has no effect on regular files. */
  int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0 || fstat(file, &about) != 0) {
    log_fail(log, status, "%s: cannot open: %s", path, strerror(errno));
    goto done;
  }
  if (!S_ISREG(about.st_mode)) {
    log_fail(log, status, "%s: not a regular file", path);
    goto done;
  }
  if ((uintmax_t)about.st_size > limit) {
    log_fail(log, status, "%s: the file has %jd bytes, the limit is %zu", path,
             (intmax_t)about.st_size, limit);
    goto done;
  }
  *size = (size_t)about.st_size;
  *bytes = malloc(*size + 1);
  if (!*bytes) {
    log_fail(log, status, "%s: not enough memory for %zu bytes", path, *size);
    goto done;
  }
  status = read_all(log, path, file, *bytes, *size);
done:
  if (file >= 0) close(file);
  if (status != CDL_OK) {
    free(*bytes);
    *bytes = NULL;
    *size = 0;
  }
  return status;
}

static cdl_Status write_all(int file, const unsigned char *bytes, size_t size) {
  for (size_t at = 0; at < size;) {
    ssize_t put = write(file, bytes + at, size - at);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return CDL_OUTPUT;
    at += (size_t)put;
  }
  return fsync(file) == 0 ? CDL_OK : CDL_OUTPUT;
}

/* Creates the temporary file beside `path`; its name, the caller's, in *temporary. */
static int create_beside(const char *path, char **temporary) {
  const char *slash = strrchr(path, '/');
  int folder = slash ? (int)(slash - path) + 1 : 0;
  for (int attempt = 0; attempt < 100; attempt++) {
    /* The name is cut so that a long file name does not outgrow NAME_MAX with what is added. */
    if (asprintf(temporary, "%.*s.%.200s.%ld.%d.part", folder, path, path + folder, (long)getpid(),
                 attempt) < 0) {
      *temporary = NULL;
      errno = ENOMEM;
      return -1;
    }
    int file = open(*temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) return file;
    int error = errno;
    free(*temporary);
    *temporary = NULL;
    errno = error;
    if (error != EEXIST) return -1;
  }
  return -1;
}

/* Renaming over a device or a folder would destroy or fail late: only files are replaced. */
static cdl_Status check_replaceable(const cdl_Log *log, const char *path) {
  struct stat about;
  if (stat(path, &about) == 0 && !S_ISREG(about.st_mode))
    return log_fail(log, CDL_OUTPUT, "%s: exists and is not a regular file", path);
  return CDL_OK;
}

/* Makes the rename itself durable; not every file system can, so failure is no error. */
static void sync_folder(const char *path) {
  const char *slash = strrchr(path, '/');
  char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
  int file = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
  if (file >= 0) {
    fsync(file);
    close(file);
  }
  free(folder);
}

cdl_Status image_file_write(const cdl_Log *log, const char *path, const void *bytes, size_t size) {
  char *temporary = NULL;
  cdl_Status status = check_replaceable(log, path);
  if (status != CDL_OK) return status;
  int file = create_beside(path, &temporary);
  if (file < 0) {
    status = log_fail(log, CDL_OUTPUT, "%s: cannot create: %s", path, strerror(errno));
    goto done;
  }
  status = write_all(file, bytes, size);
  int error = errno;
  if (close(file) != 0 && status == CDL_OK) {
    status = CDL_OUTPUT;
    error = errno;
  }
  if (status == CDL_OK && rename(temporary, path) != 0) {
    status = CDL_OUTPUT;
    error = errno;
  }
  if (status != CDL_OK) {
    log_fail(log, status, "%s: cannot write: %s", path, strerror(error));
    unlink(temporary);
  } else {
    sync_folder(path);
  }
done:
  free(temporary);
  return status;
}

cdl_Status image_file_probe(const cdl_Log *log, const char *path) {
  char *temporary = NULL;
  cdl_Status status = check_replaceable(log, path);
  if (status != CDL_OK) return status;
  int file = create_beside(path, &temporary);
  if (file < 0) return log_fail(log, CDL_OUTPUT, "%s: cannot create: %s", path, strerror(errno));
  close(file);
  unlink(temporary);
  free(temporary);
  return CDL_OK;
}
