/* vdb.cpp: the only file that sees OpenVDB. Grids are read from memory, one of them alone, and
 * handed on block by block; reads past the end of the file are errors, which stops most loops that
 * a damaged count would start. */
#include "scene/vdb.h"

#include <openvdb/openvdb.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <istream>
#include <streambuf>
#include <string>
#include <type_traits>
#include <vector>

namespace {

/* Files before this version, of 2013, are laid out in other ways. */
constexpr uint32_t oldest_version = 222;
constexpr uint32_t most_grids = 4096, longest_name = 4096;
constexpr int leaf_size = 512, farthest = 1 << 28;
const char half_suffix[] = "_HalfFloat";

struct Refused {
  std::string why;
};
struct Stopped {};

/* A file in memory as a stream that can be read and sought in. */
class MemoryBuffer final : public std::streambuf {
public:
  MemoryBuffer(const uint8_t *data, size_t size) {
    char *begin = const_cast<char *>(reinterpret_cast<const char *>(data));
    setg(begin, begin, begin + size);
  }

protected:
  pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
    off_type base = from == std::ios_base::beg   ? 0
                    : from == std::ios_base::cur ? gptr() - eback()
                                                 : egptr() - eback();
    if (by < -base || by > egptr() - eback() - base) return pos_type(off_type(-1));
    setg(eback(), eback() + base + by, egptr());
    return base + by;
  }
  pos_type seekpos(pos_type to, std::ios_base::openmode mode) override {
    return seekoff(to, std::ios_base::beg, mode);
  }
};

/* A grid as the file's table of contents has it. */
struct Entry {
  std::string name, type, parent;
  bool half;
  int64_t position;
};

class Archive final : public openvdb::io::Archive {
public:
  Archive(const uint8_t *data, size_t size) : buffer(data, size), stream(&buffer) {
    stream.exceptions(std::ios_base::failbit | std::ios_base::badbit | std::ios_base::eofbit);
    check_begin();
    readHeader(stream);
    if (!inputHasGridOffsets())
      throw Refused{"it was written as a stream, without a table of contents; write it to a file"};
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    openvdb::MetaMap metadata;
    metadata.readMeta(stream);
    read_entries();
  }

  const Entry &find(const char *name) const {
    std::string list;
    for (const Entry &entry : entries) {
      if (entry.name == name) return entry;
      list += (list.empty() ? "" : ", ") + entry.name;
    }
    throw Refused{"it has no grid of that name, but " + (list.empty() ? "none at all" : list)};
  }

  /* All but the voxels. The order is that of io::Archive::readGrid(). */
  void read(const Entry &entry, openvdb::GridBase &grid) {
    stream.seekg(entry.position);
    readGridCompression(stream);
    auto metadata = openvdb::io::StreamMetadata::Ptr(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(stream, metadata, false);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    grid.setSaveFloatAsHalf(entry.half);
    grid.readMeta(stream);
    grid.readTransform(stream);
    check_class(grid);
    grid.readTopology(stream);
    grid.readBuffers(stream);
  }

private:
  MemoryBuffer buffer;
  std::istream stream;
  std::vector<Entry> entries;

  /* The library only warns of what it cannot read. */
  void check_begin() {
    int64_t magic = 0;
    uint32_t version = 0;
    stream.read(reinterpret_cast<char *>(&magic), sizeof magic);
    stream.read(reinterpret_cast<char *>(&version), sizeof version);
    stream.seekg(0);
    if (magic != openvdb::OPENVDB_MAGIC) throw Refused{"it is no VDB file"};
    if (version < oldest_version || version > openvdb::OPENVDB_FILE_VERSION)
      throw Refused{"its version is " + std::to_string(version) + ", not " +
                    std::to_string(oldest_version) + " to " +
                    std::to_string(openvdb::OPENVDB_FILE_VERSION)};
  }

  std::string read_text() {
    uint32_t length = 0;
    stream.read(reinterpret_cast<char *>(&length), sizeof length);
    if (length > longest_name) throw Refused{"it is damaged: a name is too long"};
    std::string text(length, '\0');
    stream.read(&text[0], length);
    return text;
  }

  void read_entries() {
    int32_t count = readGridCount(stream);
    if (count < 0 || (uint32_t)count > most_grids) throw Refused{"it is damaged: too many grids"};
    for (int32_t i = 0; i < count; i++) {
      Entry entry;
      int64_t offsets[3];
      entry.name = openvdb::io::GridDescriptor::stripSuffix(read_text());
      entry.type = read_text();
      entry.parent = read_text();
      stream.read(reinterpret_cast<char *>(offsets), sizeof offsets);
      size_t suffix = sizeof half_suffix - 1, length = entry.type.size();
      entry.half = length > suffix && !entry.type.compare(length - suffix, suffix, half_suffix);
      if (entry.half) entry.type.resize(length - suffix);
      entry.position = offsets[0];
      entries.push_back(entry);
      stream.seekg(offsets[2]);
    }
  }

  static void check_class(const openvdb::GridBase &grid) {
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET)
      throw Refused{"it is a level set; convert it into a fog volume"};
    if (grid.getGridClass() == openvdb::GRID_STAGGERED)
      throw Refused{"its values are staggered; resample them to the centres of voxels"};
    if (!grid.transform().isLinear())
      throw Refused{"its transform is not linear (a frustum); resample it to a linear one"};
  }
};

