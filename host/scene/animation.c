/* animation.c: node transforms at a point in time (glTF 2.0, section 3.11 and appendix C). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/build.h"

typedef struct Track {
  const float *times, *values;
  size_t count;
  unsigned width;
  int step, cubic;
} Track;

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

/* The value of a key: cubic tracks hold in-tangent, value and out-tangent. */
static const float *key_value(const Track *track, size_t key, unsigned part) {
  size_t stride = track->cubic ? 3 : 1;
  return track->values + (key * stride + (track->cubic ? part : 0)) * track->width;
}

static void slerp(const float *a, const float *b, double t, double *out) {
  double d = 0, wa = 1 - t, wb = t;
  for (int i = 0; i < 4; i++) d += (double)a[i] * b[i];
  double sign = d < 0 ? -1 : 1, angle = acos(fmin(1, fabs(d)));
  if (angle > 1e-6) {
    wa = sin((1 - t) * angle) / sin(angle);
    wb = sin(t * angle) / sin(angle);
  }
  for (int i = 0; i < 4; i++) out[i] = wa * a[i] + sign * wb * b[i];
}

static void hermite(const Track *track, size_t key, double t, double span, double *out) {
  const float *p0 = key_value(track, key, 1), *m0 = key_value(track, key, 2);
  const float *p1 = key_value(track, key + 1, 1), *m1 = key_value(track, key + 1, 0);
  double t2 = t * t, t3 = t2 * t;
  for (unsigned i = 0; i < track->width; i++)
    out[i] = (2 * t3 - 3 * t2 + 1) * p0[i] + (t3 - 2 * t2 + t) * span * m0[i] +
             (3 * t2 - 2 * t3) * p1[i] + (t3 - t2) * span * m1[i];
}

static void sample(const Track *track, double time, double *out) {
  size_t last = track->count - 1;
  if (time <= track->times[0] || time >= track->times[last]) {
    const float *end = key_value(track, time <= track->times[0] ? 0 : last, 1);
    for (unsigned i = 0; i < track->width; i++) out[i] = end[i];
    return;
  }
  size_t key = find_key(track, time);
  double span = (double)track->times[key + 1] - track->times[key];
  double t = span > 0 ? (time - track->times[key]) / span : 0;
  const float *a = key_value(track, key, 1), *b = key_value(track, key + 1, 1);
  if (track->step) t = 0;
  if (track->cubic)
    hermite(track, key, t, span, out);
  else if (track->width == 4)
    slerp(a, b, t, out);
  else
    for (unsigned i = 0; i < track->width; i++) out[i] = (1 - t) * a[i] + t * b[i];
}

/* Where in a node's ten numbers a path lies. */
static int path_slot(const char *path, unsigned *width) {
  *width = strcmp(path, "rotation") == 0 ? 4 : 3;
  return strcmp(path, "translation") == 0 ? 0
         : strcmp(path, "rotation") == 0  ? 3
         : strcmp(path, "scale") == 0     ? 7
                                          : -1;
}

static cdl_Status apply_channel(Builder *builder, const json_t *animation, const json_t *channel,
                                double *trs, uint8_t *moved) {
  const json_t *target = json_object_get(channel, "target");
  const json_t *sampler =
      json_array_get(json_object_get(animation, "samplers"), json_get_index(channel, "sampler"));
  const char *mode = json_get_string(sampler, "interpolation", "LINEAR");
  uint32_t node = json_get_index(target, "node"), input = json_get_index(sampler, "input");
  uint32_t output = json_get_index(sampler, "output");
  Track track = {.count = builder->doc->accessors[input].count,
                 .step = strcmp(mode, "STEP") == 0,
                 .cubic = strcmp(mode, "CUBICSPLINE") == 0};
  int slot = path_slot(json_get_string(target, "path", ""), &track.width);
  if (node == DOCUMENT_NONE || slot < 0) {
    document_note(builder->doc, "animation path", "/animations",
                  "animations other than of translation, rotation and scale are not supported.");
    return CDL_OK;
  }
  cdl_Status status = accessor_require(builder->doc, input);
  if (!status) status = accessor_require(builder->doc, output);
  if (status) return status;
  float *times = accessor_floats(builder->doc, input);
  float *values = accessor_floats(builder->doc, output);
  track.times = times;
  track.values = values;
  if (times && values) sample(&track, builder->time, trs + 10 * (size_t)node + slot);
  moved[node] = 1;
  if (!times || !values) status = document_out_of_memory(builder->doc);
  free(times);
  free(values);
  return status;
}

cdl_Status animate_nodes(Builder *builder, double *trs, uint8_t *moved) {
  const json_t *animations = json_object_get(builder->doc->root, "animations");
  const json_t *first = json_array_get(animations, 0);
  const json_t *channels = json_object_get(first, "channels");
  cdl_Status status = CDL_OK;
  if (json_array_size(animations) > 1)
    document_note(builder->doc, NULL, "/animations", "of several animations the first is shown.");
  for (size_t i = 0; i < json_array_size(channels) && !status; i++)
    status = apply_channel(builder, first, json_array_get(channels, i), trs, moved);
  return status;
}
