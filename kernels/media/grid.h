/* grid.h: sparse grids in space (abi/grid.h), and the way of a ray through one.
 *
 * A ray is followed brick by brick, block by block where a block is empty; each stretch comes with
 * the largest value that can be met on it (a digital differential analyser over two levels, after
 * Amanatides and Woo 1987). Distances are in metres along the ray. */
#ifndef CDL_MEDIA_GRID_H
#define CDL_MEDIA_GRID_H

#include "abi/grid.h"
#include "abi/medium.h"
#include "lib/math.h"
#include "lib/transform.h"

/* All grids, as the functions below take them and hand them on. */
#define CDL_GRID_ARGS                                                                              \
  CDL_GLOBAL const cdl_Grid *grids, CDL_GLOBAL const uint *grid_table,                             \
      CDL_GLOBAL const float *grid_most, CDL_GLOBAL const float *grid_values

/* The same as further parameters and arguments, only where a scene has grids. */
#ifdef CDL_GRIDS
#define CDL_GRID_PARAM , CDL_GRID_ARGS
#define CDL_GRID , grids, grid_table, grid_most, grid_values
#else
#define CDL_GRID_PARAM
#define CDL_GRID
#endif

/* The bricks low … high - 1 of one axis. */
typedef struct GridSpan {
  int low, high;
} GridSpan;

/* Where a ray is: in a brick, `t` along it. */
typedef struct GridMarch {
  vec3 origin, direction; /* of the ray in index space, per metre */
  vec3 inverse;           /* of the direction's components; 0 where those are 0 */
  int x, y, z;            /* brick */
  float t, end;           /* end <= t: the ray has left the grid */
} GridMarch;

/* ---- values ---- */

CDL_INLINE float grid_clamp_axis(float r, uint size) {
  return math_clamp(r, 0.0f, (float)(int)(size - 1u));
}

/* The centres between which a point lies, within the grid. */
CDL_INLINE vec3 grid_clamp(CDL_GLOBAL const cdl_Grid *grid, vec3 r) {
  return v3(grid_clamp_axis(r.x, grid->size[0]), grid_clamp_axis(r.y, grid->size[1]),
            grid_clamp_axis(r.z, grid->size[2]));
}

CDL_INLINE int grid_brick_axis(float r) { return (int)floor(r * (1.0f / CDL_GRID_CELLS)); }

CDL_INLINE uint grid_entry(CDL_GLOBAL const cdl_Grid *grid, int x, int y, int z) {
  return ((uint)z * grid->bricks[1] + (uint)y) * grid->bricks[0] + (uint)x;
}

CDL_INLINE float grid_lerp(float a, float b, float t) { return fma(t, b - a, a); }

/* Interpolated in a brick, at `r` counted from its first centre. */
CDL_INLINE float grid_brick_value(CDL_GLOBAL const float *v, vec3 r) {
  float last = (float)(int)(CDL_GRID_CELLS - 1u);
  float x = math_clamp(floor(r.x), 0.0f, last);
  float y = math_clamp(floor(r.y), 0.0f, last);
  float z = math_clamp(floor(r.z), 0.0f, last);
  float fx = math_saturate(r.x - x), fy = math_saturate(r.y - y), fz = math_saturate(r.z - z);
  uint at = ((uint)(int)z * CDL_GRID_SIDE + (uint)(int)y) * CDL_GRID_SIDE + (uint)(int)x;
  CDL_GLOBAL const float *w = v + at + CDL_GRID_SIDE * CDL_GRID_SIDE;
  v += at;
  float near_z = grid_lerp(grid_lerp(v[0], v[1], fx),
                           grid_lerp(v[CDL_GRID_SIDE], v[CDL_GRID_SIDE + 1u], fx), fy);
  float far_z = grid_lerp(grid_lerp(w[0], w[1], fx),
                          grid_lerp(w[CDL_GRID_SIDE], w[CDL_GRID_SIDE + 1u], fx), fy);
  return grid_lerp(near_z, far_z, fz);
}

/* A channel at point `r` of index space inside the grid, looked up in the brick x, y, z. */
CDL_INLINE float grid_value(uint number, uint channel, int x, int y, int z, vec3 r, CDL_GRID_ARGS) {
  CDL_GLOBAL const cdl_Grid *grid = grids + number;
  (void)grid_most;
  uint brick = grid_table[grid->first_brick + grid_entry(grid, x, y, z)];
  if (brick == CDL_NONE) return 0.0f;
  float cells = (float)(int)CDL_GRID_CELLS;
  vec3 base = v3((float)x * cells, (float)y * cells, (float)z * cells);
  return grid_brick_value(grid_values + (size_t)(brick + channel) * CDL_GRID_VALUES,
                          v3_sub(grid_clamp(grid, r), base));
}

