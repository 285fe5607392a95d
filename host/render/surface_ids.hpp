#pragma once

#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "render/render.hpp"

// Layers that say what a pixel's samples see: objects and materials, by number or as Cryptomattes by name.
namespace luciole {

/// Whether the settings ask for such layers.
bool wantsSurfaceIds(const RenderSettings& settings);

/// The names by which mattes know a scene's objects. What has no name of its own is called after its mesh, a
/// file without folder and ending, and where that isn't the only one, by its number in the scene too: box.3.
std::vector<std::string> objectNames(const Scene& scene);
/// The same of materials: what has no name is called material and its number.
std::vector<std::string> materialNames(const Scene& scene);

/// The texts in an EXR's header that the mattes which the settings ask for need.
Metadata surfaceIdTexts(const Scene& scene, const RenderSettings& settings);

/// What mattes call objects and materials (cryptomatteId), by their numbers in the scene.
struct MatteIds {
  std::vector<float> objects, materials;
};
MatteIds matteIds(const Scene& scene, const RenderSettings& settings);

/// Fills in the layers that the settings ask for, of a picture of this view that has their channels. Draws
/// all samples of its pixels once more. Objects that the fog hides count as others. Throws as rasterize does.
void setSurfaceIds(const Scene& scene, const View& view, const RenderSettings& settings, const MatteIds& ids,
                   Image& picture);

}  // namespace luciole
