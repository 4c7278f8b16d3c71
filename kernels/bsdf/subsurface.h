/* subsurface.h: a rough dielectric coat over a body whose light leaves elsewhere than it entered,
 *
 *   S(xo, wo, xi, wi) = T(wo) Sp(|xo - xi|) T(wi) / (pi <T>),
 *
 * Sp being albedo times a profile of profile.h, T what passes the coat and <T> its mean over the
 * cosine, both as plastic.h has them, so that no more comes back than arrives. The coat reflects
 * where it is hit.
 *
 * A path goes under by a probe: a ray along the normal, the tangent or the bitangent that cuts the
 * body at some distance from the point (King et al. 2013, "BSSRDF Importance Sampling"). Where the
 * probe meets the body the path comes out again. Densities count all axes and all channels. */
#ifndef CDL_BSDF_SUBSURFACE_H
#define CDL_BSDF_SUBSURFACE_H

#include "bsdf/plastic.h"
#include "bsdf/profile.h"
#include "lib/frame.h"

/* Probability of probes along the normal; the tangents share the rest. */
#define SUBSURFACE_NORMAL_SHARE 0.5f

/* The least radius, of the largest coordinate: probes could not find nearer points. */
#define SUBSURFACE_LEAST_RADIUS 2e-6f
#define SUBSURFACE_MOST_RADIUS 1e6f /* m: densities stay far from denormal */

/* ---- where the path goes under ---- */

typedef struct SubsurfaceParams {
  PlasticParams coat;
  vec3 albedo;
  vec3 radius; /* m */
  int dipole;
} SubsurfaceParams;

CDL_INLINE PlasticParams subsurface_coat(BsdfPoint point, CDL_GLOBAL const uint *params,
                                         size_t stride, size_t i) {
  point.base = v3_all(1.0f);
  return plastic_make(point, param_float(params, CDL_SUBSURFACE_ALPHA, stride, i),
                      param_float(params, CDL_SUBSURFACE_ALPHA + 1u, stride, i),
                      param_float(params, CDL_SUBSURFACE_IOR, stride, i));
}

CDL_INLINE SubsurfaceParams subsurface_params(BsdfPoint point, CDL_GLOBAL const uint *params,
                                              size_t stride, size_t i) {
  SubsurfaceParams p;
  p.coat = subsurface_coat(point, params, stride, i);
  p.albedo = point.base;
  p.coat.guess = v3_max(p.albedo);
  p.radius = param_vec3(params, CDL_SUBSURFACE_RADIUS, stride, i);
  p.dipole = (point.flags & CDL_MATERIAL_DIPOLE) != 0u;
  return p;
}

/* Of the coat alone. */
CDL_INLINE BsdfValue subsurface_evaluate(SubsurfaceParams p, vec3 wo, vec3 wi) {
  MicrofacetLobe lobe = microfacet_evaluate(p.coat.facets, wo, wi);
  float fresnel = fresnel_dielectric(lobe.cos_h, p.coat.eta).reflectance;
  float probability = plastic_coat_probability(p.coat, plastic_pass(p.coat, wo));
  float rough = p.coat.facets.smooth ? 0.0f : 1.0f;
  return bsdf_value(v3_all(rough * lobe.f_cos * fresnel), rough * lobe.pdf * probability);
}

/* A reflection, or `transmitted` with the weight of going under. */
CDL_INLINE BsdfSample subsurface_sample(SubsurfaceParams p, vec3 wo, float u, float v, float w) {
  float pass = plastic_pass(p.coat, wo);
  float probability = plastic_coat_probability(p.coat, pass);
  int coat = w < probability;
  int smooth = p.coat.facets.smooth;
  vec3 rough = fresnel_reflect(wo, microfacet_sample_normal(p.coat.facets, wo, u, v));
  vec3 wi = v3_select(smooth, bsdf_mirror(wo), rough);
  BsdfValue value = subsurface_evaluate(p, wo, wi);
  float mirror = (1.0f - pass) / (coat ? probability : 1.0f);
  vec3 reflected = v3_scale(value.f_cos, bsdf_reciprocal(value.pdf));
  reflected = v3_select(smooth, v3_all(mirror), reflected);
  vec3 under = v3_scale(p.albedo, pass * bsdf_reciprocal(1.0f - probability));
  BsdfSample sample =
      bsdf_sample(v3_select(coat, wi, v3(0.0f, 0.0f, -1.0f)), v3_select(coat, reflected, under),
                  (coat && !smooth) ? value.pdf : 0.0f);
  sample.delta = coat && smooth;
  sample.transmitted = !coat;
  return sample;
}

