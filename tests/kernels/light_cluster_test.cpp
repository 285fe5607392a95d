#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kernels/cluster_moments.hpp"
#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"

// The bounds of the clusters' light, piece by piece: that they hold, and that they hold where they are tight,
// so that no piece can be smaller.
namespace luciole::test {
namespace {

/// A cluster, a group of pixels and one of them. All is rounded to floats but the lights' places from the
/// cluster's centre.
struct Case {
  glm::vec3 centre{};
  std::vector<ClusterLight> lights;
  glm::vec3 middle{}, facing{0, 0, 1};
  float radius = 0, spread = 0, thickness = 0;
  glm::vec3 position{}, normal{0, 0, 1};
};

struct Columns {
  std::vector<Column> in{15};
  std::vector<float> rows;
};

Columns columnsOf(const std::vector<Case>& cases) {
  Columns columns;
  std::vector<ClusterMoments> clusters;
  for (const Case& each : cases) {
    const float values[15] = {each.middle.x,  each.middle.y,   each.middle.z,   each.facing.x,
                              each.facing.y,  each.facing.z,   each.radius,     each.spread,
                              each.thickness, each.position.x, each.position.y, each.position.z,
                              each.normal.x,  each.normal.y,   each.normal.z};
    for (std::size_t i = 0; i < 15; ++i) columns.in[i].push_back(values[i]);
    clusters.push_back(clusterMoments(each.centre, each.lights));
  }
  columns.rows = clusterRows(clusters);
  return columns;
}

std::vector<Column> probeFar(int lanes, const std::vector<Case>& cases) {
  const Columns columns = columnsOf(cases);
  return probe(deviceWithLanes(lanes), "light_cluster_probe.cl", "probe_far_cluster", columns.in, 7,
               {{"rows", columns.rows}});
}

/// Of the first light of each case.
std::vector<Column> probeFarLight(int lanes, const std::vector<Case>& cases) {
  std::vector<ClusterLight> lights;
  for (const Case& each : cases)
    lights.push_back({glm::dvec3(each.centre) + each.lights[0].offset, each.lights[0].color});
  const std::vector<float> rows = lightRows(lights);
  return probe(deviceWithLanes(lanes), "light_cluster_probe.cl", "probe_far_light", columnsOf(cases).in, 7,
               {{"light_rows", rows}});
}

std::vector<Column> probeCut(int lanes, const std::vector<Case>& cases) {
  const Columns columns = columnsOf(cases);
  return probe(deviceWithLanes(lanes), "light_cluster_probe.cl", "probe_cut_cluster", columns.in, 6,
               {{"rows", columns.rows}});
}

glm::dvec3 toLight(const Case& each, const ClusterLight& light) {
  return glm::dvec3(each.centre) + light.offset - glm::dvec3(each.position);
}

/// Σ q·N·v/|v|³.
glm::dvec3 farTruth(const Case& each) {
  glm::dvec3 sum(0.0);
  for (const ClusterLight& light : each.lights) {
    const glm::dvec3 v = toLight(each, light);
    sum += light.color * (glm::dot(glm::dvec3(each.normal), v) / std::pow(glm::length(v), 3));
  }
  return sum;
}

/// ½Σ q·|N·v|/|v|³.
glm::dvec3 cutTruth(const Case& each) {
  glm::dvec3 sum(0.0);
  for (const ClusterLight& light : each.lights) {
    const glm::dvec3 v = toLight(each, light);
    sum += light.color * (0.5 * std::abs(glm::dot(glm::dvec3(each.normal), v)) / std::pow(glm::length(v), 3));
  }
  return sum;
}

/// By what clustered_light.cl makes a bound larger for the bound's own rounding.
constexpr double kBoundRounding = 1.001;

/// The series of each case is within its bound of the truth. tight: how much of the bound the error is at
/// least, but for rounding. of_light: the series of its first light as a light, which joins it.
void expectFarCertified(const std::vector<Case>& cases, double tight = 0, bool of_light = false) {
  for (const int lanes : kAllLanes) {
    const std::vector<Column> out = of_light ? probeFarLight(lanes, cases) : probeFar(lanes, cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const glm::dvec3 truth = farTruth(cases[i]);
      if (of_light) {
        ASSERT_EQ(out[6][i], 2) << "case " << i << " is listed, or dark";
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const double error = std::abs(out[c][i] - truth[int(c)]);
        ASSERT_LE(error, kBoundRounding * out[3][i] + out[4][i])
            << "case " << i << ", channel " << c << ", " << lanes << " lanes, truth " << truth[int(c)];
        ASSERT_GE(error, tight * out[3][i] - out[4][i]) << "case " << i << ", " << lanes << " lanes";
      }
    }
  }
}

// A light and a pixel on the line between the middles, towards each other: every degree of the series is as
// large as Bernstein's inequality allows. 1/(D − s)² = Σ (m + 1)sᵐ/Dᵐ⁺².
TEST(FarFieldKernels, LeaveOutAsMuchAsTheBoundSaysWhereLightAndPixelLeanTowardsEachOther) {
  Random random(11);
  std::vector<Case> cases;
  for (const double k : {0.03, 0.1, 0.3, 0.5, 0.69})
    for (const double of_light : {0.0, 0.1, 0.35, 0.5, 0.65, 0.9, 1.0})
      for (const double distance : {0.2, 1.0, 30.0}) {
        Case each;
        each.centre = distance * random.direction();
        const double d = glm::length(glm::dvec3(each.centre));
        const glm::dvec3 n = glm::dvec3(each.centre) / d;
        each.lights = {{-(of_light * k * d) * n, glm::dvec3(random.between(0.5, 2))}};
        each.position = (1 - of_light) * k * d * n;
        each.radius = std::nextafter(float(glm::length(glm::dvec3(each.position))), INFINITY);
        each.normal = each.facing = n;
        cases.push_back(each);
      }
  ASSERT_NO_FATAL_FAILURE(expectFarCertified(cases, 0.99));
}

// The same, seen by a group that faces elsewhere: its spread says that a pixel may face the light all the
// same.
TEST(FarFieldKernels, KnowThatAPixelMayFaceTheLightMoreThanItsGroup) {
  Random random(18);
  std::vector<Case> cases;
  for (int i = 0; i < 100; ++i) {
    Case each;
    each.centre = random.direction();
    const glm::dvec3 n = glm::normalize(glm::dvec3(each.centre)),
                     aside = glm::normalize(glm::cross(n, random.direction()));
    each.lights = {{-0.05 * n, glm::dvec3(1)}};
    each.normal = n;
    each.facing = 0.5 * n + std::sqrt(0.75) * aside;
    each.spread = 1.00001f;
    cases.push_back(each);
  }
  ASSERT_NO_FATAL_FAILURE(expectFarCertified(cases));
}

// Lights all around the centre whose brightness is even but for a harmonic of degree 3: that which lights a
// pixel of this normal the most. Only the terms of degree 3 and, since they are far, little else is left out.
TEST(FarFieldKernels, LeaveOutAsMuchAsTheBoundSaysWhateverTheNormal) {
  Random random(19);
  // C. Gauss's quadrature: exact for polynomials of degree 9.
  const std::pair<double, double> rings[] = {{0, 128.0 / 225},
                                             {0.5384693101056831, 0.4786286704993665},
                                             {-0.5384693101056831, 0.4786286704993665},
                                             {0.9061798459386640, 0.2369268850561891},
                                             {-0.9061798459386640, 0.2369268850561891}};
  std::vector<Case> cases;
  for (const double cosine : {0.0, 0.3, 0.55, 0.8, 1.0})
    for (const double sign : {1.0, -1.0}) {
      Case each;
      each.centre = random.direction();
      const glm::dvec3 n = glm::normalize(glm::dvec3(each.centre)),
                       aside = glm::normalize(glm::cross(n, random.direction()));
      each.normal = each.facing = cosine * n + std::sqrt(1 - cosine * cosine) * aside;
      const glm::dvec3 normal(each.normal);
      const double c = glm::dot(normal, n);
      for (const auto& [z, weight] : rings)
        for (int i = 0; i < 10; ++i) {
          const double angle = 0.2 * M_PI * i, across = std::sqrt(1 - z * z);
          const glm::dvec3 way(across * std::cos(angle), across * std::sin(angle), z);
          // N·∇ of P₃(cos)/|v|⁴.
          const double x = glm::dot(n, way);
          const double harmonic =
              -4 * c * legendre(3, x) + (7.5 * x * x - 1.5) * (glm::dot(normal, way) - c * x);
          each.lights.push_back({0.03 * way, glm::dvec3(weight * (1 + 0.24 * sign * harmonic))});
        }
      cases.push_back(each);
    }
  ASSERT_NO_FATAL_FAILURE(expectFarCertified(cases, 0.85));
}

// The same of a light, which has no extent. Half of them are 1000 m from the origin, where a float's last bit
// is 60 µm.
TEST(FarFieldKernels, LeaveOutOfALightAsMuchAsTheBoundSays) {
  Random random(17);
  std::vector<Case> cases;
  for (const double k : {0.02, 0.1, 0.3, 0.5, 0.69})
    for (const double distance : {0.5, 1.0, 30.0})
      for (const double origin : {0.0, 1000.0})
        for (int i = 0; i < 4; ++i) {
          Case each;
          each.middle = origin * glm::dvec3(1, -1, 1) + random.direction();
          const glm::dvec3 n = random.direction(), place = glm::dvec3(each.middle) + distance * n;
          each.centre = place;
          each.lights = {{place - glm::dvec3(each.centre), glm::dvec3(random.between(0.5, 2))}};
          each.position = glm::dvec3(each.middle) + k * distance * n;
          each.radius = std::nextafter(
              float(glm::distance(glm::dvec3(each.position), glm::dvec3(each.middle))), INFINITY);
          each.thickness = each.radius;
          each.normal = each.facing = n;
          // A pixel's place is a float: of a near one it isn't on the line at all.
          if (origin == 0 || k * distance > 0.05) cases.push_back(each);
        }
  ASSERT_NO_FATAL_FAILURE(expectFarCertified(cases, 0.99, true));
}

TEST(FarFieldKernels, AreWithinTheirBoundOfTheTruth) {
  Random random(12);
  std::vector<Case> cases;
  for (int i = 0; i < 2000; ++i) {
    Case each;
    const double d = std::pow(10.0, random.between(-1, 2)), k = std::pow(10.0, random.between(-2.5, -0.17)),
                 of_light = random.between(0, 1);
    each.middle = d * random.between(0, 1) * random.direction();
    each.centre = glm::dvec3(each.middle) + d * random.direction();
    const double distance = glm::distance(glm::dvec3(each.centre), glm::dvec3(each.middle));
    const int lights = 1 + random.below(5);
    for (int light = 0; light < lights; ++light)
      each.lights.push_back(
          {of_light * k * distance * random.between(0, 1) * random.direction(), random.color()});
    each.position =
        glm::dvec3(each.middle) + (1 - of_light) * k * distance * random.between(0, 1) * random.direction();
    each.radius =
        std::nextafter(float(glm::distance(glm::dvec3(each.position), glm::dvec3(each.middle))), INFINITY);
    each.normal = each.facing = random.direction();
    cases.push_back(each);
  }
  ASSERT_NO_FATAL_FAILURE(expectFarCertified(cases));
}

// The magnitudes of a light's terms on that line are 1, 3 + 1 and 7.5 + 1.5 + 3 of the degrees 0 to 2, in
// powers of k. What is counted of their rounding stands at finish_field().
TEST(FarFieldKernels, CountTheRoundingOfAllTermsOfTheSeries) {
  std::vector<Case> cases;
  for (const double k : {0.0, 0.01, 0.1, 0.3, 0.5, 0.69})
    for (const double of_light : {0.0, 0.5, 1.0})
      cases.push_back({.centre = {0, 0, 1},
                       .lights = {{{0, 0, -of_light * k}, glm::dvec3(1)}},
                       .radius = float((1 - of_light) * k)});
  for (const auto& [lanes, of_light] : {std::pair(16, false), std::pair(8, false), std::pair(4, false),
                                        std::pair(1, false), std::pair(16, true), std::pair(1, true)}) {
    std::vector<Case> tried = cases;
    // A light's extent is none.
    if (of_light) std::erase_if(tried, [](const Case& each) { return each.lights[0].offset.z != 0; });
    const std::vector<Column> out = of_light ? probeFarLight(lanes, tried) : probeFar(lanes, tried);
    for (std::size_t i = 0; i < tried.size(); ++i) {
      const double k = double(tried[i].radius) - tried[i].lights[0].offset.z,
                   magnitudes = 1 + 4 * k + 12 * k * k;
      // k is taken 10⁻⁵ larger, and its polynomial rounds.
      EXPECT_GE(out[5][i], magnitudes * (1 - 8 * 0x1p-24)) << k;
      EXPECT_LE(out[5][i], magnitudes * 1.0001) << k;
      const double counted = 6 + 8 + 27 + 20 + 16 + 4 + 16 + 1;
      EXPECT_GE(out[4][i], counted * 0x1p-24 * magnitudes) << k;
    }
  }
}

// 41 blocks of rows and a part of one.
TEST(FarFieldKernels, SumsOverManyRowsAreWithinTheirRounding) {
  constexpr uint kRows = 41 * 16 + 5;
  Random random(13);
  std::vector<Case> cases;
  for (std::size_t i = 0; i < std::size_t(kRows) * kClusterSlots; ++i) {
    Case each;
    each.centre = random.between(1, 9) * random.direction();
    each.lights = {{0.01 * random.direction(), random.color()}};
    cases.push_back(each);
  }
  glm::dvec3 truth(0.0);
  double weight = 0;
  for (const Case& each : cases) {
    truth += farTruth(each);
    const glm::dvec3& color = each.lights[0].color;
    weight +=
        std::max({color.x, color.y, color.z}) / glm::dot(glm::dvec3(each.centre), glm::dvec3(each.centre));
  }
  Columns columns = columnsOf(cases);
  for (Column& column : columns.in) column.resize(1);
  const std::vector<uint> rows{kRows};
  for (const int lanes : kAllLanes) {
    const std::vector<Column> out =
        probe(deviceWithLanes(lanes), "light_cluster_probe.cl", "probe_field_sums", columns.in, 6,
              {{"rows", columns.rows}, {"row_count", rows}});
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LE(std::abs(out[c][0] - truth[int(c)]), kBoundRounding * out[3][0] + out[4][0]);
    // A sum of so many terms rounds once for each row of a block and for each block.
    const double counted = 6 + 8 + 27 + 20 + 16 + 4 + 16 + 42;
    EXPECT_GE(out[4][0], counted * 0x1p-24 * weight);
  }
}

/// Axes of a case whose horizon's normal is an axis: the normal, the way to the cluster, and the third.
struct Axes {
  glm::dvec3 up{}, ahead{}, aside{};
};

std::vector<Axes> allAxes() {
  std::vector<Axes> all;
  for (int up = 0; up < 3; ++up)
    for (const int turn : {1, 2})
      for (const double sign : {1.0, -1.0}) {
        Axes axes;
        axes.up[up] = sign;
        axes.ahead[(up + turn) % 3] = 1;
        axes.aside[(up + 3 - turn) % 3] = 1;
        all.push_back(axes);
      }
  return all;
}

/// Of clusters `height` times as high above the horizon as it takes to be above all: at 0.98 none may be
/// taken for one above, or upside down for one below; at 1.05 all are.
void expectMargin(const std::function<Case(const Axes&, double height)>& caseAt) {
  for (const double height : {0.98, 1.05})
    for (const bool below : {false, true}) {
      std::vector<Case> cases;
      for (const Axes& axes : allAxes()) {
        Case each = caseAt(axes, height);
        if (below) {
          // Mirrored in the horizon, but for the normals.
          const auto flip = [&](const glm::dvec3& v) { return v - 2 * glm::dot(v, axes.up) * axes.up; };
          each.centre = flip(each.centre);
          each.position = flip(each.position);
          for (ClusterLight& light : each.lights) light.offset = flip(light.offset);
          each.normal = -flip(each.normal);
        }
        const double z = glm::dot(glm::dvec3(each.normal), toLight(each, each.lights[0]));
        ASSERT_EQ((z > 0) != below, height > 1) << "the light itself is there";
        cases.push_back(each);
      }
      for (const int lanes : kAllLanes) {
        const Column verdict = probeFar(lanes, cases)[6];
        for (std::size_t i = 0; i < cases.size(); ++i)
          EXPECT_EQ(verdict[i], height < 1 ? 0.0f
                                : below    ? 1.0f
                                           : 2.0f)
              << "case " << i << ", " << height << ", " << lanes << " lanes";
      }
    }
}

TEST(HorizonKernels, KnowHowFarAClusterReachesDown) {
  expectMargin([](const Axes& axes, double height) {
    Case each;
    each.facing = each.normal = axes.up;
    each.lights = {{-0.1 * axes.up, glm::dvec3(1)}};
    each.centre = axes.ahead + 0.1 * height * axes.up;
    return each;
  });
}

TEST(HorizonKernels, KnowHowFarAPixelLiesAboveTheMiddle) {
  expectMargin([](const Axes& axes, double height) {
    Case each;
    each.facing = each.normal = axes.up;
    each.lights = {{glm::dvec3(0), glm::dvec3(1)}};
    each.position = 0.1 * axes.up;
    each.radius = each.thickness = 0.1f;
    each.centre = axes.ahead + 0.1 * height * axes.up;
    return each;
  });
}

TEST(HorizonKernels, KnowHowFarAHorizonTurnsAtAClustersFarSide) {
  expectMargin([](const Axes& axes, double height) {
    Case each;
    each.facing = axes.up;
    each.spread = 0.08f;
    each.normal = axes.up - 0.08 * axes.ahead;
    each.lights = {{0.6 * axes.ahead, glm::dvec3(1)}};
    each.centre = axes.ahead + 0.08 * 1.6 * height * axes.up;
    return each;
  });
}

TEST(HorizonKernels, AreNotFooledByRounding) {
  Random random(14);
  std::vector<Case> cases;
  for (int i = 0; i < 4000; ++i) {
    Case each;
    each.facing = each.normal = random.direction();
    const glm::dvec3 normal(each.normal), way = random.direction();
    each.centre = way - glm::dot(way, normal) / glm::dot(normal, normal) * normal;
    each.lights = {{glm::dvec3(0), glm::dvec3(1)}};
    cases.push_back(each);
  }
  for (const int lanes : kAllLanes) {
    const Column verdict = probeFar(lanes, cases)[6];
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double z = glm::dot(glm::dvec3(cases[i].normal), glm::dvec3(cases[i].centre));
      EXPECT_FALSE(verdict[i] == 1 && z > 0) << "case " << i << ", " << z;
      EXPECT_FALSE(verdict[i] == 2 && z < 0) << "case " << i << ", " << z;
    }
  }
}

/// What a case's cluster adds is within its bound of the truth, and of what is counted as its rounding.
/// tight: how much of the bound the error is at least.
void expectCutCertified(const std::vector<Case>& cases, double tight = 0) {
  for (const int lanes : kAllLanes) {
    const std::vector<Column> out = probeCut(lanes, cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const glm::dvec3 truth = cutTruth(cases[i]);
      for (std::size_t c = 0; c < 3; ++c) {
        // As clustered_light.cl counts it of one cluster.
        const double rounding = 65 * 0x1p-24 * (out[c][i] + out[c + 3][i]),
                     error = std::abs(out[c][i] - truth[int(c)]);
        ASSERT_LE(error, kBoundRounding * (out[c + 3][i] + rounding))
            << "case " << i << ", channel " << c << ", " << lanes << " lanes, truth " << truth[int(c)];
        ASSERT_GE(error, tight * out[c + 3][i] - rounding) << "case " << i << ", " << lanes << " lanes";
      }
    }
  }
}

/// Lights at the given heights above a horizon, all `ahead` from the cluster's centre, which is on it and 1 m
/// away, of the given brightnesses.
Case onHorizon(const Axes& axes, const std::vector<std::pair<double, double>>& heights, double ahead = 0) {
  Case each;
  each.normal = axes.up;
  each.centre = axes.ahead;
  for (const auto& [height, brightness] : heights)
    each.lights.push_back({height * axes.up + ahead * axes.ahead, brightness * glm::dvec3(1, 0.5, 0.25)});
  return each;
}

// All |z| are alike, so Cauchy's and Schwarz's bound is reached. The black light keeps the lower one away.
TEST(CutClusterKernels, AreAsFarOffAsTheyMayBeWhereAllLightsAreAsFarFromTheHorizon) {
  std::vector<Case> cases;
  for (const Axes& axes : allAxes()) cases.push_back(onHorizon(axes, {{0.004, 1}, {-0.004, 1}, {0.008, 0}}));
  ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases, 0.97));
}

