/* medium_grid.c: the grids of a medium: from a volume file into one index space.
 *
 * All grids of a medium share one index box: that of its density, and where it has a temperature of
 * both, since what is hot glows without being dense. What the colour holds outside does not
 * matter. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "scene/build.h"
#include "scene/vdb.h"

/* What a compressed file may grow to in memory, besides what every scene may. */
#define GROWTH 64

typedef struct Volume {
  Builder *builder;
  const char *pointer, *uri, *file; /* the JSON of the grid, and its file as messages name it */
  Bytes bytes;                      /* read when a grid is not there yet */
  cdl_SceneMedium *medium;
  int32_t low[3]; /* box of the density alone */
  uint32_t size[3];
} Volume;

static cdl_Status refuse(const Volume *volume, const char *member, const char *grid,
                         const char *why) {
  return document_fail(volume->builder->doc, AT("%.200s/%s", volume->pointer, member),
                       "GRID_DATA_INVALID", "%.200s: grid %.200s: %s.", volume->file, grid, why);
}

static void note_values(const Volume *volume, const char *member, const char *grid,
                        const GridSource *source, double background) {
  const Document *doc = volume->builder->doc;
  char *at = AT("%.200s/%s", volume->pointer, member);
  if (source->negative)
    document_note(doc, NULL, at,
                  "%.200s: grid %.200s: %llu values below 0, down to %g, count as 0.", volume->file,
                  grid, (unsigned long long)source->negative, source->lowest);
  if (background > 0)
    document_note(doc, NULL, at,
                  "%.200s: grid %.200s: its background is %g; where no voxel is active, 0 counts.",
                  volume->file, grid, background);
}

/* The grid that is there already, over its own box or that of `like`; CDL_NONE: there is none. What
 * a data URI holds is not compared. */
static uint32_t find_grid(const Volume *volume, const char *name, const cdl_SceneGrid *like) {
  const struct cdl_Scene *scene = volume->builder->scene;
  if (volume->file != volume->uri) return CDL_NONE;
  for (uint32_t i = 0; i < scene->grid_count; i++) {
    const cdl_SceneGrid *grid = &scene->grids[i];
    if (strcmp(grid->file, volume->file) != 0 || strcmp(grid->name, name) != 0) continue;
    if (like ? memcmp(grid->low, like->low, sizeof grid->low) == 0 &&
                   memcmp(grid->size, like->size, sizeof grid->size) == 0
             : grid->whole)
      return i;
  }
  return CDL_NONE;
}

/* From the file's space to the index space of the box that begins at voxel `low`. */
static int index_space(const double to_world[12], const int32_t low[3], double to_index[12]) {
  Matrix world, index;
  memcpy(world.m, to_world, sizeof world.m);
  if (!matrix_invert(&world, &index)) return 0;
  for (int k = 0; k < 3; k++) index.m[4 * k + 3] -= low[k];
  for (int i = 0; i < 12; i++)
    if (!isfinite(index.m[i])) return 0;
  memcpy(to_index, index.m, sizeof index.m);
  return 1;
}

static cdl_Status add_grid(const Volume *volume, const char *member, const char *name,
                           const GridSource *source, const int32_t low[3], const uint32_t size[3],
                           uint32_t *index) {
  struct cdl_Scene *scene = volume->builder->scene;
  Document *doc = volume->builder->doc;
  const char *why = NULL;
  cdl_SceneGrid *grid = array_push((void **)&scene->grids, scene->grid_count, sizeof *grid);
  if (!grid) return document_out_of_memory(doc);
  *index = scene->grid_count++;
  if (grid_build(source, low, size, doc->decode_left, grid, &why))
    return refuse(volume, member, name, why);
  if (!index_space(source->to_world, low, grid->to_index))
    return refuse(volume, member, name, "its transform is flat or not finite");
  grid->file = string_copy(volume->file);
  grid->name = string_copy(name);
  if (!grid->file || !grid->name) return document_out_of_memory(doc);
  return document_charge(doc, volume->pointer, grid_memory(grid));
}

