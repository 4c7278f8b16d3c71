/* select.h: choosing among lights, or cells of a map, by weight: the alias method. */
#ifndef CDL_LIGHT_SELECT_H
#define CDL_LIGHT_SELECT_H

#include "abi/light.h"
#include "lib/rng.h"

/* An entry of a table of `count` >= 1, with the probability that its `pdf` says (Walker 1977).
 * `bits` choose the slot, `chance` in [0,1) between it and its alias: the fraction that is left of
 * one number would be too coarse where the table is long. */
CDL_INLINE uint alias_pick(CDL_GLOBAL const cdl_AliasEntry *table, uint count, uint bits,
                           float chance) {
  uint slot = rng_pick(bits, count);
  return chance < table[slot].keep ? slot : table[slot].alias;
}

#endif
