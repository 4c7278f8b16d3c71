/* pass: paths that go straight on: through the boundary of a medium, or through a hole. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/state.h"
#include "media/stack.h"

__kernel void pass(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
                   CDL_GLOBAL uint *path, CDL_GLOBAL uint *work) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    uint vertex = state_uint(work, CDL_WORK_VERTEX, stride, i);
    uint medium = state_uint(work, CDL_WORK_MEDIUM, stride, i);
    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    float passed = state_float(path, CDL_PATH_HIT_T, stride, i);
    uint counts = counts_passed(state_uint(path, CDL_PATH_COUNTS, stride, i));

    MediaStack before = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                   state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
    MediaStack crossed = media_crossed(before, medium, (vertex & CDL_VERTEX_FRONT) != 0u);
    int boundary = (vertex & CDL_VERTEX_INTERFACE) != 0u;
    int alive = (v3_max(throughput) > 0.0f) & (counts_passes(counts) < params->pass_limit);

    state_set_float(path, CDL_PATH_PASSED, stride, i, passed);
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, counts);
    state_set_uint(path, CDL_PATH_MEDIA, stride, i, boundary ? crossed.inner : before.inner);
    state_set_uint(path, CDL_PATH_MEDIA + 1, stride, i, boundary ? crossed.outer : before.outer);
    state_set_uint(work, CDL_WORK_QUEUE, stride, i, alive ? CDL_QUEUE_LIVE : CDL_QUEUE_DEAD);
  }
}
