/* describe_grid.c: the grids of a scene, told as JSON and in words. */
#include "scene/describe.h"

static json_t *json_of_grid(const cdl_SceneGrid *grid) {
  return json_pack("{s:s, s:s, s:I, s:[I, I, I], s:[f, f], s:I, s:I, s:I}", "file", grid->file,
                   "name", grid->name, "channels", (json_int_t)grid->channels, "size",
                   (json_int_t)grid->size[0], (json_int_t)grid->size[1], (json_int_t)grid->size[2],
                   "range", (double)grid->minimum, (double)grid->maximum, "active_voxels",
                   (json_int_t)grid->active, "bricks", (json_int_t)grid->brick_count,
                   "memory_bytes", (json_int_t)grid_memory(grid));
}

json_t *describe_grids(const cdl_Scene *scene) {
  json_t *list = json_array();
  for (uint32_t i = 0; i < scene->grid_count; i++)
    json_array_append_new(list, json_of_grid(&scene->grids[i]));
  return list;
}

void print_grids(FILE *out, const cdl_Scene *scene) {
  if (scene->grid_count) fprintf(out, "grids\n");
  for (uint32_t i = 0; i < scene->grid_count; i++) {
    const cdl_SceneGrid *grid = &scene->grids[i];
    fprintf(out,
            "  %2u  %s: %s, %u x %u x %u%s, %.4g to %.4g, %llu active voxels in %u bricks, "
            "%.1f MB\n",
            i, grid->file, grid->name, grid->size[0], grid->size[1], grid->size[2],
            grid->channels == 3 ? " colours" : "", (double)grid->minimum, (double)grid->maximum,
            (unsigned long long)grid->active, grid->brick_count, (double)grid_memory(grid) / 1e6);
  }
}

uint64_t grids_memory(const cdl_Scene *scene) {
  uint64_t memory = 0;
  for (uint32_t i = 0; i < scene->grid_count; i++) memory += grid_memory(&scene->grids[i]);
  return memory;
}
