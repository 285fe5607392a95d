#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// The values of an accessor whose elements have `components` numbers each, in one row; sparse parts are
/// applied. Normalized integers become [0,1] or [−1,1], others the float of the same value. `place` is what
/// refers to it, for messages. Throws InputError where the accessor has another type or reaches past its
/// data.
std::vector<float> readFloats(const GltfModel& model, int accessor, int components, const std::string& place);

/// The values of a scalar accessor of unsigned integers.
std::vector<std::uint32_t> readIndices(const GltfModel& model, int accessor, const std::string& place);

/// The number of components of an accessor's elements: 3 for a VEC3.
int accessorComponents(const GltfModel& model, int accessor, const std::string& place);

}  // namespace luciole
