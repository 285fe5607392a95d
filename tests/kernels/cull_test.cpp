#include "lights/cull.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shared.h"
#include "lights/light_tree.hpp"
#include "scene/bounds.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

constexpr unsigned kGroupLog2s[] = {4, 6, 8};
constexpr unsigned kTests[] = {kByRange, kByCone, kByCone | kByFacing};

/// A surface's points, of whole tiles; background where z is −∞.
struct Points {
  Plane position, normal;

  explicit Points(int tiles)
      : position(3 * std::size_t(tiles) * kTilePixels, -kInfinity), normal(position.size(), 0.0f) {}
  std::size_t count() const { return position.size() / 3; }
  bool covered(std::size_t i) const { return position[i + 2 * count()] > -kInfinity; }
  glm::vec3 p(std::size_t i) const { return {position[i], position[i + count()], position[i + 2 * count()]}; }
  glm::vec3 n(std::size_t i) const { return {normal[i], normal[i + count()], normal[i + 2 * count()]}; }
  void set(std::size_t i, const glm::vec3& at, const glm::vec3& facing) {
    for (int c = 0; c < 3; ++c) {
      position[i + c * count()] = at[c];
      normal[i + c * count()] = facing[c];
    }
  }
};

/// The lists on the host, one for each piece of pixels that lights are kept apart by: `starts` has
/// kSquaresPerTile of them a tile, of which larger pieces leave the last ones empty.
struct Lists {
  std::vector<cl_uint> starts, list;

  bool operator==(const Lists&) const = default;
  bool has(std::size_t i, std::uint32_t light) const {
    return std::binary_search(list.begin() + starts[i], list.begin() + starts[i + 1], light);
  }
};

/// By buffers that may have held other lists.
Lists cullInto(LightLists& lists, int lanes, const Points& points, std::span<const ShadeLight> lights,
               unsigned group_log2, unsigned tests) {
  OpenedDevice& device = deviceWithLanes(lanes);
  const LightTree tree = buildLightTree(lights);
  cull(device,
       {.position = borrowed(device, points.position),
        .normal = borrowed(device, points.normal),
        .plane_stride = points.count(),
        .group_log2 = group_log2,
        .lights = borrowed(device, lights),
        .light_count = lights.size(),
        .tree = borrowed(device, tree.planes),
        .tree_stride = tree.stride,
        .tests = tests},
       lists);
  EXPECT_EQ(lists.tiles, points.count() / kTilePixels);
  std::vector<cl_uint> starts(lists.tiles + 1);
  std::vector<ListEntry> entries(lists.entries);
  download(device, lists.starts, starts);
  download(device, lists.list, entries);
  EXPECT_EQ(starts[0], 0u);
  EXPECT_EQ(starts.back(), entries.size());
  Lists result{{0}, {}};
  const unsigned squares = (1u << group_log2) * kSquaresPerTile / kTilePixels, whole = (1u << squares) - 1;
  for (std::size_t tile = 0; tile < lists.tiles; ++tile) {
    EXPECT_LE(starts[tile], starts[tile + 1]);
    for (unsigned first = 0; first < kSquaresPerTile * squares; first += squares) {
      for (std::size_t i = starts[tile]; i < starts[tile + 1] && first < kSquaresPerTile; ++i) {
        EXPECT_TRUE(entries[i].squares > 0 && entries[i].squares < 1u << kSquaresPerTile);
        const unsigned members = entries[i].squares >> first & whole;
        EXPECT_TRUE(members == 0 || members == whole) << "what is bounded together is lit together";
        if (members) result.list.push_back(entries[i].light);
      }
      result.starts.push_back(cl_uint(result.list.size()));
    }
  }
  return result;
}

Lists cullWith(int lanes, const Points& points, std::span<const ShadeLight> lights, unsigned group_log2,
               unsigned tests) {
  LightLists lists;
  return cullInto(lists, lanes, points, lights, group_log2, tests);
}

