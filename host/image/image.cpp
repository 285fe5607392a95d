#include "image/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "error.hpp"
#include "image/oiio.hpp"
#include "image/srgb.hpp"

namespace luciole {
namespace {

int channelIndex(const Image& image, const std::string& name) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), name);
  return found == image.channels.end() ? -1 : int(found - image.channels.begin());
}

/// The channels a format of few channels takes: R G B, and A where it fits; Y alone is spread over R G B.
std::vector<int> colorChannels(const Image& image, const FileFormat& format, const std::string& path) {
  std::vector<int> colors;
  for (const char* name : {"R", "G", "B"}) colors.push_back(channelIndex(image, name));
  if (image.channels.size() <= 2 && channelIndex(image, "Y") >= 0) colors.assign(3, channelIndex(image, "Y"));
  if (std::count(colors.begin(), colors.end(), -1) > 0) {
    throw InputError(fmt::format("{}: .{} holds R G B and the picture has no such channels, expected .exr",
                                 path, format.extension));
  }
  const int alpha = channelIndex(image, "A");
  if (format.max_channels >= 4 && alpha >= 0) colors.push_back(alpha);
  return colors;
}

OIIO::ImageSpec makeSpec(const Image& image, const std::vector<std::string>& channels, OIIO::TypeDesc type,
                         const Metadata& metadata) {
  OIIO::ImageSpec spec(image.width, image.height, int(channels.size()), type);
  spec.channelnames = channels;
  const auto alpha = std::find(channels.begin(), channels.end(), "A");
  spec.alpha_channel = alpha == channels.end() ? -1 : int(alpha - channels.begin());
  spec.attribute("oiio:UnassociatedAlpha", 1);
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  return spec;
}

std::uint8_t toByte(float unit) { return std::uint8_t(unit * 255.0f + 0.5f); }

}  // namespace

Image readImage(const std::string& path) {
  const auto input = openPicture(path, path);
  const OIIO::ImageSpec spec = input->spec();
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.channelnames;
  const std::size_t channels = image.channels.size();
  image.pixels.resize(std::size_t(spec.width) * spec.height * channels);
  if (spec.format.is_floating_point()) {
    readValues(*input, path, OIIO::TypeDesc::FLOAT, image.pixels.data());
    return image;
  }
  std::vector<std::uint16_t> codes(image.pixels.size());
  readValues(*input, path, OIIO::TypeDesc::UINT16, codes.data());
  const bool is_linear = isLinear(spec);
  const std::vector<float>& linear_of_code = linearOfSrgb16();
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const bool is_color = int(i % channels) != spec.alpha_channel;
    image.pixels[i] = is_color && !is_linear ? linear_of_code[codes[i]] : float(codes[i]) / 65535.0f;
  }
  return image;
}

std::string readAttribute(const std::string& path, const std::string& name) {
  return openPicture(path, path)->spec().get_string_attribute(name);
}

void writeImage(const Image& image, const std::string& path, const Metadata& metadata) {
  const FileFormat format = outputFormat(path);
  if (format.max_channels > 4) {
    OIIO::ImageSpec spec = makeSpec(image, image.channels, OIIO::TypeDesc::FLOAT, metadata);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    writePicture(path, spec, image.pixels.data());
    return;
  }
  const std::vector<int> sources = colorChannels(image, format, path);
  std::vector<std::string> names{"R", "G", "B", "A"};
  names.resize(sources.size());
  const std::size_t pixels = std::size_t(image.width) * image.height;
  const auto value = [&](std::size_t pixel, std::size_t channel) {
    return image.pixels[pixel * image.channels.size() + sources[channel]];
  };
  if (format.is_float) {
    std::vector<float> values;
    values.reserve(pixels * sources.size());
    for (std::size_t p = 0; p < pixels; ++p) {
      for (std::size_t c = 0; c < sources.size(); ++c) values.push_back(value(p, c));
    }
    OIIO::ImageSpec spec = makeSpec(image, names, OIIO::TypeDesc::FLOAT, metadata);
    writePicture(path, spec, values.data());
    return;
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(pixels * sources.size());
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t c = 0; c < sources.size(); ++c) {
      const float v = value(p, c);
      const bool is_alpha = c == 3;
      bytes.push_back(toByte(is_alpha ? (v > 0.0f ? std::min(v, 1.0f) : 0.0f) : encodeSrgb(v)));
    }
  }
  OIIO::ImageSpec spec = makeSpec(image, names, OIIO::TypeDesc::UINT8, metadata);
  spec.attribute("oiio:ColorSpace", "sRGB");
  // OpenImageIO's own 98 doubles the size for what nobody sees.
  if (format.extension == "jpg" || format.extension == "jpeg") spec.attribute("compression", "jpeg:88");
  writePicture(path, spec, bytes.data());
}

}  // namespace luciole
