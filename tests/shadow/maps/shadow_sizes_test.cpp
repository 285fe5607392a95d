#include "shadow/maps/shadow_sizes.hpp"

#include <gtest/gtest.h>

#include "luciole/error.hpp"
#include "shadow/maps/shadow_scenes.hpp"

namespace luciole::test {
namespace {

TEST(ShadowSizes, ThousandPointLightsFitIntoSixteenMebibytesCoarser) {
  const Scene scene = thousandLamps();
  const ShadowLimits roomy{.bytes = std::size_t(64) << 30}, tight{.bytes = std::size_t(16) << 20};
  const ShadowMaps wanted = planFor(scene, {1920, 1080}, roomy), maps = planFor(scene, {1920, 1080}, tight);
  EXPECT_EQ(wanted.reduced_lights, 0u);
  EXPECT_GT(wanted.planned_texels * sizeof(ShadowTexel), tight.bytes);
  EXPECT_EQ(maps.reduced_lights, 1000u);
  EXPECT_LE(maps.planned_texels * sizeof(ShadowTexel), tight.bytes);
  ASSERT_EQ(maps.maps.size(), 1000u);
  ASSERT_EQ(maps.faces.size(), 6000u);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(maps.map_of_light[i], i);
    EXPECT_EQ(maps.maps[i].first_face, 6 * i);
    EXPECT_EQ(maps.maps[i].face_count, 6u);
    EXPECT_GE(maps.planned[6 * i].view.size.x, kSmallestFace);
    EXPECT_LT(maps.faces[6 * i].scale, wanted.faces[6 * i].scale);
  }
}

TEST(ShadowSizes, LimitThatTheSmallestFacesExceedIsRefused) {
  const Scene scene = thousandLamps();
  const std::size_t least = 6000 * kSmallestFace * kSmallestFace * sizeof(ShadowTexel);
  EXPECT_EQ(planFor(scene, {1920, 1080}, {.bytes = least}).planned_texels * sizeof(ShadowTexel), least);
  EXPECT_THROW(planFor(scene, {1920, 1080}, {.bytes = least - 1}), MachineError);
}

}  // namespace
}  // namespace luciole::test
