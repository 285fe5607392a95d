#include "scene/sky_cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "scene/luminance.hpp"

namespace luciole {
namespace {

/// Texels around the horizon of the level by which cells are divided, at most.
constexpr int kWidestMeasure = 4096;

/// A rectangle of a sky: u from left to right, v from the top down, from 0 to 1.
struct Cell {
  double left, top, right, bottom;
};

double thetaOf(double v) { return glm::pi<double>() * v; }

/// The integral of L^⅔ over rectangles of a sky, as a table of sums.
class Measure {
 public:
  explicit Measure(const SkyLevel& level)
      : width_(level.width), height_(level.height), sums_(std::size_t(width_ + 1) * (height_ + 1)) {
    const double turn = 2 * glm::pi<double>() / width_;
    for (int y = 0; y < height_; ++y) {
      double row = 0;
      const double area = turn * (cosine(y) - cosine(y + 1));
      for (int x = 0; x < width_; ++x) {
        const float* texel = &level.texels[3 * (std::size_t(y) * width_ + x)];
        const double light = glm::dot(kLuminance, glm::dvec3(texel[0], texel[1], texel[2]));
        row += std::cbrt(light * light) * area;
        at(x + 1, y + 1) = at(x + 1, y) + row;
      }
    }
  }

  double of(const Cell& cell) const {
    return to(cell.right, cell.bottom) - to(cell.left, cell.bottom) - to(cell.right, cell.top) +
           to(cell.left, cell.top);
  }

  /// Where a cell is cut so that the left part, or the upper one, has this share of the whole.
  double cut(const Cell& cell, bool across, double share) const {
    const double wanted = share * of(cell);
    const auto part = [&](double where) {
      Cell first = cell;
      (across ? first.right : first.bottom) = where;
      return of(first);
    };
    const double begin = across ? cell.left : cell.top, end = across ? cell.right : cell.bottom;
    const int count = across ? width_ : height_;
    if (!(wanted > 0)) return 0.5 * begin + 0.5 * end;
    // The texel in which it lies, and there the place: texels are of one brightness.
    int low = int(begin * count), high = int(std::ceil(end * count));
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      (part(std::clamp(double(middle) / count, begin, end)) < wanted ? low : high) = middle;
    }
    const double from = std::clamp(double(low) / count, begin, end),
                 to = std::clamp(double(high) / count, begin, end);
    const double before = part(from), after = part(to);
    const double share_of_texel =
        after > before ? std::clamp((wanted - before) / (after - before), 0.0, 1.0) : 0.5;
    if (across) return std::lerp(from, to, share_of_texel);
    return std::acos(std::clamp(std::lerp(std::cos(thetaOf(from)), std::cos(thetaOf(to)), share_of_texel),
                                -1.0, 1.0)) /
           glm::pi<double>();
  }

 private:
  double& at(int x, int y) { return sums_[std::size_t(y) * (width_ + 1) + x]; }
  double at(int x, int y) const { return sums_[std::size_t(y) * (width_ + 1) + x]; }
  double cosine(int row) const { return std::cos(thetaOf(double(row) / height_)); }

  /// Over all that is left of u and above v.
  double to(double u, double v) const {
    const int x = std::min(int(u * width_), width_ - 1), y = std::min(int(v * height_), height_ - 1);
    const double right = u * width_ - x, above = cosine(y);
    const double down = (above - std::cos(thetaOf(v))) / (above - cosine(y + 1));
    return std::lerp(std::lerp(at(x, y), at(x + 1, y), right),
                     std::lerp(at(x, y + 1), at(x + 1, y + 1), right), down);
  }

  int width_, height_;
  std::vector<double> sums_;
};

/// Halves a cell until each part has one light. The longer side is cut.
void divide(const Measure& measure, const Cell& cell, std::uint32_t count, std::vector<Cell>& cells) {
  if (count == 1) {
    cells.push_back(cell);
    return;
  }
  const double wide = 2 * (cell.right - cell.left) * std::sin(thetaOf(0.5 * (cell.top + cell.bottom)));
  const bool across = wide > cell.bottom - cell.top;
  const std::uint32_t first = count / 2;
  const double where = measure.cut(cell, across, double(first) / count);
  Cell one = cell, other = cell;
  (across ? one.right : one.bottom) = where;
  (across ? other.left : other.top) = where;
  divide(measure, one, first, cells);
  divide(measure, other, count - first, cells);
}

/// Integrals over an interval of longitude or latitude, of which those over a rectangle are products. With φ
/// from −π to π and θ from the top, a direction is (sin θ sin φ, cos θ, −sin θ cos φ), and dω = sin θ dθ dφ.
struct Longitudes {
  double angle, sine, cosine;  // of dφ, sin φ dφ, cos φ dφ

