/* surface.h: the geometry of a hit: position, normals and tangent in the world. */
#ifndef CDL_SURFACE_H
#define CDL_SURFACE_H

#include "abi/bvh.h"
#include "abi/geometry.h"
#include "lib/frame.h"
#include "lib/math.h"
#include "lib/motion.h"
#include "lib/transform.h"

typedef struct SurfacePoint {
  vec3 position;
  vec3 geometric;   /* unit; of the front side */
  vec3 normal;      /* unit; interpolated, of the front side */
  vec3 tangent;     /* of any length, not yet orthogonal; zero where the shape has none */
  float handedness; /* bitangent = handedness x (normal x tangent) */
} SurfacePoint;

CDL_INLINE vec3 barycentric(vec3 a, vec3 b, vec3 c, float u, float v) {
  return v3_madd(v3_madd(v3_scale(a, 1.0f - u - v), u, b), v, c);
}

/* Baked shapes are in the world already, and their instance's transform is the identity. */
CDL_INLINE SurfacePoint surface_point(CDL_GLOBAL const cdl_BvhInstance *instance,
                                      CDL_GLOBAL const cdl_Shape *shape,
                                      CDL_GLOBAL const float *attributes,
                                      CDL_GLOBAL const cdl_Triangle *triangle, float u,
                                      float v CDL_TIME_PARAM) {
  uint c0 = triangle->corner[0];
  uint c1 = triangle->corner[1];
  uint c2 = triangle->corner[2];
  Transform to_world = transform_load(instance->to_world);
  Transform to_object = transform_load(instance->to_object);

  size_t positions = shape->positions;
  size_t step = 3u * (size_t)shape->key_stride;
  vec3 p0 = attribute_at(attributes, positions + 3u * c0, step CDL_TIME(time));
  vec3 p1 = attribute_at(attributes, positions + 3u * c1, step CDL_TIME(time));
  vec3 p2 = attribute_at(attributes, positions + 3u * c2, step CDL_TIME(time));
  vec3 flat_normal = v3_cross(v3_sub(p1, p0), v3_sub(p2, p0));

  int smooth = shape->normals != CDL_NONE;
  size_t normals = smooth ? shape->normals : positions;
  vec3 n0 = attribute_at(attributes, normals + 3u * c0, step CDL_TIME(time));
  vec3 n1 = attribute_at(attributes, normals + 3u * c1, step CDL_TIME(time));
  vec3 n2 = attribute_at(attributes, normals + 3u * c2, step CDL_TIME(time));
  vec3 blended = barycentric(n0, n1, n2, u, v);
  smooth = smooth & (v3_length2(blended) > 1e-12f);

  int has_tangent = shape->tangents != CDL_NONE;
  size_t tangents = has_tangent ? shape->tangents : 0u;
  uint stride = has_tangent ? 4u : 0u;
  size_t turn = stride * (size_t)shape->key_stride;
  vec3 t0 = attribute_at(attributes, tangents + stride * c0, turn CDL_TIME(time));
  vec3 t1 = attribute_at(attributes, tangents + stride * c1, turn CDL_TIME(time));
  vec3 t2 = attribute_at(attributes, tangents + stride * c2, turn CDL_TIME(time));
  float handedness = attributes[tangents + stride * c0 + 3u];

  SurfacePoint s;
  s.position = transform_point(to_world, barycentric(p0, p1, p2, u, v));
  s.geometric = v3_normalize(transform_transposed(to_object, flat_normal));
  vec3 normal = v3_normalize(transform_transposed(to_object, blended));
  s.normal = v3_select(smooth, normal, s.geometric);
  vec3 tangent = transform_direction(to_world, barycentric(t0, t1, t2, u, v));
  s.tangent = v3_select(has_tangent, tangent, v3_all(0.0f));
  float volume = v3_dot(to_world.x, v3_cross(to_world.y, to_world.z));
  int turned = (has_tangent & (handedness < 0.0f)) ^ (volume < 0.0f); /* mirrors turn it */
  s.handedness = turned ? -1.0f : 1.0f;
  return s;
}

/* Bends a shading normal that the path sees from behind towards it, until it sees it at a grazing
 * angle: what is left of the normal's own tilt stays, and no pixel goes black. */
CDL_INLINE vec3 surface_face_path(vec3 normal, vec3 wo) {
  float cosine = v3_dot(normal, wo);
  float bend = cosine < 0.01f ? 0.01f - cosine : 0.0f;
  return v3_normalize(v3_madd(normal, bend, wo));
}

/* The scene's node that a surface is of. */
CDL_INLINE uint surface_object(CDL_GLOBAL const cdl_Shape *shape,
                               CDL_GLOBAL const cdl_BvhInstance *instance) {
  return shape->object != CDL_NONE ? shape->object : instance->object;
}

/* The medium behind a surface. */
CDL_INLINE uint surface_medium(CDL_GLOBAL const cdl_Shape *shape,
                               CDL_GLOBAL const cdl_BvhInstance *instance) {
#ifdef CDL_GRIDS
  return shape->medium != CDL_NONE ? shape->medium : instance->medium;
#else
  (void)instance;
  return shape->medium;
#endif
}

#endif
