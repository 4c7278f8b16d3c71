/* queue_move: brings the paths together, queue by queue, so that shading kernels read and write
 * neighbouring words. Dead paths stay behind. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/state.h"

CDL_FUNCTION void queue_move_strip(size_t first, CDL_CONSTANT cdl_Wave *restrict wave,
                                   CDL_GLOBAL const uint *sources, CDL_GLOBAL const uint *path_from,
                                   CDL_GLOBAL uint *path, CDL_GLOBAL uint *work) {
  CDL_FOR_STRIP(i, first) {
    size_t stride = wave->stride;
    uint source = sources[i];
    int pad = (source & CDL_SOURCE_PAD) != 0u;
    size_t from = pad ? 0u : source;
/* else this loop is vectorised instead of the one over paths */
#pragma unroll
    for (uint field = 0; field < CDL_PATH_FIELDS; field++)
      path[field * stride + i] = path_from[field * stride + from];
    uint slot = path[CDL_PATH_SLOT * stride + i];
    uint triangle = path[CDL_PATH_HIT_TRIANGLE * stride + i];
    uint instance = path[CDL_PATH_HIT_INSTANCE * stride + i];
    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    state_set_uint(path, CDL_PATH_SLOT, stride, i, pad ? source & ~CDL_SOURCE_PAD : slot);
    state_set_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i, pad ? 0u : triangle);
    state_set_uint(path, CDL_PATH_HIT_INSTANCE, stride, i, pad ? 0u : instance);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, v3_select(pad, v3_all(0.0f), throughput));
    state_set_uint(work, CDL_WORK_QUEUE, stride, i, CDL_QUEUE_DEAD);
    state_set_uint(work, CDL_WORK_SHADOW_COUNT, stride, i, 0u);
  }
}

__kernel void queue_move(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const uint *sources,
                         CDL_GLOBAL const uint *path_from, CDL_GLOBAL uint *path,
                         CDL_GLOBAL uint *work) {
  queue_move_strip(get_global_id(0) * CDL_STRIP, wave, sources, path_from, path, work);
}
