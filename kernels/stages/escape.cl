/* escape: paths that hit nothing see the environment. */
#include "lib/stage.h"

#include "lib/state.h"
#include "light/environment.h"

__kernel void escape(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
                     CDL_GLOBAL const float *environment,
                     CDL_GLOBAL const cdl_AliasEntry *environment_cells,
                     CDL_GLOBAL const uint *path, CDL_GLOBAL uint *slots) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    float pdf = state_float(path, CDL_PATH_PDF, stride, i);
    uint slot = state_uint(path, CDL_PATH_SLOT, stride, i);
    vec3 radiance = environment_radiance(&params->environment, environment, direction);
    float light_pdf = environment_pdf(&params->environment, environment_cells, direction);
    float weight = mis_power_or_alone(pdf, light_pdf);
    state_add_radiance(slots, wave->slots, slot, v3_scale(v3_mul(throughput, radiance), weight));
  }
}
