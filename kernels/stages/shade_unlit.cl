/* shade_unlit: KHR_materials_unlit: the colour itself is seen, and nothing is scattered. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void shade_unlit(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const uint *path,
                          CDL_GLOBAL uint *work, CDL_GLOBAL uint *slots) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    vec3 base = state_vec3(work, CDL_WORK_BASE, stride, i);
    state_add_radiance(slots, wave->slots, state_uint(path, CDL_PATH_SLOT, stride, i),
                       v3_mul(throughput, base));
    state_set_uint(work, CDL_WORK_QUEUE, stride, i, CDL_QUEUE_DEAD);
  }
}
