/* environment.h: light from infinity, a latitude-longitude map.
 *
 * u = 1/2 + atan2(z, x) / 2 pi, v = acos(y) / pi: the centre column lies towards +X, the top row is
 * +Y. Sampling chooses a cell of a grid of equal angles by the alias method, in proportion to the
 * light that comes from it, and a direction in it uniformly by solid angle. */
#ifndef CDL_LIGHT_ENVIRONMENT_H
#define CDL_LIGHT_ENVIRONMENT_H

#include "abi/light.h"
#include "abi/params.h"
#include "lib/math.h"
#include "lib/sampling.h"
#include "light/light_sample.h"
#include "light/select.h"

CDL_INLINE vec3 environment_to_map(CDL_CONSTANT cdl_EnvironmentParams *env, vec3 d) {
  return v3(env->rotation_cos * d.x - env->rotation_sin * d.z, d.y,
            env->rotation_sin * d.x + env->rotation_cos * d.z);
}

CDL_INLINE vec3 environment_from_map(CDL_CONSTANT cdl_EnvironmentParams *env, vec3 d) {
  return v3(env->rotation_cos * d.x + env->rotation_sin * d.z, d.y,
            env->rotation_cos * d.z - env->rotation_sin * d.x);
}

/* Coordinates in [0,1] of a unit direction. */
CDL_INLINE void environment_uv(CDL_CONSTANT cdl_EnvironmentParams *env, vec3 direction, float *u,
                               float *v) {
  vec3 d = environment_to_map(env, direction);
  *u = 0.5f + math_atan2(d.z, d.x) * CDL_INV_2PI;
  *v = math_acos(math_clamp(d.y, -1.0f, 1.0f)) * CDL_INV_PI;
}

/* An index brought into 0 … n - 1, whatever it came from: a direction that is not a number must not
 * read beyond the map. */
CDL_INLINE int environment_index(int i, int n) {
  int below = i < n ? i : n - 1;
  return below > 0 ? below : 0;
}

CDL_INLINE vec3 environment_texel(CDL_GLOBAL const float *texels, uint width, int x, int y) {
  size_t first = 4u * ((size_t)((uint)y * width + (uint)x));
  return v3(texels[first], texels[first + 1], texels[first + 2]);
}

CDL_INLINE vec3 environment_lerp(vec3 a, vec3 b, float t) {
  float x = math_lerp(a.x, b.x, t);
  float y = math_lerp(a.y, b.y, math_after(x, t));
  return v3(x, y, math_lerp(a.z, b.z, math_after(y, t)));
}

/* Radiance from a direction: bilinear, around the corner sideways, constant beyond first and last
 * row. */
CDL_INLINE vec3 environment_radiance(CDL_CONSTANT cdl_EnvironmentParams *env,
                                     CDL_GLOBAL const float *texels, vec3 direction) {
  float u, v;
  environment_uv(env, direction, &u, &v);
  int width = (int)env->width;
  int height = (int)env->height;
  float x = u * (float)width - 0.5f;
  float y = math_after(x, v) * (float)height - 0.5f;
  float x_floor = floor(x);
  float y_floor = floor(y);
  int x0 = (int)x_floor;
  int x1 = x0 + 1;
  int y0 = (int)y_floor;
  int y1 = y0 + 1;
  x0 = x0 < 0 ? x0 + width : x0;
  x1 = x1 >= width ? x1 - width : x1;
  x0 = environment_index(x0, width);
  x1 = environment_index(x1, width);
  y0 = environment_index(y0, height);
  y1 = environment_index(y1, height);
  vec3 top = environment_lerp(environment_texel(texels, env->width, x0, y0),
                              environment_texel(texels, env->width, x1, y0), x - x_floor);
  vec3 bottom = environment_lerp(environment_texel(texels, env->width, x0, y1),
                                 environment_texel(texels, env->width, x1, y1), x - x_floor);
  vec3 radiance = environment_lerp(top, bottom, y - y_floor);
  return v3_mul(radiance, v3(env->scale[0], env->scale[1], env->scale[2]));
}

/* Cosine of the polar angle at the upper edge of a row of cells. */
CDL_INLINE float environment_row_cosine(CDL_CONSTANT cdl_EnvironmentParams *env, int row) {
  float sine, cosine;
  math_sincos_2pi(0.5f * (float)row / (float)(int)env->rows, &sine, &cosine);
  return cosine;
}

/* Difference of the cosines at a row's edges, as 2 sin sin: near the poles the cosines cancel. */
CDL_INLINE float environment_row_height(CDL_CONSTANT cdl_EnvironmentParams *env, int row) {
  float rows = (float)(int)env->rows;
  float middle, half_row, cosine;
  math_sincos_2pi(((float)row + 0.5f) / (2.0f * rows), &middle, &cosine);
  math_sincos_2pi(0.25f / math_after(middle, rows), &half_row, &cosine);
  return 2.0f * middle * half_row;
}

/* Density by solid angle of every direction in a cell of this row; choice of the light included. */
CDL_INLINE float environment_cell_pdf(CDL_CONSTANT cdl_EnvironmentParams *env, float probability,
                                      float height) {
  float solid_angle = 2.0f * CDL_PI / (float)(int)env->columns * height;
  return env->select_pdf * probability / solid_angle;
}

CDL_INLINE float environment_pdf(CDL_CONSTANT cdl_EnvironmentParams *env,
                                 CDL_GLOBAL const cdl_AliasEntry *cells, vec3 direction) {
  float u, v;
  environment_uv(env, direction, &u, &v);
  int columns = (int)env->columns;
  int rows = (int)env->rows;
  int column = (int)(u * (float)columns);
  int row = (int)(v * (float)rows);
  column = environment_index(column, columns);
  row = environment_index(row, rows);
  float height = environment_row_height(env, row);
  return environment_cell_pdf(env, cells[(uint)(row * columns + column)].pdf, height);
}

/* `bits` and v choose the cell, s and t the point in it. */
CDL_INLINE LightSample environment_sample(CDL_CONSTANT cdl_EnvironmentParams *env,
                                          CDL_GLOBAL const float *texels,
                                          CDL_GLOBAL const cdl_AliasEntry *cells, uint bits,
                                          float v, float s, float t) {
  int columns = (int)env->columns;
  int cell = (int)alias_pick(cells, env->columns * env->rows, bits, v);
  int row = (int)floor(((float)cell + 0.5f) / (float)columns); /* exact: fewer than 2^22 cells */
  int column = cell - row * columns;
  float top = environment_row_cosine(env, row);
  float height = environment_row_height(env, row);
  float y = math_clamp(fma(-t, height, top), -1.0f, 1.0f);
  float ring = math_safe_sqrt(fma(-y, y, 1.0f));
  float sine, cosine;
  math_sincos_2pi(((float)column + s) / (float)columns - 0.5f, &sine, &cosine);
  vec3 direction = environment_from_map(env, v3(ring * cosine, y, ring * sine));
  float pdf = environment_cell_pdf(env, cells[(uint)cell].pdf, height);
  vec3 radiance = environment_radiance(env, texels, direction);
  return light_sample_make(direction, CDL_INFINITY,
                           v3_scale(radiance, pdf > 0.0f ? 1.0f / pdf : 0.0f), pdf);
}

#endif
