/* tree.c: binned SAH (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
 *
 * Subtrees are OpenMP tasks. Large nodes are binned and partitioned in chunks whose number depends
 * on the node alone, so the tree does not depend on the number of threads. */
#include "bvh/tree.h"

#include <stdlib.h>

enum { CHUNK = 1 << 15, TASK_MIN = 1 << 11, CHUNKS_MAX = 256 };

typedef struct Bins {
  Box box[3][TREE_BINS];
  uint32_t count[3][TREE_BINS];
} Bins;

/* Maps twice a centroid to a bin of each axis. */
typedef struct BinMap {
  float origin[3], scale[3];
  int bins;
} BinMap;

typedef struct Split {
  float cost;    /* INFINITY: none was found */
  int axis, bin; /* fragments in bins below `bin` go left */
} Split;

typedef struct Builder {
  TreeNode *nodes;
  Fragment *fragments, *spare;
  const TreeOptions *options;
} Builder;

/* Fragments first … first + count - 1. */
typedef struct Range {
  uint32_t first, count;
} Range;

static Range chunk_of(Range range, uint32_t chunk) {
  uint32_t chunks = (range.count + CHUNK - 1) / CHUNK;
  if (chunks > CHUNKS_MAX) chunks = CHUNKS_MAX;
  uint32_t a = (uint32_t)((uint64_t)range.count * chunk / chunks);
  uint32_t b = (uint32_t)((uint64_t)range.count * (chunk + 1) / chunks);
  return (Range){range.first + a, b - a};
}

static uint32_t chunk_count(Range range) {
  uint32_t chunks = (range.count + CHUNK - 1) / CHUNK;
  return chunks > CHUNKS_MAX ? CHUNKS_MAX : chunks;
}

static float centroid2(const Fragment *fragment, int axis) {
  return fragment->box.side[axis] - fragment->box.side[axis + 4];
}

/* The box of the fragments, and that of their doubled centroids. */
static void range_bounds_serial(const Builder *b, Range range, Box *box, Box *centroids) {
  *box = box_empty();
  *centroids = box_empty();
  for (uint32_t i = range.first; i < range.first + range.count; i++) {
    const Fragment *f = b->fragments + i;
    Box c;
    for (int k = 0; k < 4; k++) {
      c.side[k] = f->box.side[k] - f->box.side[k + 4];
      c.side[k + 4] = -c.side[k];
    }
    box_grow(box, &f->box);
    box_grow(centroids, &c);
  }
}

static void range_bounds(const Builder *b, Range range, Box *box, Box *centroids) {
  uint32_t chunks = chunk_count(range);
  if (chunks <= 1) {
    range_bounds_serial(b, range, box, centroids);
    return;
  }
  Box boxes[CHUNKS_MAX][2];
#pragma omp taskloop grainsize(1) shared(boxes)
  for (uint32_t i = 0; i < chunks; i++)
    range_bounds_serial(b, chunk_of(range, i), &boxes[i][0], &boxes[i][1]);
  *box = boxes[0][0];
  *centroids = boxes[0][1];
  for (uint32_t i = 1; i < chunks; i++) {
    box_grow(box, &boxes[i][0]);
    box_grow(centroids, &boxes[i][1]);
  }
}

/* False if no axis can be binned: all centroids equal, or not finite. */
static int bin_map(const Box *centroids, int bins, BinMap *map) {
  int usable = 0;
  map->bins = bins;
  for (int axis = 0; axis < 3; axis++) {
    float low = centroids->side[axis], extent = -centroids->side[axis + 4] - low;
    float scale = (float)bins * 0.99999f / extent;
    int good = extent > 0.0f && isfinite(extent) && isfinite(scale);
    map->origin[axis] = good ? low : 0.0f;
    map->scale[axis] = good ? scale : 0.0f;
    usable |= good;
  }
  return usable;
}

static int bin_of(const BinMap *map, const Fragment *fragment, int axis) {
  float x = (centroid2(fragment, axis) - map->origin[axis]) * map->scale[axis];
  int bin = (int)x;
  return bin < map->bins ? bin : map->bins - 1;
}

