#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cl/device.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/shader.hpp"

namespace luciole {

/// Functions of the user's that change surfaces before they are lit, one after another, as one program.
struct SurfaceProgram {
  std::string user_text;  ///< see makeKernel(); empty: there are no functions
  unsigned read = 0;      ///< groups whose members they name, kNormalGroup …
  unsigned changed = 0;   ///< of these, those that they may change

  bool changes(unsigned group) const { return (changed & group) != 0; }
};

/// The program of these shaders (ShaderKind::kSurface). Throws InputError for one that breaks a rule.
SurfaceProgram surfaceProgram(std::span<const Shader> surfaces);

/// Adds the groups that a program reads to those that a G-buffer is to have.
void addGroups(const SurfaceProgram& program, PlaneSet& planes);

/// Launches kernels/shade/surface.cl on every pixel of a G-buffer and waits for it. Groups of the G-buffer
/// that it lacks are zeros to the functions, and stay away. Returns the number of pixels to which they gave a
/// number below 0, which counts as 0, or one that is not finite, or no direction, which change nothing.
/// Throws InputError if the user's text doesn't compile, and MachineError.
std::uint64_t surface(OpenedDevice& device, const SurfaceProgram& program, GBuffer& gbuffer);

}  // namespace luciole
