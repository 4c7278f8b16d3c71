#include "draco_encode.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <cstring>

static draco::DataType data_type(uint32_t component) {
  switch (component) {
  case 5120:
    return draco::DT_INT8;
  case 5121:
    return draco::DT_UINT8;
  case 5122:
    return draco::DT_INT16;
  case 5123:
    return draco::DT_UINT16;
  default:
    return draco::DT_FLOAT32;
  }
}

static void add_source(draco::Mesh *mesh, DracoSource *source, uint32_t points) {
  draco::GeometryAttribute attribute;
  draco::DataType type = data_type(source->component);
  size_t size = source->width * draco::DataTypeLength(type);
  attribute.Init((draco::GeometryAttribute::Type)source->type, nullptr, (uint8_t)source->width,
                 type, source->normalized != 0, (int64_t)size, 0);
  int id = mesh->AddAttribute(attribute, true, points);
  for (uint32_t i = 0; i < points; i++)
    mesh->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                           (const uint8_t *)source->data + i * size);
  source->id = mesh->attribute(id)->unique_id();
}

size_t draco_encode(const uint32_t (*faces)[3], uint32_t face_count, uint32_t points,
                    DracoSource *sources, int source_count, int edgebreaker, int with_metadata,
                    uint8_t *out, size_t room) {
  draco::Mesh mesh;
  mesh.SetNumFaces(face_count);
  mesh.set_num_points(points);
  for (uint32_t f = 0; f < face_count; f++)
    mesh.SetFace(draco::FaceIndex(f),
                 {{draco::PointIndex(faces[f][0]), draco::PointIndex(faces[f][1]),
                   draco::PointIndex(faces[f][2])}});
  for (int i = 0; i < source_count; i++) add_source(&mesh, &sources[i], points);
  if (with_metadata) {
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    auto inner = std::make_unique<draco::Metadata>();
    inner->AddEntryString("made", "by hand");
    metadata->AddSubMetadata("inner", std::move(inner));
    metadata->AddEntryInt("answer", 42);
    mesh.AddMetadata(std::move(metadata));
    auto of_attribute = std::make_unique<draco::AttributeMetadata>();
    of_attribute->AddEntryString("name", "position");
    mesh.AddAttributeMetadata(0, std::move(of_attribute));
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                        : draco::MESH_SEQUENTIAL_ENCODING);
  for (int i = 0; i < source_count; i++)
    if (sources[i].bits) encoder.SetAttributeQuantization(i, sources[i].bits);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok() || buffer.size() > room) return 0;
  memcpy(out, buffer.data(), buffer.size());
  return buffer.size();
}
