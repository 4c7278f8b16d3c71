/* gltf_node.cpp: the node graph: transforms, instances, cameras and lights. */
#include <algorithm>
#include <cmath>

#include "scene/accessor.h"
#include "scene/gltf.h"

namespace {

/* Squares of coordinates stay within single precision. */
constexpr double FARTHEST = 1e18;

template <typename T> T *push(T *&array, uint32_t count) {
  T *slot = (T *)array_push((void **)&array, count, sizeof(T));
  if (!slot) throw std::bad_alloc();
  return slot;
}

char *copy(const std::string &text) {
  char *made = string_copy(text.c_str());
  if (!made) throw std::bad_alloc();
  return made;
}

} // namespace

Matrix GltfScene::local_matrix(size_t node) const {
  const tinygltf::Node &n = model.nodes[node];
  double t[10] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1};
  if (n.matrix.size() == 16) return matrix_from_columns(n.matrix.data());
  std::copy(n.translation.begin(), n.translation.end(), t);
  std::copy(n.rotation.begin(), n.rotation.end(), t + 3);
  std::copy(n.scale.begin(), n.scale.end(), t + 7);
  return matrix_from_trs(t, t + 3, t + 7);
}

bool GltfScene::is_shown(size_t node) const {
  const json_t *json = json_array_get(json_object_get(builder->doc->root, "nodes"), node);
  return !json_is_false(
      json_object_get(json_get_extension(json, "KHR_node_visibility"), "visible"));
}

/* Parents before children, without recursion: graphs may be deep. */
void GltfScene::place_nodes() {
  size_t count = model.nodes.size();
  world.assign(count, matrix_identity());
  visible.assign(count, 0);
  std::vector<uint8_t> is_child(count, 0);
  for (size_t i = 0; i < count; i++)
    for (int child : model.nodes[i].children) is_child[(size_t)child] = 1;
  std::vector<uint32_t> open;
  for (size_t i = 0; i < count; i++)
    if (!is_child[i]) {
      world[i] = local_matrix(i);
      visible[i] = is_shown(i);
      open.push_back((uint32_t)i);
    }
  while (!open.empty()) {
    uint32_t parent = open.back();
    open.pop_back();
    for (int child : model.nodes[parent].children) {
      Matrix local = local_matrix((size_t)child);
      world[(size_t)child] = matrix_multiply(&world[parent], &local);
      visible[(size_t)child] = visible[parent] && is_shown((size_t)child);
      open.push_back((uint32_t)child);
    }
  }
}

/* The nodes of the scene in depth-first order; without scenes, all. */
std::vector<uint32_t> GltfScene::shown_nodes() const {
  std::vector<uint32_t> order, open;
  if (model.scenes.empty()) {
    for (size_t i = 0; i < model.nodes.size(); i++) order.push_back((uint32_t)i);
    return order;
  }
  const tinygltf::Scene &scene = model.scenes[model.defaultScene < 0 ? 0 : model.defaultScene];
  for (size_t i = scene.nodes.size(); i-- > 0;) open.push_back((uint32_t)scene.nodes[i]);
  while (!open.empty()) {
    uint32_t node = open.back();
    open.pop_back();
    order.push_back(node);
    const std::vector<int> &children = model.nodes[node].children;
    for (size_t i = children.size(); i-- > 0;) open.push_back((uint32_t)children[i]);
  }
  return order;
}

void GltfScene::add_camera(uint32_t node) {
  struct cdl_Scene *scene = builder->scene;
  uint32_t index = (uint32_t)model.nodes[node].camera;
  const tinygltf::Camera &from = model.cameras[index];
  const json_t *json = json_array_get(json_object_get(builder->doc->root, "cameras"), index);
  const json_t *cdl = json_get_extension(json, "CDL_camera");
  if (from.type != "perspective" && from.type != "orthographic") return;
  cdl_SceneCamera *to = push(scene->cameras, scene->camera_count);
  to->name = copy(from.name.empty() ? model.nodes[node].name : from.name);
  scene->camera_count++;
  matrix_to_float(&world[node], to->to_world);
  to->orthographic = from.type == "orthographic";
  if (to->orthographic) {
    to->xmag = (float)std::fabs(from.orthographic.xmag);
    to->ymag = (float)std::fabs(from.orthographic.ymag);
    to->aspect = to->xmag / to->ymag;
  } else {
    to->yfov = (float)from.perspective.yfov;
    to->aspect = (float)from.perspective.aspectRatio;
  }
  to->aperture_radius = (float)json_get_number(cdl, "apertureRadius", 0);
  to->focus_distance = (float)json_get_number(cdl, "focusDistance", 0);
  to->blades = (uint32_t)json_get_number(cdl, "blades", 0);
  json_get_numbers(cdl, "shutter", 2, to->shutter);
}

uint32_t GltfScene::add_object(uint32_t node, uint32_t number) {
  struct cdl_Scene *scene = builder->scene;
  const tinygltf::Node &from = model.nodes[node];
  std::string name = from.name.empty() ? model.meshes[(size_t)from.mesh].name : from.name;
  if (name.empty()) name = "node " + std::to_string(node);
  if (number) name += " " + std::to_string(number);
  *push(scene->object_names, scene->object_count) = copy(name);
  return scene->object_count++;
}

