#include "image/read_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/machine_memory.hpp"
#include "image/build_mips.hpp"
#include "image/oiio.hpp"
#include "image/spread_texels.hpp"
#include "image/srgb.hpp"
#include "luciole/array_memory.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr int kNone = -1;

/// Where R, G, B and A of a texel lie in a pixel of the file; A may be kNone.
std::array<int, 4> channelPlaces(const OIIO::ImageSpec& spec, const std::string& name) {
  // A damaged TIFF may name an alpha that it hasn't got.
  const int alpha = spec.alpha_channel < spec.nchannels ? spec.alpha_channel : kNone;
  const auto place = [&](const char* channel) { return spec.channelindex(channel); };
  if (place("R") >= 0 && place("G") >= 0 && place("B") >= 0)
    return {place("R"), place("G"), place("B"), alpha};
  std::vector<int> colors;
  for (int i = 0; i < spec.nchannels; ++i) {
    if (i != alpha) colors.push_back(i);
  }
  if (colors.size() == 1) return {colors[0], colors[0], colors[0], alpha};
  if (colors.size() >= 3) return {colors[0], colors[1], colors[2], alpha};
  throw InputError(fmt::format("{}: channels '{}', expected grey or R G B, and A", name,
                               fmt::join(spec.channelnames, " ")));
}

std::uint16_t toCode(float unit) { return std::uint16_t(unit * 65535.0f + 0.5f); }
float clampUnit(float value) { return value > 0.0f ? std::min(value, 1.0f) : 0.0f; }

/// The texels of float pictures, and of integer ones that are marked as linear.
Texels texelsOfLinear(OIIO::ImageInput& input, const std::string& name, const std::array<int, 4>& places) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::size_t pixels = std::size_t(spec.width) * spec.height;
  std::vector<float> values(pixels * spec.nchannels);
  readValues(input, name, OIIO::TypeDesc::FLOAT, values.data());
  const bool multiplied = places[3] != kNone && !spec.get_int_attribute("oiio:UnassociatedAlpha");
  Texels texels(pixels * 4);
  for (std::size_t p = 0; p < pixels; ++p) {
    const float* value = &values[p * spec.nchannels];
    const float alpha = places[3] == kNone ? 1.0f : clampUnit(value[places[3]]);
    const float scale = multiplied && alpha > 0.0f ? 1.0f / alpha : 1.0f;
    for (int c = 0; c < 3; ++c) texels[p * 4 + c] = toCode(encodeSrgb(value[places[c]] * scale));
    texels[p * 4 + 3] = toCode(alpha);
  }
  return texels;
}

template <class Code>
Texels texelsOf(OIIO::ImageInput& input, const std::string& name, const std::array<int, 4>& places) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::size_t pixels = std::size_t(spec.width) * spec.height;
  RawArray<Code> values(pixels * spec.nchannels);
  readValues(input, name, OIIO::BaseTypeFromC<Code>::value, values.data());
  Texels texels(pixels * 4);
  for (std::size_t p = 0; p < pixels; ++p) {
    const Code* value = &values[p * spec.nchannels];
    for (int c = 0; c < 4; ++c) texels[p * 4 + c] = places[c] == kNone ? 65535 : wideCode(value[places[c]]);
  }
  return texels;
}

/// The texels of pictures of integers, which are sRGB.
Texels texelsOfCodes(OIIO::ImageInput& input, const std::string& name, const std::array<int, 4>& places) {
  const bool bytes = input.spec().format == OIIO::TypeDesc::UINT8;
  return bytes ? texelsOf<std::uint8_t>(input, name, places) : texelsOf<std::uint16_t>(input, name, places);
}

/// knows_space: whether what the file says of its colour space counts.
Texture read(const std::string& path, const std::string& name, bool knows_space) {
  const auto input = openPicture(path, name);
  const OIIO::ImageSpec& spec = input->spec();
  const std::array<int, 4> places = channelPlaces(spec, name);
  const bool linear = knows_space ? isLinear(spec) : spec.format.is_floating_point();
  // The file's values, its texels, and a third more for the mip chain.
  requireMemory(double(spec.width) * spec.height * (spec.nchannels * sizeof(float) + 4 * sizeof(float)),
                name);
  MipLevel finest{spec.width, spec.height, {}};
  finest.texels = linear ? texelsOfLinear(*input, name, places) : texelsOfCodes(*input, name, places);
  Texture texture{name, {}};
  texture.levels.push_back(std::move(finest));
  texture.linear = linear;
  buildMips(texture);
  return texture;
}

}  // namespace

Texture readTexture(const std::string& path) { return read(path, path, true); }

Texture readTexture(std::span<const std::byte> file, const std::string& name) {
  const MemoryFile in_memory(file);
  try {
    return read(in_memory.path(), name, false);
  } catch (const InputError& error) {
    // Some decoders name the file that they read.
    throw InputError(OIIO::Strutil::replace(error.what(), in_memory.path(), name, true));
  }
}

}  // namespace luciole