// |z| is 0 or the most that it can be: Σ q·|z| = Z₂/z'.
TEST(CutClusterKernels, AreAsFarOffAsTheyMayBeWhereLightsAreOnTheHorizonOrFarthestFromIt) {
  std::vector<Case> cases;
  for (const Axes& axes : allAxes())
    cases.push_back(onHorizon(axes, {{0.004, 1}, {-0.004, 1}, {0, 1}, {0, 5}}));
  ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases, 0.97));
}

// All z have a sign: Σ q·|z| = |Σ q·z|.
TEST(CutClusterKernels, AreAsFarOffAsTheyMayBeWhereAllLightsAreAboveTheHorizon) {
  std::vector<Case> cases;
  for (const Axes& axes : allAxes())
    for (const double sign : {1.0, -1.0})
      cases.push_back(onHorizon(axes, {{sign * 0.0006, 1}, {sign * 0.0018, 1}}));
  ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases, 0.9));
}

// One light, at the height that is known, nearer than the centre or farther away: the bounds of 1/d³ are both
// reached where t is small.
TEST(CutClusterKernels, AreAsFarOffAsTheyMayBeWhereALightIsNearerThanTheCentreOrFartherAway) {
  for (const auto& [t, tight] :
       {std::pair(0.005, 0.8), std::pair(0.02, 0.9), std::pair(0.1, 0.75), std::pair(0.3, 0.0)}) {
    std::vector<Case> cases;
    for (const Axes& axes : allAxes())
      for (const double sign : {1.0, -1.0}) cases.push_back(onHorizon(axes, {{0.002, 1}}, sign * t));
    ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases, tight));
  }
}

