#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"
#include "raster/rasterize.hpp"
#include "render/features.hpp"
#include "render/stats.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Extra layers of an EXR.
enum class Aov : std::uint8_t {
  kPosition,
  kNormal,
  kDepth,
  kDiffuse,
  kMaterial,
  kLightCount,  ///< lights in range of the pixel
  kListLength,  ///< lights that its square has in its list, all of them where there are no lists; where
                ///< squares begin depends on the band and the crop
  kShadow
};

struct RenderSettings {
  glm::ivec2 size{1280, 720};
  Camera camera;
  std::optional<Crop> crop;
  int samples = 1;  ///< per pixel, at the points of a Hammersley set
  Shading shading = Shading::kPhong;
  ShadeSettings shade;
  std::vector<Aov> aovs;  ///< of the first sample
  float exposure = 0;     ///< stops: colours are multiplied by 2^exposure
  /// Also count, for the statistics, the lights that every pixel goes through and those in its range.
  bool count_lights = false;
  /// Rows that are rendered at a time; 0: as bandHeight() says. The picture is the same.
  int band_height = 0;
  std::function<void(int done, int passes)> on_pass;  ///< called after each sample of each band, if set
};

/// Fills in what the statistics say of the scene.
void describeScene(const Scene& scene, const FeatureSet& features, Stats& stats);

/// Takes the next rows of a picture, from the top down.
using RowSink = std::function<void(const Image& rows)>;

/// Rasterizes, draws shadow maps, culls and shades: the whole way from a scene to its picture (channels R G
/// B, then the layers), band by band. Fills in the statistics. Throws InputError for a crop outside the
/// picture, MachineError, and what `take` throws.
void renderBands(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take,
                 Stats& stats);

/// The same as one picture.
Image renderScene(Device& device, const Scene& scene, const RenderSettings& settings, Stats& stats);

/// The first half of it: the G-buffer with every group. For Shading::kGouraud, whose vertices are lit,
/// `device` is needed; otherwise it may be null.
GBuffer rasterizeScene(Device* device, const Scene& scene, const RenderSettings& settings, Stats& stats);

/// The second half: lights a G-buffer by the scene's lights, ambient and fog, with shadows cast by its
/// objects. Of the settings, `shade`, `aovs`, `exposure` and `count_lights` count.
Image shadeGBuffer(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings,
                   Stats& stats);

}  // namespace luciole
