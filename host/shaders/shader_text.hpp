#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "luciole/shader.hpp"

// A shader's text is held against rules before a compiler sees it, by which no kernel that contains it can
// run without end or reach data that isn't its own. The rules are GLSL ES's (The OpenGL ES Shading Language
// 1.00, Appendix A) and more:
//
// - A file holds functions and directives. The only loop is UNROLLED(i, n) {…}, n a number, whose body
//   leaves i as it is, and a screen's EACH_NEIGHBOR(dx, dy) {…}. Text is counted as often as loops, calls and
//   macros repeat it, and that is limited.
// - A function is defined before it is called, and doesn't call itself.
// - The only pointers are those to a Surface or a Screen that a function is given. They are followed by ->,
//   or given on to functions of the file.
// - No arrays, jumps, assembly, or text of other files than the headers for shaders.
namespace luciole {

/// A shader's largest text.
inline constexpr std::size_t kMostShaderBytes = 64 << 10, kMostShaderLines = 2000;
/// Words and signs: of a statement, and of a whole file with all that it repeats.
inline constexpr std::size_t kMostStatement = 1000, kMostRepeated = 100'000;
/// Turns of a loop.
inline constexpr unsigned kMostTurns = 64;
/// The kind of warnings of ShaderFacts::loose.
inline constexpr const char* kLooseArithmetic = "arithmetic that devices round differently";
/// A screen's largest radius, in pixels.
inline constexpr int kMostScreenRadius = 8;

/// The headers that a shader may include. All are there without it.
std::span<const char* const> shaderHeaders();

/// What a program must know of a shader.
struct ShaderFacts {
  bool uses_tangents = false;  ///< it names `tangent` or `bitangent`
  bool uses_colors = false;    ///< a model names `s->diffuse` or `s->specular`
  bool uses_grazing = false;   ///< it names `grazing`
  int radius = 0;              ///< a screen's RADIUS
  /// The members that it names behind ->, and those of them that it changes.
  std::set<std::string, std::less<>> named, changed;
  /// Arithmetic whose last bits differ between devices, since OpenCL doesn't fix it: "FILE:LINE:COLUMN: …".
  std::vector<std::string> loose;
};

/// Throws InputError, "FILE:LINE:COLUMN: …", for a text that breaks a rule, or lacks its kind's function.
ShaderFacts shaderFacts(const Shader& shader, ShaderKind kind);

/// Whether one of these models names tangents.
bool usesTangents(std::span<const Shader> models);

/// The text that takes the place of kernels/user_text.clh in a program with these shaders, which must have
/// passed shaderFacts(). Its lines have the files' names and numbers. The function of the shader with the
/// index i is called `__reflect_light_i`, `__surface_i` or `__screen_i`. Empty without shaders.
std::string shaderProgram(std::span<const Shader> shaders, ShaderKind kind);

/// What the user is told of a program with such a text that doesn't compile: "FILE:LINE:COLUMN: what" of the
/// first error in the user's text, else "FILE: does not compile: ...". log: of clang.
std::string shaderError(const std::string& log, const std::string& user_text);

}  // namespace luciole
