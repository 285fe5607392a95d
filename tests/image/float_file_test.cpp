// Arrays of floats as other programs read and write them.
#include "image/float_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "image/layers.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <class T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

const Image kPicture{2, 2, {"R", "G", "B"}, {1, -2, 3e-30f, 4, 5, 1e30f, 7, 8, 9, 10, 11, 12.5f}};

TEST(FloatFile, APfmHasItsRowsFromTheBottomUp) {
  const TemporaryFolder folder;
  writeImage(kPicture, folder / "a.pfm", {});
  EXPECT_EQ(
      readText(folder / "a.pfm"),
      "PF\n2 2\n-1.0\n" + bytesOf(std::vector<float>{7, 8, 9, 10, 11, 12.5f, 1, -2, 3e-30f, 4, 5, 1e30f}));
  const Image read = readImage(folder / "a.pfm");
  EXPECT_EQ(read.pixels, kPicture.pixels);
  EXPECT_EQ(read.channels, kPicture.channels);
}

TEST(FloatFile, AnNpyIsAnArrayOfRowsFromTheTopDown) {
  const TemporaryFolder folder;
  writeImage(kPicture, folder / "a.npy", {});
  const std::string file = readText(folder / "a.npy"), pixels = bytesOf(kPicture.pixels);
  EXPECT_TRUE(file.starts_with(
      std::string("\x93NUMPY\1\0v\0{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }", 72)));
  ASSERT_EQ(file.size(), 128 + pixels.size());
  EXPECT_EQ(file[127], '\n');
  EXPECT_EQ(file.substr(128), pixels);
  const Image read = readImage(folder / "a.npy");
  EXPECT_EQ(read.pixels, kPicture.pixels);
  EXPECT_EQ(read.channels, kPicture.channels);
  ASSERT_EQ(readParts(folder / "a.npy").size(), 1u);
  EXPECT_EQ(readParts(folder / "a.npy")[0].size, glm::ivec2(2, 2));
}

TEST(FloatFile, ValuesAreKeptAsTheyAreAndOnlyNpyHoldsCoverage) {
  const TemporaryFolder folder;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Image image{1, 1, {"R", "G", "B", "A", "Z"}, {kInfinity, -0.0f, 2, 0.5f, 9}};
  writeImage(image, folder / "a.npy", {}, {.alpha = true});
  EXPECT_EQ(readImage(folder / "a.npy").pixels, (std::vector<float>{kInfinity, -0.0f, 2, 0.5f}));
  EXPECT_EQ(readImage(folder / "a.npy").channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_THROW(writeImage(image, folder / "a.pfm", {}, {.alpha = true}), InputError);
  for (const char* file : {"/b.npy", "/b.pfm"}) {
    EXPECT_THROW(writeImage(image, folder.path().string() + file, {}, {.bits = 8}), InputError);
    EXPECT_THROW(writeImage(image, folder.path().string() + file, {}, {.half = true}), InputError);
  }
}

/// A .npy file of this dictionary and these values.
std::string npy(const std::string& dictionary, const std::string& values, char version = 1) {
  std::string file = "\x93NUMPY";
  file += version;
  file += '\0';
  file += char(dictionary.size());
  file += '\0';
  if (version > 1) file += std::string(2, '\0');
  return file + dictionary + values;
}

TEST(FloatFile, ArraysOfOtherProgramsAreRead) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.npy";
  std::ofstream(path, std::ios::binary) << npy("{'shape': (1, 3), 'descr': '<f8', 'fortran_order': False}\n",
                                               bytesOf(std::vector<double>{1, 2, 0.1}));
  EXPECT_EQ(readImage(path).channels, (std::vector<std::string>{"Y"}));
  EXPECT_EQ(readImage(path).pixels, (std::vector<float>{1, 2, 0.1f}));
  std::ofstream(path, std::ios::binary)
      << npy("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 1, 1), }\n",
             bytesOf(std::vector<float>{1, 2, 3}), 2);
  EXPECT_EQ(readImage(path).height, 3);
}

TEST(FloatFile, ArraysThatAreNoPicturesAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.npy";
  const auto refuses = [&](const std::string& file, const std::string& why) {
    std::ofstream(path, std::ios::binary) << file;
    EXPECT_THAT([&] { readImage(path); }, ThrowsMessage<InputError>(HasSubstr(why))) << why;
  };
  const auto header = [](const std::string& type, const std::string& order, const std::string& shape) {
    return "{'descr': " + type + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  };
  const std::string one = bytesOf(std::vector<float>{1});
  refuses(npy(header("'<i4'", "False", "(1, 1)"), one), "an array of '<i4', expected '<f4' or '<f8'");
  refuses(npy(header("[('x', '<f4')]", "False", "(1, 1)"), one), "expected '<f4' or '<f8'");
  refuses(npy(header("'<f4'", "True", "(1, 1)"), one), "Fortran's order");
  for (const char* shape : {"()", "(1,)", "(1, 1, 2)", "(1, 1, 1, 1)", "(x, 1)", "(-1, -1)"})
    refuses(npy(header("'<f4'", "False", shape), one), "expected");
  refuses(npy(header("'<f4'", "False", "(1000000, 1000000)"), one), "1000000 pixels a side");
  refuses(npy(header("'<f4'", "False", "(99999999999999999999, 1)"), one), "expected (height, width)");
  refuses(npy(header("'<f4'", "False", "(2, 1)"), one), "4 bytes of values, expected 8 by its shape");
  refuses(npy(header("'<f4'", "False", "(1, 1)"), one + "x"), "5 bytes of values, expected 4 by its shape");
  refuses(std::string("\x93NUMPY\1\0\xff\xff{", 11), "ends inside its header");
  refuses(npy("{}", one), "expected '<f4' or '<f8'");
}

}  // namespace
}  // namespace luciole::test