// A light that is nearer than the centre, and four that are farther away, each as high as 1/d³: so Cauchy's
// and Schwarz's bound is reached, and all that is known of D⁶/d⁶ but its mean slope is needed.
TEST(CutClusterKernels, AreAsFarOffAsTheyMayBeWhereLightsAreOnBothSidesOfTheCentre) {
  std::vector<Case> cases;
  for (const Axes& axes : allAxes())
    for (const double t : {0.05, 0.1, 0.2, 0.3}) {
      Case each = onHorizon(axes, {});
      for (const auto& [ahead, brightness] : {std::pair(-t, 1.0), std::pair(0.25 * t, 4.0)}) {
        const double height = 0.0005 * std::pow(1 + ahead, -3);
        for (const double sign : {1.0, -1.0})
          each.lights.push_back({sign * height * axes.up + ahead * axes.ahead, glm::dvec3(brightness)});
      }
      cases.push_back(each);
    }
  ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases, 0.75));
}

// A single light, whose height above the horizon is rounding and little else.
TEST(CutClusterKernels, KnowWhatRoundingDoesOnTheHorizon) {
  Random random(15);
  std::vector<Case> cases;
  for (int i = 0; i < 2000; ++i) {
    Case each;
    each.position = random.direction();
    each.normal = random.direction();
    const glm::dvec3 normal(each.normal), way = random.direction();
    const double height = random.between(-1, 1) * std::pow(10.0, random.between(-9, -5));
    each.centre = glm::dvec3(each.position) + way - glm::dot(way, normal) * normal + height * normal;
    each.lights = {{glm::dvec3(0), glm::dvec3(1)}};
    cases.push_back(each);
  }
  ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases));
}

TEST(CutClusterKernels, AreWithinTheirBoundOfTheTruth) {
  Random random(16);
  std::vector<Case> cases;
  for (int i = 0; i < 2000; ++i) {
    Case each;
    const double d = std::pow(10.0, random.between(-1.5, 2)), t = std::pow(10.0, random.between(-3, -0.302));
    each.position = d * random.between(0, 1) * random.direction();
    each.normal = random.direction();
    const glm::dvec3 normal(each.normal), way = random.direction();
    const glm::dvec3 level = glm::normalize(way - glm::dot(way, normal) * normal);
    each.centre = glm::dvec3(each.position) + d * (level + t * random.between(-1, 1) * normal);
    const int lights = 1 + random.below(5);
    for (int light = 0; light < lights; ++light)
      each.lights.push_back({t * d * random.between(0, 1) * random.direction(), random.color()});
    cases.push_back(each);
  }
  ASSERT_NO_FATAL_FAILURE(expectCutCertified(cases));
}

}  // namespace
}  // namespace luciole::test
