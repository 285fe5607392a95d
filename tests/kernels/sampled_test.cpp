#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/sampled/sampled_light.h"
#include "lights/light_clusters.hpp"

// The parts of kernels/sampled, one by one: how a stratum is halved, and how its lights are picked.
namespace luciole::test {
namespace {

/// A tree of random lights around the origin, as the kernels read it.
struct SampledTree {
  std::vector<UnboundedLight> lights;   ///< in the tree's order
  std::vector<std::size_t> slot_light;  ///< the light in a slot, or lights.size()
  std::vector<float> rows, light_rows, lobes;
  std::vector<glm::dvec3> axis;  ///< of each of `lights`: the way it shines, or 0
  std::vector<uint> size;        ///< the number of lights, and of levels
  unsigned levels() const { return size[1]; }
  std::size_t begin(unsigned level, std::size_t node) const {
    return clusterBegin(lights.size(), level, node);
  }
};

/// decades: how far apart intensities are, at most. with_lobes: half of the lights are cosine lobes.
SampledTree sampledTree(std::size_t count, double decades, Random& random, bool with_lobes = false) {
  std::vector<UnboundedLight> lights;
  for (std::size_t i = 0; i < count; ++i)
    lights.push_back({{random.between(-4, 4), random.between(-4, 4), random.between(-1, 5)},
                      glm::dvec3(std::pow(10.0, random.between(-decades / 2, decades / 2))),
                      1});
  const LightClusters clusters = buildLightClusters(lights);
  SampledTree tree;
  for (const std::uint32_t light : clusters.order) tree.lights.push_back(lights[light]);
  tree.slot_light.assign(kLeafLights << clusters.levels, count);
  tree.axis.resize(count);
  tree.lobes.resize(clusters.light_rows.size() / kLightFields * kLobeFields);
  forEachSlot(clusters, [&](std::size_t slot, std::size_t i) {
    tree.slot_light[slot] = i;
    if (with_lobes && random.chance(0.5)) tree.axis[i] = random.direction();
    float* lobe = &tree.lobes[slot / kClusterSlots * kLobeFields * kClusterSlots + slot % kClusterSlots];
    for (int k = 0; k < 3; ++k) lobe[std::size_t(k) * kClusterSlots] = float(tree.axis[i][k]);
    lobe[std::size_t(kLobeRound) * kClusterSlots] = tree.axis[i] == glm::dvec3(0.0) ? 1.0f : 0.0f;
  });
  tree.rows.assign(clusters.rows.begin(), clusters.rows.end());
  tree.light_rows.assign(clusters.light_rows.begin(), clusters.light_rows.end());
  tree.size = {uint(count), clusters.levels};
  return tree;
}

/// What bounds a group of pixels around the origin that face +z. The columns of sampled_probe.cl's
/// bounds_of().
struct ProbedGroup {
  float radius = 0.1f, spread = 0, thickness = 0, specular = 0;
  std::uint32_t model = kPhongModel;
  std::vector<float> columns() const {
    return {0,    0,       0, 0, 0, 1, 0.6f, 0, 0.8f, radius, spread, thickness, 0.1f, 20, float(model),
            0.7f, specular};
  }
};

/// Which all lights are above.
constexpr ProbedGroup kSeesAll{.spread = 2};

/// A stratum that picks its lights by a seed. used: bits of the picks that are.
struct PickCase {
  ProbedGroup group;
  unsigned level = 0;
  std::size_t node = 0;
  unsigned seed = 0;
  std::uint32_t used = 0xffffffff;
};

/// The picks of a case: numbers of lights in the tree's order, or their number without one.
struct PickedLights {
  std::array<std::size_t, 2 * kPicks> light{};
  std::array<float, 2 * kPicks> weight{};
};

std::vector<PickedLights> probePicks(int lanes, const SampledTree& tree, const std::vector<PickCase>& cases) {
  std::vector<Column> in;
  for (const PickCase& each : cases) {
    std::vector<float> of_case = each.group.columns();
    for (const float value : {float(each.level), float(each.node), float(each.seed),
                              float(each.used & 0xffff), float(each.used >> 16)})
      of_case.push_back(value);
    in.resize(of_case.size());
    for (std::size_t column = 0; column < in.size(); ++column) in[column].push_back(of_case[column]);
  }
  const std::vector<Column> out = probe(
      deviceWithLanes(lanes), "sampled_probe.cl", "probe_picks", in, 4 * kPicks,
      {{"rows", tree.rows}, {"light_rows", tree.light_rows}, {"lobes", tree.lobes}, {"size", tree.size}});
  std::vector<PickedLights> picked(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t k = 0; k < 2 * kPicks; ++k) {
      const float slot = out[k][i];
      picked[i].light[k] = slot < 0 ? tree.lights.size() : tree.slot_light.at(std::size_t(slot));
      picked[i].weight[k] = out[2 * kPicks + k][i];
    }
  return picked;
}

/// What a light gives the group's middle.
double lightAtMiddle(const UnboundedLight& light) {
  const double d2 = glm::dot(light.position, light.position);
  return light.color.x * std::max(light.position.z, 0.0) / (d2 * std::sqrt(d2));
}

// A pixel's value of a half is one pick's weight times what its light gives. So the mean over a half's picks
// is that over the pixels of a group, and both halves' together is, on average, the sum over the stratum.
TEST(SampledKernels, PicksGiveTheSumOfTheirStratumOnAverage) {
  constexpr unsigned kSeeds = 512;
  Random random(1);
  for (const std::size_t count : {3, 9, 40, 300})
    for (const double decades : {0.0, 6.0}) {
      const SampledTree tree = sampledTree(count, decades, random);
      // Some lights are hidden, and the rest partly.
      std::vector<double> value;
      for (const UnboundedLight& light : tree.lights)
        value.push_back(random.chance(0.5) ? random.between(0, 1) * lightAtMiddle(light) : 0.0);
      std::vector<PickCase> cases;
      for (const ProbedGroup& group :
           {ProbedGroup{}, ProbedGroup{.spread = 0.1f, .specular = 0.5f},
            ProbedGroup{.radius = 0.5f, .specular = 0.5f, .model = kBlinnPhongModel}})
        for (unsigned level = 0; level < tree.levels() + 2; ++level)
          for (unsigned seed = 0; seed < kSeeds; ++seed)
            cases.push_back({group, level, (std::size_t(1) << level) - 1, seed});
      for (const int lanes : kAllLanes) {
        const std::vector<PickedLights> picked = probePicks(lanes, tree, cases);
        for (std::size_t first = 0; first < cases.size(); first += kSeeds) {
          const auto& [group, level, node, seed, used] = cases[first];
          const std::size_t begin = tree.begin(level, node), end = tree.begin(level, node + 1);
          double sum = 0, squares = 0, truth = 0;
          for (std::size_t i = begin; i < end; ++i) truth += value[i];
          for (std::size_t i = first; i < first + kSeeds; ++i) {
            double estimate = 0;
            for (std::size_t k = 0; k < 2 * kPicks; ++k) {
              const std::size_t light = picked[i].light[k];
              if (light == count) continue;
              ASSERT_TRUE(light >= begin && light < end) << light;
              estimate += double(picked[i].weight[k]) * value[light] / double(kPicks);
            }
            sum += estimate;
            squares += estimate * estimate;
          }
          const double mean = sum / kSeeds,
                       deviation = std::sqrt(std::max(squares / kSeeds - mean * mean, 0.0));
          EXPECT_NEAR(mean, truth, 5 * deviation / std::sqrt(double(kSeeds)) + 1e-5 * truth)
              << count << " lights, " << decades << " decades, level " << level << ", " << lanes << " lanes";
        }
      }
    }
}

TEST(SampledKernels, WeightsAreThoseOfProbabilitiesThatAddUpToOne) {
  Random random(2);
  for (const std::size_t count : {1, 2, 7, 40}) {
    const SampledTree tree = sampledTree(count, 0.5, random);
    std::vector<PickCase> cases;
    for (unsigned seed = 0; seed < 512; ++seed) cases.push_back({kSeesAll, 0, 0, seed});
    for (const int lanes : kAllLanes) {
      std::map<std::size_t, float> weights;
      std::map<std::size_t, double> picks;
      for (const PickedLights& picked : probePicks(lanes, tree, cases))
        for (std::size_t k = 0; k < 2 * kPicks; ++k) {
          ASSERT_LT(picked.light[k], count);
          const auto [at, is_new] = weights.emplace(picked.light[k], picked.weight[k]);
          ASSERT_TRUE(is_new || at->second == picked.weight[k]) << "a light has one probability";
          picks[picked.light[k]] += 1.0 / double(cases.size());
        }
      double sum = 0;
      for (const auto& [light, weight] : weights) {
        const double probability = 0.5 / double(weight);
        sum += probability;
        // It is picked so often: of each seed's within 1, and so their mean within 5 deviations.
        EXPECT_NEAR(picks[light], 2 * kPicks * probability, 5 * 0.5 / std::sqrt(double(cases.size())));
      }
      EXPECT_EQ(weights.size(), count);
      EXPECT_NEAR(sum, 1, 1e-5) << count << " lights, " << lanes << " lanes";
    }
  }
}

TEST(SampledKernels, PicksDontDependOnWhichAreUsedNorOnLanes) {
  Random random(3);
  const SampledTree tree = sampledTree(300, 3, random);
  std::vector<PickCase> all, some;
  for (unsigned seed = 0; seed < 128; ++seed) {
    const unsigned level = unsigned(random.below(int(tree.levels()) + 2));
    all.push_back({ProbedGroup{.specular = 0.5f}, level, std::size_t(random.below(1 << level)), seed});
    some.push_back(all.back());
    some.back().used = std::uint32_t(random.below(1 << 16)) << 16 | std::uint32_t(random.below(1 << 16));
  }
  const std::vector<PickedLights> first = probePicks(1, tree, all);
  for (const int lanes : kAllLanes) {
    const std::vector<PickedLights> whole = probePicks(lanes, tree, all),
                                    part = probePicks(lanes, tree, some);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(whole[i].light, first[i].light) << lanes << " lanes";
      EXPECT_EQ(whole[i].weight, first[i].weight) << lanes << " lanes";
      for (std::size_t k = 0; k < 2 * kPicks; ++k) {
        const bool is_used = (some[i].used >> k & 1) != 0;
        ASSERT_EQ(part[i].light[k], is_used ? whole[i].light[k] : tree.lights.size());
        if (is_used) {
          ASSERT_EQ(part[i].weight[k], whole[i].weight[k]);
        }
      }
    }
  }
}

/// A pixel of a group, or one that may be.
struct GroupPixel {
  glm::dvec3 position, normal;
};

GroupPixel randomPixel(const ProbedGroup& group, Random& random) {
  const double angle = random.between(0, 6.283), tilt = random.between(0, 6.283);
  // A normal whose chord to +z is at most the spread.
  const double chord = random.chance(0.5) ? group.spread : random.between(0, group.spread);
  const double z = 1 - chord * chord / 2, across = std::sqrt(std::max(1 - z * z, 0.0));
  GroupPixel pixel{{}, {across * std::cos(tilt), across * std::sin(tilt), z}};
  const glm::dvec3 out(std::cos(angle), std::sin(angle), 0);
  const glm::dvec3 along = out - glm::dot(out, pixel.normal) * pixel.normal;
  pixel.position = 0.99 * double(group.radius) * glm::normalize(along);
  return pixel;
}

/// Whether any of some pixels sees a light above it, which shines along an axis, or with 0 all ways.
bool isAboveAPixel(const ProbedGroup& group, const UnboundedLight& light, Random& random,
                   const glm::dvec3& axis = glm::dvec3(0.0)) {
  for (int i = 0; i < 100; ++i) {
    const GroupPixel pixel = randomPixel(group, random);
    const glm::dvec3 way = light.position - pixel.position;
    const double least = 1e-5 * glm::length(way);
    const bool shines_there = axis == glm::dvec3(0.0) || -glm::dot(way, axis) > least;
    if (glm::dot(way, pixel.normal) > least && shines_there) return true;
  }
  return false;
}

// Else what it gives is missed by every seed.
TEST(SampledKernels, EachLightThatAPixelOfTheGroupMaySeeCanBePicked) {
  Random random(4);
  const SampledTree tree = sampledTree(300, 3, random, true);
  const unsigned single = tree.levels() + 3;
  std::vector<PickCase> cases;
  for (std::size_t node = 0; node < std::size_t(1) << single; ++node)
    if (tree.begin(single, node + 1) - tree.begin(single, node) == 1)
      for (const float radius : {0.0f, 0.3f, 1.0f})
        cases.push_back(
            {ProbedGroup{.radius = radius, .spread = random.chance(0.5) ? 0.12f : 0.0f}, single, node});
  for (const int lanes : kAllLanes) {
    const std::vector<PickedLights> picked = probePicks(lanes, tree, cases);
    std::size_t seen = 0, unseen = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const std::size_t light = tree.begin(single, cases[i].node);
      (picked[i].light[0] == light ? seen : unseen) += 1;
      if (!isAboveAPixel(cases[i].group, tree.lights[light], random, tree.axis[light])) continue;
      for (std::size_t k = 0; k < 2 * kPicks; ++k) {
        ASSERT_EQ(picked[i].light[k], light) << "height " << tree.lights[light].position.z;
        ASSERT_EQ(picked[i].weight[k], 0.5f) << "the only light of its stratum is sure";
      }
    }
    EXPECT_GT(seen, 300u);
    EXPECT_GT(unseen, 50u);
  }
}

