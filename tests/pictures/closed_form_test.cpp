// Scenes whose picture is known by a formula, rendered by the whole pipeline.
#include "pictures/closed_form.hpp"

#include <array>
#include <numbers>
#include <random>
#include <vector>

namespace luciole::test {
namespace {

TEST(ClosedForm, PointLightOverAPlane) {
  // I·Kd·cos, cos = h / √(h² + r²): on the axis of the view and off it.
  for (const glm::dvec3& light :
       {glm::dvec3(0, 1, 0), glm::dvec3(0.75, 1.5, -0.5), glm::dvec3(-3, 0.25, 2)}) {
    SCOPED_TRACE(fmt::format("light at {}, {}, {}", light.x, light.y, light.z));
    const Image image = render(floorScene(
        fmt::format(R"({}, "lights": [{{"type": "point", "position": [{}, {}, {}], "intensity": 3}}])",
                    kMatte, light.x, light.y, light.z)));
    expectFloor(image, [&](const glm::dvec3& p) { return lambert(1.5, litBy(light, p)); });
  }
}

TEST(ClosedForm, ColoursMultiplyChannelByChannel) {
  const Image image = render(floorScene(R"("materials": {"m": {"diffuse": [0.5, 0.25, 1]}},
      "lights": [{"type": "directional", "direction": [0, -1, 0], "color": [1, 0.5, 0.25], "intensity": 2}])"));
  // Straight down, all factors are powers of two, and the cosine is exactly 1.
  for (int i = 0; i < kSide * kSide; ++i)
    ASSERT_EQ(std::vector(image.pixels.begin() + 3 * i, image.pixels.begin() + 3 * i + 3),
              (std::vector<float>{1, 0.25f, 0.5f}));
}

TEST(ClosedForm, AttenuationDividesByItsPolynomial) {
  const glm::dvec3 light(0.75, 1.5, -0.5);
  for (const glm::dvec3& a : {glm::dvec3(1, 0.5, 0.25), glm::dvec3(0, 0, 1), glm::dvec3(0, 2, 0)}) {
    const Image image = render(floorScene(fmt::format(
        R"({}, "lights": [{{"type": "point", "position": [0.75, 1.5, -0.5], "attenuation": [{}, {}, {}]}}])",
        kMatte, a.x, a.y, a.z)));
    expectFloor(image, [&](const glm::dvec3& p) {
      const Lit lit = litBy(light, p);
      const double d = lit.distance;
      // The polynomial's relative slope in d is 2/d at most, so d's relative error counts twice; it is that
      // of the unit vector. Its own terms round 6 times, the division once.
      return lambert(0.5 / (a.x + a.y * d + a.z * d * d), lit, 2 * lit.way_error + 8 * kUnit);
    });
  }
}

TEST(ClosedForm, RangeIsASmoothWindowThatEndsAtZero) {
  const glm::dvec3 light(0.5, 1, 0.25);
  const double range = 1.75;
  const Image image = render(floorScene(fmt::format(
      R"({}, "lights": [{{"type": "point", "position": [0.5, 1, 0.25], "range": {}}}])", kMatte, range)));
  int beyond = 0;
  expectFloor(image, [&](const glm::dvec3& p) {
    const Lit lit = litBy(light, p);
    const double fade = std::max(1 - std::pow(lit.distance / range, 4), 0.0);
    // (d/r)⁴ carries d's relative error 4 times and 8 roundings, as 1 − (d/r)⁴ does absolutely.
    const double fade_error = 4 * lit.way_error + 8 * kUnit;
    if (fade == 0 && lit.distance > range * (1 + lit.way_error + 8 * kUnit)) {
      ++beyond;
      return Known{0, 0};
    }
    Known known = lambert(0.5 * fade * fade, lit);
    known.error += 0.5 * lit.n_dot_l * (2 * fade * fade_error + fade_error * fade_error);
    return known;
  });
  EXPECT_GT(beyond, kSide * kSide / 4) << "the range ends inside the picture";
}

/// From inside a sphere of radius 1, at its centre: everywhere the normal is the view vector.
std::string insideSphere(int segments, const std::string& rest) {
  return fmt::format(R"({{"camera": {{"eye": [0, 0, 0], "target": [1, 2, 3], "fov_y": 80}},
      "materials": {{"m": {{"diffuse": 0.5, "specular": 0.25, "shininess": 50, "double_sided": true}}}},
      "objects": [{{"primitive": "sphere", "segments": {}, "material": "m"}}], {}}})",
                     segments, rest);
}

