#include "scene/meshopt_filter.h"

#include <math.h>
#include <string.h>

/* The nearest integer, halves away from zero. */
static float nearest(float x, float least, float most) {
  return roundf(fminf(fmaxf(x, least), most));
}

/* --- Octahedra: a point of the plane to a direction, of length `most`. */

static void octahedral(const float in[3], float most, float out[3]) {
  float one = in[2] > 0 ? in[2] : 1, x = in[0] / one, y = in[1] / one;
  float z = 1 - fabsf(x) - fabsf(y), fold = fminf(z, 0);
  x -= copysignf(fold, x);
  y -= copysignf(fold, y);
  float length = sqrtf(x * x + y * y + z * z);
  out[0] = nearest(x / length * most, -most, most);
  out[1] = nearest(y / length * most, -most, most);
  out[2] = nearest(z / length * most, -most, most);
}

static void octahedral_bytes(uint8_t *p) {
  float out[3], in[3] = {(int8_t)p[0], (int8_t)p[1], (int8_t)p[2]};
  octahedral(in, 127, out);
  for (int c = 0; c < 3; c++) p[c] = (uint8_t)(int8_t)out[c];
}

static void octahedral_shorts(uint8_t *p) {
  int16_t v[3];
  memcpy(v, p, sizeof v);
  float out[3], in[3] = {v[0], v[1], v[2]};
  octahedral(in, 32767, out);
  for (int c = 0; c < 3; c++) v[c] = (int16_t)out[c];
  memcpy(p, v, sizeof v);
}

void meshopt_octahedral(uint8_t *data, size_t count, size_t stride) {
  for (size_t i = 0; i < count; i++)
    (stride == 4 ? octahedral_bytes : octahedral_shorts)(data + i * stride);
}

/* --- Quaternions: the three smaller components are at most sqrt(1/2). */

void meshopt_quaternions(uint8_t *data, size_t count) {
  const float range = 0.707106781f;
  for (size_t i = 0; i < count; i++) {
    int16_t v[4];
    memcpy(v, data + 8 * i, sizeof v);
    int largest = v[3] & 3;
    float one = (float)(v[3] | 3), q[4]; /* odd: not 0 */
    for (int c = 0; c < 3; c++) q[c + 1] = (float)v[c] / one * range;
    q[0] = sqrtf(fmaxf(0, 1 - q[1] * q[1] - q[2] * q[2] - q[3] * q[3]));
    for (int c = 0; c < 4; c++)
      v[(largest + c) % 4] = (int16_t)nearest(q[c] * 32767, -32767, 32767);
    memcpy(data + 8 * i, v, sizeof v);
  }
}

/* --- Exponents. */

void meshopt_exponential(uint8_t *data, size_t count, size_t stride) {
  for (size_t i = 0; i < count * stride; i += 4) {
    int32_t mantissa = data[i] | data[i + 1] << 8 | (int8_t)data[i + 2] * 65536;
    float value = ldexpf((float)mantissa, (int8_t)data[i + 3]);
    memcpy(data + i, &value, 4);
  }
}

/* --- Colours, in as many bits as the highest one set in the fourth component says. */

static void color(int32_t y, int32_t co, int32_t cg, uint32_t alpha, float most, float out[4]) {
  uint32_t scale = 1;
  while (scale < alpha) scale = scale << 1 | 1;
  uint32_t a = alpha & scale >> 1;
  float to = most / (float)scale;
  out[0] = nearest((float)(y + co - cg) * to, 0, most);
  out[1] = nearest((float)(y + cg) * to, 0, most);
  out[2] = nearest((float)(y - co - cg) * to, 0, most);
  out[3] = nearest((float)(a << 1 | (a & 1)) * to, 0, most);
}

void meshopt_colors(uint8_t *data, size_t count, size_t stride) {
  float rgba[4];
  for (size_t i = 0; i < count; i++) {
    uint8_t *p = data + i * stride;
    uint16_t v[4];
    if (stride == 4) {
      color(p[0], (int8_t)p[1], (int8_t)p[2], p[3], 255, rgba);
      for (int c = 0; c < 4; c++) p[c] = (uint8_t)rgba[c];
      continue;
    }
    memcpy(v, p, 8);
    color(v[0], (int16_t)v[1], (int16_t)v[2], v[3], 65535, rgba);
    for (int c = 0; c < 4; c++) v[c] = (uint16_t)rgba[c];
    memcpy(p, v, 8);
  }
}