TEST(SampledKernels, PicksAreSharedOutByWeight) {
  Random random(5);
  std::vector<Column> in(kClusterSlots + 3);
  for (int i = 0; i < 2000; ++i) {
    const bool mixed = random.chance(0.5);
    for (std::size_t slot = 0; slot < kClusterSlots; ++slot)
      in[slot].push_back(random.chance(0.3) ? 0.0f
                                            : float(mixed ? std::pow(10.0, random.between(-20, 29))
                                                          : random.between(0.5, 1)));
    in[kClusterSlots].push_back(float(1 + random.below(kClusterSlots)));
    in[kClusterSlots + 1].push_back(float(1 + random.below(2 * kPicks)));
    in[kClusterSlots + 2].push_back(i % 3 == 0   ? 0.0f
                                    : i % 3 == 1 ? 0x1.fffffep-1f
                                                 : float(random.between(0, 1)));
  }
  for (const int lanes : kAllLanes) {
    const std::vector<Column> out =
        probe(deviceWithLanes(lanes), "sampled_probe.cl", "probe_share_out", in, kClusterSlots + 2);
    for (std::size_t i = 0; i < in[0].size(); ++i) {
      const auto slots = std::size_t(in[kClusterSlots][i]);
      const float count = in[kClusterSlots + 1][i];
      double sum = 0;
      for (std::size_t slot = 0; slot < slots; ++slot) sum += double(in[slot][i]);
      EXPECT_NEAR(out[kClusterSlots + 1][i], sum, 1e-6 * sum);
      ASSERT_EQ(out[0][i], 0);
      ASSERT_EQ(out[slots][i], sum > 0 ? count : 0);
      for (std::size_t slot = 0; slot < slots && sum > 0; ++slot) {
        const double share = double(count) * double(in[slot][i]) / sum,
                     taken = out[slot + 1][i] - out[slot][i];
        ASSERT_GE(taken, 0);
        ASSERT_TRUE(share > 0 || taken == 0);
        // By systematic sampling fewer than 1 more or less; an end that rounding moves gives or takes 1.
        ASSERT_LT(std::abs(taken - share), 1.001) << slot << " of " << slots;
      }
    }
  }
}

