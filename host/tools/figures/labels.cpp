#include "tools/figures/labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/figures/text_table.hpp"

namespace luciole {
namespace {

constexpr double kMarker = 7;    ///< half the room of a point, pixels
constexpr double kNearest = 9;   ///< from a point to its text, pixels
constexpr double kLead = 18;     ///< a text that is farther away is led to
constexpr double kLineRoom = 2;  ///< between a text and a line, pixels
constexpr double kTextRoom = 3;  ///< between texts
constexpr double kRingStep = 4;  ///< between distances from a point to its text that are tried
constexpr int kRings = 40;

/// Directions from a point in the order in which they are tried, in sixteenths of a turn from the right:
/// beside the point, above and below it, then between.
constexpr std::array kDirections{0, 8, 12, 4, 14, 2, 10, 6, 15, 1, 9, 7, 13, 11, 3, 5};

Rectangle around(const glm::dvec2& middle, const glm::dvec2& size) {
  return {middle - size / 2.0, middle + size / 2.0};
}

Rectangle grown(const Rectangle& a, double room) { return {a.low - room, a.high + room}; }

bool inside(const Rectangle& a, const Rectangle& area) {
  return a.low.x >= area.low.x && a.low.y >= area.low.y && a.high.x <= area.high.x && a.high.y <= area.high.y;
}

/// The place of a text of this size whose nearest edge or corner is `distance` from the point, in one of
/// kDirections.
LabelPlace beside(const glm::dvec2& point, const glm::dvec2& size, double distance, int direction) {
  const double angle = 2 * std::numbers::pi * direction / double(kDirections.size());
  const glm::dvec2 way(std::cos(angle), std::sin(angle));
  LabelPlace place;
  place.text = around(point + way * distance + glm::clamp(way * 1.5, -1.0, 1.0) * size / 2.0, size);
  place.leader = {point, glm::clamp(point, place.text.low, place.text.high)};
  place.has_leader = glm::distance(place.leader.from, place.leader.to) > kLead;
  return place;
}

Segment withoutStart(const Segment& segment, double length) {
  return {segment.from + glm::normalize(segment.to - segment.from) * length, segment.to};
}

/// The sign says on which side of a line the point is.
double side(const Segment& line, const glm::dvec2& point) {
  const glm::dvec2 way = line.to - line.from, to_point = point - line.from;
  return way.x * to_point.y - way.y * to_point.x;
}

bool cross(const Segment& a, const Segment& b) {
  return side(a, b.from) * side(a, b.to) <= 0 && side(b, a.from) * side(b, a.to) <= 0;
}

/// The place moved into the area, as far as its size allows.
LabelPlace movedInside(LabelPlace place, const Rectangle& area) {
  const glm::dvec2 size = place.text.high - place.text.low;
  place.text.low = glm::clamp(place.text.low, area.low, glm::max(area.low, area.high - size));
  place.text.high = place.text.low + size;
  place.has_leader = false;
  return place;
}

}  // namespace

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

// They overlap if some parameter of the segment lies between both pairs of the rectangle's edges (C. Cyrus
// and J. Beck, "Generalized two- and three-dimensional clipping", 1978).
bool overlap(const Rectangle& rectangle, const Segment& segment) {
  const glm::dvec2 way = segment.to - segment.from;
  double first = 0, last = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double to_low = rectangle.low[axis] - segment.from[axis];
    const double to_high = rectangle.high[axis] - segment.from[axis];
    if (way[axis] == 0) {
      if (to_low >= 0 || to_high <= 0) return false;
      continue;
    }
    const auto [in, out] = std::minmax({to_low / way[axis], to_high / way[axis]});
    first = std::max(first, in);
    last = std::min(last, out);
  }
  return first < last;
}

// In a sans serif font a character is on average less than 0.56 of the font's size wide, and a line 1.2 high.
glm::dvec2 textSize(const std::string& text, double font_size) {
  return glm::dvec2(0.56 * double(shownWidth(text)), 1.2) * font_size;
}

std::vector<LabelPlace> placeLabels(const std::vector<Label>& labels, double font_size,
                                    std::vector<Rectangle> taken, std::vector<Segment> lines,
                                    const Rectangle& area) {
  std::vector<LabelPlace> placed;
  for (const Label& label : labels) taken.push_back(around(label.point, glm::dvec2(2 * kMarker)));
  const auto hasRoom = [&](const LabelPlace& place) {
    const Rectangle text = grown(place.text, kLineRoom);
    return inside(place.text, area) &&
           std::none_of(taken.begin(), taken.end(),
                        [&](const Rectangle& other) { return overlap(place.text, other); }) &&
           std::none_of(lines.begin(), lines.end(),
                        [&](const Segment& line) { return overlap(text, line); }) &&
           (!place.has_leader || std::none_of(placed.begin(), placed.end(), [&](const LabelPlace& other) {
             return overlap(grown(other.text, kLineRoom), place.leader);
           }));
  };
  const auto leadsClearly = [&](const LabelPlace& place) {
    if (!place.has_leader) return true;
    const Segment leader = withoutStart(place.leader, kMarker);
    return std::none_of(labels.begin(), labels.end(),
                        [&](const Label& other) {
                          return other.point != place.leader.from &&
                                 overlap(around(other.point, glm::dvec2(kMarker)), leader);
                        }) &&
           std::none_of(lines.begin(), lines.end(), [&](const Segment& line) { return cross(line, leader); });
  };
  for (const Label& label : labels) {
    const glm::dvec2 size = textSize(label.text, font_size);
    std::optional<LabelPlace> clear, any;
    for (int ring = 0; ring < kRings && !clear; ++ring)
      for (const int direction : kDirections) {
        const LabelPlace place = beside(label.point, size, kNearest + ring * kRingStep, direction);
        if (clear || !hasRoom(place)) continue;
        if (!any) any = place;
        if (leadsClearly(place)) clear = place;
      }
    if (!clear) clear = any;
    placed.push_back(clear.value_or(movedInside(beside(label.point, size, kNearest, 0), area)));
    taken.push_back(grown(placed.back().text, kTextRoom));
    if (placed.back().has_leader) lines.push_back(placed.back().leader);
  }
  return placed;
}

}  // namespace luciole
