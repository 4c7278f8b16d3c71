/* film: adds up the samples of each pixel, block by block, in the order of the samples.
 *
 * One work-item a pixel, block and channel. sums[(block * channels + channel) * pixels + pixel]; a
 * channel is a SLOT field, added as a float or, for ids, the first sample's taken as it is. A
 * sample that is not finite counts as black, and is counted. */
#include "lib/portable.h"

#include "abi/film.h"
#include "abi/params.h"
#include "lib/state.h"

CDL_INLINE int is_finite(uint bits) { return (bits & 0x7f800000u) != 0x7f800000u; }

__kernel void film(CDL_CONSTANT cdl_Wave *restrict wave,
                   CDL_GLOBAL const cdl_FilmChannel *film_channels, CDL_GLOBAL const uint *slots,
                   CDL_GLOBAL uint *sums, CDL_GLOBAL uint *bad_samples) {
  uint pixels = wave->width * wave->height;
  uint channels = wave->channels;
  uint blocks = (wave->sample_count + CDL_BLOCK_SAMPLES - 1u) / CDL_BLOCK_SAMPLES;
  uint item = (uint)get_global_id(0);
  if (item >= pixels * channels * blocks) return;
  uint pixel = item % pixels;
  uint channel = item / pixels % channels;
  uint block = item / pixels / channels;
  cdl_FilmChannel rule = film_channels[channel];
  uint begin = block * CDL_BLOCK_SAMPLES;
  uint end = begin + CDL_BLOCK_SAMPLES;
  end = end < wave->sample_count ? end : wave->sample_count;
  float sum = 0.0f;
  uint bad = 0u;
  for (uint sample = begin; sample < end; sample++) {
    uint bits = state_uint(slots, rule.field, wave->slots, sample * pixels + pixel);
    sum += is_finite(bits) ? as_float(bits) : 0.0f;
    bad += is_finite(bits) ? 0u : 1u;
  }
  uint first = state_uint(slots, rule.field, wave->slots, begin * pixels + pixel);
  sums[item] = rule.first_only ? first : as_uint(sum);
  bad_samples[item] = rule.first_only ? 0u : bad;
}