TEST(ClosedForm, SphereLitFromItsCentreIsEvenlyBright) {
  // Vertices lie at their own normals, so interpolated normals point exactly away from the centre, facets or
  // not: N·L = R·V = 1, and the picture is I·(Kd + Ks).
  const Image image =
      render(insideSphere(12, R"("lights": [{"type": "point", "position": [0, 0, 0], "intensity": 4}])"));
  for (const float value : image.pixels) {
    // The cosine of two rounded unit vectors is within 12 roundings of 1. R and V differ by 40 roundings at
    // most, so that 1 − R·V is below (40·2^-24)²/2 and the lobe 1 within the power's 2 ulp. Five more for
    // products and the sum.
    ASSERT_NEAR(value, 4 * 0.75, 4 * 0.75 * (12 + 4 + 5) * kUnit);
  }
}

TEST(ClosedForm, SphereFadesWithItsRadiusSquared) {
  constexpr int kSegments = 256;
  const Image image = render(insideSphere(
      kSegments, R"("lights": [{"type": "point", "position": [0, 0, 0], "attenuation": [0, 0, 1]}])"));
  // A point Σ bᵢvᵢ of a facet with corners on the sphere and sides ≤ c is at a squared distance of
  // 1 − Σ bᵢbⱼ|vᵢ − vⱼ|²/2 ≥ 1 − c²/3 from the centre; the longest side is a quad's diagonal.
  const double side = 2 * std::sin(std::numbers::pi / kSegments), c2 = 2 * side * side;
  for (const float value : image.pixels) {
    ASSERT_GE(value, 0.75 * (1 - 40 * kUnit));
    ASSERT_LE(value, 0.75 / (1 - c2 / 3) * (1 + 40 * kUnit));
  }
}

TEST(ClosedForm, DirectionalLightAtSixtyDegreesIsHalfAsBright) {
  const Image image = render(floorScene(
      fmt::format(R"({}, "lights": [{{"type": "directional", "direction": [{}, -1, 0], "intensity": 2}}])",
                  kMatte, std::sqrt(3.0))));
  // The direction rounds, and the cosine's products and sums; the rest are powers of two.
  expectFloor(image, [](const glm::dvec3&) { return Known{0.5, 8 * kUnit}; });
}

