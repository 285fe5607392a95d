// Two sequences of pictures, and pictures side by side. Two pictures in numbers are in command_line_test.cpp.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "luciole/compare.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Compare : public ProgramTest {
 protected:
  /// Writes a picture of 4 x 2 pixels of this grey, but for one.
  void write(const std::string& name, float grey, float of_pixel_3_1) {
    Image image{4, 2, {"R", "G", "B"}, std::vector<float>(24, grey)};
    for (int c = 0; c < 3; ++c) image.pixels[7 * 3 + c] = of_pixel_3_1;
    writeImage(image, folder / name, {});
  }
  /// Frames 8 to 11, of which 9 differs by 1/4, 10 by 1/2 in one pixel, and 11 by 1/8.
  void writeSequences() {
    for (int frame = 8; frame <= 11; ++frame) write(fmt::format("a.{:03}.exr", frame), 0.5f, 0.5f);
    write("b.008.exr", 0.5f, 0.5f);
    write("b.009.exr", 0.75f, 0.75f);
    write("b.010.exr", 0.5f, 0.0f);
    write("b.011.exr", 0.625f, 0.625f);
  }
};

TEST_F(Compare, HelpDefinesEachFigureThatItPrints) {
  writeImage({1, 1, {"R", "G", "B"}, {1, 1, 1}}, folder / "a.npy", {});
  writeImage({1, 1, {"R", "G", "B"}, {1, 2, 1}}, folder / "b.pfm", {});
  const std::string figures = succeed("luciole compare a.npy b.pfm"),
                    help = succeed("luciole compare --help");
  EXPECT_NE(figures.find("max_abs 1 at (0, 0)"), std::string::npos) << figures;
  std::istringstream lines(figures);
  std::string line;
  std::getline(lines, line);  // how many pixels
  while (std::getline(lines, line))
    EXPECT_NE(help.find("\n" + line.substr(0, line.find(' ')) + " "), std::string::npos) << line;
  EXPECT_NE(succeed("luciole man").find("relmse"), std::string::npos);
}

TEST_F(Compare, SequencesAreATableWithALineAFrame) {
  writeSequences();
  const std::string table = succeed("luciole compare a.###.exr b.###.exr");
  EXPECT_THAT(table, StartsWith("| frame | max_abs |"));
  EXPECT_THAT(table, HasSubstr("\n| 8     |       0 |"));
  EXPECT_THAT(table, HasSubstr("\n| 9     |    0.25 |"));
  EXPECT_THAT(table, HasSubstr("\n| 10    |     0.5 |"));
  EXPECT_THAT(table, HasSubstr("\n| 11    |   0.125 |"));
  // One pixel of eight differs by 1/2: the mean square is 1/32, -10 log10 of which is 15.05 dB.
  EXPECT_THAT(table, EndsWith("|\nworst frame 10: max_abs 0.5 at (3, 1), psnr 15.05 dB\n"));
  EXPECT_EQ(succeed("luciole compare a.%03d.exr b.###.exr"), table) << "the place as printf has it";
  succeed("mkdir other && mv b.* other");
  EXPECT_EQ(succeed("luciole compare a.###.exr ./other/b.%03d.exr"), table);
}

TEST_F(Compare, OfFramesThatDifferByAsMuchTheWorstIsThatOfTheLargestMean) {
  writeSequences();
  write("b.011.exr", 0.0f, 0.0f);
  EXPECT_THAT(succeed("luciole compare a.###.exr b.###.exr"), HasSubstr("\nworst frame 11: max_abs 0.5 "));
  write("b.008.exr", 0.0f, 0.0f);
  EXPECT_THAT(succeed("luciole compare a.###.exr b.###.exr"), HasSubstr("\nworst frame 8: max_abs 0.5 "));
  write("b.009.exr", 0.5f, NAN);
  EXPECT_THAT(succeed("luciole compare a.###.exr b.###.exr"), HasSubstr("\nworst frame 9: max_abs inf "));
}

TEST_F(Compare, APictureOverItsLimitIsToldWithTheWorstPixel) {
  writeSequences();
  const std::string frame = "luciole compare a.010.exr b.010.exr --max-abs ";
  EXPECT_EQ(told(frame + "0.5"), "");
  refuse(frame + "0.125", 1, "max_abs 0.5 at (3, 1) is over --max-abs 0.125");
  write("b.010.exr", 0.5f, NAN);
  refuse(frame + "inf", 1, "not finite");
}