template <class Value> struct Channels {
  static constexpr uint32_t count = 1;
  static float get(const Value &value, uint32_t) { return (float)value; }
};
template <class Scalar> struct Channels<openvdb::math::Vec3<Scalar>> {
  static constexpr uint32_t count = 3;
  static float get(const openvdb::math::Vec3<Scalar> &value, uint32_t c) {
    return (float)value[(int)c];
  }
};

template <class Value> void spread(const Value &value, float out[3]) {
  for (uint32_t c = 0; c < Channels<Value>::count; c++) out[c] = Channels<Value>::get(value, c);
}

void put_transform(const openvdb::GridBase &grid, double to_world[12]) {
  /* The library multiplies rows from the left. */
  openvdb::math::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 4; c++) to_world[4 * r + c] = matrix[c][r];
}

/* Goes through the nodes of a tree itself: the library's own iterators, and whatever makes a grid
 * of a type known here, would be compiled anew for every type. */
template <class Grid> class Sender {
public:
  using Value = typename Grid::ValueType;
  using Tree = typename Grid::TreeType;
  using Leaf = typename Tree::LeafNodeType;

  Sender(const Grid &of, const VdbSink *to) : grid(of), sink(to) {}

  void send() {
    VdbHeader header = {};
    float background[3];
    header.channels = Channels<Value>::count;
    put_transform(grid, header.to_world);
    spread(grid.tree().root().background(), background);
    for (uint32_t c = 0; c < header.channels; c++)
      header.background = std::fmax(header.background, std::fabs((double)background[c]));
    survey(header);
    if (!sink->begin(sink->user, &header)) throw Stopped{};
    visit(
        grid.tree().root(), [this](const Leaf &leaf) { send_leaf(leaf); },
        [this](const openvdb::Coord &at, uint32_t size, const Value &value) {
          send_tile(at, size, value);
        });
  }

private:
  const Grid &grid;
  const VdbSink *sink;

  /* Leaves with active voxels, and active tiles. */
  template <class Node, class OfLeaf, class OfTile>
  static void visit(const Node &node, const OfLeaf &of_leaf, const OfTile &of_tile) {
    for (auto tile = node.cbeginValueOn(); tile; ++tile)
      of_tile(tile.getCoord(), (uint32_t)Node::ChildNodeType::DIM, *tile);
    for (auto child = node.cbeginChildOn(); child; ++child) visit(*child, of_leaf, of_tile);
  }
  template <class OfLeaf, class OfTile>
  static void visit(const Leaf &leaf, const OfLeaf &of_leaf, const OfTile &) {
    if (!leaf.isEmpty()) of_leaf(leaf);
  }

  void survey(VdbHeader &header) const {
    openvdb::CoordBBox all;
    visit(
        grid.tree().root(),
        [&](const Leaf &leaf) {
          openvdb::CoordBBox box;
          leaf.evalActiveBoundingBox(box);
          all.expand(box);
          header.leaves++;
          header.active += leaf.onVoxelCount();
        },
        [&](const openvdb::Coord &at, uint32_t size, const Value &) {
          for (int k = 0; k < 3; k++)
            if (at[k] < -farthest || at[k] > farthest)
              throw Refused{"its voxels lie too far from its origin"};
          all.expand(openvdb::CoordBBox::createCube(at, (int32_t)size));
          header.tiles++;
          header.active += (uint64_t)size * size * size;
        });
    if (all.empty()) throw Refused{"it has no active voxels"};
    for (int k = 0; k < 3; k++) {
      header.low[k] = all.min()[k];
      header.high[k] = all.max()[k];
    }
  }

  /* The library stores z fastest. */
  void send_leaf(const Leaf &leaf) const {
    float values[3 * leaf_size] = {};
    const Value *from = leaf.buffer().data();
    for (auto on = leaf.cbeginValueOn(); on; ++on) {
      uint32_t at = on.pos(), to = at >> 6 | (at >> 3 & 7) << 3 | (at & 7) << 6;
      for (uint32_t c = 0; c < Channels<Value>::count; c++)
        values[c * leaf_size + to] = Channels<Value>::get(from[at], c);
    }
    if (!sink->leaf(sink->user, leaf.origin().data(), values)) throw Stopped{};
  }

  void send_tile(const openvdb::Coord &at, uint32_t size, const Value &value) const {
    float values[3];
    spread(value, values);
    if (!sink->tile(sink->user, at.data(), size, values)) throw Stopped{};
  }
};