/// By every width, which give the same.
Lists cullEverywhere(const Points& points, std::span<const ShadeLight> lights, unsigned group_log2,
                     unsigned tests) {
  const Lists lists = cullWith(1, points, lights, group_log2, tests);
  for (const int lanes : {4, 8, 16})
    EXPECT_EQ(cullWith(lanes, points, lights, group_log2, tests), lists) << lanes << " lanes";
  return lists;
}

ShadeLight pointLight(const glm::vec3& place, double range) {
  ShadeLight light{};
  light.kind = kPointLight;
  light.position = {place.x, place.y, place.z, float(1 / (range * range))};
  return light;
}

ShadeLight spotLight(const glm::vec3& place, double range, const glm::dvec3& shines, double edge) {
  ShadeLight light = pointLight(place, range);
  light.kind = kSpotLight;
  light.direction = {float(shines.x), float(shines.y), float(shines.z), float(edge)};
  return light;
}

ShadeLight directionalLight(const glm::dvec3& towards) {
  ShadeLight light{};
  light.kind = kDirectionalLight;
  light.position = {float(towards.x), float(towards.y), float(towards.z), 0};
  return light;
}

glm::vec3 place(const ShadeLight& light) { return {light.position.x, light.position.y, light.position.z}; }

/// The vector from a point to a light as the shading kernel rounds it.
glm::dvec3 toLight(const ShadeLight& light, const glm::vec3& p) {
  return glm::dvec3(light.kind == kDirectionalLight ? place(light) : place(light) - p);
}

/// Whether shading adds anything for this point, however its roundings come out.
bool isLit(const ShadeLight& light, const glm::vec3& p, const glm::vec3& n, unsigned tests) {
  const glm::dvec3 l = toLight(light, p);
  // The squared distance has 3 roundings and is then multiplied once; beside the difference's, in `l`.
  if (glm::dot(l, l) * light.position.w >= 1 - 5 * kUnit) return false;
  if (light.kind == kSpotLight) {
    const glm::dvec3 axis(light.direction.x, light.direction.y, light.direction.z);
    // 12 roundings: see FalloffKernels.
    if (!(glm::dot(-l, axis) / glm::length(l) > light.direction.w + 12 * kUnit)) return false;
  }
  // N·L has 3 roundings of terms that together are no larger than this.
  const glm::dvec3 terms = l * glm::dvec3(n);
  return !(tests & kByFacing) || terms.x + terms.y + terms.z >
                                     4 * kUnit * (std::abs(terms.x) + std::abs(terms.y) + std::abs(terms.z));
}

/// What a list shows, in double.
struct Bounds {
  glm::dvec3 low{INFINITY}, high{-INFINITY}, normal_low{INFINITY}, normal_high{-INFINITY};
  double plane = INFINITY;

  Bounds(const Points& points, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      if (!points.covered(i)) continue;
      low = glm::min(low, glm::dvec3(points.p(i)));
      high = glm::max(high, glm::dvec3(points.p(i)));
      normal_low = glm::min(normal_low, glm::dvec3(points.n(i)));
      normal_high = glm::max(normal_high, glm::dvec3(points.n(i)));
    }
    for (std::size_t i = first; i < end; ++i)
      if (points.covered(i))
        plane = std::min(plane, glm::dot(glm::dvec3(points.n(i)), glm::dvec3(points.p(i)) - middle()));
  }
  bool empty() const { return low.x > high.x; }
  glm::dvec3 middle() const { return 0.5 * (low + high); }
};

double sum(const glm::dvec3& v) { return v.x + v.y + v.z; }

