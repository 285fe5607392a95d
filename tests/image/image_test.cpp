#include "luciole/image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>
#include <utility>

#include "image/file_format.hpp"
#include "image/row_file.hpp"
#include "luciole/error.hpp"
#include "messages.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::filesIn;
using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A picture with values that differ in every place and channel.
Image rampPicture(int width, int height, const std::vector<std::string>& channels) {
  Image image{width, height, channels, {}};
  const std::size_t count = std::size_t(width) * height * channels.size();
  for (std::size_t i = 0; i < count; ++i) image.pixels.push_back(float(i) * 0.37f - 1.0f);
  return image;
}

float channelValue(const Image& image, std::size_t pixel, const std::string& channel) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), channel);
  EXPECT_NE(found, image.channels.end()) << channel;
  return image.pixels[pixel * image.channels.size() + std::size_t(found - image.channels.begin())];
}

/// The linear value of an 8-bit sRGB code, IEC 61966-2-1 as printed.
double linearOfByte(int code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(Image, EveryEightBitCodeSurvivesARoundTrip) {
  const TemporaryFolder folder;
  Image image{256, 1, {"R", "G", "B"}, {}};
  for (int code = 0; code < 256; ++code) {
    for (int c = 0; c < 3; ++c) image.pixels.push_back(float(linearOfByte(c == 1 ? 255 - code : code)));
  }
  for (const char* name : {"a.png", "a.tga", "a.bmp", "a.ppm"}) {
    writeImage(image, folder / name, {});
    const Image read = readImage(folder / name);
    // The pixels are the decoded codes, rounded to float once (2⁻²⁴ relative) on either side of the file.
    ASSERT_EQ(read.pixels.size(), image.pixels.size()) << name;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      ASSERT_NEAR(read.pixels[i], image.pixels[i], image.pixels[i] * 0x1p-23) << name << " value " << i;
    }
  }
}

TEST(Image, EightBitCodesAreRoundedToNearest) {
  const TemporaryFolder folder;
  // Just below and above the middle between codes k and k + 1: 1e-3 of a step is far more than float's
  // rounding there.
  Image image{255, 2, {"R", "G", "B"}, {}};
  for (const double shift : {-1e-3, 1e-3}) {
    for (int k = 0; k < 255; ++k) {
      const double code = (k + 0.5 + shift) / 255.0;
      const double linear = code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
      image.pixels.insert(image.pixels.end(), 3, float(linear));
    }
  }
  writeImage(image, folder / "a.png", {});
  const Image read = readImage(folder / "a.png");
  for (int row = 0; row < 2; ++row) {
    for (int k = 0; k < 255; ++k) {
      const float expected = float(linearOfByte(k + row));
      ASSERT_NEAR(read.pixels[(std::size_t(row) * 255 + k) * 3], expected, expected * 0x1p-23)
          << k << " " << row;
    }
  }
}

TEST(Image, IntegerFormatsClampAndTakeNaNAsBlack) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  writeImage({2, 1, {"R", "G", "B"}, {nan, -1.0f, 7.0f, inf, -inf, 1.0f}}, folder / "a.png", {});
  EXPECT_EQ(readImage(folder / "a.png").pixels, (std::vector<float>{0, 0, 1, 1, 0, 1}));
}

TEST(Image, FloatFormatsKeepEveryChannelExactly) {
  const TemporaryFolder folder;
  const std::vector<std::string> channels{"R",        "G",        "B",        "A",
                                          "normal.X", "normal.Y", "normal.Z", "light_count"};
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 93}, {144, 17}}) {
    Image image = rampPicture(width, height, channels);
    image.pixels[0] = std::numeric_limits<float>::infinity();
    image.pixels[1] = 1e-42f;
    image.pixels[2] = -0.0f;
    writeImage(image, folder / "a.exr", {});
    const Image read = readImage(folder / "a.exr");
    ASSERT_EQ(read.width, width);
    ASSERT_EQ(read.height, height);
    ASSERT_EQ(read.channels.size(), channels.size());
    for (std::size_t p = 0; p < std::size_t(width) * height; ++p) {
      for (const std::string& name : channels)
        ASSERT_EQ(channelValue(read, p, name), channelValue(image, p, name));
    }
    writeImage(image, folder / "a.tif", {});
    ASSERT_EQ(readImage(folder / "a.tif").pixels, image.pixels);
  }
}

