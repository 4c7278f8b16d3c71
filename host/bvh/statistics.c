#include "bvh/statistics.h"

#include <stdio.h>

static double add_subtree(cdl_BvhStatistics *s, const Tree *tree, uint32_t at) {
  const TreeNode *node = tree->nodes + at;
  double area = box_area(&node->box);
  if (!node->count) return area + add_subtree(s, tree, at + 1) + add_subtree(s, tree, node->next);
  s->leaves++;
  s->triangles += node->count;
  s->leaf_sizes[node->count < 32 ? node->count : 32]++;
  if (node->count > s->leaf_max) s->leaf_max = node->count;
  return area * node->count;
}

double bvh_statistics_add(cdl_BvhStatistics *statistics, const Tree *tree) {
  if (!tree->nodes) return 0.0;
  double cost = add_subtree(statistics, tree, 0), area = box_area(&tree->nodes[0].box);
  statistics->leaf_average = (double)statistics->triangles / (double)statistics->leaves;
  return area > 0.0 ? cost / area : 0.0;
}

int bvh_statistics_line(const cdl_BvhStatistics *s, int width, char *line, size_t size) {
  double millions = (double)s->triangles * 1e-6;
  return snprintf(line, size,
                  "BVH%d: %llu triangles (%llu dropped), %u instance%s, %llu nodes, depth %u, "
                  "SAH cost %.1f, %.2f triangles a leaf (at most %u), built in %.3f s "
                  "(%.2f Mtriangles/s), %.1f MiB (%.0f bytes a triangle)",
                  width, (unsigned long long)s->triangles, (unsigned long long)s->dropped,
                  s->instances, s->instances == 1 ? "" : "s", (unsigned long long)s->nodes,
                  s->depth, s->sah, s->leaf_average, s->leaf_max, s->seconds,
                  s->seconds > 0.0 ? millions / s->seconds : 0.0, (double)s->bytes / 1048576.0,
                  s->triangles ? (double)s->bytes / (double)s->triangles : 0.0);
}
