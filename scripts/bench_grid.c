/* bench_grid.c: look-ups in our bricks, by the kernels' own code, against NanoVDB's C header: bytes
 * for each active voxel, and nanoseconds for each trilinear look-up, of random points and of points
 * along rays, on one processor; the least of five runs in turn.
 *
 *   bench_grid [LARGEST]      sides 64, 128, … LARGEST (512) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PNANOVDB_C
#include <nanovdb/PNanoVDB.h>

#include "bench_grid.h"
#include "core/clock.h"
#include "media/grid.h"
#include "scene/grid.h"

enum { POINTS = 1 << 21, RUNS = 5 };

typedef struct Bench {
  int side;
  cdl_SceneGrid bricks;
  cdl_Grid grid;
  void *nano;
  size_t nano_size;
  float (*points)[3];
  float *ours, *theirs;
} Bench;

static float lattice(uint32_t x, uint32_t y, uint32_t z) {
  uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ z * 0xcb1ab31fu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  return (float)((h ^ h >> 13) >> 8) / 16777216.0f;
}

static float noise(float x, float y, float z) {
  float fx = floorf(x), fy = floorf(y), fz = floorf(z), value = 0;
  for (uint32_t i = 0; i < 8; i++) {
    float wx = i & 1 ? x - fx : 1 - (x - fx), wy = i & 2 ? y - fy : 1 - (y - fy);
    float wz = i & 4 ? z - fz : 1 - (z - fz);
    value += wx * wy * wz *
             lattice((uint32_t)fx + (i & 1), (uint32_t)fy + (i >> 1 & 1), (uint32_t)fz + (i >> 2));
  }
  return value;
}

float bench_smoke(int side, int x, int y, int z) {
  float s = 1.0f / (float)side, u = (float)x * s, h = (float)y * s, w = (float)z * s;
  float across = hypotf(u - 0.5f - 0.1f * sinf(9 * h), w - 0.5f - 0.1f * cosf(7 * h));
  float shape = 1 - across / (0.1f + 0.3f * h);
  if (shape < -0.5f) return 0;
  float rough = 0.5f * noise(9 * u, 9 * h, 9 * w) + 0.3f * noise(23 * u, 23 * h, 23 * w) +
                0.2f * noise(51 * u, 51 * h, 51 * w);
  return fmaxf(shape + 1.6f * (rough - 0.5f) - 0.1f, 0) * (1 - h);
}

static void check(cdl_Status status, const char *why) {
  if (!status) return;
  fprintf(stderr, "bench_grid: %s\n", why);
  exit(1);
}

static void build_bricks(Bench *bench) {
  const int32_t low[3] = {0, 0, 0}, last = bench->side - 1, high[3] = {last, last, last};
  const uint32_t n = (uint32_t)bench->side, size[3] = {n, n, n}, blocks = n / 8;
  GridSource source;
  const char *why = "";
  check(grid_source_begin(&source, 1, low, high, blocks * blocks * blocks, 0, &why), why);
  for (uint32_t b = 0; b < blocks * blocks * blocks; b++) {
    const int32_t at[3] = {(int32_t)(b % blocks * 8), (int32_t)(b / blocks % blocks * 8),
                           (int32_t)(b / blocks / blocks * 8)};
    float values[GRID_LEAF];
    uint64_t active = 0;
    for (int i = 0; i < GRID_LEAF; i++) {
      values[i] = bench_smoke(bench->side, at[0] + (i & 7), at[1] + (i >> 3 & 7), at[2] + (i >> 6));
      active += values[i] > 0;
    }
    source.active += active;
    if (active) check(grid_source_leaf(&source, at, values, &why), why);
  }
  check(grid_build(&source, low, size, SIZE_MAX, &bench->bricks, &why), why);
  grid_source_free(&source);
  bench->grid = (cdl_Grid){.channels = 1};
  memcpy(bench->grid.size, bench->bricks.size, sizeof bench->grid.size);
  memcpy(bench->grid.bricks, bench->bricks.bricks, sizeof bench->grid.bricks);
}

/* Random points, or points half a voxel apart along rays across the grid. */
static void make_points(Bench *bench, int along_rays) {
  uint64_t state = 1;
  float span = (float)(bench->side - 1), from[3] = {0}, by[3] = {0};
  for (int i = 0; i < POINTS; i++)
    for (int k = 0; k < 3; k++) {
      int in_ray = i % (2 * bench->side);
      if (!along_rays || in_ray < 2) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        float r = span * (float)(state >> 40) / 16777216.0f;
        if (in_ray == 0 || !along_rays) from[k] = r;
        if (in_ray == 1) by[k] = (r - from[k]) / (float)(2 * bench->side);
      }
      bench->points[i][k] = along_rays ? from[k] + by[k] * (float)in_ray : from[k];
    }
}

