// Films: render --frames A-B -o film.mp4, and what ffmpeg reads from them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "image/srgb.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using Bytes = std::vector<unsigned char>;

/// Grey, so that a film's colours, one for 2 x 2 pixels, lose nothing. The camera turns by 45 degrees a
/// frame.
constexpr const char* kGreyScene = R"({
  "camera": {"orbit": [0, 20, 6], "target": [0, 0.5, 0],
             "keys": [{"frame": 1, "orbit": [0, 20, 6]}, {"frame": 9, "orbit": [360, 20, 6]}]},
  "size": [96, 54], "ambient": 0.2, "background": 0.1,
  "objects": [{"primitive": "plane", "scale": 10}, {"primitive": "box", "translate": [1, 0.5, 0]},
              {"primitive": "box", "translate": [-1, 1, 1], "scale": [0.5, 2, 0.5]}],
  "lights": [{"type": "directional", "direction": [-1, -2, -0.5], "color": 0.7, "shadow": true}]
})";

class Films : public ProgramTest {
 protected:
  Films() { writeText(folder / "scene.json", kGreyScene); }
  void SetUp() override { LUCIOLE_NEEDS_PROGRAM("ffmpeg", "ffmpeg"); }

  /// The frames of a film, as R G B.
  std::vector<Bytes> framesOf(const std::string& film, std::size_t width, std::size_t height) {
    succeed("ffmpeg -nostdin -v error -y -i " + film +
            " -sws_flags bicubic+accurate_rnd+full_chroma_int -f rawvideo -pix_fmt rgb24 film.raw");
    const std::string text = readText(folder / "film.raw");
    const std::size_t size = width * height * 3;
    EXPECT_EQ(text.size() % size, 0u) << film;
    std::vector<Bytes> frames;
    for (std::size_t i = 0; i + size <= text.size(); i += size)
      frames.emplace_back(text.begin() + std::ptrdiff_t(i), text.begin() + std::ptrdiff_t(i + size));
    return frames;
  }
  /// The R G B of a PNG.
  Bytes pictureOf(const std::string& path) {
    Bytes bytes;
    for (const float value : readImage(folder / path).pixels)
      bytes.push_back(static_cast<unsigned char>(std::lround(255 * encodeSrgb(value))));
    return bytes;
  }
  static double psnr(const Bytes& a, const Bytes& b) {
    EXPECT_EQ(a.size(), b.size());
    double sum = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
    return 10 * std::log10(255.0 * 255.0 * double(a.size()) / sum);
  }
  nlohmann::json streamOf(const std::string& film) {
    const std::string text = succeed(
        "ffprobe -v error -count_frames -show_entries stream=nb_read_frames,codec_name,width,height,pix_fmt,"
        "r_frame_rate,color_range,color_space,color_transfer,color_primaries -of json " +
        film);
    return nlohmann::json::parse(text).at("streams").at(0);
  }
  /// Expects a refusal that leaves nothing but the scene.
  void refuseWhole(const std::string& line, int status, const std::string& what) {
    refuse(line, status, what);
    EXPECT_EQ(filesIn(folder), std::vector<std::string>{"scene.json"}) << line;
  }
};

