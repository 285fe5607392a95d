#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "luciole/image.hpp"

// Relights pictures by weighting the layers of their groups of lights, without shading again.
namespace luciole {

/// A factor of a group's light: r g b, linear.
struct GroupFactor {
  std::string group;
  glm::vec3 factor{1.0f};
};

/// The linear r g b of "#rrggbb"; nothing for another text.
std::optional<glm::vec3> linearColor(const std::string& color);

/// The groups that an EXR has layers of (kLightGroups), each with a factor of 1, in the order of its
/// channels. Throws InputError, also where there is none.
std::vector<GroupFactor> lightGroupsOf(const std::string& path);

/// The layers of an EXR's groups of lights alone, with the file's channel names; no channels if it has no
/// such layers. Throws InputError and MachineError.
Image readLightGroups(const std::string& path);

/// The sum of an EXR's groups times their factors, and its A where it has one: summed in double, so within
/// half an ulp. NaN counts as the largest float, as other sums beyond it. `options` gets the file's camera
/// and place in the whole picture. Throws InputError and MachineError.
Image mixLights(const std::string& path, const std::vector<GroupFactor>& groups, WriteOptions& options);

/// The same, without A, of layers that readLightGroups() gave. Throws InputError where it gave none of a
/// group.
Image mixLights(const Image& layers, const std::vector<GroupFactor>& groups);

/// An EXR's groups, reduced to a picture of so many bytes at most.
struct SmallGroups {
  int width = 0, height = 0;
  std::vector<std::uint16_t>
      halves;  ///< group after group: r g b of all pixels, row by row, as 16-bit floats
};
/// Each pixel is the mean of a square of the file's. Throws as mixLights.
SmallGroups smallGroups(const std::string& path, const std::vector<GroupFactor>& groups,
                        std::size_t most_bytes);

}  // namespace luciole
