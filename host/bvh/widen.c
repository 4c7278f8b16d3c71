/* widen.c: width 8. A node takes the place of up to seven of the binary tree: the child with the
 * largest box is opened until there are eight (Wald, Benthin, Boulos 2008, "Getting Rid of
 * Packets"). Where that would make ways too deep for the kernels' stack, children are opened level
 * by level. */
#include "bvh/layout.h"

enum { WIDTH = 8, STACK_TOP = 64, STACK_BOTTOM = CDL_BVH8_STACK - STACK_TOP - 1 };

/* Subtrees of the binary tree that become the children of one node, in order of opening. */
typedef struct Children {
  uint32_t at[WIDTH], depth[WIDTH];
  int count;
} Children;

/* Which child to open next; -1: all are leaves. */
static int choose_open(const Tree *tree, const Children *children, int by_area) {
  int chosen = -1;
  float best = -1.0f;
  for (int i = 0; i < children->count; i++) {
    const TreeNode *node = tree->nodes + children->at[i];
    float value = by_area ? box_area(&node->box) : 100.0f - (float)children->depth[i];
    if (node->count || !(value > best)) continue;
    chosen = i;
    best = value;
  }
  return chosen;
}

static Children gather(const Tree *tree, uint32_t at, int by_area) {
  Children children = {.at = {at}, .count = 1};
  int open = 0;
  if (tree->nodes[at].count) return children;
  while (open >= 0 && children.count < WIDTH) {
    uint32_t opened = children.at[open], depth = children.depth[open] + 1;
    children.at[open] = opened + 1;
    children.at[children.count] = tree->nodes[opened].next;
    children.depth[open] = children.depth[children.count] = depth;
    children.count++;
    open = choose_open(tree, &children, by_area);
  }
  return children;
}

/* Entries that wait while the ray is at the end of the worst way below `at`. */
static uint32_t stack_below(const Tree *tree, uint32_t at, int by_area) {
  Children children = gather(tree, at, by_area);
  uint32_t most = 0;
  for (int i = 0; i < children.count; i++) {
    if (tree->nodes[children.at[i]].count) continue;
    uint32_t below = stack_below(tree, children.at[i], by_area);
    if (below > most) most = below;
  }
  return most + (uint32_t)children.count - 1;
}

static int may_go_by_area(const Tree *tree, int top) {
  return !tree->nodes || stack_below(tree, 0, 1) <= (uint32_t)(top ? STACK_TOP : STACK_BOTTOM);
}

static uint32_t groups(uint32_t count) { return (count + 3) / 4; }

static void measure_below(const Tree *tree, uint32_t at, int by_area, LayoutSize *size) {
  Children children = gather(tree, at, by_area);
  size->nodes++;
  for (int i = 0; i < children.count; i++) {
    uint32_t count = tree->nodes[children.at[i]].count;
    if (count)
      size->triangles += groups(count);
    else
      measure_below(tree, children.at[i], by_area, size);
  }
}

LayoutSize widen_measure(const Tree *tree, int top) {
  LayoutSize size = {0, 0};
  if (!tree->nodes) return (LayoutSize){1, 0};
  measure_below(tree, 0, may_go_by_area(tree, top), &size);
  if (top) size.triangles = 0;
  return size;
}

/* What is being written, and how. */
typedef struct Writer {
  Layout *layout;
  const Tree *tree;
  const Source *source;
  int by_area;
} Writer;

static void write_group(cdl_BvhTriangle4 *group, const Writer *w, const Fragment *fragments,
                        uint32_t count) {
  for (uint32_t lane = 0; lane < 4; lane++) {
    float v[9] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    group->primitive[lane] = CDL_NONE;
    if (lane < count)
      group->primitive[lane] = source_triangle(w->source, fragment_number(fragments + lane), v);
    for (int i = 0; i < 9; i++) group->v[4 * i + (int)lane] = v[i];
  }
}

static uint32_t write_leaf(const Writer *w, const TreeNode *leaf) {
  const Fragment *fragments = w->tree->fragments + leaf->next;
  if (!w->source) return CDL_BVH_LEAF | fragment_number(fragments);
  uint32_t first = (uint32_t)w->layout->filled.triangles, length = groups(leaf->count);
  cdl_BvhTriangle4 *triangles = (cdl_BvhTriangle4 *)w->layout->bvh->triangles + first;
  for (uint32_t i = 0; i < length; i++)
    write_group(triangles + i, w, fragments + 4 * i, leaf->count - 4 * i);
  w->layout->filled.triangles += length;
  return CDL_BVH_LEAF | (length - 1) << CDL_BVH_LENGTH_SHIFT | first;
}

static void set_bounds(cdl_BvhNode8 *node, int child, const Box *box) {
  float bounds[6];
  box_store(box, bounds);
  for (int i = 0; i < 6; i++) node->bounds[8 * i + child] = bounds[i];
}

static cdl_BvhNode8 *new_node(const Writer *w, uint32_t *index, const Box *box) {
  Box empty = box_empty();
  *index = (uint32_t)w->layout->filled.nodes++;
  cdl_BvhNode8 *node = (cdl_BvhNode8 *)w->layout->bvh->nodes + *index;
  *node = (cdl_BvhNode8){.pad = {0}};
  box_store(box, node->all);
  for (int i = 0; i < WIDTH; i++) {
    set_bounds(node, i, &empty);
    node->child[i] = CDL_BVH_LEAF;
  }
  return node;
}

static uint32_t write_node(const Writer *w, uint32_t at) {
  Children children = gather(w->tree, at, w->by_area);
  uint32_t index;
  cdl_BvhNode8 *node = new_node(w, &index, &w->tree->nodes[at].box);
  for (int i = 0; i < children.count; i++) {
    const TreeNode *child = w->tree->nodes + children.at[i];
    set_bounds(node, i, &child->box);
    node->child[i] = child->count ? write_leaf(w, child) : write_node(w, children.at[i]);
  }
  return index;
}

uint32_t widen_write(Layout *layout, const Tree *tree, const Source *source) {
  Writer w = {layout, tree, source, may_go_by_area(tree, !source)};
  if (tree->nodes) return write_node(&w, 0);
  Box empty = box_empty();
  uint32_t index;
  new_node(&w, &index, &empty);
  return index;
}
