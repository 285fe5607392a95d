#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace luciole {

/// A rectangle of a drawing, in pixels, y down.
struct Rectangle {
  glm::dvec2 low{0.0}, high{0.0};
};
bool overlap(const Rectangle& a, const Rectangle& b);

/// A straight line from one point to another.
struct Segment {
  glm::dvec2 from{0.0}, to{0.0};
};
bool overlap(const Rectangle& rectangle, const Segment& segment);

/// The room that a line of text of this size takes, in pixels.
glm::dvec2 textSize(const std::string& text, double font_size);

/// A name of a point.
struct Label {
  glm::dvec2 point{0.0};
  std::string text;
};

/// Where the text is, and where it had to go far from its point: the line that leads there.
struct LabelPlace {
  Rectangle text;
  bool is_led_to = false;
  Segment leader;
};

/// Finds each label a place near its point, inside `area`, off all points, off what is `taken`, off the
/// lines, and off the labels and leaders before it; the first labels get the best places. A leader crosses no
/// text, and no point and no line where that can be had. Where there is no room left, a label lies beside its
/// point, over others.
std::vector<LabelPlace> placeLabels(const std::vector<Label>& labels, double font_size,
                                    std::vector<Rectangle> taken, std::vector<Segment> lines,
                                    const Rectangle& area);

}  // namespace luciole
