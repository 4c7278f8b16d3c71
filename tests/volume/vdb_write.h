/* vdb_write.h: volume files written by the library itself. */
#ifndef CANDELA_TESTS_VDB_WRITE_H
#define CANDELA_TESTS_VDB_WRITE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Voxels of one value: those of a tile of 8, 128 or 4096 a side. */
typedef struct VdbTile {
  int32_t origin[3];
  uint32_t side;
  float value;
} VdbTile;

/* A grid: a dense array, of which the voxels that are not active are left out. */
typedef struct VdbGrid {
  const char *name,
      *type;      /* "float", "half", "double", "int32", "int64", "vec3s", "vec3d", "bool" */
  int32_t low[3]; /* the array's first voxel in the file's index */
  uint32_t size[3];
  const float *values;   /* x fastest, channels interleaved */
  const uint8_t *active; /* NULL: all */
  float background;
  const VdbTile *tiles;
  uint32_t tile_count;
  double to_world[12]; /* 3x4, row-major; all 0: the identity */
  int frustum, level_set;
} VdbGrid;

enum { VDB_NONE = 0, VDB_ZIP = 1, VDB_MASK = 2, VDB_BLOSC = 4 };

/* Writes the grids into a file; 0 when that fails. `compression` is of VDB_*. */
int vdb_write(const char *path, const VdbGrid *grids, uint32_t count, uint32_t compression);

#ifdef __cplusplus
}
#endif
#endif
