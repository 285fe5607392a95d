#include "scene/gltf/gltf_draco.hpp"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text_file.hpp"

namespace luciole {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// How many numbers (corners of triangles, components of vertices) a byte may stand for. A flat grid takes
/// the fewest bytes: Draco's encoder packs 1,700 numbers of one of 2,000 x 2,000 squares into each. A number
/// takes the decoder some 16 bytes.
constexpr double kMostNumbers = 4096;

/// A decoder of the library that is told how many numbers it may decode: the library itself allocates for
/// whatever the data say.
template <typename Coder>
class BoundedDecoder : public Coder {
 public:
  explicit BoundedDecoder(double most) : most_(most) {}

  double numbers() const { return numbers_; }  ///< that were asked for, as far as it is known
  bool wantsTooMany() const { return numbers_ > most_; }

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    return countConnectivity(ahead) && !wantsTooMany() && Coder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    const draco::PointCloud& points = *this->point_cloud();
    for (int i = 0; i < points.num_attributes(); ++i)
      numbers_ += double(points.num_points()) * std::uint8_t(points.attribute(i)->num_components());
    return !wantsTooMany() && Coder::DecodeAllAttributes();
  }

 private:
  /// Returns false where the data end before the counts do.
  bool countConnectivity(draco::DecoderBuffer& ahead) {
    std::uint32_t first = 0, second = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
    numbers_ = 3.0 * first + second;  // faces, points
    if constexpr (std::is_same_v<Coder, draco::MeshEdgebreakerDecoder>) {
      std::uint8_t seamed_attributes = 0;  // each has a table of corners of its own
      std::uint32_t symbols = 0, splits = 0;
      if (!ahead.Decode(&seamed_attributes) || !draco::DecodeVarint(&symbols, &ahead) ||
          !draco::DecodeVarint(&splits, &ahead))
        return false;
      numbers_ = first + 3.0 * second * (1 + seamed_attributes) + symbols + splits;  // vertices, faces
    }
    return true;
  }

  double most_, numbers_ = 0;
};

/// Decodes, and takes the numbers from those that the whole file may still decode.
template <typename Coder>
std::unique_ptr<draco::Mesh> decodeBy(const GltfModel& model, std::span<const std::byte> bytes, double& left,
                                      const std::string& place) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  BoundedDecoder<Coder> decoder(std::min(left, kMostNumbers * double(bytes.size())));
  auto mesh = std::make_unique<draco::Mesh>();
  const draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, mesh.get());
  if (decoder.wantsTooMany())
    failGltf(model, place,
             fmt::format("{} bytes can't hold {:.0f} numbers", bytes.size(), decoder.numbers()));
  if (!status.ok())
    failGltf(model, place, fmt::format("can't be decoded: {}", forMessage(status.error_msg_string())));
  left -= decoder.numbers();
  return mesh;
}

std::unique_ptr<draco::Mesh> decode(const GltfModel& model, int view, double& left,
                                    const std::string& place) {
  const std::span<const std::byte> bytes = viewBytes(model, view, place);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header{};
  const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&buffer, &header);
  if (!status.ok())
    failGltf(model, place, fmt::format("can't be decoded: {}", forMessage(status.error_msg_string())));
  if (header.encoder_type != draco::TRIANGULAR_MESH) failGltf(model, place, "is no mesh of triangles");
  // Earlier ones have their counts elsewhere.
  if (header.version_major != 2 || header.version_minor != 2)
    failGltf(model, place,
             fmt::format("is of version {}.{} of Draco's format, expected 2.2", header.version_major,
                         header.version_minor));
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    return decodeBy<draco::MeshEdgebreakerDecoder>(model, bytes, left, place);
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
    return decodeBy<draco::MeshSequentialDecoder>(model, bytes, left, place);
  failGltf(model, place, fmt::format("method {} is none of Draco's", header.encoder_method));
}

/// Adds what an accessor is to have in place of its own data. Returns the new accessor.
int addAccessor(GltfModel& model, GltfAccessor accessor, std::vector<std::byte> bytes) {
  accessor.view = static_cast<int>(model.file.views.size());
  accessor.offset = 0;
  accessor.sparse.reset();
  model.file.views.emplace_back();
  model.decoded[accessor.view] = std::move(bytes);
  model.file.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.file.accessors.size()) - 1;
}

template <typename T>
std::vector<std::byte> pointValues(const draco::PointAttribute& attribute, std::uint32_t points,
                                   int components, const GltfModel& model, const std::string& place) {
  std::vector<T> values(std::size_t{points} * std::size_t(components));
  for (std::uint32_t i = 0; i < points; ++i)
    if (!attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)),
                                   static_cast<std::int8_t>(components),
                                   &values[i * std::size_t(components)]))
      failGltf(model, place, fmt::format("element {} can't be what its accessor says", i));
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// An attribute's values as its accessor has them.
std::vector<std::byte> valuesOf(const GltfModel& model, const draco::PointAttribute& attribute,
                                std::uint32_t points, const GltfAccessor& accessor,
                                const std::string& place) {
  const int components = accessor.components;
  if (components != attribute.num_components())
    failGltf(
        model, place,
        fmt::format("has {} components an element, its accessor {}", attribute.num_components(), components));
  switch (accessor.type) {
    case kGltfByte:
      return pointValues<std::int8_t>(attribute, points, components, model, place);
    case kGltfUnsignedByte:
      return pointValues<std::uint8_t>(attribute, points, components, model, place);
    case kGltfShort:
      return pointValues<std::int16_t>(attribute, points, components, model, place);
    case kGltfUnsignedShort:
      return pointValues<std::uint16_t>(attribute, points, components, model, place);
    case kGltfUnsignedInt:
      return pointValues<std::uint32_t>(attribute, points, components, model, place);
    case kGltfFloat:
      return pointValues<float>(attribute, points, components, model, place);
    default:
      failGltf(model, place, fmt::format("componentType {} is not one of glTF's", accessor.type));
  }
}

