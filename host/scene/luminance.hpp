#pragma once

#include <glm/glm.hpp>

namespace luciole {

/// The luminance of a linear Rec.709 colour is its dot product with this.
inline constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

}  // namespace luciole