static cdl_Status read_file(Volume *volume) {
  Document *doc = volume->builder->doc;
  if (volume->bytes.data) return CDL_OK;
  cdl_Status status =
      document_read_uri(doc, AT("%.200s/uri", volume->pointer), volume->uri, &volume->bytes, NULL);
  if (!status) doc->decode_left += GROWTH * volume->bytes.size;
  return status;
}

static cdl_Status read_source(Volume *volume, const char *member, const char *name,
                              GridSource *source) {
  char why[512];
  double background;
  *source = (GridSource){0};
  cdl_Status status = read_file(volume);
  if (status) return status;
  size_t room = volume->builder->doc->decode_left;
  if (vdb_load(volume->bytes.data, volume->bytes.size, name, room, source, &background, why))
    return refuse(volume, member, name, why);
  note_values(volume, member, name, source, background);
  return CDL_OK;
}

static cdl_Status check_channels(const Volume *volume, const char *member, const char *name,
                                 const GridSource *source, uint32_t channels) {
  if (source->channels == channels) return CDL_OK;
  return refuse(volume, member, name,
                channels == 1 ? "it has three channels, where one is wanted"
                              : "it has one channel; a colour has three");
}

/* The box of the density, as far as there is no `heat`, or of both. */
static void common_box(const GridSource *density, const GridSource *heat, cdl_SceneGrid *box) {
  for (int k = 0; k < 3; k++) {
    int32_t low = density->low[k], high = density->high[k];
    if (heat && heat->low[k] < low) low = heat->low[k];
    if (heat && heat->high[k] > high) high = heat->high[k];
    box->low[k] = low;
    box->size[k] = (uint32_t)(high - low) + 1;
  }
}

/* `heat` is what was read of the temperature, or NULL. */
static cdl_Status read_density(Volume *volume, const char *name, const GridSource *heat) {
  GridSource source = {0};
  cdl_SceneGrid box, *grids = volume->builder->scene->grids;
  uint32_t *index = &volume->medium->density;
  *index = heat ? CDL_NONE : find_grid(volume, name, NULL);
  if (*index != CDL_NONE) {
    memcpy(volume->low, grids[*index].low, sizeof volume->low);
    memcpy(volume->size, grids[*index].size, sizeof volume->size);
    return CDL_OK;
  }
  cdl_Status status = read_source(volume, "density", name, &source);
  if (!status) status = check_channels(volume, "density", name, &source, 1);
  if (!status) {
    common_box(&source, NULL, &box);
    memcpy(volume->low, box.low, sizeof volume->low);
    memcpy(volume->size, box.size, sizeof volume->size);
    common_box(&source, heat, &box);
    *index = find_grid(volume, name, &box);
    if (*index == CDL_NONE)
      status = add_grid(volume, "density", name, &source, box.low, box.size, index);
  }
  if (!status)
    volume->builder->scene->grids[*index].whole = !memcmp(box.low, volume->low, sizeof box.low) &&
                                                  !memcmp(box.size, volume->size, sizeof box.size);
  grid_source_free(&source);
  return status;
}

/* Whether two transforms put no voxel of the box a thousandth of a voxel apart. */
static int same_space(const cdl_SceneGrid *density, const double to_world[12]) {
  Matrix other, index;
  memcpy(index.m, density->to_index, sizeof index.m);
  memcpy(other.m, to_world, sizeof other.m);
  Matrix both = matrix_multiply(&index, &other);
  for (int corner = 0; corner < 8; corner++) {
    double voxel[3], moved[3];
    for (int k = 0; k < 3; k++)
      voxel[k] = density->low[k] + (corner >> k & 1 ? density->size[k] : 0.0);
    matrix_apply(&both, voxel, 1, moved);
    for (int k = 0; k < 3; k++)
      if (!(fabs(moved[k] - (voxel[k] - density->low[k])) < 1e-3)) return 0;
  }
  return 1;
}

/* A further grid, of which `source` was read, over the box of the density. */
static cdl_Status place_other(Volume *volume, const char *member, const char *name,
                              const GridSource *source, uint32_t *index) {
  /* A copy: adding a grid moves the others. */
  const cdl_SceneGrid density = volume->builder->scene->grids[volume->medium->density];
  if (!same_space(&density, source->to_world))
    return refuse(volume, member, name,
                  "its transform is not that of the density; resample it to the same voxels");
  *index = find_grid(volume, name, &density);
  if (*index != CDL_NONE && volume->builder->scene->grids[*index].channels == source->channels)
    return CDL_OK;
  return add_grid(volume, member, name, source, density.low, density.size, index);
}

