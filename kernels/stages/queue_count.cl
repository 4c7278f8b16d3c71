/* queue_count: counts, chunk by chunk, how many paths go to each queue, and how many shadow rays
 * were traced before. counts[queue * chunks + chunk]; one work-item a chunk of CDL_QUEUE_CHUNK
 * paths. */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void queue_count(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const uint *work,
                          CDL_GLOBAL uint *counts) {
  uint chunk = (uint)get_global_id(0);
  uint live = wave->live;
  uint chunks = (live + CDL_QUEUE_CHUNK - 1u) / CDL_QUEUE_CHUNK;
  if (chunk >= chunks) return;
  uint sums[CDL_QUEUE_COUNT + 1u];
  for (uint q = 0; q <= CDL_QUEUE_COUNT; q++) sums[q] = 0u;
  uint begin = chunk * CDL_QUEUE_CHUNK;
  uint end = begin + CDL_QUEUE_CHUNK < live ? begin + CDL_QUEUE_CHUNK : live;
  for (uint i = begin; i < end; i++) {
    uint queue = state_uint(work, CDL_WORK_QUEUE, wave->stride, i);
    if (queue < CDL_QUEUE_COUNT) sums[queue]++;
    sums[CDL_QUEUE_SHADOWS] += state_uint(work, CDL_WORK_SHADOW_COUNT, wave->stride, i);
  }
  for (uint q = 0; q <= CDL_QUEUE_COUNT; q++) counts[q * chunks + chunk] = sums[q];
}
