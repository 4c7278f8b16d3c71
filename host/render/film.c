#include "render/film.h"

#include <stdlib.h>
#include <string.h>

#include "core/log.h"

uint32_t film_channels(uint32_t aovs) {
  uint32_t channels = 0;
  for (int i = 0; i < CDL_AOV_COUNT; i++)
    if (aovs & AOV_BIT(i) && aov_table[i].rule != CDL_AOV_STATISTIC)
      channels += (uint32_t)aov_table[i].channels;
  return channels;
}

cdl_Status film_create(const cdl_Log *log, uint32_t width, uint32_t height, uint32_t aovs,
                       int keep_blocks, cdl_Film **film) {
  cdl_Film *f = calloc(1, sizeof *f);
  *film = NULL;
  if (!f) goto no_memory;
  f->log = log;
  f->width = width;
  f->height = height;
  f->aovs = (aovs & AOV_ALL) | AOV_BIT(CDL_AOV_BEAUTY);
  f->channels = film_channels(f->aovs);
  f->keep_blocks = keep_blocks;
  const size_t pixels = film_pixels(f);
  f->sums = calloc(pixels * f->channels, sizeof *f->sums);
  f->squares = calloc(pixels * 3, sizeof *f->squares);
  f->samples = calloc(pixels, sizeof *f->samples);
  f->blocks = calloc(pixels, sizeof *f->blocks);
  if (!f->sums || !f->squares || !f->samples || !f->blocks) goto no_memory;
  *film = f;
  return CDL_OK;
no_memory:
  film_free(f);
  return log_fail(log, CDL_DEVICE,
                  "not enough memory for a film of %u x %u pixels; render fewer with --size or "
                  "--crop",
                  width, height);
}

void film_free(cdl_Film *film) {
  if (!film) return;
  for (uint32_t i = 0; i < film->part_count; i++) free(film->parts[i].sums);
  free(film->parts);
  free(film->sums);
  free(film->squares);
  free(film->samples);
  free(film->blocks);
  free(film);
}

/* The block kept apart, made if it is new. Waves of several blocks come back to earlier ones. */
static cdl_FilmBlock *film_part(cdl_Film *film, uint32_t block, uint32_t samples) {
  uint32_t at = film->part_count;
  while (at && film->parts[at - 1].index >= block) at--;
  if (at < film->part_count && film->parts[at].index == block) return &film->parts[at];
  cdl_FilmBlock *parts = realloc(film->parts, (film->part_count + 1) * sizeof *parts);
  if (!parts) return NULL;
  film->parts = parts;
  float *sums = calloc(film_pixels(film) * film->channels, sizeof *sums);
  if (!sums) return NULL;
  memmove(&parts[at + 1], &parts[at], (film->part_count - at) * sizeof *parts);
  parts[at] = (cdl_FilmBlock){block, samples, sums};
  film->part_count++;
  return &parts[at];
}

/* Rule CDL_AOV_FIRST_SAMPLE keeps what is there; all else is summed. */
static void add_channels(cdl_Film *film, const cdl_Aov *aov, uint32_t channel, uint32_t first,
                         uint32_t count, const float *sums, size_t stride) {
  for (uint32_t c = channel; c < channel + (uint32_t)aov->channels; c++) {
    double *to = film->sums + c * film_pixels(film) + first;
    const float *from = sums + c * stride;
    if (aov->rule == CDL_AOV_MEAN) {
      for (uint32_t i = 0; i < count; i++) to[i] += from[i];
    } else {
      for (uint32_t i = 0; i < count; i++)
        if (film->blocks[first + i] == 0) to[i] = from[i];
    }
  }
}

static void add_squares(cdl_Film *film, uint32_t samples, uint32_t first, uint32_t count,
                        const float *sums, size_t stride) {
  for (uint32_t c = 0; c < 3; c++) {
    double *to = film->squares + c * film_pixels(film) + first;
    const float *from = sums + c * stride;
    for (uint32_t i = 0; i < count; i++) to[i] += (double)from[i] * from[i] / samples;
  }
}

cdl_Status film_add(cdl_Film *film, uint32_t block, uint32_t samples, uint32_t first,
                    uint32_t count, const float *sums, size_t stride) {
  if (film->keep_blocks) {
    cdl_FilmBlock *part = film_part(film, block, samples);
    if (!part)
      return log_fail(film->log, CDL_DEVICE,
                      "not enough memory to keep block %u apart; render a smaller part with "
                      "--samples",
                      block);
    for (uint32_t c = 0; c < film->channels; c++)
      memcpy(part->sums + c * film_pixels(film) + first, sums + c * stride, count * sizeof *sums);
  }
  for (int i = 0; i < CDL_AOV_COUNT; i++) {
    const int channel = film_channel(film, i);
    if (channel >= 0)
      add_channels(film, &aov_table[i], (uint32_t)channel, first, count, sums, stride);
  }
  add_squares(film, samples, first, count, sums, stride);
  for (uint32_t i = first; i < first + count; i++) {
    film->samples[i] += samples;
    film->blocks[i]++;
  }
  return CDL_OK;
}

int film_channel(const cdl_Film *film, cdl_AovId aov) {
  if (!(film->aovs & AOV_BIT(aov)) || aov_table[aov].rule == CDL_AOV_STATISTIC) return -1;
  return (int)film_channels(film->aovs & (AOV_BIT(aov) - 1u));
}

uint32_t film_complete_parts(const cdl_Film *film) {
  uint32_t complete = film->part_count;
  const size_t pixels = film_pixels(film);
  for (size_t i = 0; i < pixels; i++)
    if (film->blocks[i] < complete) complete = film->blocks[i];
  return complete;
}

void film_sample_range(const cdl_Film *film, uint32_t *least, uint32_t *most) {
  uint32_t low = UINT32_MAX, high = 0;
  const size_t pixels = film_pixels(film);
  for (size_t i = 0; i < pixels; i++) {
    if (film->samples[i] < low) low = film->samples[i];
    if (film->samples[i] > high) high = film->samples[i];
  }
  if (least) *least = low < high ? low : high;
  if (most) *most = high;
}
