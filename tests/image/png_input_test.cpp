#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "image/read_texture.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "png_chunk.hpp"
#include "shared_files.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What OpenImageIO's own reader makes of a file: the values of a 16-bit picture.
Image byOpenImageIO(const std::string& path) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path, &config);
  if (!input) {
    ADD_FAILURE() << OIIO::geterror();
    return {};
  }
  const OIIO::ImageSpec& spec = input->spec();
  Image image{spec.width, spec.height, spec.channelnames, {}};
  std::vector<std::uint16_t> codes(std::size_t(spec.width) * spec.height * spec.nchannels);
  EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT16, codes.data()));
  const std::string space = OIIO::Strutil::lower(spec.get_string_attribute("oiio:ColorSpace"));
  const bool is_linear = OIIO::Strutil::starts_with(space, "lin");
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const bool is_alpha = int(i % spec.nchannels) == spec.alpha_channel;
    image.pixels.push_back(is_alpha || is_linear ? float(codes[i]) / 65535.0f : linearOfSrgb16()[codes[i]]);
  }
  return image;
}

/// Pseudo-random rows of a picture, all seven passes of them if it is interlaced (Adam7), by all filters.
std::string someRows(int width, int height, int bits_of_pixel, bool interlaced) {
  struct Pass {
    int x, y, step_x, step_y;
  };
  const std::vector<Pass> passes =
      interlaced ? std::vector<Pass>{{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                     {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}
                 : std::vector<Pass>{{0, 0, 1, 1}};
  std::string bytes;
  std::uint32_t state = 1;
  const auto random = [&] { return char((state = state * 1664525u + 1013904223u) >> 24); };
  for (const Pass& pass : passes) {
    const int across = (width - pass.x + pass.step_x - 1) / pass.step_x;
    const int down = (height - pass.y + pass.step_y - 1) / pass.step_y;
    if (across <= 0) continue;
    for (int y = 0; y < down; ++y) {
      bytes += char(y % 5);
      for (int i = 0; i < (across * bits_of_pixel + 7) / 8; ++i) bytes += random();
    }
  }
  return bytes;
}

struct Kind {
  int color_type, bits, channels;
};
const std::vector<Kind> kKinds{{0, 1, 1}, {0, 2, 1},  {0, 4, 1},  {0, 8, 1}, {0, 16, 1},
                               {2, 8, 3}, {2, 16, 3}, {3, 1, 1},  {3, 2, 1}, {3, 4, 1},
                               {3, 8, 1}, {4, 8, 2},  {4, 16, 2}, {6, 8, 4}, {6, 16, 4}};

std::string palette(int bits) {
  std::string colors;
  for (int i = 0; i < 3 << bits; ++i) colors += char(i * 37);
  return pngChunk("PLTE", colors);
}

/// A transparent colour, or the alpha of half a palette.
std::string transparency(const Kind& kind) {
  if (kind.color_type == 3) return pngChunk("tRNS", std::string(std::size_t(1) << (kind.bits - 1), '\x55'));
  return pngChunk("tRNS", std::string(kind.color_type == 0 ? 2 : 6, '\0'));
}

TEST(PngInput, GivesWhatOpenImageIOsReaderGives) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.png";
  for (const Kind& kind : kKinds) {
    for (const bool interlaced : {false, true}) {
      for (const bool transparent : {false, true}) {
        if (transparent && kind.color_type >= 4) continue;  // they have alpha
        std::string between = kind.color_type == 3 ? palette(kind.bits) : "";
        if (transparent) between += transparency(kind);
        for (const auto& [width, height] : {std::pair{13, 11}, {1, 1}, {3, 9}}) {
          writeText(path, pngFile(width, height, kind.bits, kind.color_type, interlaced, between,
                                  someRows(width, height, kind.bits * kind.channels, interlaced)));
          const Image expected = byOpenImageIO(path), read = readImage(path);
          SCOPED_TRACE(testing::Message()
                       << "colour type " << kind.color_type << ", " << kind.bits << " bits, " << width
                       << " x " << height << (interlaced ? ", interlaced" : "")
                       << (transparent ? ", transparent" : ""));
          EXPECT_EQ(read.width, expected.width);
          EXPECT_EQ(read.height, expected.height);
          EXPECT_EQ(read.channels, expected.channels);
          EXPECT_EQ(read.pixels, expected.pixels);
        }
      }
    }
  }
}

TEST(PngInput, TakesAGammaOfOneForLinearLight) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.png";
  for (const std::uint32_t gamma : {100000u, 100400u, 99600u, 101000u, 45455u, 0u}) {
    std::string value;
    append(value, gamma);
    for (const std::string& srgb : {std::string(), pngChunk("sRGB", std::string(1, '\0'))}) {
      writeText(path,
                pngFile(13, 11, 8, 2, false, srgb + pngChunk("gAMA", value), someRows(13, 11, 24, false)));
      EXPECT_EQ(readImage(path).pixels, byOpenImageIO(path).pixels)
          << gamma << (srgb.empty() ? "" : ", sRGB");
    }
  }
}

TEST(PngInput, IsKnownByWhatItHoldsNotByItsName) {
  const TemporaryFolder folder;
  writeText(folder / "a.jpg", pngFile(2, 1, 8, 0, false, "", std::string("\0\x40\x80", 3)));
  EXPECT_EQ(readImage(folder / "a.jpg").pixels,
            (std::vector<float>{linearOfSrgb16()[0x4040], linearOfSrgb16()[0x8080]}));
}

/// The message of the InputError that reading throws; nothing else may reach the terminal.
std::string quietErrorOf(const std::string& path) {
  testing::internal::CaptureStderr();
  std::string message = "no error";
  try {
    readTexture(path);
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << message;
  return message;
}

TEST(PngInput, DamageIsOneLineAndTheLibraryPrintsNone) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.png";
  for (const bool interlaced : {false, true}) {
    std::string rows = someRows(13, 11, 24, interlaced);
    const std::string whole = pngFile(13, 11, 8, 2, interlaced, "", rows);
    rows[0] = 9;
    writeText(path, pngFile(13, 11, 8, 2, interlaced, "", rows));
    EXPECT_THAT(quietErrorOf(path),
                AllOf(HasSubstr("a.png: damaged: bad adaptive filter value"), Not(HasSubstr("\n"))));
    for (const std::size_t size : {20u, 35u, 60u, 300u}) {
      writeText(path, whole.substr(0, size));
      EXPECT_THAT(quietErrorOf(path), AllOf(HasSubstr("a.png: "), Not(HasSubstr("\n")))) << size;
    }
    for (std::size_t i = 8; i < 100; ++i) {
      std::string bytes = whole;
      bytes[i] ^= 0x55;
      writeText(path, bytes);
      EXPECT_THAT(quietErrorOf(path), Not(HasSubstr("\n"))) << i;
    }
  }
}

}  // namespace
}  // namespace luciole::test
