/* shade_surface: light that a surface scatters. Built once for each model, -DCDL_SHADE_MODEL=…, and
 * run on that model's queue: weighs the sampled light, then samples the direction in which to go
 * on, or the probe by which to go under the surface. */
#include "lib/stage.h"

#include "bsdf/model.h"
#include "lib/dimensions.h"
#include "lib/frame.h"
#include "lib/roulette.h"
#include "lib/sampling.h"
#include "lib/state.h"
#include "media/stack.h"

/* What the kernel reads of a vertex. */
typedef struct Vertex {
  vec3 position, geometric;
  Frame shading;
  vec3 wo; /* local */
  uint counts;
  int scatters; /* 0: the path is as deep as it may be */
  int front;
  int mirrored;
  uint flags; /* CDL_MATERIAL_* */
  PathRandom random;
  MediaStack before, beyond; /* media on the path's side of the surface, and on the other */
} Vertex;

CDL_INLINE Vertex load_vertex(CDL_CONSTANT cdl_Params *params, CDL_CONSTANT cdl_Wave *wave,
                              CDL_GLOBAL const uint *path, CDL_GLOBAL const uint *work, size_t i) {
  size_t stride = wave->stride;
  Vertex at;
  at.position = state_vec3(work, CDL_WORK_POSITION, stride, i);
  at.geometric = state_vec3(work, CDL_WORK_GEOMETRIC_NORMAL, stride, i);
  at.shading = frame_orthonormal(state_vec3(work, CDL_WORK_NORMAL, stride, i),
                                 state_vec3(work, CDL_WORK_TANGENT, stride, i));
  at.wo = frame_to_local(at.shading, v3_neg(state_vec3(path, CDL_PATH_DIRECTION, stride, i)));
  at.counts = state_uint(path, CDL_PATH_COUNTS, stride, i);
#ifdef CDL_SHADE_LEAVES
  at.scatters = 1; /* counted where it went under */
#else
  at.scatters = counts_depth(at.counts) < params->max_depth;
#endif
  uint vertex = state_uint(work, CDL_WORK_VERTEX, stride, i);
  at.front = (vertex & CDL_VERTEX_FRONT) != 0u;
  at.mirrored = (vertex & CDL_VERTEX_MIRRORED) != 0u;
  at.flags = vertex >> CDL_VERTEX_FLAGS;
  at.random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
  at.before = media_make(state_uint(path, CDL_PATH_MEDIA, stride, i),
                         state_uint(path, CDL_PATH_MEDIA + 1, stride, i));
  at.beyond = at.before;
#if CDL_SHADE_TRANSMITS
  uint medium = state_uint(work, CDL_WORK_MEDIUM, stride, i);
  MediaStack crossed = media_crossed(at.before, medium, at.front);
  int boundary = (at.flags & CDL_MATERIAL_BOUNDARY) != 0u;
  at.beyond.inner = boundary ? crossed.inner : at.before.inner;
  at.beyond.outer = boundary ? crossed.outer : at.before.outer;
#endif
  return at;
}

CDL_INLINE BsdfPoint load_point(Vertex at, CDL_GLOBAL const uint *path, CDL_GLOBAL const uint *work,
                                size_t stride, size_t i) {
  BsdfPoint point;
  point.base = state_vec3(work, CDL_WORK_BASE, stride, i);
  point.throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
  point.coat_normal = v3(0.0f, 0.0f, 1.0f);
  point.wavelength = 0.0f;
  point.channel_choice = 0.0f;
  point.flags = at.flags;
  point.front = at.front;
  point.mirrored = at.mirrored;
#ifdef CDL_SHADE_COATED
  point.coat_normal = frame_to_local(at.shading, state_vec3(work, CDL_WORK_COAT_NORMAL, stride, i));
#endif
#ifdef CDL_SHADE_DISPERSES
  float unused;
  rng_2d(at.random.key, at.random.sample, CDL_PAIR_PATH, &point.wavelength, &unused);
  vertex_random(at.random, counts_vertex(at.counts), CDL_PAIR_CHANNEL, &point.channel_choice,
                &unused);
#endif
  return point;
}

/* What a bumpy surface would send into itself is mirrored by its plane and leaves after all: no
 * light is lost and no fringe goes dark, however steep the normal map is. It is the microsurface of
 * Schüssler et al. 2017, its second facet a mirror, without the shadows. A direction above the
 * plane then stands for two, itself and its mirror image; densities and values of both add up. */
#ifdef CDL_NORMAL_MAPS
#define CDL_SHADE_FOLDS 1
#else
#define CDL_SHADE_FOLDS 0
#endif

CDL_INLINE vec3 mirror_image(Vertex at, vec3 w) {
  return v3_madd(w, -2.0f * v3_dot(w, at.geometric), at.geometric);
}

