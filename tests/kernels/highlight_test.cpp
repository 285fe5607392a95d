#include <gtest/gtest.h>

#include <cmath>

#include "kernels/cluster_moments.hpp"
#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"

// The bounds of the clusters' highlights, piece by piece, against double precision.
namespace luciole::test {
namespace {

/// A cluster or a light, a group of pixels and one of them. All is rounded to floats but the lights' places
/// from the cluster's centre.
struct LobeCase {
  std::uint32_t model = kPhongModel;
  glm::vec3 centre{};
  std::vector<ClusterLight> lights;
  glm::vec3 middle{}, axis{0, 0, 1}, facing{0, 0, 1};
  float radius = 0, spread = 0, turn = 0, exponent = 1;
  glm::vec3 position{}, of_pixel{0, 0, 1}, normal{0, 0, 1};  ///< of_pixel: its axis
};

/// The first light of each case.
std::vector<float> firstLightRows(const std::vector<LobeCase>& cases) {
  std::vector<ClusterLight> lights;
  for (const LobeCase& each : cases)
    lights.push_back({glm::dvec3(each.centre) + each.lights[0].offset, each.lights[0].color});
  return lightRows(lights);
}

std::vector<float> lobeClusterRows(const std::vector<LobeCase>& cases) {
  std::vector<ClusterMoments> clusters;
  for (const LobeCase& each : cases) clusters.push_back(clusterMoments(each.centre, each.lights));
  return clusterRows(clusters);
}

struct LobesOut {
  Column value[3], bound, rounding, cosine, brightest, k, verdict;
};

LobesOut probeLobes(int lanes, const std::vector<LobeCase>& cases, bool of_lights) {
  std::vector<Column> in(20);
  for (const LobeCase& each : cases) {
    std::size_t column = 0;
    const auto add = [&](float value) { in[column++].push_back(value); };
    const auto addVector = [&](const glm::vec3& v) { add(v.x), add(v.y), add(v.z); };
    addVector(each.middle), addVector(each.axis), addVector(each.facing);
    add(each.radius), add(each.spread), add(each.turn), add(each.exponent), add(float(each.model));
    addVector(each.position), addVector(each.of_pixel);
  }
  const std::vector<float> rows = of_lights ? firstLightRows(cases) : lobeClusterRows(cases);
  const std::vector<uint> lights{of_lights ? 1u : 0u};
  std::vector<Column> out = probe(deviceWithLanes(lanes), "highlight_probe.cl", "probe_lobes", in, 9,
                                  {{"rows", rows}, {"of_lights", lights}});
  return {{out[0], out[1], out[2]}, out[3], out[4], out[5], out[6], out[7], out[8]};
}

/// The lobe's cosine for a light at v from the pixel.
double lobeCosine(const LobeCase& each, const glm::dvec3& v) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(each.of_pixel)), to_light = glm::normalize(v);
  if (each.model == kPhongModel) return glm::dot(axis, to_light);
  return glm::dot(glm::normalize(glm::dvec3(each.normal)), glm::normalize(axis + to_light));
}

glm::dvec3 wayToLight(const LobeCase& each, const ClusterLight& light) {
  return glm::dvec3(each.centre) + light.offset - glm::dvec3(each.position);
}

double lobeOf(const LobeCase& each, const glm::dvec3& v) {
  return std::pow(std::max(lobeCosine(each, v), 0.0), double(each.exponent)) / glm::dot(v, v);
}

/// `unit` turned by a chord, to some side.
glm::dvec3 turned(const glm::dvec3& unit, double chord, Random& random) {
  const glm::dvec3 side = glm::normalize(glm::cross(unit, random.direction()));
  const double cosine = 1 - chord * chord / 2;
  return cosine * unit + std::sqrt(std::max(1 - cosine * cosine, 0.0)) * side;
}

float roundedUp(double x) { return std::nextafter(float(x), INFINITY); }

