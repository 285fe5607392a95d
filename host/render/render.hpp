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
#include "shadow/kept_shadows.hpp"

namespace luciole {

/// Extra layers of an EXR. aovTable() has a row for each, in this order.
enum class Aov : std::uint8_t {
  kPosition,
  kNormal,
  kDepth,
  kDiffuse,
  kMaterial,
  // The parts of the picture's light, whose sum is the picture, as light_layers.hpp tells.
  kAmbient,  ///< ambient light: the scene's, and the lights' own
  kDiffuseLight,
  kSpecularLight,
  kEmission,  ///< and the background
  kFog,       ///< the fog's own colour
  // What renderBands() alone knows, by surface_ids.hpp. Objects and materials are numbered as in the scene.
  kObjectId,        ///< -1 where nothing is seen
  kMaterialId,      ///< likewise
  kCryptoObject,    ///< Cryptomatte: which objects cover how much of the pixel's samples
  kCryptoMaterial,  ///< the same of materials
  kLightCount,      ///< lights in range of the pixel
  kListLength,  ///< lights in the list of the pixel's square, all lights if there are no lists. Squares are
                ///< counted from the band's first pixel, so it depends on the band and the crop
  kShadow,
  /// Bounds of the error, r g b, in the units of R G B, that lights that clusters stand for may make
  /// (ShadeSettings::light_error): the mean over the samples. With Shading::kGouraud the largest of any
  /// vertex.
  kLightError,
  kShadingCount,  ///< points that were shaded for all samples of the pixel
  kCount
};

/// What of a pixel's samples is shaded.
enum class SampleShading : std::uint8_t {
  kShared,  ///< a point for those that see the same surface (SharedSamples)
  kAll,     ///< each of them, at its own place
};

struct RenderSettings {
  glm::ivec2 size{1280, 720};
  Camera camera;
  std::optional<Crop> crop;
  int samples = 1;  ///< per pixel, at the points of a Hammersley set
  SampleShading sample_shading = SampleShading::kShared;
  Shading shading = Shading::kPhong;
  ShadeSettings shade;
  /// Layers. But for kLightError, kShadingCount, Cryptomattes and the parts of the light they show the first
  /// sample, or the point that is shaded for it.
  std::vector<Aov> aovs;
  /// Adds three channels for each group of lights that has any, and three for what no light gives: their sum
  /// is the picture. Neither these nor parts of the light go with ShadeSettings::light_error, which is
  /// ignored beside them, nor with Shading::kGouraud.
  bool light_groups = false;
  float exposure = 0;  ///< stops: colours are multiplied by 2^exposure
  /// Adds a channel A: the share of a pixel's samples that show a surface. The colours are then those of the
  /// surfaces alone, times A: what they lack is (1 − A) × 2^exposure × the scene's background. Objects that
  /// the fog hides are drawn too: they look like the scene's background, but hide any other.
  bool alpha = false;
  /// Also count, for the statistics, the lights that every pixel goes through and those in its range.
  bool count_lights = false;
  /// Rows that are rendered at a time, at most; 0: as bandHeight() says. The picture's colours don't depend
  /// on it, with a light error as long as it is a multiple of kBinSize.
  int band_height = 0;
  /// Called after each pass over a band, if set: how many rows are done, of how many, in all passes together.
  std::function<void(int done, int rows)> on_pass;
  /// Called once if set and a picture has waited a second for its kernels to be compiled.
  std::function<void()> on_long_compile;
};

/// Sets what the statistics say of the scene: triangles, lights, warnings, and the names of the features.
void describeScene(const Scene& scene, const FeatureSet& features, Stats& stats);

/// Takes the next rows of a picture, from the top down. `rows` lasts until it returns.
using RowSink = std::function<void(const Image& rows)>;

/// Makes a scene's picture (channels R G B, linear, A if asked for, then the layers) and hands it to `take`
/// band by band: rasterizes, draws shadow maps, culls and shades. Adds to the statistics. kept: for pictures
/// of one scene at several poses, one after another; they are the same bits as without it, sooner. Throws as
/// validate() does, InputError for a crop outside the picture, MachineError, and what `take` throws.
void renderBands(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take,
                 Stats& stats, KeptShadows* kept = nullptr);

/// The same, but returns the whole picture.
Image renderScene(Device& device, const Scene& scene, const RenderSettings& settings, Stats& stats);

/// The first half of renderScene(): the G-buffer with every group. `device` is needed for Shading::kGouraud,
/// which lights vertices; otherwise it may be null. Throws as validate() does, InputError for a crop outside
/// the picture, and MachineError.
GBuffer rasterizeScene(Device* device, const Scene& scene, const RenderSettings& settings, Stats& stats);

/// The second half: lights a G-buffer by the scene's lights, ambient light and fog, with shadows that the
/// scene's objects cast. Uses of the settings `shade`, `aovs`, `exposure`, `alpha` and `count_lights` only;
/// the camera is the G-buffer's. Throws as validate() and validateGBuffer() do, and MachineError.
Image shadeGBuffer(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings,
                   Stats& stats);

}  // namespace luciole
