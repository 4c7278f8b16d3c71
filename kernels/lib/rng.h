/* rng.h: counter-based samples, keyed by pixel, seed, sample index and dimension; integers only.
 *
 * A pair of dimensions is an Owen-scrambled Sobol (0,2)-sequence of its own: the first two Sobol
 * dimensions, with the order of samples shuffled and the values scrambled by hashes of pixel and
 * pair (padding; Burley 2020, "Practical Hash-based Owen Scrambling"). Every aligned power-of-two
 * block of sample indices is a stratified net in each pair. Values are multiples of 2^-24 in [0,
 * 1). Sample and dimension numbers are free; nothing is stored. */
#ifndef CDL_RNG_H
#define CDL_RNG_H

#include "lib/portable.h"

/* A bijective mixer of 32 bits (the low-bias constants of Wellons's hash prospector). */
CDL_INLINE uint rng_hash(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

/* Mixes two words; bijective in either while the other is fixed. */
CDL_INLINE uint rng_hash2(uint a, uint b) { return rng_hash(rng_hash(a) + b * 0x9e3779b1u); }

/* The key of a pixel's samples. */
CDL_INLINE uint rng_pixel_key(uint x, uint y, uint seed) {
  return rng_hash2(rng_hash2(seed, y), x);
}

/* Top 24 bits as a float in [0, 1) */
CDL_INLINE float rng_to_unit(uint bits) { return (float)(bits >> 8) * 5.96046448e-8f; }

/* Exchanges the bits of x under `mask` with those `shift` above them. */
CDL_INLINE uint rng_swap_bits(uint x, uint mask, uint shift) {
  uint change = (x ^ (x >> shift)) & mask;
  return x ^ change ^ (change << shift);
}

#ifdef __SPIR__
/* Compilers recognise the way below and make one instruction of it, which is lost on the way
 * through SPIR; this one they do not. */
CDL_INLINE uint rng_reverse_bits(uint x) {
  x = rng_swap_bits(x, 0x55555555u, 1);
  x = rng_swap_bits(x, 0x33333333u, 2);
  x = rng_swap_bits(x, 0x0f0f0f0fu, 4);
  x = rng_swap_bits(x, 0x00ff00ffu, 8);
  return rng_swap_bits(x, 0x0000ffffu, 16);
}
#else
CDL_INLINE uint rng_reverse_bits(uint x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}
#endif

/* A permutation in which each bit is flipped by a hash of the bits below it only: an Owen scramble
 * of a value whose bits are reversed (Laine and Karras 2011, with Vegdahl's constants). */
CDL_INLINE uint rng_scramble_reversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

/* The second Sobol dimension, bit-reversed, of an index. The generator is Pascal's triangle modulo
 * 2; in reversed order its product is bit i = sum over j >= i of binomial(j, i) bit j, which
 * factors into one xor by each power of two because binomial(j, i) is odd where i is a subset of j
 * (Lucas). */
CDL_INLINE uint rng_sobol2_reversed(uint index) {
  uint x = index;
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ (x >> 16);
}

/* The order of samples: an Owen scramble of the index permutes it within every aligned block of a
 * power of two, so that such blocks stay nets. */
CDL_INLINE uint rng_shuffle_index(uint sample, uint seed) {
  return rng_reverse_bits(rng_scramble_reversed(rng_reverse_bits(sample), seed));
}

/* Seeds of one pair: of the order, and (by rng_hash of seed + 1 and + 2) of the values. The key is
 * mixed already, so one more hash separates the pairs. */
CDL_INLINE uint rng_dimension_seed(uint key, uint dimension) {
  return rng_hash(key + dimension * 0x9e3779b1u);
}

/* Two stratified numbers for one sample of a pixel; `pair` numbers the pairs of dimensions. */
CDL_INLINE void rng_2d_bits(uint key, uint sample, uint pair, uint *u, uint *v) {
  uint seed = rng_dimension_seed(key, 2u * pair);
  uint index = rng_shuffle_index(sample, seed);
  uint x = rng_scramble_reversed(index, rng_hash(seed + 1u));
  uint y = rng_scramble_reversed(rng_sobol2_reversed(index), rng_hash(seed + 2u));
  *u = rng_reverse_bits(x);
  *v = rng_reverse_bits(y);
}

/* The same as floats in [0,1). */
CDL_INLINE void rng_2d(uint key, uint sample, uint pair, float *u, float *v) {
  uint x, y;
  rng_2d_bits(key, sample, pair, &x, &y);
  *u = rng_to_unit(x);
  *v = rng_to_unit(y);
}

/* One of `count` alike, from 32 random bits: 24 would favour some where there are many. */
CDL_INLINE uint rng_pick(uint bits, uint count) { return mul_hi(bits, count); }

#endif
