/* gltf_mesh.cpp: primitives of glTF meshes, each made into a mesh once, or once a skin. */
#include "scene/accessor.h"
#include "scene/gltf.h"

PrimitiveSource GltfScene::primitive_source(uint32_t mesh, size_t number,
                                            const std::vector<double> &weights) const {
  const tinygltf::Primitive &primitive = model.meshes[mesh].primitives[number];
  auto attribute = [&](const char *name) {
    auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? CDL_NONE : index_of(found->second);
  };
  const json_t *meshes_json = json_object_get(builder->doc->root, "meshes");
  const json_t *json =
      json_array_get(json_object_get(json_array_get(meshes_json, mesh), "primitives"), number);
  PrimitiveSource source = {};
  source.position = attribute("POSITION");
  source.normal = attribute("NORMAL");
  source.tangent = attribute("TANGENT");
  source.uv[0] = attribute("TEXCOORD_0");
  source.uv[1] = attribute("TEXCOORD_1");
  source.color = attribute("COLOR_0");
  source.indices = json_get_index(json, "indices");
  source.material = variant_material(json, builder->variant, index_of(primitive.material));
  source.mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : (uint32_t)primitive.mode;
  source.name = model.meshes[mesh].name.c_str();
  source.json = json;
  source.weights = weights.data();
  source.weight_count = weights.size();
  return source;
}

/* A node's weights count before those of its mesh; without any, all are 0. */
std::vector<double> GltfScene::morph_weights(uint32_t node) const {
  uint32_t mesh = (uint32_t)model.nodes[node].mesh;
  const json_t *json = json_array_get(json_object_get(builder->doc->root, "nodes"), node);
  const json_t *given = json_object_get(json, "weights");
  json = json_array_get(json_object_get(builder->doc->root, "meshes"), mesh);
  if (!given) given = json_object_get(json, "weights");
  std::vector<double> weights;
  if (model.meshes[mesh].primitives[0].targets.empty()) return weights;
  for (size_t i = 0; i < json_array_size(given); i++)
    weights.push_back(json_number_value(json_array_get(given, i)));
  return weights;
}

const std::vector<uint32_t> &GltfScene::mesh_primitives(uint32_t node) {
  uint32_t mesh = (uint32_t)model.nodes[node].mesh;
  std::vector<double> weights = morph_weights(node);
  auto found = meshes.find({mesh, weights});
  if (found != meshes.end()) return found->second;
  std::vector<uint32_t> made;
  for (size_t i = 0; i < model.meshes[mesh].primitives.size(); i++) {
    PrimitiveSource source = primitive_source(mesh, i, weights);
    uint32_t index;
    check(build_primitive(builder, &source, &index));
    if (index != CDL_NONE) made.push_back(index);
  }
  return meshes[{mesh, weights}] = made;
}

std::vector<Matrix> GltfScene::joint_matrices(uint32_t index) const {
  const tinygltf::Skin &skin = model.skins[index];
  std::vector<Matrix> joints;
  float *inverse = nullptr;
  if (skin.inverseBindMatrices >= 0) {
    check(accessor_require(builder->doc, (uint32_t)skin.inverseBindMatrices));
    inverse = accessor_floats(builder->doc, (uint32_t)skin.inverseBindMatrices);
    if (!inverse) throw std::bad_alloc();
  }
  joints.reserve(skin.joints.size());
  for (size_t j = 0; j < skin.joints.size(); j++) {
    Matrix bind = matrix_identity();
    if (inverse) {
      double columns[16];
      for (int i = 0; i < 16; i++) columns[i] = inverse[16 * j + i];
      bind = matrix_from_columns(columns);
    }
    joints.push_back(matrix_multiply(&world[(size_t)skin.joints[j]], &bind));
  }
  free(inverse);
  return joints;
}

/* Joints say where a skinned primitive lies, and its node does not; primitives of the same mesh
 * that have no joints stay with the node. */
void GltfScene::add_skinned(uint32_t node) {
  uint32_t mesh = (uint32_t)model.nodes[node].mesh, object = add_object(node, 0);
  std::vector<Matrix> joints = joint_matrices((uint32_t)model.nodes[node].skin);
  std::vector<double> weights = morph_weights(node);
  for (size_t i = 0; i < model.meshes[mesh].primitives.size(); i++) {
    PrimitiveSource source = primitive_source(mesh, i, weights);
    uint32_t index;
    check(build_primitive(builder, &source, &index));
    if (index == CDL_NONE) continue;
    bool moved = model.meshes[mesh].primitives[i].attributes.count("JOINTS_0") != 0;
    if (moved)
      check(skin_mesh(builder, &source, joints.data(), (uint32_t)joints.size(),
                      &builder->scene->meshes[index]));
    add_instance(node, index, moved ? matrix_identity() : world[node], object);
  }
}
