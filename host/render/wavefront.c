#include "render/wavefront.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi/film.h"
#include "abi/grid.h"
#include "core/clock.h"
#include "core/log.h"
#include "device/buffer.h"
#include "device/program.h"
#include "image/aov.h"
#include "render/wavefront_parts.h"

/* --- Queues, after a sort. */

/* The entries of queues first … last together, pads included. */
static size_t ranges_span(const cdl_QueueRange *ranges, uint32_t first, uint32_t last,
                          size_t *offset) {
  *offset = ranges[first].begin;
  return (size_t)ranges[last + 1].begin - ranges[first].begin;
}

static int ranges_empty(const cdl_QueueRange *ranges, uint32_t first, uint32_t last) {
  for (uint32_t q = first; q <= last; q++)
    if (ranges[q].count) return 0;
  return 1;
}

/* Runs a kernel over queues first … last, if there is anything in them. */
static cdl_Status run_queues(cdl_Wavefront *w, cdl_KernelId kernel, uint32_t first, uint32_t last) {
  size_t offset, count = ranges_span(w->ranges, first, last, &offset);
  if (ranges_empty(w->ranges, first, last)) return CDL_OK;
  return device_run(w->device, kernel, &w->bindings, offset, count);
}

static cdl_Status run_all(cdl_Wavefront *w, cdl_KernelId kernel, size_t count) {
  return device_run(w->device, kernel, &w->bindings, 0, count);
}

/* --- The steps of a bounce. */

static cdl_Status trace(cdl_Wavefront *w) {
  cdl_Status status = run_all(w, CDL_KERNEL_intersect, w->wave.live);
  if (!status && w->features.opacity) status = run_all(w, CDL_KERNEL_opacity, w->wave.live);
  if (!status && w->features.media) status = run_all(w, CDL_KERNEL_sample_medium, w->wave.live);
  if (!status && w->features.grids) status = run_all(w, CDL_KERNEL_sample_grid, w->wave.live);
  return status;
}

/* Sorts the paths by queue; afterwards w->ranges says where each queue lies, and wave.live how many
 * entries there are. */
static cdl_Status sort(cdl_Wavefront *w, cdl_WaveCounts *counts) {
  size_t chunks = (w->wave.live + CDL_QUEUE_CHUNK - 1) / CDL_QUEUE_CHUNK;
  cdl_Status status = run_all(w, CDL_KERNEL_queue_count, chunks);
  if (!status) status = run_all(w, CDL_KERNEL_queue_scan, 1);
  if (!status) status = run_all(w, CDL_KERNEL_queue_scatter, chunks);
  if (!status) status = buffer_read(&w->buffers[BUFFER_ranges], 0, sizeof w->ranges, w->ranges);
  if (status) return status;
  for (uint32_t q = 0; q < CDL_QUEUE_COUNT; q++) counts->bounce_rays += w->ranges[q].count;
  counts->shadow_rays += w->ranges[CDL_QUEUE_SHADOWS].count;
  w->wave.live = w->ranges[CDL_QUEUE_ENDED].begin;
  if (w->wave.live == CDL_QUEUE_ALIGNMENT) w->wave.live = 0; /* pads alone */
  if (!w->wave.live) return CDL_OK;
  wavefront_swap_paths(w);
  return run_all(w, CDL_KERNEL_queue_move, w->wave.live);
}

static cdl_Status emit(cdl_Wavefront *w) {
  cdl_Status status = CDL_OK;
  for (uint32_t model = 0; model < CDL_MODEL_COUNT && !status; model++) {
    uint32_t queue = CDL_QUEUE_MODELS + 2 * model + 1;
    status = run_queues(w, CDL_KERNEL_emit, queue, queue);
  }
  return status;
}

