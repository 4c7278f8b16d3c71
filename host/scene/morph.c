/* morph.c: vertices moved by morph targets (glTF 2.0, section 3.7.2.2). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/mesh.h"

/* Adds weight x displacement to `to`, which has `width` numbers a vertex; the accessor may have
 * fewer: tangents keep their handedness, colours their opacity. */
static cdl_Status add_target(Builder *builder, uint32_t accessor, double weight, uint32_t count,
                             uint32_t width, float *to) {
  Document *doc = builder->doc;
  cdl_Status status = accessor_require(doc, accessor);
  if (status) return status;
  uint32_t given = doc->accessors[accessor].width;
  float *values = accessor_floats(doc, accessor);
  if (!values) return document_out_of_memory(doc);
  for (size_t i = 0; i < count; i++)
    for (uint32_t c = 0; c < given && c < width; c++)
      to[i * width + c] = (float)(to[i * width + c] + weight * values[i * given + c]);
  free(values);
  return CDL_OK;
}

static void clamp_colors(cdl_SceneMesh *mesh) {
  for (size_t i = 0; i < 4 * (size_t)mesh->vertex_count; i++) {
    float *c = &mesh->colors[i];
    *c = *c < 0 ? 0 : *c > 1 ? 1 : *c;
  }
}

static int any_weight(const PrimitiveSource *primitive) {
  for (size_t i = 0; i < primitive->weight_count; i++)
    if (primitive->weights[i] != 0) return 1;
  return 0;
}

cdl_Status morph_mesh(Builder *builder, const PrimitiveSource *primitive, cdl_SceneMesh *mesh) {
  const json_t *targets = json_object_get(primitive->json, "targets");
  const struct {
    const char *name;
    uint32_t width;
    float *to;
  } parts[] = {{"POSITION", 3, mesh->positions}, {"NORMAL", 3, mesh->normals},
               {"TANGENT", 4, mesh->tangents},   {"TEXCOORD_0", 2, mesh->uv[0]},
               {"TEXCOORD_1", 2, mesh->uv[1]},   {"COLOR_0", 4, mesh->colors}};
  if (!any_weight(primitive)) return CDL_OK;
  cdl_Status status = CDL_OK;
  for (size_t t = 0; t < json_array_size(targets) && t < primitive->weight_count; t++)
    for (size_t p = 0; p < sizeof parts / sizeof *parts && !status; p++) {
      uint32_t accessor = json_get_index(json_array_get(targets, t), parts[p].name);
      if (accessor == DOCUMENT_NONE || !parts[p].to || primitive->weights[t] == 0) continue;
      status = add_target(builder, accessor, primitive->weights[t], mesh->vertex_count,
                          parts[p].width, parts[p].to);
    }
  if (!status && mesh->colors) clamp_colors(mesh);
  return status;
}
