/* shade_surface: light that a surface scatters. Built once for each model, -DCDL_SHADE_MODEL=…, and
 * run on that model's queue: weighs the sampled light, then samples the direction in which to go
 * on. */
#include "lib/stage.h"

#include "bsdf/model.h"
#include "lib/dimensions.h"
#include "lib/frame.h"
#include "lib/roulette.h"
#include "lib/sampling.h"
#include "lib/state.h"
#include "media/stack.h"

CDL_INLINE BsdfPoint load_point(CDL_GLOBAL const uint *path, CDL_GLOBAL const uint *work,
                                size_t stride, size_t i, uint flags, Frame shading,
                                PathRandom random, uint vertex) {
  BsdfPoint point;
  point.base = state_vec3(work, CDL_WORK_BASE, stride, i);
  point.throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
  point.coat_normal = v3(0.0f, 0.0f, 1.0f);
  point.wavelength = 0.0f;
  point.channel_choice = 0.0f;
  point.flags = flags;
  point.front = (state_uint(work, CDL_WORK_VERTEX, stride, i) & CDL_VERTEX_FRONT) != 0u;
#ifdef CDL_SHADE_COATED
  point.coat_normal = frame_to_local(shading, state_vec3(work, CDL_WORK_COAT_NORMAL, stride, i));
#endif
#ifdef CDL_SHADE_DISPERSES
  float unused;
  rng_2d(random.key, random.sample, CDL_PAIR_PATH, &point.wavelength, &unused);
  vertex_random(random, vertex, CDL_PAIR_CHANNEL, &point.channel_choice, &unused);
#endif
  (void)shading;
  (void)random;
  (void)vertex;
  return point;
}

__kernel void CDL_KERNEL_NAME(CDL_CONSTANT cdl_Params *restrict params,
                              CDL_CONSTANT cdl_Wave *restrict wave,
                              CDL_GLOBAL const cdl_Material *materials, CDL_GLOBAL uint *path,
                              CDL_GLOBAL uint *work) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    CDL_GLOBAL const cdl_Material *material =
        materials + state_uint(work, CDL_WORK_MATERIAL, stride, i);
    uint counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
    PathRandom random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
    vec3 position = state_vec3(work, CDL_WORK_POSITION, stride, i);
    vec3 geometric = state_vec3(work, CDL_WORK_GEOMETRIC_NORMAL, stride, i);
    Frame shading = frame_orthonormal(state_vec3(work, CDL_WORK_NORMAL, stride, i),
                                      state_vec3(work, CDL_WORK_TANGENT, stride, i));
    vec3 wo = frame_to_local(shading, v3_neg(state_vec3(path, CDL_PATH_DIRECTION, stride, i)));
    BsdfPoint point =
        load_point(path, work, stride, i, material->flags, shading, random, counts_vertex(counts));
    BsdfParams p = bsdf_params(point, work + CDL_WORK_PARAM * stride, stride, i);
    vec3 throughput = point.throughput;
    int scatters = counts_depth(counts) < params->max_depth;

    MediaStack before = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                                   state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
    MediaStack crossed = before;
#if CDL_SHADE_TRANSMITS
    MediaStack beyond = media_crossed(before, material->medium, point.front);
    int boundary = (material->flags & CDL_MATERIAL_BOUNDARY) != 0u;
    crossed.inner = boundary ? beyond.inner : before.inner;
    crossed.outer = boundary ? beyond.outer : before.outer;
#endif

#if CDL_SHADE_LIT && defined(CDL_LIGHTS)
    vec3 to_light = state_vec3(work, CDL_WORK_LIGHT_DIRECTION, stride, i);
    float light_pdf = state_float(work, CDL_WORK_LIGHT_PDF, stride, i);
    vec3 local_light = frame_to_local(shading, to_light);
    BsdfValue value = bsdf_evaluate(p, wo, local_light);
    float light_side = v3_dot(to_light, geometric);
#if CDL_SHADE_TRANSMITS
    int behind = light_side < 0.0f;
    int lit = behind ? local_light.z < 0.0f : local_light.z > 0.0f;
#else
    int behind = 0;
    int lit = light_side > 0.0f;
#endif
    float mis = light_pdf > 0.0f ? mis_power(light_pdf, value.pdf) : 1.0f;
    vec3 direct = v3_mul(value.f_cos, state_vec3(work, CDL_WORK_LIGHT_WEIGHT, stride, i));
    direct = v3_scale(v3_mul(throughput, direct), (scatters & lit) ? mis : 0.0f);
    vec3 light_normal = v3_select(behind, v3_neg(geometric), geometric);
    state_set_vec3(work, CDL_WORK_SHADOW_ORIGIN, stride, i, offset_ray(position, light_normal));
    state_set_uint(work, CDL_WORK_SHADOW_MEDIA, stride, i, behind ? crossed.inner : before.inner);
    state_set_uint(work, CDL_WORK_SHADOW_MEDIA + 1, stride, i,
                   behind ? crossed.outer : before.outer);
    state_set_vec3(work, CDL_WORK_SHADOW_RADIANCE, stride, i, direct);
    state_set_uint(work, CDL_WORK_SHADOW_COUNT, stride, i, v3_max(direct) > 0.0f ? 1u : 0u);
#endif

    float u, v, lobe, chance;
    vertex_random(random, counts_vertex(counts), CDL_PAIR_DIRECTION, &u, &v);
    vertex_random(random, counts_vertex(counts), CDL_PAIR_LOBE, &lobe, &chance);
#if CDL_SHADE_LIT && defined(CDL_LIGHTS)
    u = math_after(value.pdf, u); /* evaluated once for the light, once for the sample */
    v = math_after(value.pdf, v);
#endif
    BsdfSample sample = bsdf_sample_model(p, wo, u, v, lobe);
    vec3 wi = frame_to_world(shading, sample.wi);
    float side = v3_dot(wi, geometric);
    int through = sample.transmitted;
    int right_side = through ? side < 0.0f : side > 0.0f;
    vec3 next =
        roulette(params, counts_depth(counts) + 1u, v3_mul(throughput, sample.weight), chance);
    next = v3_select(scatters & right_side, next, v3_all(0.0f));
    vec3 leaving = v3_select(through, v3_neg(geometric), geometric);

    state_set_vec3(path, CDL_PATH_ORIGIN, stride, i, offset_ray(position, leaving));
    state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, wi);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, next);
    state_set_float(path, CDL_PATH_PDF, stride, i, sample.delta ? 0.0f : sample.pdf);
    state_set_float(path, CDL_PATH_PASSED, stride, i, 0.0f);
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, counts_scattered(counts));
#if CDL_SHADE_TRANSMITS
    state_set_uint(path, CDL_PATH_MEDIA, stride, i, through ? crossed.inner : before.inner);
    state_set_uint(path, CDL_PATH_MEDIA + 1, stride, i, through ? crossed.outer : before.outer);
#endif
    state_set_uint(work, CDL_WORK_QUEUE, stride, i,
                   v3_max(next) > 0.0f ? CDL_QUEUE_LIVE : CDL_QUEUE_DEAD);
  }
}
