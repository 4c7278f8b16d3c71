/* statistics.h: what is said about a tree. Internal to bvh/. */
#ifndef CANDELA_BVH_STATISTICS_H
#define CANDELA_BVH_STATISTICS_H

#include "bvh/bvh.h"
#include "bvh/tree.h"

/* Adds the leaves of a mesh's tree; returns its SAH cost, in node visits and triangle tests. */
double bvh_statistics_add(cdl_BvhStatistics *statistics, const Tree *tree);

#endif