/* ---- rays ---- */

/* Cuts [*from, *to] to where the axis is inside the grid. */
CDL_INLINE void grid_cut(float origin, float direction, float inverse, uint size, float *from,
                         float *to) {
  float low = -0.5f - origin, high = (float)(int)size - 0.5f - origin;
  float first = (direction > 0.0f ? low : high) * inverse;
  float last = (direction > 0.0f ? high : low) * inverse;
  int along = direction == 0.0f;
  int inside = low <= 0.0f && high >= 0.0f;
  *from = along ? *from : math_max(*from, first);
  *to = along ? (inside ? *to : *from) : math_min(*to, last);
}

/* Denormal numbers, which some devices take for 0 and whose inverse may be infinite, are 0. */
CDL_INLINE float grid_flush(float d) { return math_abs(d) < 1.17549435e-38f ? 0.0f : d; }

CDL_INLINE float grid_inverse(float d) { return d == 0.0f ? 0.0f : 1.0f / d; }

CDL_INLINE int grid_is_finite(vec3 a) {
  float most = 3.40282347e+38f;
  return math_abs(a.x) <= most && math_abs(a.y) <= most && math_abs(a.z) <= most;
}

CDL_INLINE vec3 grid_march_point(GridMarch m, float t) { return v3_madd(m.origin, t, m.direction); }

/* Keeps a brick number in the bricks low … high - 1. */
CDL_INLINE int grid_keep(int brick, GridSpan span) {
  brick = brick < span.low ? span.low : brick;
  return brick < span.high ? brick : span.high - 1;
}

CDL_INLINE GridSpan grid_axis(CDL_GLOBAL const cdl_Grid *grid, int axis) {
  GridSpan span;
  span.low = 0;
  span.high = (int)grid->bricks[axis];
  return span;
}

/* The ray from `origin` along `direction`, both in the world, from `from` to `to` metres, which may
 * be infinite. A ray that is not finite in index space, or has no end there, ends at once. */
CDL_INLINE GridMarch grid_march(CDL_GLOBAL const cdl_Medium *medium,
                                CDL_GLOBAL const cdl_Grid *grid, vec3 origin, vec3 direction,
                                float from, float to) {
  Transform to_grid = transform_load(medium->to_grid);
  GridMarch m;
  m.origin = transform_point(to_grid, origin);
  vec3 d = transform_direction(to_grid, direction);
  m.direction = v3(grid_flush(d.x), grid_flush(d.y), grid_flush(d.z));
  m.inverse =
      v3(grid_inverse(m.direction.x), grid_inverse(m.direction.y), grid_inverse(m.direction.z));
  int sound = grid_is_finite(m.origin) && grid_is_finite(m.direction);
  grid_cut(m.origin.x, m.direction.x, m.inverse.x, grid->size[0], &from, &to);
  grid_cut(m.origin.y, m.direction.y, m.inverse.y, grid->size[1], &from, &to);
  grid_cut(m.origin.z, m.direction.z, m.inverse.z, grid->size[2], &from, &to);
  m.t = from;
  m.end = sound && to < CDL_INFINITY ? to : from;
  vec3 r = grid_march_point(m, from < to ? from : 0.0f);
  m.x = grid_keep(grid_brick_axis(grid_clamp_axis(r.x, grid->size[0])), grid_axis(grid, 0));
  m.y = grid_keep(grid_brick_axis(grid_clamp_axis(r.y, grid->size[1])), grid_axis(grid, 1));
  m.z = grid_keep(grid_brick_axis(grid_clamp_axis(r.z, grid->size[2])), grid_axis(grid, 2));
  return m;
}

/* Where the ray leaves the bricks of `span` on one axis; at the grid's own faces that is for `end`
 * to say. */
CDL_INLINE float grid_exit(float origin, float direction, float inverse, GridSpan span, int count) {
  int brick = direction > 0.0f ? span.high : span.low;
  int inner = brick > 0 && brick < count && direction != 0.0f;
  float plane = (float)brick * (float)(int)CDL_GRID_CELLS;
  return inner ? (plane - origin) * inverse : CDL_INFINITY;
}

