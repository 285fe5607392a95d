#include "lights/light_clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "kernels/cluster_moments.hpp"
#include "kernels/random_scene.hpp"

namespace luciole::test {
namespace {

using Lights = std::vector<UnboundedLight>;

Lights someLights(int count, Random& random) {
  Lights lights;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 place(random.between(-9, 9), random.between(-2, 2), random.between(-30, -10));
    lights.push_back({place, random.color(), random.between(0.5, 2)});
  }
  return lights;
}

/// A light as its row has it.
struct LeafLight {
  glm::dvec3 place;
  glm::vec3 color;
  float most, falloff;
};

/// The light at index `i` in the order of the tree, which is that of the leaves.
LeafLight leafLight(const LightClusters& clusters, std::size_t i) {
  std::size_t leaf = 0;
  while (clusterBegin(clusters.lights, clusters.levels, leaf + 1) <= i) ++leaf;
  const std::size_t slot = leaf % 2 * kLeafLights + i - clusterBegin(clusters.lights, clusters.levels, leaf);
  const auto field = [&](std::size_t f) {
    return clusters.light_rows[(leaf / 2 * kLightFields + f) * kClusterSlots + slot];
  };
  LeafLight light{{}, {}, field(kLightMost), field(kLightFalloff)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    light.place[int(axis)] = double(field(kLightPlace + axis)) + double(field(kLightRest + axis));
    light.color[int(axis)] = field(kLightColor + axis);
  }
  return light;
}

/// What brute force has of the lights from `begin` to `end`, about the centre that the row has.
void expectCluster(const LightClusters& clusters, std::size_t row, std::size_t slot, std::size_t begin,
                   std::size_t end) {
  const auto field = [&](std::size_t f) {
    return double(clusters.rows[(row * kClusterFields + f) * kClusterSlots + slot]);
  };
  const glm::dvec3 centre(field(kClusterCentre), field(kClusterCentre + 1), field(kClusterCentre + 2));
  std::vector<ClusterLight> lights;
  for (std::size_t i = begin; i < end; ++i) {
    const LeafLight light = leafLight(clusters, i);
    lights.push_back({light.place - centre, glm::dvec3(light.color)});
  }
  const ClusterMoments truth = clusterMoments(centre, lights);
  // What places lose beyond 48 bits, and sums in double precision, is below 2⁻⁴⁰ of what is summed. A bound
  // is rounded up to a float, at least 10⁻³⁰.
  const double radius = truth.field[kClusterRadius];
  for (std::size_t f = kClusterExtent; f < kClusterMoments; ++f) {
    const bool harmonic = f >= kClusterHarmonic;
    const double lost = 0x1p-40 * (harmonic                ? truth.most[f - kClusterHarmonic]
                                   : f >= kClusterAbsolute ? truth.field[f]
                                                           : radius + 30);
    // The square of a harmonic bound is what brute force knows to 2⁻⁴⁸ of its terms' squares. A largest
    // eigenvalue is rounded up.
    const double unknown = harmonic ? 0x1p-23 * truth.most[f - kClusterHarmonic] : lost;
    EXPECT_GE(field(f), truth.field[f] - unknown) << "field " << f;
    const double eigenvalue = f >= kClusterDeviation ? 0x1p-20 * truth.most[f - kClusterHarmonic] : 0;
    EXPECT_LE(field(f), truth.field[f] * (1 + 0x1p-22) + unknown + eigenvalue + 2e-30) << "field " << f;
  }
  for (std::size_t f = kClusterMoments; f < kClusterFields; ++f) {
    const std::size_t m = (f - kClusterMoments) % kMoments;
    const std::size_t degree = m >= kMoment2 ? 2 : m >= kMoment1 ? 1 : 0;
    EXPECT_NEAR(field(f), truth.field[f],
                0x1p-24 * std::abs(truth.field[f]) + 0x1p-38 * truth.field[kClusterAbsolute + degree])
        << "field " << f;
  }
}

class LightClustersOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lights, LightClustersOf, testing::Range(0, 201, 1));

TEST_P(LightClustersOf, HoldEachLightInOneLeafAndBoundEveryCluster) {
  Random random(GetParam());
  const Lights lights = someLights(GetParam(), random);
  const LightClusters clusters = buildLightClusters(lights);
  const std::size_t count = lights.size();
  ASSERT_EQ(clusters.lights, count);
  // By their places, which are all different.
  std::vector<bool> found(count);
  for (std::size_t index = 0; index < count; ++index) {
    const LeafLight light = leafLight(clusters, index);
    const auto near = std::find_if(lights.begin(), lights.end(), [&](const UnboundedLight& other) {
      return glm::distance(other.position, light.place) <= 0x1p-44 * glm::length(other.position);
    });
    ASSERT_NE(near, lights.end());
    const std::size_t i = std::size_t(near - lights.begin());
    EXPECT_FALSE(found[i]) << "twice";
    found[i] = true;
    const glm::dvec3 color = near->color / near->quadratic;
    EXPECT_EQ(light.color, glm::vec3(color));
    EXPECT_EQ(light.most, std::max({light.color.x, light.color.y, light.color.z}));
    EXPECT_EQ(light.falloff, float(0x1p100 * near->quadratic));
  }
  // Slots without a light are black.
  std::size_t bright = 0;
  for (std::size_t row = 0; row * kLightFields * kClusterSlots < clusters.light_rows.size(); ++row)
    for (std::size_t slot = 0; slot < kClusterSlots; ++slot)
      bright += clusters.light_rows[(row * kLightFields + kLightMost) * kClusterSlots + slot] > 0;
  EXPECT_EQ(bright, count);
  for (std::size_t leaf = 0; leaf < std::size_t(1) << clusters.levels; ++leaf)
    EXPECT_LE(clusterBegin(count, clusters.levels, leaf + 1) - clusterBegin(count, clusters.levels, leaf),
              std::size_t(kLeafLights));
  std::size_t row = 0, seen = 0;
  // All rows but the first have three levels.
  for (unsigned level = 0, levels = clusters.levels % 3 == 0 ? 3 : clusters.levels % 3;
       level < clusters.levels; level += levels, levels = 3)
    for (std::size_t node = 0; node < std::size_t(1) << level; ++node, ++row)
      for (unsigned below = 1, slot = 0; below <= levels; ++below)
        for (std::size_t i = 0; i < std::size_t(1) << below; ++i, ++slot) {
          SCOPED_TRACE("row " + std::to_string(row) + ", slot " + std::to_string(slot));
          const std::size_t at = (node << below) + i;
          expectCluster(clusters, row, slot, clusterBegin(count, level + below, at),
                        clusterBegin(count, level + below, at + 1));
          ++seen;
        }
  EXPECT_EQ(row * kClusterFields * kClusterSlots, clusters.rows.size());
  EXPECT_EQ(seen, (std::size_t(2) << clusters.levels) - 2);
}

TEST(LightClusters, AreTheSameEveryTime) {
  Random random(5);
  const Lights lights = someLights(40000, random);
  const LightClusters once = buildLightClusters(lights), again = buildLightClusters(lights);
  EXPECT_TRUE(once.rows == again.rows);
  EXPECT_TRUE(once.light_rows == again.light_rows);
}

}  // namespace
}  // namespace luciole::test
