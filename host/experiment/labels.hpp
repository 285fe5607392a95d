#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace luciole {

/// A rectangle of a drawing, in pixels, y up.
struct Rectangle {
  glm::dvec2 low{0.0}, high{0.0};
};
bool overlap(const Rectangle& a, const Rectangle& b);

/// The room that a line of text takes, in pixels.
glm::dvec2 textSize(const std::string& text);

/// Finds each text a place near its point, inside `area`, off all points, off what is `taken` and off the
/// texts placed before it; the first texts get the best places. Where there is no room left, a text may lie
/// over others.
std::vector<Rectangle> placeLabels(const std::vector<glm::dvec2>& points,
                                   const std::vector<std::string>& texts, std::vector<Rectangle> taken,
                                   const Rectangle& area);

}  // namespace luciole