static void bins_clear(Bins *bins, int count) {
  for (int axis = 0; axis < 3; axis++)
    for (int i = 0; i < count; i++) {
      bins->box[axis][i] = box_empty();
      bins->count[axis][i] = 0;
    }
}

static void bins_fill_serial(const Builder *b, Range range, const BinMap *map, Bins *bins) {
  bins_clear(bins, map->bins);
  for (uint32_t i = range.first; i < range.first + range.count; i++) {
    const Fragment *f = b->fragments + i;
    for (int axis = 0; axis < 3; axis++) {
      if (map->scale[axis] == 0.0f) continue;
      int bin = bin_of(map, f, axis);
      box_grow(&bins->box[axis][bin], &f->box);
      bins->count[axis][bin]++;
    }
  }
}

static void bins_merge(Bins *bins, const Bins *more, int count) {
  for (int axis = 0; axis < 3; axis++)
    for (int i = 0; i < count; i++) {
      box_grow(&bins->box[axis][i], &more->box[axis][i]);
      bins->count[axis][i] += more->count[axis][i];
    }
}

static void bins_fill(const Builder *b, Range range, const BinMap *map, Bins *bins) {
  uint32_t chunks = chunk_count(range);
  Bins *parts = chunks > 1 ? malloc(chunks * sizeof *parts) : NULL;
  if (!parts) {
    bins_fill_serial(b, range, map, bins);
    return;
  }
#pragma omp taskloop grainsize(1)
  for (uint32_t i = 0; i < chunks; i++) bins_fill_serial(b, chunk_of(range, i), map, parts + i);
  *bins = parts[0];
  for (uint32_t i = 1; i < chunks; i++) bins_merge(bins, parts + i, map->bins);
  free(parts);
}

/* Cost of testing so many triangles, times the area of their box. */
static float leaf_cost(const TreeOptions *options, uint32_t count, float area) {
  uint32_t group = (uint32_t)options->group;
  return options->leaf_cost * (float)((count + group - 1) / group) * area;
}

/* Best of the planes between the bins of one axis; `split` is improved or left alone. */
static void split_axis(const TreeOptions *options, const Bins *bins, int count, int axis,
                       Split *split) {
  float right_cost[TREE_BINS] = {0};
  uint32_t right = 0, left = 0;
  Box box = box_empty();
  for (int i = count - 1; i > 0; i--) {
    right += bins->count[axis][i];
    box_grow(&box, &bins->box[axis][i]);
    right_cost[i] = right ? leaf_cost(options, right, box_area(&box)) : INFINITY;
  }
  box = box_empty();
  for (int i = 1; i < count; i++) {
    left += bins->count[axis][i - 1];
    box_grow(&box, &bins->box[axis][i - 1]);
    float cost = left ? leaf_cost(options, left, box_area(&box)) + right_cost[i] : INFINITY;
    if (cost < split->cost) *split = (Split){cost, axis, i};
  }
}

static int goes_left(const BinMap *map, const Split *split, const Fragment *fragment) {
  return bin_of(map, fragment, split->axis) < split->bin;
}

static uint32_t count_left(const Builder *b, Range range, const BinMap *map, const Split *split) {
  uint32_t left = 0;
  for (uint32_t i = range.first; i < range.first + range.count; i++)
    left += (uint32_t)goes_left(map, split, b->fragments + i);
  return left;
}

static void scatter(const Builder *b, Range range, const BinMap *map, const Split *split,
                    uint32_t left, uint32_t right) {
  for (uint32_t i = range.first; i < range.first + range.count; i++)
    b->spare[goes_left(map, split, b->fragments + i) ? left++ : right++] = b->fragments[i];
}

static uint32_t partition_serial(const Builder *b, Range range, const BinMap *map,
                                 const Split *split) {
  uint32_t left = range.first, right = range.first + range.count;
  while (left < right) {
    if (goes_left(map, split, b->fragments + left)) {
      left++;
    } else {
      Fragment f = b->fragments[--right];
      b->fragments[right] = b->fragments[left];
      b->fragments[left] = f;
    }
  }
  return left - range.first;
}

