/* build.c: from meshes and placements to the arrays that kernels read. */
#include "bvh/bvh.h"

#include <stdlib.h>
#include <sys/mman.h>

#include "bvh/instances.h"
#include "bvh/layout.h"
#include "bvh/motion.h"
#include "bvh/statistics.h"
#include "core/clock.h"
#include "core/log.h"

/* What a width stands for. */
typedef struct Width {
  size_t node_size, triangle_size;
  TreeOptions tree;
  int leaf_limit;
  LayoutSize (*measure)(const Tree *tree, int top);
  uint32_t (*write)(Layout *layout, const Tree *tree, const Source *source);
} Width;

static const Width widths[2] = {
    {sizeof(cdl_BvhNode),
     sizeof(cdl_BvhTriangle),
     {TREE_BINS, 4, TREE_DEPTH_BOTTOM, 1, 0.5f},
     8,
     flatten_measure,
     flatten_write},
    {sizeof(cdl_BvhNode8),
     sizeof(cdl_BvhTriangle4),
     {TREE_BINS, 4, TREE_DEPTH_BOTTOM, 4, 1.0f},
     32,
     widen_measure,
     widen_write},
};

/* A build on its way: meshes' trees, then the tree of the instances. */
typedef struct Build {
  const cdl_Log *log;
  Width width;
  Source *sources;
  Tree *trees;
  uint32_t mesh_count;
  Tree top;
  cdl_Bvh *bvh;
} Build;

static cdl_Status no_memory(const Build *b, const char *what, size_t bytes) {
  return log_fail(b->log, CDL_BAD_INPUT,
                  "BVH: no memory for %s (%.1f MiB): use a smaller scene or a machine with more "
                  "memory.",
                  what, (double)bytes / 1048576.0);
}

static Width choose_width(const cdl_BvhOptions *options) {
  cdl_BvhOptions none = {0};
  if (!options) options = &none;
  Width width = widths[options->width == 8];
  if (options->bins > 0) width.tree.bins = options->bins < TREE_BINS ? options->bins : TREE_BINS;
  if (width.tree.bins < 2) width.tree.bins = 2;
  if (options->leaf_max > 0)
    width.tree.leaf_max =
        options->leaf_max < width.leaf_limit ? options->leaf_max : width.leaf_limit;
  return width;
}

/* Arrays for kernels: zeroed, and at least 64 bytes so that a buffer exists. Large ones ask for
 * huge pages: rays jump about in them, and with small pages half of their time goes into page
 * walks. */
static void *allocate(size_t *bytes) {
  const size_t huge = (size_t)2 << 20;
  size_t align = *bytes >= huge ? huge : 64;
  size_t size = *bytes ? (*bytes + align - 1) / align * align : align;
  void *memory = aligned_alloc(align, size);
  if (!memory) return NULL;
#ifdef MADV_HUGEPAGE
  if (align == huge) madvise(memory, size, MADV_HUGEPAGE); /* only a wish */
#endif
  memset(memory, 0, size);
  if (*bytes == 0) *bytes = 64;
  return memory;
}

static cdl_Status build_mesh(Build *b, uint32_t index, const cdl_BvhMesh *mesh) {
  Source *source = b->sources + index;
  Tree *tree = b->trees + index;
  if (source_open(source, mesh) || source->count > CDL_BVH_INDEX)
    return log_fail(b->log, CDL_BAD_INPUT,
                    "BVH: mesh %u has more than %u triangles or memory is short: split the scene.",
                    index, CDL_BVH_INDEX);
  size_t bytes = source->count * sizeof *tree->fragments;
  tree->fragments = malloc(bytes ? bytes : 1);
  if (!tree->fragments) return no_memory(b, "a mesh's triangles", bytes);
  b->bvh->statistics.dropped += source_fragments(source, tree->fragments, &tree->count);
  if (tree_build(tree, &b->width.tree))
    return no_memory(b, "a mesh's tree", tree->count * (2 * sizeof *tree->nodes));
  double sah = bvh_statistics_add(&b->bvh->statistics, tree);
  if (sah > b->bvh->statistics.sah) b->bvh->statistics.sah = sah;
  return CDL_OK;
}

static cdl_Status build_meshes(Build *b, const cdl_BvhMesh *meshes) {
  size_t count = (size_t)b->mesh_count + 1;
  b->sources = calloc(count, sizeof *b->sources);
  b->trees = calloc(count, sizeof *b->trees);
  if (!b->sources || !b->trees) return no_memory(b, "the list of meshes", count * sizeof(Tree));
  for (uint32_t i = 0; i < b->mesh_count; i++) {
    cdl_Status status = build_mesh(b, i, meshes + i);
    if (status) return status;
  }
  return CDL_OK;
}

/* A fragment for every instance that can be hit. */
static void add_instance(Build *b, uint32_t index, const cdl_BvhPlacement *placement) {
  cdl_BvhInstance *instance = b->bvh->instances + index;
  if (!instance_place(placement, b->trees + placement->mesh, instance)) return;
  const float *w = instance->world_bounds;
  Box box = {{w[0], w[1], w[2], 0.0f, -w[3], -w[4], -w[5], 0.0f}};
  fragment_set(b->top.fragments + b->top.count++, &box, index);
}

