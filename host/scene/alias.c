#include "scene/alias.h"

#include <stdint.h>
#include <stdlib.h>

#include "core/log.h"

/* Pairs each slot that has less than its share with one that has more, until all are full. */
static void alias_pair(double *share, uint32_t *stack, size_t count, cdl_AliasEntry *table) {
  size_t small = 0, large = count; /* two stacks that grow towards each other */
  for (size_t i = 0; i < count; i++) stack[share[i] < 1.0 ? small++ : --large] = (uint32_t)i;
  while (small && large < count) {
    uint32_t poor = stack[--small], rich = stack[large];
    table[poor].keep = (float)share[poor];
    table[poor].alias = rich;
    share[rich] -= 1.0 - share[poor];
    if (share[rich] < 1.0) {
      large++;
      stack[small++] = rich;
    }
  }
  /* What is left is full but for rounding. */
  while (small) table[stack[--small]].keep = 1.0f;
  while (large < count) table[stack[large++]].keep = 1.0f;
}

cdl_Status alias_build(const cdl_Log *log, const double *weights, size_t count,
                       cdl_AliasEntry *table) {
  double sum = 0.0;
  for (size_t i = 0; i < count; i++) sum += weights[i];
  double *share = malloc(count * sizeof *share);
  uint32_t *stack = malloc(count * sizeof *stack);
  if (!share || !stack) {
    free(share);
    free(stack);
    return log_fail(log, CDL_BAD_INPUT, "not enough memory to choose among %zu lights or texels",
                    count);
  }
  for (size_t i = 0; i < count; i++) {
    double probability = sum > 0.0 ? weights[i] / sum : 1.0 / (double)count;
    table[i] = (cdl_AliasEntry){1.0f, (uint32_t)i, (float)probability, 0};
    share[i] = probability * (double)count;
  }
  alias_pair(share, stack, count, table);
  free(share);
  free(stack);
  return CDL_OK;
}
