/* sample_medium: the free flight of paths inside a medium that is the same everywhere: how far
 * light goes before it is scattered, what is absorbed on the way, and what the medium emits. */
#include "lib/stage.h"

#include "abi/light.h"
#include "lib/dimensions.h"
#include "lib/state.h"
#include "light/select.h"
#include "media/homogeneous.h"
#include "media/stack.h"

/* The lamp near which a scattering event may be drawn; none where the sky is chosen. */
CDL_INLINE EquiAngular near_light(CDL_CONSTANT cdl_Params *params,
                                  CDL_GLOBAL const cdl_Light *lights,
                                  CDL_GLOBAL const cdl_AliasEntry *light_table, uint bits,
                                  uint keep_bits, vec3 origin, vec3 direction, float t_max,
                                  float sigma) {
#ifdef CDL_NEAR_LIGHTS
  CDL_GLOBAL const cdl_Light *light =
      lights + alias_pick(light_table, params->light_count, bits, rng_to_unit(keep_bits));
  float third = light->type == CDL_LIGHT_TRIANGLE ? 0.333333343f : 0.0f;
  vec3 point = v3(fma(light->e1[0] + light->e2[0], third, light->p[0]),
                  fma(light->e1[1] + light->e2[1], third, light->p[1]),
                  fma(light->e1[2] + light->e2[2], third, light->p[2]));
  EquiAngular near = equiangular_toward(point, origin, direction, t_max, sigma);
  int somewhere = (light->type == CDL_LIGHT_TRIANGLE) | (light->type == CDL_LIGHT_POINT);
  near.chance = somewhere ? near.chance : 0.0f;
  return near;
#else
  return equiangular_none();
#endif
}

/* Whether what the ray meets behind the medium may be bright by itself: an emitter, or the sky. */
CDL_INLINE int shines(uint queue) {
#ifdef CDL_ENVIRONMENT_LIGHT
  int sky = queue == CDL_QUEUE_ESCAPED;
#else
  int sky = 0;
#endif
  return sky | ((queue >= CDL_QUEUE_MODELS) & ((queue - CDL_QUEUE_MODELS) & 1u));
}

CDL_FUNCTION void sample_medium_strip(size_t first, CDL_CONSTANT cdl_Params *restrict params,
                                      CDL_CONSTANT cdl_Wave *restrict wave,
                                      CDL_GLOBAL const cdl_Medium *media,
                                      CDL_GLOBAL const cdl_Light *lights,
                                      CDL_GLOBAL const cdl_AliasEntry *light_table,
                                      CDL_GLOBAL uint *path, CDL_GLOBAL uint *work,
                                      CDL_GLOBAL uint *slots) {
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

    uint light_bits, keep_bits;
    vertex_random_bits(random, counts_vertex(counts), CDL_PAIR_NEAR_LIGHT, &light_bits, &keep_bits);
    vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
    vec3 begin = v3_madd(state_vec3(path, CDL_PATH_ORIGIN, stride, i), passed, direction);
    vec3 extinction = v3_add(absorption, scattering);
    float sigma = (extinction.x + extinction.y + extinction.z) * 0.333333343f;
    EquiAngular near = near_light(params, lights, light_table, light_bits, keep_bits, begin,
                                  direction, distance, sigma);
    /* Only straight from the camera, as every flight that ends behind the fog weighs the path more,
     * which adds up over bounces; and not before what shines, which would flicker. */
    int fresh = (counts_depth(counts) == 0u) & (params->max_depth > 0u) & (medium->walk == 0u);
    near.chance = (fresh & !shines(queue)) ? near.chance : 0.0f;
    FreeFlight flight =
        homogeneous_sample(absorption, scattering, throughput, distance, channel, chance, near);
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
                            CDL_GLOBAL const cdl_Medium *media, CDL_GLOBAL const cdl_Light *lights,
                            CDL_GLOBAL const cdl_AliasEntry *light_table, CDL_GLOBAL uint *path,
                            CDL_GLOBAL uint *work, CDL_GLOBAL uint *slots) {
  sample_medium_strip(get_global_id(0) * CDL_STRIP, params, wave, media, lights, light_table, path,
                      work, slots);
}