void GltfScene::grow_bounds(const cdl_SceneMesh &mesh, const Matrix &to_world) {
  for (size_t i = 0; i < mesh.vertex_count; i++) {
    double at[3],
        in[3] = {mesh.positions[3 * i], mesh.positions[3 * i + 1], mesh.positions[3 * i + 2]};
    matrix_apply(&to_world, in, 1, at);
    for (int c = 0; c < 3; c++) {
      if (!(std::fabs(at[c]) <= FARTHEST))
        throw Failed{document_fail(builder->doc, "/meshes", "VALUE_NOT_IN_RANGE",
                                   "a vertex lies at %g m; %g m is the limit.", at[c], FARTHEST)};
      builder->scene->bounds[0][c] = std::min(builder->scene->bounds[0][c], (float)at[c]);
      builder->scene->bounds[1][c] = std::max(builder->scene->bounds[1][c], (float)at[c]);
    }
  }
}

void GltfScene::add_instance(uint32_t node, uint32_t mesh, const Matrix &to_world,
                             uint32_t object) {
  struct cdl_Scene *scene = builder->scene;
  float values[12];
  matrix_to_float(&to_world, values);
  for (float value : values)
    if (!std::isfinite(value)) {
      char at[256];
      throw Failed{document_fail(builder->doc, pointer_format(at, "/nodes/%u", node),
                                 "VALUE_NOT_IN_RANGE",
                                 "its transform in the world is beyond single precision.")};
    }
  int rank = matrix_rank(&to_world);
  if (scene->meshes[mesh].triangle_count == 0 || rank < 2) return;
  if (rank == 2) {
    uint32_t baked;
    Matrix identity = matrix_identity();
    check(bake_mesh(builder, mesh, &to_world, &baked));
    push_instance(baked, identity, object);
  } else {
    push_instance(mesh, to_world, object);
  }
}

void GltfScene::push_instance(uint32_t mesh, const Matrix &to_world, uint32_t object) {
  struct cdl_Scene *scene = builder->scene;
  cdl_SceneInstance *to = push(scene->instances, scene->instance_count);
  to->mesh = mesh;
  to->object = object;
  matrix_to_float(&to_world, to->to_world);
  scene->instance_count++;
  grow_bounds(scene->meshes[mesh], to_world);
}

/* EXT_mesh_gpu_instancing: as many copies as its attributes have elements. */
std::vector<Matrix> GltfScene::gpu_instances(uint32_t node) const {
  const json_t *json = json_array_get(json_object_get(builder->doc->root, "nodes"), node);
  const json_t *attributes =
      json_object_get(json_get_extension(json, "EXT_mesh_gpu_instancing"), "attributes");
  static const char *const names[] = {"TRANSLATION", "ROTATION", "SCALE"};
  static const int width[] = {3, 4, 3}, slot[] = {0, 3, 7};
  std::vector<double> copies;
  size_t count = 0;
  for (int a = 0; a < 3; a++) {
    uint32_t accessor = json_get_index(attributes, names[a]);
    if (accessor == DOCUMENT_NONE) continue;
    check(accessor_require(builder->doc, accessor));
    count = builder->doc->accessors[accessor].count;
    copies.resize(10 * count);
    if (copies[9] == 0)
      for (size_t i = 0; i < count; i++) std::fill_n(&copies[10 * i + 6], 4, 1.0);
    float *values = accessor_floats(builder->doc, accessor);
    if (!values) throw std::bad_alloc();
    for (size_t i = 0; i < count; i++)
      std::copy_n(values + i * width[a], width[a], &copies[10 * i + slot[a]]);
    free(values);
  }
  std::vector<Matrix> placed;
  for (size_t i = 0; i < count; i++) {
    const double *t = &copies[10 * i];
    Matrix local = matrix_from_trs(t, t + 3, t + 7);
    placed.push_back(matrix_multiply(&world[node], &local));
  }
  if (!attributes || placed.empty()) placed.assign(1, world[node]);
  return placed;
}

void GltfScene::add_instances(uint32_t node) {
  if (model.nodes[node].skin >= 0) return add_skinned(node);
  const std::vector<uint32_t> &primitives = mesh_primitives(node);
  std::vector<Matrix> placed = gpu_instances(node);
  for (size_t i = 0; i < placed.size(); i++) {
    uint32_t object = add_object(node, placed.size() > 1 ? (uint32_t)i + 1 : 0);
    for (uint32_t mesh : primitives) add_instance(node, mesh, placed[i], object);
  }
}

void GltfScene::add_node(uint32_t node) {
  const json_t *json = json_array_get(json_object_get(builder->doc->root, "nodes"), node);
  const json_t *light = json_get_extension(json, "KHR_lights_punctual");
  if (model.nodes[node].mesh >= 0 && visible[node]) add_instances(node);
  if (model.nodes[node].camera >= 0) add_camera(node);
  if (light && visible[node])
    check(build_light(builder, json_get_index(light, "light"), &world[node]));
}

void GltfScene::build() {
  place_nodes();
  for (uint32_t node : shown_nodes()) add_node(node);
}
