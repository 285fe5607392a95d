// Every scene at hand, through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

std::vector<std::filesystem::path> sceneFiles(const std::filesystem::path& root,
                                              const std::set<std::string>& extensions) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (entry.is_regular_file() && extensions.count(entry.path().extension().string()))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

const std::set<std::string> kMeshes{".obj", ".gltf", ".glb"};

/// Renders a file, without the pictures that it names and that it came without, and expects a picture, or one
/// clear line and exit status 2 and no file. Returns whether it rendered.
bool renderedOrRefused(const TemporaryFolder& folder, const std::filesystem::path& file) {
  const Outcome outcome =
      runLine(folder, "luciole render --quiet --missing-textures warn --size 64x36 -o out.png '" +
                          file.string() + "'");
  const bool exists = std::filesystem::exists(folder / "out.png");
  std::filesystem::remove(folder / "out.png");
  EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << file << ": status " << outcome.status << "\n"
                                                          << outcome.err;
  EXPECT_EQ(exists, outcome.status == 0) << file;
  EXPECT_TRUE(outcome.status == 0 || isOneLine(outcome.err)) << file << "\n" << outcome.err;
  return outcome.status == 0;
}

class OwnScene : public testing::TestWithParam<const char*> {};

TEST_P(OwnScene, LooksTheSameWithAndWithoutCulling) {
  const TemporaryFolder folder;
  const std::string scene = "'" LUCIOLE_SOURCE_DIR "/scenes/" + std::string(GetParam()) + ".json'";
  const std::string render = "luciole render " + scene + " --quiet --size 320x180 ";
  const Outcome outcome =
      runLine(folder, render + "-o a.exr && " + render +
                          "--culling none -o b.exr && luciole compare a.exr b.exr --max-abs 0");
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnScene,
                         testing::Values("fireflies", "cornell", "colonnade", "underwater", "spheres",
                                         "city"),
                         [](const auto& test) { return std::string(test.param); });

// Each light at each pixel of a larger picture would take long.
TEST(Lanterns, LightByClustersIsWithinTheBoundThatIsTold) {
  const TemporaryFolder folder;
  const std::string render =
      "luciole render '" LUCIOLE_SOURCE_DIR "/scenes/lanterns.json' --quiet --size 96x54 ";
  ASSERT_EQ(runLine(folder, render + "-o exact.exr").status, 0);
  ASSERT_EQ(runLine(folder, render + "--light-error 1/256 --stats s.json -o clusters.exr").status, 0);
  const auto stats = nlohmann::json::parse(readText(folder / "s.json"));
  EXPECT_EQ(stats["counts"]["lights_stood_for"], 366866);
  EXPECT_EQ(stats["counts"]["lights_exact"], 1) << "the moon";
  // What the exact picture's sums of two floats round is some thousandth of this.
  const std::string largest = stats["light_error"]["largest"].dump();
  const Outcome compared = runLine(folder, "luciole compare exact.exr clusters.exr --max-abs " + largest);
  EXPECT_EQ(compared.status, 0) << compared.out << compared.err;
}

TEST(SharedScenes, ValidOnesRender) {
  LUCIOLE_NEEDS_SHARED();
  const TemporaryFolder folder;
  for (const auto& file : sceneFiles(sharedScenes(), kMeshes)) {
    const std::string name = file.lexically_relative(sharedScenes()).string();
    if (name.rfind("malformed_", 0) == 0) continue;
    EXPECT_TRUE(renderedOrRefused(folder, file)) << name;
  }
}

class MalformedScenes : public testing::TestWithParam<const char*> {};

TEST_P(MalformedScenes, EndInAPictureOrOneClearLine) {
  LUCIOLE_NEEDS_SHARED();
  const TemporaryFolder folder;
  int rendered = 0, count = 0;
  for (const auto& file : sceneFiles(sharedScenes() / GetParam(), {".obj", ".gltf", ".glb", ".ply"})) {
    rendered += renderedOrRefused(folder, file);
    ++count;
  }
  EXPECT_GT(count, 0);
  EXPECT_LT(rendered, count);  // some are broken beyond rendering
}

INSTANTIATE_TEST_SUITE_P(Folders, MalformedScenes,
                         testing::Values("malformed_assimp/OBJ", "malformed_assimp/glTF2",
                                         "malformed_assimp/invalid", "malformed_tinyobjloader"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

}  // namespace
}  // namespace luciole::test
