/* tree.h: the binary tree that every layout is made from, and how it is built. Internal to bvh/. */
#ifndef CANDELA_BVH_TREE_H
#define CANDELA_BVH_TREE_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Depths (inner nodes on a way from root to leaf) that the kernels' stacks allow. */
enum { TREE_DEPTH_TOP = 24, TREE_DEPTH_BOTTOM = 38, TREE_BINS = 32 };

/* A box as min and negated max, so that growing it is eight times the same minimum. Lanes 3 and 7
 * do not count. */
typedef struct Box {
  float side[8]; /* min x y z, -, -max x y z, - */
} Box;

/* What is built over, a triangle or an instance: its box, with its number in lane 3. */
typedef struct Fragment {
  Box box;
} Fragment;

/* count 0: an inner node with children at index + 1 and `next`; else a leaf of the fragments next …
 * next + count - 1. */
typedef struct TreeNode {
  Box box;
  uint32_t next;
  uint32_t count;
} TreeNode;

/* Nodes lie depth first, with gaps: a subtree over n fragments owns 2 n - 1 places. */
typedef struct Tree {
  TreeNode *nodes; /* NULL for an empty tree */
  Fragment *fragments;
  uint32_t count; /* fragments */
} Tree;

typedef struct TreeOptions {
  int bins, leaf_max, depth_max;
  int group;       /* triangles tested at once */
  float leaf_cost; /* of testing one group, in units of visiting a node */
} TreeOptions;

static inline Box box_empty(void) {
  Box box;
  for (int i = 0; i < 8; i++) box.side[i] = INFINITY;
  return box;
}

static inline void box_grow(Box *box, const Box *other) {
  for (int i = 0; i < 8; i++)
    box->side[i] = other->side[i] < box->side[i] ? other->side[i] : box->side[i];
}

/* Half the surface; 0 if empty. */
static inline float box_area(const Box *box) {
  float x = -box->side[4] - box->side[0];
  float y = -box->side[5] - box->side[1];
  float z = -box->side[6] - box->side[2];
  return x >= 0.0f ? x * y + y * z + z * x : 0.0f;
}

/* Writes min x y z, max x y z. */
static inline void box_store(const Box *box, float bounds[6]) {
  for (int i = 0; i < 3; i++) {
    bounds[i] = box->side[i];
    bounds[i + 3] = -box->side[i + 4];
  }
}

static inline uint32_t fragment_number(const Fragment *fragment) {
  uint32_t number;
  memcpy(&number, &fragment->box.side[3], sizeof number);
  return number;
}

static inline void fragment_set(Fragment *fragment, const Box *box, uint32_t number) {
  fragment->box = *box;
  memcpy(&fragment->box.side[3], &number, sizeof number);
}

/* Builds over tree->fragments, which it reorders. 0, or -1 when memory is short. Calls nest in an
 * OpenMP parallel region or open one. The tree is the same for any number of threads. tree->nodes
 * is to be freed by the caller. */
int tree_build(Tree *tree, const TreeOptions *options);

#endif
