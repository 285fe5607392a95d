#include "image/float_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string_view>
#include <vector>

#include "base/machine_memory.hpp"
#include "base/output_file.hpp"
#include "base/picture_size.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr std::string_view kNpyMagic("\x93NUMPY", 6);

/// NumPy wants the whole header to be a multiple of 64 bytes.
std::string npyHeader(int width, int height, int channels) {
  std::string dictionary = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                                       height, width, channels);
  const std::size_t before = kNpyMagic.size() + 4;
  dictionary.append(63 - (before + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  const auto length = dictionary.size();
  return std::string(kNpyMagic) + '\1' + '\0' + char(length & 0xff) + char(length >> 8) + dictionary;
}

class FloatFile : public RowFile {
 public:
  FloatFile(const std::string& path, int width, int height, int channels, bool is_pfm)
      : height_(height),
        row_bytes_(std::size_t(width) * std::size_t(channels) * sizeof(float)),
        is_pfm_(is_pfm),
        file_(path),
        header_(is_pfm ? fmt::format("PF\n{} {}\n-1.0\n", width, height)
                       : npyHeader(width, height, channels)) {
    file_.writeAt(0, std::as_bytes(std::span(header_)));
  }

  void write(const void* values, int rows) override {
    const std::span all(static_cast<const std::byte*>(values), row_bytes_ * std::size_t(rows));
    if (!is_pfm_) {
      file_.writeAt(header_.size() + row_bytes_ * std::size_t(done_), all);
    } else {
      // One piece, turned upside down.
      const int lowest = height_ - done_ - rows;
      std::vector<std::byte> turned(all.size());
      for (int y = 0; y < rows; ++y)
        std::copy_n(all.begin() + std::ptrdiff_t(row_bytes_ * std::size_t(y)), row_bytes_,
                    turned.begin() + std::ptrdiff_t(row_bytes_ * std::size_t(rows - 1 - y)));
      if (file_.isStream()) {
        waiting_.resize(row_bytes_ * std::size_t(height_));
        std::copy(turned.begin(), turned.end(),
                  waiting_.begin() + std::ptrdiff_t(row_bytes_ * std::size_t(lowest)));
      } else {
        file_.writeAt(header_.size() + row_bytes_ * std::size_t(lowest), turned);
      }
    }
    done_ += rows;
  }

  void close() override {
    if (!waiting_.empty()) file_.writeAt(header_.size(), waiting_);
    file_.putInPlace();
  }

 private:
  int height_;
  std::size_t row_bytes_;
  bool is_pfm_;
  OutputFile file_;
  std::string header_;
  int done_ = 0;                    ///< rows
  std::vector<std::byte> waiting_;  ///< a PFM's rows, for a stream
};

/// What follows a key of a .npy header's dictionary, up to a character that ends it; empty where there is no
/// such key.
std::string_view npyValue(std::string_view dictionary, std::string_view key, std::string_view ends) {
  const std::size_t at = dictionary.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = dictionary.substr(at + key.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(": "), rest.size()));
  return rest.substr(0, rest.find_first_of(ends));
}

/// The numbers of "(480, 640, 3" or "(480, 640"; empty where they aren't up to three.
std::vector<std::int64_t> npyShape(std::string_view text) {
  std::vector<std::int64_t> shape;
  const char *at = text.data(), *end = at + text.size();
  while (at != end) {
    if (*at == '(' || *at == ',' || *at == ' ') {
      ++at;
      continue;
    }
    std::int64_t number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || shape.size() == 3) return {};
    shape.push_back(number);
    at = next;
  }
  return shape;
}

}  // namespace

std::unique_ptr<RowFile> openFloatFile(const std::string& path, int width, int height, int channels,
                                       const FileFormat& format) {
  checkWritable(path, {.format = format.extension});
  checkSizeLimit(std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels) * sizeof(float),
                 path);
  return std::make_unique<FloatFile>(path, width, height, channels, format.extension == "pfm");
}

std::optional<Image> readNpy(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::int64_t length = file ? std::int64_t(file.tellg()) : 0;
  file.seekg(0);
  std::array<unsigned char, 12> start{};
  file.read(reinterpret_cast<char*>(start.data()), 10);
  if (!file || !std::equal(kNpyMagic.begin(), kNpyMagic.end(), reinterpret_cast<const char*>(start.data())))
    return {};
  const auto refuse = [&](const std::string& what) { throw InputError(path + ": " + what); };
  std::uint32_t header = start[8] | std::uint32_t(start[9]) << 8;
  if (start[6] > 1) {
    file.read(reinterpret_cast<char*>(start.data() + 10), 2);
    header |= std::uint32_t(start[10]) << 16 | std::uint32_t(start[11]) << 24;
  }
  if (!file || header > length) refuse("ends inside its header");
  std::string dictionary(header, ' ');
  file.read(dictionary.data(), std::streamsize(header));
  if (!file) refuse("ends inside its header");

  const std::string_view type = npyValue(dictionary, "'descr'", ",}"),
                         fortran = npyValue(dictionary, "'fortran_order'", ",}");
  if (type != "'<f4'" && type != "'<f8'")
    refuse(fmt::format("an array of {}, expected '<f4' or '<f8'", forMessage(type)));
  if (fortran != "False") refuse("an array in Fortran's order, expected C's");
  const std::string_view shape_text = npyValue(dictionary, "'shape'", ")}");
  const std::vector<std::int64_t> shape = npyShape(shape_text);
  const std::int64_t channels = shape.size() == 3 ? shape[2] : 1;
  if (shape.size() < 2 || (channels != 1 && channels != 3 && channels != 4))
    refuse(fmt::format("an array of shape {}), expected (height, width) or (height, width, 1, 3 or 4)",
                       forMessage(shape_text)));
  for (const std::int64_t side : {shape[0], shape[1]})
    if (side < 1 || side > kLargestSide)
      refuse(fmt::format("{} pixels a side, expected 1 to {}", side, kLargestSide));
  const std::int64_t values = shape[0] * shape[1] * channels, of_value = type == "'<f4'" ? 4 : 8;
  if (values * of_value != length - std::int64_t(file.tellg()))
    refuse(fmt::format("{} bytes of values, expected {} by its shape", length - std::int64_t(file.tellg()),
                       values * of_value));

  Image image{int(shape[1]), int(shape[0]), {"R", "G", "B", "A"}, {}};
  if (channels == 1)
    image.channels = {"Y"};
  else
    image.channels.resize(std::size_t(channels));
  image.picture_size = {image.width, image.height};
  requireMemory(double(values) * double(sizeof(float)), path);
  image.pixels.resize(std::size_t(values));
  if (of_value == 4) {
    file.read(reinterpret_cast<char*>(image.pixels.data()), values * of_value);
  } else {
    std::vector<double> row(std::size_t(shape[1] * channels));
    for (std::size_t first = 0; first < image.pixels.size(); first += row.size()) {
      file.read(reinterpret_cast<char*>(row.data()), std::streamsize(row.size() * sizeof(double)));
      std::transform(row.begin(), row.end(), image.pixels.begin() + std::ptrdiff_t(first),
                     [](double value) { return float(value); });
    }
  }
  if (!file) refuse("can't be read to its end");
  return image;
}

}  // namespace luciole