TEST(ClosedForm, LightsBehindASurfaceLeaveItBlack) {
  const Image image =
      render(floorScene(R"("materials": {"m": {"diffuse": 0.5, "specular": 1, "shininess": 0}},
      "lights": [{"type": "point", "position": [0, -1, 0]}, {"type": "directional", "direction": [0.1, 1, 0]},
                 {"type": "spot", "position": [0, -1, 0], "direction": [0, 1, 0], "cutoff": 80}])"));
  expectFloor(image, [](const glm::dvec3&) { return Known{0, 0}; });
}

TEST(ClosedForm, SpotEndsAtItsCutoffToThePixel) {
  // From a height of 1 straight down, a cutoff of 40 degrees lights a disc of radius tan 40.
  const glm::dvec3 light(0.25, 1, 0.125);
  const double cutoff = std::numbers::pi * 40 / 180;
  const Image image = render(floorScene(fmt::format(
      R"({}, "lights": [{{"type": "spot", "position": [0.25, 1, 0.125], "direction": [0, -1, 0], "cutoff": 40}}])",
      kMatte)));
  int inside = 0;
  expectFloor(image, [&](const glm::dvec3& p) {
    const Lit lit = litBy(light, p);
    EXPECT_GT(std::abs(lit.n_dot_l - std::cos(cutoff)), lit.way_error + 8 * kUnit)
        << "on the edge, undecided";
    const bool is_inside = glm::length(p - glm::dvec3(light.x, 0, light.z)) < std::tan(cutoff);
    inside += is_inside;
    return is_inside ? lambert(0.5, lit) : Known{0, 0};
  });
  // Its area, π tan² 40, in pixels of 1/8 m: 141.6; a disc's count of pixels is off by less than its girth.
  EXPECT_NEAR(inside, 141.6, 42);
}

TEST(ClosedForm, SpotExponentIsACosinesPower) {
  const glm::dvec3 light(0.25, 1, 0.125);
  for (const double n : {1.0, 8.0, 128.0}) {
    const Image image = render(floorScene(fmt::format(
        R"({}, "lights": [{{"type": "spot", "position": [0.25, 1, 0.125], "direction": [0, -1, 0], "cutoff": 90, "exponent": {}}}])",
        kMatte, n)));
    expectFloor(image, [&](const glm::dvec3& p) {
      const Lit lit = litBy(light, p);
      const Known spot = power(lit.n_dot_l, lit.way_error + 6 * kUnit, n), cosine = lambert(0.5, lit);
      return Known{spot.value * cosine.value,
                   (spot.value + spot.error) * cosine.error + spot.error * cosine.value + 0x1p-126};
    });
  }
}

TEST(ClosedForm, ConeIsTheSquareOfARampInTheCosine) {
  const glm::dvec3 light(0.25, 1, 0.125);
  const double inner = std::cos(std::numbers::pi * 20 / 180), outer = std::cos(std::numbers::pi * 50 / 180);
  const Image image = render(floorScene(fmt::format(
      R"({}, "lights": [{{"type": "spot", "position": [0.25, 1, 0.125], "direction": [0, -1, 0], "inner_cone": 20, "outer_cone": 50}}])",
      kMatte)));
  expectFloor(image, [&](const glm::dvec3& p) {
    const Lit lit = litBy(light, p);
    const double ramp = std::clamp((lit.n_dot_l - outer) / (inner - outer), 0.0, 1.0);
    // The cosine's error and its difference's, the edge's and the scale's roundings, over the ramp's width.
    const double ramp_error = (lit.way_error + 10 * kUnit) / (inner - outer);
    Known known = lambert(0.5 * ramp * ramp, lit);
    known.error += 0.5 * lit.n_dot_l * (2 * ramp + ramp_error) * ramp_error;
    return known;
  });
}

constexpr const char* kGlow = R"("materials": {"m": {"diffuse": 0, "emission": [0.5, 0.5, 0.5]}})";

/// Half white seen through a share of fog that is a quarter white, with an error of the share.
Known fogged(double share, double error) {
  // Both products and their sum round, and 1 − share.
  const double value = 0.5 * share + 0.25 * (1 - share);
  return {value, 0.25 * error + 4 * kUnit * value};
}

TEST(ClosedForm, FogByDepthAtKnownDistances) {
  struct Mode {
    const char* json;
    double (*share)(double depth);
    double
        error;  // of the share: exponents below 8 are off by 4 roundings and log2's, the exponential by 2 ulp
  };
  for (const Mode& mode : {Mode{R"("mode": "linear", "start": 1, "end": 5)",
                                [](double z) { return std::clamp((5 - z) / 4, 0.0, 1.0); }, 0},
                           Mode{R"("mode": "exp", "density": 0.5)",
                                [](double z) { return std::exp(-0.5 * z); }, (8 * 8 + 4) * kUnit},
                           Mode{R"("mode": "exp2", "density": 0.25)",
                                [](double z) { return std::exp(-z * z / 16); }, (8 * 8 + 4) * kUnit}}) {
    for (const double depth : {0.5, 1.0, 2.0, 4.0, 8.0}) {
      SCOPED_TRACE(fmt::format("{} at {} m", mode.json, depth));
      const Image image = render(floorScene(
          fmt::format(R"({}, "fog": {{{}, "color": [0.25, 0.25, 0.25]}})", kGlow, mode.json), depth));
      // Depth is the same all over the floor; linear shares are exact.
      expectFloor(image, [&](const glm::dvec3&) {
        return fogged(mode.share(depth), mode.error * mode.share(depth));
      });
    }
  }
}

TEST(ClosedForm, RadialFogGoesByTheDistanceFromTheEye) {
  const Image image = render(floorScene(fmt::format(
      R"({}, "fog": {{"mode": "exp", "density": 0.5, "color": [0.25, 0.25, 0.25], "distance": "radial"}})",
      kGlow)));
  expectFloor(image, [](const glm::dvec3& p) {
    const double depth = 0.5 * glm::length(p - glm::dvec3(0, kEyeHeight, 0)), share = std::exp(-depth);
    // The distance: its point's rounding, 3 of d², 6 of the root and a product, as in litBy; then 4 of the
    // exponent, and the exponential's 2 ulp.
    return fogged(share, share * (16 * depth + 4) * kUnit);
  });
}

TEST(ClosedForm, FogThickensChannelByChannel) {
  const Image image = render(floorScene(
      fmt::format(R"({}, "fog": {{"mode": "exp", "density": [0.25, 0.5, 1], "color": [0, 0, 0]}})", kGlow)));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double depth = kEyeHeight * std::array{0.25, 0.5, 1.0}[i % 3];
    ASSERT_NEAR(image.pixels[i], 0.5 * std::exp(-depth), 0.5 * std::exp(-depth) * (4 * depth + 8) * kUnit);
  }
}

