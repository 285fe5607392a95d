#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "image/dither.hpp"
#include "image/file_format.hpp"
#include "image/film.hpp"
#include "image/float_file.hpp"
#include "image/row_file.hpp"
#include "image/srgb_codes.hpp"
#include "image/tone.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"

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

/// A picture is converted and written in pieces of rows: their values take no memory as large as the picture,
/// and are still in a cache when they are compressed.
constexpr std::size_t kPieceBytes = std::size_t(4) << 20;

/// Writes a picture's rows, as values of which a pixel has `channels`. `convert(pixels, y, values)` makes
/// those of a row from its pixels with all channels.
template <class T, class Convert>
void writeRows(const Image& rows, std::size_t channels, Convert convert, RowFile& file) {
  const std::size_t row_values = rows.width * channels, row_pixels = rows.width * rows.channels.size();
  const std::size_t row_bytes = std::max<std::size_t>(row_values * sizeof(T), 1);
  const int most = int(std::max<std::size_t>(kPieceBytes / row_bytes, 1));
  const auto values = std::make_unique_for_overwrite<T[]>(row_values * std::min(most, rows.height));
  for (int first = 0; first < rows.height; first += most) {
    const int count = std::min(most, rows.height - first);
    tbb::parallel_for(0, count, [&](int i) {
      convert(rows.pixels.data() + std::size_t(first + i) * row_pixels, first + i,
              values.get() + i * row_values);
    });
    file.write(values.get(), count);
  }
}

/// Of pixels of `channels` the channels `sources`.
void takeChannels(const float* pixels, std::size_t channels, const std::vector<int>& sources, int count,
                  float* values) {
  if (channels == 3 && sources == std::vector{0, 1, 2}) {
    std::copy_n(pixels, 3 * count, values);
    return;
  }
  for (int i = 0; i < count; ++i, pixels += channels)
    for (const int source : sources) *values++ = pixels[source];
}

/// Limits the magnitude of the channels `colors`; NaN stays. Returns how many pixels had a larger one.
std::uint64_t limitColors(const std::vector<std::size_t>& colors, float largest, std::size_t channels,
                          std::span<float> pixels) {
  std::uint64_t limited = 0;
  for (std::size_t pixel = 0; pixel < pixels.size(); pixel += channels) {
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
  glm::ivec2 place;                        ///< of the next row's first pixel in the whole picture
  std::atomic<std::uint64_t> limited = 0;  ///< pixels with a colour beyond largestColor()
  std::unique_ptr<RowFile> file = nullptr;

  /// Writes all channels, the colours limited.
  void writeLimited(const Image& rows, float largest) {
    const std::size_t channels = rows.channels.size();
    std::vector<std::size_t> colors;
    for (std::size_t c = 0; c < channels; ++c)
      if (isColorChannel(rows.channels[c])) colors.push_back(c);
    const auto limit = [&](const float* pixels, int, float* values) {
      const std::size_t count = rows.width * channels;
      std::copy_n(pixels, count, values);
      limited += limitColors(colors, largest, channels, {values, count});
    };
    writeRows<float>(rows, channels, limit, *file);
  }

  /// Writes R, G, B and perhaps A as integers.
  template <class Code>
  void writeCodes(const Image& rows) {
    const std::size_t from_channels = rows.channels.size(), to_channels = sources.size();
    const auto convert = [&](const float* pixels, int y, Code* codes) {
      for (int x = 0; x < rows.width; x += kRun)
        encode(pixels + x * from_channels, from_channels, place + glm::ivec2(x, y),
               std::min(kRun, rows.width - x), codes + x * to_channels);
    };
    writeRows<Code>(rows, to_channels, convert, *file);
  }

 private:
  static constexpr int kRun = 256;  ///< pixels of a row whose values are in the fastest cache together

  /// The codes of up to kRun pixels of a row; `at`: the first one's place in the whole picture.
  template <class Code>
  void encode(const float* pixels, std::size_t from_channels, const glm::ivec2& at, int count,
              Code* codes) const {
    const int channels = int(sources.size());
    std::array<float, 4 * kRun> values, thresholds;
    takeChannels(pixels, from_channels, sources, count, values.data());
    if (options.alpha && channels == 4)
      for (int i = 0; i < 4 * count; ++i)
        if (i % 4 < 3) values[i] = divided(values[i], values[i | 3]);
    if (options.tone == ToneCurve::kFilmic)
      for (int i = 0; i < channels * count; ++i) values[i] = filmicTone(values[i]);
    thresholds.fill(kHalfUp);
    if (options.dither && format.bits == 8)
      for (int i = 0; i < count; ++i)
        std::fill_n(&thresholds[i * channels], 3, ditherThreshold(at.x + i, at.y));
    srgbCodes(values.data(), thresholds.data(), std::size_t(channels) * std::size_t(count), codes);
    if (channels == 4)
      for (int i = 0; i < count; ++i)
        codes[4 * i + 3] = alphaCode<Code>(pixels[i * from_channels + sources[3]]);
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
    state_->file = openPngFile(path, width, height, int(names.size()), metadata, format.bits,
                               options.compression, options.memory);
  else if (options.memory && format.extension == "jpg")
    state_->file = openJpegInMemory(width, height, *options.memory);
  else if (options.memory)
    throw InputError(path + ": in memory there are png and jpg alone");
  else if (format.extension == "exr")
    state_->file = openExrFile(path, width, height, names, metadata, options);
  else if (format.extension == "pfm" || format.extension == "npy")
    state_->file = openFloatFile(path, width, height, int(names.size()), format);
  else
    state_->file = openPictureFile(path, width, height, names, format, metadata, options);
}

ImageWriter::~ImageWriter() = default;

void ImageWriter::write(const Image& rows) {
  State& state = *state_;
  const float largest = largestColor(state.options);
  if (state.sources.empty() && std::isfinite(largest)) {
    state.writeLimited(rows, largest);
  } else if (state.sources.empty()) {
    state.file->write(rows.pixels.data(), rows.height);
  } else if (state.format.is_float) {
    const auto take = [&](const float* pixels, int, float* values) {
      takeChannels(pixels, rows.channels.size(), state.sources, rows.width, values);
    };
    writeRows<float>(rows, state.sources.size(), take, *state.file);
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
