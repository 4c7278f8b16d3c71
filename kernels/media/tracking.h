/* tracking.h: light in media whose density a grid gives, by null collisions: a fictitious part that
 * scatters straight on fills the medium up to the largest density of each stretch, so that the
 * extinction is constant there (Woodcock et al. 1965; Miller, Georgiev and Jarosz 2019, "A null-
 * scattering path integral formulation of light transport").
 *
 * Colours share one fictitious extinction. What becomes of a collision is drawn by the mean over
 * the channels, weighed by the throughput: the sum of its channels changes only by what is
 * absorbed, so no channel's weight explodes (the single-sample model of spectral MIS). */
#ifndef CDL_MEDIA_TRACKING_H
#define CDL_MEDIA_TRACKING_H

#include "lib/rng.h"
#include "media/grid.h"

/* What streams of the same vertex are for. */
#define CDL_STREAM_FLIGHT 0u
#define CDL_STREAM_SHADOW 1u

/* Numbers without an end, for what takes an unknown count of them. */
typedef struct RandomStream {
  uint key, next;
} RandomStream;

CDL_INLINE RandomStream random_stream(uint key, uint sample, uint vertex, uint purpose) {
  RandomStream stream;
  stream.key = rng_hash2(rng_hash2(key, sample), 4u * vertex + purpose);
  stream.next = 0u;
  return stream;
}

CDL_INLINE float random_next(RandomStream *stream) {
  return rng_to_unit(rng_hash2(stream->key, stream->next++));
}

CDL_INLINE vec3 medium_vec3(CDL_GLOBAL const float *v) { return v3(v[0], v[1], v[2]); }

/* ---- emission ---- */

/* Radiance of a black body, relative to the luminance of one of 1500 K. */
CDL_INLINE vec3 blackbody_radiance(float kelvin, CDL_GLOBAL const float *blackbody) {
  float last = (float)(int)(CDL_BLACKBODY_COUNT - 2u);
  float at = math_clamp(kelvin, 0.0f, 1e9f) * (1.0f / CDL_BLACKBODY_STEP);
  float node = math_min(floor(at), last);
  float part = math_min(at - node, 1.0f);
  float beyond = math_max(at / (last + 1.0f), 1.0f); /* in proportion: Rayleigh and Jeans */
  CDL_GLOBAL const float *a = blackbody + 3u * (uint)(int)node;
  return v3_scale(
      v3(grid_lerp(a[0], a[3], part), grid_lerp(a[1], a[4], part), grid_lerp(a[2], a[5], part)),
      beyond);
}

/* Radiance per metre at a point of the stretch that the march is at. */
CDL_INLINE vec3 grid_emission(CDL_GLOBAL const cdl_Medium *medium, GridMarch m, float t,
                              CDL_GLOBAL const float *blackbody, CDL_GRID_ARGS) {
  vec3 emission = medium_vec3(medium->emission);
  if (medium->temperature == CDL_NONE) return emission;
  float heat = grid_value(medium->temperature, 0u, m.x, m.y, m.z, grid_march_point(m, t), grids,
                          grid_table, grid_most, grid_values);
  return v3_mul(emission, blackbody_radiance(heat * medium->temperature_scale, blackbody));
}

/* ---- free flight ---- */

typedef struct GridFlight {
  vec3 throughput; /* behind the flight */
  vec3 glow;       /* what the medium emitted on the way, times the throughput there */
  float t;         /* where it scatters, or t_max, m */
  int scattered;
  uint real, null; /* collisions */
} GridFlight;

/* What a collision does: of all light, how much goes on scattered and how much straight on. */
typedef struct GridCollision {
  vec3 scattered, straight; /* [0,1] */
} GridCollision;

/* `density` is that at the collision over the largest of the stretch. */
CDL_INLINE GridCollision grid_collision(CDL_GLOBAL const cdl_Medium *medium, float density,
                                        float sigma_max, vec3 color) {
  vec3 scattering = v3_mul(medium_vec3(medium->scattering), color);
  vec3 extinction = v3_add(medium_vec3(medium->absorption), medium_vec3(medium->scattering));
  float scale = math_min(density, 1.0f) / sigma_max;
  GridCollision c;
  c.scattered = v3_scale(scattering, scale);
  c.straight = v3(math_max(fma(-extinction.x, scale, 1.0f), 0.0f),
                  math_max(fma(-extinction.y, scale, 1.0f), 0.0f),
                  math_max(fma(-extinction.z, scale, 1.0f), 0.0f));
  return c;
}

CDL_INLINE float grid_sigma_max(CDL_GLOBAL const cdl_Medium *medium) {
  return v3_max(v3_add(medium_vec3(medium->absorption), medium_vec3(medium->scattering)));
}

CDL_INLINE vec3 grid_color(CDL_GLOBAL const cdl_Medium *medium, GridMarch m, vec3 r,
                           CDL_GRID_ARGS) {
  if (medium->color == CDL_NONE) return v3_all(1.0f);
  return v3(math_saturate(grid_value(medium->color, 0u, m.x, m.y, m.z, r, grids, grid_table,
                                     grid_most, grid_values)),
            math_saturate(grid_value(medium->color, 1u, m.x, m.y, m.z, r, grids, grid_table,
                                     grid_most, grid_values)),
            math_saturate(grid_value(medium->color, 2u, m.x, m.y, m.z, r, grids, grid_table,
                                     grid_most, grid_values)));
}