CDL_INLINE BsdfValue evaluate(Vertex at, BsdfParams p, vec3 wi) {
  BsdfValue value = bsdf_evaluate(p, at.wo, frame_to_local(at.shading, wi));
#if CDL_SHADE_FOLDS
  int folds = (at.flags & CDL_MATERIAL_NORMAL_MAPPED) != 0u;
  BsdfValue image = bsdf_evaluate(p, at.wo, frame_to_local(at.shading, mirror_image(at, wi)));
  value.f_cos = v3_add(value.f_cos, v3_select(folds, image.f_cos, v3_all(0.0f)));
  value.pdf += folds ? image.pdf : 0.0f;
#endif
  return value;
}

#if CDL_SHADE_LIT && defined(CDL_LIGHTS)
/* The shadow ray of the light that was sampled, with what it adds if it arrives. */
CDL_INLINE void store_direct(Vertex at, BsdfParams p, vec3 throughput, CDL_GLOBAL uint *work,
                             size_t stride, size_t i) {
  vec3 to_light = state_vec3(work, CDL_WORK_LIGHT_DIRECTION, stride, i);
  float light_pdf = state_float(work, CDL_WORK_LIGHT_PDF, stride, i);
  BsdfValue value = evaluate(at, p, to_light);
  float side = v3_dot(to_light, at.geometric);
#if CDL_SHADE_TRANSMITS
  int behind = side < 0.0f;
  float shading_side = v3_dot(to_light, at.shading.z);
  int lit = behind ? shading_side < 0.0f : shading_side > 0.0f;
#else
  int behind = 0;
  int lit = side > 0.0f;
#endif
  float mis = light_pdf > 0.0f ? mis_power(light_pdf, value.pdf) : 1.0f;
  vec3 direct = v3_mul(value.f_cos, state_vec3(work, CDL_WORK_LIGHT_WEIGHT, stride, i));
  direct = v3_scale(v3_mul(throughput, direct), (at.scatters & lit) ? mis : 0.0f);
  vec3 leaving = v3_select(behind, v3_neg(at.geometric), at.geometric);
  state_set_vec3(work, CDL_WORK_SHADOW_ORIGIN, stride, i, offset_ray(at.position, leaving));
  state_set_uint(work, CDL_WORK_SHADOW_MEDIA, stride, i,
                 behind ? at.beyond.inner : at.before.inner);
  state_set_uint(work, CDL_WORK_SHADOW_MEDIA + 1, stride, i,
                 behind ? at.beyond.outer : at.before.outer);
  state_set_vec3(work, CDL_WORK_SHADOW_RADIANCE, stride, i, direct);
  state_set_uint(work, CDL_WORK_SHADOW_COUNT, stride, i, v3_max(direct) > 0.0f ? 1u : 0u);
}
#endif

#if CDL_SHADE_FOLDS
/* Density of the direction whose mirror image was sampled. */
CDL_INLINE float evaluate_image(Vertex at, BsdfParams p, vec3 wi) {
  int folds = (at.flags & CDL_MATERIAL_NORMAL_MAPPED) != 0u;
  BsdfValue image = bsdf_evaluate(p, at.wo, frame_to_local(at.shading, mirror_image(at, wi)));
  return folds ? image.pdf : 0.0f;
}

CDL_INLINE vec3 fold(Vertex at, vec3 wi) {
  int below = v3_dot(wi, at.geometric) < 0.0f;
  int folds = below & ((at.flags & CDL_MATERIAL_NORMAL_MAPPED) != 0u);
  return v3_select(folds, mirror_image(at, wi), wi);
}
#endif

#ifdef CDL_SHADE_ENTERS
/* The way under the surface: a probe instead of a ray, and what probe_subsurface needs to weigh
 * what it finds. */
CDL_INLINE void store_probe(Vertex at, BsdfParams p, vec3 next, int under, float u, float v,
                            float lobe, CDL_GLOBAL uint *path, CDL_GLOBAL uint *work, size_t stride,
                            size_t i) {
  float choice, unused;
  vertex_random(at.random, counts_vertex(at.counts), CDL_PAIR_CHANNEL, &choice, &unused);
  SubsurfaceProfiles profiles = subsurface_profiles(p, at.position);
  SubsurfaceProbe probe =
      subsurface_probe(profiles, subsurface_channels(next), at.position,
                       frame_from_tangent(at.geometric, at.shading.x), SUBSURFACE_NORMAL_SHARE, u,
                       v, subsurface_rest(p, at.wo, lobe), choice);
  vec3 origin = state_vec3(path, CDL_PATH_ORIGIN, stride, i);
  vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
  uint queue = state_uint(work, CDL_WORK_QUEUE, stride, i);
  int probes = under & (queue == CDL_QUEUE_LIVE);
  state_set_vec3(path, CDL_PATH_ORIGIN, stride, i, v3_select(under, probe.origin, origin));
  state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, v3_select(under, probe.direction, direction));
  state_set_float(path, CDL_PATH_HIT_T, stride, i, under ? probe.length : 0.0f);
  state_set_uint(work, CDL_WORK_QUEUE, stride, i, probes ? CDL_QUEUE_PROBE : queue);
  subsurface_store(profiles, work + CDL_WORK_PARAM * stride, stride, i);
}
#endif

