#include "render/dilate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace luciole {

void dilate(Image& image, std::vector<std::uint8_t> shows, int times) {
  const std::size_t channels = image.channels.size(), width = std::size_t(image.width);
  std::vector<std::uint8_t> after = shows;
  std::atomic<bool> grows = true;
  for (int time = 0; time < times && grows; ++time) {
    grows = false;
    tbb::parallel_for(0, image.height, [&](int y) {
      std::vector<double> sum(channels);
      for (int x = 0; x < image.width; ++x) {
        if (shows[std::size_t(y) * width + std::size_t(x)]) continue;
        std::fill(sum.begin(), sum.end(), 0.0);
        int count = 0;
        for (int near_y = std::max(y - 1, 0); near_y <= std::min(y + 1, image.height - 1); ++near_y)
          for (int near_x = std::max(x - 1, 0); near_x <= std::min(x + 1, image.width - 1); ++near_x) {
            const std::size_t pixel = std::size_t(near_y) * width + std::size_t(near_x);
            if (!shows[pixel]) continue;
            ++count;
            for (std::size_t c = 0; c < channels; ++c) sum[c] += image.pixels[pixel * channels + c];
          }
        if (count == 0) continue;
        const std::size_t pixel = std::size_t(y) * width + std::size_t(x);
        for (std::size_t c = 0; c < channels; ++c) image.pixels[pixel * channels + c] = float(sum[c] / count);
        after[pixel] = 1;
        grows = true;
      }
    });
    shows = after;
  }
}

}  // namespace luciole
