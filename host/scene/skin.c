/* skin.c: vertices moved by joints (glTF 2.0, section 3.7.3.3). */
#include <stdlib.h>

#include "scene/accessor.h"
#include "scene/mesh.h"

/* The weighted sum of a vertex's joint matrices; weights are taken to sum to 1. */
static Matrix blend(const float *joint, const float *weight, const Matrix *joints,
                    uint32_t joint_count) {
  Matrix sum = {{0}};
  double total = 0;
  for (int k = 0; k < 4; k++) {
    uint32_t j = (uint32_t)joint[k];
    if (weight[k] <= 0 || j >= joint_count) continue;
    total += weight[k];
    for (int i = 0; i < 12; i++) sum.m[i] += weight[k] * joints[j].m[i];
  }
  for (int i = 0; total > 0 && i < 12; i++) sum.m[i] /= total;
  return total > 0 ? sum : matrix_identity();
}

cdl_Status skin_mesh(Builder *builder, const PrimitiveSource *primitive, const Matrix *joints,
                     uint32_t joint_count, cdl_SceneMesh *mesh) {
  cdl_Status status = accessor_require(builder->doc, primitive->joints);
  if (!status) status = accessor_require(builder->doc, primitive->weights);
  if (status) return status;
  float *indices = accessor_floats(builder->doc, primitive->joints);
  float *weights = accessor_floats(builder->doc, primitive->weights);
  if (!indices || !weights) status = document_out_of_memory(builder->doc);
  for (size_t i = 0; !status && i < mesh->vertex_count; i++) {
    Matrix to = blend(indices + 4 * i, weights + 4 * i, joints, joint_count);
    mesh_move_vertex(&to, i, mesh);
  }
  free(indices);
  free(weights);
  return status;
}
