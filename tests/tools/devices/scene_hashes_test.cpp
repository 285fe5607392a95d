// The pictures of the shipped scenes have the same bits on every OpenCL device that is found, whatever the
// width of vectors, the number of threads and the way of culling: those whose hashes are in hashes.json (made
// by make_hashes.sh). With LUCIOLE_LONG each is made in every width.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "long_run.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

const nlohmann::ordered_json& hashes() {
  static const auto parsed = nlohmann::ordered_json::parse(
      readText(std::string(LUCIOLE_SOURCE_DIR) + "/tests/tools/devices/hashes.json"));
  return parsed;
}

/// The scenes and methods of shadows in hashes.json: "city hard" ...
std::vector<std::string> pictures() {
  std::vector<std::string> names;
  for (const auto& [name, hash] : hashes().items()) names.push_back(name);
  return names;
}

class SceneHashes : public ProgramTest, public testing::WithParamInterface<std::string> {
 protected:
  /// Expects the hash of a picture that the program makes with these options. settings: variables of the
  /// environment before the command.
  void expectHash(const std::string& options, const std::string& settings = {}) {
    EXPECT_EQ(succeed(settings + "luciole " + line("96x54", options)).substr(0, 64),
              hashes()[GetParam()].get<std::string>())
        << settings << GetParam() << " " << options;
  }

  /// What follows "luciole" on the command line.
  static std::string line(const std::string& size, const std::string& options) {
    const std::string picture = GetParam();
    const std::size_t blank = picture.find(' ');
    return "render '" LUCIOLE_SOURCE_DIR "/scenes/" + picture.substr(0, blank) + ".json' --size " + size +
           " --shadows " + picture.substr(blank + 1) + " " + options + " --hash --quiet -o a.exr";
  }
};

TEST_P(SceneHashes, AreThoseOfEveryDeviceWidthThreadAndWayOfCulling) {
  const std::string listed = succeed("luciole devices");
  const auto devices = std::count(listed.begin(), listed.end(), '\n');
  ASSERT_GT(devices, 0);
  // Each picture's own program is optimized once. Otherwise pictures share the general program where they
  // can, none is optimized, and each has one width, so that every width makes pictures of both methods of
  // shadows.
  const std::string quickly = longRun() ? "" : "LUCIOLE_OPTIMIZE=0 LUCIOLE_GENERAL=1 ";
  std::vector<int> widths{1, 4, 8, 16};
  if (!longRun()) {
    const auto names = pictures();
    const auto index = std::size_t(std::find(names.begin(), names.end(), GetParam()) - names.begin());
    widths = {widths[(index + index / widths.size()) % widths.size()]};
  }
  for (auto device = 0; device < devices; ++device) {
    const std::string selector = "--device " + std::to_string(device);
    expectHash(selector + " --threads 1");
    for (const int lanes : widths) expectHash(selector + ",lanes=" + std::to_string(lanes), quickly);
    for (const char* options : {" --culling none", " --tile 16"}) expectHash(selector + options, quickly);
  }
}

// An interpreter of OpenCL. Its pictures are small, so they are held to those of the default device, whose
// larger ones are held to the hashes above.
class SceneHashesUnderOclgrind : public SceneHashes {};

TEST_P(SceneHashesUnderOclgrind, AreTheSame) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  const std::string size = "32x18", expected = succeed("luciole " + line(size, ""));
  for (const char* lanes : {"1", "16"})
    EXPECT_EQ(underOclgrind(line(size, std::string("--require-exact --device ,lanes=") + lanes)), expected)
        << lanes << " lanes";
}

std::string nameOf(const testing::TestParamInfo<std::string>& test) {
  std::string name = test.param;
  name.replace(name.find(' '), 1, "_");
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneHashesUnderOclgrind,
                         testing::Values("cornell hard", "cornell exact", "spheres hard", "underwater hard",
                                         "colonnade hard"),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(Scenes, SceneHashes, testing::ValuesIn(pictures()), nameOf);

}  // namespace
}  // namespace luciole::test
