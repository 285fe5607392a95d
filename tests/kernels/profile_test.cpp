#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "lights/luminaires.hpp"
#include "lights/shade_lights.hpp"
#include "scene/profiles/profile_files.hpp"
#include "scene/profiles/profile_table.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Directions all around, some of them along the axes, of many lengths.
std::vector<Column> directions(Random& random, int count) {
  std::vector<Column> columns(3);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 way = i < 6 ? glm::dvec3(i / 2 == 0, i / 2 == 1, i / 2 == 2) * (i % 2 ? -1.0 : 1.0)
                                 : random.direction() * std::exp2(20 * random.between(-1, 1));
    for (int c = 0; c < 3; ++c) columns[std::size_t(c)].push_back(float(way[c]));
  }
  return columns;
}

/// Two luminaires of a profile, the second turned so, as the kernel takes them.
Column luminairesOf(const LightProfile& profile, const glm::dvec3& direction, const glm::dvec3& up) {
  Scene scene;
  const auto shared = std::make_shared<const LightProfile>(profile);
  scene.luminaires = {{shared, {1, 2, 3}}, {shared, up}};
  scene.lights.resize(2);
  for (int i = 0; i < 2; ++i) scene.lights[std::size_t(i)].luminaire = i;
  scene.lights[0].direction = {0, 0, 1};
  scene.lights[1].direction = direction;
  const Camera camera;
  const std::vector<std::uint32_t> order{0, 1};
  RawArray<ShadeLight> lights = prepareLights(scene, order, camera, {});
  const RawArray<float> luminaires = setLuminaires(scene, camera, order, lights);
  EXPECT_EQ(lights[1].ambient.w, 2.0f);
  return {luminaires.begin(), luminaires.end()};
}

TEST(ProfileKernels, AnglesAreThoseOfTheArcTangent) {
  Random random(1);
  const LightProfile even = *[] {
    std::vector<Warning> warnings;
    return parseLightProfile(iesText({}), "lamp.ies", warnings);
  }();
  const Column luminaires = luminairesOf(even, {0, -1, 0}, {1, 0, 0});
  std::vector<Column> in = directions(random, 20000);
  for (const float tiny : {1e-30f, 1e-8f})
    for (int i = 0; i < 8; ++i) {
      in[0].push_back(i & 1 ? -1.0f : 1.0f);
      in[1].push_back((i & 2 ? -1.0f : 1.0f) * tiny);
      in[2].push_back(1);
      if (i & 4) std::swap(in[0].back(), in[1].back());
    }
  for (const int lanes : kAllLanes) {
    const Column angle = probe(deviceWithLanes(lanes), "profile_probe.cl", "probe_profile", in, 2,
                               {{"luminaires", luminaires}})[1];
    for (std::size_t i = 0; i < angle.size(); ++i) {
      // -0 counts as 0: both ends of a turn are one direction.
      const double exact = std::atan2(double(in[1][i]) + 0.0, double(in[0][i]) + 0.0);
      const double size = std::abs(exact);
      ASSERT_NEAR(angle[i], exact,
                  kUnit * (size <= kPi / 4   ? 4
                           : size <= kPi / 2 ? 7
                                             : 13))
          << i << ", " << lanes;
    }
  }
}

/// A table that is bilinear as a whole, so that it is known between its lines, too: over its peak
/// (1 + vertical / 360) (1 + horizontal / 720) / most.
struct BilinearLamp {
  const char* what;
  int type;
  std::vector<double> vertical, horizontal;

  static double value(double vertical, double horizontal) {
    return (1 + vertical / 360) * (1 + horizontal / 720);
  }
};

