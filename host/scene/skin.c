/* skin.c: vertices moved by joints (glTF 2.0, section 3.7.3.3). */
#include <math.h>
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

static void store_unit(const double v[3], float *out) {
  double n = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int c = 0; n > 0 && c < 3; c++) out[c] = (float)(v[c] / n);
}

static void move_vertex(const Matrix *to, size_t i, cdl_SceneMesh *mesh) {
  double in[3], out[3], turn[9];
  for (int c = 0; c < 3; c++) in[c] = mesh->positions[3 * i + c];
  matrix_apply(to, in, 1, out);
  for (int c = 0; c < 3; c++) mesh->positions[3 * i + c] = (float)out[c];
  if (mesh->normals) {
    const float *n = mesh->normals + 3 * i;
    matrix_cofactors(to, turn);
    for (int r = 0; r < 3; r++)
      out[r] = turn[3 * r] * n[0] + turn[3 * r + 1] * n[1] + turn[3 * r + 2] * n[2];
    store_unit(out, mesh->normals + 3 * i);
  }
  if (mesh->tangents) {
    for (int c = 0; c < 3; c++) in[c] = mesh->tangents[4 * i + c];
    matrix_apply(to, in, 0, out);
    store_unit(out, mesh->tangents + 4 * i);
  }
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
    move_vertex(&to, i, mesh);
  }
  free(indices);
  free(weights);
  return status;
}
