/* skin.c: vertices moved by joints (glTF 2.0, section 3.7.3.3). */
#include <stdio.h>
#include <stdlib.h>

#include "scene/accessor.h"
#include "scene/mesh.h"

/* Of one vertex: the weighted sum of its joints' matrices, and of the weights. */
typedef struct Blend {
  Matrix sum;
  double total;
  uint32_t first; /* the first joint that the file names */
} Blend;

static void blend_set(const float *joint, const float *weight, const Matrix *joints,
                      uint32_t joint_count, Blend *blend) {
  for (int k = 0; k < 4; k++) {
    uint32_t j = (uint32_t)joint[k];
    if (!(weight[k] > 0) || j >= joint_count) continue;
    blend->total += weight[k];
    for (int i = 0; i < 12; i++) blend->sum.m[i] += weight[k] * joints[j].m[i];
  }
}

/* One set of four influences, JOINTS_n and WEIGHTS_n; any number of sets may be given. */
static cdl_Status add_set(Builder *builder, uint32_t joints_accessor, uint32_t weights_accessor,
                          const Matrix *joints, uint32_t joint_count, uint32_t vertex_count,
                          int is_first, Blend *blends) {
  cdl_Status status = accessor_require(builder->doc, joints_accessor);
  if (!status) status = accessor_require(builder->doc, weights_accessor);
  if (status) return status;
  float *indices = accessor_floats(builder->doc, joints_accessor);
  float *weights = accessor_floats(builder->doc, weights_accessor);
  if (!indices || !weights) status = document_out_of_memory(builder->doc);
  for (size_t i = 0; !status && i < vertex_count; i++) {
    blend_set(indices + 4 * i, weights + 4 * i, joints, joint_count, &blends[i]);
    if (is_first) blends[i].first = (uint32_t)indices[4 * i];
  }
  free(indices);
  free(weights);
  return status;
}

/* Weights are taken to sum to 1. A vertex without any goes with the first joint that it names. */
static Matrix blended(const Blend *blend, const Matrix *joints, uint32_t joint_count) {
  Matrix to = blend->sum;
  for (int i = 0; i < 12; i++) to.m[i] /= blend->total;
  if (blend->total > 0) return to;
  return blend->first < joint_count ? joints[blend->first] : matrix_identity();
}

/* Joints that mirror turn triangles inside out; their corners are swapped, so that the front stays
 * the front. Where a triangle's vertices differ, most of them count. */
static void turn_triangles(const uint8_t *mirrored, cdl_SceneMesh *mesh) {
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    uint32_t *v = mesh->indices + 3 * t;
    if (mirrored[v[0]] + mirrored[v[1]] + mirrored[v[2]] < 2) continue;
    uint32_t swapped = v[1];
    v[1] = v[2];
    v[2] = swapped;
  }
}

cdl_Status skin_mesh(Builder *builder, const PrimitiveSource *primitive, const Matrix *joints,
                     uint32_t joint_count, cdl_SceneMesh *mesh) {
  const json_t *attributes = json_object_get(primitive->json, "attributes");
  uint8_t *mirrored = calloc((size_t)mesh->vertex_count + 1, 1);
  Blend *blends = calloc((size_t)mesh->vertex_count + 1, sizeof *blends);
  cdl_Status status = mirrored && blends ? CDL_OK : document_out_of_memory(builder->doc);
  for (int set = 0; !status; set++) {
    char names[2][32];
    snprintf(names[0], sizeof names[0], "JOINTS_%d", set);
    snprintf(names[1], sizeof names[1], "WEIGHTS_%d", set);
    uint32_t joint = json_get_index(attributes, names[0]);
    uint32_t weight = json_get_index(attributes, names[1]);
    if (joint == DOCUMENT_NONE || weight == DOCUMENT_NONE) break;
    status =
        add_set(builder, joint, weight, joints, joint_count, mesh->vertex_count, set == 0, blends);
  }
  for (size_t i = 0; !status && i < mesh->vertex_count; i++) {
    Matrix to = blended(&blends[i], joints, joint_count);
    mirrored[i] = mesh_move_vertex(&to, i, mesh);
  }
  if (!status) turn_triangles(mirrored, mesh);
  free(blends);
  free(mirrored);
  return status;
}
