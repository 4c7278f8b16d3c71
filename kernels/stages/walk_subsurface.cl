/* walk_subsurface: a step of the walk under a surface: light that its inside scatters goes on by
 * the phase function. The whole walk counts as one scattering event, with that of leaving, and no
 * light is sampled on it, because the surface is in the way. */
#include "lib/stage.h"

#include "lib/dimensions.h"
#include "lib/state.h"
#include "media/phase.h"
#include "media/stack.h"

/* Steps of a walk, in units of the limit of passes: more are not taken. Where nothing is absorbed
 * and nothing comes out soon, a share of 1 / sqrt(steps) of the light is still inside. */
#define WALK_LIMIT_PASSES 4u

/* The throughput with which the walk goes on: what is faint is ended by chance. */
CDL_INLINE vec3 walk_roulette(vec3 throughput, float chance) {
  float survival = math_min(v3_max(throughput), 1.0f);
  float scale = survival > 0.0f ? 1.0f / survival : 0.0f;
  return v3_scale(throughput, chance < survival ? scale : 0.0f);
}

CDL_FUNCTION void walk_subsurface_strip(size_t first, CDL_CONSTANT cdl_Params *restrict params,
                                        CDL_CONSTANT cdl_Wave *restrict wave,
                                        CDL_GLOBAL const cdl_Medium *media, CDL_GLOBAL uint *path,
                                        CDL_GLOBAL uint *work) {
  CDL_FOR_STRIP(i, first) {
    size_t stride = wave->stride;
    MediaStack stack = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                  state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
    Phase phase = phase_of(media + media_current(stack, params->scene_medium));
    vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
    float t = state_float(path, CDL_PATH_HIT_T, stride, i);
    vec3 position = v3_madd(state_vec3(path, CDL_PATH_ORIGIN, stride, i), t, direction);
    uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);

    PathRandom random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
    float u, v, lobe, chance;
    vertex_random(random, counts_vertex(counts), CDL_PAIR_DIRECTION, &u, &v);
    vertex_random(random, counts_vertex(counts), CDL_PAIR_LOBE, &lobe, &chance);
    PhaseSample sample = phase_sample(phase, direction, u, v, lobe);
    vec3 next = walk_roulette(state_vec3(path, CDL_PATH_THROUGHPUT, stride, i), chance);
    next = v3_select(counts_passes(counts) < WALK_LIMIT_PASSES * params->pass_limit, next,
                     v3_all(0.0f));

    state_set_vec3(path, CDL_PATH_ORIGIN, stride, i, position);
    state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, sample.wi);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, next);
    state_set_float(path, CDL_PATH_PDF, stride, i, 0.0f);
    state_set_float(path, CDL_PATH_PASSED, stride, i, 0.0f);
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, counts_passed(counts));
    state_set_uint(work, CDL_WORK_QUEUE, stride, i,
                   v3_max(next) > 0.0f ? CDL_QUEUE_LIVE : CDL_QUEUE_DEAD);
  }
}

__kernel void walk_subsurface(CDL_CONSTANT cdl_Params *restrict params,
                              CDL_CONSTANT cdl_Wave *restrict wave,
                              CDL_GLOBAL const cdl_Medium *media, CDL_GLOBAL uint *path,
                              CDL_GLOBAL uint *work) {
  walk_subsurface_strip(get_global_id(0) * CDL_STRIP, params, wave, media, path, work);
}
