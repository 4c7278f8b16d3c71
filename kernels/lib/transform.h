/* transform.h: 3x4 row-major matrices on points, directions and normals. */
#ifndef CDL_TRANSFORM_H
#define CDL_TRANSFORM_H

#include "lib/vec.h"

typedef struct Transform {
  vec3 x, y, z; /* rows of the linear part */
  vec3 move;
} Transform;

CDL_INLINE Transform transform_load(CDL_GLOBAL const float *m) {
  Transform t;
  t.x = v3(m[0], m[1], m[2]);
  t.y = v3(m[4], m[5], m[6]);
  t.z = v3(m[8], m[9], m[10]);
  t.move = v3(m[3], m[7], m[11]);
  return t;
}

CDL_INLINE vec3 transform_direction(Transform t, vec3 d) {
  return v3(v3_dot(t.x, d), v3_dot(t.y, d), v3_dot(t.z, d));
}

CDL_INLINE vec3 transform_point(Transform t, vec3 p) {
  return v3_add(transform_direction(t, p), t.move);
}

/* Multiplies by the transpose of the linear part: with a matrix from world to object space this
 * takes normals from object to world space, not of unit length. */
CDL_INLINE vec3 transform_transposed(Transform t, vec3 n) {
  return v3_madd(v3_madd(v3_scale(t.x, n.x), n.y, t.y), n.z, t.z);
}

#endif
