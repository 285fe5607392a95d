// --hash: what it prints, and that all that may not change a picture doesn't change it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "image/picture_hash.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

class Hashes : public ProgramTest {
 protected:
  Hashes() { writeText(folder / "scene.json", kSmallScene); }

  /// The hash of the one line that is printed, about this file.
  std::string hashOf(const std::string& line, const std::string& file) {
    const std::string out = succeed(line + " --hash --quiet -o " + file);
    EXPECT_THAT(out, MatchesRegex("[0-9a-f]{64}  [^\n]*\n")) << line;
    EXPECT_EQ(out.substr(64), "  " + file + "\n") << line;
    return out.substr(0, 64);
  }
};

TEST_F(Hashes, IsThatOfTheFloatsInALosslessExr) {
  const std::string hash = hashOf("luciole render scene.json", "a.exr");
  EXPECT_EQ(pictureHash(readImage(folder / "a.exr")), hash);
  const std::string alpha = hashOf("luciole render scene.json --alpha", "b.exr");
  EXPECT_EQ(pictureHash(readImage(folder / "b.exr")), alpha);
  EXPECT_NE(alpha, hash);
  const std::string brighter = hashOf("luciole render scene.json --exposure 1.5", "c.exr");
  EXPECT_EQ(pictureHash(readImage(folder / "c.exr")), brighter);
  EXPECT_NE(brighter, hash);
}

TEST_F(Hashes, NeitherFileNorWorkChangesIt) {
  const std::string hash = hashOf("luciole render scene.json", "a.exr");
  for (const char* options : {"--half", "--compression dwaa", "--aov position,depth,shadow", "--culling none",
                              "--tile 16", "--threads 1", "--device ,lanes=1", "--device ,lanes=4"})
    EXPECT_EQ(hashOf(std::string("luciole render scene.json ") + options, "b.exr"), hash) << options;
  for (const char* options : {"--bits 16", "--dither off", "--tone filmic"})
    EXPECT_EQ(hashOf(std::string("luciole render scene.json ") + options, "b.png"), hash) << options;
  EXPECT_NE(hashOf("luciole render scene.json --size 95x54", "c.png"), hash);
}

TEST_F(Hashes, ShadeAndRelightHaveThemToo) {
  const std::string hash = hashOf("luciole render scene.json", "a.png");
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  EXPECT_EQ(hashOf("luciole shade g.exr --scene scene.json", "b.png"), hash);
  const std::string relit = hashOf("luciole relight g.exr --lights scene.json", "c.exr");
  EXPECT_EQ(pictureHash(readImage(folder / "c.exr")), relit);
}

TEST_F(Hashes, ALightMapHasOne) {
  const std::string hash = hashOf("luciole bake scene.json --object plane --size 32x32", "map.exr");
  EXPECT_EQ(pictureHash(readImage(folder / "map.exr")), hash);
}

TEST_F(Hashes, EachFrameAndCameraHasALineAndCropsTheirOwn) {
  const std::string two = succeed("luciole render scene.json --frames 3,5 --hash --quiet -o f.##.exr");
  const std::string hash = hashOf("luciole render scene.json --frames 5", "f.exr");
  EXPECT_EQ(two, hash + "  f.03.exr\n" + hash + "  f.05.exr\n") << "nothing moves in this scene";
  const std::string crop = hashOf("luciole render scene.json --crop 16,16,32,20", "crop.exr");
  EXPECT_EQ(pictureHash(readImage(folder / "crop.exr")), crop);
}

TEST_F(Hashes, StatisticsAndEventsTellThem) {
  const Outcome outcome = run("luciole render scene.json --hash --stats stats.json --log json -o a.exr");
  const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
  const std::string hash = stats["image"]["hash"];
  EXPECT_EQ(outcome.out, hash + "  a.exr\n");
  EXPECT_THAT(outcome.err, HasSubstr("\"hash\":\"" + hash + "\""));
  succeed("luciole render scene.json --stats stats.json --quiet -o a.exr");
  EXPECT_FALSE(nlohmann::json::parse(readText(folder / "stats.json"))["image"].contains("hash"));
}

TEST_F(Hashes, StandardOutputIsNotShared) {
  refuse("luciole render scene.json --hash -o -", 2, "--hash: standard output can't take it and -o -");
  refuse("luciole shade g.exr --scene scene.json --hash --stats - -o a.png", 2, "and --stats -");
  refuse("luciole render scene.json --hash --trace - -o a.png", 2, "and --trace -");
  refuse("luciole render scene.json --hash --stats - --frames 1-2 -o a.mp4", 2, "and --stats -");
}

TEST_F(Hashes, AFilmHasALineAFrame) {
  LUCIOLE_NEEDS_PROGRAM("ffmpeg", "ffmpeg");
  const std::string film = succeed("luciole render scene.json --frames 1-2 --hash --quiet -o film.mp4");
  const std::string hash = hashOf("luciole render scene.json", "a.exr");
  EXPECT_EQ(film, hash + "  film.mp4\n" + hash + "  film.mp4\n");
}

}  // namespace
}  // namespace luciole::test
