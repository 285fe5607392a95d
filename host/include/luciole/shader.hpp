#pragma once

#include <string>

namespace luciole {

/// A function in a file of the user's, which kernels call: INLINE Reflection reflect_light(…) and the like.
struct Shader {
  std::string path;  ///< as messages name the file
  std::string text;

  bool operator==(const Shader&) const = default;
};

/// What a shader's function does.
enum class ShaderKind {
  kModel,    ///< reflect_light(): what a surface reflects of a light
  kSurface,  ///< surface(): changes a surface before it is lit
  kScreen,   ///< screen(): changes a lit pixel by those around it
};

/// How the names of shaders' files end.
inline constexpr const char* kShaderExtension = ".clh";

/// Reads a shader's file. Throws InputError, "FILE:LINE:COLUMN: …", if it can't be read, or breaks a rule of
/// shaders.
Shader readShader(const std::string& path, ShaderKind kind);

}  // namespace luciole
