/* check_nodes.c: the node graph. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/check.h"

/* Deeper graphs are not made by people. */
#define DEEPEST 65536

/* The validator's tolerance for quantised unit vectors is of this size. */
#define UNIT_TOLERANCE 0.01

/* The trees in preorder, so that whether one node lies below another is one comparison. */
typedef struct Graph {
  uint32_t count;
  uint32_t *parent; /* DOCUMENT_NONE: a root */
  uint32_t *order;  /* node by place in the order */
  uint32_t *place;  /* place of a node, DOCUMENT_NONE: in a loop */
  uint32_t *size;   /* of a node and all below it */
  uint32_t *depth;  /* 1: a root */
  uint32_t *root;
} Graph;

static const json_t *node_at(const Document *doc, uint32_t i) {
  return json_array_get(json_object_get(doc->root, "nodes"), i);
}

static cdl_Status link_children(Document *doc, uint32_t i, Graph *graph) {
  const json_t *children = json_object_get(node_at(doc, i), "children");
  for (size_t k = 0; k < json_array_size(children); k++) {
    uint32_t child = (uint32_t)json_number_value(json_array_get(children, k));
    if (child == i)
      return document_fail(doc, AT("/nodes/%u", i), "NODE_LOOP", "it is its own child.");
    if (graph->parent[child] != DOCUMENT_NONE)
      return document_fail(doc, AT("/nodes/%u/children/%zu", i, k), "NODE_PARENT_OVERRIDE",
                           "node %u is already a child of node %u.", child, graph->parent[child]);
    graph->parent[child] = i;
  }
  return CDL_OK;
}

static void enter(Graph *graph, uint32_t node, uint32_t place) {
  uint32_t parent = graph->parent[node];
  graph->order[place] = node;
  graph->place[node] = place;
  graph->size[node] = 1;
  graph->depth[node] = parent == DOCUMENT_NONE ? 1 : graph->depth[parent] + 1;
  graph->root[node] = parent == DOCUMENT_NONE ? node : graph->root[parent];
}

/* The order's own tail serves as the stack of a tree's open nodes: what is not yet entered. */
static uint32_t walk_tree(const Document *doc, Graph *graph, uint32_t root, uint32_t place) {
  uint32_t *stack = graph->order + graph->count, open = 1;
  stack[-1] = root;
  while (open) {
    uint32_t node = stack[-(int64_t)open--];
    enter(graph, node, place++);
    const json_t *children = json_object_get(node_at(doc, node), "children");
    for (size_t k = json_array_size(children); k-- > 0;)
      stack[-(int64_t)++open] = (uint32_t)json_number_value(json_array_get(children, k));
  }
  return place;
}

/* With one parent each, a node that no root reaches is part of a loop. */
static cdl_Status order_nodes(Document *doc, Graph *graph) {
  uint32_t place = 0;
  for (uint32_t i = 0; i < graph->count; i++)
    if (graph->parent[i] == DOCUMENT_NONE) place = walk_tree(doc, graph, i, place);
  for (uint32_t i = 0; i < graph->count; i++) {
    if (graph->place[i] == DOCUMENT_NONE)
      return document_fail(doc, AT("/nodes/%u", i), "NODE_LOOP", "its parents form a loop.");
    if (graph->depth[i] > DEEPEST)
      return document_fail(doc, AT("/nodes/%u", i), "NODE_TOO_DEEP",
                           "it lies %u nodes deep; at most %d are read.", graph->depth[i], DEEPEST);
  }
  for (uint32_t k = place; k-- > 0;) {
    uint32_t node = graph->order[k], parent = graph->parent[node];
    if (parent != DOCUMENT_NONE) graph->size[parent] += graph->size[node];
  }
  return CDL_OK;
}

static double column_dot(const double *m, int a, int b) {
  return m[4 * a] * m[4 * b] + m[4 * a + 1] * m[4 * b + 1] + m[4 * a + 2] * m[4 * b + 2];
}