/* A type of grid by the name that files give it. */
struct Type {
  const char *name;
  void (*send)(const openvdb::GridBase &grid, const VdbSink *sink);
};

template <class Grid> void send_as(const openvdb::GridBase &grid, const VdbSink *sink) {
  Sender<Grid>(static_cast<const Grid &>(grid), sink).send();
}

const Type types[] = {
    {"Tree_float_5_4_3", send_as<openvdb::FloatGrid>},
    {"Tree_double_5_4_3", send_as<openvdb::DoubleGrid>},
    {"Tree_int32_5_4_3", send_as<openvdb::Int32Grid>},
    {"Tree_int64_5_4_3", send_as<openvdb::Int64Grid>},
    {"Tree_vec3s_5_4_3", send_as<openvdb::Vec3SGrid>},
    {"Tree_vec3d_5_4_3", send_as<openvdb::Vec3DGrid>},
};

void read_grid(const uint8_t *data, size_t size, const char *name, const VdbSink *sink) {
  Archive archive(data, size);
  const Entry &entry = archive.find(name);
  if (!entry.parent.empty())
    throw Refused{"it shares the voxels of the grid " + entry.parent +
                  "; save it without instancing"};
  for (const Type &type : types) {
    if (entry.type != type.name) continue;
    /* Never freed, as the library would start threads for it; the process ends anyway. */
    const auto &grid = *new openvdb::GridBase::Ptr(openvdb::GridBase::createGrid(entry.type));
    archive.read(entry, *grid);
    return type.send(*grid, sink);
  }
  throw Refused{"its type is " + entry.type + ", which is not supported: use float or vec3s"};
}

} // namespace

int vdb_prepare(void) {
  try {
    openvdb::initialize();
    /* At its first use TBB looks for further libraries, which the cage does not allow. */
    tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    tbb::parallel_for(0, 2, [](int) {});
    return 1;
  } catch (...) {
    return 0;
  }
}

int vdb_read(const uint8_t *data, size_t size, const char *name, const VdbSink *sink,
             char error[512]) {
  std::string why;
  try {
    /* nor does it allow threads */
    tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    read_grid(data, size, name, sink);
    return 1;
  } catch (const Refused &refused) {
    why = refused.why;
  } catch (const Stopped &) {
    why = "";
  } catch (const std::bad_alloc &) {
    why = "it would take more memory than is allowed";
  } catch (const std::ios_base::failure &) {
    why = "it is damaged or cut short";
  } catch (const std::exception &exception) {
    why = std::string("it is damaged: ") + exception.what();
  } catch (...) {
    why = "it is damaged";
  }
  snprintf(error, 512, "%s", why.c_str());
  return 0;
}
