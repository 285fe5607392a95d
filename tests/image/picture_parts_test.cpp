// What readParts() tells of files with several parts, as other programs write them.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/utf8.hpp"
#include "image/exr_input.hpp"
#include "image/layers.hpp"
#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// An EXR of two parts: half colours, a crop, and float depth.
void writeTwoParts(const std::string& path) {
  OIIO::ImageSpec color(20, 10, 3, OIIO::TypeDesc::HALF), depth(40, 30, 1, OIIO::TypeDesc::FLOAT);
  color.channelnames = {"beauty.R", "beauty.G", "beauty.B"};
  color.attribute("oiio:subimagename", "beauty");
  color.attribute("compression", "piz");
  color.attribute("Software", "Painter");
  color.x = 5;
  color.y = 7;
  color.full_width = 40;
  color.full_height = 30;
  depth.channelnames = {"Z"};
  depth.attribute("oiio:subimagename", "depth");
  const std::vector<float> values(40 * 30, 0.5f);
  const auto output = OIIO::ImageOutput::create("exr");
  const OIIO::ImageSpec specs[]{color, depth};
  ASSERT_TRUE(output->open(path, 2, specs));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->open(path, depth, OIIO::ImageOutput::AppendSubimage));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
}

TEST(PictureParts, TextsOfHeadersAreUtf8) {
  EXPECT_EQ(utf8Of("Caf\xe9 \xa0"), "Caf\u00e9 \u00a0");
  EXPECT_EQ(utf8Of("Caf\u00e9, 灯"), "Caf\u00e9, 灯");
  EXPECT_EQ(utf8Of("\xc3"), "\u00c3") << "cut off in a character";
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  writeImage({1, 1, {"Y"}, {0}}, path, {},
             {.exr = {.texts = {{"luciole:cameraName", "Caf\xe9"}}, .matrices = {}}});
  const std::pair<std::string, std::string> wanted("luciole:cameraName", "Caf\u00e9");
  EXPECT_THAT(ExrInput(path).parts()[0].attributes.texts, testing::Contains(wanted));
  EXPECT_THAT(readParts(path)[0].attributes.texts, testing::Contains(wanted));
}

TEST(PictureParts, TellWhereTheDisplayWindowLiesAndHowWidePixelsAre) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const Display display{.origin = {-7, 9}, .pixel_aspect = 0.5f};
  writeImage({2, 1, {"Y"}, {0, 1}}, path, {},
             {.picture_size = {5, 4}, .crop_origin = {-1, 2}, .display = display});
  for (const PicturePart& part : {ExrInput(path).parts()[0], readParts(path)[0]}) {
    EXPECT_EQ(part.display, display);
    EXPECT_EQ(part.picture_size, glm::ivec2(5, 4));
    EXPECT_EQ(part.crop_origin, glm::ivec2(-1, 2));
  }
  EXPECT_EQ(readImage(path).display, display);
  EXPECT_EQ(readImage(path).pixels, (std::vector<float>{0, 1}));
}

TEST(PictureParts, AreAllTold) {
  const TemporaryFolder folder;
  writeTwoParts(folder / "a.exr");
  const std::vector<PicturePart> parts = readParts(folder / "a.exr");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "beauty");
  EXPECT_EQ(parts[0].size, glm::ivec2(20, 10));
  EXPECT_EQ(parts[0].picture_size, glm::ivec2(40, 30));
  EXPECT_EQ(parts[0].crop_origin, glm::ivec2(5, 7));
  EXPECT_THAT(parts[0].channels, ElementsAre("beauty.R", "beauty.G", "beauty.B"));
  EXPECT_THAT(parts[0].types, ElementsAre("half", "half", "half"));
  EXPECT_EQ(parts[0].compression, "piz");
  EXPECT_EQ(parts[1].name, "depth");
  EXPECT_THAT(parts[1].channels, ElementsAre("Z"));
  EXPECT_THAT(parts[1].types, ElementsAre("float"));
}

TEST(PictureParts, FileThatEndsEarlyIsRefused) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec(300, 200, 3, OIIO::TypeDesc::FLOAT);
  std::vector<float> values(300 * 200 * 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i * 2654435761u % 1000);
  const auto output = OIIO::ImageOutput::create("exr");
  ASSERT_TRUE(output->open(folder / "a.exr", spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
  ASSERT_EQ(readParts(folder / "a.exr").size(), 1u);
  std::filesystem::resize_file(folder / "a.exr", std::filesystem::file_size(folder / "a.exr") - 100);
  EXPECT_THAT([&] { readParts(folder / "a.exr"); }, ThrowsMessage<InputError>(HasSubstr("a.exr")));
}

}  // namespace
}  // namespace luciole::test
