#include "scene/gltf/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

namespace luciole {
namespace {

/// Elements that lie in memory `stride` bytes apart. Empty bytes: all zero.
struct Elements {
  std::span<const std::byte> bytes;
  std::size_t count;
  std::size_t stride;
  int component_type;
  int components;
};

template <typename T>
T load(const std::byte* place) {  // a file's data need not be aligned
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

/// Normalized integers by the glTF 2.0 specification, 3.11 (equations of KHR_mesh_quantization).
template <typename T>
float toFloat(T value, bool normalized) {
  if (!normalized) return static_cast<float>(value);
  return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float loadFloat(const std::byte* place, int type, bool normalized) {
  switch (type) {
    case kGltfByte:
      return toFloat(load<std::int8_t>(place), normalized);
    case kGltfUnsignedByte:
      return toFloat(load<std::uint8_t>(place), normalized);
    case kGltfShort:
      return toFloat(load<std::int16_t>(place), normalized);
    case kGltfUnsignedShort:
      return toFloat(load<std::uint16_t>(place), normalized);
    case kGltfUnsignedInt:
      return toFloat(load<std::uint32_t>(place), normalized);
    default:
      return load<float>(place);
  }
}

std::uint32_t loadIndex(const std::byte* place, int type) {
  switch (type) {
    case kGltfUnsignedByte:
      return load<std::uint8_t>(place);
    case kGltfUnsignedShort:
      return load<std::uint16_t>(place);
    default:
      return load<std::uint32_t>(place);
  }
}

bool isIndexType(int type) {
  return type == kGltfUnsignedByte || type == kGltfUnsignedShort || type == kGltfUnsignedInt;
}

/// Finds `count` ≥ 1 elements from `offset` of a buffer view on. Throws InputError where they don't lie
/// inside it.
Elements findElements(const GltfModel& model, int buffer_view, std::size_t offset, std::size_t count,
                      int type, int components, const std::string& place) {
  const std::span<const std::byte> bytes = viewBytes(model, buffer_view, place);
  const std::size_t size = gltfComponentSize(type) * static_cast<std::size_t>(components);
  const std::size_t given = model.file.views[static_cast<std::size_t>(buffer_view)].stride;
  const std::size_t stride = given == 0 ? size : given;
  if (stride < size)
    failGltf(model, place, fmt::format("elements of {} bytes lie {} bytes apart", size, stride));
  const bool fits = offset <= bytes.size() && size <= bytes.size() - offset &&
                    count - 1 <= (bytes.size() - offset - size) / stride;
  if (!fits) {
    failGltf(model, place,
             fmt::format("{} elements of {} bytes from byte {} on reach past bufferViews[{}] of {} bytes",
                         count, size, offset, buffer_view, bytes.size()));
  }
  return {bytes.subspan(offset), count, stride, type, components};
}

std::string accessorPlace(int accessor) { return fmt::format("accessors[{}]", accessor); }

/// An accessor's elements without their sparse part. None where its count is 0.
Elements baseElements(const GltfModel& model, int index, int components, const std::string& place) {
  const GltfAccessor& accessor = element(model, model.file.accessors, index, place, "accessor");
  const std::string here = accessorPlace(index);
  if (accessor.components == 0) failGltf(model, here, "its type is none of glTF's");
  if (accessor.components != components) {
    failGltf(
        model, here,
        fmt::format("has {} components an element, but {} needs {}", accessor.components, place, components));
  }
  if (gltfComponentSize(accessor.type) == 0)
    failGltf(model, here, fmt::format("componentType {} is not one of glTF's", accessor.type));
  if (accessor.count == 0) {
    warnRepaired(model, here, "count is 0, expected at least 1", "count 0");
    return {{}, 0, 0, accessor.type, components};
  }
  if (accessor.view >= 0)
    return findElements(model, accessor.view, accessor.offset, accessor.count, accessor.type, components,
                        here);
  constexpr std::size_t kMostZeros =
      1 << 24;  // without data, only this bounds what a file can make us allocate
  if (accessor.count > kMostZeros) {
    failGltf(model, here, fmt::format("has no bufferView, so count may be {} at most", kMostZeros));
  }
  return {{}, accessor.count, 0, accessor.type, components};
}

/// Calls set(which element, its bytes) for each element that the sparse part replaces.
template <typename Set>
void forEachSparse(const GltfModel& model, int index, const Elements& base, const Set& set) {
  const std::optional<GltfSparse>& sparse = model.file.accessors[static_cast<std::size_t>(index)].sparse;
  if (!sparse || base.count == 0) return;
  const std::string here = accessorPlace(index) + ".sparse";
  if (sparse->count == 0) return;
  if (sparse->count > base.count || !isIndexType(sparse->index_type))
    failGltf(model, here, "count or componentType is out of range");
  const Elements indices = findElements(model, sparse->index_view, sparse->index_offset, sparse->count,
                                        sparse->index_type, 1, here + ".indices");
  const Elements values = findElements(model, sparse->value_view, sparse->value_offset, sparse->count,
                                       base.component_type, base.components, here + ".values");
  for (std::size_t i = 0; i < indices.count; ++i) {
    const std::uint32_t target = loadIndex(&indices.bytes[i * indices.stride], indices.component_type);
    if (target >= base.count) {
      failGltf(model, here, fmt::format("replaces element {} of {}", target, base.count));
    }
    set(target, &values.bytes[i * values.stride]);
  }
}

}  // namespace

int accessorComponents(const GltfModel& model, int accessor, const std::string& place) {
  return element(model, model.file.accessors, accessor, place, "accessor").components;
}

std::vector<float> readFloats(const GltfModel& model, int accessor, int components,
                              const std::string& place) {
  const Elements base = baseElements(model, accessor, components, place);
  const bool normalized = model.file.accessors[static_cast<std::size_t>(accessor)].normalized;
  const std::size_t size = gltfComponentSize(base.component_type);
  std::vector<float> values(base.count * components, 0.0f);
  const auto set = [&](std::size_t which, const std::byte* bytes) {
    for (int j = 0; j < components; ++j) {
      values[which * components + j] = loadFloat(bytes + j * size, base.component_type, normalized);
    }
  };
  if (!base.bytes.empty()) {
    for (std::size_t i = 0; i < base.count; ++i) set(i, &base.bytes[i * base.stride]);
  }
  forEachSparse(model, accessor, base, set);
  return values;
}

std::vector<std::uint32_t> readIndices(const GltfModel& model, int accessor, const std::string& place) {
  const Elements base = baseElements(model, accessor, 1, place);
  if (!isIndexType(base.component_type)) {
    failGltf(model, accessorPlace(accessor), "indices must be unsigned integers");
  }
  std::vector<std::uint32_t> values(base.count, 0);
  const auto set = [&](std::size_t which, const std::byte* bytes) {
    values[which] = loadIndex(bytes, base.component_type);
  };
  if (!base.bytes.empty()) {
    for (std::size_t i = 0; i < base.count; ++i) set(i, &base.bytes[i * base.stride]);
  }
  forEachSparse(model, accessor, base, set);
  return values;
}

}  // namespace luciole
