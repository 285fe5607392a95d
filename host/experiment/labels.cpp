#include "experiment/labels.hpp"

#include <algorithm>
#include <cmath>

namespace luciole {
namespace {

constexpr double kMarker = 7;            ///< half the room of a point, pixels
constexpr double kNearest = 9;           ///< from a point to its text, pixels
constexpr double kCharacterWidth = 6.7;  ///< of a sans serif of 12 pixels, on average and rounded up
constexpr double kLineHeight = 14;
constexpr int kRings = 22;  ///< distances from a point to its text, half a line apart
constexpr int kDirections = 16;

Rectangle around(const glm::dvec2& middle, const glm::dvec2& size) {
  return {middle - size / 2.0, middle + size / 2.0};
}

bool inside(const Rectangle& a, const Rectangle& area) {
  return a.low.x >= area.low.x && a.low.y >= area.low.y && a.high.x <= area.high.x && a.high.y <= area.high.y;
}

/// Where a text of this size lies whose nearest edge or corner is `distance` from the point in a direction.
Rectangle beside(const glm::dvec2& point, const glm::dvec2& size, double distance, int direction) {
  const double angle = 2 * 3.14159265358979 * direction / kDirections;
  const glm::dvec2 way(std::cos(angle), std::sin(angle));
  return around(point + way * distance + glm::clamp(way * 1.5, -1.0, 1.0) * size / 2.0, size);
}

}  // namespace

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

glm::dvec2 textSize(const std::string& text) { return {kCharacterWidth * double(text.size()), kLineHeight}; }

std::vector<Rectangle> placeLabels(const std::vector<glm::dvec2>& points,
                                   const std::vector<std::string>& texts, std::vector<Rectangle> taken,
                                   const Rectangle& area) {
  std::vector<Rectangle> placed;
  for (const glm::dvec2& point : points) taken.push_back(around(point, glm::dvec2(2 * kMarker)));
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const glm::dvec2 size = textSize(texts[i]);
    const auto find = [&] {
      for (int ring = 0; ring < kRings; ++ring)
        for (int direction = 0; direction < kDirections; ++direction) {
          const Rectangle place = beside(points[i], size, kNearest + ring * kLineHeight / 2, direction);
          const bool is_free = std::none_of(taken.begin(), taken.end(),
                                            [&](const Rectangle& other) { return overlap(place, other); });
          if (is_free && inside(place, area)) return place;
        }
      return beside(points[i], size, kNearest, 0);
    };
    placed.push_back(find());
    taken.push_back(placed.back());
  }
  return placed;
}

}  // namespace luciole
