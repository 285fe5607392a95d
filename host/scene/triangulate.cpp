#include "scene/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace luciole {
namespace {

/// Newell's normal: its length is twice the polygon's area.
glm::dvec3 polygonNormal(const std::vector<glm::dvec3>& polygon) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // Relative to corner 0, so that a small polygon far from the origin loses no digits.
    const glm::dvec3 a = polygon[i] - polygon[0];
    const glm::dvec3 b = polygon[(i + 1) % polygon.size()] - polygon[0];
    normal += glm::cross(a, b);
  }
  return normal;
}

/// The polygon projected to its plane, seen from the side where it is counter-clockwise.
std::vector<glm::dvec2> flatten(const std::vector<glm::dvec3>& polygon, const glm::dvec3& normal) {
  const glm::dvec3 w = normal / glm::length(normal);
  const glm::dvec3 helper = std::abs(w.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(helper, w));
  const glm::dvec3 v = glm::cross(w, u);
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& corner : polygon) {
    flat.emplace_back(glm::dot(corner - polygon[0], u), glm::dot(corner - polygon[0], v));
  }
  return flat;
}

/// Twice the signed area: positive where a, b, c turn left.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Corners that turn right, in the cells of a grid over the polygon: those that may lie in an ear.
class ReflexGrid {
 public:
  ReflexGrid(const std::vector<glm::dvec2>& flat, const std::vector<int>& reflex) : flat_(flat) {
    low_ = high_ = flat[0];
    for (const glm::dvec2& p : flat) {
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
    side_ = std::max(1, static_cast<int>(std::sqrt(double(reflex.size()))));
    cells_.resize(std::size_t(side_) * std::size_t(side_));
    for (const int corner : reflex) cell(column(flat[corner].x), row(flat[corner].y)).push_back(corner);
  }

  void remove(int corner) {
    std::vector<int>& those = cell(column(flat_[corner].x), row(flat_[corner].y));
    const auto found = std::find(those.begin(), those.end(), corner);
    if (found == those.end()) return;
    *found = those.back();
    those.pop_back();
  }

  /// Whether `is` holds for a corner in a cell that the triangle touches.
  template <class Is>
  bool anyNear(const std::array<glm::dvec2, 3>& triangle, const Is& is) const {
    const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    for (int y = row(low); y <= row(high); ++y) {
      const auto [left, right] = extentIn(y, triangle);
      for (int x = column(left); x <= column(right); ++x)
        for (const int corner : cells_[std::size_t(y) * std::size_t(side_) + std::size_t(x)])
          if (is(corner)) return true;
    }
    return false;
  }

 private:
  int place(double at, double low, double high) const {
    const double share = high > low ? (at - low) / (high - low) : 0.0;
    return std::clamp(static_cast<int>(share * side_), 0, side_ - 1);
  }
  int column(double x) const { return place(x, low_.x, high_.x); }
  int row(double y) const { return place(y, low_.y, high_.y); }
  std::vector<int>& cell(int x, int y) {
    return cells_[std::size_t(y) * std::size_t(side_) + std::size_t(x)];
  }

  /// From where to where the triangle reaches in a row of cells, and a little more, for rounding.
  std::pair<double, double> extentIn(int y, const std::array<glm::dvec2, 3>& triangle) const {
    const double height = (high_.y - low_.y) / side_, slack = 1e-9 * (high_.y - low_.y);
    const double bottom = low_.y + y * height - slack, top = low_.y + (y + 1) * height + slack;
    double left = high_.x, right = low_.x;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 a = triangle[i], b = triangle[(i + 1) % 3];
      if (std::max(a.y, b.y) < bottom || std::min(a.y, b.y) > top) continue;
      for (const double edge : {bottom, top}) {
        const double share = b.y == a.y ? 0.0 : std::clamp((edge - a.y) / (b.y - a.y), 0.0, 1.0);
        for (const double x : {a.x + share * (b.x - a.x), b.y == a.y ? b.x : a.x + share * (b.x - a.x)}) {
          left = std::min(left, x);
          right = std::max(right, x);
        }
      }
    }
    const double more = 1e-9 * (high_.x - low_.x);
    return {left - more, right + more};
  }

  const std::vector<glm::dvec2>& flat_;
  glm::dvec2 low_, high_;
  int side_;
  std::vector<std::vector<int>> cells_;
};