/// Whether a list with these bounds has no business with the light: what the tests find, with twice the slack
/// that they allow for, and the rounding of the box's middle.
bool isFarOff(const ShadeLight& light, const Bounds& bounds, unsigned tests) {
  if (bounds.empty()) return true;
  const bool placed = light.kind != kDirectionalLight;
  const glm::dvec3 at(place(light));
  const glm::dvec3 gap = glm::max(glm::max(bounds.low - at, at - bounds.high), glm::dvec3(0));
  if (placed && glm::dot(gap, gap) * light.position.w > 1 + 8 * kUnit) return true;
  const glm::dvec3 v = placed ? at - bounds.middle() : at;
  const glm::dvec3 extent = placed ? 0.5 * (bounds.high - bounds.low) : glm::dvec3(0);
  const double middle_error = placed ? 2 * kUnit * sum(glm::abs(bounds.middle())) : 0;
  if ((tests & kByCone) && light.kind == kSpotLight && light.direction.w > 0) {
    const glm::dvec3 axis(light.direction.x, light.direction.y, light.direction.z);
    const double along = glm::dot(-v, axis),
                 across = std::sqrt(std::max(glm::dot(v, v) - along * along, 0.0));
    const double cosine = light.direction.w, sine = std::sqrt(1 - cosine * cosine);
    if (across * cosine - along * sine > glm::length(extent) + 2e-3 * glm::length(v) + middle_error)
      return true;
  }
  if (!(tests & kByFacing)) return false;
  const double most = sum(glm::max(v * bounds.normal_low, v * bounds.normal_high));
  const double slack = 8e-6 * (sum(glm::abs(v)) + sum(extent)) + 2 * middle_error;
  return most - (placed ? bounds.plane : 0.0) < -slack;
}

/// What the lists of one run came to.
struct Tally {
  std::size_t lit = 0, left_out = 0;
};

/// Every list against its points and its bounds.
void judge(const Points& points, std::span<const ShadeLight> lights, unsigned group_log2, unsigned tests,
           const Lists& lists, Tally& tally) {
  for (std::size_t list = 0; list + 1 < lists.starts.size(); ++list) {
    const auto begin = lists.list.begin() + lists.starts[list],
               end = lists.list.begin() + lists.starts[list + 1];
    ASSERT_EQ(std::adjacent_find(begin, end, std::greater_equal<>()), end) << "indices ascend, none twice";
    ASSERT_TRUE(begin == end || *(end - 1) < lights.size());
    const std::size_t in_tile = list % kSquaresPerTile << group_log2;
    const std::size_t first = list / kSquaresPerTile * kTilePixels + in_tile;
    const std::size_t last = in_tile < kTilePixels ? first + (std::size_t(1) << group_log2) : first;
    const Bounds bounds(points, first, last);
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      bool lit = false;
      for (std::size_t pixel = first; pixel < last && !lit; ++pixel)
        lit = points.covered(pixel) && isLit(lights[i], points.p(pixel), points.n(pixel), tests);
      const bool listed = lists.has(list, i);
      tally.lit += lit;
      tally.left_out += !listed && !bounds.empty();
      ASSERT_TRUE(listed || !lit) << "light " << i << " of list " << list << " is left out";
      ASSERT_FALSE(listed && isFarOff(lights[i], bounds, tests)) << "light " << i << " of list " << list;
    }
  }
}

/// A random number whose logarithm is evenly spread.
double magnitude(double low, double high, Random& random) {
  return std::exp(random.between(std::log(low), std::log(high)));
}

glm::dvec3 towards(const glm::dvec3& way, double spread, Random& random) {
  return glm::normalize(way + spread * random.direction());
}

/// Tiles of squares of 4 × 4 points, which lie in a patch of a plane of their own and face much the same way;
/// from a millimetre to kilometres ahead and as wide. Tile 1 is background and tile 2 a single point, and of
/// all others a third is background.
Points randomPoints(int tiles, Random& random) {
  Points points(tiles);
  for (int tile = 0; tile < tiles; ++tile) {
    const double depth = magnitude(1e-3, 1e4, random), width = depth * magnitude(1e-6, 1, random);
    const glm::dvec3 center = depth * glm::dvec3(random.between(-1, 1), random.between(-1, 1), -1);
    for (int i = 0; i < kTilePixels; i += 16) {
      const glm::dvec3 facing = random.direction();
      const glm::dvec3 aside = glm::normalize(glm::cross(facing, random.direction()));
      const glm::dvec3 square = center + width * random.direction();
      const double bend = magnitude(1e-7, 1, random);
      for (int k = i; k < i + 16; ++k) {
        if (tile == 1 || (tile == 2 ? k != 77 : random.chance(0.33))) continue;
        const glm::dvec3 at =
            square +
            0.3 * width * (random.between(-1, 1) * aside + random.between(-1, 1) * glm::cross(aside, facing));
        points.set(std::size_t(tile) * kTilePixels + k, glm::vec3(at),
                   glm::vec3(towards(facing, bend, random)));
      }
    }
  }
  return points;
}

