#pragma once

#include <nlohmann/json.hpp>

#include "luciole/compare.hpp"

namespace luciole {

/// The figures of a difference. JSON has no infinity: an infinite figure becomes null, with a reason beside
/// it.
nlohmann::ordered_json differenceJson(const ImageDifference& difference);

}  // namespace luciole
