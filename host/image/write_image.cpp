#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/error.hpp"
#include "image/dither.hpp"
#include "image/file_format.hpp"
#include "image/film.hpp"
#include "image/image.hpp"
#include "image/row_file.hpp"
#include "image/srgb.hpp"

namespace luciole {
namespace {

int channelIndex(const std::vector<std::string>& channels, const std::string& name) {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : int(found - channels.begin());
}

/// The channels a format of few channels takes: R G B, and A where it fits; Y alone is spread over R G B.
std::vector<int> colorChannels(const std::vector<std::string>& channels, const FileFormat& format,
                               const std::string& path) {
  std::vector<int> colors;
  for (const char* name : {"R", "G", "B"}) colors.push_back(channelIndex(channels, name));
  if (channels.size() <= 2 && channelIndex(channels, "Y") >= 0) colors.assign(3, channelIndex(channels, "Y"));
  if (std::count(colors.begin(), colors.end(), -1) > 0) {
    throw InputError(fmt::format("{}: .{} holds R G B and the picture has no such channels, expected .exr",
                                 path, format.extension));
  }
  const int alpha = channelIndex(channels, "A");
  if (format.max_channels >= 4 && alpha >= 0) colors.push_back(alpha);
  return colors;
}

const FileFormat kFilmFrame{"", false, 3};

constexpr float kHalfUp = 0.5f;  ///< rounds to nearest

std::uint8_t colorByte(float value, float threshold) {
  return std::uint8_t(encodeSrgb(value) * 255.0f + threshold);
}
std::uint8_t alphaByte(float value) {
  return std::uint8_t((value > 0.0f ? std::min(value, 1.0f) : 0.0f) * 255.0f + kHalfUp);
}

/// The values of a picture's rows that its file takes, converted by `convert(value, channel, x, y)`.
template <class T, class Convert>
std::vector<T> convertRows(const Image& rows, const std::vector<int>& sources, Convert convert) {
  std::vector<T> values(std::size_t(rows.width) * rows.height * sources.size());
  const std::size_t channels = rows.channels.size();
  tbb::parallel_for(0, rows.height, [&](int y) {
    const float* in = rows.pixels.data() + std::size_t(y) * rows.width * channels;
    T* out = values.data() + std::size_t(y) * rows.width * sources.size();
    for (int x = 0; x < rows.width; ++x, in += channels)
      for (std::size_t c = 0; c < sources.size(); ++c) *out++ = convert(in[sources[c]], c, x, y);
  });
  return values;
}

}  // namespace

struct ImageWriter::State {
  FileFormat format;
  std::vector<int> sources;  ///< which channels the file takes; all where it takes any
  bool dither;
  ToneCurve tone;
  glm::ivec2 place;  ///< of the next row's first pixel in the whole picture
  std::unique_ptr<RowFile> file;
};

ImageWriter::ImageWriter(const std::string& path, int width, int height,
                         const std::vector<std::string>& channels, const Metadata& metadata,
                         const WriteOptions& options)
    : state_(new State{options.film ? kFilmFrame : outputFormat(path, options.format),
                       {},
                       options.dither,
                       options.tone,
                       options.crop_origin,
                       nullptr}) {
  const FileFormat& format = state_->format;
  std::vector<std::string> names = channels;
  if (format.max_channels <= 4) {
    state_->sources = colorChannels(channels, format, path);
    names = {"R", "G", "B", "A"};
    names.resize(state_->sources.size());
  }
  state_->file = options.film ? options.film->addFrame()
                 : format.extension == "png"
                     ? openPngFile(path, width, height, int(names.size()), metadata)
                     : openPictureFile(path, width, height, names, format, metadata, options);
}

ImageWriter::~ImageWriter() = default;

void ImageWriter::write(const Image& rows) {
  if (state_->sources.empty()) {
    state_->file->write(rows.pixels.data(), rows.height);
  } else if (state_->format.is_float) {
    const auto same = [](float value, std::size_t, int, int) { return value; };
    state_->file->write(convertRows<float>(rows, state_->sources, same).data(), rows.height);
  } else {
    const auto byte = [&](float value, std::size_t channel, int x, int y) {
      if (channel == 3) return alphaByte(value);
      const glm::ivec2 pixel = state_->place + glm::ivec2(x, y);
      const float shown = state_->tone == ToneCurve::kFilmic ? filmicTone(value) : value;
      return colorByte(shown, state_->dither ? ditherThreshold(pixel.x, pixel.y) : kHalfUp);
    };
    state_->file->write(convertRows<std::uint8_t>(rows, state_->sources, byte).data(), rows.height);
  }
  state_->place.y += rows.height;
}

void ImageWriter::close() { state_->file->close(); }

void writeImage(const Image& image, const std::string& path, const Metadata& metadata,
                const WriteOptions& options) {
  ImageWriter writer(path, image.width, image.height, image.channels, metadata, options);
  writer.write(image);
  writer.close();
}

}  // namespace luciole