/// A group and a cluster that reach as far as k says, the pixel and a light on their rims as often as inside.
/// off: the angle between the lobe's axis and the way to the cluster.
LobeCase randomCase(std::uint32_t model, double exponent, double k, double of_light, double turn, double off,
                    int lights, Random& random) {
  LobeCase each;
  each.model = model;
  each.exponent = float(exponent);
  const double d = std::pow(10.0, random.between(-1, 2));
  const auto within = [&] { return random.chance(0.5) ? 1.0 : random.between(0, 1); };
  each.middle = d * random.between(0, 1) * random.direction();
  each.centre = glm::dvec3(each.middle) + d * random.direction();
  const glm::dvec3 ahead = glm::dvec3(each.centre) - glm::dvec3(each.middle);
  const double distance = glm::length(ahead);
  const glm::dvec3 n = ahead / distance;
  // A third of the ways lean along the line between the middles, a third across it.
  const auto way = [&] {
    const int kind = random.below(3);
    if (kind == 0) return random.direction();
    if (kind == 1) return random.chance(0.5) ? n : -n;
    return glm::normalize(glm::cross(n, random.direction()));
  };
  for (int light = 0; light < lights; ++light)
    each.lights.push_back({of_light * k * distance * within() * way(), random.color()});
  const double reach = (1 - of_light) * k * distance;
  each.position = glm::dvec3(each.middle) + reach * within() * way();
  each.radius = roundedUp(glm::distance(glm::dvec3(each.position), glm::dvec3(each.middle)));
  each.axis = turned(n, 2 * std::sin(off / 2), random);
  each.of_pixel = turned(glm::normalize(glm::dvec3(each.axis)), turn, random);
  if (model == kBlinnPhongModel) {
    const glm::dvec3 half_vector = glm::normalize(n + glm::dvec3(each.axis));
    each.facing = turned(half_vector, 2 * std::sin(random.between(0, 0.8)), random);
    each.normal = turned(glm::normalize(glm::dvec3(each.facing)), turn * random.between(0, 1), random);
  }
  each.turn = roundedUp(glm::distance(glm::dvec3(each.of_pixel), glm::dvec3(each.axis)));
  each.spread = roundedUp(glm::distance(glm::dvec3(each.normal), glm::dvec3(each.facing)));
  return each;
}

constexpr double kExponents[] = {0, 0.5, 1, 3, 5, 12, 32, 128, 1000};

/// An angle off a lobe's axis where it falls off, or any.
double someAngle(double exponent, Random& random) {
  return random.chance(0.3) ? random.between(0, 3.14)
                            : std::min(random.between(0, 3) / std::sqrt(exponent + 1), 3.14);
}

class HighlightKernels : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lanes, HighlightKernels, testing::ValuesIn(kAllLanes),
                         testing::PrintToStringParamName());

// The axis of a lobe is turned and the light leans to its nearest: the cosine is reached but for what bounds
// of chords by sines and of sums of angles take, and it is never more.
void expectLobesBounded(int lanes, std::uint32_t model, double tight) {
  Random random(21);
  std::vector<LobeCase> cases;
  for (int i = 0; i < 6000; ++i) {
    const double exponent = kExponents[random.below(int(std::size(kExponents)))];
    cases.push_back(randomCase(model, exponent, std::pow(10.0, random.between(-2.5, -0.05)),
                               random.chance(0.3) ? 0 : random.between(0, 1),
                               std::pow(10.0, random.between(-4, -0.2)), someAngle(exponent, random),
                               1 + random.below(4), random));
  }
  for (const bool of_lights : {false, true}) {
    const LobesOut out = probeLobes(lanes, cases, of_lights);
    double nearest = 0, brightest = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      // Of a light's row it is the first alone, at the centre for the group's k.
      if (out.k[i] > 0.9f) continue;
      double given = 0;
      for (std::size_t light = 0; light < (of_lights ? 1 : cases[i].lights.size()); ++light) {
        const glm::dvec3 v = wayToLight(cases[i], cases[i].lights[light]);
        const double cosine = lobeCosine(cases[i], v);
        ASSERT_LE(cosine, out.cosine[i]) << "case " << i << ", lights " << of_lights;
        given = std::max(given, lobeOf(cases[i], v));
        if (out.cosine[i] < 0.99f)
          nearest = std::max(nearest, std::acos(double(out.cosine[i])) / std::acos(cosine));
      }
      ASSERT_LE(given, out.brightest[i]) << "case " << i << ", lights " << of_lights;
      brightest = std::max(brightest, given / out.brightest[i]);
    }
    EXPECT_GT(nearest, tight);
    EXPECT_GT(brightest, tight);
  }
}

