/* test_bvh.c: the builder and ray queries, two-child layout. */
#define CDL_BVH_WIDTH 2
#include "bvh_cases.h"
