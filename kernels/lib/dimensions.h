/* dimensions.h: which random numbers belong to which decision of a path.
 *
 * Numbers come in pairs, two dimensions of one Sobol net each. The camera takes the first pairs,
 * every vertex (passed surfaces included) the next ones. */
#ifndef CDL_DIMENSIONS_H
#define CDL_DIMENSIONS_H

#include "abi/params.h"
#include "lib/motion.h"
#include "lib/rng.h"

#define CDL_PAIR_FILM 0u
#define CDL_PAIR_LENS 1u
#define CDL_PAIR_PATH 2u /* wavelength; time */
#define CDL_PAIR_FIRST_VERTEX 3u

#define CDL_PAIR_DIRECTION 0u   /* the scattered direction */
#define CDL_PAIR_LOBE 1u        /* which lobe; Russian roulette */
#define CDL_PAIR_LIGHT 2u       /* the point on the light */
#define CDL_PAIR_SELECT 3u      /* which light: slot of the table, and slot or alias */
#define CDL_PAIR_FREE_FLIGHT 4u /* which channel's extinction; the distance */
#define CDL_PAIR_TEXEL 5u       /* the point within a cell of the environment */
#define CDL_PAIR_OPACITY 6u     /* whether a half transparent surface is passed */
#define CDL_PAIR_CHANNEL 7u     /* which colour channel goes on alone; which exit a probe takes */
#define CDL_PAIR_NEAR_LIGHT 8u  /* which light a distance is drawn near to: slot, slot or alias */
#define CDL_PAIRS_PER_VERTEX 9u

/* Who draws: the pixel's key and the number of the sample. */
typedef struct PathRandom {
  uint key, sample;
  uint x, y; /* pixel of the full image */
  uint pad;
} PathRandom;

/* Both quotients are exact: slots are below 2^20, so slot + 1/2 is a float and the quotient errs by
 * less than its distance to a whole number. Integer division would not be vectorised. */
CDL_INLINE PathRandom path_random(CDL_CONSTANT cdl_Params *params, CDL_CONSTANT cdl_Wave *wave,
                                  uint slot) {
  uint pixels = wave->width * wave->height;
  uint sample = (uint)(int)floor(((float)(int)slot + 0.5f) / (float)(int)pixels);
  uint pixel = slot - sample * pixels;
  uint row = (uint)(int)floor(((float)(int)pixel + 0.5f) / (float)(int)wave->width);
  PathRandom random;
  random.x = wave->x + pixel - row * wave->width;
  random.y = wave->y + row;
  random.key = rng_pixel_key(random.x, random.y, params->seed);
  random.sample = wave->first_sample + sample;
  random.pad = 0u;
  return random;
}

#ifdef CDL_MOTION
/* The time of a path, uniform over the shutter: the same for all its rays. */
CDL_INLINE MotionTime path_time(CDL_CONSTANT cdl_Params *params, CDL_CONSTANT cdl_Wave *wave,
                                uint slot) {
  PathRandom random = path_random(params, wave, slot);
  float unused, t;
  rng_2d(random.key, random.sample, CDL_PAIR_PATH, &unused, &t);
  uint last = params->motion_keys - 2u;
  t = t * (float)(int)(last + 1u);
  uint key = (uint)(int)floor(t);
  MotionTime time;
  time.key = key > last ? last : key;
  time.fraction = t - floor(t);
  return time;
}
#endif

/* Bits of the pair `which`, for choosing among many. */
CDL_INLINE void vertex_random_bits(PathRandom random, uint vertex, uint which, uint *u, uint *v) {
  rng_2d_bits(random.key, random.sample,
              CDL_PAIR_FIRST_VERTEX + vertex * CDL_PAIRS_PER_VERTEX + which, u, v);
}

/* The pair `which` (CDL_PAIR_*) of the path's current vertex. */
CDL_INLINE void vertex_random(PathRandom random, uint vertex, uint which, float *u, float *v) {
  rng_2d(random.key, random.sample, CDL_PAIR_FIRST_VERTEX + vertex * CDL_PAIRS_PER_VERTEX + which,
         u, v);
}

#endif
