#include "image/picture_hash.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

TEST(PictureHash, IsTheSha256OfItsLineAndItsFloats) {
  // By coreutils: printf '2x1 R G\n' and the floats 0, 1, -0, 0.5 in bytes, | sha256sum.
  const Image image{2, 1, {"R", "G"}, {0.0f, 1.0f, -0.0f, 0.5f}};
  EXPECT_EQ(pictureHash(image), "d1999d5956e5b1fc00dae91e29910340d9b04dc376625cff70ad9b0ed37f57fa");
}

TEST(PictureHash, IsTheSameInPieces) {
  const Image whole{1, 3, {"Y"}, {1.0f, 2.0f, 3.0f}}, first{1, 1, {"Y"}, {1.0f}},
      rest{1, 2, {"Y"}, {2.0f, 3.0f}};
  PictureHash hash(1, 3, {"Y"});
  hash.add(first);
  hash.add(rest);
  EXPECT_EQ(hash.digits(), pictureHash(whole));
}

TEST(PictureHash, TellsShapesChannelsAndSignsOfZeroApart) {
  const std::string one = pictureHash({2, 1, {"Y"}, {0.0f, 1.0f}});
  EXPECT_NE(one, pictureHash({1, 2, {"Y"}, {0.0f, 1.0f}}));
  EXPECT_NE(one, pictureHash({2, 1, {"A"}, {0.0f, 1.0f}}));
  EXPECT_NE(one, pictureHash({2, 1, {"Y"}, {-0.0f, 1.0f}}));
}

}  // namespace
}  // namespace luciole::test
