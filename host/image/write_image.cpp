#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "base/error.hpp"
#include "image/dither.hpp"
#include "image/file_format.hpp"
#include "image/film.hpp"
#include "image/image.hpp"
#include "image/row_file.hpp"
#include "image/srgb_codes.hpp"

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
Code alphaCode(float value) {
  constexpr float kLargest = float(std::numeric_limits<Code>::max());
  return Code((value > 0.0f ? std::min(value, 1.0f) : 0.0f) * kLargest + kHalfUp);
}

/// A colour that was multiplied by alpha; black where nothing is left of it.
float divided(float color, float alpha) { return alpha > 0.0f ? color / alpha : 0.0f; }

/// The values of a picture's rows that its file takes. `convert(pixels, y, values)` makes those of a row from
/// its pixels with all channels.
template <class T, class Convert>
std::unique_ptr<T[]> convertRows(const Image& rows, std::size_t channels, Convert convert) {
  const std::size_t row_values = rows.width * channels;
  auto values = std::make_unique_for_overwrite<T[]>(row_values * rows.height);
  tbb::parallel_for(0, rows.height, [&](int y) {
    convert(rows.pixels.data() + std::size_t(y) * rows.width * rows.channels.size(), y,
            values.get() + y * row_values);
  });
  return values;
}

/// The channels `sources` of a row of pixels of `channels`.
void takeChannels(const float* pixels, std::size_t channels, const std::vector<int>& sources, int width,
                  float* values) {
  for (int x = 0; x < width; ++x, pixels += channels)
    for (const int source : sources) *values++ = pixels[source];
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
    const std::size_t channels = sources.size(), row_values = rows.width * channels;
    const bool dither = options.dither && format.bits == 8;
    const bool divide = options.alpha && channels == 4;
    const auto codes = convertRows<Code>(rows, channels, [&](const float* pixels, int y, Code* row) {
      std::vector<float> values(row_values), thresholds(row_values, kHalfUp);
      takeChannels(pixels, rows.channels.size(), sources, rows.width, values.data());
      if (divide)
        for (std::size_t i = 0; i < row_values; ++i)
          if (i % 4 < 3) values[i] = divided(values[i], values[i - i % 4 + 3]);
      if (options.tone == ToneCurve::kFilmic)
        for (float& value : values) value = filmicTone(value);
      if (dither)
        for (int x = 0; x < rows.width; ++x)
          std::fill_n(thresholds.begin() + x * channels, 3, ditherThreshold(place.x + x, place.y + y));
      srgbCodes(values.data(), thresholds.data(), row_values, row);
      if (channels == 4)
        for (int x = 0; x < rows.width; ++x)
          row[4 * x + 3] = alphaCode<Code>(pixels[x * rows.channels.size() + sources[3]]);
    });
    file->write(codes.get(), rows.height);
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
  if (options.film)
    state_->file = options.film->addFrame();
  else if (format.extension == "png")
    state_->file =
        openPngFile(path, width, height, int(names.size()), metadata, format.bits, options.compression);
  else if (format.extension == "exr")
    state_->file = openExrFile(path, width, height, names, metadata, options);
  else
    state_->file = openPictureFile(path, width, height, names, format, metadata, options);
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
    const auto take = [&](const float* pixels, int, float* values) {
      takeChannels(pixels, rows.channels.size(), state.sources, rows.width, values);
    };
    state.file->write(convertRows<float>(rows, state.sources.size(), take).get(), rows.height);
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
