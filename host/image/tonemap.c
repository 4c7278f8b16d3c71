#include "image/tonemap.h"

#include <math.h>
#include <string.h>

#include "core/log.h"

/* Far above any radiance that a curve tells from white, and its square is still finite. */
#define BRIGHTEST 1e9f

static const char *const tonemap_names[] = {"none", "aces", "agx", "neutral"};

cdl_Status tonemap_parse(const cdl_Log *log, const char *name, cdl_ToneMap *tonemap) {
  for (int i = 0; i < 4; i++) {
    if (strcmp(name, tonemap_names[i]) != 0) continue;
    *tonemap = (cdl_ToneMap)i;
    return CDL_OK;
  }
  return log_fail(log, CDL_USAGE, "no tone map is called '%s'; there are none, aces, agx, neutral",
                  name);
}

static float clip(float x, float low, float high) { return fminf(fmaxf(x, low), high); }

static void multiply(const float matrix[3][3], float rgb[3]) {
  const float r = rgb[0], g = rgb[1], b = rgb[2];
  for (int i = 0; i < 3; i++) rgb[i] = matrix[i][0] * r + matrix[i][1] * g + matrix[i][2] * b;
}

/* Stephen Hill's fit of the ACES 1.0 reference rendering transform with the sRGB output transform
 * (MJP and Hill, "BakingLab", ACES.hlsl): into a desaturated AP1, one rational curve, and back. */
static void map_aces(float rgb[3]) {
  static const float in[3][3] = {{0.59719f, 0.35458f, 0.04823f},
                                 {0.07600f, 0.90834f, 0.01566f},
                                 {0.02840f, 0.13383f, 0.83777f}};
  static const float out[3][3] = {{1.60475f, -0.53108f, -0.07367f},
                                  {-0.10208f, 1.10813f, -0.00605f},
                                  {-0.00327f, -0.07276f, 1.07602f}};
  multiply(in, rgb);
  for (int i = 0; i < 3; i++) {
    const float x = rgb[i];
    rgb[i] = (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
  }
  multiply(out, rgb);
}

/* AgX's sigmoid (Sobotka, "AgX", 2022): through (0,0), the pivot and (1,1) with slope 2 at the
 * pivot, where middle grey lies. Each side is x / (1 + x^p)^(1/p), scaled so that it ends exactly
 * in its corner. */
static float agx_sigmoid(float x) {
  const double power = 3.0, slope = 2.0, pivot_x = 10.0 / 16.5, pivot_y = 0.5;
  const double sign = x < pivot_x ? -1.0 : 1.0;
  const double room_x = x < pivot_x ? pivot_x : 1.0 - pivot_x;
  const double run = slope * room_x, room_y = x < pivot_x ? pivot_y : 1.0 - pivot_y;
  const double scale = pow(pow(run, -power) * (pow(run / room_y, power) - 1.0), -1.0 / power);
  const double t = slope * fabs((double)x - pivot_x) / scale;
  return (float)(pivot_y + sign * scale * t / pow(1.0 + pow(t, power), 1.0 / power));
}

/* AgX: inset of the primaries, so that bright colours go to white, log2 over 10 stops below and 6.5
 * above middle grey, the sigmoid, and the outset. Matrices: Wrensch, "Minimal AgX Implementation",
 * 2023, for Rec. 709 primaries. The result is encoded with a power of 2.2, undone at the end. */
static void map_agx(float rgb[3]) {
  static const float inset[3][3] = {{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
                                    {0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
                                    {0.0423756549057051f, 0.0784336f, 0.879142973793104f}};
  static const float outset[3][3] = {
      {1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f},
      {-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f},
      {-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f}};
  const float low = -12.473931f, high = 4.026069f; /* log2(0.18) - 10 and + 6.5 */
  multiply(inset, rgb);
  for (int i = 0; i < 3; i++)
    rgb[i] = agx_sigmoid(clip((log2f(fmaxf(rgb[i], 1e-10f)) - low) / (high - low), 0.0f, 1.0f));
  multiply(outset, rgb);
  for (int i = 0; i < 3; i++) rgb[i] = powf(clip(rgb[i], 0.0f, 1.0f), 2.2f);
}

/* Khronos PBR Neutral, as its specification of 2024 has it: base colours below 0.8 pass but for the
 * Fresnel reflection (F90 = 0.04) that is taken off; the rest is compressed and desaturated. */
static void map_neutral(float rgb[3]) {
  const float f90 = 0.04f, start = 0.8f - f90, desaturation = 0.15f, room = 1.0f - start;
  const float x = fminf(rgb[0], fminf(rgb[1], rgb[2]));
  const float offset = x <= 2.0f * f90 ? x - x * x / (4.0f * f90) : f90;
  for (int i = 0; i < 3; i++) rgb[i] -= offset;
  const float peak = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
  if (peak <= start) return;
  const float new_peak = 1.0f - room * room / (peak + room - start);
  const float keep = 1.0f / (desaturation * (peak - new_peak) + 1.0f);
  for (int i = 0; i < 3; i++) rgb[i] = keep * rgb[i] * (new_peak / peak) + (1.0f - keep) * new_peak;
}

void tonemap_apply(const cdl_ToneSettings *settings, float rgb[3]) {
  const float scale = exp2f(settings->exposure);
  for (int i = 0; i < 3; i++) rgb[i] = isnan(rgb[i]) ? 0.0f : clip(rgb[i] * scale, 0.0f, BRIGHTEST);
  switch (settings->tonemap) {
  case CDL_TONEMAP_NONE:
    break;
  case CDL_TONEMAP_ACES:
    map_aces(rgb);
    break;
  case CDL_TONEMAP_AGX:
    map_agx(rgb);
    break;
  case CDL_TONEMAP_NEUTRAL:
    map_neutral(rgb);
    break;
  }
  for (int i = 0; i < 3; i++) rgb[i] = clip(rgb[i], 0.0f, 1.0f);
}

float tonemap_srgb_encode(float linear) {
  if (linear <= 0.0031308f) return 12.92f * linear;
  return 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
}

float tonemap_srgb_decode(float encoded) {
  if (encoded <= 0.04045f) return encoded / 12.92f;
  return powf((encoded + 0.055f) / 1.055f, 2.4f);
}

void tonemap_to_srgb8(const cdl_ToneSettings *settings, const float *rgb, size_t pixels,
                      uint8_t *out) {
  for (size_t i = 0; i < pixels; i++) {
    float colour[3] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]};
    tonemap_apply(settings, colour);
    for (int c = 0; c < 3; c++)
      out[3 * i + (size_t)c] = (uint8_t)lrintf(255.0f * tonemap_srgb_encode(colour[c]));
  }
}
