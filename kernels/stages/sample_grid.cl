/* sample_grid: the free flight of paths inside a medium whose density a grid gives. */
#include "lib/portable.h"

#include "lib/dimensions.h"
#include "lib/state.h"
#include "media/stack.h"
#include "media/tracking.h"

__kernel void sample_grid(CDL_CONSTANT cdl_Params *restrict params,
                          CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const cdl_Medium *media,
                          CDL_GLOBAL const cdl_Grid *grids, CDL_GLOBAL const uint *grid_table,
                          CDL_GLOBAL const float *grid_most, CDL_GLOBAL const float *grid_values,
                          CDL_GLOBAL const float *blackbody, CDL_GLOBAL uint *path,
                          CDL_GLOBAL uint *work, CDL_GLOBAL uint *slots,
                          volatile CDL_GLOBAL uint *collisions) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  uint queue = state_uint(work, CDL_WORK_QUEUE, stride, i);
  if (queue == CDL_QUEUE_DEAD) return;
  MediaStack stack = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
  CDL_GLOBAL const cdl_Medium *medium = media + media_current(stack, params->scene_medium);
  if (medium->density == CDL_NONE) return;

  uint slot = state_uint(path, CDL_PATH_SLOT, stride, i);
  uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
  PathRandom random = path_random(params, wave, slot);
  float unused, first;
  vertex_random(random, counts_vertex(counts), CDL_PAIR_FREE_FLIGHT, &unused, &first);
  RandomStream stream =
      random_stream(random.key, random.sample, counts_vertex(counts), CDL_STREAM_FLIGHT);
  GridFlight flight = grid_fly(medium, state_vec3(path, CDL_PATH_ORIGIN, stride, i),
                               state_vec3(path, CDL_PATH_DIRECTION, stride, i),
                               state_float(path, CDL_PATH_PASSED, stride, i),
                               state_float(path, CDL_PATH_HIT_T, stride, i),
                               state_vec3(path, CDL_PATH_THROUGHPUT, stride, i), first, &stream,
                               blackbody, grids, grid_table, grid_most, grid_values);
  size_t counter = 2u * (i % CDL_COLLISION_COUNTERS);
  atomic_add(collisions + counter, flight.real);
  atomic_add(collisions + counter + 1u, flight.null);
  state_add_radiance(slots, wave->slots, slot, flight.glow);
  state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, flight.throughput);
  if (!flight.scattered) return;
  state_set_float(path, CDL_PATH_HIT_T, stride, i, flight.t);
  uint next_queue = counts_depth(counts) < params->max_depth ? CDL_QUEUE_MEDIUM : CDL_QUEUE_ENDED;
  state_set_uint(work, CDL_WORK_QUEUE, stride, i, next_queue);
}
