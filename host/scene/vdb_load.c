#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* pipe2 */
#endif

/* vdb_load.c: has a volume file read by a process of its own, and believes nothing that it says.
 *
 * The library was not made for files that someone has tampered with: a changed byte can make it
 * write where it should not, take all memory, or run for hours. The process shares the file's
 * bytes with this one by fork(), without anything to install or to find. */
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene/vdb_pipe.h"

enum { BUFFER = 1 << 18 };

typedef struct Intake {
  GridSource *source;
  size_t room;       /* bytes */
  unsigned patience; /* s without a byte: longer than the process may compute, on a busy machine */
  double background;
  int from;
  pid_t child;
  float *values; /* of one leaf */
  uint8_t *buffer;
  size_t at, end;
  const char *why;
} Intake;

static int fill(Intake *intake) {
  struct pollfd ready = {.fd = intake->from, .events = POLLIN};
  for (;;) {
    int n = poll(&ready, 1, (int)intake->patience * 1000);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    ssize_t got = read(intake->from, intake->buffer, BUFFER);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return 0;
    intake->at = 0;
    intake->end = (size_t)got;
    return 1;
  }
  intake->why = "reading it takes too long; it is damaged";
  return 0;
}

static int get(Intake *intake, void *to, size_t size) {
  uint8_t *bytes = to;
  while (size > 0) {
    if (intake->at == intake->end && !fill(intake)) return 0;
    size_t left = intake->end - intake->at, part = size < left ? size : left;
    memcpy(bytes, intake->buffer + intake->at, part);
    intake->at += part, bytes += part, size -= part;
  }
  return 1;
}

static int take_header(Intake *intake) {
  VdbHeader header;
  if (intake->values || !get(intake, &header, sizeof header)) return 0;
  uint64_t voxels = (uint64_t)header.leaves * GRID_LEAF + header.tiles;
  size_t each = header.channels * sizeof(float);
  intake->background = header.background;
  if (header.channels != 1 && header.channels != 3) return 0;
  intake->why = "it would take more memory than is allowed";
  if (voxels > intake->room / each) return 0;
  intake->values = malloc(GRID_LEAF * each);
  if (!intake->values || grid_source_begin(intake->source, header.channels, header.low, header.high,
                                           header.leaves, header.tiles, &intake->why))
    return 0;
  intake->why = NULL;
  intake->source->active = header.active;
  memcpy(intake->source->to_world, header.to_world, sizeof header.to_world);
  return 1;
}

static int take_values(Intake *intake, const Record *record) {
  GridSource *source = intake->source;
  size_t count = source->channels * (record->kind == RECORD_LEAF ? GRID_LEAF : 1);
  if (!intake->values || !get(intake, intake->values, count * sizeof(float))) return 0;
  cdl_Status status =
      record->kind == RECORD_LEAF
          ? grid_source_leaf(source, record->origin, intake->values, &intake->why)
          : grid_source_tile(source, record->origin, record->side, intake->values, &intake->why);
  return status == CDL_OK;
}

/* 1: all of it is here. Else `error` says why, or is empty if the process ended unheard. */
static int take_all(Intake *intake, char error[VDB_ERROR]) {
  Record record;
  while (get(intake, &record, sizeof record)) {
    if (record.kind == RECORD_DONE) return intake->values != NULL;
    if (record.kind == RECORD_FAILED) {
      if (get(intake, error, VDB_ERROR)) error[VDB_ERROR - 1] = 0;
      return 0;
    }
    if (record.kind == RECORD_HEADER ? !take_header(intake) : !take_values(intake, &record)) break;
  }
  if (intake->why) snprintf(error, VDB_ERROR, "%s", intake->why);
  return 0;
}

static pid_t start(const uint8_t *data, size_t size, const char *name, size_t room, int *from) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC)) return -1;
  fcntl(ends[1], F_SETPIPE_SZ, BUFFER);
  pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    vdb_child(data, size, name, room, ends[1]);
  }
  int error = errno;
  close(ends[1]);
  *from = ends[0];
  if (child < 0) close(ends[0]);
  errno = error;
  return child;
}

/* How a process that said nothing has ended. */
static const char *words_of_end(pid_t child) {
  int status = 0;
  kill(child, SIGKILL);
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) break;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "reading it takes too long; it is damaged, export it again";
  return "it is damaged, and its reader failed at it; export it again";
}

cdl_Status vdb_load(const uint8_t *data, size_t size, const char *name, size_t room,
                    GridSource *source, double *background, char error[512]) {
  Intake intake = {.source = source,
                   .room = room,
                   .patience = 60 + 4 * vdb_seconds(size),
                   .buffer = malloc(BUFFER)};
  int good = 0;
  *source = (GridSource){0};
  *error = 0;
  if (!intake.buffer || !vdb_prepare()) {
    snprintf(error, VDB_ERROR, "there is not enough memory for it");
    goto done;
  }
  intake.child = start(data, size, name, room, &intake.from);
  if (intake.child < 0) {
    snprintf(error, VDB_ERROR, "no process can be started to read it: %s", strerror(errno));
    goto done;
  }
  good = take_all(&intake, error);
  close(intake.from);
  const char *end = words_of_end(intake.child);
  if (!good && !*error) snprintf(error, VDB_ERROR, "%s", end);
  *background = intake.background;
done:
  free(intake.buffer);
  free(intake.values);
  return good ? CDL_OK : CDL_BAD_INPUT;
}
