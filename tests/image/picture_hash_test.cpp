#include "image/picture_hash.hpp"

#include <gtest/gtest.h>

#include <string>

namespace luciole::test {
namespace {

Image smallPicture() { return {2, 2, {"R", "G", "B"}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}; }

// Of Python's struct.pack("<3I12f", 2, 2, 3, *range(12)), by its hashlib.
TEST(PictureHash, IsOfTheBytesThatAreTold) {
  EXPECT_EQ(pictureHash(smallPicture()), "0fbd8d157092b6d9ae71805eca02a3fe7f39ce3e8188ba594143f12385f26a64");
}

TEST(PictureHash, RowsAddUp) {
  const Image picture = smallPicture();
  PictureHash hash(2, 2, picture.channels);
  for (int y = 0; y < 2; ++y)
    hash.add(
        {2, 1, picture.channels, {picture.pixels.begin() + 6 * y, picture.pixels.begin() + 6 * (y + 1)}});
  EXPECT_EQ(hash.hex(), pictureHash(picture));
}

TEST(PictureHash, LayersDontCountWhereverTheyLie) {
  Image layered = smallPicture();
  layered.channels = {"depth.Z", "R", "G", "B", "normal.X"};
  layered.pixels.clear();
  for (int pixel = 0; pixel < 4; ++pixel)
    for (const float value : {-1.0f, 3.0f * pixel, 3.0f * pixel + 1, 3.0f * pixel + 2, -2.0f})
      layered.pixels.push_back(value);
  EXPECT_EQ(pictureHash(layered), pictureHash(smallPicture()));
}

TEST(PictureHash, ShapeChannelsSignsAndEachBitCount) {
  const std::string hash = pictureHash(smallPicture());
  Image wide = smallPicture();
  wide.width = 4;
  wide.height = 1;
  EXPECT_NE(pictureHash(wide), hash);
  Image with_alpha{3, 1, {"R", "G", "B", "A"}, smallPicture().pixels};
  Image without{4, 1, {"R", "G", "B"}, smallPicture().pixels};
  EXPECT_NE(pictureHash(with_alpha), pictureHash(without));
  Image negative = smallPicture();
  negative.pixels[0] = -0.0f;
  EXPECT_NE(pictureHash(negative), hash);
  Image last_bit = smallPicture();
  last_bit.pixels[11] = 11 + 0x1p-20f;
  EXPECT_NE(pictureHash(last_bit), hash);
}

}  // namespace
}  // namespace luciole::test
