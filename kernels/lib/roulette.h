/* roulette.h: Russian roulette (Arvo and Kirk 1990): paths that carry little are ended by chance,
 * and those that go on carry what the ended ones lost. */
#ifndef CDL_ROULETTE_H
#define CDL_ROULETTE_H

#include "abi/params.h"
#include "lib/math.h"
#include "lib/vec.h"

#define CDL_ROULETTE_MOST 0.95f /* the highest chance to go on, so that every path ends */

/* The throughput after the `depth`-th event; black where the path ends. */
CDL_INLINE vec3 roulette(CDL_CONSTANT cdl_Params *params, uint depth, vec3 throughput,
                         float chance) {
  float survival = math_min(v3_max(throughput), CDL_ROULETTE_MOST);
  int plays = depth >= params->roulette_depth;
  int survives = (chance < survival) | !plays;
  float scale = (plays & (survival > 0.0f)) ? 1.0f / survival : 1.0f;
  return v3_scale(throughput, survives ? scale : 0.0f);
}

#endif
