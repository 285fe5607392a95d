// Files of every format that textures come in, cut short or full of something else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <span>

#include "image/read_texture.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "shared_files.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::vector<std::string> kExtensions{"png", "jpg", "tif", "webp", "tga", "gif",
                                           "exr", "hdr", "bmp", "ppm",  "sgi"};

/// Pixels that no encoder makes much smaller.
Image noise() {
  Image image{64, 64, {"R", "G", "B"}, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < 64 * 64 * 3; ++i)
    image.pixels.push_back(float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f);
  return image;
}

/// The message of the InputError that reading these bytes throws, "" if it throws none; nothing else may
/// reach the terminal.
std::string quietErrorOf(const std::string& bytes, const std::string& name) {
  testing::internal::CaptureStderr();
  std::string message;
  try {
    readTexture(std::as_bytes(std::span(bytes)), name);
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name << ": " << message;
  return message;
}

auto isOneLineAbout(const std::string& name) {
  return AllOf(StartsWith(name + ": "), Not(HasSubstr("\n")), Not(HasSubstr("/proc")));
}

TEST(DamagedPictures, CutShortAreOneLineThatNamesTheFile) {
  const TemporaryFolder folder;
  for (const std::string& extension : kExtensions) {
    writeImage(noise(), folder / ("a." + extension), {});
    const std::string bytes = readText(folder / ("a." + extension));
    for (const std::size_t size : {std::size_t(0), std::size_t(40), bytes.size() / 2, bytes.size() * 9 / 10})
      EXPECT_THAT(quietErrorOf(bytes.substr(0, size), "x." + extension), isOneLineAbout("x." + extension))
          << size;
  }
}

TEST(DamagedPictures, JunkIsOneLineThatNamesTheFile) {
  for (const std::string& extension : kExtensions) {
    EXPECT_THAT(quietErrorOf("not a picture\nbut some junk, which goes on and on and on", "x." + extension),
                isOneLineAbout("x." + extension));
    const TemporaryFolder folder;
    writeText(folder / ("x." + extension), "not a picture\nbut some junk, which goes on and on and on");
    testing::internal::CaptureStderr();
    try {
      readTexture(folder / ("x." + extension));
      ADD_FAILURE() << "read " << extension;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), isOneLineAbout(folder / ("x." + extension)));
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

TEST(DamagedPictures, BytesThatChangedAreOneLineIfAnything) {
  const TemporaryFolder folder;
  for (const std::string& extension : kExtensions) {
    writeImage(noise(), folder / ("a." + extension), {});
    const std::string bytes = readText(folder / ("a." + extension));
    std::uint32_t state = 7;
    const auto random = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
    for (int i = 0; i < 30; ++i) {
      std::string changed = bytes;
      for (int k = 0; k < 5; ++k) changed[random() % (k < 3 ? 100 : bytes.size())] = char(random());
      const std::string message = quietErrorOf(changed, "x." + extension);
      if (message.empty()) continue;
      EXPECT_THAT(message, isOneLineAbout("x." + extension));
    }
  }
}

}  // namespace
}  // namespace luciole::test
