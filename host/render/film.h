/* film.h: what a render accumulates: for every pixel and channel the sum of its blocks' sums.
 *
 * A block is 16 samples, added in sample order on the device; blocks are added in block order, in
 * double, here. So the film does not depend on who rendered which block. */
#ifndef CANDELA_RENDER_FILM_H
#define CANDELA_RENDER_FILM_H

#include <stddef.h>
#include <stdint.h>

#include "candela.h"
#include "image/aov.h"

/* One block of samples of a whole crop, kept apart so that parts can be merged in block order:
 * channels x height x width floats, and the samples that each pixel has in it. */
typedef struct cdl_FilmBlock {
  uint32_t index;   /* block number: first sample / 16 */
  uint32_t samples; /* 1 to 16 */
  float *sums;      /* channel-major */
} cdl_FilmBlock;

typedef struct cdl_Film {
  uint32_t width, height; /* of the crop */
  uint32_t channels;      /* 3 for beauty, and those of the AOVs in the order of aov.h */
  uint32_t aovs;          /* bit i: entry i of the table in aov.h */
  double *sums;           /* channel-major: channels x height x width */
  double *squares;        /* 3 x height x width: sum over blocks of (block mean)^2 x block samples */
  uint32_t *samples;      /* height x width: samples so far */
  uint32_t *blocks;       /* height x width: blocks so far */
  cdl_FilmBlock *parts;   /* blocks kept apart; NULL unless keep_blocks */
  uint32_t part_count;
  int keep_blocks;
} cdl_Film;

cdl_Status film_create(const cdl_Log *log, uint32_t width, uint32_t height, uint32_t aovs,
                       int keep_blocks, cdl_Film **film);

/* Adds one block's sums for the pixels first .. first + count - 1 (row by row): `sums` holds
 * channels x stride floats, the pixel's at [channel * stride + i]. */
void film_add(cdl_Film *film, uint32_t block, uint32_t samples, uint32_t first, uint32_t count,
              const float *sums, size_t stride);

/* The mean radiance, RGB interleaved, row by row from the top left: width x height x 3 floats that the
 * caller frees. NULL if there is no memory. */
float *film_resolve(const cdl_Film *film);

/* The layer of one AOV: its channels interleaved; the caller frees. Means for averaged ones. */
float *film_resolve_aov(const cdl_Film *film, unsigned aov);

/* SHA-256 of film_resolve(), little-endian, as 64 hexadecimal digits. */
cdl_Status film_sha256(const cdl_Film *film, char digest[65]);

/* Median over pixels of the relative standard error of the mean luminance; infinite below two blocks. */
double film_noise(const cdl_Film *film);

void film_free(cdl_Film *film);

#endif