/// The vertices of triangles as an accessor like `source`.
int addIndices(GltfModel& model, const draco::Mesh& mesh, const GltfAccessor& source,
               const std::string& place) {
  std::vector<std::byte> bytes(std::size_t{mesh.num_faces()} * 12);
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(i));
    const std::uint32_t corners[3] = {face[0].value(), face[1].value(), face[2].value()};
    for (const std::uint32_t corner : corners)
      if (corner >= mesh.num_points())
        failGltf(model, place,
                 fmt::format("index {}, but it has only {} vertices", corner, mesh.num_points()));
    std::memcpy(&bytes[std::size_t{i} * 12], corners, sizeof corners);
  }
  GltfAccessor accessor = source;
  accessor.components = 1;
  accessor.type = kGltfUnsignedInt;
  accessor.count = std::size_t{mesh.num_faces()} * 3;
  return addAccessor(model, std::move(accessor), std::move(bytes));
}

void decodePrimitive(GltfModel& model, GltfPrimitive& primitive, double& left, const std::string& place) {
  const GltfJson& extension = memberOf(primitive.extensions, kDraco);
  const bool is_strip = primitive.mode == kGltfStrip;
  if (primitive.mode != kGltfTriangles && !is_strip)
    failGltf(model, place, fmt::format("mode {} is none of triangles", primitive.mode));
  const int view = indexOf(memberOf(extension, "bufferView"));
  const std::unique_ptr<draco::Mesh> mesh = decode(model, view, left, place);
  if (mesh->num_faces() == 0 || mesh->num_points() == 0) failGltf(model, place, "has no triangles");

  GltfAccessor indices;
  if (primitive.indices >= 0)
    indices = element(model, model.file.accessors, primitive.indices, place + ".indices", "accessor");
  // Of a strip it says how long that was.
  if (primitive.indices >= 0 && !is_strip && indices.count != std::size_t{mesh->num_faces()} * 3)
    failGltf(model, place,
             fmt::format("has {} triangles, its accessor {} indices", mesh->num_faces(), indices.count));
  primitive.indices = addIndices(model, *mesh, indices, place);
  primitive.mode = kGltfTriangles;

  const GltfJson& attributes = memberOf(extension, "attributes");
  if (memberOf(attributes, "POSITION").is_null()) failGltf(model, place, "has no POSITION");
  for (const auto& [name, number] : attributes.items()) {
    const std::string here = fmt::format("{}.{}", place, forMessage(name));
    const auto known = primitive.attributes.find(name);
    if (known == primitive.attributes.end()) failGltf(model, here, "is no attribute of its primitive");
    const GltfAccessor accessor = element(model, model.file.accessors, known->second, here, "accessor");
    const double id = number.is_number() ? number.get<double>() : -1;
    const draco::PointAttribute* const attribute =
        id >= 0 && id < 4294967296.0 ? mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id)) : nullptr;
    if (!attribute) failGltf(model, here, "is not in the data");
    if (accessor.count != mesh->num_points())
      failGltf(model, here,
               fmt::format("has {} elements, its accessor {}", mesh->num_points(), accessor.count));
    known->second =
        addAccessor(model, accessor, valuesOf(model, *attribute, mesh->num_points(), accessor, here));
  }
}

/// Whether two primitives say the same of the same data. Their materials may differ.
bool haveSameData(const GltfPrimitive& a, const GltfPrimitive& b) {
  return a.mode == b.mode && a.indices == b.indices && a.attributes == b.attributes &&
         a.extensions.at(kDraco) == b.extensions.at(kDraco);
}

}  // namespace

void decodeDraco(GltfModel& model) {
  double left = 0;  // buffer views may overlap, and so stand for more bytes than the file has
  for (const GltfBuffer& buffer : model.file.buffers) left += kMostNumbers * double(buffer.bytes.size());
  struct Known {
    GltfPrimitive written, decoded;
  };
  std::multimap<int, Known> all_known;  // by buffer view
  for (std::size_t m = 0; m < model.file.meshes.size(); ++m)
    for (std::size_t p = 0; p < model.file.meshes[m].primitives.size(); ++p) {
      GltfPrimitive& primitive = model.file.meshes[m].primitives[p];
      const GltfJson& extension = memberOf(primitive.extensions, kDraco);
      if (extension.is_null()) continue;
      const int view = indexOf(memberOf(extension, "bufferView"));
      const auto [begin, end] = all_known.equal_range(view);
      const auto known = std::find_if(
          begin, end, [&](const auto& entry) { return haveSameData(entry.second.written, primitive); });
      if (known != end) {
        primitive.mode = known->second.decoded.mode;
        primitive.indices = known->second.decoded.indices;
        primitive.attributes = known->second.decoded.attributes;
        continue;
      }
      const GltfPrimitive written = primitive;
      decodePrimitive(model, primitive, left, fmt::format("meshes[{}].primitives[{}].{}", m, p, kDraco));
      all_known.insert({view, {written, primitive}});
    }
}

}  // namespace luciole
