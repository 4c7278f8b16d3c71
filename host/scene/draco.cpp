/* draco.cpp: the only file that sees the Draco library.
 *
 * The library takes memory for what a stream says it holds, before it has read it. So the two steps
 * in which it does are held up: what they are about to decode is compared with what the scene
 * declares, and with what may be spent. */
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "scene/accessor.h"
#include "scene/compression.h"

namespace {

/* Bytes in work: of a face, more for each further attribute with seams of its own; of a point, for
 * each group of attributes, and for each byte of its attributes. */
constexpr size_t face_bytes = 64, seam_bytes = 16, group_bytes = 16, value_bytes = 2;
constexpr size_t most_attributes = 64, most_seams = 32;
constexpr int most_depth = 32, most_metadata = 4096;

struct Refused {
  const char *why;
};

struct Guard {
  DracoMesh *mesh;
  size_t left;

  void charge(size_t count, size_t each) {
    if (each && count > left / each) throw Refused{"it would take more memory than is allowed"};
    left -= count * each;
  }
};

uint32_t read_varint(draco::DecoderBuffer *buffer) {
  uint32_t value = 0;
  if (!draco::DecodeVarint(&value, buffer)) throw Refused{"it is cut short"};
  return value;
}

void skip(draco::DecoderBuffer *buffer, size_t size) {
  if ((int64_t)size > buffer->remaining_size()) throw Refused{"it is cut short"};
  buffer->Advance((int64_t)size);
}

void skip_name(draco::DecoderBuffer *buffer) {
  uint8_t size = 0;
  if (!buffer->Decode(&size)) throw Refused{"it is cut short"};
  skip(buffer, size);
}

/* One set of metadata and those within: nothing uses them, but the library reads them, and takes
 * memory for as many as each says it has within before it reads the first. */
void guard_metadata(draco::DecoderBuffer *buffer, int depth, int *left) {
  if (depth > most_depth || --*left < 0) throw Refused{"it has too much metadata"};
  for (uint32_t n = read_varint(buffer); n > 0; n--) {
    skip_name(buffer);
    skip(buffer, read_varint(buffer));
  }
  for (uint32_t n = read_varint(buffer); n > 0; n--) {
    skip_name(buffer);
    guard_metadata(buffer, depth + 1, left);
  }
}

void guard_all_metadata(draco::DecoderBuffer buffer) {
  int left = most_metadata;
  for (uint32_t n = read_varint(&buffer); n > 0; n--) {
    read_varint(&buffer); /* which attribute it belongs to */
    guard_metadata(&buffer, 0, &left);
  }
  guard_metadata(&buffer, 0, &left);
}

/* Both kinds of stream: each begins its triangles with their number, one of them after that of the
 * vertices. Copies of the buffer look ahead. */
void guard_faces(Guard *guard, uint32_t faces, size_t seams) {
  if (faces > guard->mesh->most_faces) throw Refused{"it has more triangles than are declared"};
  if (seams > most_seams) throw Refused{"it has too many attributes"};
  guard->charge(faces, face_bytes + seam_bytes * seams);
}

void guard_values(Guard *guard, const draco::PointCloud *cloud, size_t groups) {
  size_t points = cloud->num_points(), bytes = 0;
  if (points != guard->mesh->points) throw Refused{"it has not as many vertices as are declared"};
  if (cloud->num_attributes() > (int)most_attributes || groups > most_attributes)
    throw Refused{"it has too many attributes"};
  for (int i = 0; i < cloud->num_attributes(); i++) {
    const draco::PointAttribute *attribute = cloud->attribute(i);
    /* At least four bytes each: quantised values are decoded to integers first. */
    size_t size = (size_t)draco::DataTypeLength(attribute->data_type());
    bytes += (size < 4 ? 4 : size) * attribute->num_components();
  }
  guard->charge(points, group_bytes * groups + value_bytes * bytes);
}

class Edgebreaker final : public draco::MeshEdgebreakerDecoder {
public:
  explicit Edgebreaker(Guard *of) : guard(of) {}

protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *buffer();
    uint8_t seams = 0;
    read_varint(&ahead);
    uint32_t faces = read_varint(&ahead);
    ahead.Decode(&seams);
    guard_faces(guard, faces, seams);
    return draco::MeshEdgebreakerDecoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    guard_values(guard, point_cloud(), (size_t)num_attributes_decoders());
    return draco::MeshEdgebreakerDecoder::DecodeAllAttributes();
  }

private:
  Guard *guard;
};

class Sequential final : public draco::MeshSequentialDecoder {
public:
  explicit Sequential(Guard *of) : guard(of) {}

protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *buffer();
    guard_faces(guard, read_varint(&ahead), 0);
    if (read_varint(&ahead) != guard->mesh->points)
      throw Refused{"it has not as many vertices as are declared"};
    return draco::MeshSequentialDecoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    guard_values(guard, point_cloud(), (size_t)num_attributes_decoders());
    return draco::MeshSequentialDecoder::DecodeAllAttributes();
  }

private:
  Guard *guard;
};