/// Strata after so many halvings.
struct ProbedCut {
  std::vector<Stratum> strata;
  std::vector<uint> heap, order;
  uint cost = 0;
};

ProbedCut probeCut(int lanes, const SampledTree& tree, const ProbedGroup& group, uint halves) {
  constexpr std::size_t kPlaces = sizeof(Stratum) / sizeof(float);
  // A column has room for so many cases.
  constexpr std::size_t kCases = 16;
  std::vector<Column> in;
  for (const float value : group.columns()) in.push_back(Column(kCases, value));
  const std::vector<uint> asked{halves};
  const std::vector<Column> out = probe(deviceWithLanes(lanes), "sampled_probe.cl", "probe_cut", in,
                                        (kPlaces + 3) * kMostStrata / kCases + 1,
                                        {{"rows", tree.rows},
                                         {"light_rows", tree.light_rows},
                                         {"lobes", tree.lobes},
                                         {"size", tree.size},
                                         {"halves", asked}});
  std::vector<float> flat;
  for (const Column& column : out) flat.insert(flat.end(), column.begin(), column.end());
  const float* places = flat.data() + kPlaces * kMostStrata;
  const float* counts = places + 3 * kMostStrata;
  ProbedCut cut;
  const auto take = [](const float* from, auto& to) {
    if (!to.empty()) std::memcpy(to.data(), from, to.size() * sizeof(to[0]));
  };
  cut.strata.resize(std::bit_cast<uint>(counts[0]));
  cut.heap.resize(std::bit_cast<uint>(counts[1]));
  cut.order.resize(std::bit_cast<uint>(counts[2]));
  cut.cost = std::bit_cast<uint>(counts[3]);
  take(flat.data(), cut.strata);
  take(places, cut.heap);
  take(places + kMostStrata, cut.order);
  return cut;
}