/// The floor with a point light in the mirror of pixel (20, 14), as high as the eye: half way between them.
constexpr int kMirrorX = 20, kMirrorY = 14;
glm::dvec3 mirrorLight() { return 2.0 * floorPoint(kMirrorX, kMirrorY) + glm::dvec3(0, kEyeHeight, 0); }

Image mirrorPicture(double shininess, Model model, bool parallel) {
  const glm::dvec3 light = mirrorLight();
  const std::string json =
      floorScene(fmt::format(R"("materials": {{"m": {{"diffuse": 0, "specular": 0.5, "shininess": {}}}}},
      "lights": [{{"type": "point", "position": [{}, {}, {}]}}])",
                             shininess, light.x, light.y, light.z),
                 kEyeHeight, parallel);
  return renderJson(json, {kSide, kSide}, [&](RenderSettings& settings) { settings.shade.model = model; });
}

/// Ks·cosⁿ of two unit vectors, each within `error` as a length: 1 − cos is half their squared distance, so
/// it is off by √(2(1 − cos)) times both errors, and their square. Below 2^-63.5 kernels leave it out.
Known highlight(double cosine, double error, double n) {
  const Known lobe = power(cosine,
                           std::sqrt(2 * std::max(1 - cosine, 0.0)) * error + error * error +
                               8 * kUnit * std::max(1 - cosine, 0.0),
                           n);
  const double left_out = lobe.value < 0x1p-63 ? lobe.value : 0;
  return {0.5 * lobe.value, 0.5 * (lobe.error + 2 * kUnit * lobe.value + left_out)};
}

TEST(ClosedForm, MirrorDirectionShowsTheFullHighlight) {
  for (const Model model : {Model::kPhong, Model::kBlinnPhong}) {
    const Image image = mirrorPicture(200, model, false);
    const auto brightest = std::max_element(image.pixels.begin(), image.pixels.end());
    EXPECT_EQ((brightest - image.pixels.begin()) / 3, kMirrorY * kSide + kMirrorX);
    // There 1 − cos is below (40 · 2^-24)²/2, and times 200 still nothing; the power and two products round.
    EXPECT_NEAR(*brightest, 0.5, 0.5 * 6 * kUnit);
  }
}

TEST(ClosedForm, PhongsLobeSurroundsTheMirrorDirection) {
  for (const bool parallel : {false, true}) {
    SCOPED_TRACE(parallel);
    expectFloor(mirrorPicture(20, Model::kPhong, parallel), [&](const glm::dvec3& p) {
      const Lit lit = litBy(mirrorLight(), p);
      const glm::dvec3 mirrored(-lit.to_light.x, lit.to_light.y, -lit.to_light.z);
      const glm::dvec3 to_eye =
          parallel ? glm::dvec3(0, 1, 0) : glm::normalize(glm::dvec3(0, kEyeHeight, 0) - p);
      // R = 2(N·L)N − L doubles L's error at most twice over; V has its own of 12 roundings; the sums of
      // R, 12.
      return highlight(glm::dot(mirrored, to_eye), 3 * lit.way_error + 24 * kUnit, 20);
    });
  }
}

TEST(ClosedForm, BlinnsLobeSurroundsTheHalfVector) {
  for (const bool parallel : {false, true}) {
    SCOPED_TRACE(parallel);
    expectFloor(mirrorPicture(20, Model::kBlinnPhong, parallel), [&](const glm::dvec3& p) {
      const Lit lit = litBy(mirrorLight(), p);
      const glm::dvec3 to_eye =
          parallel ? glm::dvec3(0, 1, 0) : glm::normalize(glm::dvec3(0, kEyeHeight, 0) - p);
      const glm::dvec3 sum = lit.to_light + to_eye;
      // Errors of L and V over the sum's length, which is above 1 here, and 12 roundings of its own.
      return highlight(glm::normalize(sum).y, lit.way_error + 24 * kUnit, 20);
    });
  }
}

TEST(ClosedForm, ParallelViewLightsTheSameFloor) {
  const glm::dvec3 light(0.75, 1.5, -0.5);
  const Image image = render(
      floorScene(fmt::format(R"({}, "lights": [{{"type": "point", "position": [0.75, 1.5, -0.5]}}])", kMatte),
                 kEyeHeight, true));
  expectFloor(image, [&](const glm::dvec3& p) { return lambert(0.5, litBy(light, p)); });
}