void decode(Guard *guard, draco::Mesh *out) {
  draco::DecoderBuffer buffer;
  draco::DracoHeader header;
  buffer.Init((const char *)guard->mesh->stream, guard->mesh->size);
  draco::DecoderBuffer ahead = buffer;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok())
    throw Refused{"it does not begin with DRACO"};
  if (header.version_major != 2 || header.version_minor != 2)
    throw Refused{"its version is not 2.2, the one that glTF allows"};
  if (header.encoder_type != draco::TRIANGULAR_MESH) throw Refused{"it is no triangle mesh"};
  if (header.flags & METADATA_FLAG_MASK) guard_all_metadata(ahead);
  draco::DecoderOptions options;
  draco::Status status;
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    status = Edgebreaker(guard).Decode(options, &buffer, out);
  else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
    status = Sequential(guard).Decode(options, &buffer, out);
  else
    throw Refused{"its method is not known"};
  if (!status.ok()) throw Refused{"it is damaged"};
}

uint8_t *allocate(Guard *guard, size_t count, size_t each) {
  guard->charge(count, each);
  uint8_t *data = (uint8_t *)malloc(count * each + 1);
  if (!data) throw std::bad_alloc();
  return data;
}

template <typename T> void put_indices(Guard *guard, const draco::Mesh &from) {
  uint8_t *to = guard->mesh->indices = allocate(guard, 3 * (size_t)from.num_faces(), sizeof(T));
  for (draco::FaceIndex f(0); f < from.num_faces(); ++f)
    for (int k = 0; k < 3; k++) {
      uint32_t index = from.face(f)[k].value();
      T narrow = (T)index;
      if (index >= from.num_points() || narrow != index)
        throw Refused{"an index does not fit the accessor's type"};
      memcpy(to + (3 * (size_t)f.value() + (size_t)k) * sizeof narrow, &narrow, sizeof narrow);
    }
}

void read_indices(Guard *guard, const draco::Mesh &from) {
  DracoMesh *mesh = guard->mesh;
  mesh->faces = from.num_faces();
  switch (mesh->index_component) {
  case GL_UNSIGNED_BYTE:
    return put_indices<uint8_t>(guard, from);
  case GL_UNSIGNED_SHORT:
    return put_indices<uint16_t>(guard, from);
  default:
    return put_indices<uint32_t>(guard, from);
  }
}

template <typename T>
void put_values(Guard *guard, const draco::Mesh &from, const draco::PointAttribute &attribute,
                uint8_t **out) {
  T values[4];
  uint8_t *to = *out = allocate(guard, from.num_points(), 4 * sizeof(T));
  size_t size = attribute.num_components() * sizeof(T);
  for (draco::PointIndex p(0); p < from.num_points(); ++p) {
    draco::AttributeValueIndex at = attribute.mapped_index(p);
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(at, (int8_t)attribute.num_components(), values))
      throw Refused{"a value does not fit the accessor's type"};
    memcpy(to + p.value() * size, values, size);
  }
}

void read_attribute(Guard *guard, const draco::Mesh &from, DracoAttribute *wanted) {
  const draco::PointAttribute *attribute = from.GetAttributeByUniqueId(wanted->id);
  if (!attribute) throw Refused{"it lacks an attribute that is declared"};
  if (attribute->num_components() != wanted->width || wanted->width > 4)
    throw Refused{"an attribute has not as many components as its accessor"};
  switch (wanted->component) {
  case GL_BYTE:
    return put_values<int8_t>(guard, from, *attribute, &wanted->data);
  case GL_UNSIGNED_BYTE:
    return put_values<uint8_t>(guard, from, *attribute, &wanted->data);
  case GL_SHORT:
    return put_values<int16_t>(guard, from, *attribute, &wanted->data);
  case GL_UNSIGNED_SHORT:
    return put_values<uint16_t>(guard, from, *attribute, &wanted->data);
  case GL_FLOAT:
    return put_values<float>(guard, from, *attribute, &wanted->data);
  default:
    return put_values<uint32_t>(guard, from, *attribute, &wanted->data);
  }
}

void read_mesh(Guard *guard) {
  draco::Mesh mesh;
  decode(guard, &mesh);
  if (mesh.num_points() != guard->mesh->points || mesh.num_faces() > guard->mesh->most_faces)
    throw Refused{"it has not as many vertices or triangles as are declared"};
  read_indices(guard, mesh);
  for (uint32_t i = 0; i < guard->mesh->attribute_count; i++)
    read_attribute(guard, mesh, &guard->mesh->attributes[i]);
}

} // namespace

int draco_decode(DracoMesh *mesh) {
  Guard guard = {mesh, mesh->budget};
  const char *why;
  try {
    read_mesh(&guard);
    mesh->budget -= guard.left;
    return 1;
  } catch (const Refused &refused) {
    why = refused.why;
  } catch (const std::bad_alloc &) {
    why = "there is not enough memory for it";
  } catch (...) {
    why = "it is damaged";
  }
  snprintf(mesh->error, sizeof mesh->error, "%s", why);
  return 0;
}
