#include "raster/bound_depth.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "raster/bins.hpp"
#include "raster/geometry.hpp"

namespace luciole {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Half a grown texel's side. A hair more than promised, for the rounding of cut corners below (2⁻³⁶ texels).
constexpr double kHalf = 0.5 + kBoundGrowth + 0x1p-24;

/// Triangles that reach behind the light or far beyond the picture are cut so many texels outside of it.
constexpr double kBeyond = 2.0;

/// What a corner may have lost, relative to the largest of the numbers it was added up from: 2⁻⁵¹ for a
/// product of a matrix and a point, less than 2⁻⁵¹ for each of four cuts, and 2⁻⁵¹ for division and viewport.
constexpr double kCornerError = 0x1p-48;

/// Of places, in texels: more and nothing is known of a triangle; it is less than growth has room for.
constexpr double kWorstPlace = 0x1p-10;
/// More and a triangle doesn't count as covering. A plane's error inside a polygon is at most three times
/// that of its corners (see setPlane), which leaves 2⁻²⁴ steps.
constexpr double kWorstCoveringPlace = 0x1p-26;

/// Corners of a triangle, cut by four sides, by the two of a row and by the two of a column.
constexpr int kMostCorners = 3 + 4 + 4;

/// x and y in texels from the centre of the whole picture's texel (0,0), reversed depth.
template <int kRoom>
struct Polygon {
  std::array<glm::dvec3, kRoom> corners;
  int count = 0;
};
using AnyPolygon = Polygon<kMostCorners>;

/// A triangle as far as it is near the picture: convex, nothing of it left out for its size or its way round.
struct Piece : Polygon<7> {
  glm::dvec3 low, high;  ///< the box of its corners
  double place_error;    ///< of its corners, texels in x and in y
  double depth_error;
  bool covering;  ///< it may cover whole texels: solid, large enough, and known well enough. Then:
  double depth, step_x, step_y;  ///< its plane at corner `base`
  int base;
};

struct Setup {
  std::vector<Piece> pieces;
  bool unknown = false;  ///< some triangle may be anywhere
};

/// The part of a polygon with sign · (p[axis] − limit) ≤ 0 (Sutherland & Hodgman 1974). New corners lie on
/// the limit, and their depths between those of their edge.
template <int kAxis, int kSign>
void cut(const AnyPolygon& polygon, double limit, AnyPolygon& kept) {
  kept.count = 0;
  glm::dvec3 a = polygon.corners[polygon.count - 1];
  double da = kSign * (a[kAxis] - limit);
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& b = polygon.corners[i];
    const double db = kSign * (b[kAxis] - limit);
    if ((da <= 0) != (db <= 0)) {
      glm::dvec3 p = a + (b - a) * (da / (da - db));
      p[kAxis] = limit;
      kept.corners[kept.count++] = p;
    }
    if (db <= 0) kept.corners[kept.count++] = b;
    a = b;
    da = db;
  }
}

/// a·b − c·d within 1.5 units in its last place (Kahan; Jeannerod, Louvet & Muller 2013).
double differenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

double twiceArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return differenceOfProducts(b.x - a.x, c.y - a.y, b.y - a.y, c.x - a.x);
}

