/* shade_medium: light that a medium scatters, by its phase function. */
#include "lib/stage.h"

#include "lib/dimensions.h"
#include "lib/roulette.h"
#include "lib/sampling.h"
#include "lib/state.h"
#include "media/phase.h"
#include "media/stack.h"

CDL_FUNCTION void shade_medium_strip(size_t first, CDL_CONSTANT cdl_Params *restrict params,
                                     CDL_CONSTANT cdl_Wave *restrict wave,
                                     CDL_GLOBAL const cdl_Medium *media, CDL_GLOBAL uint *path,
                                     CDL_GLOBAL uint *work) {
  CDL_FOR_STRIP(i, first) {
    size_t stride = wave->stride;
    MediaStack stack = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                  state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
    Phase phase = phase_of(media + media_current(stack, params->scene_medium));
    vec3 position = state_vec3(work, CDL_WORK_POSITION, stride, i);
    vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
    int scatters = counts_depth(counts) < params->max_depth;

#ifdef CDL_LIGHTS
    vec3 to_light = state_vec3(work, CDL_WORK_LIGHT_DIRECTION, stride, i);
    float light_pdf = state_float(work, CDL_WORK_LIGHT_PDF, stride, i);
    float value = phase_value(phase, v3_dot(direction, to_light));
    float mis = light_pdf > 0.0f ? mis_power(light_pdf, value) : 1.0f;
    vec3 direct = v3_mul(throughput, state_vec3(work, CDL_WORK_LIGHT_WEIGHT, stride, i));
    direct = v3_scale(direct, scatters ? value * mis : 0.0f);
    state_set_vec3(work, CDL_WORK_SHADOW_ORIGIN, stride, i, position);
    state_set_uint(work, CDL_WORK_SHADOW_MEDIA, stride, i, stack.inner);
    state_set_uint(work, CDL_WORK_SHADOW_MEDIA + 1, stride, i, stack.outer);
    state_set_vec3(work, CDL_WORK_SHADOW_RADIANCE, stride, i, direct);
    state_set_uint(work, CDL_WORK_SHADOW_COUNT, stride, i, v3_max(direct) > 0.0f ? 1u : 0u);
#endif

    PathRandom random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
    float u, v, lobe, chance;
    vertex_random(random, counts_vertex(counts), CDL_PAIR_DIRECTION, &u, &v);
    vertex_random(random, counts_vertex(counts), CDL_PAIR_LOBE, &lobe, &chance);
    PhaseSample sample = phase_sample(phase, direction, u, v, lobe);
    vec3 next = roulette(params, counts_depth(counts) + 1u, throughput, chance);
    next = v3_select(scatters, next, v3_all(0.0f));

    state_set_vec3(path, CDL_PATH_ORIGIN, stride, i, position);
    state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, sample.wi);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, next);
    state_set_float(path, CDL_PATH_PDF, stride, i, sample.pdf);
    state_set_float(path, CDL_PATH_PASSED, stride, i, 0.0f);
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, counts_scattered(counts));
    state_set_uint(work, CDL_WORK_QUEUE, stride, i,
                   v3_max(next) > 0.0f ? CDL_QUEUE_LIVE : CDL_QUEUE_DEAD);
  }
}

__kernel void shade_medium(CDL_CONSTANT cdl_Params *restrict params,
                           CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL const cdl_Medium *media,
                           CDL_GLOBAL uint *path, CDL_GLOBAL uint *work) {
  shade_medium_strip(get_global_id(0) * CDL_STRIP, params, wave, media, path, work);
}
