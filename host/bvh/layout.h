/* layout.h: from binary trees to the nodes and triangles that kernels read. Internal to bvh/.
 *
 * Each tree is first measured, then written behind those before it. */
#ifndef CANDELA_BVH_LAYOUT_H
#define CANDELA_BVH_LAYOUT_H

#include "bvh/source.h"

/* How much a tree needs, or how much has been written. */
typedef struct LayoutSize {
  uint64_t nodes;
  uint64_t triangles; /* width 8: groups of four */
} LayoutSize;

typedef struct Layout {
  cdl_Bvh *bvh;      /* with its arrays allocated */
  LayoutSize filled; /* where the next tree goes */
} Layout;

/* `top`: leaves are instances, of which one is in each leaf. An empty tree needs a node, too. */
LayoutSize flatten_measure(const Tree *tree, int top);
LayoutSize widen_measure(const Tree *tree, int top);

/* Writes a tree and returns its root. `source` holds the triangles; NULL: the leaves are instances.
 */
uint32_t flatten_write(Layout *layout, const Tree *tree, const Source *source);
uint32_t widen_write(Layout *layout, const Tree *tree, const Source *source);

/* Inner nodes on the longest way; at least 1. */
uint32_t tree_depth(const Tree *tree);

#endif
