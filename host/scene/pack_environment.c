#include <math.h>
#include <stdlib.h>

#include "core/log.h"
#include "lib/color.h"
#include "light/environment.h"
#include "scene/alias.h"
#include "scene/pack_parts.h"

/* Cells of the importance table at the most; larger maps share cells among texels. */
enum { MAX_COLUMNS = 1024, MAX_ROWS = 512 };

/* Points across a cell, each way, at which its light is looked up at the least. */
enum { CELL_POINTS = 4 };

static float texel_value(const cdl_Image *image, size_t i) {
  return image->f32 ? image->f32[i] : (float)image->u8[i] / 255.0f;
}

static float largest_finite(const cdl_Image *image) {
  size_t values = 4 * (size_t)image->width * (size_t)image->height;
  float largest = 0.0f;
  for (size_t i = 0; i < values; i++) {
    float value = texel_value(image, i);
    if (i % 4 != 3 && isfinite(value) && value > largest) largest = value;
  }
  return largest;
}

/* Radiance is finite and not negative; what is not is mended and counted. */
static float mend(float value, float largest, size_t *mended) {
  if (value >= 0.0f && value <= largest) return value;
  ++*mended;
  return value > 0.0f ? largest : 0.0f;
}

static void copy_map(const cdl_Log *log, const cdl_Scene *scene, const cdl_Image *image,
                     cdl_Pack *pack) {
  size_t texels = (size_t)image->width * (size_t)image->height, mended = 0;
  float largest = largest_finite(image);
  for (size_t i = 0; i < texels; i++) {
    size_t before = mended;
    for (size_t c = 0; c < 3; c++) {
      size_t values = 0;
      float value = mend(texel_value(image, 4 * i + c), largest, &values);
      pack->environment[4 * i + c] = image->encoded ? color_srgb_decode(value) : value;
      mended += values;
    }
    mended = mended > before ? before + 1 : before;
  }
  if (mended)
    log_note(log,
             "%s: %zu texels of the environment were negative, infinite or not numbers; they count "
             "as 0 or as the largest finite value",
             scene->path, mended);
}

/* Luminance at fractional texel coordinates, as the kernels blend it. */
static double map_luminance(const cdl_Pack *pack, double x, double y) {
  long width = pack->environment_params.width, height = pack->environment_params.height;
  long x0 = (long)floor(x - 0.5), y0 = (long)floor(y - 0.5);
  double fx = x - 0.5 - (double)x0, fy = y - 0.5 - (double)y0, sum = 0.0;
  for (int corner = 0; corner < 4; corner++) {
    long column = (x0 + (corner & 1) + width) % width, row = y0 + (corner >> 1);
    row = row < 0 ? 0 : row >= height ? height - 1 : row;
    const float *t = pack->environment + 4 * (size_t)(row * width + column);
    double weight = (corner & 1 ? fx : 1.0 - fx) * (corner >> 1 ? fy : 1.0 - fy);
    sum += weight * color_luminance(v3(t[0], t[1], t[2]));
  }
  return sum;
}

/* Mean luminance of a cell: no cell is 0 from which light comes. */
static double cell_luminance(const cdl_Pack *pack, uint32_t column, uint32_t row) {
  const cdl_EnvironmentParams *env = &pack->environment_params;
  double wide = (double)env->width / env->columns, high = (double)env->height / env->rows;
  int nx = CELL_POINTS * (int)ceil(wide), ny = CELL_POINTS * (int)ceil(high);
  double sum = 0.0;
  for (int j = 0; j < ny; j++)
    for (int i = 0; i < nx; i++)
      sum += map_luminance(pack, (column + (i + 0.5) / nx) * wide, (row + (j + 0.5) / ny) * high);
  return sum / ((double)nx * ny);
}

/* Fills the table of cells; *integral is that of the luminance over the sphere, without strength.
 */
static cdl_Status build_cells(const cdl_Log *log, cdl_Pack *pack, double *integral) {
  const cdl_EnvironmentParams *env = &pack->environment_params;
  double *weights = pack_array(log, "texels", pack->cell_count, sizeof *weights);
  if (!weights) return CDL_BAD_INPUT;
#pragma omp parallel for schedule(dynamic)
  for (uint32_t row = 0; row < env->rows; row++) {
    double band = environment_row_height(env, (int)row);
    for (uint32_t column = 0; column < env->columns; column++)
      weights[(size_t)row * env->columns + column] =
          cell_luminance(pack, column, row) * band * 2.0 * M_PI / env->columns;
  }
  *integral = 0.0;
  for (size_t i = 0; i < pack->cell_count; i++) *integral += weights[i];
  cdl_Status status = alias_build(log, weights, pack->cell_count, pack->environment_cells);
  free(weights);
  return status;
}

static uint32_t cells_across(int texels, uint32_t most) {
  uint32_t share = ((uint32_t)texels + most - 1) / most;
  return ((uint32_t)texels + share - 1) / share;
}

static void set_params(const cdl_SceneEnvironment *from, const cdl_Image *image,
                       cdl_EnvironmentParams *env) {
  env->width = image ? (uint32_t)image->width : 1;
  env->height = image ? (uint32_t)image->height : 1;
  env->columns = image ? cells_across(image->width, MAX_COLUMNS) : 1;
  env->rows = image ? cells_across(image->height, MAX_ROWS) : 1;
  for (int c = 0; c < 3; c++) env->scale[c] = from->strength;
  float turns = from->rotation / 360.0f;
  math_sincos_2pi(turns - rintf(turns), &env->rotation_sin, &env->rotation_cos);
}

cdl_Status pack_environment(const cdl_Log *log, const cdl_Scene *scene, cdl_Pack *pack,
                            double *power) {
  const cdl_SceneEnvironment *from = &scene->environment;
  const cdl_Image *image =
      from->present && from->image != CDL_NONE ? scene->images[from->image] : NULL;
  cdl_EnvironmentParams *env = &pack->environment_params;
  set_params(from, image, env);
  pack->environment_count = (size_t)env->width * env->height;
  pack->cell_count = (size_t)env->columns * env->rows;
  pack->environment =
      pack_array(log, "environment texels", pack->environment_count, 4 * sizeof(float));
  pack->environment_cells =
      pack_array(log, "environment cells", pack->cell_count, sizeof *pack->environment_cells);
  if (!pack->environment || !pack->environment_cells) return CDL_BAD_INPUT;
  if (image)
    copy_map(log, scene, image, pack);
  else if (from->present)
    for (int c = 0; c < 3; c++) pack->environment[c] = from->radiance[c];
  double integral;
  if (build_cells(log, pack, &integral)) return CDL_BAD_INPUT;
  double radius = pack_scene_radius(pack);
  *power = from->present ? from->strength * integral * M_PI * radius * radius : 0.0;
  pack->features.environment = *power > 0.0;
  return CDL_OK;
}
