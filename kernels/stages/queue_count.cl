/* queue_count: counts, chunk by chunk, how many paths go to each queue.
 * counts[queue * chunks + chunk]; one work-item a chunk of CDL_QUEUE_CHUNK paths. */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void queue_count(CDL_CONSTANT cdl_Wave *wave, CDL_GLOBAL const uint *work,
                          CDL_GLOBAL uint *counts) {
  uint chunk = (uint)get_global_id(0);
  uint live = wave->live;
  uint chunks = (live + CDL_QUEUE_CHUNK - 1u) / CDL_QUEUE_CHUNK;
  if (chunk >= chunks) return;
  uint local_counts[CDL_QUEUE_COUNT];
  for (uint q = 0; q < CDL_QUEUE_COUNT; q++) local_counts[q] = 0u;
  uint begin = chunk * CDL_QUEUE_CHUNK;
  uint end = begin + CDL_QUEUE_CHUNK < live ? begin + CDL_QUEUE_CHUNK : live;
  for (uint i = begin; i < end; i++) {
    uint queue = state_uint(work, CDL_WORK_QUEUE, wave->stride, i);
    if (queue < CDL_QUEUE_COUNT) local_counts[queue]++;
  }
  for (uint q = 0; q < CDL_QUEUE_COUNT; q++) counts[q * chunks + chunk] = local_counts[q];
}