  Longitudes(double left, double right) {
    const double from = 2 * glm::pi<double>() * (left - 0.5), to = 2 * glm::pi<double>() * (right - 0.5);
    angle = to - from;
    sine = std::cos(from) - std::cos(to);
    cosine = std::sin(to) - std::sin(from);
  }
};
struct Latitudes {
  double area, square, mixed;  // of sin θ dθ, sin² θ dθ, sin θ cos θ dθ

  Latitudes(double top, double bottom) {
    const double from = thetaOf(top), to = thetaOf(bottom);
    area = std::cos(from) - std::cos(to);
    square = 0.5 * (to - from) - 0.25 * (std::sin(2 * to) - std::sin(2 * from));
    mixed = 0.5 * (std::sin(to) * std::sin(to) - std::sin(from) * std::sin(from));
  }
};

/// What a cell's light is: ∫ L ω dω of each channel, as columns. So n · ∫ L ω dω is the irradiance that it
/// gives a surface of the normal n that sees all of it.
glm::dmat3 lightOf(const SkyLevel& level, const std::vector<Longitudes>& columns, const Cell& cell) {
  const int first = int(cell.left * level.width),
            last = std::min(int(std::ceil(cell.right * level.width)), level.width);
  const int top = int(cell.top * level.height),
            bottom = std::min(int(std::ceil(cell.bottom * level.height)), level.height);
  glm::dmat3 light(0.0);
  for (int y = top; y < bottom; ++y) {
    std::array<glm::dvec3, 3> row{};  // ∫ L dφ, ∫ L sin φ dφ, ∫ L cos φ dφ
    for (int x = first; x < last; ++x) {
      const bool whole = x >= cell.left * level.width && x + 1 <= cell.right * level.width;
      const Longitudes part = whole ? columns[std::size_t(x)]
                                    : Longitudes(std::max(double(x) / level.width, cell.left),
                                                 std::min(double(x + 1) / level.width, cell.right));
      const float* texel = &level.texels[3 * (std::size_t(y) * level.width + x)];
      const glm::dvec3 radiance(texel[0], texel[1], texel[2]);
      row[0] += part.angle * radiance;
      row[1] += part.sine * radiance;
      row[2] += part.cosine * radiance;
    }
    const Latitudes part(std::max(double(y) / level.height, cell.top),
                         std::min(double(y + 1) / level.height, cell.bottom));
    for (int c = 0; c < 3; ++c)
      light[c] += glm::dvec3(part.square * row[1][c], part.mixed * row[0][c], -part.square * row[2][c]);
  }
  return light;
}

/// The light of a cell comes from where the luminance's does. Each channel keeps what it has that way, so
/// that white light is exact, and of coloured light what is lost turns its direction alone.
SkyCell cellOf(const SkyLevel& level, const std::vector<Longitudes>& columns, const Cell& cell) {
  const glm::dmat3 light = lightOf(level, columns, cell);
  const glm::dvec3 whole = light * kLuminance;
  const double length = glm::length(whole);
  if (!(length > 0)) return {};
  SkyCell result;
  result.direction = whole / length;
  result.light = glm::vec3(glm::max(result.direction * light, glm::dvec3(0.0)) / glm::pi<double>());
  result.solid_angle = float(Longitudes(cell.left, cell.right).angle * Latitudes(cell.top, cell.bottom).area);
  return result;
}

}  // namespace

std::vector<SkyCell> skyCells(const Sky& sky, std::uint32_t count) {
  if (count == 0) return {};
  const auto measured = std::find_if(sky.levels.begin(), sky.levels.end(),
                                     [](const SkyLevel& level) { return level.width <= kWidestMeasure; });
  const Measure measure(*measured);
  const Cell whole{0, 0, 1, 1};
  if (!(measure.of(whole) > 0)) return {};
  std::vector<Cell> parts;
  parts.reserve(count);
  divide(measure, whole, count, parts);
  const SkyLevel& level = sky.levels[0];
  std::vector<Longitudes> columns;
  for (int x = 0; x < level.width; ++x)
    columns.emplace_back(double(x) / level.width, double(x + 1) / level.width);
  std::vector<SkyCell> cells(parts.size());
  tbb::parallel_for(std::size_t(0), cells.size(),
                    [&](std::size_t i) { cells[i] = cellOf(level, columns, parts[i]); });
  std::erase_if(cells, [](const SkyCell& cell) { return cell.light == glm::vec3(0.0f); });
  return cells;
}

}  // namespace luciole
