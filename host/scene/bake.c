/* bake.c: meshes whose vertices are moved for good, because no instance transform can say it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/mesh.h"

static void store_unit(const double v[3], float *out) {
  double n = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int c = 0; n > 0 && c < 3; c++) out[c] = (float)(v[c] / n);
}

uint8_t mesh_move_vertex(const Matrix *to, size_t i, cdl_SceneMesh *mesh) {
  double in[3], out[3], turn[9];
  matrix_cofactors(to, turn);
  int mirrors = to->m[0] * turn[0] + to->m[1] * turn[1] + to->m[2] * turn[2] < 0;
  double side = mirrors ? -1 : 1;
  for (int c = 0; c < 3; c++) in[c] = mesh->positions[3 * i + c];
  matrix_apply(to, in, 1, out);
  for (int c = 0; c < 3; c++) mesh->positions[3 * i + c] = (float)out[c];
  if (mesh->normals) {
    const float *n = mesh->normals + 3 * i;
    for (int r = 0; r < 3; r++)
      out[r] = side * (turn[3 * r] * n[0] + turn[3 * r + 1] * n[1] + turn[3 * r + 2] * n[2]);
    store_unit(out, mesh->normals + 3 * i);
  }
  if (mesh->tangents) {
    for (int c = 0; c < 3; c++) in[c] = mesh->tangents[4 * i + c];
    matrix_apply(to, in, 0, out);
    store_unit(out, mesh->tangents + 4 * i);
    mesh->tangents[4 * i + 3] *= (float)side;
  }
  return (uint8_t)mirrors;
}

static void *copy_of(const void *from, size_t size, int *failed) {
  void *to = from ? malloc(size) : NULL;
  if (to) memcpy(to, from, size);
  *failed |= from && !to;
  return to;
}

static int copy_mesh(const cdl_SceneMesh *from, cdl_SceneMesh *to) {
  size_t vertex = sizeof(float) * (size_t)from->vertex_count;
  int failed = 0;
  *to = *from;
  to->positions = copy_of(from->positions, 3 * vertex, &failed);
  to->normals = copy_of(from->normals, 3 * vertex, &failed);
  to->tangents = copy_of(from->tangents, 4 * vertex, &failed);
  to->uv[0] = copy_of(from->uv[0], 2 * vertex, &failed);
  to->uv[1] = copy_of(from->uv[1], 2 * vertex, &failed);
  to->colors = copy_of(from->colors, 4 * vertex, &failed);
  to->indices = copy_of(from->indices, 12 * (size_t)from->triangle_count, &failed);
  to->name = string_copy(from->name);
  return !failed && to->name;
}

cdl_Status bake_mesh(Builder *builder, uint32_t mesh, const Matrix *to_world, uint32_t *baked) {
  struct cdl_Scene *scene = builder->scene;
  cdl_SceneMesh *to = array_push((void **)&scene->meshes, scene->mesh_count, sizeof *to);
  if (!to) return document_out_of_memory(builder->doc);
  *baked = scene->mesh_count++;
  if (!copy_mesh(&scene->meshes[mesh], to)) return document_out_of_memory(builder->doc);
  for (size_t i = 0; i < to->vertex_count; i++) mesh_move_vertex(to_world, i, to);
  return CDL_OK;
}

/* A scale of 0 leaves no inverse; one that small leaves none in single precision. */
int matrix_rank(const Matrix *a) {
  double cofactor[9], length[3], most = 0, area = 0;
  matrix_cofactors(a, cofactor);
  for (int c = 0; c < 3; c++) {
    length[c] = sqrt(a->m[c] * a->m[c] + a->m[4 + c] * a->m[4 + c] + a->m[8 + c] * a->m[8 + c]);
    most = fmax(most, length[c]);
  }
  for (int i = 0; i < 9; i++) area = fmax(area, fabs(cofactor[i]));
  double det = a->m[0] * cofactor[0] + a->m[1] * cofactor[1] + a->m[2] * cofactor[2];
  if (fabs(det) > 1e-9 * most * most * most) return 3;
  return area > 1e-12 * most * most ? 2 : 1;
}
