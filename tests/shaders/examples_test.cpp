// The shaders that come with the program, as people read them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "shaders/shader_text.hpp"

namespace luciole::test {
namespace {

std::vector<Shader> exampleShaders() {
  std::vector<Shader> examples;
  for (const auto& entry : std::filesystem::directory_iterator(LUCIOLE_SOURCE_DIR "/kernels/examples")) {
    if (entry.path().extension() != ".clh") continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    examples.push_back({entry.path().filename().string(), text.str()});
  }
  return examples;
}

ShaderKind kindOf(const Shader& shader) {
  if (shader.text.find(" reflect_light(") != std::string::npos) return ShaderKind::kModel;
  return shader.text.find(" surface(") != std::string::npos ? ShaderKind::kSurface : ShaderKind::kScreen;
}

TEST(ExampleShaders, KeepTheRulesWithArithmeticThatIsTheSameEverywhere) {
  const std::vector<Shader> examples = exampleShaders();
  ASSERT_GE(examples.size(), 5u);
  for (const Shader& example : examples)
    EXPECT_TRUE(shaderFacts(example, kindOf(example)).loose.empty()) << example.path;
}

TEST(ExampleShaders, AreAtMostFortyLinesAndBeginWithWhatTheyAre) {
  for (const Shader& example : exampleShaders()) {
    EXPECT_LE(std::count(example.text.begin(), example.text.end(), '\n'), 40) << example.path;
    EXPECT_TRUE(example.text.starts_with("// ")) << example.path;
    EXPECT_NE(example.text.find(example.path), std::string::npos)
        << example.path << " doesn't say how to run it";
  }
}

}  // namespace
}  // namespace luciole::test
