#include "shade/screen_rows.hpp"

#include <fmt/format.h>

#include <array>
#include <sstream>
#include <utility>

#include "cl/launch.hpp"
#include "luciole/error.hpp"
#include "luciole/gbuffer.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

/// A note of note_beyond() in kernels/screens/screen.clh, for people. It has the line alone: the column is
/// that of the first call there that looks at a neighbour.
std::string beyondText(const ScreenProgram& screen, uint note) {
  const uint line = note >> 20;
  std::istringstream lines(screen.shader.text);
  std::string text;
  for (uint i = 0; i < line; ++i) std::getline(lines, text);
  const std::size_t call = text.find("_at(");
  const std::size_t before =
      call == text.npos ? text.npos : text.find_last_not_of("abcdefghijklmnopqrstuvwxyz_", call);
  const std::size_t column = before == text.npos ? 1 : before + 2;
  const int dx = int(note >> 10 & 1023) - 512, dy = int(note & 1023) - 512;
  return fmt::format(
      "{}:{}:{}: this looks at the pixel ({}, {}) from its own, beyond the screen's RADIUS of {}",
      screen.shader.path, line, column, dx, dy, screen.radius);
}

}  // namespace

ScreenMarks screenRows(OpenedDevice& device, const ScreenProgram& screen,
                       const ScreenRowsArguments& arguments) {
  Kernel kernel = makeKernel(device, "screens/screen_rows.cl", "screen_rows",
                             fmt::format("-DHAS_SCREEN -DSCREEN_RADIUS={}", screen.radius),
                             shaderProgram({&screen.shader, 1}, ShaderKind::kScreen));
  constexpr uint kNowhere = 0xffffffff;
  std::array<uint, 2> marks{0, kNowhere};
  const Buffer<uint> marks_buffer = makeBuffer<uint>(device, marks.size());
  bytes::write(device, marks_buffer.memory, marks.data(), {0, sizeof marks});
  const ScreenFrame& frame = arguments.frame;
  const int lanes = device.description.lanes, blocks = (frame.columns + lanes - 1) / lanes;
  constexpr std::size_t kGroup = 16;
  const std::size_t items = std::size_t(blocks) * std::size_t(frame.rows);
  launch(device, kernel,
         {{"frame", frame},
          {"color", arguments.color},
          {"from_eye", arguments.from_eye},
          {"depth", arguments.depth},
          {"normal", arguments.normal},
          {"object", arguments.object},
          {"material", arguments.material},
          {"image", arguments.image},
          {"marks", marks_buffer}},
         {.items = (items + kGroup - 1) / kGroup * kGroup, .group = kGroup});
  download(device, marks_buffer, marks);
  return {marks[0], marks[1] == kNowhere ? std::string() : beyondText(screen, marks[1])};
}

void compileScreen(OpenedDevice& device, const ScreenProgram& screen) {
  const bool compiles_quickly = std::exchange(device.compiles_quickly, false);
  // A row of one pixel, which has neighbours on either side.
  constexpr int kStride = 3 * kScreenPad;
  const ScreenFrame frame{.eye = {},
                          .to_eye = {0, 0, 1, 0},
                          .pixel_base = 1,
                          .pixel_slope = 0,
                          .plane_stride = kStride,
                          .row_stride = kStride,
                          .columns = 1,
                          .rows = 1,
                          .first_x = 0,
                          .first_y = 0,
                          .width = 1,
                          .height = 1,
                          .inner_left = 0,
                          .inner_top = 0,
                          .inner_right = 0,
                          .inner_bottom = 0,
                          .pad0 = 0,
                          .pad1 = 0};
  const Plane zeros(3 * kStride);
  const std::vector<int> ids(kStride);
  Plane image(3 * kStride);
  const Buffer<const float> plane = borrowed(device, zeros);
  const Buffer<const int> numbers = borrowed(device, ids);
  const ScreenMarks marks =
      screenRows(device, screen,
                 {frame, plane, plane, plane, plane, numbers, numbers, borrowedForOutput(device, image)});
  device.compiles_quickly = compiles_quickly;
  if (!marks.beyond.empty()) throw InputError(marks.beyond);
}

}  // namespace luciole
