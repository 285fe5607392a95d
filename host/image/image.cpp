#include "luciole/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <memory>

#include "base/machine_memory.hpp"
#include "base/utf8.hpp"
#include "image/layers.hpp"
#include "image/oiio.hpp"
#include "image/picture_file.hpp"
#include "image/row_file.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr OIIO::TypeDesc kMatrix(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44);

OIIO::ImageSpec makeSpec(int width, int height, const std::vector<std::string>& channels,
                         const FileFormat& format, const Metadata& metadata, const WriteOptions& options) {
  OIIO::ImageSpec spec(width, height, int(channels.size()),
                       format.is_float     ? OIIO::TypeDesc::FLOAT
                       : format.bits == 16 ? OIIO::TypeDesc::UINT16
                                           : OIIO::TypeDesc::UINT8);
  spec.channelnames = channels;
  const auto alpha = std::find(channels.begin(), channels.end(), "A");
  spec.alpha_channel = alpha == channels.end() ? -1 : int(alpha - channels.begin());
  // Otherwise OpenImageIO divides the colours of integer formats by A itself, in sRGB codes.
  const bool is_multiplied = options.alpha && format.is_float;
  spec.attribute("oiio:UnassociatedAlpha", is_multiplied ? 0 : 1);
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  const bool is_tiff = format.extension == "tif" || format.extension == "tiff";
  if (is_tiff) spec.attribute("compression", "zip");
  if (format.max_channels > 4) spec.attribute("oiio:ColorSpace", "Linear");
  // For a TIFF this would make an Exif directory, for which OpenImageIO reads the file that it writes. Its
  // integers are taken as sRGB without.
  if (!format.is_float && !is_tiff) spec.attribute("oiio:ColorSpace", "sRGB");
  // OpenImageIO's default quality of 98 doubles the size without a visible gain.
  if (format.extension == "jpg" || format.extension == "jpeg") spec.attribute("compression", "jpeg:88");
  return spec;
}

/// Texts and 4 × 4 matrices.
ExrAttributes attributesOf(const OIIO::ImageSpec& spec) {
  ExrAttributes attributes;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (value.type() == OIIO::TypeDesc::STRING)
      attributes.texts.emplace_back(name, utf8Of(value.get_string()));
    else if (value.type() == kMatrix)
      attributes.matrices.emplace_back(name, glm::make_mat4(static_cast<const float*>(value.data())));
  }
  return attributes;
}

Display displayOf(const OIIO::ImageSpec& spec) {
  Display display{.origin = {spec.full_x, spec.full_y}};
  if (const float aspect = spec.get_float_attribute("PixelAspectRatio", 1);
      std::isfinite(aspect) && aspect > 0)
    display.pixel_aspect = aspect;
  return display;
}

/// Where in the whole picture pixel (0,0) of its data lies.
glm::ivec2 cropOrigin(const OIIO::ImageSpec& spec) { return {spec.x - spec.full_x, spec.y - spec.full_y}; }

PicturePart partOf(const OIIO::ImageSpec& spec) {
  PicturePart part{.name = spec.get_string_attribute("oiio:subimagename"),
                   .size = {spec.width, spec.height},
                   .picture_size = {spec.full_width, spec.full_height},
                   .crop_origin = cropOrigin(spec),
                   .display = displayOf(spec),
                   .channels = spec.channelnames,
                   .types = {},
                   .compression = spec.get_string_attribute("compression"),
                   .attributes = attributesOf(spec),
                   .is_deep = spec.deep};
  for (int channel = 0; channel < spec.nchannels; ++channel)
    part.types.emplace_back(spec.channelformat(channel).c_str());
  return part;
}

}  // namespace

Image readImage(const std::string& path) {
  const auto input = openPicture(path, path);
  const OIIO::ImageSpec spec = input->spec();
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.channelnames;
  image.picture_size = {spec.full_width, spec.full_height};
  image.crop_origin = cropOrigin(spec);
  image.display = displayOf(spec);
  const std::size_t channels = image.channels.size();
  // Integer files are read as 16-bit codes first, which lie beside the floats.
  requireMemory(double(spec.width) * spec.height * channels * (sizeof(float) + sizeof(std::uint16_t)), path);
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

std::vector<PicturePart> readParts(const std::string& path) {
  const auto input = openPicture(path, path);
  const bool is_exr = std::string(input->format_name()) == "openexr";
  std::vector<PicturePart> parts;
  do {
    const OIIO::ImageSpec spec = input->spec();
    parts.push_back(partOf(spec));
    if (!is_exr || spec.deep || spec.tile_width > 0) continue;
    checkRow(*input, path, spec.y);
    checkRow(*input, path, spec.y + spec.height - 1);
  } while (is_exr && input->seek_subimage(int(parts.size()), 0));
  return parts;
}

std::string readAttribute(const std::string& path, const std::string& name) {
  return openPicture(path, path)->spec().get_string_attribute(name);
}

std::unique_ptr<RowFile> openPictureFile(const std::string& path, int width, int height,
                                         const std::vector<std::string>& channels, const FileFormat& format,
                                         const Metadata& metadata, const WriteOptions& options) {
  return std::make_unique<PictureFile>(path, format.extension,
                                       makeSpec(width, height, channels, format, metadata, options));
}

}  // namespace luciole
