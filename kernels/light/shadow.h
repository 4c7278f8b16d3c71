/* shadow.h: shadow rays: how far they go, and what of the light comes through to the vertex.
 *
 * Opaque surfaces stop them; media, holes and half transparent surfaces weaken them. */
#ifndef CDL_LIGHT_SHADOW_H
#define CDL_LIGHT_SHADOW_H

#include "abi/medium.h"
#include "bvh/traverse.h"
#include "lib/passable.h"
#include "media/homogeneous.h"
#include "media/stack.h"
#include "media/tracking.h"

typedef struct ShadowRay {
  vec3 origin;
  vec3 direction; /* unit */
  float distance; /* to the light, m; infinite for lights at infinity */
  float reach;    /* up to where surfaces count */
} ShadowRay;

/* Short of the light, which would else shadow its own points, by some hundred units in the last
 * place of the coordinates there. */
CDL_INLINE float shadow_reach(vec3 origin, vec3 target, float distance) {
  float size = math_max(math_max(math_abs(origin.x), math_abs(target.x)),
                        math_max(math_abs(origin.y), math_abs(target.y)));
  size = math_max(size, math_max(math_abs(origin.z), math_abs(target.z)));
  return distance < CDL_INFINITY ? math_max(fma(-3e-5f, size, distance), 0.0f) : CDL_INFINITY;
}

/* The ray of a vertex at `position` to the light that it sampled. It begins at `origin`, beside the
 * vertex, and still ends at the very point of the light. */
CDL_INLINE ShadowRay shadow_ray(vec3 position, vec3 origin, vec3 direction, float distance) {
  vec3 target = v3_madd(position, distance, direction);
  ShadowRay ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.distance = distance;
  if (distance < CDL_INFINITY) {
    ray.direction = v3_normalize(v3_sub(target, origin));
    ray.distance = v3_length(v3_sub(target, origin));
  }
  ray.reach = shadow_reach(origin, target, ray.distance);
  return ray;
}

/* The scene's surfaces, as the functions below take them and hand them on. */
#define CDL_SURFACE_ARGS                                                                           \
  CDL_GLOBAL const cdl_BvhInstance *instances, CDL_GLOBAL const cdl_Triangle *triangles,           \
      CDL_GLOBAL const cdl_Shape *shapes, CDL_GLOBAL const float *attributes,                      \
      CDL_GLOBAL const cdl_Material *materials, CDL_TEXTURE_ARGS

/* The part of the light that a hole or a half transparent surface lets through. */
CDL_INLINE float surface_transmittance(Hit hit, CDL_SURFACE_ARGS) {
  CDL_GLOBAL const cdl_Triangle *triangle = triangles + hit.primitive;
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
  CDL_GLOBAL const cdl_Material *material = materials + shape->material;
  TextureCoords uv = shape_texture_coords(shape, attributes, triangle, hit.u, hit.v);
  Texel base = material_base(material, shape, attributes, triangle, hit.u, hit.v, uv, textures,
                             texels, srgb);
  return 1.0f - material_opacity(material, base.a);
}

/* What arrives of `light` over the part of the ray from `from` to `to` metres inside the medium. */
CDL_INLINE vec3 medium_transmit(vec3 light, CDL_GLOBAL const cdl_Medium *medium, ShadowRay ray,
                                float from, float to, RandomStream *random CDL_GRID_PARAM) {
#ifdef CDL_GRIDS
  if (medium->density != CDL_NONE)
    return grid_transmit(light, medium, ray.origin, ray.direction, from, to, random CDL_GRID);
#else
  (void)ray;
  (void)random;
#endif
  vec3 extinction = v3(medium->absorption[0] + medium->scattering[0],
                       medium->absorption[1] + medium->scattering[1],
                       medium->absorption[2] + medium->scattering[2]);
  return v3_mul(light, homogeneous_transmittance(extinction, to - from));
}

/* What arrives of `radiance` on a ray that nothing opaque stops and that begins inside the media of
 * `stack`; black beyond `limit` surfaces. */
CDL_INLINE vec3 shadow_filter(vec3 radiance, ShadowRay ray, MediaStack stack, uint outside,
                              uint limit, CDL_GLOBAL const BvhNode *nodes,
                              CDL_GLOBAL const BvhTriangle *bvh_triangles, uint root,
                              CDL_GLOBAL const cdl_Medium *media, RandomStream random,
                              CDL_SURFACE_ARGS CDL_TIME_PARAM CDL_GRID_PARAM) {
  Hit last = hit_none(0.0f);
  for (uint passed = 0; passed < limit && v3_max(radiance) > 0.0f; passed++) {
    Hit hit = hit_none(0.0f);
#ifdef CDL_PASSABLE
    hit = bvh_closest_after(nodes, bvh_triangles, instances, root, ray.origin, ray.direction,
                            ray.reach, CDL_MASK_PASSABLE, last CDL_TIME(time));
#endif
    int arrived = !hit_is_some(hit);
#ifdef CDL_MEDIA
    radiance = medium_transmit(radiance, media + media_current(stack, outside), ray, last.t,
                               arrived ? ray.distance : hit.t, &random CDL_GRID);
#endif
    if (arrived) return radiance;
    CDL_GLOBAL const cdl_Material *material =
        materials + shapes[triangles[hit.primitive].shape].material;
    int repeated = hit_repeats(hit, last, ray.direction, instances, triangles, shapes,
                               attributes CDL_TIME(time));
    if (material->model != CDL_MODEL_INTERFACE) {
      float through = surface_transmittance(hit, instances, triangles, shapes, attributes,
                                            materials, textures, texels, srgb);
      radiance = v3_scale(radiance, repeated ? 1.0f : through);
    } else if (!repeated) {
      stack = hit_crossed(hit, stack, ray.direction, instances, triangles, shapes,
                          attributes CDL_TIME(time));
    }
    last = hit;
  }
  return v3_all(0.0f);
}

#endif
