/* From sums to pictures and figures. */
#include "render/film.h"

#include <endian.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "core/log.h"

/* One rounding from the exact quotient's double: the same on every host. */
static void resolve_means(const cdl_Film *film, uint32_t channel, int channels, float *out) {
  const size_t pixels = film_pixels(film);
  for (int c = 0; c < channels; c++) {
    const double *sums = film->sums + (channel + (uint32_t)c) * pixels;
    for (size_t i = 0; i < pixels; i++)
      out[i * (size_t)channels + (size_t)c] =
          film->samples[i] ? (float)(sums[i] / film->samples[i]) : 0.0f;
  }
}

static void resolve_first(const cdl_Film *film, uint32_t channel, const cdl_Aov *aov, void *out) {
  const size_t pixels = film_pixels(film), channels = (size_t)aov->channels;
  for (size_t c = 0; c < channels; c++) {
    const double *values = film->sums + (channel + c) * pixels;
    for (size_t i = 0; i < pixels; i++) {
      if (aov->type == CDL_CHANNEL_UINT)
        ((uint32_t *)out)[i * channels + c] = (uint32_t)values[i];
      else
        ((float *)out)[i * channels + c] = (float)values[i];
    }
  }
}

/* Variance of the mean of one pixel and channel. With B blocks of n_b samples and means m_b, N
 * samples and mean m, the expectation of sum n_b m_b^2 - N m^2 is (B - 1) times a sample's
 * variance, as far as blocks are independent. Infinite below two blocks. */
static double variance_of_mean(const cdl_Film *film, int channel, size_t pixel) {
  const size_t at = (size_t)channel * film_pixels(film) + pixel;
  if (film->blocks[pixel] < 2) return INFINITY;
  const double samples = film->samples[pixel];
  const double excess = film->squares[at] - film->sums[at] * film->sums[at] / samples;
  return fmax(excess, 0.0) / (film->blocks[pixel] - 1) / samples;
}

static void resolve_variance(const cdl_Film *film, float *out) {
  const size_t pixels = film_pixels(film);
  for (size_t i = 0; i < pixels; i++)
    for (int c = 0; c < 3; c++) out[i * 3 + (size_t)c] = (float)variance_of_mean(film, c, i);
}

float *film_resolve(const cdl_Film *film) { return film_resolve_aov(film, CDL_AOV_BEAUTY); }

void *film_resolve_aov(const cdl_Film *film, cdl_AovId aov) {
  const cdl_Aov *entry = &aov_table[aov];
  const size_t pixels = film_pixels(film);
  const int channel = film_channel(film, aov);
  if (!(film->aovs & AOV_BIT(aov))) return NULL;
  void *out = malloc(pixels * (size_t)entry->channels * 4); /* floats or uint32_t */
  if (!out) return NULL;
  if (aov == CDL_AOV_SAMPLES) memcpy(out, film->samples, pixels * sizeof *film->samples);
  if (aov == CDL_AOV_VARIANCE) resolve_variance(film, out);
  if (entry->rule == CDL_AOV_MEAN) resolve_means(film, (uint32_t)channel, entry->channels, out);
  if (entry->rule == CDL_AOV_FIRST_SAMPLE) resolve_first(film, (uint32_t)channel, entry, out);
  return out;
}

cdl_Status film_sha256(const cdl_Film *film, char digest[65]) {
  const size_t count = film_pixels(film) * 3;
  float *rgb = film_resolve(film);
  if (!rgb) return log_fail(film->log, CDL_DEVICE, "not enough memory to hash the film");
  for (size_t i = 0; i < count; i++) {
    uint32_t word;
    memcpy(&word, &rgb[i], sizeof word);
    word = htole32(word);
    memcpy(&rgb[i], &word, sizeof word);
  }
  struct sha256_ctx hash;
  sha256_init(&hash);
  sha256_update(&hash, count * sizeof *rgb, (const uint8_t *)rgb);
  hash_hex(&hash, digest);
  free(rgb);
  return CDL_OK;
}

/* Negative for a pixel that is black so far: its light has not been found yet, or there is none. */
static float relative_error(const cdl_Film *film, size_t pixel) {
  static const double luminance[3] = {0.2126, 0.7152, 0.0722}; /* Rec. 709 */
  const size_t pixels = film_pixels(film);
  double mean = 0, error = 0;
  for (int c = 0; c < 3; c++) {
    mean += luminance[c] * film->sums[(size_t)c * pixels + pixel];
    error += luminance[c] * sqrt(variance_of_mean(film, c, pixel));
  }
  return mean > 0 ? (float)(error * film->samples[pixel] / mean) : -1;
}

/* The value of rank `rank`, by Hoare's selection; `values` is reordered. */
static float select_rank(float *values, size_t count, size_t rank) {
  size_t low = 0, high = count - 1;
  while (low < high) {
    const float pivot = values[low + (high - low) / 2];
    size_t i = low, j = high;
    for (;;) {
      while (values[i] < pivot) i++;
      while (values[j] > pivot) j--;
      if (i >= j) break;
      const float swap = values[i];
      values[i++] = values[j];
      values[j--] = swap;
    }
    if (rank <= j)
      high = j;
    else
      low = j + 1;
  }
  return values[rank];
}

double film_noise(const cdl_Film *film) {
  const size_t pixels = film_pixels(film);
  float *errors = pixels ? malloc(pixels * sizeof *errors) : NULL;
  if (!errors) return INFINITY;
  size_t ranked = 0;
  for (size_t i = 0; i < pixels; i++) {
    const float error = relative_error(film, i);
    if (error >= 0) errors[ranked++] = error;
  }
  const double median = ranked ? select_rank(errors, ranked, ranked / 2) : INFINITY;
  free(errors);
  return median;
}
