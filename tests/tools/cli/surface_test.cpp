// --surface of the commands that take it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class SurfaceOption : public ProgramTest {
 protected:
  SurfaceOption() {
    writeText(folder / "plain.json", sceneOf(1));
    writeText(folder / "half.json", sceneOf(0.5));
    write("half.clh", "s->diffuse.x *= 0.5f; s->diffuse.y *= 0.5f; s->diffuse.z *= 0.5f;");
  }

  static std::string sceneOf(double diffuse) {
    return R"({"camera": {"eye": [2, 2, 3], "target": [0, 0, 0]}, "materials": {"m": {"diffuse": )" +
           std::to_string(diffuse) + R"(, "specular": 0}},
      "objects": [{"primitive": "box", "material": "m"}], "lights": [{"type": "directional", "direction": [-1, -3, -2]}]})";
  }

  void write(const std::string& file, const std::string& body) {
    writeText(folder / file, "INLINE void surface(Surface *s) {\n" + body + "\n}\n");
  }
};

TEST_F(SurfaceOption, EveryCommandLightsTheChangedSurface) {
  run("luciole render half.json --size 40x30 --quiet -o want.exr");
  run("luciole render plain.json --surface half.clh --size 40x30 --quiet -o render.exr");
  expectSamePicture("render.exr", "want.exr");
  run("luciole gbuffer plain.json --surface half.clh --size 40x30 --quiet -o changed.exr");
  run("luciole shade changed.exr --scene plain.json --quiet -o of_changed.exr");
  run("luciole gbuffer half.json --size 40x30 --quiet -o half.exr");
  run("luciole shade half.exr --scene plain.json --quiet -o of_half.exr");
  expectSamePicture("of_changed.exr", "of_half.exr");
  run("luciole gbuffer plain.json --size 40x30 --quiet -o given.exr");
  run("luciole shade given.exr --scene plain.json --surface half.clh --quiet -o of_given.exr");
  expectSamePicture("of_given.exr", "of_half.exr");
  run("luciole relight given.exr --lights plain.json --surface half.clh --quiet -o relight.exr");
  expectSamePicture("relight.exr", "of_half.exr");
  run("luciole reference half.json --size 40x30 --quiet -o truth.exr");
  run("luciole reference plain.json --surface half.clh --size 40x30 --quiet -o reference.exr");
  expectSamePicture("reference.exr", "truth.exr");
  run("luciole reference --gbuffer given.exr --scene plain.json --surface half.clh --quiet -o of_file.exr");
  run("luciole reference --gbuffer half.exr --scene plain.json --quiet -o of_half_file.exr");
  expectSamePicture("of_file.exr", "of_half_file.exr");
}

TEST_F(SurfaceOption, MayStandSeveralTimesInOrder) {
  writeText(folder / "quarter.json", sceneOf(0.25));
  run("luciole render quarter.json --size 40x30 --quiet -o want.exr");
  run("luciole render plain.json --surface half.clh --surface half.clh --size 40x30 --quiet -o twice.exr");
  expectSamePicture("twice.exr", "want.exr");
}

TEST_F(SurfaceOption, MistakesAreToldWithTheirPlaceAndNothingIsWritten) {
  write("name.clh", "  s->diffuse.x = tint;");
  write("loop.clh", "while (true) {}");
  const std::string line = "luciole render plain.json --size 8x8 -o none.exr --surface ";
  refuse(line + "name.clh", 2, "name.clh:2:18: ");
  refuse(line + "loop.clh", 2, "loop.clh:2:1: ");
  refuse(line + "gone.clh", 2, "gone.clh: no such file");
  EXPECT_FALSE(std::filesystem::exists(folder / "none.exr"));
}

TEST_F(SurfaceOption, FaultsAreToldOnceWithTheirCount) {
  write("nan.clh", "s->diffuse.x = quotient_lanes(s->uv.x, s->uv.x - s->uv.x);");
  const std::string told_of = told("luciole render plain.json --size 40x30 --surface nan.clh -o nan.exr");
  EXPECT_THAT(told_of, HasSubstr("warning: a file of --surface gave NaN"));
  EXPECT_EQ(told_of.find("warning"), told_of.rfind("warning"));
  run("luciole render plain.json --size 40x30 --quiet -o want.exr");
  expectSamePicture("nan.exr", "want.exr");
}

TEST_F(SurfaceOption, ArithmeticThatDevicesRoundDifferentlyIsWarnedOf) {
  write("loose.clh", "s->diffuse.x = s->diffuse.x / 2.0f;");
  EXPECT_THAT(told("luciole render plain.json --size 8x8 --surface loose.clh -o loose.exr"),
              HasSubstr("warning: loose.clh:2:"));
}

}  // namespace
}  // namespace luciole::test
