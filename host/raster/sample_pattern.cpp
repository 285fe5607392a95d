#include "raster/sample_pattern.hpp"

#include <algorithm>
#include <cmath>

#include "raster/setup.hpp"

namespace luciole {

SamplePattern samplePattern(int count) {
  SamplePattern pattern;
  pattern.count = count;
  while (pattern.stride < std::min(count, 16)) pattern.stride *= 2;
  if (count > 16) pattern.stride = (count + 15) / 16 * 16;
  for (int entry = 0; entry < pattern.stride; ++entry) {
    const glm::dvec2 place = samplePoint(std::min(entry, count - 1), count);
    pattern.x.push_back(std::min(int(std::lround(place.x * kSubpixels)), kSubpixels - 1));
    pattern.y.push_back(std::min(int(std::lround(place.y * kSubpixels)), kSubpixels - 1));
  }
  const auto [left, right] = std::minmax_element(pattern.x.begin(), pattern.x.end());
  const auto [top, bottom] = std::minmax_element(pattern.y.begin(), pattern.y.end());
  const glm::ivec2 least(*left, *top);
  pattern.origin = glm::dvec2(least) / double(kSubpixels);
  pattern.reach = glm::ivec2(*right, *bottom) - least;
  for (std::int32_t& x : pattern.x) x -= least.x;
  for (std::int32_t& y : pattern.y) y -= least.y;
  return pattern;
}

}  // namespace luciole