TEST_P(HighlightKernels, KnowHowNearToPhongsLobeALightMayBe) {
  expectLobesBounded(GetParam(), kPhongModel, 0.9);
}

TEST_P(HighlightKernels, KnowHowNearToBlinnsLobeALightMayBe) {
  expectLobesBounded(GetParam(), kBlinnPhongModel, 0.99);
}

/// A light, and a pixel whose place and axis are off the series' own: by η/D = k·(cos α along the way to the
/// light, sin α across it, in the axis' plane), of which the light has `of_light`, and by a chord `turn`.
struct Direction {
  double exponent, sine, k, of_light, turn;
};

LobeCase inDirection(const Direction& of, double alpha, double sign, Random& random) {
  LobeCase each;
  each.exponent = float(of.exponent);
  each.centre = random.direction();
  const double d = glm::length(glm::dvec3(each.centre));
  const glm::dvec3 n = glm::dvec3(each.centre) / d,
                   across = glm::normalize(glm::cross(n, random.direction()));
  const auto axisAt = [&](double angle) { return std::cos(angle) * n + std::sin(angle) * across; };
  const glm::dvec3 off = of.k * d * axisAt(alpha);
  each.lights = {{of.of_light * off, glm::dvec3(1)}};
  each.position = (of.of_light - 1) * off;
  each.radius = roundedUp(glm::length(glm::dvec3(each.position)));
  each.axis = axisAt(std::asin(of.sine));
  each.of_pixel = axisAt(std::asin(of.sine) + sign * 2 * std::asin(of.turn / 2));
  each.turn = roundedUp(glm::distance(glm::dvec3(each.of_pixel), glm::dvec3(each.axis)));
  return each;
}

// Each term of the bound where it is the largest. What the bound of so small a group has to spare: the powers
// of D(1 − k), of the nearest cosine and of the largest sine, and where no direction reaches X and Y
// together. Real rounding is some hundredth of it, so the error is below the bound without what is counted as
// rounding.
TEST_P(HighlightKernels, SeriesIsAsFarOffAsItsBoundSaysInTheWorstDirection) {
  constexpr std::pair<Direction, double> kDirections[] = {
      // p₃S³, by each power of the light's extent, the group's and the axis' turn.
      {{64, 0.8, 0.001, 0, 0}, 0.9},
      {{64, 0.8, 0.001, 1.0 / 3, 0}, 0.9},
      {{64, 0.8, 0.001, 0.5, 0}, 0.9},
      {{64, 0.8, 0.001, 2.0 / 3, 0}, 0.9},
      {{64, 0.8, 0.001, 1, 0}, 0.9},
      {{64, 0.8, 0, 0, 0.001}, 0.9},
      {{64, 0.8, 0.0005, 0, 0.0005}, 0.9},
      // The sine of a turned axis, on the lobe's own; there the bound goes with the turn's third power, the
      // error
      // with its sixth.
      {{250, 0, 0, 0, 0.15}, 0.06},
      // 3p(p + 2)c²S; p(p − 1)S²; (p + 2)c²; and far beyond where the powers of 1 − k are 1.
      {{32, 0.08, 0.007, 0, 0}, 0.8},
      {{3, 0.92, 0.015, 0, 0}, 0.7},
      {{8, 0, 0.015, 0, 0}, 0.55},
      {{3, 0, 0.45, 0, 0}, 0.06},
  };
  Random random(24);
  for (const auto& [of, tight] : kDirections) {
    std::vector<LobeCase> cases;
    for (int i = 0; i < 96; ++i)
      for (const double sign : {-1.0, 1.0})
        cases.push_back(inDirection(of, i * (6.2831853 / 96), sign, random));
    const LobesOut out = probeLobes(GetParam(), cases, false);
    double worst = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const glm::dvec3 v = wayToLight(cases[i], cases[i].lights[0]);
      worst = std::max(worst, std::abs(out.value[0][i] - lobeOf(cases[i], v)) / out.bound[i]);
    }
    EXPECT_LE(worst, 1.0) << "exponent " << of.exponent << ", sine " << of.sine << ", k " << of.k;
    EXPECT_GE(worst, tight) << "exponent " << of.exponent << ", sine " << of.sine << ", k " << of.k;
  }
}

