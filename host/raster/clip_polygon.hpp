#pragma once

#include <array>

namespace luciole {

/// A polygon's corners, in order. kRoom must hold the corners after clipping: a plane adds at most one corner
/// to a convex polygon, but rounding may make it concave, and then n corners become at most 3n/2.
template <class Corner, int kRoom>
struct Polygon {
  std::array<Corner, kRoom> corners;
  int count = 0;

  void add(const Corner& corner) { corners[count++] = corner; }
};

/// The point between corners a and b where a distance that is da at a and db at b is 0. Swapping a and b may
/// change its rounding.
template <class Corner>
Corner edgeCrossing(const Corner& a, double da, const Corner& b, double db) {
  return a + (b - a) * (da / (da - db));
}

/// One step of I. E. Sutherland and G. W. Hodgman, "Reentrant polygon clipping", Communications of the ACM 17
/// (1974). `kept` becomes the part of a polygon where distance(corner) ≥ 0, corners in the same order.
/// crossing(a, da, b, db) makes the new corner on the edge from a to b, one of which is inside. The edge from
/// the last corner to the first is visited first, so a new corner on it comes first. `kept` must not be
/// `polygon`. O(corners).
template <class Corner, int kRoom, class Distance, class Crossing>
void clipPolygon(const Polygon<Corner, kRoom>& polygon, Distance distance, Crossing crossing,
                 Polygon<Corner, kRoom>& kept) {
  kept.count = 0;
  if (polygon.count == 0) return;
  const Corner* a = &polygon.corners[polygon.count - 1];
  double da = distance(*a);
  for (int i = 0; i < polygon.count; ++i) {
    const Corner* b = &polygon.corners[i];
    const double db = distance(*b);
    if ((da >= 0.0) != (db >= 0.0)) kept.add(crossing(*a, da, *b, db));
    if (db >= 0.0) kept.add(*b);
    a = b;
    da = db;
  }
}

}  // namespace luciole