/* Radiance that paths find where they are: from the sky and from emitters. */
static cdl_Status gather(cdl_Wavefront *w) {
  uint32_t last_surface = CDL_QUEUE_MEDIUM - 1;
  cdl_Status status = CDL_OK;
  if (w->features.environment)
    status = run_queues(w, CDL_KERNEL_escape, CDL_QUEUE_ESCAPED, CDL_QUEUE_ESCAPED);
  if (!status) status = run_queues(w, CDL_KERNEL_surface, CDL_QUEUE_PASS, last_surface);
  if (!status)
    status = run_queues(w, CDL_KERNEL_parameters, CDL_QUEUE_MODELS + 2 * CDL_MODEL_FIRST_PARAMETERS,
                        CDL_QUEUE_MODELS + 2 * CDL_MODEL_LAST_PARAMETERS + 1);
  if (!status && w->has_aovs)
    status = run_queues(w, CDL_KERNEL_first_hit, CDL_QUEUE_MODELS, last_surface);
  return status ? status : emit(w);
}

static cdl_Status shade_models(cdl_Wavefront *w) {
#define SHADE_KERNEL(model, name, words) [CDL_MODEL_##model] = CDL_KERNEL_shade_##name,
  static const cdl_KernelId kernels[] = {CDL_SHADED_MODELS(SHADE_KERNEL)};
#undef SHADE_KERNEL
  cdl_Status status = CDL_OK;
  for (uint32_t model = 0; model < CDL_MODEL_INTERFACE && !status; model++) {
    uint32_t queue = CDL_QUEUE_MODELS + 2 * model;
    status = run_queues(w, kernels[model], queue, queue + 1);
  }
  return status;
}

/* Light that vertices scatter: choose a light, weigh it, go on, and see whether it was visible. */
static cdl_Status scatter(cdl_Wavefront *w) {
  uint32_t first_lit = CDL_QUEUE_MODELS + 2 * CDL_MODEL_FIRST_LIT;
  uint32_t subsurface = CDL_QUEUE_MODELS + 2 * CDL_MODEL_SUBSURFACE;
  cdl_Status status = run_queues(w, CDL_KERNEL_medium_vertex, CDL_QUEUE_MEDIUM, CDL_QUEUE_MEDIUM);
  if (!status && w->has_lights)
    status = run_queues(w, CDL_KERNEL_sample_light, first_lit, CDL_QUEUE_MEDIUM);
  if (!status) status = run_queues(w, CDL_KERNEL_pass, CDL_QUEUE_PASS, CDL_QUEUE_PASS);
  if (!status) status = shade_models(w);
  if (!status) status = run_queues(w, CDL_KERNEL_probe_subsurface, subsurface, subsurface + 1);
  if (!status) status = run_queues(w, CDL_KERNEL_shade_medium, CDL_QUEUE_MEDIUM, CDL_QUEUE_MEDIUM);
  if (!status) status = run_queues(w, CDL_KERNEL_walk_subsurface, CDL_QUEUE_WALK, CDL_QUEUE_WALK);
  if (!status && w->has_lights)
    status = run_queues(w, CDL_KERNEL_occlude, first_lit, CDL_QUEUE_MEDIUM);
  return status;
}

/* --- A wave. */

static cdl_Status write_wave(cdl_Wavefront *w) {
  return buffer_write(&w->buffers[BUFFER_wave], 0, sizeof w->wave, &w->wave);
}

static cdl_Status start_paths(cdl_Wavefront *w) {
  cdl_Status status = write_wave(w);
  if (!status) status = run_all(w, CDL_KERNEL_generate, w->wave.live);
  if (!status && w->wide_camera) status = run_all(w, CDL_KERNEL_lens_medium, w->wave.live);
  if (!status && w->has_aovs) status = run_all(w, CDL_KERNEL_clear_first_hit, w->wave.live);
  return status;
}

static cdl_Status trace_paths(cdl_Wavefront *w, cdl_WaveCounts *counts) {
  cdl_Status status = start_paths(w);
  while (!status && w->wave.live) {
    status = trace(w);
    if (!status) status = sort(w, counts);
    if (status || !w->wave.live) break;
    status = gather(w);
    if (!status) status = scatter(w);
    if (!status) status = write_wave(w);
  }
  counts->camera_rays = w->wave.path_count;
  counts->bounce_rays -= w->wave.path_count;
  return status;
}

