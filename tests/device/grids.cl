/* grids.cl: sparse grids over arrays of points and rays, for test_grids.c and test_grid_tracking.c.
 * Results are rows of get_global_size(0) floats. */
#include "media/tracking.h"

#define ROW(k) out[(k)*get_global_size(0) + get_global_id(0)]

#define GRID_BUFFERS                                                                               \
  __global const cdl_Medium *media, __global const cdl_Grid *grids,                                \
      __global const uint *grid_table, __global const float *grid_most,                            \
      __global const float *grid_values, __global const float *blackbody

#define GRIDS grids, grid_table, grid_most, grid_values

/* A point of index space, as rows; `in`: grid, channel. The second result is from the brick before,
 * where the point lies between two. */
__kernel void grid_look(GRID_BUFFERS, __global const float *points, __global const uint *in,
                        __global float *out) {
  size_t i = get_global_id(0), n = get_global_size(0);
  __global const cdl_Grid *grid = grids + in[0];
  vec3 r = v3(points[i], points[n + i], points[2 * n + i]), c = grid_clamp(grid, r);
  int x = grid_brick_axis(c.x), y = grid_brick_axis(c.y), z = grid_brick_axis(c.z);
  ROW(0) = grid_value(in[0], in[1], x, y, z, r, GRIDS);
  x = x > 0 && c.x == (float)(8 * x) ? x - 1 : x;
  y = y > 0 && c.y == (float)(8 * y) ? y - 1 : y;
  z = z > 0 && c.z == (float)(8 * z) ? z - 1 : z;
  ROW(1) = grid_value(in[0], in[1], x, y, z, r, GRIDS);
}

/* Rays of 8 floats; `in`: the most stretches that are written, 4 floats for each. */
__kernel void grid_walk(GRID_BUFFERS, __global const float *rays, __global const uint *in,
                        __global float *out) {
  size_t i = get_global_id(0);
  __global const float *ray = rays + 8 * i;
  uint count = 0;
  GridMarch m = grid_march(media, grids + media->density, v3(ray[0], ray[1], ray[2]),
                           v3(ray[4], ray[5], ray[6]), ray[3], ray[7]);
  for (; !grid_march_ends(m) && count < in[0]; count++) {
    GridStretch s = grid_stretch(m, media, grids, grid_most);
    ROW(1u + 4u * count) = s.t;
    ROW(2u + 4u * count) = s.end;
    ROW(3u + 4u * count) = s.most;
    ROW(4u + 4u * count) = s.hottest;
    m = grid_march_on(m, s);
  }
  ROW(0) = grid_march_ends(m) ? (float)(int)count : -1.0f;
}

/* `in`: rays, seed, throughput as floats. Samples of a ray lie `rays` apart. */
__kernel void grid_flight(GRID_BUFFERS, __global const float *rays, __global const uint *in,
                          __global float *out) {
  uint i = (uint)get_global_id(0);
  __global const float *ray = rays + 8u * (i % in[0]);
  RandomStream stream = random_stream(in[1], i, 3u, CDL_STREAM_FLIGHT);
  float u = rng_to_unit(rng_hash2(i, in[1]));
  vec3 throughput = v3(as_float(in[2]), as_float(in[3]), as_float(in[4]));
  GridFlight f = grid_fly(media, v3(ray[0], ray[1], ray[2]), v3(ray[4], ray[5], ray[6]), ray[3],
                          ray[7], throughput, u, &stream, blackbody, GRIDS);
  ROW(0) = f.t;
  ROW(1) = (float)f.scattered;
  ROW(2) = f.throughput.x;
  ROW(3) = f.throughput.y;
  ROW(4) = f.throughput.z;
  ROW(5) = f.glow.x;
  ROW(6) = f.glow.y;
  ROW(7) = f.glow.z;
  ROW(8) = (float)(int)(f.real + f.null);
}

/* The same for shadow rays. */
__kernel void grid_shadow(GRID_BUFFERS, __global const float *rays, __global const uint *in,
                          __global float *out) {
  uint i = (uint)get_global_id(0);
  __global const float *ray = rays + 8u * (i % in[0]);
  RandomStream stream = random_stream(in[1], i, 3u, CDL_STREAM_SHADOW);
  vec3 light = grid_transmit(v3(as_float(in[2]), as_float(in[3]), as_float(in[4])), media,
                             v3(ray[0], ray[1], ray[2]), v3(ray[4], ray[5], ray[6]), ray[3], ray[7],
                             &stream, GRIDS);
  ROW(0) = light.x;
  ROW(1) = light.y;
  ROW(2) = light.z;
}

/* Radiance by temperature. */
__kernel void grid_radiance(__global const float *blackbody, __global const float *kelvin,
                            __global float *out) {
  vec3 light = blackbody_radiance(kelvin[get_global_id(0)], blackbody);
  ROW(0) = light.x;
  ROW(1) = light.y;
  ROW(2) = light.z;
}
