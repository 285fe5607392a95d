#include "scene/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
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
  flat.reserve(polygon.size());
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
  ReflexGrid(const std::vector<glm::dvec2>& flat, const std::vector<int>& reflex, double margin)
      : flat_(flat),
        margin_(margin),
        side_(std::max(1, static_cast<int>(std::sqrt(double(reflex.size()) / kInCell)))) {
    low_ = high_ = flat[0];
    for (const glm::dvec2& p : flat) {
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
    first_.assign(std::size_t(side_) * std::size_t(side_), -1);
    next_.resize(flat.size());
    for (const int corner : reflex) next_[corner] = std::exchange(first_[cellOf(corner)], corner);
  }

  void remove(int corner) {
    int* link = &first_[cellOf(corner)];
    while (*link >= 0 && *link != corner) link = &next_[*link];
    if (*link == corner) *link = next_[corner];
  }

  /// Whether test(corner) is true for any corner in the cells that the triangle and the margin around it
  /// touch.
  template <class Test>
  bool anyNear(const std::array<glm::dvec2, 3>& triangle, const Test& test) const {
    if (side_ == 1) return anyIn(0, test);
    const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    for (int y = row(low - margin_); y <= row(high + margin_); ++y) {
      const auto [left, right] = extentIn(y, triangle);
      for (int x = column(left); x <= column(right); ++x)
        if (anyIn(cell(x, y), test)) return true;
    }
    return false;
  }

 private:
  static constexpr double kInCell = 4;  ///< corners, on average

  template <class Test>
  bool anyIn(std::size_t cell, const Test& test) const {
    for (int corner = first_[cell]; corner >= 0; corner = next_[corner])
      if (test(corner)) return true;
    return false;
  }
  int place(double at, double low, double high) const {
    const double share = high > low ? (at - low) / (high - low) : 0.0;
    return std::clamp(static_cast<int>(share * side_), 0, side_ - 1);
  }
  int column(double x) const { return place(x, low_.x, high_.x); }
  int row(double y) const { return place(y, low_.y, high_.y); }
  std::size_t cell(int x, int y) const { return std::size_t(y) * std::size_t(side_) + std::size_t(x); }
  std::size_t cellOf(int corner) const {
    return side_ == 1 ? 0 : cell(column(flat_[corner].x), row(flat_[corner].y));
  }

  /// The interval of x that the triangle covers in a row of cells, enlarged for rounding.
  std::pair<double, double> extentIn(int y, const std::array<glm::dvec2, 3>& triangle) const {
    const double height = (high_.y - low_.y) / side_, slack = margin_ + 1e-9 * (high_.y - low_.y);
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
    const double more = margin_ + 1e-9 * (high_.x - low_.x);
    return {left - more, right + more};
  }

  const std::vector<glm::dvec2>& flat_;
  double margin_;
  glm::dvec2 low_, high_;
  int side_;
  std::vector<int> first_;  ///< of each cell its first corner, or -1
  std::vector<int> next_;   ///< of each corner the next in its cell, or -1
};

/// The ring of corners of a polygon from which ears are cut off.
class Ring {
 public:
  /// `rounding`: the largest error of a corner's position.
  Ring(const std::vector<glm::dvec2>& flat, const std::vector<int>& reflex, double rounding)
      : flat_(flat),
        rounding_(rounding),
        margin_(rounding),
        size_(flat.size()),
        grid_(flat, reflex, rounding),
        corners_(flat.size()),
        tests_left_(64.0 * double(size_) * std::sqrt(double(size_)) + 0x1p20),
        rechecks_left_(16.0 * double(size_)) {
    const int n = static_cast<int>(flat.size());
    for (int i = 0; i < n; ++i) corners_[i] = {i + 1 < n ? i + 1 : 0, i > 0 ? i - 1 : n - 1};
    for (const int corner : reflex) corners_[corner].is_reflex = true;
    lookAtAll();
  }

  /// Cuts off the first ear behind the first corner that is left. Where there is none, a corner that is in
  /// line with its neighbours, as those that stand twice are. Where there is none either, for the polygon
  /// crosses itself, the corner after the first.
  std::array<int, 3> cut() {
    int tip = firstEar();
    if (tip < 0 && updateAllEars(early_rechecks_left_)) tip = firstEar();
    if (tip < 0) tip = takeInLine();
    if (tip < 0) {
      margin_ = 0;
      if (updateAllEars(rechecks_left_)) tip = firstEar();
    }
    if (tip < 0) tip = corners_[first_].next;
    const int before = corners_[tip].previous, after = corners_[tip].next;
    corners_[before].next = after;
    corners_[after].previous = before;
    if (tip == first_) first_ = after;
    if (corners_[tip].is_reflex) grid_.remove(tip);
    corners_[tip] = {-1, -1};
    --size_;
    for (const int corner : {before, after}) updateEar(corner);
    return {before, tip, after};
  }

