#include "tools/figures/checked_pixels.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"

namespace luciole {

CheckedPixels chooseCheckedPixels(const glm::ivec2& size, std::size_t count, std::uint64_t seed) {
  CheckedPixels checked;
  checked.side = std::max(1, int(std::sqrt(double(size.x) * size.y / double(count))));
  checked.cells = (size + checked.side - 1) / checked.side;
  for (int y = 0; y < checked.cells.y; ++y) {
    for (int x = 0; x < checked.cells.x; ++x) {
      const glm::ivec2 low = glm::ivec2(x, y) * checked.side;
      const glm::ivec2 extent = glm::min(glm::ivec2(checked.side), size - low);
      const int place = int(nextUniform(seed) * extent.x * extent.y);
      checked.pixels.push_back(low + glm::ivec2(place % extent.x, place / extent.x));
    }
  }
  return checked;
}

}  // namespace luciole
