/* vdb_load.c: takes in what the reader of volume files says. */
#include <stdio.h>
#include <string.h>

#include "scene/vdb.h"

typedef struct Intake {
  GridSource *source;
  size_t room; /* bytes */
  double background;
  const char *why;
} Intake;

static int take_header(void *user, const VdbHeader *header) {
  Intake *intake = user;
  uint64_t voxels = (uint64_t)header->leaves * GRID_LEAF + header->tiles;
  intake->background = header->background;
  intake->why = "it would take more memory than is allowed";
  if (voxels > intake->room / (header->channels * sizeof(float))) return 0;
  if (grid_source_begin(intake->source, header->channels, header->low, header->high, header->leaves,
                        header->tiles, &intake->why))
    return 0;
  intake->source->active = header->active;
  memcpy(intake->source->to_world, header->to_world, sizeof header->to_world);
  return 1;
}

static int take_leaf(void *user, const int32_t origin[3], const float *values) {
  Intake *intake = user;
  return grid_source_leaf(intake->source, origin, values, &intake->why) == CDL_OK;
}

static int take_tile(void *user, const int32_t origin[3], uint32_t side, const float *values) {
  Intake *intake = user;
  return grid_source_tile(intake->source, origin, side, values, &intake->why) == CDL_OK;
}

cdl_Status vdb_load(const uint8_t *data, size_t size, const char *name, size_t room,
                    GridSource *source, double *background, char error[512]) {
  Intake intake = {.source = source, .room = room};
  VdbSink sink = {&intake, take_header, take_leaf, take_tile};
  *source = (GridSource){0};
  *error = 0;
  int good = vdb_prepare() && vdb_read(data, size, name, &sink, error);
  *background = intake.background;
  if (!good && !*error) snprintf(error, 512, "%s", intake.why ? intake.why : "it cannot be read");
  return good ? CDL_OK : CDL_BAD_INPUT;
}