/* Moves the fragments that go left to the front; returns how many there are. */
static uint32_t partition(const Builder *b, Range range, const BinMap *map, const Split *split) {
  uint32_t chunks = chunk_count(range), lefts[CHUNKS_MAX], total = 0, starts[CHUNKS_MAX];
  if (chunks == 1) return partition_serial(b, range, map, split);
#pragma omp taskloop grainsize(1) shared(lefts)
  for (uint32_t i = 0; i < chunks; i++) lefts[i] = count_left(b, chunk_of(range, i), map, split);
  for (uint32_t i = 0; i < chunks; i++) {
    starts[i] = total;
    total += lefts[i];
  }
#pragma omp taskloop grainsize(1) shared(starts)
  for (uint32_t i = 0; i < chunks; i++) {
    Range chunk = chunk_of(range, i);
    uint32_t before = chunk.first - range.first;
    scatter(b, chunk, map, split, range.first + starts[i],
            range.first + total + before - starts[i]);
  }
#pragma omp taskloop grainsize(1)
  for (uint32_t i = 0; i < chunks; i++) {
    Range chunk = chunk_of(range, i);
    memcpy(b->fragments + chunk.first, b->spare + chunk.first, chunk.count * sizeof(Fragment));
  }
  return total;
}

/* Levels that halving needs to reach leaves of at most leaf_max. */
static int levels_needed(uint32_t count, int leaf_max) {
  int levels = 0;
  for (uint64_t size = (uint64_t)leaf_max; size < count; size *= 2) levels++;
  return levels;
}

/* How many fragments go left, 0 for a leaf. Halves where the SAH has no say or the depth runs out.
 */
static uint32_t split_range(const Builder *b, Range range, const Box *box, const Box *centroids,
                            int depth) {
  const TreeOptions *options = b->options;
  if (range.count == 1) return 0;
  int may_be_leaf = range.count <= (uint32_t)options->leaf_max;
  int levels = options->depth_max - depth;
  if (levels_needed(range.count, options->leaf_max) >= levels)
    return may_be_leaf ? 0 : range.count / 2;
  int bins = options->bins;
  if (range.count < (uint32_t)bins / 2) bins = bins < 8 ? bins : bins < 16 ? 8 : bins / 2;
  Split split = {INFINITY, 0, 0};
  BinMap map;
  if (bin_map(centroids, bins, &map)) {
    Bins filled;
    bins_fill(b, range, &map, &filled);
    for (int axis = 0; axis < 3; axis++)
      if (map.scale[axis] != 0.0f) split_axis(options, &filled, bins, axis, &split);
  }
  float area = box_area(box);
  if (may_be_leaf && !(split.cost + area < leaf_cost(options, range.count, area))) return 0;
  if (!(split.cost < INFINITY)) return range.count / 2;
  return partition(b, range, &map, &split);
}

static void build_range(const Builder *b, uint32_t index, Range range, int depth) {
  TreeNode *node = b->nodes + index;
  Box centroids;
  range_bounds(b, range, &node->box, &centroids);
  uint32_t left = split_range(b, range, &node->box, &centroids, depth);
  if (left == 0) {
    node->next = range.first;
    node->count = range.count;
    return;
  }
  node->next = index + 2 * left;
  node->count = 0;
  Range right = {range.first + left, range.count - left};
#pragma omp task if (range.count > TASK_MIN)
  build_range(b, index + 1, (Range){range.first, left}, depth + 1);
  build_range(b, node->next, right, depth + 1);
}

int tree_build(Tree *tree, const TreeOptions *options) {
  tree->nodes = NULL;
  if (tree->count == 0) return 0;
  Builder b = {malloc((2 * (size_t)tree->count - 1) * sizeof *b.nodes), tree->fragments,
               malloc(tree->count * sizeof *b.spare), options};
  if (b.nodes && b.spare) {
#pragma omp parallel
#pragma omp single
    build_range(&b, 0, (Range){0, tree->count}, 0);
    tree->nodes = b.nodes;
  } else {
    free(b.nodes);
  }
  free(b.spare);
  return tree->nodes ? 0 : -1;
}