static cdl_Status build_top(Build *b, const cdl_BvhPlacement *placements, uint32_t count) {
  cdl_Bvh *bvh = b->bvh;
  TreeOptions options = {TREE_BINS, 1, TREE_DEPTH_TOP, 1, 1.0f};
  bvh->instance_bytes = count * sizeof *bvh->instances;
  bvh->instances = allocate(&bvh->instance_bytes);
  b->top.fragments = malloc((count ? count : 1) * sizeof *b->top.fragments);
  if (!bvh->instances || !b->top.fragments) return no_memory(b, "instances", bvh->instance_bytes);
  bvh->instance_count = bvh->statistics.instances = count;
  for (uint32_t i = 0; i < count; i++) {
    if (placements[i].mesh >= b->mesh_count)
      return log_fail(b->log, CDL_BAD_INPUT, "BVH: instance %u places mesh %u of %u.", i,
                      placements[i].mesh, b->mesh_count);
    add_instance(b, i, placements + i);
  }
  if (tree_build(&b->top, &options)) return no_memory(b, "the tree of the instances", 0);
  Box box = b->top.nodes ? b->top.nodes[0].box : box_empty();
  box_store(&box, bvh->bounds);
  return CDL_OK;
}

static void measure(const Build *b, LayoutSize *total) {
  *total = b->width.measure(&b->top, 1);
  for (uint32_t i = 0; i < b->mesh_count; i++) {
    LayoutSize size = b->width.measure(b->trees + i, 0);
    total->nodes += size.nodes;
    total->triangles += size.triangles;
  }
}

static void write_trees(Build *b, uint32_t *roots) {
  cdl_Bvh *bvh = b->bvh;
  Layout layout = {bvh, {0, 0}};
  bvh->root = b->width.write(&layout, &b->top, NULL);
  if (b->top.count == 1) bvh->root = CDL_BVH_LEAF | fragment_number(b->top.fragments);
  for (uint32_t i = 0; i < b->mesh_count; i++)
    roots[i] = b->width.write(&layout, b->trees + i, b->sources + i);
  for (uint32_t i = 0; i < bvh->instance_count; i++)
    bvh->instances[i].root = roots[bvh->instances[i].mesh];
}

static cdl_Status write_layout(Build *b) {
  cdl_Bvh *bvh = b->bvh;
  LayoutSize size;
  measure(b, &size);
  if (size.nodes > CDL_BVH_INDEX || size.triangles > CDL_BVH_INDEX)
    return log_fail(b->log, CDL_BAD_INPUT,
                    "BVH: %llu triangles are more than the %u that fit: split the scene.",
                    (unsigned long long)bvh->statistics.triangles, CDL_BVH_INDEX);
  bvh->node_bytes = size.nodes * b->width.node_size;
  bvh->triangle_bytes = size.triangles * b->width.triangle_size;
  bvh->nodes = allocate(&bvh->node_bytes);
  bvh->triangles = allocate(&bvh->triangle_bytes);
  uint32_t *roots = calloc((size_t)b->mesh_count + 1, sizeof *roots);
  if (bvh->nodes && bvh->triangles && roots) write_trees(b, roots);
  cdl_Status status = CDL_OK;
  if (!bvh->nodes || !bvh->triangles || !roots)
    status = no_memory(b, "nodes and triangles", bvh->node_bytes + bvh->triangle_bytes);
  free(roots);
  bvh->statistics.nodes = size.nodes;
  bvh->statistics.bytes = bvh->node_bytes + bvh->triangle_bytes + bvh->instance_bytes;
  return status;
}

static void build_close(Build *b) {
  uint32_t deepest = 0;
  for (uint32_t i = 0; b->trees && i < b->mesh_count; i++) {
    uint32_t depth = tree_depth(b->trees + i);
    if (depth > deepest) deepest = depth;
    free(b->trees[i].nodes);
    free(b->trees[i].fragments);
  }
  b->bvh->statistics.depth = deepest + tree_depth(&b->top);
  for (uint32_t i = 0; b->sources && i < b->mesh_count; i++) source_close(b->sources + i);
  free(b->top.nodes);
  free(b->top.fragments);
  free(b->sources);
  free(b->trees);
}

cdl_Status bvh_build(const cdl_Log *log, const cdl_BvhMesh *meshes, uint32_t mesh_count,
                     const cdl_BvhPlacement *placements, uint32_t placement_count,
                     const cdl_BvhOptions *options, cdl_Bvh *bvh) {
  double start = clock_now();
  *bvh = (cdl_Bvh){.width = options && options->width == 8 ? 8 : 2};
  Build b = {.log = log, .width = choose_width(options), .mesh_count = mesh_count, .bvh = bvh};
  cdl_Status status = build_meshes(&b, meshes);
  if (status) goto done;
  status = build_top(&b, placements, placement_count);
  if (status) goto done;
  status = write_layout(&b);
  if (!status && motion_append(meshes, mesh_count, bvh))
    status = no_memory(&b, "triangles that move", bvh->triangle_bytes);
done:
  build_close(&b);
  bvh->statistics.seconds = clock_now() - start;
  return status;
}

void bvh_free(cdl_Bvh *bvh) {
  free(bvh->nodes);
  free(bvh->triangles);
  free(bvh->instances);
  *bvh = (cdl_Bvh){0};
}