static double run_bricks(const Bench *bench) {
  const cdl_SceneGrid *b = &bench->bricks;
  double start = clock_cpu();
  for (int i = 0; i < POINTS; i++) {
    const float *p = bench->points[i];
    bench->ours[i] =
        grid_value(0, 0, grid_brick_axis(p[0]), grid_brick_axis(p[1]), grid_brick_axis(p[2]),
                   v3(p[0], p[1], p[2]), &bench->grid, b->table, b->most, b->values);
  }
  return clock_cpu() - start;
}

static float nano_value(pnanovdb_buf_t buf, pnanovdb_readaccessor_t *access, const float p[3]) {
  float f[3], corner[8];
  int at[3];
  for (int k = 0; k < 3; k++) {
    at[k] = (int)floorf(p[k]);
    f[k] = p[k] - (float)at[k];
  }
  for (int i = 0; i < 8; i++) {
    pnanovdb_coord_t ijk = {at[0] + (i & 1), at[1] + (i >> 1 & 1), at[2] + (i >> 2)};
    corner[i] = pnanovdb_read_float(
        buf, pnanovdb_readaccessor_get_value_address(PNANOVDB_GRID_TYPE_FLOAT, buf, access, &ijk));
  }
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 4 >> k; i++)
      corner[i] = corner[2 * i] + f[k] * (corner[2 * i + 1] - corner[2 * i]);
  return corner[0];
}

static double run_nano(const Bench *bench) {
  pnanovdb_buf_t buf = pnanovdb_make_buf(bench->nano, bench->nano_size / 4);
  pnanovdb_grid_handle_t grid = {{0}};
  pnanovdb_readaccessor_t access;
  pnanovdb_readaccessor_init(&access,
                             pnanovdb_tree_get_root(buf, pnanovdb_grid_get_tree(buf, grid)));
  double start = clock_cpu();
  for (int i = 0; i < POINTS; i++) bench->theirs[i] = nano_value(buf, &access, bench->points[i]);
  return clock_cpu() - start;
}

/* Nanoseconds of a look-up: ours, theirs. */
static void time_both(Bench *bench, int along_rays, double ns[2]) {
  double least[2] = {INFINITY, INFINITY};
  make_points(bench, along_rays);
  for (int i = 0; i < RUNS; i++) {
    least[0] = fmin(least[0], run_bricks(bench));
    least[1] = fmin(least[1], run_nano(bench));
  }
  for (int i = 0; i < 2; i++) ns[i] = least[i] / POINTS * 1e9;
  for (int i = 0; i < POINTS; i++)
    if (fabsf(bench->ours[i] - bench->theirs[i]) > 1e-5f) check(CDL_DIFFERENT, "values differ");
}

static void run_side(int side) {
  Bench bench = {.side = side,
                 .points = malloc(POINTS * sizeof *bench.points),
                 .ours = malloc(POINTS * sizeof *bench.ours),
                 .theirs = malloc(POINTS * sizeof *bench.theirs)};
  double random[2], rays[2];
  if (!bench.points || !bench.ours || !bench.theirs) abort();
  build_bricks(&bench);
  bench.nano = bench_nanovdb(side, &bench.nano_size);
  time_both(&bench, 0, random);
  time_both(&bench, 1, rays);
  double active = (double)bench.bricks.active;
  printf("%4d  %9.0f  %5.1f %%  %7.2f  %7.2f  %8.1f  %8.1f  %8.1f  %8.1f\n", side, active,
         100 * active / pow(side, 3), (double)grid_memory(&bench.bricks) / active,
         (double)bench.nano_size / active, random[0], random[1], rays[0], rays[1]);
  free(bench.nano);
  free(bench.points);
  free(bench.ours);
  free(bench.theirs);
  grid_free(&bench.bricks);
}

int main(int argc, char **argv) {
  int largest = argc > 1 ? atoi(argv[1]) : 512;
  printf("               active      bytes a voxel         random, ns          along rays, ns\n"
         "side     voxels  of all   bricks  NanoVDB    bricks   NanoVDB    bricks   NanoVDB\n");
  for (int side = 64; side <= largest && side <= 1024; side *= 2) run_side(side);
  return 0;
}
