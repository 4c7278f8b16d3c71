/* random.h: random numbers for tests by xorshift64* (Vigna 2016), independent of rng.h. */
#ifndef CANDELA_TESTS_RANDOM_H
#define CANDELA_TESTS_RANDOM_H

#include <stdint.h>

#include "lib/sampling.h"

static uint64_t random_state = 1;

static inline void random_start(uint64_t seed) { random_state = seed * 0x9e3779b97f4a7c15u + 1u; }

static inline float random_unit(void) {
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return (float)((random_state * 0x2545f4914f6cdd1du) >> 40) / 16777216.0f;
}

static inline float random_signed(void) { return 2.0f * random_unit() - 1.0f; }

static inline vec3 random_normal(void) {
  float u = random_unit(), v = random_unit();
  return sample_sphere(u, v);
}

#endif
