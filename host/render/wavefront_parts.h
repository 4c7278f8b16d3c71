/* wavefront_parts.h: what a wavefront consists of; shared by its own files alone. */
#ifndef CANDELA_RENDER_WAVEFRONT_PARTS_H
#define CANDELA_RENDER_WAVEFRONT_PARTS_H

#include "device/buffer.h"
#include "render/wavefront.h"

/* Every buffer, under the name that device/kernels.def uses, and whether the kernels fill it. */
/* clang-format off */
#define CDL_BUFFERS(B) \
  B(params) B(wave) B(camera_media) B(bvh_nodes) B(bvh_triangles) B(bvh_instances) \
  B(triangles) B(shapes) B(attributes) B(materials) B(param_textures) B(textures) B(texels) \
  B(srgb) B(lights) B(light_table) B(environment) B(environment_cells) B(media) \
  B(grids) B(grid_table) B(grid_most) B(grid_values) B(blackbody) B(energy_table) B(film_channels) B(path_a) B(path_b) B(work) B(slots) B(counts) B(ranges) \
  B(sources) B(sums) B(bad_samples) B(collisions)
/* clang-format on */

typedef enum BufferId {
#define BUFFER_ID(name) BUFFER_##name,
  CDL_BUFFERS(BUFFER_ID)
#undef BUFFER_ID
      BUFFER_COUNT
} BufferId;

struct cdl_Wavefront {
  cdl_Device *device;
  cdl_Params params;
  cdl_Wave wave; /* the current one */
  cdl_PackFeatures features;
  int has_lights, has_aovs;
  int wide_camera; /* rays begin in more than one place, and there are media that may begin there */
  uint32_t paths;  /* of a wave, at the most */
  cdl_QueueRange ranges[CDL_QUEUE_COUNT + 1];
  cdl_Buffer buffers[BUFFER_COUNT];
  cdl_Bindings bindings;
  int path_is_b; /* which of path_a and path_b holds the paths */
  double upload_seconds;
};

/* Lets `path` and `path_from` change places. */
void wavefront_swap_paths(cdl_Wavefront *wavefront);

#endif