TEST(Image, AlphaIsLinearAndDoesNotMultiplyColors) {
  const TemporaryFolder folder;
  const float color = float(linearOfByte(200));
  writeImage({1, 1, {"R", "G", "B", "A"}, {color, color, color, 51.0f / 255}}, folder / "a.png", {});
  const Image read = readImage(folder / "a.png");
  EXPECT_NEAR(channelValue(read, 0, "R"), color, color * 0x1p-23);
  EXPECT_NEAR(channelValue(read, 0, "A"), 0.2f, 0x1p-24);
}

TEST(Image, RadianceFilesTakeRedGreenBlue) {
  const TemporaryFolder folder;
  writeImage({1, 1, {"depth", "B", "G", "R"}, {9.0f, 0.25f, 0.5f, 1.0f}}, folder / "a.hdr", {});
  // These powers of two are exact in its shared-exponent format.
  EXPECT_EQ(readImage(folder / "a.hdr").pixels, (std::vector<float>{1.0f, 0.5f, 0.25f}));
}

TEST(Image, MetadataIsStored) {
  const TemporaryFolder folder;
  const Image image = rampPicture(4, 4, {"R", "G", "B"});
  const Metadata metadata{
      {"Software", "Luciole 1"}, {"ImageDescription", "render a.json"}, {"luciole:device", "pocl"}};
  writeImage(image, folder / "a.exr", metadata);
  for (const char* text : {"Luciole 1", "render a.json", "luciole:device"}) {
    EXPECT_THAT(readText(folder / "a.exr"), HasSubstr(text));
  }
  writeImage(image, folder / "a.png", metadata);
  EXPECT_THAT(readText(folder / "a.png"),
              AllOf(HasSubstr("Luciole 1"), HasSubstr("render a.json"), HasSubstr("sRGB")));
}

/// The chunks of a PNG file, in order: type and content.
std::vector<std::pair<std::string, std::string>> chunksOf(const std::string& png) {
  std::vector<std::pair<std::string, std::string>> chunks;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    std::size_t size = 0;
    for (int i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(png[at + i]);
    chunks.emplace_back(png.substr(at + 4, 4), png.substr(at + 8, size));
    at += 12 + size;
  }
  return chunks;
}

TEST(Image, PngTextIsAsciiOrSaysThatItIsUtf8) {
  const TemporaryFolder folder;
  const std::string ascii = "render a.json", utf8 = "render été-灯.json", neither = "render \xff\xfe.json";
  for (const std::string& text : {ascii, utf8, neither}) {
    writeImage(rampPicture(4, 4, {"R", "G", "B"}), folder / "a.png",
               {{"Software", "Luciole"}, {"ImageDescription", text}, {"luciole:reference", text}});
    const std::string shown = text == neither ? "render ÿþ.json" : text;
    EXPECT_EQ(readAttribute(folder / "a.png", "ImageDescription"), shown);
    EXPECT_EQ(readAttribute(folder / "a.png", "luciole:reference"), shown);
    EXPECT_EQ(readAttribute(folder / "a.png", "Software"), "Luciole");
    int international = 0;
    for (const auto& [type, content] : chunksOf(readText(folder / "a.png"))) {
      if (type != "tEXt" && type != "iTXt") continue;
      // ISO 15948: iTXt is UTF-8, uncompressed here (two zeros), of no language (two more), tEXt Latin-1.
      EXPECT_EQ(content.find("Luciole") == std::string::npos && text != ascii, type == "iTXt") << type;
      international += type == "iTXt";
      if (type != "iTXt") continue;
      EXPECT_THAT(content, HasSubstr(std::string(5, '\0') + shown));
    }
    EXPECT_EQ(international, text == ascii ? 0 : 2);
  }
}

TEST(Image, APngOfNoPixelsIsAMachineError) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  EXPECT_THAT(messageOf<MachineError>([&] { openPngFile(folder / "a.png", 0, 1, 3, {}); }),
              HasSubstr("a.png: can't encode: "));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(filesIn(folder).empty());
}

