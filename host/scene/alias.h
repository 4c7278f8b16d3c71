/* alias.h: choosing among many by weight in constant time (Walker 1977, built as Vose 1991). */
#ifndef CANDELA_SCENE_ALIAS_H
#define CANDELA_SCENE_ALIAS_H

#include <stddef.h>

#include "abi/light.h"
#include "candela.h"

/* Fills `count` >= 1 entries for weights that are finite and >= 0; their pdfs sum to 1. All zero:
 * all alike. CDL_BAD_INPUT if memory is short. */
cdl_Status alias_build(const cdl_Log *log, const double *weights, size_t count,
                       cdl_AliasEntry *table);

#endif
