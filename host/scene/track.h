/* track.h: an animation sampler, and its value at a point in time. */
#ifndef CANDELA_SCENE_TRACK_H
#define CANDELA_SCENE_TRACK_H

#include "scene/document.h"

/* Keys of `width` numbers each. Times ascend; cubic keys hold in-tangent, value, out-tangent. */
typedef struct Track {
  float *times, *values;
  size_t count;
  size_t width;
  int step, cubic;
} Track;

/* Reads a checked sampler whose keys have `width` numbers; `at` names the channel in failures. Call
 * track_free() in any case. */
cdl_Status track_load(Document *doc, const char *at, const json_t *sampler, size_t width,
                      Track *track);

/* The value at `time`, s: that of the first or last key before and after them (glTF 2.0, appendix
 * C). A `rotation` is a quaternion and comes out with length 1. */
void track_sample(const Track *track, double time, int rotation, double *out);

void track_free(Track *track);

#endif
