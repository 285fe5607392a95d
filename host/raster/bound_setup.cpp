#include "raster/bound_setup.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "raster/clip.hpp"
#include "raster/concatenate.hpp"

namespace luciole {
namespace {

/// Texels outside the picture where triangles are cut that reach behind the light or far beyond the picture.
constexpr double kBeyond = 2.0;

/// Bound for a corner's rounding error, relative to the sum of the magnitudes it was added up from: 2⁻⁵¹ for
/// the product of matrix and point, less than 2⁻⁵¹ for each of four cuts, and 2⁻⁵¹ for division and viewport.
constexpr double kCornerError = 0x1p-48;

/// Largest error of a corner's place, in texels. A triangle with a larger one counts as unknown: it may be
/// anywhere. It is less than kBoundGrowth.
constexpr double kWorstPlace = 0x1p-10;
/// Largest error of the corners' places, in texels, with which a triangle counts as covering. A plane's error
/// inside a polygon is at most three times that of its corners (see setPlane), so less than 2⁻²⁴ steps.
constexpr double kWorstCoveringPlace = 0x1p-26;

/// a·b − c·d within 1.5 units in its last place (Kahan; Jeannerod, Louvet & Muller 2013).
double differenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

double twiceArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return differenceOfProducts(b.x - a.x, c.y - a.y, b.y - a.y, c.x - a.x);
}

/// Sets the plane through the three corners that span the largest area. Then no other corner lies beyond the
/// parallel to a side through the third corner. So barycentric weights are −1 to 1 inside the polygon, and
/// the plane's error there is at most three times that of a corner. Differences of places and depths are
/// rounded to 2⁻⁵³; that equals a corner's error of at most 2⁻⁵³ · 2¹⁶ texels' steps.
void setPlane(BoundPiece& piece) {
  double largest = 0;
  std::array<int, 3> best{0, 1, 2};
  for (int i = 0; i < piece.count; ++i)
    for (int j = i + 1; j < piece.count; ++j)
      for (int k = j + 1; k < piece.count; ++k) {
        const double area = twiceArea(piece.corners[i], piece.corners[j], piece.corners[k]);
        if (!(std::abs(area) > std::abs(largest))) continue;
        largest = area;
        best = {i, j, k};
      }
  // A polygon that contains a square of one texel has an area of at least 1, and the largest triangle of a
  // convex polygon's corners takes up at least 3√3 / 4π = .413 of it (Sas 1939). `largest` is twice an area.
  if (std::abs(largest) < 0.8) {
    piece.covering = false;
    return;
  }
  if (largest < 0) {  // drawPlane needs the inside on one side of all edges
    std::reverse(piece.corners.begin(), piece.corners.begin() + piece.count);
    for (int& i : best) i = piece.count - 1 - i;
    std::swap(best[0], best[2]);
    largest = -largest;
  }
  const glm::dvec3 &a = piece.corners[best[0]], &b = piece.corners[best[1]], &c = piece.corners[best[2]];
  piece.base = best[0];
  piece.depth = a.z;
  piece.step_x = differenceOfProducts(b.z - a.z, c.y - a.y, b.y - a.y, c.z - a.z) / largest;
  piece.step_y = differenceOfProducts(b.x - a.x, c.z - a.z, b.z - a.z, c.x - a.x) / largest;
}

/// What all triangles of a view share.
struct BoundFrame {
  const View& view;
  glm::dmat4 absolute;  ///< the projection's magnitudes
  ClipVolume volume;
  glm::dvec2 reach;        ///< half the picture and kBeyond, in units of w
  glm::dvec2 first, last;  ///< box of the picture, grown by one texel
};

BoundFrame makeBoundFrame(const View& view) {
  BoundFrame frame{view,
                   view.projection,
                   clipVolume(view),
                   1.0 + 2.0 * kBeyond / glm::dvec2(view.size),
                   glm::dvec2(-1.0),
                   glm::dvec2(view.size)};
  for (int column = 0; column < 4; ++column) frame.absolute[column] = glm::abs(frame.absolute[column]);
  return frame;
}

struct Vertex {
  glm::dvec4 clip;
  glm::dvec4 sums;  ///< of the magnitudes that clip was added up from
  ScreenVertex screen;
  std::uint32_t place;  ///< VertexPlace bits
};

/// Four planes make at most 3, 4, 6, 9, 13 corners, see clipPolygon.
using CutTriangle = Polygon<glm::dvec4, 13>;

/// Cuts a triangle in clip space so that |x| ≤ reach.x · w and |y| ≤ reach.y · w, and so w ≥ 0. A corner
/// within the rounding error of numbers as large as `sums` is kept.
CutTriangle cutSides(const std::array<glm::dvec4, 3>& triangle, const glm::dvec2& reach,
                     const glm::dvec4& sums) {
  CutTriangle polygon{{triangle[0], triangle[1], triangle[2]}, 3}, kept;
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 ? -1.0 : 1.0;
    const double doubt = kCornerError * (sums[axis] + reach[axis] * sums.w);
    clipPolygon(
        polygon, [&](const glm::dvec4& p) { return reach[axis] * p.w + sign * p[axis] + doubt; },
        edgeCrossing<glm::dvec4>, kept);
    std::swap(polygon, kept);
  }
  return polygon;
}