TEST(SampledKernels, StrataHoldEachLightOnceHoweverTheyAreHalved) {
  Random random(6);
  for (const std::size_t count : {1, 2, 3, 8, 9, 17, 100, 1000}) {
    const SampledTree tree = sampledTree(count, 6, random);
    for (const int lanes : kAllLanes)
      for (const uint halves : {0u, 1u, 2u, 7u, 60u, 5000u}) {
        const ProbedCut cut = probeCut(lanes, tree, kSeesAll, halves);
        std::vector<bool> held(count);
        uint cost = 0;
        std::vector<uint> large;
        for (uint i = 0; i < cut.strata.size(); ++i) {
          const Stratum& stratum = cut.strata[i];
          ASSERT_GT(stratum.lights, 0u);
          ASSERT_EQ(stratum.first, tree.begin(stratum.level, stratum.node));
          ASSERT_EQ(stratum.first + stratum.lights, tree.begin(stratum.level, stratum.node + 1));
          for (uint light = stratum.first; light < stratum.first + stratum.lights; ++light) {
            ASSERT_FALSE(held[light]);
            held[light] = true;
          }
          cost += stratum.lights == 1 ? 1 : 2;
          if (stratum.lights > 2) large.push_back(i);
        }
        EXPECT_TRUE(std::all_of(held.begin(), held.end(), [](bool it) { return it; })) << count;
        EXPECT_EQ(cut.cost, cost);
        EXPECT_TRUE(halves < 5000u || large.empty()) << "whatever has more than two lights can be halved";
        // The heap holds those that can be halved; the largest is at its top.
        std::vector<uint> heap = cut.heap;
        for (const uint number : heap) EXPECT_GE(cut.strata[heap[0]].key, cut.strata[number].key);
        std::sort(heap.begin(), heap.end());
        EXPECT_EQ(heap, large);
        EXPECT_EQ(cut.order.size(), cut.strata.size());
        for (std::size_t i = 1; i < cut.order.size(); ++i)
          EXPECT_LT(cut.strata[cut.order[i - 1]].first, cut.strata[cut.order[i]].first);
      }
  }
}