/* What ends a path that straight-on collisions hold up: it is in a grid whose largest density is
 * far above the others' beside it. */
#define TRACKING_COLLISIONS 65536u

/* The density that fills the stretch up. Steps below the rounding of t would lead nowhere. */
CDL_INLINE float grid_majorant(GridStretch s, float sigma_max) {
  return math_min(s.most, 4194304.0f / (sigma_max * s.end));
}

/* Follows a path from `from` to `t_max` metres along its ray, which may be infinite, or to where it
 * is scattered. `u` draws the first distance, the stream the rest. Absorption is never drawn: what
 * only absorbs weakens the path and lets it through (ratio tracking). Emission is gathered over the
 * stretches between collisions, at a point of each where it varies. */
CDL_INLINE GridFlight grid_fly(CDL_GLOBAL const cdl_Medium *medium, vec3 origin, vec3 direction,
                               float from, float t_max, vec3 throughput, float u,
                               RandomStream *stream, CDL_GLOBAL const float *blackbody,
                               CDL_GRID_ARGS) {
  GridFlight flight = {throughput, v3_all(0.0f), t_max, 0, 0u, 0u};
  GridMarch m = grid_march(medium, grids + medium->density, origin, direction, from, t_max);
  float sigma_max = grid_sigma_max(medium);
  float depth = -math_log(1.0f - u);
  while (!grid_march_ends(m) && v3_max(flight.throughput) > 0.0f) {
    GridStretch s = grid_stretch(m, medium, grids, grid_most);
    float most = grid_majorant(s, sigma_max), rate = sigma_max * most;
    int collides = rate * (s.end - s.t) > depth;
    float stop = collides ? math_min(s.t + depth / rate, s.end) : s.end;
    if (medium->emissive && (s.hottest > 0.0f || medium->temperature == CDL_NONE)) {
      float at = fma(random_next(stream), stop - s.t, s.t);
      vec3 glow =
          grid_emission(medium, m, at, blackbody, grids, grid_table, grid_most, grid_values);
      flight.glow = v3_add(flight.glow, v3_scale(v3_mul(flight.throughput, glow), stop - s.t));
    }
    if (!collides) {
      depth = math_max(fma(-rate, s.end - s.t, depth), 0.0f);
      m = grid_march_on(m, s);
      continue;
    }
    m.t = stop;
    depth = -math_log(1.0f - random_next(stream));
    vec3 r = grid_march_point(m, stop);
    float density = grid_value(medium->density, 0u, m.x, m.y, m.z, r, grids, grid_table, grid_most,
                               grid_values);
    vec3 color = grid_color(medium, m, r, grids, grid_table, grid_most, grid_values);
    GridCollision c = grid_collision(medium, density / most, sigma_max, color);
    vec3 scattered = v3_mul(flight.throughput, c.scattered);
    vec3 straight = v3_mul(flight.throughput, c.straight);
    float real = scattered.x + scattered.y + scattered.z;
    float on = straight.x + straight.y + straight.z, all = on + real;
    flight.scattered = random_next(stream) * all < real;
    flight.throughput = flight.scattered ? v3_scale(scattered, all / real)
                                         : v3_scale(straight, on > 0.0f ? all / on : 0.0f);
    if (flight.scattered) {
      flight.real++;
      flight.t = stop;
      return flight;
    }
    flight.null++;
    if (flight.null == TRACKING_COLLISIONS) flight.throughput = v3_all(0.0f);
  }
  return flight;
}

/* ---- transmittance ---- */

/* Below this, a shadow ray lives on by chance. */
#define TRACKING_FAINT 0.1f
#define TRACKING_SURVIVAL 0.25f

/* An estimate of what arrives of `light` between `from` and `to` metres along a ray (ratio
 * tracking, Novak, Selle and Jarosz 2014). */
CDL_INLINE vec3 grid_transmit(vec3 light, CDL_GLOBAL const cdl_Medium *medium, vec3 origin,
                              vec3 direction, float from, float to, RandomStream *stream,
                              CDL_GRID_ARGS) {
  GridMarch m = grid_march(medium, grids + medium->density, origin, direction, from, to);
  float sigma_max = grid_sigma_max(medium), brightest = v3_max(light);
  float depth = -math_log(1.0f - random_next(stream));
  uint collisions = 0u;
  while (!grid_march_ends(m)) {
    GridStretch s = grid_stretch(m, medium, grids, grid_most);
    float most = grid_majorant(s, sigma_max), rate = sigma_max * most;
    if (!(rate * (s.end - s.t) > depth)) {
      depth = math_max(fma(-rate, s.end - s.t, depth), 0.0f);
      m = grid_march_on(m, s);
      continue;
    }
    m.t = math_min(s.t + depth / rate, s.end);
    depth = -math_log(1.0f - random_next(stream));
    float density = grid_value(medium->density, 0u, m.x, m.y, m.z, grid_march_point(m, m.t), grids,
                               grid_table, grid_most, grid_values);
    light = v3_mul(light, grid_collision(medium, density / most, sigma_max, v3_all(1.0f)).straight);
    if (++collisions == TRACKING_COLLISIONS) return v3_all(0.0f);
    if (v3_max(light) < TRACKING_FAINT * brightest) {
      if (!(random_next(stream) < TRACKING_SURVIVAL)) return v3_all(0.0f);
      light = v3_scale(light, 1.0f / TRACKING_SURVIVAL);
    }
  }
  return light;
}

#endif
