#include "tools/cli/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/output_file.hpp"
#include "base/split.hpp"
#include "luciole/error.hpp"
#include "tools/cli/picture_options.hpp"

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

/// A part of the list: every `step`th frame from `first` to `last`.
struct FrameRange {
  int first, last, step;
};

std::optional<FrameRange> frameRange(std::string_view text) {
  const std::size_t dash = text.find('-');
  const std::optional<int> first = frameNumber(text.substr(0, dash));
  if (!first || dash == std::string_view::npos)
    return first ? std::optional(FrameRange{*first, *first, 1}) : std::nullopt;
  const std::string_view rest = text.substr(dash + 1);
  const std::size_t x = rest.find('x');
  const std::optional<int> last = frameNumber(rest.substr(0, x));
  const std::optional<int> step = x == std::string_view::npos ? 1 : frameNumber(rest.substr(x + 1));
  if (!last || !step || *first > *last || *step < 1) return std::nullopt;
  return FrameRange{*first, *last, *step};
}

/// A file's name: the text before the frame's number, the number's digits, and the text after it.
struct NamePattern {
  std::string before, after;
  int digits = 0;  ///< 0: there is no place for the number, and the name is `before`
};

/// The length of a placeholder for the frame's number, "%d" or "%04d", at the start of `text`; 0 without one.
std::size_t percentLength(std::string_view text) {
  if (text.starts_with("%d")) return 2;
  const bool is_padded =
      text.size() >= 4 && text.starts_with("%0") && text[2] >= '1' && text[2] <= '9' && text[3] == 'd';
  return is_padded ? 4 : 0;
}

NamePattern parsePattern(const std::string& pattern) {
  const std::size_t slash = pattern.find_last_of('/');
  const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
  const std::string_view text = pattern;
  NamePattern parsed;
  parsed.before = text.substr(0, start);
  for (std::size_t i = start; i < text.size();) {
    std::string& part = parsed.digits > 0 ? parsed.after : parsed.before;
    const std::size_t length = percentLength(text.substr(i));
    if (length > 0 && parsed.digits == 0) {
      parsed.digits = length == 2 ? 1 : text[i + 2] - '0';
      i += length;
    } else if (text[i] != '%') {
      part += text[i++];
    } else if (text.substr(i, 2) == "%%") {
      part += '%';
      i += 2;
    } else {
      throw InputError(
          fmt::format("{}: '{}': expected %04d once, for the frame's number, and %% for a percent sign",
                      pattern, text.substr(i, 4)));
    }
  }
  const std::size_t end = parsed.before.find_last_of('#');
  if (parsed.digits > 0 || end == std::string::npos || end < start) return parsed;
  const std::size_t other = parsed.before.find_last_not_of('#', end);
  const std::size_t begin = other == std::string::npos ? 0 : other + 1;
  parsed.digits = int(end + 1 - begin);
  parsed.after = parsed.before.substr(end + 1);
  parsed.before.resize(begin);
  return parsed;
}

}  // namespace

FrameChoice chosenFrames(const std::string& option) {
  if (option.empty()) return {};
  FrameChoice choice{{}, option.find_first_of(",-") != std::string::npos};
  std::vector<bool> is_there(kLastFrame + 1);
  for (const std::string& part : split(option, ',')) {
    const std::optional<FrameRange> range = frameRange(part);
    if (!range)
      throw InputError(
          fmt::format("--frames {}: expected a frame, such as 17, a first and a last, such as 1-120, each "
                      "fifth of them, 1-120x5, or several of these, 1,3,10-100x5; from 0 to {}",
                      option, kLastFrame));
    for (int frame = range->first; frame <= range->last; frame += range->step) {
      if (is_there[frame]) continue;
      is_there[frame] = true;
      choice.frames.push_back(frame);
    }
  }
  return choice;
}

int chosenFrame(const std::string& option, const std::string& command) {
  const FrameChoice choice = chosenFrames(option);
  if (choice.is_list)
    throw InputError(fmt::format("--frames {}: {} makes one picture, expected one frame", option, command));
  return choice.frames.front();
}

std::string frameFile(const std::string& pattern, int frame) {
  const NamePattern name = parsePattern(pattern);
  if (name.digits == 0) return name.before;
  return fmt::format("{}{:0{}}{}", name.before, frame, name.digits, name.after);
}

std::string hashPattern(const std::string& pattern) {
  const NamePattern name = parsePattern(pattern);
  return name.before + std::string(std::size_t(name.digits), '#') + name.after;
}

bool hasFramePlace(const std::string& pattern) { return parsePattern(pattern).digits > 0; }

void checkPattern(const std::string& pattern, const std::string& option) {
  if (!hasFramePlace(pattern))
    throw InputError(fmt::format(
        "{} {}: expected a name with #### or %04d in the place of the frame's number, such as frame.####.png",
        option, pattern));
}

std::vector<int> framesThere(const std::string& pattern) {
  const NamePattern name = parsePattern(pattern);
  const std::string before = name.before.substr(name.before.find_last_of('/') + 1);
  std::vector<int> frames;
  std::error_code error;
  std::filesystem::directory_iterator entry(folderOf(pattern), error), end;
  for (; !error && entry != end; entry.increment(error)) {
    const std::string file = entry->path().filename().string();
    const std::size_t around = before.size() + name.after.size();
    if (file.size() <= around || !file.starts_with(before) || !file.ends_with(name.after)) continue;
    const auto frame = frameNumber(std::string_view(file).substr(before.size(), file.size() - around));
    // Not a number with fewer or more zeros in front than its file has.
    if (frame && std::filesystem::path(frameFile(pattern, *frame)).filename() == file)
      frames.push_back(*frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::string listFrames(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", frames[i]);
    if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
    i = end;
  }
  return text;
}

}  // namespace luciole
