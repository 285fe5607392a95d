#include <utility>

#include "lighting/count_picture.hpp"
#include "render/assemble.hpp"
#include "render/light_points.hpp"
#include "render/screens.hpp"
#include "render/sky_background.hpp"

namespace luciole {
namespace {

/// Lists a G-buffer as it is.
struct GivenLister final : PointLister {
  ReadyPicture& picture;
  const GBuffer& given;
  Image image;

  GivenLister(ReadyPicture& ready, const GBuffer& points) : picture(ready), given(points) {}

  bool next() override {
    if (gbuffer) return false;
    gbuffer = &given;
    counts = wantedCounts(picture.settings, 0);
    return true;
  }

  /// Lets the environment be seen where no surface is, if it is these lights' background.
  void addBackground(const LightSet& lights, LitPlanes& lit) const {
    if (lights.sky)
      timed(picture.stats, Stage::kResolve,
            [&] { addSky(skyPlane(*lights.sky, picture.plan.view, given), given, lit.color); });
  }

  void take(LitPlanes lit) override {
    countPass(given, lit, counts.evaluated, picture.plan.shade.light_error_floor, picture.stats);
    addBackground(picture.lighting.lights, lit);
    ScreenedColors screened;
    if (!picture.plan.screens.empty())
      screened = timed(picture.stats, Stage::kScreens, [&] {
        return applyScreens(picture, given, lit.color, {{0, 0}, {given.width, given.height}});
      });
    timed(picture.stats, Stage::kResolve, [&] {
      image = startPicture(given, lit, picture.settings, layerNames(picture));
      PixelSums sums{std::move(lit.color), {}, {}, std::move(lit.light_error), std::move(lit.half_width)};
      if (countsCovered(picture.settings)) countCovered(given, sums.covered);
      setColors(given, sums, picture.settings, image);
      if (!screened.color.empty()) setScreenedColors(screened, 1, image);
    });
  }

  void takeLayer(std::size_t layer, LitPlanes lit) override {
    addBackground(picture.layers[layer].lights, lit);
    timed(picture.stats, Stage::kResolve, [&] {
      const PixelSums sums{std::move(lit.color), {}, {}, std::move(lit.light_error), {}};
      setLightLayer(given, sums, picture.settings, picture.layers[layer].layer,
                    channelOfLayer(picture, image, layer), image);
    });
  }
};

}  // namespace

Image lightGivenPoints(ReadyPicture& picture, const GBuffer& gbuffer) {
  GivenLister lister(picture, gbuffer);
  lightPoints(picture, picture.plan.pixels, lister);
  return std::move(lister.image);
}

}  // namespace luciole