/* Counts of 32 bits last for a wave. */
static cdl_Status count_collisions(cdl_Wavefront *w, cdl_WaveCounts *counts) {
  uint32_t words[2 * CDL_COLLISION_COUNTERS];
  if (!w->features.grids) return CDL_OK;
  cdl_Status status = buffer_read(&w->buffers[BUFFER_collisions], 0, sizeof words, words);
  if (status) return status;
  for (uint32_t i = 0; i < CDL_COLLISION_COUNTERS; i++) {
    counts->real_collisions += words[2 * i];
    counts->null_collisions += words[2 * i + 1];
  }
  return buffer_fill(&w->buffers[BUFFER_collisions], 0, sizeof words, 0);
}

/* Hands the block sums of a wave to the film, row by row of the rectangle. */
static cdl_Status add_to_film(const cdl_Wavefront *w, const float *sums, cdl_Film *film) {
  const cdl_Wave *wave = &w->wave;
  size_t pixels = (size_t)wave->width * wave->height;
  uint32_t blocks = (wave->sample_count + CDL_BLOCK_SAMPLES - 1) / CDL_BLOCK_SAMPLES;
  cdl_Status status = CDL_OK;
  for (uint32_t block = 0; block < blocks && !status; block++) {
    uint32_t left = wave->sample_count - block * CDL_BLOCK_SAMPLES;
    uint32_t samples = left < CDL_BLOCK_SAMPLES ? left : CDL_BLOCK_SAMPLES;
    uint32_t index = wave->first_sample / CDL_BLOCK_SAMPLES + block;
    const float *block_sums = sums + block * wave->channels * pixels;
    for (uint32_t row = 0; row < wave->height && !status; row++) {
      uint32_t first =
          (wave->y - w->params.crop_y + row) * w->params.crop_width + wave->x - w->params.crop_x;
      status = film_add(film, index, samples, first, wave->width,
                        block_sums + (size_t)row * wave->width, pixels);
    }
  }
  return status;
}

static cdl_Status develop(cdl_Wavefront *w, cdl_Film *film, cdl_WaveCounts *counts) {
  const cdl_Wave *wave = &w->wave;
  size_t blocks = (wave->sample_count + CDL_BLOCK_SAMPLES - 1) / CDL_BLOCK_SAMPLES;
  size_t items = (size_t)wave->width * wave->height * wave->channels * blocks;
  void *sums = NULL, *bad = NULL;
  cdl_Status status = run_all(w, CDL_KERNEL_film, items);
  if (status) return status;
  status = buffer_map(&w->buffers[BUFFER_bad_samples], CL_MAP_READ, 0, items * 4, &bad);
  if (status) return status;
  for (size_t i = 0; i < items; i++) counts->bad_samples += ((const uint32_t *)bad)[i];
  status = buffer_unmap(&w->buffers[BUFFER_bad_samples], bad);
  if (!status) status = buffer_map(&w->buffers[BUFFER_sums], CL_MAP_READ, 0, items * 4, &sums);
  if (status) return status;
  status = add_to_film(w, sums, film);
  cdl_Status unmapped = buffer_unmap(&w->buffers[BUFFER_sums], sums);
  return status ? status : unmapped;
}

cdl_Status wavefront_run(cdl_Wavefront *w, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                         uint32_t first_sample, uint32_t samples, cdl_Film *film,
                         cdl_WaveCounts *counts) {
  memset(counts, 0, sizeof *counts);
  w->wave.x = x;
  w->wave.y = y;
  w->wave.width = width;
  w->wave.height = height;
  w->wave.first_sample = first_sample;
  w->wave.sample_count = samples;
  w->wave.path_count = width * height * samples;
  w->wave.live =
      (w->wave.path_count + CDL_QUEUE_ALIGNMENT - 1) / CDL_QUEUE_ALIGNMENT * CDL_QUEUE_ALIGNMENT;
  cdl_Status status = trace_paths(w, counts);
  if (!status) status = count_collisions(w, counts);
  return status ? status : develop(w, film, counts);
}
