/* mesh.h: a glTF primitive as a triangle mesh. */
#ifndef CANDELA_SCENE_MESH_H
#define CANDELA_SCENE_MESH_H

#include "scene/build.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a primitive's data lie: accessors, CDL_NONE where absent. */
typedef struct PrimitiveSource {
  uint32_t position, normal, tangent, uv[2], color, indices;
  uint32_t material; /* glTF's index, or CDL_NONE: the default */
  uint32_t mode;     /* GL primitive mode */
  const char *name;
  const json_t *json;    /* the primitive itself */
  const double *weights; /* of morph targets */
  size_t weight_count;
} PrimitiveSource;

/* Adds a mesh to the scene; *mesh is CDL_NONE where the primitive has no triangles. */
cdl_Status build_primitive(Builder *builder, const PrimitiveSource *primitive, uint32_t *mesh);

/* bake.c: moves a vertex, its normal and its tangent; 1 when the matrix mirrors, 0 otherwise. The
 * normal keeps to its side: who moves all corners of a triangle turns it around. */
uint8_t mesh_move_vertex(const Matrix *to, size_t i, cdl_SceneMesh *mesh);

/* Adds a copy of a mesh, moved. */
cdl_Status bake_mesh(Builder *builder, uint32_t mesh, const Matrix *to_world, uint32_t *baked);

/* 3 for a transform that has an inverse in single precision, 2 for one that flattens to a plane, 1
 * for one that leaves a line or a point. */
int matrix_rank(const Matrix *a);

/* morph.c: adds the weighted displacements of morph targets. Lengths of normals and tangents are
 * left to the caller. */
cdl_Status morph_mesh(Builder *builder, const PrimitiveSource *primitive, cdl_SceneMesh *mesh);

/* skin.c: moves a mesh's vertices by `joint_count` matrices (joint to world after inverse bind). */
cdl_Status skin_mesh(Builder *builder, const PrimitiveSource *primitive, const Matrix *joints,
                     uint32_t joint_count, cdl_SceneMesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
