#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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

template <class Code>
constexpr float kLargestCode = float(std::numeric_limits<Code>::max());

template <class Code>
Code colorCode(float value, float threshold) {
  return Code(encodeSrgb(value) * kLargestCode<Code> + threshold);
}
template <class Code>
Code alphaCode(float value) {
  return Code((value > 0.0f ? std::min(value, 1.0f) : 0.0f) * kLargestCode<Code> + kHalfUp);
}

/// A colour that was multiplied by alpha; black where nothing is left of it.
float divided(float color, float alpha) { return alpha > 0.0f ? color / alpha : 0.0f; }

/// The values of a picture's rows that its file takes, converted by `convert(pixel, channel, x, y)`.
template <class T, class Convert>
std::vector<T> convertRows(const Image& rows, const std::vector<int>& sources, Convert convert) {
  std::vector<T> values(std::size_t(rows.width) * rows.height * sources.size());
  const std::size_t channels = rows.channels.size();
  tbb::parallel_for(0, rows.height, [&](int y) {
    const float* in = rows.pixels.data() + std::size_t(y) * rows.width * channels;
    T* out = values.data() + std::size_t(y) * rows.width * sources.size();
    for (int x = 0; x < rows.width; ++x, in += channels)
      for (std::size_t c = 0; c < sources.size(); ++c) *out++ = convert(in, c, x, y);
  });
  return values;
}

/// Limits the magnitude of colours; NaN stays. Returns how many pixels had a larger one.
std::uint64_t limitColors(const std::vector<std::string>& channels, float largest,
                          std::vector<float>& pixels) {
  std::vector<std::size_t> colors;
  for (std::size_t c = 0; c < channels.size(); ++c)
    if (isColorChannel(channels[c])) colors.push_back(c);
  std::uint64_t limited = 0;
  for (std::size_t pixel = 0; pixel < pixels.size(); pixel += channels.size()) {
    bool is_beyond = false;
    for (const std::size_t c : colors) {
      float& value = pixels[pixel + c];
      if (!(std::abs(value) > largest)) continue;
      value = std::copysign(largest, value);
      is_beyond = true;
    }
    limited += is_beyond;
  }
  return limited;
}

}  // namespace

struct ImageWriter::State {
  FileFormat format;
  std::vector<int> sources;  ///< which channels the file takes; all where it takes any
  WriteOptions options;
  glm::ivec2 place;           ///< of the next row's first pixel in the whole picture
  std::uint64_t limited = 0;  ///< pixels with a colour beyond largestColor()
  std::unique_ptr<RowFile> file = nullptr;

  /// Writes R, G, B and perhaps A as integers.
  template <class Code>
  void writeCodes(const Image& rows) {
    const bool dither = options.dither && format.bits == 8;
    const bool divide = options.alpha && sources.size() == 4;
    const auto code = [&](const float* pixel, std::size_t channel, int x, int y) {
      const float value = pixel[sources[channel]];
      if (channel == 3) return alphaCode<Code>(value);
      const glm::ivec2 at = place + glm::ivec2(x, y);
      const float color = divide ? divided(value, pixel[sources[3]]) : value;
      return colorCode<Code>(options.tone == ToneCurve::kFilmic ? filmicTone(color) : color,
                             dither ? ditherThreshold(at.x, at.y) : kHalfUp);
    };
    file->write(convertRows<Code>(rows, sources, code).data(), rows.height);
  }
};

ImageWriter::ImageWriter(const std::string& path, int width, int height,
                         const std::vector<std::string>& channels, const Metadata& metadata,
                         const WriteOptions& options)
    : state_(new State{
          options.film ? kFilmFrame : pictureFormat(path, options), {}, options, options.crop_origin}) {
  const FileFormat& format = state_->format;
  std::vector<std::string> names = channels;
  if (format.max_channels <= 4) {
    state_->sources = colorChannels(channels, format, path);
    names = {"R", "G", "B", "A"};
    names.resize(state_->sources.size());
  }
  state_->file = options.film ? options.film->addFrame()
                 : format.extension == "png"
                     ? openPngFile(path, width, height, int(names.size()), metadata, format.bits)
                     : openPictureFile(path, width, height, names, format, metadata, options);
}

ImageWriter::~ImageWriter() = default;

void ImageWriter::write(const Image& rows) {
  State& state = *state_;
  const float largest = largestColor(state.options);
  if (state.sources.empty() && std::isfinite(largest)) {
    std::vector<float> pixels = rows.pixels;
    state.limited += limitColors(rows.channels, largest, pixels);
    state.file->write(pixels.data(), rows.height);
  } else if (state.sources.empty()) {
    state.file->write(rows.pixels.data(), rows.height);
  } else if (state.format.is_float) {
    const auto same = [&](const float* pixel, std::size_t c, int, int) { return pixel[state.sources[c]]; };
    state.file->write(convertRows<float>(rows, state.sources, same).data(), rows.height);
  } else if (state.format.bits == 16) {
    state.writeCodes<std::uint16_t>(rows);
  } else {
    state.writeCodes<std::uint8_t>(rows);
  }
  state.place.y += rows.height;
}

std::uint64_t ImageWriter::close() {
  state_->file->close();
  return state_->limited;
}

std::uint64_t writeImage(const Image& image, const std::string& path, const Metadata& metadata,
                         const WriteOptions& options) {
  ImageWriter writer(path, image.width, image.height, image.channels, metadata, options);
  writer.write(image);
  return writer.close();
}

}  // namespace luciole
