#include "tools/figures/truth.hpp"

#include "luciole/compare.hpp"
#include "reference/reference_picture.hpp"

namespace luciole {
namespace {

/// Samples a pixel in each of the two sets.
constexpr int kSamples[2] = {32, 48};

}  // namespace

Truth sampledTruth(const Scene& scene, const View& view, const ReferenceSettings& settings) {
  const std::vector<glm::ivec2> pixels = allPixels(view.crop_size);
  Image sets[2], mean{view.crop_size.x, view.crop_size.y, {"R", "G", "B"}, {}};
  for (int set = 0; set < 2; ++set) {
    ReferenceSettings of_set = settings;
    if (settings.on_progress)
      of_set.on_progress = [&](std::size_t done, std::size_t count) {
        settings.on_progress(set * count + done, 2 * count);
      };
    sets[set] = mean;
    for (const glm::dvec3& color :
         referencePicture(scene, view, Shading::kPhong, kSamples[set], pixels, of_set))
      for (int c = 0; c < 3; ++c) sets[set].pixels.push_back(pictureValue(color[c]));
  }
  const float share = float(kSamples[0]) / float(kSamples[0] + kSamples[1]);
  for (std::size_t i = 0; i < sets[0].pixels.size(); ++i)
    mean.pixels.push_back(share * sets[0].pixels[i] + (1 - share) * sets[1].pixels[i]);
  return {mean, compareImages(sets[0], sets[1]).mean_abs / 2};
}

}  // namespace luciole