TEST_F(Films, HoldTheFramesInTheirOrderAndSize) {
  succeed("luciole render scene.json --frames 1-8 -o f.#.png");
  std::vector<Bytes> pictures;
  for (int frame = 1; frame <= 8; ++frame) pictures.push_back(pictureOf(fmt::format("f.{}.png", frame)));
  for (const std::string film : {"film.mp4", "film.webm"}) {
    const Outcome made = run("luciole render scene.json --frames 3-8,1-2 --fps 12 -o " + film);
    EXPECT_THAT(made.err, AllOf(StartsWith(film + ": 8 frames of 96x54, 12 a second, "), EndsWith(" ms\n")));
    const std::vector<Bytes> frames = framesOf(film, 96, 54);
    ASSERT_EQ(frames.size(), 8u) << film;
    for (int i = 0; i < 8; ++i) {
      // A limited range of 219 steps for 255 is off by half a step, 0.6, and half a code more when it is
      // shown. A quantized coefficient is off by less than its step, and so is their mean square in pixels,
      // because the transform keeps it. H.264's step is 0.625 * 2^(QP/6). crf 16 is QP 16 on average; where
      // the encoder thinks that nobody looks it goes higher, here taken for 12 more, a step of 16. VP9's at
      // crf 24 is about 13. So rounded up errors are 255/219 * 16 + 1.1 = 19.7 of 255, which is 22.2 dB.
      std::vector<double> likeness;
      for (const Bytes& picture : pictures) likeness.push_back(psnr(frames[i], picture));
      const int own = (i + 2) % 8;
      EXPECT_GT(likeness[own], 22.2) << film << " " << i;
      EXPECT_EQ(std::max_element(likeness.begin(), likeness.end()) - likeness.begin(), own)
          << film << " " << i;
      RecordProperty(fmt::format("{}_{}", film, i), fmt::format("{:.1f}", likeness[own]));
    }
    const nlohmann::json stream = streamOf(film);
    EXPECT_EQ(stream["nb_read_frames"], "8") << film;
    EXPECT_EQ(stream["codec_name"], film == "film.mp4" ? "h264" : "vp9");
    EXPECT_EQ(stream["width"], 96) << film;
    EXPECT_EQ(stream["height"], 54) << film;
    EXPECT_EQ(stream["pix_fmt"], "yuv420p") << film;
    EXPECT_EQ(stream["r_frame_rate"], "12/1") << film;
  }
}

TEST_F(Films, KeepTheirColorsAndSayHow) {
  writeText(
      folder / "scene.json",
      R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]}, "size": [64, 64], "background": [0.8, 0.05, 0.05],
                "objects": [{"primitive": "box", "translate": [0, 0, 50]}]})");
  succeed("luciole render scene.json --dither off -o one.png");
  const Bytes picture = pictureOf("one.png");
  for (const std::string film : {"film.mp4", "film.webm"}) {
    succeed("luciole render scene.json --dither off --frames 1-3 -o " + film);
    for (const Bytes& frame : framesOf(film, 64, 64)) {
      // Rounding Y, Cb and Cr moves a colour by (1.17 + 2.12) / 2 at most, and rounding it by 1/2 more. A
      // flat block is one coefficient: of 16 x 16 luma it is off by a step of 16 at most (see above), so a
      // pixel by 1.2; of 8 x 8 chroma by 2, times 2.12. Together 7.6. Colours of Rec.601 would be off by 20.
      for (std::size_t i = 0; i < frame.size(); ++i)
        ASSERT_NEAR(frame[i], picture[i], 7.6) << film << " " << i;
    }
    const nlohmann::json stream = streamOf(film);
    EXPECT_EQ(stream["color_range"], "tv") << film;
    EXPECT_EQ(stream["color_space"], "bt709") << film;
    EXPECT_EQ(stream["color_primaries"], "bt709") << film;
    EXPECT_EQ(stream["color_transfer"], "iec61966-2-1") << film;
    EXPECT_EQ(stream["r_frame_rate"], "24/1") << film;
  }
}

// Files of meshes alone are exposed by what their first frame shows.
TEST_F(Films, OfABareMeshAreExposedAsItsPicturesAre) {
  writeText(folder / "box.obj",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 1 0 -1\nv 1 1 -1\nv 0 1 -1\n"
            "f 1 2 3 4\nf 6 5 8 7\nf 4 3 7 8\nf 2 6 7 3\n");
  succeed("luciole render box.obj --size 64x36 --frames 1-2 -o f.#.png");
  const Bytes picture = pictureOf("f.2.png");
  for (const std::string film :
       {"-o film.mp4", "-o film.webm", "--format mp4 -o film", "--format webm -o -x"}) {
    const std::string name = film.substr(film.rfind(' ') + 1);
    const Outcome made = run("luciole render box.obj --size 64x36 --frames 1-2 " + film);
    EXPECT_THAT(made.err, HasSubstr(": 2 frames of 64x36")) << film;
    const std::vector<Bytes> frames = framesOf("./" + name, 64, 36);
    ASSERT_EQ(frames.size(), 2u) << film;
    EXPECT_GT(psnr(frames[1], picture), 22.2) << film;  // as HoldTheFramesInTheirOrderAndSize derives
  }
  succeed("luciole render box.obj --size 64x36 --frames 1-2 -o film.webp");
  refuse("luciole render box.obj --size 64x36 --frames 1-2 -o film.y4m", 2,
         "or a film's, .mp4, .webm or .webp");
}