/* A stretch of the ray, in one brick or one empty block, and the bricks that it passes. */
typedef struct GridStretch {
  float t, end;  /* m */
  float most;    /* of the density */
  float hottest; /* of the temperature; 0 without */
  GridSpan x, y, z;
  float exit_x, exit_y, exit_z;
} GridStretch;

CDL_INLINE GridSpan grid_block_span(int brick, uint count) {
  GridSpan span;
  span.low = brick & ~(int)(CDL_GRID_BLOCK - 1u);
  span.high = span.low + (int)CDL_GRID_BLOCK;
  span.high = span.high < (int)count ? span.high : (int)count;
  return span;
}

CDL_INLINE GridSpan grid_brick_span(int brick) {
  GridSpan span;
  span.low = brick;
  span.high = brick + 1;
  return span;
}

/* The largest value in the block that holds the march's brick. */
CDL_INLINE float grid_block_most(CDL_GLOBAL const cdl_Grid *grid, GridMarch m,
                                 CDL_GLOBAL const float *grid_most) {
  uint x = (uint)m.x / CDL_GRID_BLOCK, y = (uint)m.y / CDL_GRID_BLOCK;
  uint z = (uint)m.z / CDL_GRID_BLOCK;
  return grid_most[grid->first_block + (z * grid->blocks[1] + y) * grid->blocks[0] + x];
}

/* The stretch that begins where the march is. */
CDL_INLINE GridStretch grid_stretch(GridMarch m, CDL_GLOBAL const cdl_Medium *medium,
                                    CDL_GLOBAL const cdl_Grid *grids,
                                    CDL_GLOBAL const float *grid_most) {
  CDL_GLOBAL const cdl_Grid *grid = grids + medium->density;
  int hot = medium->temperature != CDL_NONE;
  CDL_GLOBAL const cdl_Grid *heat = grids + (hot ? medium->temperature : medium->density);
  int empty = !(grid_block_most(grid, m, grid_most) > 0.0f) &&
              !(hot && grid_block_most(heat, m, grid_most) > 0.0f);
  uint entry = grid_entry(grid, m.x, m.y, m.z);
  GridStretch s;
  s.x = empty ? grid_block_span(m.x, grid->bricks[0]) : grid_brick_span(m.x);
  s.y = empty ? grid_block_span(m.y, grid->bricks[1]) : grid_brick_span(m.y);
  s.z = empty ? grid_block_span(m.z, grid->bricks[2]) : grid_brick_span(m.z);
  s.most = empty ? 0.0f : grid_most[grid->first_brick + entry];
  s.hottest = empty || !hot ? 0.0f : grid_most[heat->first_brick + entry];
  s.exit_x = grid_exit(m.origin.x, m.direction.x, m.inverse.x, s.x, (int)grid->bricks[0]);
  s.exit_y = grid_exit(m.origin.y, m.direction.y, m.inverse.y, s.y, (int)grid->bricks[1]);
  s.exit_z = grid_exit(m.origin.z, m.direction.z, m.inverse.z, s.z, (int)grid->bricks[2]);
  s.t = m.t;
  s.end = math_min(math_min(s.exit_x, s.exit_y), math_min(s.exit_z, m.end));
  s.end = math_max(s.end, m.t);
  return s;
}

/* On to the brick behind the stretch. Every step leaves at least one brick for good, so that the
 * march ends however distances are rounded. */
CDL_INLINE GridMarch grid_march_on(GridMarch m, GridStretch s) {
  int by_x = s.exit_x <= s.exit_y && s.exit_x <= s.exit_z;
  int by_y = !by_x && s.exit_y <= s.exit_z;
  float nearest = math_min(math_min(s.exit_x, s.exit_y), s.exit_z);
  vec3 r = grid_march_point(m, s.end);
  int x = grid_keep(grid_brick_axis(r.x), s.x);
  int y = grid_keep(grid_brick_axis(r.y), s.y);
  int z = grid_keep(grid_brick_axis(r.z), s.z);
  m.x = by_x ? (m.direction.x > 0.0f ? s.x.high : s.x.low - 1) : x;
  m.y = by_y ? (m.direction.y > 0.0f ? s.y.high : s.y.low - 1) : y;
  m.z = !by_x && !by_y && nearest < CDL_INFINITY ? (m.direction.z > 0.0f ? s.z.high : s.z.low - 1)
                                                 : z;
  m.t = s.end < m.end && nearest < m.end ? s.end : m.end;
  return m;
}

CDL_INLINE int grid_march_ends(GridMarch m) { return !(m.t < m.end); }

#endif