/* What is left of w in [0,1) after it chose the coat or the body. */
CDL_INLINE float subsurface_rest(SubsurfaceParams p, vec3 wo, float w) {
  float probability = plastic_coat_probability(p.coat, plastic_pass(p.coat, wo));
  float rest = (w - probability) * bsdf_reciprocal(1.0f - probability);
  return math_clamp(rest, 0.0f, CDL_ONE_MINUS_EPSILON);
}

/* ---- the way beneath ---- */

/* The profiles of the colour channels. */
typedef struct SubsurfaceProfiles {
  Profile x, y, z;
} SubsurfaceProfiles;

CDL_INLINE SubsurfaceProfiles subsurface_profiles(SubsurfaceParams p, vec3 position) {
  float far = math_max(math_abs(position.x), math_max(math_abs(position.y), math_abs(position.z)));
  float least = math_max(SUBSURFACE_LEAST_RADIUS * far, 1e-10f);
  vec3 radius = v3(math_clamp(p.radius.x, least, SUBSURFACE_MOST_RADIUS),
                   math_clamp(p.radius.y, least, SUBSURFACE_MOST_RADIUS),
                   math_clamp(p.radius.z, least, SUBSURFACE_MOST_RADIUS));
  float depth = profile_depth(p.coat.eta);
  SubsurfaceProfiles profiles;
  profiles.x = profile_make(p.albedo.x, radius.x, depth, p.dipole);
  profiles.y = profile_make(p.albedo.y, radius.y, depth, p.dipole);
  profiles.z = profile_make(p.albedo.z, radius.z, depth, p.dipole);
  return profiles;
}

/* To and from the words of the parameters, where the depth is not. */
CDL_INLINE void subsurface_store(SubsurfaceProfiles profiles, CDL_GLOBAL uint *params,
                                 size_t stride, size_t i) {
  vec3 radius = v3(profiles.x.radius, profiles.y.radius, profiles.z.radius);
  vec3 slope = v3(profiles.x.slope, profiles.y.slope, profiles.z.slope);
  vec3 reach = v3(profiles.x.reach, profiles.y.reach, profiles.z.reach);
  param_set_vec3(params, CDL_SUBSURFACE_RADIUS, stride, i, radius);
  param_set_vec3(params, CDL_SUBSURFACE_SLOPE, stride, i, slope);
  param_set_vec3(params, CDL_SUBSURFACE_REACH, stride, i, reach);
}

CDL_INLINE Profile subsurface_load(CDL_GLOBAL const uint *params, uint channel, float depth,
                                   int dipole, size_t stride, size_t i) {
  Profile p;
  p.radius = param_float(params, CDL_SUBSURFACE_RADIUS + channel, stride, i);
  p.slope = param_float(params, CDL_SUBSURFACE_SLOPE + channel, stride, i);
  p.reach = param_float(params, CDL_SUBSURFACE_REACH + channel, stride, i);
  p.depth = depth;
  p.real = profile_real_share(p.slope, depth);
  p.dipole = dipole;
  return p;
}

CDL_INLINE SubsurfaceProfiles subsurface_load_all(CDL_GLOBAL const uint *params, int dipole,
                                                  size_t stride, size_t i) {
  float eta = math_clamp(param_float(params, CDL_SUBSURFACE_IOR, stride, i), 1.0f, 3.0f);
  float depth = profile_depth(eta);
  SubsurfaceProfiles profiles;
  profiles.x = subsurface_load(params, 0u, depth, dipole, stride, i);
  profiles.y = subsurface_load(params, 1u, depth, dipole, stride, i);
  profiles.z = subsurface_load(params, 2u, depth, dipole, stride, i);
  return profiles;
}

/* Probabilities of the channels: in proportion to what the path carries. */
CDL_INLINE vec3 subsurface_channels(vec3 throughput) {
  float sum = throughput.x + throughput.y + throughput.z;
  return v3_scale(throughput, bsdf_reciprocal(sum));
}

typedef struct SubsurfaceProbe {
  vec3 origin, direction; /* m, unit */
  float length;           /* m; 0: it would begin beyond the reach */
} SubsurfaceProbe;

/* A probe about `position`; frame.z is the geometric normal. u and v choose the place, `axis` and
 * `choice` the rest. */
