// --samples-shading: what of a pixel's samples is shaded.
#include <nlohmann/json.hpp>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using nlohmann::json;

struct Samples : ProgramTest {
  Samples() { writeText(folder / "scene.json", kSmallScene); }
};

TEST_F(Samples, AreSharedUnlessAllAreAskedFor) {
  succeed("luciole render scene.json --samples 8 --stats usual.json -o usual.exr");
  succeed("luciole render scene.json --samples 8 --samples-shading shared -o shared.exr");
  succeed("luciole render scene.json --samples 8 --samples-shading all --stats all.json -o all.exr");
  const auto pixels = [&](const char* file) { return readImage(folder / file).pixels; };
  EXPECT_TRUE(pixels("usual.exr") == pixels("shared.exr"));
  EXPECT_FALSE(pixels("usual.exr") == pixels("all.exr"));
  const auto lit = [&](const char* file) {
    return json::parse(readText(folder / file))["counts"]["pixels_lit"].get<double>();
  };
  EXPECT_LT(2 * lit("usual.json"), lit("all.json"));
}

TEST_F(Samples, OtherWaysAreRefused) {
  refuse("luciole render scene.json --samples 8 --samples-shading some -o a.exr", 2, "--samples-shading");
  refuse("luciole reference scene.json --samples 8 --samples-shading all -o a.exr", 2, "--samples-shading");
}

}  // namespace
}  // namespace luciole::test