/// Adds a corner and its error bounds. False where its place is not known well enough.
bool addCorner(const glm::dvec4& clip, const ScreenVertex& screen, const glm::dvec4& sums,
               const BoundFrame& frame, BoundPiece& piece) {
  // Cutting a convex polygon adds at most one corner a side, so there is room for 7. One that rounding has
  // dented may have more: it counts as unknown.
  if (!(clip.w > 0.0) || piece.count == int(piece.corners.size())) return false;
  const glm::dvec2 half = 0.5 * glm::dvec2(frame.view.size);
  const double scale = kCornerError / clip.w;
  const glm::dvec3 error = scale * (glm::dvec3(sums) + glm::abs(glm::dvec3(clip) / clip.w) * sums.w);
  const double place = std::max(error.x * half.x, error.y * half.y);
  if (!(place <= kWorstPlace && error.z <= 1.0)) return false;
  piece.place_error = std::max(piece.place_error, place);
  piece.depth_error = std::max(piece.depth_error, error.z);
  const glm::dvec3 corner(screen.x + (frame.view.sample.x - 0.5), screen.y + (frame.view.sample.y - 0.5),
                          screen.depth);
  piece.low = glm::min(piece.low, corner);
  piece.high = glm::max(piece.high, corner);
  piece.add(corner);
  return true;
}

void setupTriangle(const std::array<const Vertex*, 3>& vertices, bool masked, const BoundFrame& frame,
                   BoundSetup& setup) {
  const auto& [a, b, c] = vertices;
  const unsigned any = a->place | b->place | c->place;
  if (any & kUnusable) return;
  BoundPiece piece;
  piece.low = glm::dvec3(std::numeric_limits<double>::infinity());
  piece.high = -piece.low;
  piece.place_error = piece.depth_error = 0;
  bool known = true;
  // A corner behind the eye is outside the guard band too. One between the eye and the near plane keeps its
  // place, and has a depth beyond 1.
  if (any & kOutsideGuard) {
    const glm::dvec4 sums = glm::max(glm::max(a->sums, b->sums), c->sums);
    const CutTriangle clipped = cutSides({a->clip, b->clip, c->clip}, frame.reach, sums);
    if (clipped.count == 0) return;
    for (int i = 0; i < clipped.count; ++i)
      known = known &&
              addCorner(clipped.corners[i], toScreen(clipped.corners[i], frame.view), sums, frame, piece);
  } else {
    for (const Vertex* vertex : vertices)
      known = known && addCorner(vertex->clip, vertex->screen, vertex->sums, frame, piece);
  }
  if (!known) {
    setup.unknown = true;
    return;
  }
  if (piece.high.x < frame.first.x || piece.high.y < frame.first.y || piece.low.x > frame.last.x ||
      piece.low.y > frame.last.y)
    return;
  const glm::dvec3 extent = piece.high - piece.low;
  piece.covering = !masked && extent.x >= 1.0 && extent.y >= 1.0 && piece.place_error <= kWorstCoveringPlace;
  if (piece.covering) setPlane(piece);
  setup.pieces.push_back(piece);
}

void setupMeshlet(const Scene& scene, const Meshlets& meshlets, std::uint32_t index,
                  const PlacedObject& object, const BoundFrame& frame, BoundSetup& setup) {
  std::array<Vertex, 3 * kMeshletTriangles> vertices;
  const Meshlet& meshlet = meshlets.items[index];
  for (std::uint32_t i = 0; i < meshlet.vertex_count; ++i) {
    const glm::vec3& position = object.mesh->positions[meshlets.vertices[meshlet.first_vertex + i]];
    const glm::dvec3 seen(object.object_to_view * glm::dvec4(position, 1.0));
    Vertex& vertex = vertices[i];
    vertex.clip = frame.view.projection * glm::dvec4(seen, 1.0);
    vertex.screen = toScreen(vertex.clip, frame.view);
    vertex.place = vertexPlace(seen, vertex.clip, frame.volume.guard);
    vertex.sums = frame.absolute * glm::dvec4(glm::abs(seen), 1.0);
  }
  for (std::uint32_t i = 0; i < meshlet.count; ++i) {
    const std::uint8_t* corners = meshlets.corners.data() + std::size_t(index) * 3 * kMeshletTriangles + i;
    setupTriangle({&vertices[corners[0]], &vertices[corners[kMeshletTriangles]],
                   &vertices[corners[2 * kMeshletTriangles]]},
                  materialOf(scene, object, meshlet.first + i).alpha_cutoff > 0.0f, frame, setup);
  }
}

}  // namespace

BoundSetup setupBounds(const Scene& scene, const PlacedMeshlets& placed, const View& view) {
  const BoundFrame frame = makeBoundFrame(view);
  constexpr std::size_t kTask = 32;  // meshlets
  const std::size_t tasks = (placed.chosen.size() + kTask - 1) / kTask;
  std::vector<std::vector<BoundPiece>> pieces(tasks);
  std::vector<std::uint8_t> unknown(tasks, 0);
  tbb::parallel_for(std::size_t(0), tasks, [&](std::size_t task) {
    const std::size_t end = std::min(placed.chosen.size(), (task + 1) * kTask);
    BoundSetup part;
    for (std::size_t i = task * kTask; i < end; ++i)
      setupMeshlet(scene, placed.meshlets, placed.chosen[i], placed.object(i), frame, part);
    pieces[task] = std::move(part.pieces);
    unknown[task] = part.unknown;
  });
  return {concatenate(std::move(pieces)), std::find(unknown.begin(), unknown.end(), 1) != unknown.end()};
}

}  // namespace luciole
