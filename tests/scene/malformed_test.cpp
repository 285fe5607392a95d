#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/scene.hpp"
#include "scene/gltf/gltf.hpp"
#include "scene/obj/obj.hpp"
#include "scene/scene_fault.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

/// How loading a file ended.
struct Ending {
  bool crashed = false;
  char kind = '?';  ///< 'S'cene, 'I'nputError, or '?' for anything else
  std::string words;
};

Ending loadHere(const std::string& path) {
  Scene scene;
  try {
    if (path.ends_with(".gltf") || path.ends_with(".glb")) {
      loadGltf(path, scene);
    } else {
      loadObj(path, scene);
    }
  } catch (const InputError& error) {
    return {false, 'I', error.what()};
  } catch (const std::exception& error) {
    return {false, '?', error.what()};
  }
  if (!scene.missing_textures.empty()) return {false, 'I', scene.missing_textures.front()};
  return {false, 'S', test::sceneFault(scene)};
}

/// Loads in a child process, so that a crash is reported with the file's name and the other files are still
/// tried.
Ending loadInChild(const std::string& path) {
  int ends[2];
  if (pipe(ends) != 0) return {true, '?', "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);  // a hang is a crash
    const Ending ending = loadHere(path);
    const std::string report = ending.kind + ending.words;
    const bool written = write(ends[1], report.data(), report.size()) == static_cast<ssize_t>(report.size());
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string report;
  char block[4096];
  for (ssize_t n; (n = read(ends[0], block, sizeof block)) > 0;) report.append(block, n);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || report.empty()) return {true, '?', ""};
  return {false, report[0], report.substr(1)};
}

/// A scene in order, or one clear line that names the file.
void expectSceneOrOneLine(const std::string& path) {
  const Ending ending = loadInChild(path);
  ASSERT_FALSE(ending.crashed) << path;
  if (ending.kind == 'S') {
    EXPECT_EQ(ending.words, "") << path;
    return;
  }
  ASSERT_EQ(ending.kind, 'I') << path << ": " << ending.words;
  EXPECT_EQ(ending.words.find('\n'), std::string::npos) << ending.words;
  EXPECT_LT(ending.words.size(), path.size() + 1000) << ending.words;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  EXPECT_EQ(ending.words.find(folder), 0u) << ending.words;
}

std::vector<std::string> meshFiles(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".obj" || extension == ".gltf" || extension == ".glb" || extension == ".ply") {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(MalformedMeshes, EveryFileOfTheBrokenCollectionsEndsInASceneOrOneLine) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* collection : {"malformed_assimp", "malformed_tinyobjloader"}) {
    const std::vector<std::string> files = meshFiles(luciole::test::sharedScenes() / collection);
    EXPECT_GT(files.size(), 10u) << collection;
    for (const std::string& file : files) expectSceneOrOneLine(file);
  }
}

TEST(MalformedMeshes, FilesBrokenOnPurposeAreRefused) {
  LUCIOLE_NEEDS_SHARED();
  const std::filesystem::path assimp = luciole::test::sharedScenes() / "malformed_assimp";
  const std::filesystem::path tinyobj = luciole::test::sharedScenes() / "malformed_tinyobjloader";
  for (const std::filesystem::path& file : {
           assimp / "invalid/empty.obj",
           assimp / "invalid/malformed.obj",
           assimp / "OBJ/box_UTF16BE.obj",
           assimp / "OBJ/point_cloud.obj",
           assimp / "glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
           assimp / "glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf",
           assimp / "glTF2/IndexOutOfRange/IndexOutOfRange.gltf",
           assimp / "glTF2/MissingBin/BoxTextured.gltf",
           assimp / "glTF2/RecursiveNodes/RecursiveNodes.gltf",
           assimp / "glTF2/TestNoRootNode/NoScene.gltf",
           assimp / "glTF2/TestNoRootNode/SceneWithoutNodes.gltf",
           assimp / "glTF2/wrongTypes/badArray.gltf",
           tinyobj / "invalid-face-definition.obj",
           tinyobj / "invalid-relative-texture-index.obj",
           tinyobj / "invalid-relative-vertex-index.obj",
           tinyobj / "issue-140-zero-face-idx.obj",
           tinyobj / "line-prim.obj",
           tinyobj / "test-nan.obj",
       }) {
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_EQ(loadInChild(file.string()).kind, 'I') << file;
  }
}

/// Pseudo-random numbers that are the same everywhere (Numerical Recipes' linear congruential generator).
struct Dice {
  std::uint32_t state;
  std::uint32_t roll(std::uint32_t below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::uint32_t>((std::uint64_t{state} * below) >> 32);
  }
};

void writeBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

constexpr const char* kSeedObj =
    "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nvt 0 0\nvt 1 1\nvn 0 0 1\n"
    "g one two\ns 1\nusemtl red\nf 1/1/1 2/2/1 3/1/1 4/2/1\ns off\nf -1 -2 -3\n";

constexpr const char* kSeedGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"scale":[1,-1,2]},{"camera":0,"children":[2]},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1,"zfar":10}}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":3,"range":9,"spot":{"outerConeAngle":1}}]}},
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"metallicFactor":0.5},"alphaMode":"MASK","alphaCutoff":0.25}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":4,"componentType":5121,"normalized":true,"count":3,"type":"VEC2",
"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":1}}},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
{"bufferView":0,"byteOffset":8,"componentType":5126,"count":2,"type":"SCALAR"},
{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}],
"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":3,"output":4}]}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]})";

