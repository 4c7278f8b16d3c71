/* test_bvh8.c: the builder and ray queries, eight-child layout. */
#define CDL_BVH_WIDTH 8
#include "bvh_cases.h"
