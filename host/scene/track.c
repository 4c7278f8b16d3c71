#include "scene/track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/angle.h"
#include "scene/accessor.h"

/* The key at or before `time`, which lies within the track. */
static size_t find_key(const Track *track, double time) {
  size_t low = 0, high = track->count - 1;
  while (low + 1 < high) {
    size_t middle = (low + high) / 2;
    if (track->times[middle] <= time)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Parts of a cubic key: in-tangent, value, out-tangent. */
enum { IN, VALUE, OUT };

static const float *key_value(const Track *track, size_t key, unsigned part) {
  size_t stride = track->cubic ? 3 : 1;
  return track->values + (key * stride + (track->cubic ? part : 0)) * track->width;
}

static void to_unit(double q[4]) {
  double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int i = 0; i < 4; i++) q[i] = n > 0 ? q[i] / n : i == 3;
}

/* The shorter arc. Keys of few bits are not unit. */
static void slerp(const float *from, const float *to, double t, double *out) {
  double a[4] = {from[0], from[1], from[2], from[3]}, b[4] = {to[0], to[1], to[2], to[3]};
  double d = 0, difference = 0, sum = 0, wa = 1 - t, wb = t;
  to_unit(a);
  to_unit(b);
  for (int i = 0; i < 4; i++) d += a[i] * b[i];
  for (int i = 0; i < 4; i++) {
    if (d < 0) b[i] = -b[i];
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    sum += (a[i] + b[i]) * (a[i] + b[i]);
  }
  double angle = angle_between(sqrt(difference), sqrt(sum));
  if (angle > 0) {
    wa = angle_sin((1 - t) * angle) / angle_sin(angle);
    wb = angle_sin(t * angle) / angle_sin(angle);
  }
  for (int i = 0; i < 4; i++) out[i] = wa * a[i] + wb * b[i];
}

static void hermite(const Track *track, size_t key, double t, double span, double *out) {
  const float *p0 = key_value(track, key, VALUE), *m0 = key_value(track, key, OUT);
  const float *p1 = key_value(track, key + 1, VALUE), *m1 = key_value(track, key + 1, IN);
  double t2 = t * t, t3 = t2 * t;
  for (size_t i = 0; i < track->width; i++)
    out[i] = (2 * t3 - 3 * t2 + 1) * p0[i] + (t3 - 2 * t2 + t) * span * m0[i] +
             (3 * t2 - 2 * t3) * p1[i] + (t3 - t2) * span * m1[i];
}

static void between(const Track *track, double time, int rotation, double *out) {
  size_t key = find_key(track, time);
  double span = (double)track->times[key + 1] - track->times[key];
  double t = span > 0 && !track->step ? (time - track->times[key]) / span : 0;
  const float *a = key_value(track, key, VALUE), *b = key_value(track, key + 1, VALUE);
  if (track->cubic)
    hermite(track, key, t, span, out);
  else if (rotation && !track->step)
    slerp(a, b, t, out);
  else
    for (size_t i = 0; i < track->width; i++) out[i] = a[i] + t * ((double)b[i] - a[i]);
}

void track_sample(const Track *track, double time, int rotation, double *out) {
  size_t last = track->count - 1;
  if (time <= track->times[0] || time >= track->times[last]) {
    const float *end = key_value(track, time <= track->times[0] ? 0 : last, VALUE);
    for (size_t i = 0; i < track->width; i++) out[i] = end[i];
  } else {
    between(track, time, rotation, out);
  }
  if (rotation) to_unit(out);
}

cdl_Status track_load(Document *doc, const char *at, const json_t *sampler, size_t width,
                      Track *track) {
  const char *mode = json_get_string(sampler, "interpolation", "LINEAR");
  uint32_t input = json_get_index(sampler, "input"), output = json_get_index(sampler, "output");
  const Accessor *values = &doc->accessors[output];
  *track = (Track){.count = doc->accessors[input].count,
                   .width = width,
                   .step = strcmp(mode, "STEP") == 0,
                   .cubic = strcmp(mode, "CUBICSPLINE") == 0};
  size_t wanted = track->count * (track->cubic ? 3 : 1) * width;
  if (values->count * values->width != wanted)
    return document_fail(doc, at, "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
                         "there are %zu numbers at its keys, not %zu.",
                         values->count * values->width, wanted);
  cdl_Status status = accessor_require(doc, input);
  if (!status) status = accessor_require(doc, output);
  if (status) return status;
  track->times = accessor_floats(doc, input);
  track->values = accessor_floats(doc, output);
  return track->times && track->values ? CDL_OK : document_out_of_memory(doc);
}

void track_free(Track *track) {
  free(track->times);
  free(track->values);
  *track = (Track){0};
}