/// The seed with a few characters replaced, removed or doubled.
std::string mutated(std::string seed, Dice& dice) {
  constexpr std::string_view kPool = "0123456789-+.e/ \n{}[],:\"\\#fvns\x01\xff";
  for (std::uint32_t edits = 1 + dice.roll(4); edits > 0; --edits) {
    const std::size_t place = dice.roll(static_cast<std::uint32_t>(seed.size()));
    const char c = kPool[dice.roll(static_cast<std::uint32_t>(kPool.size()))];
    switch (dice.roll(4)) {
      case 0:
        seed[place] = c;
        break;
      case 1:
        seed.insert(place, 1, c);
        break;
      case 2:
        seed.erase(place, 1 + dice.roll(8));
        break;
      default:
        seed.insert(place, seed.substr(place, 1 + dice.roll(12)));
    }
  }
  return seed;
}

TEST(MalformedMeshes, SmallChangesToAGoodFileNeverCrash) {
  const test::TemporaryFolder folder;
  writeBytes(folder / "m.mtl", "newmtl red\nKd 1 0 0\n");
  Dice dice{20240229};
  for (const auto& [seed, extension] : {std::pair(kSeedObj, ".obj"), std::pair(kSeedGltf, ".gltf")}) {
    writeBytes(folder / ("good" + std::string(extension)), seed);
    EXPECT_EQ(loadInChild(folder / ("good" + std::string(extension))).kind, 'S') << extension;
    for (int i = 0; i < 100; ++i) {
      const std::string path = folder / ("bad" + std::string(extension));
      const std::string text = mutated(seed, dice);
      writeBytes(path, text);
      expectSceneOrOneLine(path);
      if (HasFailure()) FAIL() << "with change " << i << ":\n" << text;
    }
  }
}

TEST(MalformedMeshes, AFileCutShortNeverCrashes) {
  const test::TemporaryFolder folder;
  for (const auto& [seed, extension] : {std::pair(kSeedObj, ".obj"), std::pair(kSeedGltf, ".gltf")}) {
    const std::string whole = seed;
    for (std::size_t length = 0; length < whole.size(); length += 17) {
      const std::string path = folder / ("cut" + std::string(extension));
      writeBytes(path, whole.substr(0, length));
      expectSceneOrOneLine(path);
    }
  }
}

TEST(MalformedMeshes, AGlbWithWrongLengthsIsRefused) {
  const auto word = [](std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
    return bytes;
  };
  const std::string json = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8}],"scenes":[{}]} )";
  const test::TemporaryFolder folder;
  const std::string path = folder / "bad.glb";
  for (const std::uint32_t bin_length : {0u, 4u, 8u, 12u, 16u, 0x7ffffffcu, 0xfffffffcu}) {
    const std::string body =
        word(json.size()) + "JSON" + json + word(bin_length) + std::string("BIN\0", 4) + "8 bytes!";
    for (const std::size_t length : {body.size() + 12, std::size_t{20}, std::size_t{0xffffffff}}) {
      writeBytes(path, "glTF" + word(2) + word(static_cast<std::uint32_t>(length)) + body);
      const Ending ending = loadInChild(path);
      EXPECT_EQ(ending.kind, 'I') << bin_length << " " << length;
      EXPECT_EQ(ending.words.find('\n'), std::string::npos) << ending.words;
    }
  }
}

TEST(MalformedMeshes, DeeplyNestedJsonIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "deep.gltf";
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  writeBytes(path, R"({"asset":{"version":"2.0"},"extras":)" + deep + "}");
  EXPECT_EQ(loadInChild(path).kind, 'I');
}

TEST(MalformedMeshes, BinaryJunkAsObjIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "junk.obj";
  Dice dice{7};
  std::string junk;
  for (int i = 0; i < 100000; ++i) junk += static_cast<char>(dice.roll(256));
  writeBytes(path, junk);
  EXPECT_EQ(loadInChild(path).kind, 'I');
  EXPECT_EQ(loadInChild(folder.path().string()).kind, 'I') << "a folder";
  EXPECT_EQ(loadInChild(folder / "missing.obj").kind, 'I');
  EXPECT_EQ(loadInChild(folder / "missing.glb").kind, 'I');
}

TEST(MalformedMeshes, AStatementOfVeryManyLinesIsReadInTime) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "file.obj";
  std::string text;
  for (int i = 0; i < 400'000; ++i) text += "\\\n";
  writeBytes(path, text + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(loadInChild(path).kind, 'S');
}

TEST(MalformedMeshes, AMaterialFileThatIsNamedVeryOftenIsReadOnce) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "file.obj";
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "mtllib file.obj\n";
  writeBytes(path, text + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(loadInChild(path).kind, 'S');
}

TEST(MalformedMeshes, ANameTooLongForTheSystemIsThatOfAMissingFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "file.obj";
  const std::string name(5000, 'n'), triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  writeBytes(path, "mtllib " + name + "\n" + triangle);
  EXPECT_EQ(loadInChild(path).kind, 'S');
  writeBytes(path, "mtllib file.obj\nnewmtl red\nmap_Kd " + name + "\n" + triangle);
  const Ending ending = loadInChild(path);
  EXPECT_EQ(ending.kind, 'I');
  EXPECT_NE(ending.words.find("there is no picture"), std::string::npos) << ending.words;
}

}  // namespace
}  // namespace luciole