TEST_F(Compare, ChosenMetricsArePrintedAloneInTheirOrder) {
  writeSequences();
  // All values differ by 1/4 from 1/2, and are 3/4.
  EXPECT_EQ(succeed("luciole compare a.009.exr b.009.exr --metric relmse,smape,psnr --metric mape"),
            "relmse 0.240385\nsmape 0.396825\npsnr 12.04 dB\nmape 0.490196\n");
  EXPECT_EQ(succeed("luciole compare a.009.exr b.009.exr --metric max_abs"), "max_abs 0.25 at (0, 0)\n");
  const auto json =
      nlohmann::ordered_json::parse(succeed("luciole compare a.009.exr b.009.exr --metric relmse --json -"));
  for (const auto& [name, figure] : kImageMetrics) EXPECT_TRUE(json.contains(name)) << name;
  // Means leave out what isn't finite, so it is told.
  write("b.009.exr", 0.5f, NAN);
  EXPECT_EQ(succeed("luciole compare a.009.exr b.009.exr --metric mse"), "mse 0\nnonfinite 3\n");
  refuse("luciole compare a.009.exr b.009.exr --metric rmsle", 2, "'rmsle' is none of max_abs, mean_abs, ");
}

TEST_F(Compare, EachMetricHasItsLimitAndTheLineNamesThoseThatAreBroken) {
  writeSequences();
  const std::string pair = "luciole compare a.009.exr b.009.exr ";
  EXPECT_EQ(told(pair + "--metric relmse,smape,psnr --max 0.25,0.4,12"), "");
  refuse(pair + "--metric relmse,smape --max 0.25,0.3", 1, "luciole: smape 0.396825 is over --max 0.3\n");
  refuse(pair + "--metric relmse,psnr --max 0.24,12.5", 1,
         "luciole: relmse 0.240385 is over --max 0.24; psnr 12.04 dB is under --max 12.5\n");
  refuse(pair + "--metric smape --max 0.3 --max-abs 0.125", 1,
         "luciole: max_abs 0.25 at (0, 0) is over --max-abs 0.125; smape 0.396825 is over --max 0.3\n");
  // A bias either way.
  EXPECT_EQ(told(pair + "--metric mean_signed --max 0.25"), "");
  refuse("luciole compare b.009.exr a.009.exr --metric mean_signed --max 0.125", 1,
         "mean_signed -0.25 is over --max 0.125\n");
  EXPECT_EQ(told("luciole compare a.008.exr b.008.exr --metric psnr --max 1000"), "") << "infinite";
  refuse(pair + "--metric relmse,smape --max 0.25", 2,
         "--max: 1 limits for 2 metrics, expected one for each");
  refuse(pair + "--metric relmse --max -1", 2, "--max: expected numbers that are at least 0");
  refuse(pair + "--metric relmse --max nan", 2, "--max: expected numbers that are at least 0");
  refuse(pair + "--max 1", 2, "--metric");
  write("b.009.exr", 0.5f, NAN);
  refuse(pair + "--metric relmse --max inf", 1, "3 values of one picture or both are not finite\n");
}

TEST_F(Compare, MetricsOfSequencesAreTheColumnsAndTheFirstOneSaysWhichFrameIsWorst) {
  writeSequences();
  const std::string sequences = "luciole compare a.###.exr b.###.exr --metric ";
  const std::string table = succeed(sequences + "mean_abs,mse");
  EXPECT_THAT(table, StartsWith("| frame | mean_abs |      mse |\n"));
  EXPECT_THAT(table, EndsWith("\nworst frame 9: mean_abs 0.25, mse 0.0625\n"));
  EXPECT_EQ(nlohmann::json::parse(succeed(sequences + "mean_abs --json -"))["worst"]["frame"], 9);
  EXPECT_THAT(succeed(sequences + "psnr"), EndsWith("\nworst frame 9: psnr 12.04 dB\n"));
  EXPECT_EQ(told(sequences + "mean_abs,max_abs --max 0.25,0.5"), "");
  // Frame 10 is the worst by the largest difference, frame 9 by the mean.
  refuse(
      sequences + "mean_abs,max_abs --max 0.1,0.4", 1,
      "luciole: 2 of 4 frames over --max 0.1 of mean_abs; worst frame 9: mean_abs 0.25; 1 of 4 frames over "
      "--max 0.4 of max_abs; worst frame 10: max_abs 0.5 at (3, 1)\n");
  write("b.008.exr", 0.5f, NAN);
  EXPECT_THAT(succeed(sequences + "mse"), HasSubstr("| nonfinite |"));
  EXPECT_THAT(succeed(sequences + "mse"), EndsWith("\nworst frame 8: mse 0\n"));
}

