/* check_deform.c: what moves vertices: joints, weights and morph targets. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/check.h"

static const json_t *list_of(const Document *doc, const char *name) {
  return json_object_get(doc->root, name);
}

static const json_t *attributes_of(const Document *doc, size_t mesh, size_t primitive) {
  const json_t *primitives =
      json_object_get(json_array_get(list_of(doc, "meshes"), mesh), "primitives");
  return json_object_get(json_array_get(primitives, primitive), "attributes");
}

/* The greatest component of an accessor of unsigned integers. */
static uint32_t greatest(const Document *doc, const Accessor *a) {
  uint32_t most = 0;
  for (size_t i = 0; i < a->count; i++) {
    const uint8_t *element = accessor_element(doc, a, i);
    for (uint32_t c = 0; c < a->width; c++)
      most = (uint32_t)fmax(most, accessor_component(a, element, c));
  }
  return most;
}

static cdl_Status check_joint_indices(Document *doc, size_t mesh, size_t joints) {
  const json_t *primitives =
      json_object_get(json_array_get(list_of(doc, "meshes"), mesh), "primitives");
  for (size_t p = 0; p < json_array_size(primitives); p++) {
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)attributes_of(doc, mesh, p), name, value) {
      if (strncmp(name, "JOINTS_", 7) != 0) continue;
      const Accessor *a = &doc->accessors[(uint32_t)json_number_value(value)];
      uint32_t most = accessor_has_data(doc, a) ? greatest(doc, a) : 0;
      if (most >= joints)
        return document_fail(doc, AT("/meshes/%zu/primitives/%zu/attributes/%.20s", mesh, p, name),
                             "ACCESSOR_JOINTS_INDEX_OOB",
                             "a vertex names joint %u, but the skin has %zu.", most, joints);
    }
  }
  return CDL_OK;
}

/* A mesh is looked through once, for the skin with the fewest joints that moves it. */
static cdl_Status check_joints(Document *doc) {
  const json_t *nodes = list_of(doc, "nodes");
  size_t meshes = json_array_size(list_of(doc, "meshes"));
  size_t *fewest = calloc(meshes + 1, sizeof *fewest);
  if (!fewest) return document_out_of_memory(doc);
  for (size_t i = 0; i < json_array_size(nodes); i++) {
    uint32_t mesh = json_get_index(json_array_get(nodes, i), "mesh");
    uint32_t skin = json_get_index(json_array_get(nodes, i), "skin");
    if (mesh == DOCUMENT_NONE || skin == DOCUMENT_NONE) continue;
    size_t joints =
        json_array_size(json_object_get(json_array_get(list_of(doc, "skins"), skin), "joints"));
    if (!fewest[mesh] || joints < fewest[mesh]) fewest[mesh] = joints;
  }
  cdl_Status status = CDL_OK;
  for (size_t m = 0; m < meshes && !status; m++)
    if (fewest[m]) status = check_joint_indices(doc, m, fewest[m]);
  free(fewest);
  return status;
}

static cdl_Status check_weights(Document *doc, const char *at, const Accessor *a) {
  if (a->component != GL_FLOAT || !accessor_has_data(doc, a)) return CDL_OK;
  for (size_t i = 0; i < a->count; i++)
    for (uint32_t c = 0; c < a->width; c++) {
      double weight = accessor_component(a, accessor_element(doc, a, i), c);
      if (!(weight >= 0))
        return document_fail(doc, at, "ACCESSOR_WEIGHTS_NEGATIVE", "weight %u of vertex %zu is %g.",
                             c, i, weight);
    }
  return CDL_OK;
}

/* Each primitive of a mesh has as many targets, and the mesh as many weights. */
static cdl_Status check_targets(Document *doc, size_t m, const json_t *mesh) {
  const json_t *primitives = json_object_get(mesh, "primitives");
  const json_t *weights = json_object_get(mesh, "weights");
  size_t count = 0;
  for (size_t p = 0; p < json_array_size(primitives); p++) {
    size_t here = json_array_size(json_object_get(json_array_get(primitives, p), "targets"));
    if (p && here != count)
      return document_fail(doc, AT("/meshes/%zu/primitives/%zu/targets", m, p),
                           "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
                           "there are %zu morph targets, and %zu in the primitive before.", here,
                           count);
    count = here;
  }
  if (weights && json_array_size(weights) != count)
    return document_fail(doc, AT("/meshes/%zu/weights", m), "MESH_INVALID_WEIGHTS_COUNT",
                         "there are %zu weights for %zu morph targets.", json_array_size(weights),
                         count);
  return CDL_OK;
}

static cdl_Status check_mesh(Document *doc, size_t m, const json_t *mesh) {
  const json_t *primitives = json_object_get(mesh, "primitives");
  cdl_Status status = check_targets(doc, m, mesh);
  for (size_t p = 0; p < json_array_size(primitives) && !status; p++) {
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)attributes_of(doc, m, p), name, value) {
      if (status || strncmp(name, "WEIGHTS_", 8) != 0) continue;
      status = check_weights(doc, AT("/meshes/%zu/primitives/%zu/attributes/%.20s", m, p, name),
                             &doc->accessors[(uint32_t)json_number_value(value)]);
    }
  }
  return status;
}

static cdl_Status check_node_weights(Document *doc, size_t i, const json_t *node) {
  const json_t *weights = json_object_get(node, "weights");
  uint32_t index = json_get_index(node, "mesh");
  if (!weights) return CDL_OK;
  if (index == DOCUMENT_NONE)
    return document_fail(doc, AT("/nodes/%zu/weights", i), "UNSATISFIED_DEPENDENCY",
                         "weights need a mesh.");
  const json_t *mesh = json_array_get(list_of(doc, "meshes"), index);
  const json_t *primitive = json_array_get(json_object_get(mesh, "primitives"), 0);
  size_t count = json_array_size(json_object_get(primitive, "targets"));
  if (json_array_size(weights) == count) return CDL_OK;
  return document_fail(doc, AT("/nodes/%zu/weights", i), "NODE_WEIGHTS_INVALID",
                       "there are %zu weights for %zu morph targets.", json_array_size(weights),
                       count);
}

cdl_Status check_deformation(Document *doc) {
  const json_t *meshes = list_of(doc, "meshes"), *nodes = list_of(doc, "nodes");
  cdl_Status status = check_joints(doc);
  for (size_t m = 0; m < json_array_size(meshes) && !status; m++)
    status = check_mesh(doc, m, json_array_get(meshes, m));
  for (size_t i = 0; i < json_array_size(nodes) && !status; i++)
    status = check_node_weights(doc, i, json_array_get(nodes, i));
  return status;
}
