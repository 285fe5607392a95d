#include <tbb/parallel_for.h>

#include <optional>
#include <utility>

#include "base/trace.hpp"
#include "lighting/count_picture.hpp"
#include "render/assemble.hpp"
#include "render/change_surfaces.hpp"
#include "render/light_points.hpp"
#include "render/screens.hpp"
#include "render/sky_background.hpp"

namespace luciole {
namespace {

/// Adds `more` to `sum`, count floats; an empty `sum` becomes `more`. Returns a plane whose memory can be
/// reused.
template <class Values>
Values addPlane(Values more, std::size_t count, Values& sum) {
  if (sum.empty()) {
    sum = std::move(more);
    return {};
  }
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) { sum[i] += more[i]; });
  return more;
}

/// Lists a band's pixels once for each sample.
struct SampleLister final : PointLister {
  ReadyPicture& picture;
  PixelRectangle inner;  ///< the pixels wanted of the view's
  View view;
  RasterCounts& triangles;
  const std::function<void()>& on_sample;
  int sample = -1;
  GBuffer drawn;
  PixelSums sums;
  std::vector<PixelSums> layer_sums;  ///< colours and bounds alone
  ScreenedColors screened;            ///< with screens only
  Plane sky;                          ///< skyPlane(), with an environment only
  Image image;
  std::optional<TraceSpan> span;

  SampleLister(ReadyPicture& ready, const View& band, RasterCounts& counted,
               const std::function<void()>& report)
      : picture(ready), view(withMargin(band, ready.plan)), triangles(counted), on_sample(report) {
    const glm::ivec2 first = band.crop_origin - view.crop_origin;
    inner = {first, first + band.crop_size};
    layer_sums.resize(picture.layers.size());
    recycled = std::move(picture.recycled.color);
  }

  int samples() const { return picture.settings.samples; }
  bool isLast() const { return sample + 1 == samples(); }

  bool next() override {
    span.reset();
    if (sample >= 0) {
      picture.recycled.gbuffer = std::move(drawn);
      on_sample();
    }
    if (++sample == samples()) return false;
    span.emplace("sample", std::initializer_list<TraceArgument>{{"sample", sample}, {"samples", samples()}});
    takeSample(view, {sample, samples()});
    drawn = timed(picture.stats, Stage::kRasterize, [&] {
      return rasterize(picture.scene, picture.objects, view, picture.settings.shading, picture.plan.planes,
                       picture.vertex_colors, &triangles, std::move(picture.recycled.gbuffer),
                       &picture.recycled.geometry);
    });
    drawn.camera = picture.settings.camera;
    if (picture.settings.shading != Shading::kGouraud) changeSurfaces(picture, drawn);
    gbuffer = &drawn;
    counts = wantedCounts(picture.settings, sample);
    return true;
  }

  /// Lets the environment be seen where no surface is, if it is these lights' background.
  void addBackground(const LightSet& lights, LitPlanes& lit) {
    if (!lights.sky) return;
    timed(picture.stats, Stage::kResolve, [&] {
      if (sky.empty())
        sky = samples() == 1 ? skyPlane(*lights.sky, view, drawn)
                             : skyPlane(*lights.sky, view, drawn, [](std::size_t) { return true; });
      addSky(sky, drawn, lit.color);
    });
  }

  void take(LitPlanes lit) override {
    countPass(drawn, lit, counts.evaluated, picture.plan.shade.light_error_floor, picture.stats);
    addBackground(picture.lighting.lights, lit);
    if (!picture.plan.screens.empty()) takeScreened(lit.color);
    timed(picture.stats, Stage::kResolve, [&] {
      if (sample == 0)
        image = startPicture(drawn, lit, picture.settings, layerNames(picture),
                             std::move(picture.recycled.picture));
      const std::size_t bounds = lit.light_error.size(), widths = lit.half_width.size();
      addPlane(std::move(lit.light_error), bounds, sums.light_error);
      addPlane(std::move(lit.half_width), widths, sums.half_width);
      recycled = addPlane(std::move(lit.color), 3 * drawn.pixels(), sums.color);
      if (countsCovered(picture.settings)) countCovered(drawn, sums.covered);
      if (!isLast()) return;
      setColors(drawn, sums, picture.settings, image);
      if (!screened.color.empty()) setScreenedColors(screened, samples(), image);
    });
  }

  /// Adds what the screens make of a sample.
  void takeScreened(const Plane& color) {
    ScreenedColors of_sample =
        timed(picture.stats, Stage::kScreens, [&] { return applyScreens(picture, drawn, color, inner); });
    screened.frame = of_sample.frame;
    const std::size_t count = of_sample.color.size();
    picture.recycled.screens.before = addPlane(std::move(of_sample.color), count, screened.color);
  }

  void takeLayer(std::size_t layer, LitPlanes lit) override {
    addBackground(picture.layers[layer].lights, lit);
    timed(picture.stats, Stage::kResolve, [&] {
      PixelSums& sum = layer_sums[layer];
      const std::size_t bounds = lit.light_error.size();
      addPlane(std::move(lit.light_error), bounds, sum.light_error);
      recycled = addPlane(std::move(lit.color), 3 * drawn.pixels(), sum.color);
      if (!isLast()) return;
      setLightLayer(drawn, sum, picture.settings, picture.layers[layer].layer,
                    channelOfLayer(picture, image, layer), image);
      recycled = std::move(sum.color);
    });
  }
};

}  // namespace

Image lightAllSamples(ReadyPicture& picture, const View& band, RasterCounts& triangles,
                      const std::function<void()>& on_sample) {
  SampleLister lister(picture, band, triangles, on_sample);
  lightPoints(picture, picture.plan.pixels, lister);
  picture.recycled.color = std::move(lister.sums.color);
  return cutOut(std::move(lister.image), lister.inner.first, band.crop_size);
}

}  // namespace luciole