constexpr double kSeriesExponents[] = {3, 4, 8, 20, 64, 250, 1000};

TEST_P(HighlightKernels, SeriesIsWithinItsBoundOfTheTruth) {
  Random random(22);
  for (const double exponent : kSeriesExponents)
    for (const bool of_lights : {false, true}) {
      std::vector<LobeCase> cases;
      for (int i = 0; i < 3000; ++i) {
        // What matters is how far the group and the cluster reach, as a share of the lobe's width.
        const double k = std::min(std::pow(10.0, random.between(-2, 0.3)) / std::sqrt(exponent), 0.499);
        const double turn = std::pow(10.0, random.between(-2, 0.3)) / std::sqrt(exponent);
        const int kind = random.below(4);
        cases.push_back(randomCase(kPhongModel, exponent, kind == 0 ? 1e-4 : k,
                                   of_lights || kind == 1 ? 0 : random.between(0, 1),
                                   kind == 2 ? 1e-6 : std::min(turn, 1.0), someAngle(exponent, random),
                                   1 + random.below(3), random));
      }
      const LobesOut out = probeLobes(GetParam(), cases, of_lights);
      double worst = 0;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        if (out.k[i] > 0.5f) continue;
        glm::dvec3 truth(0.0);
        for (std::size_t light = 0; light < (of_lights ? 1 : cases[i].lights.size()); ++light)
          truth +=
              cases[i].lights[light].color * lobeOf(cases[i], wayToLight(cases[i], cases[i].lights[light]));
        for (int c = 0; c < 3; ++c) {
          const double error = std::abs(out.value[c][i] - truth[c]);
          ASSERT_LE(error, 1.001 * (out.bound[i] + out.rounding[i]))
              << "case " << i << ", exponent " << exponent << ", channel " << c << ", truth " << truth[c];
          worst = std::max(worst, (error - out.rounding[i]) / out.bound[i]);
        }
      }
      // What is counted as the rounding of the largest exponent's series is more than what the series leaves
      // out.
      if (exponent <= 250) {
        EXPECT_GT(worst, 0.1) << exponent << ", lights " << of_lights;
      }
    }
}

// Half of the lights that the series may take are cut by the horizon, as all ways are as likely.
TEST_P(HighlightKernels, SeriesTakesNoneThatMayBeBelowAHorizonAndNoneOfAFlatLobe) {
  Random random(25);
  for (const double exponent : {0.5, 1.0, 2.0, 2.9, 3.0, 20.0})
    for (const bool of_lights : {false, true}) {
      std::vector<LobeCase> cases;
      for (int i = 0; i < 3000; ++i)
        cases.push_back(randomCase(kPhongModel, exponent, std::pow(10.0, random.between(-2, -0.31)),
                                   of_lights ? 0 : random.between(0, 1), 1e-3, random.between(0, 3.14), 3,
                                   random));
      const LobesOut out = probeLobes(GetParam(), cases, of_lights);
      std::size_t taken = 0, below = 0;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        taken += out.verdict[i] == 2;
        below += out.verdict[i] == 1;
        for (std::size_t light = 0; light < (of_lights ? 1 : cases[i].lights.size()); ++light) {
          const double z =
              glm::dot(wayToLight(cases[i], cases[i].lights[light]), glm::dvec3(cases[i].normal));
          EXPECT_FALSE(out.verdict[i] == 2 && z <= 0) << "case " << i << ", lights " << of_lights;
          EXPECT_FALSE(out.verdict[i] == 1 && z > 0) << "case " << i << ", lights " << of_lights;
        }
      }
      EXPECT_EQ(taken > 500, exponent >= 3) << exponent << ", " << taken;
      EXPECT_EQ(taken > 0, exponent >= 3) << exponent;
      EXPECT_GT(below, 500u);
    }
}

// A light's own rounding, in units of 2⁻²⁴, and that of a block and of the total: LIGHT_ROUNDING in
// clustered_light.cl.
constexpr double kOfLights = (32 + 128 + 4) * 0x1p-24;

