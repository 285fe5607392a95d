#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "tools/scale/scale.hpp"

namespace luciole {

/// The method that made a point's picture; null for Luciole itself.
const ScaleMethod* methodOf(const ScaleDescription& description, const ScalePoint& point);

/// How many timed runs a whole point has.
int runsOf(const ScaleDescription& description, const ScalePoint& point);

/// Adds methods to an experiment of Luciole's own points: an axis that says who made a picture, and points
/// for each number of lights. of_lights[i]: of methods[i], for each of the description's numbers of lights,
/// how its picture comes, or nothing where it has none. Throws InputError if the points have more than one
/// truth, of which a method's picture could not be held against each.
void addMethods(ScaleExperiment& experiment, const std::vector<ScaleMethod>& methods,
                const std::vector<std::vector<std::optional<OtherPicture>>>& of_lights);

/// The R, G and B of another method's picture file: linear light before exposure. Throws InputError if it
/// can't be read, has another size, lacks a colour, or has a value that isn't finite; and MachineError.
Image readMethodPicture(const std::string& file, const glm::ivec2& size);

}  // namespace luciole
