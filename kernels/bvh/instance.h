/* instance.h: both levels of a ray query, the same for both layouts; included by traverse.h.
 *
 * The layout's file provides BvhStack, what waits and where the ray enters it; bvh_ray_in_world(),
 * the ray among the instances; bvh_enter(), which tests a node's children and returns the one to go
 * to, with the others on the stack, or CDL_NONE if none is hit before `limit`; bvh_enter_all(),
 * which puts all of them on the stack and returns its new top; and bvh_leaf(), which is 1 if a
 * triangle of the leaf became the best hit. */
#ifndef CDL_BVH_INSTANCE_H
#define CDL_BVH_INSTANCE_H

#include "bvh/triangle.h"

/* A ray in an instance's space; t is the same in both spaces. */
CDL_INLINE BvhRay bvh_ray_in_instance(CDL_GLOBAL const cdl_BvhInstance *instance, vec3 o, vec3 d) {
  CDL_GLOBAL const float *m = instance->to_object;
  CDL_GLOBAL const float *box = instance->object_bounds;
  if ((instance->flags & CDL_INSTANCE_IDENTITY) == 0u) {
    o = v3(fma(m[0], o.x, fma(m[1], o.y, fma(m[2], o.z, m[3]))),
           fma(m[4], o.x, fma(m[5], o.y, fma(m[6], o.z, m[7]))),
           fma(m[8], o.x, fma(m[9], o.y, fma(m[10], o.z, m[11]))));
    d = v3(fma(m[0], d.x, fma(m[1], d.y, m[2] * d.z)), fma(m[4], d.x, fma(m[5], d.y, m[6] * d.z)),
           fma(m[8], d.x, fma(m[9], d.y, m[10] * d.z)));
  }
  return bvh_ray(o, d, v3(box[0], box[1], box[2]), v3(box[3], box[4], box[5]), BVH_PAD);
}

/* Searches a mesh with the stack from `base` up; 1 if `any` is set and something was hit. */
CDL_INLINE int bvh_search_mesh(CDL_GLOBAL const BvhNode *nodes,
                               CDL_GLOBAL const BvhTriangle *triangles, BvhRay ray, uint root,
                               int any, BvhStack *stack, uint base, BvhQuery *query) {
  uint top = base, current = root;
  for (;;) {
    if ((current & CDL_BVH_LEAF) == 0u) {
      current = bvh_enter(ray, nodes, current, query->best.t, any, stack, &top);
      if (current != CDL_NONE) continue;
    } else if (bvh_leaf(ray, triangles, current, query) && any) {
      return 1;
    }
    do {
      if (top == base) return 0;
      top--;
    } while (!any && stack->enter[top] > query->best.t);
    current = stack->child[top];
  }
}

/* The best hit after `after`, or with `any` set just some hit. The tree's root may be a leaf, its
 * only instance; then there is no top level to search. */
CDL_INLINE Hit bvh_search(CDL_GLOBAL const BvhNode *nodes, CDL_GLOBAL const BvhTriangle *triangles,
                          CDL_GLOBAL const cdl_BvhInstance *instances, uint root, vec3 o, vec3 d,
                          float tmax, uint mask, Hit after, int any CDL_TIME_PARAM) {
  BvhStack stack;
  BvhQuery query;
  BvhRay world;
  uint top = 1u;
  stack.child[0] = root;
  stack.enter[0] = 0.0f;
  query.best = hit_none(tmax);
  query.after = after;
#ifdef CDL_MOTION
  query.time = time;
#endif
  if ((root & CDL_BVH_LEAF) == 0u) {
    world = bvh_ray_in_world(nodes + root, o, d);
    if (!bvh_ray_is_usable(world)) return query.best;
  }
  while (top != 0u) {
    uint current = stack.child[--top];
    query.instance_enter = stack.enter[top];
    if (query.instance_enter > query.best.t) continue;
    if ((current & CDL_BVH_LEAF) == 0u) {
      top = bvh_enter_all(world, nodes, current, query.best.t, &stack, top);
      continue;
    }
    query.instance = current & CDL_BVH_INDEX;
    CDL_GLOBAL const cdl_BvhInstance *instance = instances + query.instance;
    if ((instance->mask & mask) == 0u) continue;
    BvhRay ray = bvh_ray_in_instance(instance, o, d);
    if (!bvh_ray_is_usable(ray)) continue;
    if (bvh_search_mesh(nodes, triangles, ray, instance->root, any, &stack, top, &query)) break;
  }
  return query.best;
}

#endif
