// luciole illuminance: lux on a grid, held against closed forms of direct light. Cases are those of CIE
// 171:2006, "Test Cases to Assess the Accuracy of Lighting Computer Programs", part 5, as far as they are of
// direct light in the open: point sources on a horizontal plane, and area sources on planes parallel and at
// right angles to them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

struct LuxAt {
  double x, y, z, lux;
};

std::vector<LuxAt> rowsOf(const std::string& csv) {
  std::vector<LuxAt> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x,y,z,lux");
  for (char comma; std::getline(lines, line);) {
    std::istringstream of(line);
    LuxAt row{};
    of >> row.x >> comma >> row.y >> comma >> row.z >> comma >> row.lux;
    rows.push_back(row);
  }
  return rows;
}

class IlluminanceCommand : public ProgramTest {
 protected:
  /// The grid's rows for the lights of a scene.
  std::vector<LuxAt> measure(const std::string& lights, const std::string& plane, const std::string& grid,
                             const std::string& objects = "[]") {
    writeText(folder / "lit.json", R"({"objects": )" + objects + R"(, "lights": )" + lights + "}");
    const auto result =
        run("luciole illuminance " + (folder / "lit.json") + " --plane=" + plane + " --grid " + grid);
    EXPECT_EQ(result.status, 0) << result.err;
    return rowsOf(result.out);
  }
};

// A plane 4 m wide at a height of 0, seen from above: corners run counter-clockwise.
constexpr const char* kFloor = "-2,0,-2:-2,0,2:2,0,2";

// What a float picture keeps: a light of about 40 operations, each of 2^-24 relatively, and six digits of
// CSV.
constexpr double kRounding = 40 * 0x1p-24 + 5e-6;

TEST_F(IlluminanceCommand, OfAPointSourceIsIntensityTimesCosineCubedByHeightSquared) {
  const std::vector<LuxAt> rows =
      measure(R"([{"type": "point", "position": [0, 3, 0], "color": 1000, "attenuation": [0, 0, 1]}])",
              kFloor, "0.5x0.5");
  ASSERT_EQ(rows.size(), 64u);
  for (const LuxAt& row : rows) {
    const double d2 = row.x * row.x + 9 + row.z * row.z;
    EXPECT_NEAR(row.lux, 1000 * 3 / (d2 * std::sqrt(d2)), kRounding * row.lux) << row.x << " " << row.z;
  }
}

TEST_F(IlluminanceCommand, OfSunlightIsItsLuxTimesTheCosine) {
  for (const LuxAt& row :
       measure(R"([{"type": "directional", "direction": [0, -4, 3], "color": 80000}])", kFloor, "2x2"))
    EXPECT_NEAR(row.lux, 80000 * 0.8, kRounding * row.lux);
}

/// The configuration factor of a parallel rectangle with a corner above the
/// point, a × b at a distance of h (H. Hottel): E = π L F.
double cornerFactor(double a, double b, double h) {
  const double x = a / h, y = b / h, root_x = std::sqrt(1 + x * x), root_y = std::sqrt(1 + y * y);
  return (x / root_x * std::atan(y / root_x) + y / root_y * std::atan(x / root_y)) / (2 * std::acos(-1.0));
}

TEST_F(IlluminanceCommand, OfARectangularSourceIsItsConfigurationFactors) {
  // 2 m × 2 m, 3 m above the middle: luminance 1000 cd/m².
  const std::vector<LuxAt> rows = measure(
      R"([{"type": "rectangle", "position": [0, 3, 0], "direction": [0, -1, 0], "width": 2, "height": 2,
                   "color": 1000, "count": 65536}])",
      "-0.5,0,-0.5:-0.5,0,0.5:0.5,0,0.5", "1x1");
  ASSERT_EQ(rows.size(), 1u);
  const double truth = std::acos(-1.0) * 1000 * 4 * cornerFactor(1, 1, 3);
  // The midpoint rule with cells of 1/128 m at 3 m: (1/128/3)² / 24 times the second derivatives, which are
  // of order 10, gives 3e-6.
  EXPECT_NEAR(rows[0].lux, truth, 1e-5 * truth);
}

