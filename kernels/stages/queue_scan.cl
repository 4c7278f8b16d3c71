/* queue_scan: lays the queues out one after the other and turns the counts of queue_count into the
 * places where each chunk puts its paths. One work-item: there are some thousand counts. */
#include "lib/portable.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void queue_scan(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL uint *counts,
                         CDL_GLOBAL cdl_QueueRange *ranges, CDL_GLOBAL uint *sources) {
  if (get_global_id(0) != 0) return;
  uint chunks = (wave->live + CDL_QUEUE_CHUNK - 1u) / CDL_QUEUE_CHUNK;
  uint place = 0u;
  for (; place < CDL_QUEUE_ALIGNMENT; place++)
    sources[place] =
        CDL_SOURCE_PAD | (wave->path_count + CDL_QUEUE_COUNT * CDL_QUEUE_ALIGNMENT + place);
  for (uint q = 0; q < CDL_QUEUE_COUNT; q++) {
    ranges[q].begin = place;
    for (uint chunk = 0; chunk < chunks; chunk++) {
      uint count = counts[q * chunks + chunk];
      counts[q * chunks + chunk] = place;
      place += count;
    }
    ranges[q].count = place - ranges[q].begin;
    /* Pads: each has a slot of its own, where what it computes does no harm. */
    for (uint pad = 0; place % CDL_QUEUE_ALIGNMENT != 0u; pad++, place++)
      sources[place] = CDL_SOURCE_PAD | (wave->path_count + q * CDL_QUEUE_ALIGNMENT + pad);
  }
  uint shadows = 0u;
  for (uint chunk = 0; chunk < chunks; chunk++)
    shadows += counts[CDL_QUEUE_SHADOWS * chunks + chunk];
  ranges[CDL_QUEUE_SHADOWS].count = shadows;
}