TEST_F(Compare, LimitsHoldForEveryFrameAndTheWorstIsTold) {
  writeSequences();
  EXPECT_EQ(told("luciole compare a.###.exr b.###.exr --max-abs 0.5"), "");
  const Outcome outcome = runLine(folder, "luciole compare a.###.exr b.###.exr --max-abs 0.125");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err,
            "luciole: 2 of 4 frames over --max-abs 0.125; worst frame 10: max_abs 0.5 at (3, 1), psnr 15.05 "
            "dB\n");
  write("b.008.exr", 0.5f, NAN);
  EXPECT_THAT(runLine(folder, "luciole compare a.###.exr b.###.exr --max-abs inf").err,
              StartsWith("luciole: 1 of 4 frames over --max-abs inf; worst frame 8: max_abs inf at (3, 1)"));
  refuse("luciole compare a.###.exr b.###.exr --max-abs -1", 2, "--max-abs");
}

TEST_F(Compare, SequencesAsJsonAreTheFiguresOfEachPair) {
  writeSequences();
  const std::string text = succeed("luciole compare a.###.exr b.###.exr --json -");
  const auto json = nlohmann::ordered_json::parse(text);
  ASSERT_EQ(json["frames"].size(), 4u);
  for (int i = 0; i < 4; ++i) {
    auto frame = json["frames"][i];
    EXPECT_EQ(frame["frame"], 8 + i);
    frame.erase("frame");
    EXPECT_EQ(frame, nlohmann::ordered_json::parse(
                         succeed(fmt::format("luciole compare a.{0:03}.exr b.{0:03}.exr --json -", 8 + i))));
  }
  EXPECT_EQ(json["worst"], json["frames"][2]);
}

TEST_F(Compare, FramesThatOneSideLacksAreNamed) {
  writeSequences();
  succeed("rm b.008.exr b.010.exr b.011.exr");
  refuse("luciole compare a.###.exr b.###.exr --json out.json", 2,
         "b.###.exr lacks frames 8, 10-11 of a.###.exr\n");
  succeed("rm a.009.exr");
  refuse("luciole compare a.###.exr b.###.exr", 2,
         "a.###.exr lacks frame 9 of b.###.exr, and b.###.exr lacks frames 8, 10-11 of a.###.exr\n");
  refuse("luciole compare c.###.exr d/d.###.exr", 2, "c.###.exr, d/d.###.exr: no frame is there");
  refuse("luciole compare a.###.exr d/d.###.exr", 2, "d/d.###.exr lacks frames 8, 10-11 of a.###.exr");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.json"));
}

TEST_F(Compare, OnlyFilesThatRenderWouldNameSoAreFrames) {
  writeSequences();
  // Fewer or more zeros than the pattern says, no number, another end, a number beyond all frames.
  for (const char* name : {"a.8.exr", "a.0012.exr", "a.x12.exr", "a..exr", "a.-12.exr", "a.012.exr.txt",
                           "aa.012.exr", "a.10000000.exr"})
    writeText(folder / name, "no picture");
  succeed("luciole compare a.###.exr b.###.exr");
  write("a.1234.exr", 0, 0);
  refuse("luciole compare a.###.exr b.###.exr", 2, "b.###.exr lacks frame 1234 of a.###.exr");
}

