#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// The values of an accessor whose elements have `components` numbers each: element after element, with
/// sparse parts applied. Normalized integers become [0,1] or [−1,1], others the float of the same value.
/// `place` names, for messages, what refers to the accessor. Throws InputError where there is no such
/// accessor, it has another type, or it reaches past its data.
std::vector<float> readFloats(const GltfModel& model, int accessor, int components, const std::string& place);

/// The values of an accessor as vectors. Throws as readFloats does.
template <typename Vector>
std::vector<Vector> readVectors(const GltfModel& model, int accessor, const std::string& place) {
  const std::vector<float> values = readFloats(model, accessor, Vector::length(), place);
  std::vector<Vector> vectors(values.size() / Vector::length());
  for (std::size_t i = 0; i < values.size(); ++i)
    vectors[i / Vector::length()][i % Vector::length()] = values[i];
  return vectors;
}

/// Throws InputError where a number of the vectors isn't finite.
template <typename Vector>
void checkFinite(const GltfModel& model, const std::vector<Vector>& vectors, const std::string& place) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (int j = 0; j < Vector::length(); ++j) {
      if (!std::isfinite(vectors[i][j]))
        failGltf(model, place, "element " + std::to_string(i) + " is not finite");
    }
  }
}

/// The values of a scalar accessor of unsigned integers. Throws as readFloats does.
std::vector<std::uint32_t> readIndices(const GltfModel& model, int accessor, const std::string& place);

/// The number of components of an accessor's elements: 3 for a VEC3. Throws InputError where there is no such
/// accessor.
int accessorComponents(const GltfModel& model, int accessor, const std::string& place);

}  // namespace luciole
