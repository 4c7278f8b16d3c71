#include "vdb_write.h"

#include <openvdb/openvdb.h>

#include <cstring>

namespace {

template <class Value> struct Maker {
  static Value make(const float *from) { return (Value)from[0]; }
  static constexpr int channels = 1;
};
template <class Scalar> struct Maker<openvdb::math::Vec3<Scalar>> {
  static openvdb::math::Vec3<Scalar> make(const float *from) {
    return openvdb::math::Vec3<Scalar>(from[0], from[1], from[2]);
  }
  static constexpr int channels = 3;
};

/* Root nodes alone are made known here: grids as a whole are slow to compile. */
template <class Grid> void fill(openvdb::GridBase &base, const VdbGrid &from) {
  using Value = typename Grid::ValueType;
  using Make = Maker<Value>;
  auto &root = static_cast<Grid &>(base).tree().root();
  const float background[3] = {from.background, from.background, from.background};
  root.setBackground(Make::make(background), false);
  size_t i = 0;
  for (uint32_t z = 0; from.values && z < from.size[2]; z++)
    for (uint32_t y = 0; y < from.size[1]; y++)
      for (uint32_t x = 0; x < from.size[0]; x++, i++) {
        openvdb::Coord at(from.low[0] + (int)x, from.low[1] + (int)y, from.low[2] + (int)z);
        if (!from.active || from.active[i])
          root.setValueOn(at, Make::make(from.values + Make::channels * i));
      }
  for (uint32_t t = 0; t < from.tile_count; t++) {
    const VdbTile &tile = from.tiles[t];
    const float value[3] = {tile.value, tile.value, tile.value};
    root.addTile(tile.side == 8     ? 1
                 : tile.side == 128 ? 2
                                    : 3,
                 openvdb::Coord(tile.origin[0], tile.origin[1], tile.origin[2]), Make::make(value),
                 true);
  }
}

struct Type {
  const char *name, *grid;
  void (*fill)(openvdb::GridBase &, const VdbGrid &);
};

const Type types[] = {
    {"float", "Tree_float_5_4_3", fill<openvdb::FloatGrid>},
    {"half", "Tree_float_5_4_3", fill<openvdb::FloatGrid>},
    {"double", "Tree_double_5_4_3", fill<openvdb::DoubleGrid>},
    {"int32", "Tree_int32_5_4_3", fill<openvdb::Int32Grid>},
    {"int64", "Tree_int64_5_4_3", fill<openvdb::Int64Grid>},
    {"vec3s", "Tree_vec3s_5_4_3", fill<openvdb::Vec3SGrid>},
    {"vec3d", "Tree_vec3d_5_4_3", fill<openvdb::Vec3DGrid>},
    {"bool", "Tree_bool_5_4_3", nullptr},
};

void place(openvdb::GridBase &grid, const VdbGrid &from) {
  using openvdb::math::Transform;
  static const double none[12] = {};
  if (from.frustum) {
    grid.setTransform(Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(9)), 0.5, 2, 0.1));
  } else if (memcmp(from.to_world, none, sizeof none) != 0) {
    const double *m = from.to_world;
    grid.setTransform(Transform::createLinearTransform(
        openvdb::Mat4d(m[0], m[4], m[8], 0.0, m[1], m[5], m[9], 0.0, m[2], m[6], m[10], 0.0, m[3],
                       m[7], m[11], 1.0)));
  }
  if (from.level_set) grid.setGridClass(openvdb::GRID_LEVEL_SET);
}

openvdb::GridBase::Ptr make(const VdbGrid &from) {
  for (const Type &type : types) {
    if (strcmp(type.name, from.type) != 0) continue;
    auto grid = openvdb::GridBase::createGrid(type.grid);
    grid->setName(from.name);
    grid->setSaveFloatAsHalf(strcmp(from.type, "half") == 0);
    if (type.fill) type.fill(*grid, from);
    place(*grid, from);
    return grid;
  }
  throw std::runtime_error("no such type");
}

} // namespace

int vdb_write(const char *path, const VdbGrid *grids, uint32_t count, uint32_t compression) {
  try {
    openvdb::initialize();
    openvdb::GridPtrVec list;
    for (uint32_t i = 0; i < count; i++) list.push_back(make(grids[i]));
    openvdb::io::File file(path);
    file.setCompression(compression);
    file.write(list);
    file.close();
    return 1;
  } catch (const std::exception &exception) {
    fprintf(stderr, "%s: %s\n", path, exception.what());
    return 0;
  }
}
