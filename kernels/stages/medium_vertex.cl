/* medium_vertex: where in the world the paths of the medium queue were scattered. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/state.h"

__kernel void medium_vertex(CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const uint *path,
                            CDL_GLOBAL uint *work) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    vec3 origin = state_vec3(path, CDL_PATH_ORIGIN, stride, i);
    vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
    float distance = state_float(path, CDL_PATH_HIT_T, stride, i);
    state_set_vec3(work, CDL_WORK_POSITION, stride, i, v3_madd(origin, distance, direction));
  }
}