TEST_F(Films, WebpIsAFilmWithoutANumberInItsName) {
  LUCIOLE_NEEDS_PROGRAM("webpmux", "webp");
  succeed("luciole render scene.json --frames 1-5 --size 33x21 -o film.webp");
  const std::string told = succeed("webpmux -info film.webp");
  EXPECT_THAT(told, HasSubstr("Canvas size: 33 x 21"));
  EXPECT_THAT(told, HasSubstr("Number of frames: 5"));
  EXPECT_THAT(told, HasSubstr("Loop Count : 0"));
  succeed("luciole render scene.json --frames 1-2 --size 33x21 -o f.#.webp");
  EXPECT_EQ(readImage(folder / "f.2.webp").width, 33);
  succeed("luciole render scene.json --size 33x21 -o one.webp");
  EXPECT_EQ(readImage(folder / "one.webp").width, 33);
}

TEST_F(Films, MayHaveOddSizesWhereTheFormatHas) {
  succeed("luciole render scene.json --frames 1-2 --size 33x21 --quiet -o film.webm");
  EXPECT_EQ(framesOf("film.webm", 33, 21).size(), 2u);
  succeed("rm film.*");
  for (const char* size : {"33x20", "32x21"})
    refuseWhole(fmt::format("luciole render scene.json --frames 1-2 --size {} -o film.mp4", size), 2,
                "pixels, expected even numbers of them for .mp4");
  succeed("luciole render scene.json --frames 1-2 --size 33x21 --crop 1,1,20,10 --format mp4 -o film");
  EXPECT_EQ(framesOf("film", 20, 10).size(), 2u);
}

TEST_F(Films, StatisticsAreOneFileAFrame) {
  succeed("luciole render scene.json --frames 1-2 --stats cost.#.json -o film.mp4");
  for (const char* name : {"cost.1.json", "cost.2.json"})
    EXPECT_EQ(nlohmann::json::parse(readText(folder / name))["image"]["width"], 96);
}

TEST_F(Films, AreEventsInALog) {
  const std::string text = told("luciole render scene.json --frames 1-3 --log json -o film.mp4");
  std::vector<nlohmann::json> done;
  int frames = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto event = nlohmann::json::parse(line);
    frames += event["event"] == "frame_done";
    if (event["event"] == "film_done") done.push_back(event);
  }
  EXPECT_EQ(frames, 3);
  ASSERT_EQ(done.size(), 1u);
  EXPECT_EQ(done[0]["file"], "film.mp4");
  EXPECT_EQ(done[0]["frames"], 3);
}

TEST_F(Films, WhatCannotBeMeantIsRefused) {
  const std::string render = "luciole render scene.json ";
  refuseWhole(render + "-o film.mp4", 2, "-o film.mp4: a film goes with --frames A-B");
  refuseWhole(render + "--frames 3 -o film.webm", 2, "-o film.webm: a film goes with --frames A-B");
  refuseWhole(render + "--frames 1-3 -o film.####.mp4", 2, "no frame's number in its name");
  refuseWhole(render + "--frames 1-3 -o - --format mp4", 2, "-: a film can't be written to a stream");
  refuseWhole(render + "--frames 1-3 -o nowhere/film.mp4", 2, "nowhere/film.mp4: no such folder");
  refuseWhole(render + "--frames 1-3 -o film.mp4 --resume", 2, "--resume: ");
  refuseWhole(render + "--frames 1-3 -o film.mp4 --aov normal", 2, "--aov: film.mp4 cannot hold layers");
  refuseWhole(render + "--frames 1-3 -o film.mp4 --stats s.json", 2, "--stats s.json: expected a name with");
  refuseWhole(render + "--frames 1-3 -o film.mp4 --camera 7", 2, "--camera 7");
  refuseWhole(render + "--frames 1-3 -o f.#.png --fps 12", 2, "--fps: goes with a film");
  refuseWhole(render + "--frames 1-3 -o film.mp4 --fps 0", 2, "--fps");
}