#ifdef CDL_SHADE_ENERGY
#define SHADE_ENERGY_PARAMETER , CDL_GLOBAL const float *energy_table
#define SHADE_ENERGY_ARGUMENT , energy_table
#define SHADE_ENERGY energy_table
#else
#define SHADE_ENERGY_PARAMETER
#define SHADE_ENERGY_ARGUMENT
#define SHADE_ENERGY 0
#endif

CDL_FUNCTION void shade_strip(size_t first, CDL_CONSTANT cdl_Params *restrict params,
                              CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL uint *path,
                              CDL_GLOBAL uint *work SHADE_ENERGY_PARAMETER) {
  CDL_FOR_STRIP(i, first) {
    size_t stride = wave->stride;
    Vertex at = load_vertex(params, wave, path, work, i);
    BsdfPoint point = load_point(at, path, work, stride, i);
    point.energy = SHADE_ENERGY;
    BsdfParams p = bsdf_params(point, work + CDL_WORK_PARAM * stride, stride, i);

    float u, v, lobe, chance;
    vertex_random(at.random, counts_vertex(at.counts), CDL_PAIR_DIRECTION, &u, &v);
    vertex_random(at.random, counts_vertex(at.counts), CDL_PAIR_LOBE, &lobe, &chance);
#if CDL_SHADE_LIT && defined(CDL_LIGHTS)
    store_direct(at, p, point.throughput, work, stride, i);
#endif
    BsdfSample sample = bsdf_sample_model(p, at.wo, u, v, lobe);
    vec3 wi = frame_to_world(at.shading, sample.wi);
#if CDL_SHADE_FOLDS
    float image_pdf = evaluate_image(at, p, wi);
    sample.pdf += image_pdf;
    wi = fold(at, wi);
#endif
    float side = v3_dot(wi, at.geometric);
    int through = sample.transmitted;
    int right_side = through ? side < 0.0f : side > 0.0f;
#ifdef CDL_SHADE_ENTERS
    right_side |= through;
#endif
    vec3 next = roulette(params, counts_depth(at.counts) + 1u,
                         v3_mul(point.throughput, sample.weight), chance);
    next = v3_select(at.scatters & right_side, next, v3_all(0.0f));
    vec3 leaving = v3_select(through, v3_neg(at.geometric), at.geometric);

    state_set_vec3(path, CDL_PATH_ORIGIN, stride, i, offset_ray(at.position, leaving));
    state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, wi);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, next);
    state_set_float(path, CDL_PATH_PDF, stride, i, sample.delta ? 0.0f : sample.pdf);
    state_set_float(path, CDL_PATH_PASSED, stride, i, 0.0f);
#if defined(CDL_SHADE_LEAVES)
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, counts_passed(at.counts));
#elif defined(CDL_SHADE_WALKS)
    int within = at.front ? through : !through;
    state_set_uint(path, CDL_PATH_COUNTS, stride, i,
                   within ? counts_passed(at.counts) : counts_scattered(at.counts));
#else
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, counts_scattered(at.counts));
#endif
#if CDL_SHADE_TRANSMITS
    state_set_uint(path, CDL_PATH_MEDIA, stride, i, through ? at.beyond.inner : at.before.inner);
    state_set_uint(path, CDL_PATH_MEDIA + 1, stride, i,
                   through ? at.beyond.outer : at.before.outer);
#endif
    state_set_uint(work, CDL_WORK_QUEUE, stride, i,
                   v3_max(next) > 0.0f ? CDL_QUEUE_LIVE : CDL_QUEUE_DEAD);
#ifdef CDL_SHADE_ENTERS
    store_probe(at, p, next, through, u, v, lobe, path, work, stride, i);
#endif
  }
}

__kernel void CDL_KERNEL_NAME(CDL_CONSTANT cdl_Params *restrict params,
                              CDL_CONSTANT cdl_Wave *restrict wave, CDL_GLOBAL uint *path,
                              CDL_GLOBAL uint *work SHADE_ENERGY_PARAMETER) {
  shade_strip(get_global_id(0) * CDL_STRIP, params, wave, path, work SHADE_ENERGY_ARGUMENT);
}