TEST(ClosedForm, AmbientAndEmissionAlone) {
  const Image image = render(floorScene(
      R"("ambient": [0.5, 0.25, 1], "materials": {"m": {"ambient": [0.5, 0.5, 0.25], "emission": [0.125, 0.25, 1]}})"));
  for (int i = 0; i < kSide * kSide; ++i)
    ASSERT_EQ(std::vector(image.pixels.begin() + 3 * i, image.pixels.begin() + 3 * i + 3),
              (std::vector<float>{0.375f, 0.375f, 1.25f}));
}

TEST(ClosedForm, ALightsOwnAmbientFadesWithItsDistance) {
  const glm::dvec3 light(0.75, 1.5, -0.5);
  const Image image = render(floorScene(
      R"("materials": {"m": {"ambient": 0.5}},
      "lights": [{"type": "point", "position": [0.75, 1.5, -0.5], "ambient": [1, 1, 1], "diffuse": [0, 0, 0], "attenuation": [0, 0, 1]}])"));
  expectFloor(image, [&](const glm::dvec3& p) {
    const Lit lit = litBy(light, p);
    const double value = 0.5 / (lit.distance * lit.distance);
    return Known{value, value * (2 * lit.way_error + 10 * kUnit)};
  });
}

std::vector<std::string> someLights(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::string> lights;
  for (int i = 0; i < count; ++i)
    lights.push_back(fmt::format(
        R"({{"type": "point", "position": [{}, {}, {}], "range": {}, "intensity": {}}})",
        4 * unit(random) - 2, 0.1 + unit(random), 4 * unit(random) - 2, 1 + 2 * unit(random), unit(random)));
  return lights;
}

constexpr const char* kShiny = R"("materials": {"m": {"diffuse": 0.5, "specular": 0.5, "shininess": 10}})";

Image renderLights(const std::vector<std::string>& lights) {
  return render(floorScene(fmt::format(R"({}, "lights": [{}])", kShiny, fmt::join(lights, ", "))));
}

// A sum of n terms that are not negative rounds n times, and the material's product and the last sums 3
// times: by (n + 3)·2^-24 of itself. Two such pictures differ by both errors.
double sumError(std::size_t lights) { return 2 * (double(lights) + 3) * kUnit; }

TEST(ClosedForm, ManyLightsInOnePlaceAreManyTimesOne) {
  const std::vector<std::string> one = someLights(1);
  const Image single = renderLights(one);
  for (const std::size_t count : {2, 7, 100}) {
    const Image many = renderLights(std::vector<std::string>(count, one.front()));
    for (std::size_t i = 0; i < single.pixels.size(); ++i) {
      const double expected = double(count) * single.pixels[i];
      ASSERT_NEAR(many.pixels[i], expected, expected * sumError(count));
    }
  }
}

TEST(ClosedForm, LightFromTwoGroupsIsTheirSum) {
  const std::vector<std::string> all = someLights(50);
  const Image a = renderLights({all.begin(), all.begin() + 20}),
              b = renderLights({all.begin() + 20, all.end()});
  const Image both = renderLights(all);
  for (std::size_t i = 0; i < both.pixels.size(); ++i) {
    const double expected = double(a.pixels[i]) + b.pixels[i];
    ASSERT_NEAR(both.pixels[i], expected, expected * sumError(all.size()));
  }
}

TEST(ClosedForm, OrderOfLightsChangesNothingButRounding) {
  std::vector<std::string> lights = someLights(50);
  const Image first = renderLights(lights);
  std::mt19937 random(9);
  for (int i = 0; i < 3; ++i) {
    std::shuffle(lights.begin(), lights.end(), random);
    const Image shuffled = renderLights(lights);
    for (std::size_t k = 0; k < first.pixels.size(); ++k)
      ASSERT_NEAR(shuffled.pixels[k], first.pixels[k], first.pixels[k] * sumError(lights.size()));
  }
}

TEST(ClosedForm, ExposureDoublesWithEveryStop) {
  const std::string json = floorScene(fmt::format(R"({}, "lights": [{}])", kShiny, someLights(1).front()));
  const Image plain = render(json);
  for (const float stops : {-3.0f, 1.0f, 4.0f}) {
    const Image exposed =
        renderJson(json, {kSide, kSide}, [&](RenderSettings& settings) { settings.exposure = stops; });
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
      ASSERT_EQ(exposed.pixels[i], std::ldexp(plain.pixels[i], int(stops)));
  }
}

}  // namespace
}  // namespace luciole::test
