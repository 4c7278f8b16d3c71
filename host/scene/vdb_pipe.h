/* vdb_pipe.h: what the process that reads a volume file sends to the one that wants it. */
#ifndef CANDELA_SCENE_VDB_PIPE_H
#define CANDELA_SCENE_VDB_PIPE_H

#include "scene/vdb.h"

typedef enum RecordKind {
  RECORD_HEADER, /* followed by a VdbHeader */
  RECORD_LEAF,   /* by GRID_LEAF values for each channel */
  RECORD_TILE,   /* by a value for each channel */
  RECORD_DONE,
  RECORD_FAILED /* by VDB_ERROR characters */
} RecordKind;

enum { VDB_ERROR = 512 };

typedef struct Record {
  uint32_t kind, side; /* of a tile */
  int32_t origin[3];   /* of a leaf or tile */
} Record;

/* What reading a file may take of processor time, s. The slowest way to store voxels, zlib, gives
 * more than 20 MB of file a second. */
static inline unsigned vdb_seconds(size_t size) { return 3 + (unsigned)(size >> 22); }

/* Reads a grid under limits of its own and writes records to the pipe `to`; ends the process. It
 * may take `room` bytes more than it has. */
_Noreturn void vdb_child(const uint8_t *data, size_t size, const char *name, size_t room, int to);

/* Leaves the process nothing but to compute, and to write to what is open. */
void vdb_cage(void);

#endif