TEST(ProfileKernels, TablesAreBilinearInTheFilesTwoAngles) {
  Random random(2);
  const std::vector<Column> in = directions(random, 20000);
  for (const BilinearLamp& lamp :
       {BilinearLamp{"C, even", 1, evenAngles(0, 180, 36), evenAngles(0, 360, 24)},
        {"C, even with gaps", 1, {0, 2.5, 5, 10, 45, 90, 180}, {0, 22.5, 45, 180, 360}},
        {"C, uneven", 1, {0, 0.017, 13.2, 90.5, 180}, {0, 1e-2, 77.713, 181, 360}},
        {"C, below alone", 1, evenAngles(0, 90, 9), evenAngles(0, 360, 8)},
        {"C, above alone", 1, {90, 90.013, 180}, {0, 100.7, 360}},
        {"B", 2, evenAngles(-90, 90, 36), evenAngles(-90, 90, 18)},
        {"B, uneven and narrow", 2, {-40, -3.3331, 55}, {-90, -13.013, 90}},
        {"A", 3, evenAngles(-90, 90, 6), {-90, -10, 0, 5, 90}}}) {
    SCOPED_TRACE(lamp.what);
    const double most = BilinearLamp::value(lamp.vertical.back(), lamp.horizontal.back());
    std::vector<Warning> warnings;
    const LightProfile profile = *parseLightProfile(iesText({.type = lamp.type,
                                                             .vertical = lamp.vertical,
                                                             .horizontal = lamp.horizontal,
                                                             .candela = BilinearLamp::value}),
                                                    "lamp.ies", warnings);
    const glm::dvec3 axis = random.direction(), up = random.direction();
    const Column luminaires = luminairesOf(profile, axis, up);
    const glm::dvec3 front = glm::normalize(up - glm::dot(up, axis) * axis), right = glm::cross(axis, front);
    Column first;
    for (const int lanes : kAllLanes) {
      const Column share = probe(deviceWithLanes(lanes), "profile_probe.cl", "probe_profile", in, 2,
                                 {{"luminaires", luminaires}})[0];
      if (first.empty()) first = share;
      ASSERT_EQ(first, share) << lanes << " lanes";
    }
    int inside = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      const glm::dvec3 way = -glm::normalize(glm::dvec3(in[0][i], in[1][i], in[2][i]));
      const double ahead = glm::dot(way, axis), upwards = glm::dot(way, front), aside = glm::dot(way, right);
      const auto degrees = [](double y, double x) { return glm::degrees(std::atan2(y, x)); };
      double vertical = 0, horizontal = 0;
      if (lamp.type == 1) {
        vertical = degrees(std::hypot(upwards, aside), ahead);
        horizontal = degrees(-aside, upwards);
        if (horizontal < 0) horizontal += 360;
      } else if (lamp.type == 2) {
        horizontal = degrees(aside, std::hypot(ahead, upwards));
        vertical = degrees(upwards, ahead);
      } else {
        vertical = degrees(upwards, std::hypot(ahead, aside));
        horizontal = degrees(aside, ahead);
      }
      // 20 u radians off the direction is as many over the sine to the pole in the azimuth, which has no
      // meaning there. The table jumps at its ends.
      const double to_pole = lamp.type == 1 ? ahead : lamp.type == 2 ? aside : upwards;
      const double off = 20 * kUnit / std::max(std::sqrt(1 - to_pole * to_pole), 1e-7);
      const auto isNear = [&](double angle, double end, bool ends) {
        return ends && std::abs(angle - end) < glm::degrees(off) + 1e-9;
      };
      if (isNear(vertical, lamp.vertical.front(), vertical > 0) ||
          isNear(vertical, lamp.vertical.back(), vertical < 180) ||
          isNear(horizontal, lamp.horizontal.front(), true) ||
          isNear(horizontal, lamp.horizontal.back(), true))
        continue;
      const bool is_inside = vertical >= lamp.vertical.front() && vertical <= lamp.vertical.back() &&
                             horizontal >= lamp.horizontal.front() && horizontal <= lamp.horizontal.back();
      inside += is_inside;
      const double exact = is_inside ? BilinearLamp::value(vertical, horizontal) / most : 0;
      // Its slope is below 1 / (2π) a radian in each angle; the entries are rounded twice, and the sum
      // thrice.
      ASSERT_NEAR(first[i], exact, 2 * off / (2 * kPi) + 6 * kUnit) << vertical << ", " << horizontal;
    }
    EXPECT_GT(inside, 1000);
  }
}

TEST(ProfileKernels, AnyDirectionHasAShareOfThePeak) {
  const float huge = 3e38f, infinite = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Column> in(3);
  for (const float x : {0.0f, 1e-38f, 1.0f, huge, infinite, nan})
    for (const float y : {0.0f, -1e-38f, -1.0f, huge, -infinite, nan}) {
      in[0].push_back(x);
      in[1].push_back(y);
      in[2].push_back(x);
    }
  for (const std::vector<double>& vertical : {std::vector<double>{0, 90}, {0, 0.017, 90}}) {
    std::vector<Warning> warnings;
    const LightProfile profile = *parseLightProfile(iesText({.vertical = vertical}), "lamp.ies", warnings);
    const Column luminaires = luminairesOf(profile, {0, -1, 0}, {1, 0, 0});
    for (const int lanes : kAllLanes) {
      const Column shares = probe(deviceWithLanes(lanes), "profile_probe.cl", "probe_profile", in, 2,
                                  {{"luminaires", luminaires}})[0];
      for (const float share : shares) EXPECT_TRUE(share >= 0 && share <= 1) << share;
    }
  }
}

}  // namespace
}  // namespace luciole::test
