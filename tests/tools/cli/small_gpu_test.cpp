// What holds for GPUs: memory of their own, buffers of a limited size, small groups. Tried on a processor
// that says that it is one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class SmallGpu : public ProgramTest {
 protected:
  /// Begins a line whose devices are GPUs with these limits.
  std::string gpu(long most_bytes, int most_group) {
    if (!std::filesystem::exists(folder / "gpu.so"))
      succeed("cc -shared -fPIC -o gpu.so '" LUCIOLE_SOURCE_DIR "/tests/tools/cli/small_gpu.c' -ldl");
    writeText(folder / "log", "");
    return "export LD_PRELOAD=$PWD/gpu.so MOST_BYTES=" + std::to_string(most_bytes) +
           " MOST_GROUP=" + std::to_string(most_group) + " LOG=$PWD/log; ";
  }

  std::string log() { return readText(folder / "log"); }
};

std::string picture(const std::string& scene, const std::string& size, const std::string& options) {
  return "luciole render '" LUCIOLE_SOURCE_DIR "/scenes/" + scene + ".json' --size " + size + " " + options +
         " --hash --quiet -o a.exr";
}

TEST_F(SmallGpu, MakesThePicturesOfAnyDevice) {
  LUCIOLE_NEEDS_PROGRAM("cc", "gcc");
  const std::string hashes = readText(LUCIOLE_SOURCE_DIR "/tests/tools/devices/hashes.json");
  for (const char* scene : {"city", "colonnade", "cornell", "fireflies", "spheres", "underwater"})
    for (const char* shadows : {"hard", "exact"}) {
      const std::string out =
          succeed(gpu(128 << 20, 4) + picture(scene, "96x54", std::string("--shadows ") + shadows));
      EXPECT_THAT(hashes, HasSubstr(std::string(scene) + " " + shadows + "\": \"" + out.substr(0, 64)));
      EXPECT_EQ(log(), "") << "nothing lies in the host's memory, or is larger than the standard allows";
    }
  EXPECT_THAT(succeed(gpu(128 << 20, 1) + "luciole devices --check"), HasSubstr("1 lanes\n     bits: same"));
}

TEST_F(SmallGpu, TakesFewerRowsAtATimeWhereABufferWouldBeTooLarge) {
  LUCIOLE_NEEDS_PROGRAM("cc", "gcc");
  for (const char* options : {"--shadows hard --shadow-size 128", "--shadows off --culling none",
                              "--shadows off --samples 4", "--shadows exact --aov light_count"}) {
    const std::string line = picture("cornell", "640x600", options);
    const std::string one = succeed(line);
    EXPECT_EQ(succeed(gpu(2'000'000, 2) + line), one) << options;
    EXPECT_THAT(log(), HasSubstr("too large")) << options;
    EXPECT_THAT(log(), Not(HasSubstr("in place"))) << options;
  }
  refuse(gpu(20'000, 2) + picture("cornell", "640x600", "--shadows off"), 3, "out of memory");
}

// Also where it runs out in the middle of a layer of light: then the picture goes on with all of its lights.
TEST_F(SmallGpu, MakesTheSamePictureInSmallerPartsWhereMemoryRunsOutOnce) {
  LUCIOLE_NEEDS_PROGRAM("cc", "gcc");
  writeText(folder / "groups.json",
            R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "objects": [{"primitive": "sphere"}],
                "lights": [{"type": "point", "position": [3, 0, 3], "color": [1, 0, 0], "group": "key"},
                           {"type": "directional", "direction": [1, 0, -1], "color": [0, 0, 1], "group": "rim"},
                           {"type": "point", "position": [0, 3, 3], "color": [0, 1, 0]}]})");
  const std::string line =
      "luciole render groups.json --size 16x192 --shadows off --light-groups --aov "
      "diffuse_light,specular_light --hash --quiet -o a.exr";
  const std::string whole = succeed(gpu(1 << 30, 4) + line);
  int gone_on = 0;
  for (int at = 1;; at += 5) {
    const Outcome result =
        runLine(folder, gpu(1 << 30, 4) + "export FAIL_AT=" + std::to_string(at) + "; " + line);
    if (log().empty()) break;
    EXPECT_THAT(log(), HasSubstr("no memory"));
    if (result.status == 0) {
      EXPECT_EQ(result.out, whole) << "buffer " << at;
      ++gone_on;
    } else {
      EXPECT_EQ(result.status, 3) << result.err;  // before the first band
      EXPECT_THAT(result.err, HasSubstr("out of memory"));
    }
  }
  EXPECT_GT(gone_on, 10);
}

}  // namespace
}  // namespace luciole::test