TEST_F(Films, OneProcessMakesAll) {
  const std::string render = "luciole render scene.json --frames 1-2 -o film.mp4";
  refuseWhole(render + " --shard 2/3", 2,
              "film.mp4: one process makes all frames of a film, and this is shard 2 of 3");
  refuseWhole(
      "SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=2 SLURM_ARRAY_TASK_STEP=1 "
      "SLURM_ARRAY_TASK_ID=1 " +
          render,
      2, "this is shard 1 of 2");
  succeed(render + " --shard 1/1");
  EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"film.mp4", "scene.json"}));
}

TEST_F(Films, WithoutFfmpegOneLineSaysWhatToInstall) {
  refuseWhole("PATH=/nonexistent luciole render scene.json --frames 1-2 -o film.mp4", 3, "install ffmpeg");
  succeed("PATH=/nonexistent luciole render scene.json --frames 1-2 -o f.#.png");
}

TEST_F(Films, AFrameThatFailsEndsTheFilm) {
  // At frame 5 the camera is above its target.
  writeText(folder / "scene.json", R"({"camera": {"eye": [0, 9, 4], "target": [0, 0, 0], "keys": [
      {"frame": 1, "eye": [0, 9, 4]}, {"frame": 9, "eye": [0, 9, -4]}]}, "size": [16, 10], "objects": [{"primitive": "box"}]})");
  refuseWhole("luciole render scene.json --frames 1-9 -o film.mp4", 2,
              "luciole: frame 5: scene.json: camera 0 at frame 5: up is parallel");
}

TEST_F(Films, AnEncoderThatFailsLeavesWhatWasThere) {
  std::filesystem::create_directory(folder / "bin");
  writeText(folder / "film.mp4", "an earlier film");
  const auto files = filesIn(folder);
  const std::string render = "luciole render scene.json --frames 1-5 -o film.mp4";
  // One that ends at once, so that frames find no reader, one that fails after all, and one that is killed.
  for (const auto& [script, what] :
       {std::pair{"echo 'no such encoder' >&2; exit 7",
                  "film.mp4: ffmpeg failed with status 7: no such encoder"},
        {"cat > /dev/null; echo >&2 'disk full\nand more'; exit 1",
         "film.mp4: ffmpeg failed with status 1: disk full\n"},
        {"head -c 1 > /dev/null; kill -9 $$", "film.mp4: ffmpeg was ended by signal 9\n"},
        {"exec 0<&-; exit 0", "film.mp4: ffmpeg ended early"}}) {
    writeText(folder / "bin/ffmpeg", std::string("#!/bin/sh\n") + script + "\n");
    std::filesystem::permissions(folder / "bin/ffmpeg", std::filesystem::perms::owner_all);
    refuse("PATH=$PWD/bin:$PATH " + render, 3, what);
    EXPECT_EQ(readText(folder / "film.mp4"), "an earlier film") << script;
    EXPECT_EQ(filesIn(folder), files) << script;
  }
  succeed(render);
  EXPECT_EQ(framesOf("film.mp4", 96, 54).size(), 5u) << "the earlier film is replaced";
}

TEST_F(Films, KilledTheyLeaveNothing) {
  const auto files = filesIn(folder);
  for (const char* signal : {"INT", "KILL"}) {
    // The program's child is ffmpeg: then frames are being made. It sees the end of its input, and ends, too.
    const Outcome outcome = runLine(
        folder,
        fmt::format("env --default-signal=INT '" LUCIOLE_BINARY
                    "' render scene.json --size 640x360 --samples 64 --frames 1-999 --quiet -o film.mp4 & "
                    "program=$!; while read -r encoder < /proc/$program/task/$program/children; "
                    "[ -z \"$encoder\" ]; do kill -0 $program || exit 9; sleep 0.05; done; "
                    "sleep 0.5; kill -{} $program; wait $program; echo $?; "
                    "for i in $(seq 200); do [ -e /proc/$encoder/exe ] || break; sleep 0.05; done; "
                    "! [ -e /proc/$encoder/exe ]",
                    signal));
    EXPECT_EQ(outcome.status, 0) << signal << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, std::string(signal) == "INT" ? "130\n" : "137\n");
    EXPECT_EQ(filesIn(folder), files) << signal;
  }
}

}  // namespace
}  // namespace luciole::test
