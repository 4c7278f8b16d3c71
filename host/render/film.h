/* film.h: what a render accumulates: for every pixel and channel the sum of its blocks' sums.
 *
 * A block is 16 samples, added in sample order on the device; blocks are added in block order, in
 * double, here. So the film does not depend on who rendered which block.
 *
 * AOVs whose rule is CDL_AOV_FIRST_SAMPLE are not summed: a block holds the value of its first
 * sample, and the film keeps that of the pixel's first block. Ids are kept as float values, exact
 * below 2^24. AOVs of rule CDL_AOV_STATISTIC have no channels: they come from the other members. */
#ifndef CANDELA_RENDER_FILM_H
#define CANDELA_RENDER_FILM_H

#include <stddef.h>
#include <stdint.h>

#include "candela.h"
#include "image/aov.h"

enum { CDL_FILM_BLOCK = 16 }; /* samples in a block; fewer only in the last one */

/* One block of samples of a whole crop, kept apart so that parts can be merged in block order. It
 * is complete when each pixel has it. */
typedef struct cdl_FilmBlock {
  uint32_t index;   /* block number: first sample / 16 */
  uint32_t samples; /* 1 to 16 */
  float *sums;      /* channel-major: channels x height x width */
} cdl_FilmBlock;

typedef struct cdl_Film {
  const cdl_Log *log;
  uint32_t width, height; /* of the crop */
  uint32_t channels;      /* 3 for beauty, and those of the AOVs in the order of aov.h */
  uint32_t aovs;          /* bit i: entry i of the table in aov.h; beauty is always there */
  double *sums;           /* channel-major: channels x height x width */
  double *squares;      /* 3 x height x width: sum over blocks of (block mean)^2 x block samples */
  uint32_t *samples;    /* height x width: samples so far */
  uint32_t *blocks;     /* height x width: blocks so far */
  cdl_FilmBlock *parts; /* blocks kept apart, in block order; NULL unless keep_blocks */
  uint32_t part_count;
  int keep_blocks;
} cdl_Film;

static inline size_t film_pixels(const cdl_Film *film) {
  return (size_t)film->width * film->height;
}

/* Channels of `sums` that these AOVs take. */
uint32_t film_channels(uint32_t aovs);

/* `aovs` as in cdl_Settings. The film keeps `log`. CDL_DEVICE if memory is short. */
cdl_Status film_create(const cdl_Log *log, uint32_t width, uint32_t height, uint32_t aovs,
                       int keep_blocks, cdl_Film **film);

/* Adds one block's sums for the pixels first .. first + count - 1 (row by row): `sums` holds
 * channels x stride floats, the pixel's at [channel * stride + i]. Each pixel's blocks must come in
 * block order, each with the same number of samples for all pixels. Without keep_blocks it cannot
 * fail; with it, CDL_DEVICE if memory is short, and nothing is added. */
cdl_Status film_add(cdl_Film *film, uint32_t block, uint32_t samples, uint32_t first,
                    uint32_t count, const float *sums, size_t stride);

/* The first of an AOV's channels in `sums`; -1 if it has none there. */
int film_channel(const cdl_Film *film, cdl_AovId aov);

/* Parts that every pixel has, a prefix of `parts`. */
uint32_t film_complete_parts(const cdl_Film *film);

/* The fewest and the most samples of a pixel. Pointers may be NULL. */
void film_sample_range(const cdl_Film *film, uint32_t *least, uint32_t *most);

/* The mean radiance, RGB interleaved, row by row from the top left: width x height x 3 floats that
 * the caller frees. NULL if there is no memory. A pixel without samples is black. */
float *film_resolve(const cdl_Film *film);

/* The layer of one AOV: its channels interleaved; the caller frees. Means for averaged ones; ids
 * and counts as uint32_t, the rest as float. NULL if there is no memory or the film lacks it. */
void *film_resolve_aov(const cdl_Film *film, cdl_AovId aov);

/* SHA-256 of film_resolve(), little-endian, as 64 hexadecimal digits. CDL_DEVICE: no memory. */
cdl_Status film_sha256(const cdl_Film *film, char digest[65]);

/* Median of the relative standard error of the mean luminance over the pixels that are not black so
 * far; infinite below two blocks, and while all are black. The error of a luminance is bounded by
 * that of fully correlated channels. */
double film_noise(const cdl_Film *film);

void film_free(cdl_Film *film); /* NULL is nothing */

#endif