/// Cosines of cutoffs: the narrowest that there is, narrow ones, 90°, beyond, and all around.
constexpr double kEdges[] = {1 - 12 * 0x1p-24, 0.9999, 0.98, 0.7, 0.01, 6e-17, -0.5, -1};

/// Lights about the points: most so far from one of them that they just reach it or just don't, just above
/// or just below the plane it faces out of, or with their cone's side through it.
ShadeLight randomLight(const Points& points, Random& random) {
  std::size_t i = 0;
  do i = std::size_t(random.below(int(points.count())));
  while (!points.covered(i));
  const glm::dvec3 p(points.p(i)), n(points.n(i));
  const double range = magnitude(1e-6, 1e6, random);
  glm::dvec3 way = random.direction();
  if (random.chance(0.4))
    way = glm::normalize(glm::cross(n, way) +
                         n * (random.chance(0.5) ? 1.0 : -1.0) * magnitude(1e-8, 1e-3, random));
  const double distance =
      range * (random.chance(0.5) ? random.between(0, 1.2) : 1 + 1e-5 * random.between(-1, 1));
  const glm::vec3 place(p + distance * way);
  if (random.chance(0.1)) return directionalLight(way);
  if (random.chance(0.1)) return pointLight(glm::vec3(1e18 * way), random.chance(0.5) ? INFINITY : 2e18);
  if (random.chance(0.4)) return pointLight(place, random.chance(0.1) ? INFINITY : range);
  const double edge = kEdges[random.below(int(std::size(kEdges)))];
  const double angle =
      std::acos(edge) * (random.chance(0.5) ? random.between(0, 1.3) : 1 + 1e-3 * random.between(-1, 1));
  const glm::dvec3 aside = glm::normalize(glm::cross(way, random.direction()));
  return spotLight(place, range, -std::cos(angle) * way + std::sin(angle) * aside, edge);
}

class CullKernels : public testing::TestWithParam<int> {};

TEST_P(CullKernels, ListsHoldWhatLightsAPointAndNothingThatCannot) {
  Random random(unsigned(GetParam()) + 1);
  const Points points = randomPoints(GetParam() > 1000 ? 4 : 12, random);
  std::vector<ShadeLight> lights;
  while (int(lights.size()) < GetParam()) lights.push_back(randomLight(points, random));
  for (const unsigned group_log2 : kGroupLog2s) {
    Tally tally;
    for (const unsigned tests : kTests) {
      const Lists lists = cullEverywhere(points, lights, group_log2, tests);
      ASSERT_NO_FATAL_FAILURE(judge(points, lights, group_log2, tests, lists, tally))
          << "group_log2 " << group_log2 << ", tests " << tests;
    }
    if (GetParam() > 100) {
      EXPECT_GT(tally.lit, std::size_t(GetParam())) << "the case tests something";
      EXPECT_GT(tally.left_out, std::size_t(GetParam())) << "the case tests something";
    }
  }
}

// Whole rows of the tree, one more, and so on for its next levels.
INSTANTIATE_TEST_SUITE_P(Lights, CullKernels, testing::Values(0, 1, 16, 17, 256, 257, 4097),
                         testing::PrintToStringParamName());

