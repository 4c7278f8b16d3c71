/* flatten.c: width 2. Nodes lie depth first, with the larger child next to its parent: the one that
 * a ray is likelier to go to is often in the cache. */
#include "bvh/layout.h"

LayoutSize flatten_measure(const Tree *tree, int top) {
  LayoutSize size = {1, top ? 0 : tree->count};
  if (!tree->nodes || tree->nodes[0].count) return size;
  size.nodes = 0;
  uint32_t stack[TREE_DEPTH_BOTTOM + 2], entries = 0, at = 0;
  for (;;) {
    const TreeNode *node = tree->nodes + at;
    if (!node->count) {
      size.nodes++;
      stack[entries++] = node->next;
      at++;
    } else if (entries) {
      at = stack[--entries];
    } else {
      return size;
    }
  }
}

static uint32_t depth_below(const Tree *tree, uint32_t at) {
  const TreeNode *node = tree->nodes + at;
  if (node->count) return 0;
  uint32_t left = depth_below(tree, at + 1), right = depth_below(tree, node->next);
  return 1 + (left > right ? left : right);
}

uint32_t tree_depth(const Tree *tree) {
  uint32_t depth = tree->nodes ? depth_below(tree, 0) : 0;
  return depth ? depth : 1;
}

static void write_triangle(const Source *source, uint32_t number, cdl_BvhTriangle *triangle) {
  float v[9];
  *triangle = (cdl_BvhTriangle){.primitive = source_triangle(source, number, v)};
  memcpy(triangle->v0, v, sizeof triangle->v0);
  memcpy(triangle->v1, v + 3, sizeof triangle->v1);
  memcpy(triangle->v2, v + 6, sizeof triangle->v2);
}

static void set_bounds(cdl_BvhNode *node, int child, const Box *box) {
  float bounds[6];
  box_store(box, bounds);
  for (int i = 0; i < 6; i++) node->bounds[2 * i + child] = bounds[i];
}

static uint32_t write_node(Layout *layout, const Tree *tree, uint32_t base, uint32_t at, int top);

/* The reference to a subtree: to a leaf, whose triangles lie in the order of the fragments from
 * `base` on, or to a node that is written now. */
static uint32_t write_child(Layout *layout, const Tree *tree, uint32_t base, uint32_t at, int top) {
  const TreeNode *node = tree->nodes + at;
  if (!node->count) return write_node(layout, tree, base, at, top);
  if (top) return CDL_BVH_LEAF | fragment_number(tree->fragments + node->next);
  return CDL_BVH_LEAF | (node->count - 1) << CDL_BVH_LENGTH_SHIFT | (base + node->next);
}

static uint32_t write_node(Layout *layout, const Tree *tree, uint32_t base, uint32_t at, int top) {
  uint32_t index = (uint32_t)layout->filled.nodes++;
  cdl_BvhNode *node = (cdl_BvhNode *)layout->bvh->nodes + index;
  uint32_t children[2] = {at + 1, tree->nodes[at].next};
  *node = (cdl_BvhNode){.pad = {0}};
  int larger = box_area(&tree->nodes[children[1]].box) > box_area(&tree->nodes[children[0]].box);
  for (int k = 0; k < 2; k++) {
    int i = k ^ larger;
    set_bounds(node, i, &tree->nodes[children[i]].box);
    node->child[i] = write_child(layout, tree, base, children[i], top);
  }
  return index;
}

/* A root that is no inner node: its first child is the only leaf, or empty as well. */
static uint32_t write_root(Layout *layout, const Tree *tree, uint32_t base, int top) {
  uint32_t index = (uint32_t)layout->filled.nodes++;
  cdl_BvhNode *node = (cdl_BvhNode *)layout->bvh->nodes + index;
  Box empty = box_empty();
  *node = (cdl_BvhNode){.child = {CDL_BVH_LEAF, CDL_BVH_LEAF}};
  set_bounds(node, 0, tree->nodes ? &tree->nodes[0].box : &empty);
  set_bounds(node, 1, &empty);
  if (tree->nodes) node->child[0] = write_child(layout, tree, base, 0, top);
  return index;
}

uint32_t flatten_write(Layout *layout, const Tree *tree, const Source *source) {
  uint32_t base = (uint32_t)layout->filled.triangles;
  if (source) {
    cdl_BvhTriangle *triangles = (cdl_BvhTriangle *)layout->bvh->triangles + base;
#pragma omp parallel for schedule(static)
    for (uint32_t i = 0; i < tree->count; i++)
      write_triangle(source, fragment_number(tree->fragments + i), triangles + i);
    layout->filled.triangles += tree->count;
  }
  if (!tree->nodes || tree->nodes[0].count) return write_root(layout, tree, base, !source);
  return write_node(layout, tree, base, 0, !source);
}