TEST_F(IlluminanceCommand, KnowsShadows) {
  const std::vector<LuxAt> rows = measure(
      R"([{"type": "point", "position": [0, 4, 0], "color": 100, "attenuation": [0, 0, 1], "shadow": true}])",
      kFloor, "1x1", R"([{"primitive": "plane", "translate": [0, 2, 0], "scale": 0.8}])");
  ASSERT_EQ(rows.size(), 16u);
  int dark = 0;
  for (const LuxAt& row : rows) {
    const bool is_near = std::abs(row.x) < 1 && std::abs(row.z) < 1;
    dark += row.lux == 0;
    if (!is_near) {
      EXPECT_GT(row.lux, 1) << row.x << " " << row.z;
    }
  }
  EXPECT_EQ(dark, 4);
}

TEST_F(IlluminanceCommand, TellsMeanLeastAndUniformity) {
  writeText(
      folder / "lit.json",
      R"({"lights": [{"type": "point", "position": [0, 3, 0], "color": 9, "attenuation": [0, 0, 1]}]})");
  const auto result = run("luciole illuminance " + (folder / "lit.json") + " --plane=" + std::string(kFloor) +
                          " --grid 4x4 -o " + (folder / "lux.csv"));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err,
              HasSubstr("1 points: mean 1 lux, least 1, most 1; least/mean 1.0000, least/most 1.0000"));
  EXPECT_EQ(rowsOf(readText(folder / "lux.csv")).size(), 1u);
}

TEST_F(IlluminanceCommand, SaysWhichSideItIsThatNoLightReaches) {
  writeText(
      folder / "lit.json",
      R"({"lights": [{"type": "point", "position": [0, 3, 0], "color": 9, "attenuation": [0, 0, 1]}]})");
  const auto result = run("luciole illuminance " + (folder / "lit.json") +
                          " --plane=2,0,2:-2,0,2:-2,0,-2 --grid 4x4 -o " + (folder / "lux.csv"));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err,
              HasSubstr("1 points: 0 lux, from where the corners of --plane run counter-clockwise"));
}

TEST_F(IlluminanceCommand, FaultsOfItsGridAreTold) {
  writeText(folder / "lit.json", R"({"lights": []})");
  const auto fault = [&](const std::string& options) {
    const Outcome result = runLine(folder, "luciole illuminance lit.json " + options);
    EXPECT_EQ(result.status, 2) << options;
    return result.err;
  };
  EXPECT_THAT(fault("--plane 0,0,0:1,0,0"), HasSubstr("--plane: 2 corners, expected three"));
  EXPECT_THAT(fault("--plane 0,0,0:1,0,0:2,0,0"), HasSubstr("lie on one line"));
  EXPECT_THAT(fault("--plane 0,0,0:1,0,x:2,0,0"), HasSubstr("expected a number, got \"x\""));
  EXPECT_THAT(fault("--plane 0,0,0:1,0,0:1,0,1 --grid 0x1"), HasSubstr("expected metres above 0"));
  EXPECT_THAT(fault("--plane 0,0,0:1,0,0:1,0,1 --grid 1e-6x1e-6"), HasSubstr("points, expected"));
}

TEST_F(IlluminanceCommand, IsALayerOfPicturesAndALineOfProbes) {
  writeText(folder / "lit.json", R"({"camera": {"eye": [0, 5, 0.01], "target": [0, 0, 0]}, "size": [33, 33],
    "materials": {"dark": {"diffuse": [0.1, 0, 0], "model": "toon", "specular": 0.5, "emission": 2}},
    "fog": {"mode": "exp", "density": 0.2}, "ambient": 0.7,
    "objects": [{"primitive": "plane", "scale": 8, "material": "dark"}],
    "lights": [{"type": "point", "position": [0, 3, 0], "color": 900, "attenuation": [0, 0, 1]}]})");
  const auto made = run("luciole render " + (folder / "lit.json") + " --aov illuminance --exposure -4 -o " +
                        (folder / "lit.exr"));
  ASSERT_EQ(made.status, 0) << made.err;
  const Image picture = readImage(folder / "lit.exr");
  const auto channel =
      std::find(picture.channels.begin(), picture.channels.end(), "illuminance.G") - picture.channels.begin();
  ASSERT_LT(std::size_t(channel), picture.channels.size());
  // The pixel in the middle sees a point within 2 cm of the middle: 100 lux, times 1 - 3/2 (0.02/3)².
  EXPECT_NEAR(picture.pixels[(16 * 33 + 16) * picture.channels.size() + std::size_t(channel)], 100, 0.01);
  const auto probed = run("luciole render " + (folder / "lit.json") + " --probe 16,16");
  EXPECT_THAT(probed.out, HasSubstr("illuminance: 100 lux"));
}

}  // namespace
}  // namespace luciole::test