TEST(CullKernels, EachTestLeavesOutWhatItIsFor) {
  // A square of points at the origin that faces +z.
  Points points(1);
  for (int i = 0; i < kTilePixels; ++i)
    points.set(i, glm::vec3(float(i % 16) / 16, float(i / 16) / 16, 0), glm::vec3(0, 0, 1));
  const ShadeLight lights[] = {pointLight({0, 0, 1}, 5),
                               pointLight({0, 0, 9}, 5),
                               pointLight({0, 0, -1}, 5),
                               spotLight({0, 0, 2}, 9, {0, 0, -1}, 0.9),
                               spotLight({0, 0, 2}, 9, {0, 0, 1}, 0.9),
                               directionalLight({0, 0, 1}),
                               directionalLight({0, 0.6, -0.8})};
  using Entries = std::vector<cl_uint>;
  EXPECT_EQ(cullEverywhere(points, lights, 8, kByRange).list, (Entries{0, 2, 3, 4, 5, 6}));
  EXPECT_EQ(cullEverywhere(points, lights, 8, kByCone).list, (Entries{0, 2, 3, 5, 6}));
  EXPECT_EQ(cullEverywhere(points, lights, 8, kByFacing).list, (Entries{0, 3, 4, 5}));
  EXPECT_EQ(cullEverywhere(points, lights, 8, kByCone | kByFacing).list, (Entries{0, 3, 5}));
}

TEST(CullKernels, LightsAHairAboveTheSurfaceStayIn) {
  // Terms of N·L are 0 but for one, which is the least that floats have there: shading sees it above 0.
  for (const float depth : {1e-3f, 1.0f, 1e3f, 1e6f}) {
    Points points(1);
    for (int i = 0; i < kTilePixels; ++i)
      points.set(i, depth * glm::vec3(float(i % 16) / 16, float(i / 16) / 16, -1), glm::vec3(0, 0, 1));
    const float above = std::nextafter(-depth, 0.0f);
    const ShadeLight lights[] = {
        pointLight({0, 0, above}, INFINITY), pointLight({-40 * depth, 3 * depth, above}, INFINITY),
        spotLight({depth, depth, above}, INFINITY, {-1, 0, 0}, 0.01), directionalLight({1, 0, 1e-30})};
    for (const unsigned group_log2 : kGroupLog2s) {
      const Lists lists = cullEverywhere(points, lights, group_log2, kByFacing);
      for (std::size_t list = 0; list < std::size_t(kTilePixels) >> group_log2; ++list)
        for (std::uint32_t light = 0; light < std::size(lights); ++light)
          EXPECT_TRUE(lists.has(list, light))
              << depth << " m, group_log2 " << group_log2 << ", light " << light;
    }
  }
}

TEST(CullKernels, BoxesOfAFloatsLastBitHoldTheirPoints) {
  // Two points a kilometre ahead, as near to each other as floats get there, and a spot at centimetres whose
  // cone holds only one of them.
  Random random(5);
  std::size_t lit = 0;
  for (int round = 0; round < 300; ++round) {
    Points points(1);
    const glm::vec3 a(glm::dvec3(0, 0, -1000) + 300.0 * random.direction());
    glm::vec3 b = a;
    for (int c = 0; c < 3; ++c)
      if (random.chance(0.6)) b[c] = std::nextafter(b[c], 2 * b[c]);
    const glm::dvec3 way = random.direction();
    const ShadeLight place_only =
        pointLight(glm::vec3(glm::dvec3(a) + magnitude(1e-4, 0.1, random) * way), INFINITY);
    const glm::dvec3 l = toLight(place_only, a);
    if (glm::length(l) == 0) continue;
    const glm::dvec3 aside = glm::normalize(glm::cross(l, random.direction()));
    for (int i = 0; i < 16; ++i) points.set(i, i % 2 ? a : b, glm::vec3(glm::normalize(l)));
    std::vector<ShadeLight> lights;
    for (const double edge : {0.9999, 0.98, 0.7}) {
      const double angle = std::acos(edge) * random.between(0.7, 1);
      lights.push_back(spotLight(place(place_only), INFINITY,
                                 -std::cos(angle) * glm::normalize(l) + std::sin(angle) * aside, edge));
    }
    Tally tally;
    ASSERT_NO_FATAL_FAILURE(judge(points, lights, 4, kByCone | kByFacing,
                                  cullWith(16, points, lights, 4, kByCone | kByFacing), tally));
    lit += tally.lit;
  }
  EXPECT_GT(lit, 300u);
}

