/* gltf.h: what the files that see tinygltf share. */
#ifndef CANDELA_SCENE_GLTF_H
#define CANDELA_SCENE_GLTF_H

#include <tiny_gltf.h>

#include <map>
#include <utility>
#include <vector>

#include "scene/build.h"
#include "scene/mesh.h"

/* A failure that has been reported already; it unwinds to gltf_build(). */
struct Failed {
  cdl_Status status;
};

inline void check(cdl_Status status) {
  if (status) throw Failed{status};
}

/* An index of tinygltf, where -1 is none. */
inline uint32_t index_of(int index) { return index < 0 ? CDL_NONE : (uint32_t)index; }

class GltfScene {
public:
  GltfScene(Builder *to, tinygltf::Model &&from) : builder(to), model(std::move(from)) {}

  void build();

private:
  /* gltf_node.cpp */
  void place_nodes();
  Matrix local_matrix(size_t node) const;
  bool is_shown(size_t node) const;
  std::vector<uint32_t> shown_nodes() const;
  void add_node(uint32_t node);
  void add_camera(uint32_t node);
  void add_instances(uint32_t node);
  void add_instance(uint32_t node, uint32_t mesh, const Matrix &to_world, uint32_t object);
  void push_instance(uint32_t mesh, const Matrix &to_world, uint32_t object);
  uint32_t add_object(uint32_t node, uint32_t copy);
  std::vector<Matrix> gpu_instances(uint32_t node) const;
  void grow_bounds(const cdl_SceneMesh &mesh, const Matrix &to_world);

  /* gltf_mesh.cpp */
  PrimitiveSource primitive_source(uint32_t mesh, size_t number,
                                   const std::vector<double> &weights) const;
  std::vector<double> morph_weights(uint32_t node) const;
  const std::vector<uint32_t> &mesh_primitives(uint32_t node);
  void add_skinned(uint32_t node);
  std::vector<Matrix> joint_matrices(uint32_t skin) const;

  Builder *builder;
  tinygltf::Model model;
  std::vector<Matrix> world;
  std::vector<uint8_t> visible; /* a node and all above it: KHR_node_visibility */
  /* glTF mesh and weights of its morph targets -> scene meshes, once made */
  std::map<std::pair<uint32_t, std::vector<double>>, std::vector<uint32_t>> meshes;
};

#endif