static cdl_Status read_color(Volume *volume, const char *name) {
  GridSource source;
  if (!name) return CDL_OK;
  cdl_Status status = read_source(volume, "color", name, &source);
  if (!status) status = check_channels(volume, "color", name, &source, 3);
  if (!status) status = place_other(volume, "color", name, &source, &volume->medium->color);
  grid_source_free(&source);
  return status;
}

static cdl_Status read_density_and_temperature(Volume *volume, const char *density,
                                               const char *temperature) {
  GridSource heat;
  if (!temperature) return read_density(volume, density, NULL);
  cdl_Status status = read_source(volume, "temperature", temperature, &heat);
  if (!status) status = check_channels(volume, "temperature", temperature, &heat, 1);
  if (!status) status = read_density(volume, density, &heat);
  if (!status)
    status = place_other(volume, "temperature", temperature, &heat, &volume->medium->temperature);
  grid_source_free(&heat);
  return status;
}

/* The corners of `bounds`; 0 if it is no such thing. */
static int read_bounds(const json_t *json, double bounds[2][3]) {
  if (!json_is_array(json) || json_array_size(json) != 2) return 0;
  for (int side = 0; side < 2; side++) {
    const json_t *corner = json_array_get(json, (size_t)side);
    if (!json_is_array(corner) || json_array_size(corner) != 3) return 0;
    for (int k = 0; k < 3; k++) {
      const json_t *number = json_array_get(corner, (size_t)k);
      if (!json_is_number(number)) return 0;
      bounds[side][k] = json_number_value(number);
    }
  }
  return 1;
}

/* With bounds, the box between them is that of the density with its outer voxels as a whole. */
static cdl_Status place(const Volume *volume, const json_t *bounds) {
  const cdl_SceneGrid *density = &volume->builder->scene->grids[volume->medium->density];
  const Document *doc = volume->builder->doc;
  double *to_index = volume->medium->to_index, box[2][3];
  const char *at = AT("%.200s/bounds", volume->pointer);
  memcpy(to_index, density->to_index, sizeof density->to_index);
  if (!bounds) return CDL_OK;
  if (!read_bounds(bounds, box))
    return document_fail(doc, at, "TYPE_MISMATCH", "bounds are two corners of three numbers.");
  memset(to_index, 0, sizeof density->to_index);
  for (int k = 0; k < 3; k++) {
    double scale = volume->size[k] / (box[1][k] - box[0][k]);
    if (!(box[1][k] > box[0][k]) || !isfinite(scale) || !isfinite(scale * box[0][k]))
      return document_fail(doc, at, "VALUE_NOT_IN_RANGE",
                           "the second corner must lie above the first along each axis.");
    to_index[4 * k + k] = scale;
    to_index[4 * k + 3] = (double)volume->low[k] - density->low[k] - 0.5 - scale * box[0][k];
  }
  return CDL_OK;
}

static cdl_Status read_grids(Volume *volume, const json_t *json) {
  cdl_SceneMedium *medium = volume->medium;
  cdl_Status status =
      read_density_and_temperature(volume, json_get_string(json, "density", "density"),
                                   json_get_string(json, "temperature", NULL));
  if (!status) status = read_color(volume, json_get_string(json, "color", NULL));
  medium->temperature_scale = (float)json_get_number(json, "temperatureScale", 1);
  return status ? status : place(volume, json_object_get(json, "bounds"));
}

cdl_Status build_medium_grid(Builder *builder, const char *pointer, const json_t *json,
                             cdl_SceneMedium *medium) {
  const char *uri = json_get_string(json, "uri", "");
  int inside = strncasecmp(uri, "data:", 5) == 0;
  if (!json || builder->shapes_only) return CDL_OK;
  Volume volume = {.builder = builder,
                   .pointer = AT("%.200s/grid", pointer),
                   .uri = uri,
                   .file = inside ? "data URI" : uri,
                   .medium = medium};
  cdl_Status status = read_grids(&volume, json);
  free(volume.bytes.owned);
  return status;
}