TEST(CullKernels, ListsGrowAsLongAsTheyMust) {
  Random random(9);
  const Points points = randomPoints(6, random);
  // As many as counting keeps, one more, twice as many, and far more.
  for (const cl_uint count :
       {cl_uint(kFoundPerTile), cl_uint(kFoundPerTile + 1), cl_uint(2 * kFoundPerTile), 20001u}) {
    const std::vector<ShadeLight> lights(count, pointLight({0, 0, 0}, INFINITY));
    for (const int lanes : kAllLanes) {
      SCOPED_TRACE(testing::Message() << count << " lights, " << lanes << " lanes");
      const Lists lists = cullWith(lanes, points, lights, 8, kByCone);
      for (int tile = 0; tile < 6; ++tile)
        for (int list = 0; list < kSquaresPerTile; ++list) {
          const int at = tile * kSquaresPerTile + list;
          ASSERT_EQ(lists.starts[at + 1] - lists.starts[at], list == 0 && tile != 1 ? count : 0u);
        }
      for (std::size_t entry = 0; entry < lists.list.size(); ++entry)
        ASSERT_EQ(lists.list[entry], entry % count);
    }
  }
}

TEST(CullKernels, ListsAreTheSameInBuffersThatHeldOthers) {
  Random random(9);
  const Points many = randomPoints(6, random), few = randomPoints(3, random);
  const std::vector<ShadeLight> lights(1000, pointLight({0, 0, 0}, INFINITY));
  const std::span all(lights);
  LightLists lists;
  cullInto(lists, 1, many, all, 8, kByCone);
  const auto memory = [&] {
    return std::array{lists.starts.memory.handle(), lists.list.memory.handle(), lists.found.memory.handle()};
  };
  const auto before = memory();
  EXPECT_EQ(cullInto(lists, 1, few, all.first(70), 4, kByCone), cullWith(1, few, all.first(70), 4, kByCone));
  EXPECT_EQ(cullInto(lists, 1, many, all, 8, kByCone), cullWith(1, many, all, 8, kByCone));
  EXPECT_EQ(memory(), before);
}

TEST(CullKernels, NoLightsAndNoPixelsMakeEmptyLists) {
  Random random(9);
  const Points points = randomPoints(3, random), background(3);
  const std::vector<ShadeLight> lights(33, pointLight({0, 0, -5}, INFINITY));
  for (const unsigned group_log2 : kGroupLog2s) {
    EXPECT_EQ(cullEverywhere(points, {}, group_log2, kByFacing).starts,
              std::vector<cl_uint>(3 * kSquaresPerTile + 1, 0));
    EXPECT_EQ(cullEverywhere(background, lights, group_log2, kByFacing).starts,
              std::vector<cl_uint>(3 * kSquaresPerTile + 1, 0));
  }
}

TEST(CullKernels, PaddingOfTheTreeIsNeverListed) {
  // One light, and so 15 nodes without any; points next to the eye, at the ends of what floats hold and past
  // them.
  Points points(1);
  const std::array<float, 4> coordinates{-3e38f, 1e18f, 3e38f, kInfinity};
  for (int i = 0; i < 64; ++i)
    points.set(i, {coordinates[i % 4], coordinates[i / 4 % 4], coordinates[i / 16]}, {0, 0, 1});
  for (int i = 64; i < kTilePixels; ++i) points.set(i, {0, 0, -1e-3f}, {0, 0, 1});
  const ShadeLight light = pointLight({0, 0, 1}, INFINITY);
  for (const unsigned group_log2 : kGroupLog2s)
    for (const cl_uint entry : cullEverywhere(points, {&light, 1}, group_log2, kByCone).list)
      EXPECT_EQ(entry, 0u);
}

}  // namespace
}  // namespace luciole::test
