#pragma once

#include <array>

namespace luciole {

/// A polygon's corners, one after another around it. A convex one gains one corner by each plane that cuts it.
/// But rounding may dent it, and of n corners in any order a plane makes 3n/2 at most.
/// kRoom must hold so many.
template <class Corner, int kRoom>
struct Polygon {
  std::array<Corner, kRoom> corners;
  int count = 0;

  void add(const Corner& corner) { corners[count++] = corner; }
};

/// The point between corners a and b where a distance that is da at a and db at b is 0. It depends on the
/// order of a and b, by rounding.
template <class Corner>
Corner edgeCrossing(const Corner& a, double da, const Corner& b, double db) {
  return a + (b - a) * (da / (da - db));
}

/// One step of I. E. Sutherland and G. W. Hodgman, "Reentrant polygon clipping", Communications of the ACM 17
/// (1974). `kept` becomes the part of a polygon where distance(corner) ≥ 0, corners in the same order.
/// crossing(a, da, b, db) makes the new corner on the edge from a to b, of which one is inside. Edges are
/// visited from that between the last and the first corner on, so a new corner on that one comes first.
/// `kept` may not be `polygon`.
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
