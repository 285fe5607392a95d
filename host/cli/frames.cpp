#include "cli/frames.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

#include "error.hpp"

namespace luciole {
namespace {

constexpr int kLastFrame = 9'999'999;

std::optional<int> frameNumber(std::string_view text) {
  int number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0 || number > kLastFrame)
    return std::nullopt;
  return number;
}

}  // namespace

FrameRange chosenFrames(const std::string& option) {
  if (option.empty()) return {};
  const std::string_view text = option;
  const std::size_t dash = text.find('-');
  const bool is_range = dash != std::string_view::npos;
  const std::optional<int> first = frameNumber(text.substr(0, dash));
  const std::optional<int> last = is_range ? frameNumber(text.substr(dash + 1)) : first;
  if (!first || !last || *first > *last)
    throw InputError(
        fmt::format("--frames {}: expected a frame, such as 17, or the first and the last, such as 1-120; "
                    "from 0 to {}",
                    option, kLastFrame));
  return {*first, *last, is_range};
}

int chosenFrame(const std::string& option, const std::string& command) {
  const FrameRange frames = chosenFrames(option);
  if (frames.is_range)
    throw InputError(fmt::format("--frames {}: {} makes one picture, expected one frame", option, command));
  return frames.first;
}

std::string frameFile(const std::string& pattern, int frame) {
  const std::size_t end = pattern.find_last_of('#');
  const std::size_t slash = pattern.find_last_of('/');
  if (end == std::string::npos || (slash != std::string::npos && slash > end)) return pattern;
  const std::size_t before = pattern.find_last_not_of('#', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return fmt::format("{}{:0{}}{}", pattern.substr(0, begin), frame, end + 1 - begin, pattern.substr(end + 1));
}

void checkPattern(const std::string& pattern, const std::string& option) {
  if (frameFile(pattern, 0) == frameFile(pattern, 1))
    throw InputError(fmt::format(
        "{} {}: expected a name with #### in the place of the frame's number, such as frame.####.png", option,
        pattern));
}

}  // namespace luciole
