#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* close_range */
#endif

/* vdb_child.c: the process in which a volume file is read. What damage does to the library ends
 * here: in time, in memory, and without a word. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "scene/vdb_pipe.h"

typedef struct Outlet {
  int to;
  uint32_t channels;
  size_t used;
  uint8_t buffer[1 << 16];
} Outlet;

static int flush(Outlet *outlet) {
  for (size_t at = 0; at < outlet->used;) {
    ssize_t put = write(outlet->to, outlet->buffer + at, outlet->used - at);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return 0;
    at += (size_t)put;
  }
  outlet->used = 0;
  return 1;
}

static int put(Outlet *outlet, const void *from, size_t size) {
  const uint8_t *bytes = from;
  while (size > 0) {
    size_t room = sizeof outlet->buffer - outlet->used, part = size < room ? size : room;
    memcpy(outlet->buffer + outlet->used, bytes, part);
    outlet->used += part, bytes += part, size -= part;
    if (outlet->used == sizeof outlet->buffer && !flush(outlet)) return 0;
  }
  return 1;
}

static int put_header(void *user, const VdbHeader *header) {
  Outlet *outlet = user;
  Record record = {.kind = RECORD_HEADER};
  outlet->channels = header->channels;
  return put(outlet, &record, sizeof record) && put(outlet, header, sizeof *header);
}

static int put_leaf(void *user, const int32_t origin[3], const float *values) {
  Outlet *outlet = user;
  Record record = {.kind = RECORD_LEAF, .origin = {origin[0], origin[1], origin[2]}};
  return put(outlet, &record, sizeof record) &&
         put(outlet, values, outlet->channels * GRID_LEAF * sizeof *values);
}

static int put_tile(void *user, const int32_t origin[3], uint32_t side, const float *values) {
  Outlet *outlet = user;
  Record record = {.kind = RECORD_TILE, .side = side, .origin = {origin[0], origin[1], origin[2]}};
  return put(outlet, &record, sizeof record) &&
         put(outlet, values, outlet->channels * sizeof *values);
}

/* A further limit `after` the first makes the system say which one it was. */
static void limit(int what, rlim_t most, rlim_t after) {
  struct rlimit old = {RLIM_INFINITY, RLIM_INFINITY};
  getrlimit(what, &old);
  if (old.rlim_max != RLIM_INFINITY && old.rlim_max < most) most = old.rlim_max;
  if (old.rlim_cur != RLIM_INFINITY && old.rlim_cur < most) most = old.rlim_cur;
  if (old.rlim_max == RLIM_INFINITY || most + after < old.rlim_max) old.rlim_max = most + after;
  setrlimit(what, &(struct rlimit){most, old.rlim_max});
}

/* Bytes of address space in use. */
static size_t address_space(void) {
  char text[64] = "";
  int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  if (read(file, text, sizeof text - 1) < 0) text[0] = 0;
  close(file);
  return strtoull(text, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE);
}

/* Ends when its parent does, and by damage as if nobody had asked for reports. */
static void detach(int to) {
  static const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE, SIGTERM};
  sigset_t none;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGINT, SIG_IGN);
#if !defined(__SANITIZE_ADDRESS__) /* whose reports are wanted */
  int nowhere = open("/dev/null", O_RDWR);
  for (int i = STDIN_FILENO; nowhere >= 0 && i <= STDERR_FILENO; i++)
    if (i != to) dup2(nowhere, i);
#endif
  for (size_t i = 0; i < sizeof fatal / sizeof *fatal; i++) signal(fatal[i], SIG_DFL);
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  /* Others wait for the end of pipes that this process has inherited. */
  if (to > STDERR_FILENO + 1) close_range(STDERR_FILENO + 1, (unsigned)to - 1, 0);
  close_range((unsigned)to + 1, ~0u, 0);
}

_Noreturn void vdb_child(const uint8_t *data, size_t size, const char *name, size_t room, int to) {
  static Outlet outlet;
  VdbSink sink = {&outlet, put_header, put_leaf, put_tile};
  char error[VDB_ERROR] = "";
  size_t space = address_space();
  detach(to);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, vdb_seconds(size), 1);
  if (space) limit(RLIMIT_AS, space + room, 0);
  vdb_cage();
  outlet.to = to;
  int good = vdb_read(data, size, name, &sink, error);
  Record record = {.kind = good ? RECORD_DONE : RECORD_FAILED};
  good = put(&outlet, &record, sizeof record) && (good || put(&outlet, error, sizeof error));
  _exit(good && flush(&outlet) ? 0 : 1);
}