  /// The remaining triangle.
  std::array<int, 3> last() const { return {first_, corners_[first_].next, corners_[first_].previous}; }
  std::size_t size() const { return size_; }

 private:
  struct Corner {
    int next, previous;  ///< -1: it was cut off
    bool is_reflex = false, is_ear = false;
  };

  std::array<glm::dvec2, 3> triangleOf(int tip) const {
    return {flat_[corners_[tip].previous], flat_[tip], flat_[corners_[tip].next]};
  }

  /// Whether no corner that turns right lies in the triangle, or within the margin around it. Those at the
  /// same place as one of the three are ignored, since polygons with a hole repeat corners.
  bool isEmpty(const std::array<glm::dvec2, 3>& triangle) {
    // Not bindings, which lambdas of clang 14 don't capture.
    const glm::dvec2 &a = triangle[0], &b = triangle[1], &c = triangle[2];
    const double ab = -margin_ * glm::distance(a, b), bc = -margin_ * glm::distance(b, c),
                 ca = -margin_ * glm::distance(c, a);
    return !grid_.anyNear(triangle, [&](int other) {
      const glm::dvec2 p = flat_[other];
      if (--tests_left_ < 0 || p == a || p == b || p == c) return false;
      return turn(a, b, p) >= ab && turn(b, c, p) >= bc && turn(c, a, p) >= ca;
    });
  }

  /// Whether the corners are in line, but for rounding.
  bool isInLine(const std::array<glm::dvec2, 3>& triangle) const {
    const auto& [a, b, c] = triangle;
    return std::abs(turn(a, b, c)) <= rounding_ * (glm::distance(a, b) + glm::distance(b, c));
  }

  /// Updates the state of a corner whose neighbour was cut off.
  void updateEar(int number) {
    Corner& corner = corners_[number];
    const std::array<glm::dvec2, 3> triangle = triangleOf(number);
    const bool turns_left = turn(triangle[0], triangle[1], triangle[2]) > 0;
    if (corner.is_reflex && turns_left) {
      corner.is_reflex = false;
      grid_.remove(number);
    }
    corner.is_ear = turns_left && isEmpty(triangle);
    if (corner.is_ear)
      ears_.push(number);
    else if (knows_in_line_ && isInLine(triangle))
      in_line_.push_back(number);
  }

  void lookAtAll() {
    int corner = first_;
    for (std::size_t i = 0; i < size_; ++i, corner = corners_[corner].next) updateEar(corner);
  }

  /// Updates all corners, unless the budget `left` is exhausted: some become ears without a neighbour being
  /// cut off.
  bool updateAllEars(double& left) {
    if (left < double(size_)) return false;
    left -= double(size_);
    lookAtAll();
    return true;
  }

  /// -1: none. The first corner of all comes last, so that convex parts become fans around it.
  int firstEar() {
    bool first_is_ear = false;
    int found = -1;
    while (found < 0 && !ears_.empty()) {
      const int corner = ears_.top();
      ears_.pop();
      if (!corners_[corner].is_ear) continue;
      if (corner == first_)
        first_is_ear = true;
      else
        found = corner;
    }
    if (first_is_ear && found >= 0) ears_.push(first_);
    return found < 0 && first_is_ear ? first_ : found;
  }

  /// -1: none.
  int takeInLine() {
    if (!std::exchange(knows_in_line_, true)) lookAtAll();
    while (!in_line_.empty()) {
      const int corner = in_line_.back();
      in_line_.pop_back();
      if (corners_[corner].next >= 0 && isInLine(triangleOf(corner))) return corner;
    }
    return -1;
  }

  const std::vector<glm::dvec2>& flat_;
  double rounding_;
  double margin_;  ///< 0 where there was no ear with it
  int first_ = 0;
  std::size_t size_;
  ReflexGrid grid_;
  std::vector<Corner> corners_;
  std::priority_queue<int, std::vector<int>, std::greater<>> ears_;  ///< some are no ears any more
  bool knows_in_line_ = false;                                       ///< few polygons need to
  std::vector<int> in_line_;  ///< those that were no ears; some are in line no more, or cut off
  double tests_left_;         ///< of points in triangles; afterwards all corners that turn left are ears
  /// Of corners where none is known to be an ear: before those in line are cut off, and afterwards.
  double early_rechecks_left_ = 0x1p16, rechecks_left_;
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
  double furthest = 0;
  for (const glm::dvec3& corner : polygon)
    furthest = std::max({furthest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
  Ring ring(flat, reflex, std::numeric_limits<float>::epsilon() * furthest);
  while (ring.size() > 3) triangles.push_back(ring.cut());
  triangles.push_back(ring.last());
  return triangles;
}

}  // namespace luciole