/* A product of translation, rotation and scale has perpendicular columns, none of them zero. */
static int is_trs(const double *m) {
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) return 0;
  for (int a = 0; a < 3; a++) {
    int b = (a + 1) % 3;
    double lengths = sqrt(column_dot(m, a, a)) * sqrt(column_dot(m, b, b));
    if (!(lengths > 0) || fabs(column_dot(m, a, b)) > 1e-3 * lengths) return 0;
  }
  return 1;
}

static cdl_Status check_transform(Document *doc, uint32_t i, const json_t *node) {
  const json_t *matrix = json_object_get(node, "matrix"),
               *rotation = json_object_get(node, "rotation");
  double m[16], length = 0;
  for (int k = 0; k < 16; k++) m[k] = json_number_value(json_array_get(matrix, k));
  if (matrix &&
      (rotation || json_object_get(node, "translation") || json_object_get(node, "scale")))
    return document_fail(doc, AT("/nodes/%u/matrix", i), "NODE_MATRIX_TRS",
                         "a node has either a matrix or translation, rotation and scale.");
  if (matrix && !is_trs(m))
    return document_fail(doc, AT("/nodes/%u/matrix", i), "NODE_MATRIX_NON_TRS",
                         "it is not a product of translation, rotation and scale.");
  for (int k = 0; k < 4; k++) {
    double x = json_number_value(json_array_get(rotation, k));
    length += x * x;
  }
  if (rotation && fabs(sqrt(length) - 1) > UNIT_TOLERANCE)
    return document_fail(doc, AT("/nodes/%u/rotation", i), "ROTATION_NON_UNIT",
                         "the quaternion has length %g, not 1.", sqrt(length));
  return CDL_OK;
}

static int mesh_has_joints(const Document *doc, const json_t *node) {
  const json_t *mesh =
      json_array_get(json_object_get(doc->root, "meshes"), json_get_index(node, "mesh"));
  const json_t *primitives = json_object_get(mesh, "primitives");
  for (size_t i = 0; i < json_array_size(primitives); i++)
    if (json_object_get(json_object_get(json_array_get(primitives, i), "attributes"), "JOINTS_0"))
      return 1;
  return 0;
}

static cdl_Status check_instancing(Document *doc, uint32_t i, const json_t *node) {
  static const struct {
    const char *name;
    uint32_t width;
  } known[] = {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}};
  const json_t *attributes =
      json_object_get(json_get_extension(node, "EXT_mesh_gpu_instancing"), "attributes");
  size_t count = 0;
  for (int k = 0; k < 3; k++) {
    uint32_t index = json_get_index(attributes, known[k].name);
    if (index == DOCUMENT_NONE) continue;
    const Accessor *a = &doc->accessors[index];
    const char *at =
        AT("/nodes/%u/extensions/EXT_mesh_gpu_instancing/attributes/%s", i, known[k].name);
    int integer_rotation =
        k == 1 && a->normalized && (a->component == GL_BYTE || a->component == GL_SHORT);
    if (a->width != known[k].width || a->columns != 1 ||
        (a->component != GL_FLOAT && !integer_rotation))
      return document_fail(doc, at, "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
                           "it must be a VEC%u of floats.", known[k].width);
    if (count && a->count != count)
      return document_fail(doc, at, "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                           "it has %zu elements, the one before %zu.", a->count, count);
    count = a->count;
  }
  return CDL_OK;
}

static cdl_Status check_node(Document *doc, uint32_t i) {
  const json_t *node = node_at(doc, i);
  if (json_object_get(node, "skin") && !json_object_get(node, "mesh"))
    return document_fail(doc, AT("/nodes/%u/skin", i), "UNSATISFIED_DEPENDENCY",
                         "a skin needs a mesh.");
  if (json_object_get(node, "skin") && !mesh_has_joints(doc, node))
    return document_fail(doc, AT("/nodes/%u", i), "NODE_SKIN_WITH_NON_SKINNED_MESH",
                         "it has a skin, but its mesh no joints.");
  cdl_Status status = check_transform(doc, i, node);
  return status ? status : check_instancing(doc, i, node);
}