TEST(SampledKernels, OnlyLightsBelowEveryHorizonAreLeftOut) {
  Random random(7);
  const SampledTree tree = sampledTree(1000, 3, random);
  for (const ProbedGroup& group : {ProbedGroup{.radius = 0}, ProbedGroup{.radius = 0.5f, .spread = 0.12f}})
    for (const int lanes : kAllLanes) {
      std::vector<bool> held(tree.lights.size());
      for (const Stratum& stratum : probeCut(lanes, tree, group, 5000).strata)
        for (uint light = stratum.first; light < stratum.first + stratum.lights; ++light) held[light] = true;
      std::size_t out = 0;
      for (std::size_t i = 0; i < held.size(); ++i) {
        if (held[i]) continue;
        ++out;
        EXPECT_FALSE(isAboveAPixel(group, tree.lights[i], random)) << tree.lights[i].position.z;
      }
      EXPECT_GT(out, 50u);
    }
}

TEST(SampledKernels, SumsOfPixelsAreTheSameAtEveryWidth) {
  Random random(8);
  std::vector<Column> in(kSampledPixels);
  for (int i = 0; i < 200; ++i)
    for (Column& column : in) column.push_back(float(std::pow(10.0, random.between(-6, 6))));
  Column truth;
  for (std::size_t i = 0; i < in[0].size(); ++i) {
    std::vector<float> values;
    for (const Column& column : in) values.push_back(column[i]);
    for (std::size_t step = values.size() / 2; step > 0; step /= 2)
      for (std::size_t k = 0; k < step; ++k) values[k] += values[k + step];
    truth.push_back(values[0]);
  }
  for (const int lanes : kAllLanes)
    EXPECT_EQ(probe(deviceWithLanes(lanes), "sampled_probe.cl", "probe_sum_of_pixels", in, 1)[0], truth);
}