/// The plane through the three corners that span most. No other corner lies beyond the parallel of a side
/// through the third corner, so weights are −1 to 1 and errors inside the polygon at most three times those
/// of a corner. Differences of places and depths are rounded to 2⁻⁵³, which is a corner's error of 2⁻⁵³ · 2¹⁶
/// texels' steps at most.
void setPlane(Piece& piece) {
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
  // What contains a square of one texel has an area of 1 at least, and some triangle of a convex polygon's
  // corners takes up 3√3 / 4π = .413 of it (Sas 1939).
  if (std::abs(largest) < 0.8) {
    piece.covering = false;
    return;
  }
  if (largest < 0) {  // edges below must have the inside on one side
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

/// What holds for all triangles of a view.
struct Frame {
  const View& view;
  glm::dmat4 absolute;  ///< the projection's magnitudes
  ClipVolume volume;
  glm::dvec2 reach;        ///< of the picture and kBeyond, in units of w
  glm::dvec2 first, last;  ///< texels of the picture, grown
};

Frame makeFrame(const View& view) {
  Frame frame{view,
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
  std::uint16_t place;
};

/// Cuts a triangle in clip space so that |x| ≤ reach.x · w and |y| ≤ reach.y · w, and with that w ≥ 0. In
/// doubt, by rounding of numbers as large as `sums`, a corner is kept.
struct ClipPiece {
  std::array<glm::dvec4, 7> corners;
  int count;
};
ClipPiece cutSides(const std::array<glm::dvec4, 3>& triangle, const glm::dvec2& reach,
                   const glm::dvec4& sums) {
  ClipPiece piece{{triangle[0], triangle[1], triangle[2]}, 3};
  for (int side = 0; side < 4 && piece.count > 0; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 ? -1.0 : 1.0;
    const double doubt = kCornerError * (sums[axis] + reach[axis] * sums.w);
    // ≥ 0 inside
    const auto distance = [&](const glm::dvec4& p) { return reach[axis] * p.w + sign * p[axis] + doubt; };
    ClipPiece kept{{}, 0};
    glm::dvec4 a = piece.corners[piece.count - 1];
    double da = distance(a);
    for (int i = 0; i < piece.count; ++i) {
      const glm::dvec4 b = piece.corners[i];
      const double db = distance(b);
      // A convex polygon gains one corner a side; one that rounding dented could gain more, which are left
      // out: the dents are as small as the doubt.
      if ((da >= 0) != (db >= 0) && kept.count < 7)
        kept.corners[kept.count++] = a + (b - a) * (da / (da - db));
      if (db >= 0 && kept.count < 7) kept.corners[kept.count++] = b;
      a = b;
      da = db;
    }
    piece = kept;
  }
  return piece;
}

/// Adds a corner and what is unknown of it; false: nothing is known.
bool addCorner(const glm::dvec4& clip, const ScreenVertex& screen, const glm::dvec4& sums, const Frame& frame,
               Piece& piece) {
  if (!(clip.w > 0.0)) return false;
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
  piece.corners[piece.count++] = corner;
  return true;
}

void setupTriangle(const std::array<const Vertex*, 3>& vertices, bool masked, const Frame& frame,
                   Setup& setup) {
  const auto& [a, b, c] = vertices;
  const unsigned any = a->place | b->place | c->place;
  if (any & kUnusable) return;
  Piece piece;
  piece.low = glm::dvec3(std::numeric_limits<double>::infinity());
  piece.high = -piece.low;
  piece.place_error = piece.depth_error = 0;
  bool known = true;
  // A corner behind the eye is outside of the guard band too. One that is only behind the near plane has its
  // place and a depth beyond 1.
  if (any & kOutsideGuard) {
    const glm::dvec4 sums = glm::max(glm::max(a->sums, b->sums), c->sums);
    const ClipPiece clipped = cutSides({a->clip, b->clip, c->clip}, frame.reach, sums);
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

void setupRun(const Scene& scene, const TriangleRuns& runs, std::uint32_t index, const PlacedObject& object,
              const Frame& frame, Setup& setup) {
  std::array<Vertex, 3 * kRunTriangles> vertices;
  const TriangleRun& run = runs.runs[index];
  for (std::uint32_t i = 0; i < run.vertex_count; ++i) {
    const glm::vec3& position = object.mesh->positions[runs.vertices[run.first_vertex + i]];
    const glm::dvec3 seen(object.object_to_view * glm::dvec4(position, 1.0));
    Vertex& vertex = vertices[i];
    vertex.place = transformVertex(seen, frame.view, frame.volume, vertex.screen);
    vertex.clip = frame.view.projection * glm::dvec4(seen, 1.0);
    vertex.sums = frame.absolute * glm::dvec4(glm::abs(seen), 1.0);
  }
  for (std::uint32_t i = 0; i < run.count; ++i) {
    const std::uint8_t* corners = runs.corners.data() + std::size_t(index) * 3 * kRunTriangles + i;
    setupTriangle(
        {&vertices[corners[0]], &vertices[corners[kRunTriangles]], &vertices[corners[2 * kRunTriangles]]},
        materialOf(scene, object, run.first + i).alpha_cutoff > 0.0f, frame, setup);
  }
}

Setup setupRuns(const Scene& scene, const TriangleRuns& runs, std::span<const std::uint32_t> chosen,
                const View& view) {
  std::vector<std::uint32_t> used;
  std::vector<std::size_t> object_of;
  for (const std::uint32_t run : chosen) {
    if (used.empty() || used.back() != runs.runs[run].object) used.push_back(runs.runs[run].object);
    object_of.push_back(used.size() - 1);
  }
  const std::vector<PlacedObject> objects = placeObjects(scene, used, view.world_to_view);
  const Frame frame = makeFrame(view);
  constexpr std::size_t kTask = 32;  // runs
  std::vector<Setup> parts((chosen.size() + kTask - 1) / kTask);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t task) {
    const std::size_t end = std::min(chosen.size(), (task + 1) * kTask);
    for (std::size_t i = task * kTask; i < end; ++i)
      setupRun(scene, runs, chosen[i], objects[object_of[i]], frame, parts[task]);
  });
  Setup all;
  for (const Setup& part : parts) {
    all.pieces.insert(all.pieces.end(), part.pieces.begin(), part.pieces.end());
    all.unknown |= part.unknown;
  }
  return all;
}

/// The texels whose grown squares a span of places touches; places beyond the picture may be far beyond.
struct Range {
  int first, last;
};
Range texelsTouched(double low, double high, int origin) {
  const double from = std::clamp(std::ceil(low - kHalf) - origin, 0.0, double(kBinSize));
  const double to = std::clamp(std::floor(high + kHalf) - origin, -1.0, double(kBinSize - 1));
  return {int(from), int(to)};
}

/// Up to the next float.
float roundUp(double value) {
  const float rounded = float(value);
  return rounded < value ? std::nextafter(rounded, kInfinity) : rounded;
}

/// A bin of texels on its way.
struct BoundBin {
  glm::ivec2 origin;
  std::array<BoundTexel, kBinSize * kBinSize> texels;
  std::array<const Piece*, kBinSize * kBinSize> covering;  ///< whose plane it is
  std::array<double, kBinSize * kBinSize> lowest;  ///< of the plane: what is below is certainly behind it
};

double planeMargin(const BoundTexel& texel) {
  return 2.0 * kPlaneError *
         (std::abs(double(texel.depth)) + std::abs(double(texel.step_x)) + std::abs(double(texel.step_y)));
}

/// Takes the piece's plane wherever the piece covers a texel and lies higher than what was there.
void drawPlane(const Piece& piece, BoundBin& bin) {
  struct Edge {
    double x, y, dx, dy, reach;
  };
  std::array<Edge, 7> edges;
  for (int i = 0; i < piece.count; ++i) {
    const glm::dvec3 &a = piece.corners[i], &b = piece.corners[i + 1 == piece.count ? 0 : i + 1];
    edges[i] = {a.x, a.y, b.x - a.x, b.y - a.y, kHalf * (std::abs(b.x - a.x) + std::abs(b.y - a.y))};
  }
  const Range rows = texelsTouched(piece.low.y + 1, piece.high.y - 1, bin.origin.y);
  const Range columns = texelsTouched(piece.low.x + 1, piece.high.x - 1, bin.origin.x);
  const glm::dvec3& base = piece.corners[piece.base];
  const BoundTexel steps{0, float(piece.step_x), float(piece.step_y), 0};
  const double drop = kHalf * (std::abs(piece.step_x) + std::abs(piece.step_y));
  for (int row = rows.first; row <= rows.last; ++row) {
    const double y = row + bin.origin.y;
    for (int column = columns.first; column <= columns.last; ++column) {
      const double x = column + bin.origin.x;
      bool covers = true;
      for (int i = 0; i < piece.count; ++i) {
        const Edge& edge = edges[i];
        covers &= edge.dx * (y - edge.y) - edge.dy * (x - edge.x) >= edge.reach;
      }
      if (!covers) continue;
      const double depth = piece.depth + piece.step_x * (x - base.x) + piece.step_y * (y - base.y);
      // In the rounding of the far plane, and behind the near plane, nothing is certain.
      if (!(3 * piece.depth_error <= 0x1p-24 * depth && depth + drop <= 1.0)) continue;
      const int at = row * kBinSize + column;
      BoundTexel texel = steps;
      texel.depth = float(depth);
      if (!std::isfinite(texel.step_x) || !std::isfinite(texel.step_y)) continue;
      const double lowest = depth - drop - planeMargin(texel);
      if (!(lowest > bin.lowest[at])) continue;
      bin.texels[at] = texel;
      bin.covering[at] = &piece;
      bin.lowest[at] = lowest;
    }
  }
}

/// Whether a polygon, which lies in the texel's grown square, may be nearer than its plane anywhere.
bool mayBeInFront(const AnyPolygon& polygon, const Piece& piece, const BoundTexel& texel, double x,
                  double y) {
  const double margin = planeMargin(texel) + piece.depth_error +
                        piece.place_error * (std::abs(double(texel.step_x)) + std::abs(double(texel.step_y)));
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& p = polygon.corners[i];
    if (!(p.z + margin < texel.depth + texel.step_x * (p.x - x) + texel.step_y * (p.y - y))) return true;
  }
  return false;
}

/// Raises `others` wherever the piece may be in front of the plane.
void drawOther(const Piece& piece, BoundBin& bin) {
  const Range rows = texelsTouched(piece.low.y, piece.high.y, bin.origin.y);
  // Whether a texel's bounds leave out something of the piece that reaches `highest`.
  const auto matters = [&](int at, double highest) {
    return highest > bin.texels[at].others && highest >= bin.lowest[at] && bin.covering[at] != &piece;
  };
  const auto anyMatters = [&](int row, const Range& columns, double highest) {
    bool any = false;
    for (int column = columns.first; column <= columns.last; ++column)
      any |= matters(row * kBinSize + column, highest);
    return any;
  };
  const Range box = texelsTouched(piece.low.x, piece.high.x, bin.origin.x);
  AnyPolygon whole, scratch, strip, part;
  whole.count = piece.count;
  std::copy_n(piece.corners.begin(), piece.count, whole.corners.begin());
  for (int row = rows.first; row <= rows.last; ++row) {
    if (!anyMatters(row, box, piece.high.z + piece.depth_error)) continue;
    const double y = row + bin.origin.y;
    cut<1, -1>(whole, y - kHalf, scratch);
    if (scratch.count == 0) continue;
    cut<1, 1>(scratch, y + kHalf, strip);
    if (strip.count == 0) continue;
    glm::dvec3 low = strip.corners[0], high = low;
    for (int i = 1; i < strip.count; ++i) {
      low = glm::min(low, strip.corners[i]);
      high = glm::max(high, strip.corners[i]);
    }
    const Range columns = texelsTouched(low.x, high.x, bin.origin.x);
    for (int column = columns.first; column <= columns.last; ++column) {
      const int at = row * kBinSize + column;
      if (!matters(at, high.z + piece.depth_error)) continue;
      const double x = column + bin.origin.x;
      cut<0, -1>(strip, x - kHalf, scratch);
      if (scratch.count == 0) continue;
      cut<0, 1>(scratch, x + kHalf, part);
      if (part.count == 0) continue;
      BoundTexel& texel = bin.texels[at];
      if (bin.covering[at] && !mayBeInFront(part, piece, texel, x, y)) continue;
      double depth = part.corners[0].z;
      for (int i = 1; i < part.count; ++i) depth = std::max(depth, part.corners[i].z);
      depth += piece.depth_error;
      texel.others = depth > 1.0 ? kInfinity : std::max(texel.others, roundUp(depth));
    }
  }
}

}  // namespace

void rasterizeBounds(const Scene& scene, const TriangleRuns& runs, std::span<const std::uint32_t> chosen,
                     const View& view, std::span<const float> farthest, std::span<BoundTexel> texels) {
  const Setup setup = setupRuns(scene, runs, chosen, view);
  const glm::ivec2 first_bin = view.crop_origin / kBinSize;
  const glm::ivec2 bins = (view.crop_origin + view.crop_size - 1) / kBinSize - first_bin + 1;
  const auto isDrawn = [&](int bin) { return farthest.empty() || std::isfinite(farthest[bin]); };
  std::vector<std::vector<const Piece*>> lists(std::size_t(bins.x) * bins.y);
  for (const Piece& piece : setup.pieces) {
    const auto binOf = [](double place, int first, int count) {
      return int(std::clamp(std::floor((place + 0.5) / kBinSize) - first, -1.0, double(count)));
    };
    const int left = std::max(binOf(piece.low.x - 1, first_bin.x, bins.x), 0);
    const int right = std::min(binOf(piece.high.x + 1, first_bin.x, bins.x), bins.x - 1);
    const int top = std::max(binOf(piece.low.y - 1, first_bin.y, bins.y), 0);
    const int bottom = std::min(binOf(piece.high.y + 1, first_bin.y, bins.y), bins.y - 1);
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) {
        const int bin = y * bins.x + x;
        if (isDrawn(bin) && (farthest.empty() || roundUp(piece.high.z + piece.depth_error) >= farthest[bin]))
          lists[bin].push_back(&piece);
      }
  }
  tbb::parallel_for(std::size_t(0), lists.size(), [&](std::size_t index) {
    if (!isDrawn(int(index))) return;
    const auto bin = std::make_unique<BoundBin>();
    bin->origin = (first_bin + glm::ivec2(int(index) % bins.x, int(index) / bins.x)) * kBinSize;
    bin->texels.fill({-kInfinity, 0, 0, setup.unknown ? kInfinity : 0.0f});
    bin->covering.fill(nullptr);
    bin->lowest.fill(-std::numeric_limits<double>::infinity());
    for (const Piece* piece : lists[index])
      if (piece->covering) drawPlane(*piece, *bin);
    for (const Piece* piece : lists[index]) drawOther(*piece, *bin);
    const glm::ivec2 first = glm::max(bin->origin, view.crop_origin);
    const glm::ivec2 end = glm::min(bin->origin + kBinSize, view.crop_origin + view.crop_size);
    for (int y = first.y; y < end.y; ++y)
      std::copy_n(bin->texels.begin() + (y - bin->origin.y) * kBinSize + (first.x - bin->origin.x),
                  end.x - first.x,
                  texels.begin() + std::size_t(y - view.crop_origin.y) * view.crop_size.x +
                      (first.x - view.crop_origin.x));
  });
}

}  // namespace luciole
