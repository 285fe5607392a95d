// Pictures that come row by row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::filesIn;
using test::readText;
using test::TemporaryFolder;

const std::vector<std::string> kExtensions{"exr", "tif", "hdr", "png", "jpg", "ppm",
                                           "bmp", "tga", "sgi", "pfm", "npy"};

Image somePicture(int width, int height) {
  Image image{width, height, {"R", "G", "B"}, {}};
  for (int i = 0; i < 3 * width * height; ++i) image.pixels.push_back(float(i * 7 % 101) / 100);
  return image;
}

Image cutRows(const Image& image, int first, int count) {
  const std::size_t row = image.width * image.channels.size();
  return {image.width,
          count,
          image.channels,
          {image.pixels.begin() + first * row, image.pixels.begin() + (first + count) * row}};
}

TEST(ImageWriter, PiecesOfAnyHeightMakeTheWholePicture) {
  const TemporaryFolder folder;
  const Image image = somePicture(53, 70);
  for (const std::string& extension : kExtensions) {
    const std::string path = folder / ("a." + extension);
    writeImage(image, path, {});
    const Image whole = readImage(path);
    ASSERT_EQ(whole.height, image.height);
    for (const int height : {1, 16, 33}) {
      ImageWriter writer(path, image.width, image.height, image.channels, {});
      for (int y = 0; y < image.height; y += height)
        writer.write(cutRows(image, y, std::min(height, image.height - y)));
      writer.close();
      EXPECT_TRUE(readImage(path).pixels == whole.pixels) << extension << ", " << height << " rows at a time";
    }
  }
}

TEST(ImageWriter, WhatIsNotFinishedLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const Image image = somePicture(53, 70);
  for (const std::string& extension : kExtensions) {
    const std::string path = folder / ("a." + extension);
    std::ofstream(path) << "old";
    for (const int rows : {0, 1, 35, 70}) {
      ImageWriter writer(path, image.width, image.height, image.channels, {});
      if (rows > 0) writer.write(cutRows(image, 0, rows));
    }
    EXPECT_EQ(readText(path), "old") << extension;
  }
  EXPECT_EQ(filesIn(folder).size(), kExtensions.size());
}

TEST(ImageWriter, BytesInMemoryAreThoseOfTheFile) {
  const TemporaryFolder folder;
  const Image image = somePicture(70, 50);
  writeImage(image, folder / "a.png", {}, {.dither = true});
  std::string bytes;
  writeImage(image, "b.png", {}, {.dither = true, .memory = &bytes});
  EXPECT_EQ(bytes, readText(folder / "a.png"));
}

TEST(ImageWriter, AJpegInMemoryShowsThePicture) {
  const TemporaryFolder folder;
  Image image{160, 90, {"R", "G", "B"}, {}};
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 160; ++x)
      for (const float value : {float(x) / 160, float(y) / 90, 0.5f}) image.pixels.push_back(value);
  std::string bytes;
  writeImage(image, "a.jpg", {}, {.memory = &bytes});
  std::ofstream(folder / "a.jpg", std::ios::binary) << bytes;
  const Image read = readImage(folder / "a.jpg");
  ASSERT_EQ(read.width, 160);
  ASSERT_EQ(read.height, 90);
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) sum += std::abs(read.pixels[i] - image.pixels[i]);
  // At quality 85 codes of such ramps are wrong by 2 of 255 or so, and a code is 2.4/255 of light at most.
  EXPECT_LT(sum / double(image.pixels.size()), 3 * 2.4 / 255);
}

TEST(ImageWriter, OtherFormatsInMemoryAreRefused) {
  std::string bytes;
  EXPECT_THROW(writeImage(somePicture(1, 1), "a.exr", {}, {.memory = &bytes}), InputError);
}

}  // namespace
}  // namespace luciole
