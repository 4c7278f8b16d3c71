/* traverse2.h: traversal of the two-child layout; included by traverse.h.
 *
 * One loop for both levels. The ray goes on into the nearer child; the farther one waits on the
 * stack with the distance at which it is entered, and is dropped unseen if a nearer hit was found
 * meanwhile. While the loop is inside an instance, entries up to `base` belong to the top level. */
#ifndef CDL_BVH_TRAVERSE2_H
#define CDL_BVH_TRAVERSE2_H

#include "bvh/triangle.h"

#if CDL_BVH_WIDTH == 2

typedef cdl_BvhNode BvhNode;
typedef cdl_BvhTriangle BvhTriangle;

/* Tests the triangles of a leaf; 1 if one became the best hit. */
CDL_INLINE int bvh_leaf(BvhRay ray, CDL_GLOBAL const BvhTriangle *triangles, uint leaf,
                        BvhQuery *query) {
  uint first = leaf & CDL_BVH_INDEX;
  uint last = first + ((leaf & ~CDL_BVH_LEAF) >> CDL_BVH_LENGTH_SHIFT);
  int taken = 0;
  for (uint i = first; i <= last; i++) {
    CDL_GLOBAL const BvhTriangle *w = triangles + i;
    float t, u, v;
    if (!triangle_test(ray, triangle_shear(ray, w->v0, w->v1, w->v2), &t, &u, &v)) continue;
    float enter =
        triangle_enter(ray, v3(w->v0[0], w->v0[1], w->v0[2]), v3(w->v1[0], w->v1[1], w->v1[2]),
                       v3(w->v2[0], w->v2[1], w->v2[2]));
    taken |= bvh_take(query, t, u, v, w->primitive, enter);
  }
  return taken;
}

/* The ray in world space, padded for the whole scene. */
CDL_INLINE BvhRay bvh_ray_in_world(CDL_GLOBAL const BvhNode *root, vec3 o, vec3 d) {
  CDL_GLOBAL const float *a = root->bounds[0], *b = root->bounds[1];
  return bvh_ray(o, d, v3(bvh_min(a[0], b[0]), bvh_min(a[1], b[1]), bvh_min(a[2], b[2])),
                 v3(bvh_max(a[3], b[3]), bvh_max(a[4], b[4]), bvh_max(a[5], b[5])),
                 BVH_PAD_INSTANCES);
}

/* The best hit after `after`, or with `any` set just some hit. */
CDL_INLINE Hit bvh_search(CDL_GLOBAL const BvhNode *nodes, CDL_GLOBAL const BvhTriangle *triangles,
                          CDL_GLOBAL const cdl_BvhInstance *instances, uint root, vec3 o, vec3 d,
                          float tmax, uint mask, Hit after, int any) {
  uint stack[CDL_BVH_STACK];
  float enters[CDL_BVH_STACK];
  BvhQuery query;
  query.best = hit_none(tmax);
  query.after = after;
  query.instance_enter = 0.0f;
  query.instance = CDL_NONE;
  BvhRay world = bvh_ray_in_world(nodes + root, o, d);
  BvhRay ray = world;
  if (!bvh_ray_is_usable(world)) return query.best;
  uint top = 0u, base = 0u, current = root;
  float enter = 0.0f;
  int inside = 0;
  for (;;) {
    if ((current & CDL_BVH_LEAF) == 0u) {
      CDL_GLOBAL const BvhNode *node = nodes + current;
      float enter0 = bvh_box(ray, node->bounds[0], query.best.t);
      float enter1 = bvh_box(ray, node->bounds[1], query.best.t);
      uint near_child = enter1 < enter0 ? 1u : 0u;
      enter = bvh_min(enter0, enter1);
      float later = bvh_max(enter0, enter1);
      if (enter < CDL_INFINITY) {
        current = node->child[near_child];
        if (later < CDL_INFINITY) {
          stack[top] = node->child[1u - near_child];
          enters[top++] = later;
        }
        continue;
      }
    } else if (inside) {
      if (bvh_leaf(ray, triangles, current, &query) && any) return query.best;
    } else {
      CDL_GLOBAL const cdl_BvhInstance *instance = instances + (current & CDL_BVH_INDEX);
      if ((instance->mask & mask) != 0u) {
        ray = bvh_ray_in_instance(instance, o, d);
        query.instance_enter = enter;
        query.instance = current & CDL_BVH_INDEX;
        inside = 1;
        base = top;
        current = instance->root;
        if (bvh_ray_is_usable(ray)) continue;
      }
    }
    do {
      if (top == base) {
        if (!inside || top == 0u) return query.best;
        ray = world;
        inside = 0;
        base = 0u;
      }
      enter = enters[--top];
      current = stack[top];
    } while (enter > query.best.t);
  }
}

#endif
#endif
