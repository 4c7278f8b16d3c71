/* passable.h: surfaces that light goes straight through: boundaries of media, holes, half
 * transparent surfaces. Used where a whole segment is followed at once. */
#ifndef CDL_PASSABLE_H
#define CDL_PASSABLE_H

#include "abi/bvh.h"
#include "bvh/hit.h"
#include "lib/material.h"
#include "lib/motion.h"
#include "lib/surface.h"
#include "lib/transform.h"
#include "media/stack.h"

/* Geometric normal of the front, of any length. */
CDL_INLINE vec3 hit_normal(Hit hit, CDL_GLOBAL const cdl_BvhInstance *instances,
                           CDL_GLOBAL const cdl_Triangle *triangles,
                           CDL_GLOBAL const cdl_Shape *shapes,
                           CDL_GLOBAL const float *attributes CDL_TIME_PARAM) {
  CDL_GLOBAL const cdl_Triangle *triangle = triangles + hit.primitive;
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
  size_t p = shape->positions;
  size_t step = 3u * (size_t)shape->key_stride;
  vec3 a = attribute_at(attributes, p + 3u * (size_t)triangle->corner[0], step CDL_TIME(time));
  vec3 b = attribute_at(attributes, p + 3u * (size_t)triangle->corner[1], step CDL_TIME(time));
  vec3 c = attribute_at(attributes, p + 3u * (size_t)triangle->corner[2], step CDL_TIME(time));
  Transform to_object = transform_load(instances[hit.instance].to_object);
  return transform_transposed(to_object, v3_cross(v3_sub(b, a), v3_sub(c, a)));
}

/* Whether a ray along `direction` meets the front of the triangle: whether it enters. */
CDL_INLINE int hit_enters(Hit hit, vec3 direction, CDL_GLOBAL const cdl_BvhInstance *instances,
                          CDL_GLOBAL const cdl_Triangle *triangles,
                          CDL_GLOBAL const cdl_Shape *shapes,
                          CDL_GLOBAL const float *attributes CDL_TIME_PARAM) {
  vec3 normal = hit_normal(hit, instances, triangles, shapes, attributes CDL_TIME(time));
  return v3_dot(normal, direction) < 0.0f;
}

/* Whether `hit` is the same crossing as the `last` hit of its ray: a ray through an edge meets the
 * triangles on both sides of it, at distances that are rounded apart, but crosses the surface once.
 */
CDL_INLINE int hit_repeats(Hit hit, Hit last, vec3 direction,
                           CDL_GLOBAL const cdl_BvhInstance *instances,
                           CDL_GLOBAL const cdl_Triangle *triangles,
                           CDL_GLOBAL const cdl_Shape *shapes,
                           CDL_GLOBAL const float *attributes CDL_TIME_PARAM) {
  if (!hit_is_some(hit) || !hit_is_some(last) || hit.instance != last.instance) return 0;
  if (triangles[hit.primitive].shape != triangles[last.primitive].shape) return 0;
  if (hit.t - last.t > 1e-6f * hit.t) return 0;
  return hit_enters(hit, direction, instances, triangles, shapes, attributes CDL_TIME(time)) ==
         hit_enters(last, direction, instances, triangles, shapes, attributes CDL_TIME(time));
}

CDL_INLINE MediaStack hit_crossed(Hit hit, MediaStack stack, vec3 direction,
                                  CDL_GLOBAL const cdl_BvhInstance *instances,
                                  CDL_GLOBAL const cdl_Triangle *triangles,
                                  CDL_GLOBAL const cdl_Shape *shapes,
                                  CDL_GLOBAL const float *attributes CDL_TIME_PARAM) {
  int enters = hit_enters(hit, direction, instances, triangles, shapes, attributes CDL_TIME(time));
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangles[hit.primitive].shape;
  return media_crossed(stack, surface_medium(shape, instances + hit.instance), enters);
}

#endif
