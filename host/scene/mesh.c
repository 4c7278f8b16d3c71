#include "scene/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

static uint32_t triangle_count(uint32_t mode, size_t vertices) {
  if (mode < MODE_TRIANGLES || vertices < 3) return 0;
  return (uint32_t)(mode == MODE_TRIANGLES ? vertices / 3 : vertices - 2);
}

/* Section 3.7.2.1 of the specification says which vertices a strip's and a fan's triangles have. */
static void triangle_corners(uint32_t mode, uint32_t t, uint32_t corners[3]) {
  uint32_t odd = t & 1;
  switch (mode) {
  case MODE_STRIP:
    corners[0] = t, corners[1] = t + 1 + odd, corners[2] = t + 2 - odd;
    break;
  case MODE_FAN:
    corners[0] = t + 1, corners[1] = t + 2, corners[2] = 0;
    break;
  default:
    corners[0] = 3 * t, corners[1] = 3 * t + 1, corners[2] = 3 * t + 2;
    break;
  }
}

static cdl_Status read_indices(Builder *builder, const PrimitiveSource *source,
                               cdl_SceneMesh *mesh) {
  Document *doc = builder->doc;
  uint32_t *given = NULL;
  size_t count = mesh->vertex_count;
  if (source->indices != CDL_NONE) {
    cdl_Status status = accessor_require(doc, source->indices);
    if (status) return status;
    given = accessor_integers(doc, source->indices);
    count = doc->accessors[source->indices].count;
    if (!given) return document_out_of_memory(doc);
  }
  mesh->triangle_count = triangle_count(source->mode, count);
  mesh->indices = malloc(3 * sizeof *mesh->indices * ((size_t)mesh->triangle_count + 1));
  for (uint32_t t = 0; mesh->indices && t < mesh->triangle_count; t++) {
    uint32_t *corners = mesh->indices + 3 * (size_t)t;
    triangle_corners(source->mode, t, corners);
    for (int k = 0; given && k < 3; k++) corners[k] = given[corners[k]];
  }
  free(given);
  return mesh->indices ? CDL_OK : document_out_of_memory(doc);
}

/* Colours without opacity are opaque. */
static cdl_Status read_colors(Builder *builder, uint32_t accessor, cdl_SceneMesh *mesh) {
  Document *doc = builder->doc;
  cdl_Status status = accessor_require(doc, accessor);
  if (status) return status;
  float *values = accessor_floats(doc, accessor);
  if (!values) return document_out_of_memory(doc);
  if (doc->accessors[accessor].width == 4) {
    mesh->colors = values;
    return CDL_OK;
  }
  mesh->colors = malloc(4 * sizeof *values * (size_t)mesh->vertex_count);
  for (uint32_t i = 0; mesh->colors && i < mesh->vertex_count; i++) {
    memcpy(mesh->colors + 4 * (size_t)i, values + 3 * (size_t)i, 3 * sizeof *values);
    mesh->colors[4 * (size_t)i + 3] = 1;
  }
  free(values);
  return mesh->colors ? CDL_OK : document_out_of_memory(doc);
}

/* Quantised directions are unit to their precision only. */
static void normalise(float *values, uint32_t count, unsigned width) {
  for (uint32_t i = 0; values && i < count; i++) {
    float *v = values + (size_t)i * width;
    double n = sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
    for (int c = 0; n > 0 && c < 3; c++) v[c] = (float)(v[c] / n);
  }
}

static cdl_Status read_attributes(Builder *builder, const PrimitiveSource *source,
                                  cdl_SceneMesh *mesh) {
  Document *doc = builder->doc;
  const struct {
    uint32_t accessor;
    float **to;
  } parts[] = {{source->position, &mesh->positions},
               {source->normal, &mesh->normals},
               /* Tangents without normals are to be left out (section 3.7.2.1). */
               {source->normal == CDL_NONE ? CDL_NONE : source->tangent, &mesh->tangents},
               {source->uv[0], &mesh->uv[0]},
               {source->uv[1], &mesh->uv[1]}};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    if (parts[i].accessor == CDL_NONE) continue;
    cdl_Status status = accessor_require(doc, parts[i].accessor);
    if (status) return status;
    *parts[i].to = accessor_floats(doc, parts[i].accessor);
    if (!*parts[i].to) return document_out_of_memory(doc);
  }
  cdl_Status status =
      source->color == CDL_NONE ? CDL_OK : read_colors(builder, source->color, mesh);
  if (!status) status = morph_mesh(builder, source, mesh);
  normalise(mesh->normals, mesh->vertex_count, 3);
  normalise(mesh->tangents, mesh->vertex_count, 4);
  return status;
}

/* Tangents matter to normal maps and to anisotropy alone. */
static cdl_Status read_tangents(Builder *builder, cdl_SceneMesh *mesh) {
  const cdl_SceneMaterial *material = &builder->scene->materials[mesh->material];
  int mapped = material->normal_texture.texture != CDL_NONE;
  int coated = material->coat_normal_texture.texture != CDL_NONE;
  int needed = mapped || coated || material->anisotropic;
  uint32_t set = mapped   ? material->normal_texture.uv_set
                 : coated ? material->coat_normal_texture.uv_set
                          : 0;
  if (!needed || mesh->tangents || !mesh->uv[set]) return CDL_OK;
  return mesh_make_tangents(mesh, set) ? document_out_of_memory(builder->doc) : CDL_OK;
}

cdl_Status build_primitive(Builder *builder, const PrimitiveSource *source, uint32_t *index) {
  struct cdl_Scene *scene = builder->scene;
  *index = CDL_NONE;
  if (source->position == CDL_NONE || source->mode < MODE_TRIANGLES) {
    document_note(builder->doc, source->mode < MODE_TRIANGLES ? "points and lines" : "positions",
                  "/meshes", "points, lines and primitives without POSITION are skipped.");
    return CDL_OK;
  }
  cdl_SceneMesh *mesh = array_push((void **)&scene->meshes, scene->mesh_count, sizeof *mesh);
  if (!mesh) return document_out_of_memory(builder->doc);
  scene->mesh_count++;
  mesh->vertex_count = (uint32_t)builder->doc->accessors[source->position].count;
  mesh->material =
      source->material != CDL_NONE ? source->material : build_default_material(builder);
  mesh->name = string_copy(source->name);
  if (mesh->material == CDL_NONE || !mesh->name) return document_out_of_memory(builder->doc);
  cdl_Status status = read_attributes(builder, source, mesh);
  if (!status) status = read_indices(builder, source, mesh);
  if (!status) status = read_tangents(builder, mesh);
  if (!status) *index = scene->mesh_count - 1;
  return status;
}