TEST_F(Compare, APictureIsNoSequence) {
  writeSequences();
  refuse("luciole compare a.###.exr b.008.exr", 2, "B b.008.exr: expected a name with ####");
  refuse("luciole compare a.008.exr b.###.exr", 2, "A a.008.exr: expected a name with ####");
  for (const char* option : {"--diff", "--error-map", "--side-by-side"}) {
    refuse(fmt::format("luciole compare a.###.exr b.###.exr {} out.png", option), 2,
           fmt::format("{} out.png: expected a name with ####", option));
    refuse(fmt::format("luciole compare a.###.exr b.###.exr {} -", option), 2, "expected a name with ####");
  }
  succeed("mv a.009.exr 'a#.exr' && mv b.009.exr 'b%.exr'");
  EXPECT_THAT(succeed("luciole compare 'a#.exr' 'b%.exr'"), HasSubstr("max_abs 0.25"));
}

TEST_F(Compare, EachFrameHasItsPictures) {
  writeSequences();
  succeed("luciole compare a.###.exr b.###.exr --diff d.#.exr --error-map e.%04d.png --side-by-side s.#.png");
  for (int frame = 8; frame <= 11; ++frame) {
    EXPECT_EQ(readImage(folder / fmt::format("d.{}.exr", frame)).width, 4);
    EXPECT_EQ(readImage(folder / fmt::format("e.{:04}.png", frame)).width, 480);
    EXPECT_GT(readImage(folder / fmt::format("s.{}.png", frame)).width, 3 * 480);
  }
  EXPECT_EQ(readImage(folder / "d.9.exr").pixels[0], 2.5f);
  refuse("luciole compare a.###.exr b.###.exr --diff d.#.png --error-map d.%d.png", 2,
         "d.8.png: named for two outputs");
}

TEST_F(Compare, AFrameThatCannotBeReadIsNamed) {
  writeSequences();
  writeText(folder / "b.010.exr", "no picture");
  refuse("luciole compare a.###.exr b.###.exr --json out.json", 2, "b.010.exr");
  writeImage({2, 2, {"R", "G", "B"}, std::vector<float>(12)}, folder / "b.010.exr", {});
  refuse("luciole compare a.###.exr b.###.exr", 2, "a.010.exr, b.010.exr: 4 x 2 and 2 x 2 pixels");
}

TEST_F(Compare, SideBySideGoesToAFileOrStandardOutputAlone) {
  writeSequences();
  succeed(
      "luciole compare a.009.exr b.009.exr --side-by-side file.png && "
      "luciole compare a.009.exr b.009.exr --side-by-side - > piped.png && "
      "luciole compare file.png piped.png --max-abs 0");
  refuse("luciole compare a.009.exr b.009.exr --side-by-side out.png --diff out.png", 2,
         "out.png: named for two outputs");
  writeImage({1, 1, {"Z"}, {1}}, folder / "depth.exr", {});
  refuse("luciole compare depth.exr depth.exr --side-by-side out.png", 2,
         "depth.exr, depth.exr: channels 'Z', expected R G B or Y to look at");
  writeImage({11000, 1, {"Y"}, std::vector<float>(11000)}, folder / "wide.exr", {});
  refuse("luciole compare wide.exr wide.exr --side-by-side out.png --error-map out_map.png", 2,
         "wide.exr, wide.exr: side by side they are 33342 pixels wide, expected at most 32768");
  EXPECT_THAT(filesIn(folder), Not(testing::Contains(StartsWith("out"))));
}

TEST_F(Compare, SideBySideNamesPicturesOfOneNameByTheirFolders) {
  writeSequences();
  succeed("mkdir old new && cp a.008.exr old/f.exr && cp a.008.exr new/f.exr && cp a.008.exr new/g.exr");
  // All pictures are the same, so rows differ in the names alone.
  const auto areAlike = [&](const std::string& one, const std::string& other) {
    succeed("luciole compare " + one + " --side-by-side one.exr");
    succeed("luciole compare " + other + " --side-by-side other.exr");
    return runLine(folder, "luciole compare one.exr other.exr --max-abs 0").status == 0;
  };
  EXPECT_FALSE(areAlike("old/f.exr new/f.exr", "new/f.exr old/f.exr"));
  EXPECT_TRUE(areAlike("old/f.exr new/g.exr", "new/f.exr new/g.exr")) << "names that differ need no folder";
}

}  // namespace
}  // namespace luciole::test
