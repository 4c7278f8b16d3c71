/* sample_medium: the free flight of paths inside a medium that is the same everywhere: how far
 * light goes before it is scattered, what is absorbed on the way, and what the medium emits. */
#include "lib/stage.h"

#include "lib/dimensions.h"
#include "lib/state.h"
#include "media/homogeneous.h"
#include "media/stack.h"

CDL_FUNCTION void sample_medium_strip(size_t first, CDL_CONSTANT cdl_Params *restrict params,
                                      CDL_CONSTANT cdl_Wave *restrict wave,
                                      CDL_GLOBAL const cdl_Medium *media, CDL_GLOBAL uint *path,
                                      CDL_GLOBAL uint *work, CDL_GLOBAL uint *slots) {
  CDL_FOR_STRIP(i, first) {
    size_t stride = wave->stride;
    uint queue = state_uint(work, CDL_WORK_QUEUE, stride, i);
    int living = queue != CDL_QUEUE_DEAD;
    MediaStack stack = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                  state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
    uint current = media_current(stack, params->scene_medium);
    CDL_GLOBAL const cdl_Medium *medium = media + (living ? current : CDL_MEDIUM_VACUUM);
    int alive = living & (medium->density == CDL_NONE);
    vec3 absorption = v3(medium->absorption[0], medium->absorption[1], medium->absorption[2]);
    vec3 scattering = v3(medium->scattering[0], medium->scattering[1], medium->scattering[2]);
    vec3 emission = v3(medium->emission[0], medium->emission[1], medium->emission[2]);

    vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
    float passed = state_float(path, CDL_PATH_PASSED, stride, i);
    float hit_t = state_float(path, CDL_PATH_HIT_T, stride, i);
    float distance = hit_t - passed;
    uint slot = state_uint(path, CDL_PATH_SLOT, stride, i);
    uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
    PathRandom random = path_random(params, wave, slot);
    float channel, chance;
    vertex_random(random, counts_vertex(counts), CDL_PAIR_FREE_FLIGHT, &channel, &chance);

    vec3 glow = homogeneous_emission(emission, v3_add(absorption, scattering), distance);
    vec3 emitted = v3_mul(throughput, glow);
    int glows = alive & (medium->emissive != 0u);
    state_add_radiance(slots, wave->slots, slot, v3_select(glows, emitted, v3_all(0.0f)));

    FreeFlight flight =
        homogeneous_sample(absorption, scattering, throughput, distance, channel, chance);
    int scattered = alive & flight.scattered;
    vec3 next = v3_mul(throughput, flight.weight);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, v3_select(alive, next, throughput));
    state_set_float(path, CDL_PATH_HIT_T, stride, i, scattered ? passed + flight.t : hit_t);
    uint inside = medium->walk != 0u ? CDL_QUEUE_WALK : CDL_QUEUE_MEDIUM;
    uint next_queue = counts_depth(counts) < params->max_depth ? inside : CDL_QUEUE_ENDED;
    state_set_uint(work, CDL_WORK_QUEUE, stride, i, scattered ? next_queue : queue);
  }
}

__kernel void sample_medium(CDL_CONSTANT cdl_Params *restrict params,
                            CDL_CONSTANT cdl_Wave *restrict wave,
                            CDL_GLOBAL const cdl_Medium *media, CDL_GLOBAL uint *path,
                            CDL_GLOBAL uint *work, CDL_GLOBAL uint *slots) {
  sample_medium_strip(get_global_id(0) * CDL_STRIP, params, wave, media, path, work, slots);
}