static int is_above(const Graph *graph, uint32_t above, uint32_t node) {
  return graph->place[node] - graph->place[above] < graph->size[above];
}

static cdl_Status check_joints(Document *doc, uint32_t i, const json_t *skin, const Graph *graph) {
  const json_t *joints = json_object_get(skin, "joints");
  uint32_t skeleton = json_get_index(skin, "skeleton"), root = DOCUMENT_NONE;
  for (size_t k = 0; k < json_array_size(joints); k++) {
    uint32_t joint = (uint32_t)json_number_value(json_array_get(joints, k));
    if (k == 0) root = graph->root[joint];
    if (graph->root[joint] != root)
      return document_fail(doc, AT("/skins/%u/joints", i), "SKIN_NO_COMMON_ROOT",
                           "node %u belongs to another tree than the rest.", joint);
    if (skeleton != DOCUMENT_NONE && !is_above(graph, skeleton, joint))
      return document_fail(doc, AT("/skins/%u/skeleton", i), "SKIN_SKELETON_INVALID",
                           "node %u does not lie below it.", joint);
  }
  return CDL_OK;
}

static cdl_Status check_skin(Document *doc, uint32_t i, const Graph *graph) {
  const json_t *skin = json_array_get(json_object_get(doc->root, "skins"), i);
  uint32_t matrices = json_get_index(skin, "inverseBindMatrices");
  size_t joints = json_array_size(json_object_get(skin, "joints"));
  const char *at = AT("/skins/%u/inverseBindMatrices", i);
  if (matrices != DOCUMENT_NONE) {
    const Accessor *a = &doc->accessors[matrices];
    if (a->width != 16 || a->component != GL_FLOAT)
      return document_fail(doc, at, "SKIN_IBM_INVALID_FORMAT", "they must be MAT4 of floats.");
    if (a->count < joints)
      return document_fail(doc, at, "INVALID_IBM_ACCESSOR_COUNT", "there are %zu for %zu joints.",
                           a->count, joints);
  }
  return check_joints(doc, i, skin, graph);
}

static cdl_Status check_scenes(Document *doc, const Graph *graph) {
  const json_t *scenes = json_object_get(doc->root, "scenes");
  for (size_t s = 0; s < json_array_size(scenes); s++) {
    const json_t *nodes = json_object_get(json_array_get(scenes, s), "nodes");
    for (size_t k = 0; k < json_array_size(nodes); k++) {
      uint32_t node = (uint32_t)json_number_value(json_array_get(nodes, k));
      if (graph->parent[node] != DOCUMENT_NONE)
        return document_fail(doc, AT("/scenes/%zu/nodes/%zu", s, k), "SCENE_NON_ROOT_NODE",
                             "node %u is a child of node %u.", node, graph->parent[node]);
    }
  }
  return CDL_OK;
}

static cdl_Status make_graph(Document *doc, Graph *graph) {
  graph->count = (uint32_t)json_array_size(json_object_get(doc->root, "nodes"));
  size_t n = (size_t)graph->count + 1;
  uint32_t *all = malloc(6 * n * sizeof *all);
  if (!all) return document_out_of_memory(doc);
  memset(all, 0xff, 6 * n * sizeof *all);
  graph->parent = all;
  graph->order = all + n;
  graph->place = all + 2 * n;
  graph->size = all + 3 * n;
  graph->depth = all + 4 * n;
  graph->root = all + 5 * n;
  cdl_Status status = CDL_OK;
  for (uint32_t i = 0; i < graph->count && !status; i++) status = link_children(doc, i, graph);
  return status ? status : order_nodes(doc, graph);
}

cdl_Status check_nodes(Document *doc) {
  Graph graph = {0};
  cdl_Status status = make_graph(doc, &graph);
  uint32_t skins = (uint32_t)json_array_size(json_object_get(doc->root, "skins"));
  for (uint32_t i = 0; i < graph.count && !status; i++) status = check_node(doc, i);
  for (uint32_t i = 0; i < skins && !status; i++) status = check_skin(doc, i, &graph);
  if (!status) status = check_scenes(doc, &graph);
  free(graph.parent);
  return status;
}
