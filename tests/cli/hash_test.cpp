// --hash: a line that says which bits a picture has.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program_test.hpp"
#include "image/compare.hpp"
#include "image/picture_hash.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class Hash : public ProgramTest {
 protected:
  Hash() { writeText(folder / "scene.json", kSmallScene); }

  /// The digits that a command prints for one picture.
  std::string hashOf(const std::string& line, const std::string& file) {
    const Outcome outcome = runLine(folder, line + " --quiet --hash -o " + file);
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
    EXPECT_THAT(outcome.out, testing::MatchesRegex("[0-9a-f]{64}  " + file + "\n")) << line;
    return outcome.out.substr(0, 64);
  }
};

TEST_F(Hash, IsThatOfTheFloatsInTheFile) {
  const std::string hash = hashOf("luciole render scene.json --aov depth --stats s.json", "a.exr");
  EXPECT_EQ(hash, pictureHash(readImage(folder / "a.exr")));
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "s.json"))["image"]["hash"], hash);
  EXPECT_EQ(nlohmann::json::parse((succeed("luciole render scene.json -o b.exr --stats t.json"),
                                   readText(folder / "t.json")))["image"]
                .count("hash"),
            0u);
}

TEST_F(Hash, IsTheSameHoweverThePictureIsMade) {
  // Without shadows there is little to compile for so many widths.
  const std::string render = "luciole render scene.json --shadows off";
  const std::string hash = hashOf(render, "a.png");
  for (const char* way : {"--threads 1", "--tile 4", "--tile 16", "--culling none", "--device 0,lanes=1",
                          "--device 0,lanes=4", "--device 0,lanes=16"})
    EXPECT_EQ(hashOf(fmt::format("{} {}", render, way), "b.exr"), hash) << way;
  succeed("luciole gbuffer scene.json -o g.exr");
  EXPECT_EQ(hashOf("luciole shade g.exr --scene scene.json --shadows off", "c.png"), hash) << "from a file";
  EXPECT_NE(hashOf(render + " --exposure 1", "d.png"), hash);
  EXPECT_NE(hashOf(render + " --crop 0,0,96,53", "e.png"), hash);
}

TEST_F(Hash, OfFramesIsALineEach) {
  const Outcome outcome = runLine(folder, "luciole render scene.json --frames 1-2 --hash -o f.#.png --quiet");
  EXPECT_THAT(outcome.out, testing::MatchesRegex("[0-9a-f]{64}  f.1.png\n[0-9a-f]{64}  f.2.png\n"));
  EXPECT_EQ(outcome.out.substr(0, 64), outcome.out.substr(outcome.out.find('\n') + 1, 64)) << "nothing moves";
}

TEST_F(Hash, WantsStandardOutputForItself) {
  refuse("luciole render scene.json --hash -o -", 2,
         "--hash: is written to standard output, and so is the picture");
  refuse("luciole render scene.json --hash -o a.png --stats -", 2, "and so is what --stats says");
}

}  // namespace
}  // namespace luciole::test
