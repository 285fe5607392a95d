#include "tools/view/frame_size.hpp"

#include <gtest/gtest.h>

namespace luciole {
namespace {

/// The size that frames settle at which take `fixed` milliseconds and `of_million` for a million pixels.
glm::ivec2 settled(double fixed, double of_million) {
  const glm::ivec2 wanted(1280, 720);
  FrameCosts costs;
  addFrame(wanted, fixed + of_million * 0.9216, costs);
  glm::ivec2 size(0);
  for (int i = 0; i < 60; ++i) {
    size = frameSize(costs, wanted);
    addFrame(size, fixed + of_million * 1e-6 * size.x * size.y, costs);
  }
  return size;
}

TEST(FrameSize, IsAllThatIsWantedWhereThatIsQuick) { EXPECT_EQ(settled(5, 10), glm::ivec2(1280, 720)); }

TEST(FrameSize, KeepsFramesWithin40Milliseconds) {
  for (const double fixed : {2.0, 10.0, 20.0})
    for (const double of_million : {50.0, 100.0, 300.0}) {
      const glm::ivec2 size = settled(fixed, of_million);
      const double milliseconds = fixed + of_million * 1e-6 * size.x * size.y;
      EXPECT_LE(milliseconds, 40) << fixed << " " << of_million;
      EXPECT_TRUE(milliseconds > 25 || size.x == 1280) << fixed << " " << of_million << " " << size.x;
    }
}

TEST(FrameSize, DoesNotShrinkForNothingWhereTrianglesTakeTheTime) {
  const glm::ivec2 size = settled(60, 60);
  EXPECT_GE(size.x, 640) << "pixels take a quarter of the time: 333,000 of them";
  EXPECT_LE(size.x, 768);
}

TEST(FrameSize, IsHalfOfWhatIsWantedBeforeAnythingIsKnown) {
  EXPECT_EQ(frameSize({}, {1280, 720}), glm::ivec2(640, 360));
  EXPECT_EQ(frameSize({}, {16, 9}), glm::ivec2(16, 16)) << "but never less than a tile";
}

}  // namespace
}  // namespace luciole