TEST(SampledKernels, NeighboursTakeDifferentPicks) {
  Column places(kSampledPixels);
  std::iota(places.begin(), places.end(), 0.0f);
  for (const int lanes : kAllLanes) {
    const Column picks =
        probe(deviceWithLanes(lanes), "sampled_probe.cl", "probe_bayer_pick", {places}, 1)[0];
    for (std::size_t square = 0; square < picks.size(); square += kPicks) {
      Column sorted(picks.begin() + std::ptrdiff_t(square), picks.begin() + std::ptrdiff_t(square + kPicks));
      std::sort(sorted.begin(), sorted.end());
      EXPECT_EQ(sorted, Column(places.begin(), places.begin() + kPicks));
    }
  }
}

// M. Jarzynski and M. Olano's pcg4d, computed by their definition in Python.
TEST(SampledKernels, RandomNumbersAreThoseOfTheirDefinition) {
  const std::vector<Column> in{{0, 1, 65535}, {0, 2, 1}, {0, 3, 0}, {0, 4, 7}};
  const std::uint32_t hashes[3][4] = {{0x0f02f829, 0x2d568769, 0x32b0c43b, 0xd32548ea},
                                      {0x3622cd16, 0xf11471d8, 0xe1109b3f, 0x02b94c2f},
                                      {0x371e0538, 0xd2a1188d, 0xc422d32f, 0x1e18b2b1}};
  const float units[3] = {3547853 * 0x1p-24f, 282105 * 0x1p-24f, 7220411 * 0x1p-24f};
  for (const int lanes : kAllLanes) {
    const std::vector<Column> out = probe(deviceWithLanes(lanes), "sampled_probe.cl", "probe_random", in, 9);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 4; ++axis)
        EXPECT_EQ(std::uint32_t(out[2 * axis][i]) | std::uint32_t(out[2 * axis + 1][i]) << 16,
                  hashes[i][axis]);
      EXPECT_EQ(out[8][i], units[i]);
    }
  }
}

}  // namespace
}  // namespace luciole::test
