#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "shared_files.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class UserModelCommands : public ProgramTest {
 protected:
  void write(const std::string& name, const std::string& body) {
    writeText(folder / name,
              "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l) {\n" + body +
                  "}\n");
  }
  const std::string scene = LUCIOLE_SOURCE_DIR "/scenes/cornell.json";
};

TEST_F(UserModelCommands, RenderByAFileAndByAMaterialsFileBesideTheScene) {
  write("half.clh", "  Reflection r = {0.5f * n_dot_l};\n  return r;\n");
  std::filesystem::create_directory(folder / "scenes");
  std::filesystem::copy(folder / "half.clh", folder / "scenes/half.clh");
  const std::string lit = R"("lights": [{"type": "directional", "direction": [-1, -2, -1]}],
      "camera": {"eye": [0, 1, 4], "target": [0, 0, 0]}, "objects": [{"primitive": "sphere", "material": "m"}]})";
  writeText(folder / "scenes/of_material.json",
            R"({"materials": {"m": {"diffuse": 0.8, "model": "half.clh"}}, )" + lit);
  writeText(folder / "scenes/dimmed.json",
            R"({"materials": {"m": {"diffuse": 0.4, "ambient": 0.8}}, )" + lit);
  writeText(folder / "scenes/plain.json", R"({"materials": {"m": {"diffuse": 0.8}}, )" + lit);
  const std::string size = " --quiet --size 64x48 -o ";
  succeed("luciole render scenes/of_material.json" + size + "of_material.exr");
  succeed("luciole render scenes/dimmed.json" + size + "dimmed.exr");
  succeed("luciole render scenes/plain.json --model half.clh" + size + "option.exr");
  expectSamePicture("of_material.exr", "dimmed.exr");
  expectSamePicture("option.exr", "dimmed.exr");
  succeed("luciole reference scenes/of_material.json --quiet --size 64x48 -o truth.exr");
  succeed("luciole compare truth.exr of_material.exr --max-abs 2e-6");
}

TEST_F(UserModelCommands, BadFilesGetOneLineWithTheirPlaceAndLeaveNothing) {
  write("undeclared.clh", "  floatL a = lost;\n  Reflection r = {a};\n  return r;\n");
  write("loop.clh", "  while (1) ;\n");
  writeText(folder / "other.clh", "INLINE floatL lobe(floatL x) { return x; }\n");
  writeText(folder / "long.clh", std::string(10'000, '\n'));
  const std::string render = "luciole render " + scene + " --size 32x32 -o out.png --model ";
  refuse(render + "absent.clh", 2, "absent.clh");
  refuse(render + "undeclared.clh", 2, "undeclared.clh:2:14: ");
  refuse(render + "loop.clh", 2, "loop.clh:2:3: `while`");
  refuse(render + "other.clh", 2, "other.clh: has no reflect_light()");
  refuse(render + "long.clh", 2, "long.clh: has 10000 lines, expected 2000 at most");
  refuse("luciole check-model undeclared.clh", 2, "undeclared.clh:2:14: ");
  refuse("luciole check-model gouraud", 2, "expected phong");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
}

TEST_F(UserModelCommands, FaultyLightIsToldOnceWithItsPixels) {
  write("nan.clh", "  Reflection r = {n_dot_l > 0.5f ? NAN : n_dot_l};\n  return r;\n");
  const Outcome outcome =
      runLine(folder, "luciole render " + scene +
                          " --size 32x32 --samples 4 -o out.png --stats s.json --model nan.clh");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("a model from a file gave NaN, infinite or negative light at "));
  EXPECT_EQ(outcome.err.find("gave NaN"), outcome.err.rfind("gave NaN"));
}

TEST_F(UserModelCommands, LooseArithmeticIsWarnedOfAndRefusedWhereBitsMustBeExact) {
  write("loose.clh", "  Reflection r = {n_dot_l * sqrt(s->n_dot_v * s->n_dot_v)};\n  return r;\n");
  const std::string render = "luciole render " + scene + " --size 32x32 -o out.png --model loose.clh";
  EXPECT_THAT(
      told(render),
      HasSubstr("loose.clh:2:29: the last bits of sqrt() differ between devices; x * rsqrt_lanes(x)"));
  refuse(render + " --require-exact --quiet", 2, "loose.clh:2:29: ");
}

TEST_F(UserModelCommands, CheckModelSaysWhatIsBrokenByItsStatus) {
  write("good.clh", "  Reflection r = {n_dot_l};\n  return r;\n");
  write("bad.clh", "  Reflection r = {-n_dot_l};\n  return r;\n");
  succeed("luciole check-model good.clh --json good.json --plot good.svg");
  EXPECT_TRUE(std::filesystem::exists(folder / "good.svg"));
  EXPECT_TRUE(nlohmann::json::parse(readText(folder / "good.json"))["broken"].empty());
  const Outcome bad = runLine(folder, "luciole check-model bad.clh --json -");
  EXPECT_EQ(bad.status, 1);
  EXPECT_FALSE(nlohmann::json::parse(bad.out)["broken"].empty());
}

}  // namespace
}  // namespace luciole::test
