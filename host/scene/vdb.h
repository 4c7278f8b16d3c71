/* vdb.h: volume files of OpenVDB. */
#ifndef CANDELA_SCENE_VDB_H
#define CANDELA_SCENE_VDB_H

#include <stddef.h>
#include <stdint.h>

#include "scene/grid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of a grid before its voxels come. */
typedef struct VdbHeader {
  uint32_t channels;       /* 1 or 3 */
  int32_t low[3], high[3]; /* the first and the last of the active voxels along each axis */
  uint32_t leaves, tiles;  /* how many will come at the most */
  uint64_t active;         /* voxels */
  double to_world[12];     /* from voxels of the file to its space, 3x4, row-major */
  double background; /* the largest channel of what lies outside of all that comes, absolute */
} VdbHeader;

/* Where a grid goes; each returns 0 to stop the reading. Values are those of active voxels, and 0
 * where a voxel is not active. */
typedef struct VdbSink {
  void *user;
  int (*begin)(void *user, const VdbHeader *header);
  int (*leaf)(void *user, const int32_t origin[3], const float *values); /* channel by channel,
                                                                            x fastest */
  int (*tile)(void *user, const int32_t origin[3], uint32_t side, const float *values);
} VdbSink;

/* vdb.cpp, which alone sees that library: reads the grid of that name from a file in memory. 0 when
 * that fails, with `error` set to words that end a line, or empty if the sink said stop. Nothing
 * is taken from the file on trust, but the library does: damage can bring the process down. It is
 * for a process that ends then: the grid stays in memory. */
int vdb_read(const uint8_t *data, size_t size, const char *name, const VdbSink *sink,
             char error[512]);

/* vdb_load.c: the same into `source`, which may take `room` bytes; CDL_BAD_INPUT with `error` set.
 * *background is as of VdbHeader. Call grid_source_free() in any case. */
cdl_Status vdb_load(const uint8_t *data, size_t size, const char *name, size_t room,
                    GridSource *source, double *background, char error[512]);

/* Prepares the library; once, before processes are forked. 0 when that fails. */
int vdb_prepare(void);

#ifdef __cplusplus
}
#endif
#endif