CDL_INLINE SubsurfaceProbe subsurface_probe(SubsurfaceProfiles profiles, vec3 channels,
                                            vec3 position, Frame frame, float normal_share, float u,
                                            float v, float axis, float choice) {
  int red = choice < channels.x;
  int green = choice < channels.x + channels.y;
  float share = red ? channels.x : (green ? channels.y : channels.z);
  float before = red ? 0.0f : (green ? channels.x : channels.x + channels.y);
  float w = math_saturate((choice - before) * bsdf_reciprocal(share));
  Profile p = profiles.z;
  p.radius = red ? profiles.x.radius : (green ? profiles.y.radius : p.radius);
  p.slope = red ? profiles.x.slope : (green ? profiles.y.slope : p.slope);
  p.reach = red ? profiles.x.reach : (green ? profiles.y.reach : p.reach);
  p.real = red ? profiles.x.real : (green ? profiles.y.real : p.real);
  float r = profile_sample(p, u, w);

  int normal = axis < normal_share;
  int tangent = axis < 0.5f * (1.0f + normal_share);
  vec3 along = v3_select(normal, frame.z, v3_select(tangent, frame.x, frame.y));
  vec3 across = v3_select(normal, frame.x, v3_select(tangent, frame.y, frame.z));
  vec3 aside = v3_select(normal, frame.y, v3_select(tangent, frame.z, frame.x));
  float sine, cosine;
  math_sincos_2pi(v, &sine, &cosine);
  int within = r < p.reach;
  float chord = within ? sqrt((p.reach - r) * (p.reach + r)) : 0.0f;
  vec3 center = v3_madd(v3_madd(position, r * cosine, across), r * sine, aside);
  SubsurfaceProbe probe;
  probe.origin = v3_madd(center, -chord, along);
  probe.direction = along;
  probe.length = 2.0f * chord;
  return probe;
}

CDL_INLINE float subsurface_axis_density(SubsurfaceProfiles profiles, vec3 channels, float r) {
  float x = channels.x * profile_density(profiles.x, r);
  float y = channels.y * profile_density(profiles.y, r);
  float z = channels.z * profile_density(profiles.z, r);
  return x + y + z;
}

/* What light of `channels` becomes that comes out `offset` from where it went under, at a place
 * with the geometric normal `normal`: times the profile over the density with which probes find the
 * place, per area. */
CDL_INLINE vec3 subsurface_carry(SubsurfaceProfiles profiles, vec3 channels, Frame frame,
                                 float normal_share, vec3 offset, vec3 normal) {
  vec3 away = frame_to_local(frame, offset);
  vec3 faces = frame_to_local(frame, normal);
  float d = v3_length(away);
  float x2 = away.x * away.x;
  float y2 = away.y * away.y;
  float z2 = away.z * away.z;
  vec3 seen =
      v3(d <= profiles.x.reach ? channels.x : 0.0f, /* a channel's probes end at its reach */
         d <= profiles.y.reach ? channels.y : 0.0f, d <= profiles.z.reach ? channels.z : 0.0f);
  float tangent_share = 0.5f * (1.0f - normal_share);
  float along_x = math_abs(faces.x) * subsurface_axis_density(profiles, seen, sqrt(y2 + z2));
  float along_y = math_abs(faces.y) * subsurface_axis_density(profiles, seen, sqrt(z2 + x2));
  float along_z = math_abs(faces.z) * subsurface_axis_density(profiles, seen, sqrt(x2 + y2));
  float pdf = fma(normal_share, along_z, tangent_share * (along_x + along_y));
  float x = channels.x * profile_density(profiles.x, d) * profile_gain(profiles.x);
  float y = channels.y * profile_density(profiles.y, d) * profile_gain(profiles.y);
  float z = channels.z * profile_density(profiles.z, d) * profile_gain(profiles.z);
  return v3_scale(v3(x, y, z), pdf > 1e-35f ? 1.0f / pdf : 0.0f);
}

/* ---- where it comes out ---- */

typedef struct SubsurfaceExitParams {
  PlasticParams coat; /* over a white base, whose base is 1 / <T> */
} SubsurfaceExitParams;

CDL_INLINE SubsurfaceExitParams subsurface_exit_params(BsdfPoint point,
                                                       CDL_GLOBAL const uint *params, size_t stride,
                                                       size_t i) {
  SubsurfaceExitParams p;
  p.coat = subsurface_coat(point, params, stride, i);
  return p;
}

CDL_INLINE BsdfValue subsurface_exit_evaluate(SubsurfaceExitParams p, vec3 wo, vec3 wi) {
  (void)wo;
  float pdf = CDL_INV_PI * math_max(wi.z, 0.0f);
  return bsdf_value(v3_all(plastic_pass(p.coat, wi) * p.coat.base.x * pdf), pdf);
}

CDL_INLINE BsdfSample subsurface_exit_sample(SubsurfaceExitParams p, vec3 wo, float u, float v,
                                             float w) {
  (void)w;
  vec3 wi = sample_cosine_hemisphere(u, v);
  BsdfValue value = subsurface_exit_evaluate(p, wo, wi);
  return bsdf_sample(wi, v3_all(plastic_pass(p.coat, wi) * p.coat.base.x), value.pdf);
}

#endif
