/* hit.h: what a ray query answers. */
#ifndef CDL_BVH_HIT_H
#define CDL_BVH_HIT_H

#include "abi/bvh.h"
#include "lib/vec.h"

/* The point hit is o + t d, or (1 - u - v) v0 + u v1 + v v2 in object space. Nothing hit: primitive
 * is CDL_NONE. Twenty bytes, for the reason given in lib/vec.h. */
typedef struct Hit {
  float t, u, v;
  uint primitive; /* global triangle number */
  uint instance;
} Hit;

CDL_INLINE Hit hit_none(float t) {
  Hit hit;
  hit.t = t;
  hit.u = 0.0f;
  hit.v = 0.0f;
  hit.primitive = CDL_NONE;
  hit.instance = CDL_NONE;
  return hit;
}

CDL_INLINE int hit_is_some(Hit hit) { return hit.primitive != CDL_NONE; }

/* Hits are ordered by distance, then instance, then primitive: a total order, so that the nearest
 * hit of a ray is one and the same whatever the order of traversal. */
CDL_INLINE int hit_before(Hit a, Hit b) {
  int tie = a.instance < b.instance || (a.instance == b.instance && a.primitive < b.primitive);
  return a.t < b.t || (a.t == b.t && tie);
}

#endif