TEST(Image, TheFormatMayBeNamedApartFromTheFile) {
  const TemporaryFolder folder;
  const Image image = rampPicture(8, 8, {"R", "G", "B"});
  writeImage(image, folder / "a", {}, {.format = "exr"});
  EXPECT_EQ(readImage(folder / "a").channels.size(), 3u);
  EXPECT_EQ(readText(folder / "a").substr(0, 4), "\x76\x2f\x31\x01");
  writeImage(image, folder / "b.exr", {}, {.format = "PNG"});
  EXPECT_EQ(readText(folder / "b.exr").substr(0, 4), "\x89PNG");
  EXPECT_THAT(messageOf<InputError>([&] { writeImage(image, folder / "c", {}, {.format = "pgn"}); }),
              HasSubstr("unknown format 'pgn'"));
  EXPECT_THAT(messageOf<InputError>([&] { writeImage(image, folder / "c", {}); }),
              HasSubstr("options.format"));
  EXPECT_EQ(filesIn(folder).size(), 2u);
}

TEST(Image, EveryFormatCanBeSentThroughAFifo) {
  const TemporaryFolder folder;
  const Image image = rampPicture(64, 48, {"R", "G", "B"});
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  for (const char* format : {"png", "exr", "tif", "jpg", "ppm", "hdr", "tga", "bmp", "webp"}) {
    std::string sent;
    std::thread reader([&] { sent = readText(folder / "fifo"); });
    writeImage(image, folder / "fifo", {}, {.format = format});
    reader.join();
    std::ofstream(folder / "received", std::ios::binary) << sent;
    writeImage(image, folder / "file", {}, {.format = format});
    EXPECT_EQ(readImage(folder / "received").pixels, readImage(folder / "file").pixels) << format;
    EXPECT_TRUE(std::filesystem::is_fifo(folder / "fifo"));
  }
}

TEST(Image, UnwritableTargetsAreRefusedBeforeAnyWork) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "taken.png");
  EXPECT_NO_THROW(checkWritable(folder / "a.PNG"));
  EXPECT_NO_THROW(checkWritable("-"));
  EXPECT_THAT(messageOf<InputError>([&] { checkWritable(folder / "a.pgn"); }),
              HasSubstr("unknown extension 'pgn'"));
  EXPECT_THAT(messageOf<InputError>([&] { checkWritable(folder / "a"); }), HasSubstr("unknown extension ''"));
  EXPECT_THAT(messageOf<InputError>([&] { checkWritable(folder / "no/a.png"); }),
              HasSubstr("no such folder"));
  EXPECT_THAT(messageOf<InputError>([&] { checkWritable(folder / "taken.png"); }), HasSubstr("is a folder"));
  EXPECT_EQ(filesIn(folder), std::vector<std::string>{"taken.png"});
}

TEST(Image, AReadOnlyFolderIsAnInputError) {
  // Linux lets nobody, root included, create files in /proc.
  EXPECT_THROW(writeImage(rampPicture(2, 2, {"R", "G", "B"}), "/proc/a.png", {}), InputError);
}

/// Bytes that no encoder makes smaller.
Image noisePicture() {
  Image noise{256, 256, {"R", "G", "B"}, {}};
  for (unsigned i = 0, state = 1; i < 256 * 256 * 3; ++i) {
    state = state * 1664525u + 1013904223u;
    noise.pixels.push_back(float(state) * 0x1p-32f);
  }
  return noise;
}

const std::vector<std::string> kFileNames{"b.exr", "b.tif", "b.hdr", "b.png",
                                          "b.jpg", "b.ppm", "b.bmp", "b.tga"};

