#pragma once

#include <chrono>
#include <luciole/array_memory.hpp>
#include <luciole/render.hpp>
#include <string>
#include <utility>
#include <vector>

namespace luciole::python {

/// A picture whose pixels Python's arrays show: rows of interleaved channels in memory of huge pages, which
/// takes less time to get than the picture's own.
struct PictureHandle {
  int width = 0, height = 0;
  std::vector<std::string> channels = {};
  RawArray<float> pixels = {};
  Stats stats = {};
  double ended = 0;  ///< see statsJson()

  PictureHandle() = default;
  explicit PictureHandle(const Image& image) { append(image, image.height); }
  explicit PictureHandle(Picture picture) : PictureHandle(picture.image) { stats = std::move(picture.stats); }

  /// Takes the next rows, of so many in all.
  void append(const Image& rows, int all) {
    if (height == 0) {
      width = rows.width;
      channels = rows.channels;
      pixels.reserve(std::size_t(all) * std::size_t(width) * channels.size());
    }
    height += rows.height;
    pixels.insert(pixels.end(), rows.pixels.begin(), rows.pixels.end());
  }

  void tookSince(std::chrono::steady_clock::time_point start) {
    ended = stats.began +
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
};

}  // namespace luciole::python
