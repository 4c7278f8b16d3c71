/* frame.h: right-handed orthonormal frames; z is the normal, x the tangent, y the bitangent. */
#ifndef CDL_FRAME_H
#define CDL_FRAME_H

#include "lib/math.h"
#include "lib/vec.h"

typedef struct Frame {
  vec3 x, y, z;
} Frame;

/* A frame about a unit normal, without a branch (Duff et al. 2017, "Building an Orthonormal Basis,
 * Revisited"). It jumps at the plane z = 0, as every such frame does somewhere. */
CDL_INLINE Frame frame_from_normal(vec3 n) {
  float sign = math_sign(n.z);
  float a = -1.0f / (sign + n.z);
  float b = n.x * n.y * a;
  Frame f;
  f.x = v3(fma(sign * n.x * n.x, a, 1.0f), sign * b, -(sign * n.x));
  f.y = v3(b, fma(n.y * n.y, a, sign), -n.y);
  f.z = n;
  return f;
}

/* A frame about unit normal n whose x axis lies in the plane of n and `tangent`, which need be
 * neither of unit length nor orthogonal. A tangent that is zero, or within 0.06 degrees of +-n,
 * gives the x axis of frame_from_normal. The bitangent of a mirrored texture (glTF's tangent.w =
 * -1) is -y. */
CDL_INLINE Frame frame_from_tangent(vec3 n, vec3 tangent) {
  float size = math_abs(tangent.x);
  size = math_max(size, math_abs(math_after(size, tangent.y)));
  size = math_max(size, math_abs(math_after(size, tangent.z)));
  vec3 t = v3(tangent.x / (size > 0.0f ? size : 1.0f), tangent.y / (size > 0.0f ? size : 1.0f),
              tangent.z / (size > 0.0f ? size : 1.0f));
  t = v3_madd(t, -v3_dot(t, n), n);
  int usable = v3_length2(t) > 1e-6f;
  /* Again, because the first projection cancels when the tangent is near the normal. */
  t = v3_normalize(t);
  t = v3_normalize(v3_madd(t, -v3_dot(t, n), n));
  Frame f;
  f.x = v3_select(usable, t, frame_from_normal(n).x);
  f.y = v3_cross(n, f.x);
  f.z = n;
  return f;
}

/* A frame of a unit normal and a unit tangent that is orthogonal to it. */
CDL_INLINE Frame frame_orthonormal(vec3 n, vec3 tangent) {
  Frame f;
  f.x = tangent;
  f.y = v3_cross(n, tangent);
  f.z = n;
  return f;
}

CDL_INLINE vec3 frame_to_local(Frame f, vec3 v) {
  return v3(v3_dot(v, f.x), v3_dot(v, f.y), v3_dot(v, f.z));
}

CDL_INLINE vec3 frame_to_world(Frame f, vec3 v) {
  return v3_madd(v3_madd(v3_scale(f.x, v.x), v.y, f.y), v.z, f.z);
}

#endif
