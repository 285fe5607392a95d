#include "scene/gltf/gltf_meshopt.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace luciole {
namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// What the extension says of a buffer view.
struct Compressed {
  std::string place;
  std::span<const std::byte> bytes;
  std::size_t count, stride;
  std::string mode, filter;
};

std::size_t sizeOf(const GltfModel& model, const GltfJson& extension, const char* member,
                   std::size_t otherwise, const std::string& place) {
  const GltfJson& value = memberOf(extension, member);
  if (!value.is_number()) return otherwise;
  const double number = value.get<double>();
  if (!(number >= 0 && number < 2147483648.0))
    failGltf(model, place, fmt::format("{} is {}, expected 0 to 2147483647", member, number));
  return static_cast<std::size_t>(number);
}

Compressed readCompressed(const GltfModel& model, const GltfJson& extension, const std::string& place) {
  Compressed compressed;
  compressed.place = place;
  const std::size_t missing = 0x7fffffff;
  const std::size_t index = sizeOf(model, extension, "buffer", missing, place);
  const GltfBuffer& buffer =
      element(model, model.file.buffers, index < 0x7fffffff ? static_cast<int>(index) : -1, place, "buffer");
  const std::size_t offset = sizeOf(model, extension, "byteOffset", 0, place),
                    length = sizeOf(model, extension, "byteLength", missing, place);
  if (offset > buffer.bytes.size() || length > buffer.bytes.size() - offset)
    failGltf(model, place,
             fmt::format("{} bytes from {} on reach past its buffer of {} bytes", length, offset,
                         buffer.bytes.size()));
  compressed.bytes = buffer.bytes.subspan(offset, length);
  compressed.count = sizeOf(model, extension, "count", 0, place);
  compressed.stride = sizeOf(model, extension, "byteStride", 0, place);
  const auto text = [&](const char* member, const char* otherwise) {
    const GltfJson& value = memberOf(extension, member);
    return value.is_string() ? value.get<std::string>() : std::string(otherwise);
  };
  compressed.mode = text("mode", "");
  compressed.filter = text("filter", "NONE");
  return compressed;
}

/// What the decoder takes for granted, and what keeps it from allocating more than the data can hold.
void check(const GltfModel& model, const Compressed& compressed, std::size_t view_bytes) {
  const auto fail = [&](const std::string& what) { failGltf(model, compressed.place, what); };
  const std::size_t stride = compressed.stride, count = compressed.count;
  const bool is_attributes = compressed.mode == "ATTRIBUTES", is_triangles = compressed.mode == "TRIANGLES";
  if (!is_attributes && !is_triangles && compressed.mode != "INDICES")
    fail("mode is none of ATTRIBUTES, TRIANGLES, INDICES");
  if (is_attributes ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
    fail(fmt::format("byteStride is {}, expected {}", stride,
                     is_attributes ? "a multiple of 4 up to 256" : "2 or 4"));
  if (is_triangles && count % 3 != 0) fail(fmt::format("count is {}, expected a multiple of 3", count));
  if (count == 0 || count * stride != view_bytes)
    fail(fmt::format("{} elements of {} bytes, but the view has {} bytes", count, stride, view_bytes));
  // 256 bytes of a block of vertices take 4 or more, and a triangle or an index 1 or more.
  if (count * stride / 64 > compressed.bytes.size())
    fail(fmt::format("{} bytes can't hold {} elements of {} bytes", compressed.bytes.size(), count, stride));
  const bool fits = compressed.filter == "NONE" ||
                    (is_attributes && ((compressed.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                                       (compressed.filter == "QUATERNION" && stride == 8) ||
                                       compressed.filter == "EXPONENTIAL"));
  if (!fits) fail("its filter is unknown, or not for its mode and byteStride");
}

std::vector<std::byte> decode(const GltfModel& model, const Compressed& compressed) {
  const std::size_t count = compressed.count, stride = compressed.stride;
  std::vector<std::byte> decoded(count * stride);
  const auto* bytes = reinterpret_cast<const unsigned char*>(compressed.bytes.data());
  const std::size_t size = compressed.bytes.size();
  const int fault = compressed.mode == "ATTRIBUTES"
                        ? meshopt_decodeVertexBuffer(decoded.data(), count, stride, bytes, size)
                    : compressed.mode == "TRIANGLES"
                        ? meshopt_decodeIndexBuffer(decoded.data(), count, stride, bytes, size)
                        : meshopt_decodeIndexSequence(decoded.data(), count, stride, bytes, size);
  if (fault != 0) failGltf(model, compressed.place, "its data is cut short or damaged");
  if (compressed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded.data(), count, stride);
  if (compressed.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded.data(), count, stride);
  if (compressed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data(), count, stride);
  return decoded;
}

}  // namespace

void decodeMeshopt(GltfModel& model) {
  for (std::size_t i = 0; i < model.file.views.size(); ++i) {
    const GltfView& view = model.file.views[i];
    const GltfJson& extension = memberOf(view.extensions, kMeshopt);
    if (extension.is_null()) continue;
    const Compressed compressed =
        readCompressed(model, extension, fmt::format("bufferViews[{}].{}", i, kMeshopt));
    check(model, compressed, view.length);
    model.decoded[static_cast<int>(i)] = decode(model, compressed);
  }
}

}  // namespace luciole