TEST(Image, ALimitOfFileSizesIsAMachineErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  const Image noise = noisePicture();
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit tight{16384, limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  for (const std::string& name : kFileNames) {
    EXPECT_THROW(writeImage(noise, folder / name, {}), MachineError) << name;
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(filesIn(folder).empty());
}

constexpr int kNoSmallDisk = 77;

/// Replaces this process's folder of temporary files by a disk of 32 KiB and fills it. Returns 0 when all is
/// as promised, kNoSmallDisk when the system lets it make no such disk, and otherwise the number of the
/// promise broken.
int fillASmallDisk() {
  const Image small = rampPicture(2, 2, {"R", "G", "B"}), noise = noisePicture();
  if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return kNoSmallDisk;
  if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return kNoSmallDisk;
  openImageIOWrites("exr");  // loads the module, which the disk may hide
  const std::string place = std::filesystem::temp_directory_path().string();
  if (mount("none", place.c_str(), "tmpfs", 0, "size=32k") != 0) return kNoSmallDisk;
  const TemporaryFolder folder;
  writeImage(small, folder / "b.exr", {});
  const std::string before = readText(folder / "b.exr");
  for (const std::string& name : kFileNames) {
    try {
      writeImage(noise, folder / name, {});
      return 1;
    } catch (const MachineError& error) {
      if (std::string(error.what()).find("No space left on device") == std::string::npos) return 2;
    } catch (...) {
      return 3;
    }
  }
  if (readText(folder / "b.exr") != before) return 4;
  if (filesIn(folder) != std::vector<std::string>{"b.exr"}) return 5;
  return 0;
}

TEST(ImageDeathTest, AFullDiskIsAMachineErrorAndLeavesTheOldFileAndNothingElse) {
  // A process of its own, started afresh: OpenImageIO's threads would not survive a mere fork.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  static int status = -1;
  EXPECT_EXIT(
      _exit(fillASmallDisk()),
      [](int exit_status) {
        status = WIFEXITED(exit_status) ? WEXITSTATUS(exit_status) : -1;
        return status == 0 || status == kNoSmallDisk;
      },
      "");
  if (status == kNoSmallDisk) GTEST_SKIP() << "this system lets the test make no small disk";
}

TEST(Image, PicturesWithoutColorsNeedAFloatFormat) {
  const TemporaryFolder folder;
  const Image image = rampPicture(2, 2, {"depth"});
  EXPECT_THAT(messageOf<InputError>([&] { writeImage(image, folder / "a.png", {}); }),
              HasSubstr("expected .exr"));
  EXPECT_TRUE(filesIn(folder).empty());
}

TEST(Image, UnreadableFilesAreOneLineErrors) {
  const TemporaryFolder folder;
  std::ofstream(folder / "empty.png");
  std::ofstream(folder / "text.exr") << "not a picture\nat all\n";
  std::filesystem::create_directory(folder / "folder.png");
  for (const char* name : {"missing.png", "empty.png", "text.exr", "folder.png"}) {
    EXPECT_THAT(messageOf<InputError>([&] { readImage(folder / name); }),
                AllOf(HasSubstr(name), Not(HasSubstr("\n"))));
  }
}

TEST(Image, TruncatedFilesAreErrors) {
  const TemporaryFolder folder;
  const Image image = rampPicture(64, 64, {"R", "G", "B"});
  for (const char* name : {"a.png", "a.exr", "a.tif", "a.hdr", "a.ppm", "a.bmp", "a.jpg", "a.tga"}) {
    SCOPED_TRACE(name);
    writeImage(image, folder / name, {});
    const std::string bytes = readText(folder / name);
    std::ofstream(folder / name, std::ios::binary | std::ios::trunc) << bytes.substr(0, bytes.size() / 2);
    EXPECT_THAT(messageOf<InputError>([&] { readImage(folder / name); }), Not(HasSubstr("\n")));
  }
}

TEST(Image, MadeUpSizesAreRefusedBeforeAllocation) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.ppm", std::ios::binary) << "P6\n32000 20000\n255\nabc";
  EXPECT_THAT(messageOf<InputError>([&] { readImage(folder / "a.ppm"); }),
              HasSubstr("the header is damaged"));
  std::ofstream(folder / "b.ppm", std::ios::binary) << "P6\n40000 10\n255\nabc";
  EXPECT_THAT(messageOf<InputError>([&] { readImage(folder / "b.ppm"); }), HasSubstr("expected 1 to 32768"));
}

}  // namespace
}  // namespace luciole
