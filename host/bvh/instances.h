/* instances.h: meshes placed in the world. Internal to bvh/. */
#ifndef CANDELA_BVH_INSTANCES_H
#define CANDELA_BVH_INSTANCES_H

#include "bvh/bvh.h"
#include "bvh/tree.h"

/* Fills all of an instance but its root. False if no ray can hit it: its mesh is empty, its matrix
 * cannot be inverted, or its box is not finite. */
int instance_place(const cdl_BvhPlacement *placement, const Tree *mesh, cdl_BvhInstance *instance);

#endif
