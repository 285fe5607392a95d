// What the program says of --shading gouraud where triangles are too large for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kLargeTriangles =
    "luciole: warning: coarse.json: --shading gouraud lights the corners of triangles, "
    "and some are up to 14.1 m wide: light ";

class GouraudWarning : public ProgramTest {
 protected:
  GouraudWarning() {
    for (const char* segments : {"1", "64"})
      writeText(folder / (std::string(segments) == "1" ? "coarse.json" : "fine.json"),
                R"({"camera": {"eye": [0, 5, 8], "target": [0, 0, 0]}, "size": [32, 18],
                "objects": [{"primitive": "plane", "scale": 10, "segments": )" +
                    std::string(segments) + R"(}],
                "lights": [{"type": "spot", "position": [0.5, 4, 1], "direction": [0, -1, 0], "cutoff": 15}]})");
  }
};

TEST_F(GouraudWarning, IsOneLineWhereTrianglesAreMuchLargerThanTheirLights) {
  for (const char* command :
       {"render coarse.json -o a.exr", "gbuffer coarse.json -o g.exr", "reference coarse.json -o r.exr",
        "render coarse.json --frames 1-3 -o a.#.exr"}) {
    const std::string said = told(std::string("luciole ") + command + " --shading gouraud");
    const std::size_t first = said.find(kLargeTriangles);
    EXPECT_NE(first, std::string::npos) << command << "\n" << said;
    EXPECT_EQ(said.find(kLargeTriangles, first + 1), std::string::npos) << "once: " << command;
  }
}

TEST_F(GouraudWarning, IsSilencedByQuietAndListedByStats) {
  EXPECT_EQ(told("luciole render coarse.json --shading gouraud --quiet --stats s.json -o a.exr"), "");
  const nlohmann::json stats = nlohmann::json::parse(readText(folder / "s.json"));
  ASSERT_EQ(stats["warnings"].size(), 1u);
  EXPECT_THAT(stats["warnings"][0].get<std::string>(), HasSubstr("coarse.json: --shading gouraud"));
}

TEST_F(GouraudWarning, IsNotGivenForFineTrianglesOrOtherShading) {
  for (const char* line :
       {"luciole render fine.json --shading gouraud -o a.exr", "luciole render coarse.json -o a.exr",
        "luciole render coarse.json --shading flat -o a.exr"})
    EXPECT_THAT(told(line), Not(HasSubstr("warning"))) << line;
}

}  // namespace
}  // namespace luciole::test