/// The light of each case, listed `times` times, as probe_listed_highlights gives it.
std::vector<Column> probeListed(int lanes, const std::vector<Column>& in, const std::vector<LobeCase>& cases,
                                uint times) {
  const std::vector<float> rows = firstLightRows(cases);
  const std::vector<uint> listed{times};
  return probe(deviceWithLanes(lanes), "highlight_probe.cl", "probe_listed_highlights", in, 6,
               {{"light_rows", rows}, {"times", listed}});
}

TEST_P(HighlightKernels, ListedLightsAreWithinTheirRoundingOfTheTruth) {
  Random random(23);
  constexpr double kListedExponents[] = {0, 0.5, 1, 1.5, 2, 4, 32, 1000, 1e6};
  constexpr int kKinds = 5;
  std::vector<LobeCase> cases;
  std::vector<glm::vec3> eyes;
  for (int i = 0; i < 18000; ++i) {
    LobeCase each;
    each.model = i % 2 == 0 ? kPhongModel : kBlinnPhongModel;
    const double exponent = kListedExponents[i / 2 % std::size(kListedExponents)];
    each.exponent = float(exponent);
    each.position = 10.0 * random.direction();
    const glm::dvec3 normal = random.direction(),
                     level = glm::normalize(glm::cross(normal, random.direction()));
    const double graze = std::pow(10.0, random.between(-9, -1));
    // Anywhere; near the lobe's axis; near the horizon; grazing on both sides, where L + V is near 0; and
    // grazing on one side, where the half vector is, too.
    const int kind = i / (2 * int(std::size(kListedExponents))) % kKinds;
    glm::dvec3 eye = random.direction();
    if (glm::dot(eye, normal) < 0 && random.chance(0.9)) eye = -eye;
    if (kind == 3) eye = glm::normalize(-level + graze * random.between(0, 2) * normal);
    const double near = std::pow(10.0, random.between(-7, 0.5)) / std::sqrt(exponent + 1);
    glm::dvec3 to_light = random.direction();
    if (kind == 1) to_light = turned(2 * glm::dot(normal, eye) * normal - eye, std::min(near, 2.0), random);
    if (kind == 2) to_light = glm::normalize(level + random.between(-1, 1) * graze * normal);
    if (kind == 3)
      to_light = glm::normalize(level + graze * random.between(0, 2) * normal + graze * random.direction());
    if (kind == 4) {
      eye = glm::normalize(level + graze * random.between(-1, 1) * normal);
      to_light = glm::normalize(level + random.between(-1, 1) * glm::cross(level, normal) +
                                graze * random.between(0, 1) * normal);
    }
    each.normal = normal;
    eyes.emplace_back(eye);
    each.centre = each.position;
    each.lights = {{std::pow(10.0, random.between(-2, 2)) * to_light, random.color()}};
    cases.push_back(each);
  }
  std::vector<Column> in(11);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      in[std::size_t(c)].push_back(cases[i].position[c]);
      in[3 + std::size_t(c)].push_back(cases[i].normal[c]);
      in[6 + std::size_t(c)].push_back(eyes[i][c]);
    }
    in[9].push_back(cases[i].exponent);
    in[10].push_back(float(cases[i].model));
  }
  const std::vector<Column> out = probeListed(GetParam(), in, cases, 1);
  // More than two blocks of sums.
  const std::vector<Column> often = probeListed(GetParam(), in, cases, 300);
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t column = 0; column < 5; ++column)
      ASSERT_NEAR(often[column][i], 300.0 * out[column][i], 1e-4 * 300 * out[column][i]) << column;
  double worst[std::size(kListedExponents)][2]{};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    LobeCase each = cases[i];
    const glm::dvec3 normal = glm::normalize(glm::dvec3(each.normal)),
                     eye = glm::normalize(glm::dvec3(eyes[i]));
    const glm::dvec3 v = wayToLight(each, each.lights[0]), to_light = glm::normalize(v);
    const bool phong = each.model == kPhongModel;
    const glm::dvec3 mirrored = 2 * glm::dot(normal, eye) * normal - eye;
    const double cosine =
        phong ? glm::dot(mirrored, to_light) : glm::dot(normal, glm::normalize(eye + to_light));
    const double lobe =
        glm::dot(normal, to_light) > 0 ? std::pow(std::max(cosine, 0.0), double(each.exponent)) : 0;
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(out[std::size_t(c)][i] - lobe / glm::dot(v, v) * each.lights[0].color[c]);
      const double of_lobe = out[4][i];
      const double other = kOfLights * out[std::size_t(c)][i] + out[3][i];
      ASSERT_LE(error, 1.001 * (other + of_lobe))
          << "case " << i << ", model " << each.model << ", exponent " << each.exponent << ", cosine "
          << cosine << ", N·L " << glm::dot(normal, to_light) << ", d² " << glm::dot(v, v);
      double& share = worst[i / 2 % std::size(kListedExponents)][i % 2];
      share = std::max(share, (error - other) / of_lobe);
    }
  }
  // Of Blinn's lobe the bound is reached where L + V is all but 0.
  for (std::size_t i = 4; i < std::size(kListedExponents) - 1; ++i)
    EXPECT_GT(worst[i][1], 0.9) << kListedExponents[i];
}

