/* wavefront.h: the wavefront schedule: one kernel launch for each stage and bounce of a wave of
 * paths. */
#ifndef CANDELA_RENDER_WAVEFRONT_H
#define CANDELA_RENDER_WAVEFRONT_H

#include "abi/params.h"
#include "abi/path.h"
#include "device/device.h"
#include "device/queue.h"
#include "render/film.h"
#include "scene/pack.h"

/* What a wave came to. */
typedef struct cdl_WaveCounts {
  uint64_t camera_rays, bounce_rays, shadow_rays;
  uint64_t real_collisions, null_collisions; /* of paths in grids */
  uint64_t bad_samples;                      /* channels of samples that were not finite */
} cdl_WaveCounts;

typedef struct cdl_Wavefront cdl_Wavefront;

/* Uploads the scene, builds the kernels that it needs and makes room for waves of up to `paths`
 * paths (a multiple of 64, at most 2^20). `params` is copied; the pack may be freed afterwards.
 * `stage` may be NULL. Free with wavefront_free(). */
cdl_Status wavefront_create(cdl_Device *device, const cdl_Pack *pack, const cdl_Params *params,
                            const cdl_Film *film, uint32_t paths, cdl_Stage stage, void *stage_user,
                            cdl_Wavefront **wavefront);

/* Renders a rectangle of pixels, `samples` samples of each from `first_sample`, which is a multiple
 * of 16, and adds them to the film. x and y count in the full image; width x height x samples paths
 * must fit. On failure nothing was added. */
cdl_Status wavefront_run(cdl_Wavefront *wavefront, uint32_t x, uint32_t y, uint32_t width,
                         uint32_t height, uint32_t first_sample, uint32_t samples, cdl_Film *film,
                         cdl_WaveCounts *counts);

/* Paths of a wave at the most. */
uint32_t wavefront_paths(const cdl_Wavefront *wavefront);

/* Seconds of uploading. */
double wavefront_upload_seconds(const cdl_Wavefront *wavefront);

void wavefront_free(cdl_Wavefront *wavefront); /* NULL is nothing */

#endif
