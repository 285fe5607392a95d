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

/// The size of a line of text of this font size, in pixels.
glm::dvec2 textSize(const std::string& text, double font_size);

/// The name of a point.
struct Label {
  glm::dvec2 point{0.0};
  std::string text;
};

/// The position of a label's text. A text far from its point has a leader, a line from the point.
struct LabelPlace {
  Rectangle text;
  bool has_leader = false;
  Segment leader;
};

/// A place for each label, in their order: near its point, inside `area`, over no point, over nothing in
/// `taken` or `lines`, and over no label or leader placed before. So the first labels get the best places. A
/// leader crosses no text, and if possible no point and no line. A label for which no room is left lies
/// beside its point, over others.
std::vector<LabelPlace> placeLabels(const std::vector<Label>& labels, double font_size,
                                    std::vector<Rectangle> taken, std::vector<Segment> lines,
                                    const Rectangle& area);

}  // namespace luciole
