#include "image/quick_texture.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/read_texture.hpp"
#include "luciole/image.hpp"
#include "png_chunk.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

/// The finest level, from what OpenImageIO's own readers give.
Texels texelsByOpenImageIO(const std::string& path) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path, &config);
  if (!input) {
    ADD_FAILURE() << OIIO::geterror();
    return {};
  }
  const int channels = input->spec().nchannels;
  const std::size_t pixels = input->spec().image_pixels();
  std::vector<std::uint16_t> codes(pixels * channels);
  EXPECT_TRUE(input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT16, codes.data()));
  Texels texels;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint16_t* code = &codes[i * channels];
    for (int c = 0; c < 3; ++c) texels.push_back(code[channels < 3 ? 0 : c]);
    texels.push_back(channels % 2 ? 65535 : code[channels - 1]);
  }
  return texels;
}

/// A colour picture of soft shapes, as photographs have.
Image somePicture(int width, int height, int channels) {
  Image image{width, height, {}, {}};
  for (int c = 0; c < channels; ++c) image.channels.push_back(channels == 1 ? "Y" : std::string(1, "RGB"[c]));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) image.pixels.push_back(float((x * (c + 1) + y * y) % 97) / 97.0f);
  return image;
}

TEST(QuickTexture, PngsOfEveryKindHaveTheTexelsThatOpenImageIOGives) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.png";
  struct Form {
    int color_type, bits, channels;
  };
  for (const auto& [color_type, bits, channels] : {Form{0, 1, 1},
                                                   {0, 2, 1},
                                                   {0, 4, 1},
                                                   {0, 8, 1},
                                                   {2, 8, 3},
                                                   {3, 1, 1},
                                                   {3, 2, 1},
                                                   {3, 4, 1},
                                                   {3, 8, 1},
                                                   {4, 8, 2},
                                                   {6, 8, 4}}) {
    for (const bool transparent : {false, true}) {
      if (transparent && color_type > 3) continue;  // has alpha
      std::string between;
      if (color_type == 3) {
        std::string colors;
        for (int i = 0; i < 3 << bits; ++i) colors += char(i * 37);
        between = pngChunk("PLTE", colors);
      }
      // The first pixel's grey or colour, as 16 bits a channel; or the alphas of two colours of the palette.
      const std::string first_pixel("\0\0\0\x39\0\xe4", 6), alphas(2, '\x15');
      if (transparent)
        between += pngChunk("tRNS", color_type == 3 ? alphas : first_pixel.substr(0, 2 * channels));
      for (const auto& [width, height] : {std::pair{13, 11}, {1, 1}, {3, 9}}) {
        std::string rows;
        for (int y = 0; y < height; ++y) {
          rows += char(y % 5);
          for (int i = 0; i < (width * bits * channels + 7) / 8; ++i) rows += char(y * 91 + i * i * 57);
        }
        writeText(path, pngFile(width, height, bits, color_type, false, between, rows));
        SCOPED_TRACE(testing::Message() << "colour type " << color_type << ", " << bits << " bits, " << width
                                        << " x " << height << (transparent ? ", transparent" : ""));
        const std::optional<Texture> read = readQuickly(path);
        ASSERT_TRUE(read);
        EXPECT_EQ(read->levels[0].width, width);
        EXPECT_EQ(read->levels[0].height, height);
        EXPECT_EQ(read->levels[0].texels, texelsByOpenImageIO(path));
      }
    }
  }
}

TEST(QuickTexture, JpegsHaveTheTexelsThatOpenImageIOGives) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {17, 9}, {144, 93}}) {
      const std::string path = folder / "a.jpg";
      writeImage(somePicture(width, height, channels), path, {});
      const std::optional<Texture> read = readQuickly(path);
      ASSERT_TRUE(read) << channels;
      EXPECT_EQ(read->levels[0].width, width);
      EXPECT_EQ(read->levels[0].height, height);
      EXPECT_EQ(read->levels[0].texels, texelsByOpenImageIO(path)) << channels << ' ' << width;
    }
  }
}

TEST(QuickTexture, TheTexturesOfSponzaAreAllReadAndHaveTheTexelsThatOpenImageIOGives) {
  LUCIOLE_NEEDS_SHARED();
  for (const auto& entry :
       std::filesystem::directory_iterator(sharedScenes() / "sponza_crytek_obj" / "textures")) {
    const std::optional<Texture> read = readQuickly(entry.path().string());
    ASSERT_TRUE(read) << entry.path();
    EXPECT_EQ(read->levels[0].texels, texelsByOpenImageIO(entry.path().string())) << entry.path();
  }
}

TEST(QuickTexture, LeavesRareKindsAndDamagedFilesToTheOtherReader) {
  const TemporaryFolder folder;
  const auto isRead = [&](const std::string& bytes) {
    return readQuickly(std::as_bytes(std::span(bytes)), "it", true).has_value();
  };
  const std::string rows("\0\x10\0\x20", 4);
  const std::string png = pngFile(1, 2, 8, 0, false, "", rows);
  EXPECT_TRUE(isRead(png));
  EXPECT_FALSE(isRead(pngFile(1, 2, 8, 0, true, "", rows))) << "interlaced";
  EXPECT_FALSE(isRead(pngFile(1, 2, 16, 0, false, "", std::string(6, '\0')))) << "16 bits";
  EXPECT_FALSE(isRead(pngFile(1, 2, 8, 3, false, "", rows))) << "no palette";
  EXPECT_FALSE(isRead(pngFile(1, 2, 8, 0, false, "", std::string("\5\x10\0\x20", 4)))) << "no such filter";
  EXPECT_FALSE(isRead(pngFile(1, 2, 8, 0, false, pngChunk("MUST", ""), rows)));
  for (std::size_t i = 8; i < png.size() - 12; ++i) {
    std::string damaged = png;
    damaged[i] ^= 0x55;
    EXPECT_FALSE(isRead(damaged)) << i;
  }
  std::string gamma;
  append(gamma, 100000);
  EXPECT_FALSE(isRead(pngFile(1, 2, 8, 0, false, pngChunk("gAMA", gamma), rows))) << "linear";
  const std::string linear = pngFile(1, 2, 8, 0, false, pngChunk("gAMA", gamma), rows);
  EXPECT_TRUE(readQuickly(std::as_bytes(std::span(linear)), "it", false))
      << "what it says of its space doesn't count";
  for (std::size_t size = 0; size < png.size() - 16; ++size)
    EXPECT_FALSE(isRead(png.substr(0, size))) << size;
  writeImage(somePicture(40, 30, 3), folder / "a.jpg", {});
  const std::string jpeg = readText(folder / "a.jpg");
  EXPECT_TRUE(isRead(jpeg));
  for (std::size_t size = 0; size < jpeg.size() - 2; size += 7) EXPECT_FALSE(isRead(jpeg.substr(0, size)));
  EXPECT_FALSE(isRead("GIF89a"));
  EXPECT_FALSE(readQuickly(folder / "nowhere.png"));
  EXPECT_FALSE(readQuickly(folder.path().string()));
}

TEST(QuickTexture, AHeaderThatClaimsMoreThanTheFileCanHoldAllocatesNothing) {
  // A picture of 2³⁰ pixels would take 8 GiB.
  const std::string png = pngFile(32768, 32768, 8, 2, false, "", std::string(4, '\0'));
  EXPECT_FALSE(readQuickly(std::as_bytes(std::span(png)), "it", true));
}

}  // namespace
}  // namespace luciole::test
