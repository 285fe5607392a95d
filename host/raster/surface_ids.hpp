#pragma once

#include <optional>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "luciole/settings.hpp"
#include "raster/view.hpp"

// Layers that show which objects and materials the samples of a pixel see: by number, or by name as
// Cryptomattes.
namespace luciole {

/// Whether the settings ask for such layers.
bool wantsSurfaceIds(const RenderSettings& settings);

/// The objects' names in Cryptomattes. An object without a name gets its mesh's, a file's name without folder
/// and extension, and its index in the scene if several would have the same: box.3.
std::vector<std::string> objectNames(const Scene& scene);
/// The same of materials. One without a name is called material and its index: material.3.
std::vector<std::string> materialNames(const Scene& scene);

/// The attributes of an EXR's header for the Cryptomattes among RenderSettings::aovs.
Metadata surfaceIdTexts(const Scene& scene, const RenderSettings& settings);

/// The cryptomatteId() of each object and material of a scene, by index. Empty for a Cryptomatte that the
/// settings don't ask for.
struct MatteIds {
  std::vector<float> objects, materials;
};
MatteIds matteIds(const Scene& scene, const RenderSettings& settings);

/// The first channel of each of these layers in a picture; empty for one that it lacks.
struct SurfaceIdChannels {
  std::optional<std::size_t> object_id, material_id, crypto_object, crypto_material;
};

/// Fills in these channels of a picture of this view. Draws all samples of its pixels once more. Objects that
/// the fog hides count as others. Throws as rasterize does.
void setSurfaceIds(const Scene& scene, const View& view, const RenderSettings& settings, const MatteIds& ids,
                   const SurfaceIdChannels& channels, Image& picture);

}  // namespace luciole