/// A polygon that ears are cut off from, and what is left of it: a ring of corners.
class Ring {
 public:
  Ring(const std::vector<glm::dvec2>& flat, const std::vector<int>& reflex)
      : flat_(flat),
        size_(flat.size()),
        grid_(flat, reflex),
        next_(flat.size()),
        previous_(flat.size()),
        is_reflex_(flat.size(), false),
        is_ear_(flat.size(), false) {
    const int n = static_cast<int>(flat.size());
    for (int i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    for (const int corner : reflex) is_reflex_[corner] = true;
    tests_left_ = 64.0 * n * std::sqrt(double(n)) + 0x1p20;
    rechecks_left_ = 16.0 * n + 0x1p16;
    findAllEars();
  }

  /// Cuts off the first ear behind the first corner that is left. Where there is none, for the polygon
  /// crosses itself, the corner after the first.
  std::array<int, 3> cut() {
    int tip = firstEar();
    if (tip < 0 && rechecks_left_ >= double(size_)) {
      rechecks_left_ -= double(size_);
      findAllEars();
      tip = firstEar();
    }
    if (tip < 0) tip = next_[first_];
    const int before = previous_[tip], after = next_[tip];
    next_[before] = after;
    previous_[after] = before;
    if (tip == first_) first_ = after;
    if (is_reflex_[tip]) grid_.remove(tip);
    is_ear_[tip] = false;
    --size_;
    for (const int corner : {before, after}) look(corner);
    return {before, tip, after};
  }

  /// The triangle that is left in the end.
  std::array<int, 3> last() const { return {first_, next_[first_], previous_[first_]}; }
  std::size_t size() const { return size_; }

 private:
  /// Whether the corner turns left, and no corner that turns right lies in its triangle. Those at the same
  /// place as one of the three are ignored, since polygons with a hole repeat corners.
  bool isEar(int tip) {
    const glm::dvec2 a = flat_[previous_[tip]], b = flat_[tip], c = flat_[next_[tip]];
    if (!(turn(a, b, c) > 0)) return false;
    return !grid_.anyNear({a, b, c}, [&](int other) {
      const glm::dvec2 p = flat_[other];
      if (--tests_left_ < 0 || p == a || p == b || p == c) return false;
      return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }

  /// Looks at a corner whose neighbour was cut off.
  void look(int corner) {
    if (is_reflex_[corner] && turn(flat_[previous_[corner]], flat_[corner], flat_[next_[corner]]) > 0) {
      is_reflex_[corner] = false;
      grid_.remove(corner);
    }
    is_ear_[corner] = isEar(corner);
    if (is_ear_[corner]) ears_.push(corner);
  }

  void findAllEars() {
    int corner = first_;
    for (std::size_t i = 0; i < size_; ++i, corner = next_[corner]) look(corner);
  }

  /// -1: none. The first corner of all comes last, so that convex parts become fans around it.
  int firstEar() {
    bool first_is_ear = false;
    int found = -1;
    while (found < 0 && !ears_.empty()) {
      const int corner = ears_.top();
      ears_.pop();
      if (!is_ear_[corner]) continue;
      if (corner == first_)
        first_is_ear = true;
      else
        found = corner;
    }
    if (first_is_ear && found >= 0) ears_.push(first_);
    return found < 0 && first_is_ear ? first_ : found;
  }

  const std::vector<glm::dvec2>& flat_;
  int first_ = 0;
  std::size_t size_;
  ReflexGrid grid_;
  std::vector<int> next_, previous_;
  std::vector<bool> is_reflex_, is_ear_;
  std::priority_queue<int, std::vector<int>, std::greater<>> ears_;  ///< some are no ears any more
  double tests_left_ = 0;     ///< of points in triangles; afterwards all corners that turn left are ears
  double rechecks_left_ = 0;  ///< of corners, where a polygon that crosses itself has no ear
};

/// The corners that don't turn left.
std::vector<int> reflexCorners(const std::vector<glm::dvec2>& flat) {
  const std::size_t n = flat.size();
  std::vector<int> reflex;
  for (std::size_t i = 0; i < n; ++i)
    if (!(turn(flat[(i + n - 1) % n], flat[i], flat[(i + 1) % n]) > 0)) reflex.push_back(static_cast<int>(i));
  return reflex;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<glm::dvec3>& polygon) {
  const int n = static_cast<int>(polygon.size());
  const glm::dvec3 normal = polygonNormal(polygon);
  const bool has_area = glm::length(normal) > 0;
  const std::vector<glm::dvec2> flat = has_area ? flatten(polygon, normal) : std::vector<glm::dvec2>();
  const std::vector<int> reflex = reflexCorners(flat);
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(polygon.size() - 2);
  if (reflex.empty()) {
    for (int i = 2; i < n; ++i) triangles.push_back({0, i - 1, i});
    return triangles;
  }
  Ring ring(flat, reflex);
  while (ring.size() > 3) triangles.push_back(ring.cut());
  triangles.push_back(ring.last());
  return triangles;
}

}  // namespace luciole
