/* queue_scatter: tells each place in the queues which path comes there, in the order of the paths.
 */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void queue_scatter(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const uint *work,
                            CDL_GLOBAL const uint *counts, CDL_GLOBAL uint *sources) {
  uint chunk = (uint)get_global_id(0);
  uint live = wave->live;
  uint chunks = (live + CDL_QUEUE_CHUNK - 1u) / CDL_QUEUE_CHUNK;
  if (chunk >= chunks) return;
  uint places[CDL_QUEUE_COUNT];
  for (uint q = 0; q < CDL_QUEUE_COUNT; q++) places[q] = counts[q * chunks + chunk];
  uint begin = chunk * CDL_QUEUE_CHUNK;
  uint end = begin + CDL_QUEUE_CHUNK < live ? begin + CDL_QUEUE_CHUNK : live;
  for (uint i = begin; i < end; i++) {
    uint queue = state_uint(work, CDL_WORK_QUEUE, wave->stride, i);
    if (queue < CDL_QUEUE_COUNT) sources[places[queue]++] = i;
  }
}