/// The largest of f on (0, most).
template <class Function>
double largest(double most, Function f) {
  double best = 0;
  for (int i = 0; i < 200'000; ++i) best = std::max(best, f(most * std::pow(i / 200'000.0, 3)));
  return best;
}

// What is counted at lobe_rounding(), with slopes that are searched for instead of bounded.
TEST_P(HighlightKernels, CountTheRoundingOfLobes) {
  constexpr double kUnit = 0x1p-24;
  const std::vector<double> exponents{0.5, 1, 1.5, 2, 3, 4, 5, 8, 12, 32, 100, 1000, 1e6, 1e12};
  std::vector<Column> in(11);
  std::vector<LobeCase> cases;
  for (const double exponent : exponents)
    for (const std::uint32_t model : {kPhongModel, kBlinnPhongModel}) {
      const float row[11] = {0, 0, 0, 0, 0, 1, 0, 0, 1, float(exponent), float(model)};
      for (std::size_t i = 0; i < 11; ++i) in[i].push_back(row[i]);
      LobeCase each;
      each.centre = {0, 0, 1};
      each.lights = {{glm::dvec3(0), glm::dvec3(1)}};
      cases.push_back(each);
    }
  const Column counted = probeListed(GetParam(), in, cases, 1)[5];
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    const double p = exponents[i], phong = counted[2 * i], blinn = counted[2 * i + 1];
    // A lobe's slopes by the chord, by a relative error of its square, by the half vector's angle and by a
    // relative error of its sine's square: from p = 4 on over the root of the lobe.
    const double rest = (p >= 4 ? p / 2 : p) - 1;
    const double by_chord =
        largest(std::sqrt(2), [&](double x) { return p * x * std::pow(1 - x * x / 2, rest); });
    const double by_square = largest(1, [&](double x) { return p * x * std::pow(1 - x, rest); });
    const double by_angle =
        largest(M_PI / 2, [&](double x) { return p * std::sin(x) * std::pow(std::cos(x), rest); });
    const double by_sine = largest(1, [&](double x) { return p / 2 * x * std::pow(1 - x, (rest - 1) / 2); });
    const double of_phong = kUnit * (15 * by_chord + 35 * by_square + 9) + 450 * p * kUnit * kUnit,
                 of_blinn = kUnit * (40 * by_angle + 2 * (13 * by_sine + 9));
    if (p >= 1) {
      EXPECT_GE(phong, of_phong) << p;
    }
    if (p >= 2) {
      EXPECT_GE(blinn, of_blinn) << p;
    }
    if (p >= 4) {
      EXPECT_LE(phong, 1.3 * of_phong) << p;
      EXPECT_LE(blinn, 1.2 * of_blinn) << p;
    }
    if (p < 1) {
      EXPECT_GE(blinn, 2 * (std::pow(13 * kUnit, p / 2) + std::pow(42 * kUnit, p))) << p;
      EXPECT_GE(phong, std::pow(61 * kUnit, p) + 9 * kUnit) << p;
    }
  }
}

}  // namespace
}  // namespace luciole::test
