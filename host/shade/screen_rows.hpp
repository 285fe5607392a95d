#pragma once

#include <cstdint>
#include <string>

#include "cl/buffer.hpp"
#include "kernels/shared.h"
#include "luciole/shader.hpp"

namespace luciole {

/// A shader's function `screen` (kernels/screens/screen.clh), as programs are made of it.
struct ScreenProgram {
  Shader shader;
  int radius = 0;  ///< how many pixels away it reads, 0 to 8
};

/// Planes of rows as ScreenFrame says. Those that a screen doesn't name may lack memory.
struct ScreenRowsArguments {
  const ScreenFrame& frame;
  Buffer<const float> color;                    ///< r g b
  Buffer<const float> from_eye, depth, normal;  ///< x y z, one, x y z
  Buffer<const int> object, material;
  Buffer<float> image;  ///< out: r g b
};

/// What a screen did that it shouldn't.
struct ScreenMarks {
  std::uint64_t bad_colors = 0;  ///< pixels whose colour was NaN, infinite or below 0, and stayed as it was
  std::string beyond = {};       ///< "FILE:LINE: …" where it read farther than its radius; else empty
};

/// Launches kernels/screens/screen_rows.cl on a part of a picture and waits for it. Throws as makeKernel()
/// does.
ScreenMarks screenRows(OpenedDevice& device, const ScreenProgram& screen,
                       const ScreenRowsArguments& arguments);

/// Compiles the screen down to machine code, by a picture of one pixel. Throws likewise, and InputError where
/// the screen reads beyond its radius there.
void compileScreen(OpenedDevice& device, const ScreenProgram& screen);

}  // namespace luciole
