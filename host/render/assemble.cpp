#include "render/assemble.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "image/cryptomatte.hpp"
#include "kernels/shared.h"
#include "raster/square.hpp"

namespace luciole {
namespace {

constexpr const char* kShadingCount = "shading_count";
constexpr const char* kLightErrorR = "light_error.R";

/// Where a channel of that name is; the number of channels if there is none.
std::size_t channelOf(const Image& image, const char* name) {
  return std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin();
}

/// A channel of the finished picture, and where its values are.
struct Layer {
  std::string name;
  const float* plane;      ///< in the G-buffer's layout; null: filled in later
  float otherwise = 0.0f;  ///< without a plane
};

std::vector<Layer> groupLayers(const GBuffer& gbuffer, const Plane& group,
                               std::initializer_list<const char*> names) {
  std::vector<Layer> layers;
  std::size_t component = 0;
  for (const char* name : names)
    if (!group.empty()) layers.push_back({name, group.data() + gbuffer.pixels() * component++});
  return layers;
}

/// World-space positions or normals and depths, from the view-space planes.
struct WorldPlanes {
  Plane position, normal, depth;
};

WorldPlanes worldPlanes(const GBuffer& gbuffer) {
  const std::size_t n = gbuffer.pixels();
  WorldPlanes world{Plane(3 * n), Plane(3 * n), Plane(n)};
  const glm::dmat4& to_world = gbuffer.camera.camera_to_world;
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const glm::dvec3 p(gbuffer.position[i], gbuffer.position[i + n], gbuffer.position[i + 2 * n]);
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + n], gbuffer.normal[i + 2 * n]);
    const bool covered = std::isfinite(p.z);
    const glm::dvec3 world_p = covered ? glm::dvec3(to_world * glm::dvec4(p, 1)) : glm::dvec3(0);
    const glm::dvec3 world_n = glm::dmat3(to_world) * normal;
    for (int c = 0; c < 3; ++c) {
      world.position[i + c * n] = float(world_p[c]);
      world.normal[i + c * n] = float(world_n[c]);
    }
    world.depth[i] = float(-p.z);
  });
  return world;
}

/// Calls `visit(place in the G-buffer, pixel of the picture)` for each pixel, tile by tile, as they lie in
/// the planes.
template <class Visit>
void forEachPixel(const GBuffer& gbuffer, Image& image, Visit visit) {
  const int tiles_x = gbuffer.tiles_x;
  tbb::parallel_for(0, tiles_x * gbuffer.tiles_y, [&](int tile) {
    const glm::ivec2 first = glm::ivec2(tile % tiles_x, tile / tiles_x) * int(kTileSize);
    for (int i = 0; i < kTilePixels; ++i) {
      const int square = i / kSquarePixels, in_square = i % kSquarePixels;
      const int x = first.x + kSquareSize * kSquareLayout.x[square] + kSquareLayout.x[in_square];
      const int y = first.y + kSquareSize * kSquareLayout.y[square] + kSquareLayout.y[in_square];
      if (x < image.width && y < image.height)
        visit(std::size_t(tile) * kTilePixels + i,
              image.pixels.data() + (std::size_t(y) * image.width + x) * image.channels.size());
    }
  });
}

/// As finite_color() in the kernels: the sum of bright samples may overflow a float.
float finiteColor(float color) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::max(color < kLargest ? color : kLargest, -kLargest);
}

/// What sums over a pixel's samples are multiplied by.
float scaleOf(const RenderSettings& settings) {
  return std::exp2(settings.exposure) / float(settings.samples);
}

}  // namespace

bool wants(const RenderSettings& settings, Aov aov) {
  return std::find(settings.aovs.begin(), settings.aovs.end(), aov) != settings.aovs.end();
}

bool countsCovered(const RenderSettings& settings) {
  return settings.alpha || wants(settings, Aov::kShadingCount);
}

std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes) {
  std::size_t count = settings.alpha ? 4 : 3;
  for (const Aov aov : settings.aovs) {
    switch (aov) {
      case Aov::kPosition:
      case Aov::kNormal:
      case Aov::kDiffuse:
      case Aov::kLightError:
        count += 3;
        break;
      case Aov::kMaterial:
        count += (planes.specular ? 4 : 0) + (planes.ambient ? 3 : 0) + (planes.emission ? 3 : 0);
        break;
      case Aov::kDepth:
      case Aov::kLightCount:
      case Aov::kListLength:
      case Aov::kShadow:
      case Aov::kShadingCount:
      case Aov::kObjectId:
      case Aov::kMaterialId:
        count += 1;
        break;
      case Aov::kCryptoObject:
      case Aov::kCryptoMaterial:
        count += 2 * kCryptomatteRanks;
        break;
      case Aov::kAmbient:
      case Aov::kDiffuseLight:
      case Aov::kSpecularLight:
      case Aov::kEmission:
      case Aov::kFog:
        break;  // lightLayers() has them
    }
  }
  return count;
}

Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings,
                   const std::vector<std::string>& light_layers, Image used) {
  const std::size_t n = gbuffer.pixels();
  std::vector<Layer> layers;
  const auto append = [&](std::vector<Layer> more) { layers.insert(layers.end(), more.begin(), more.end()); };
  const Plane all_visible(wants(settings, Aov::kShadow) ? n : 0, 1.0f);  // where no light casts shadows
  WorldPlanes world;
  if (wants(settings, Aov::kPosition) || wants(settings, Aov::kNormal) || wants(settings, Aov::kDepth))
    world = worldPlanes(gbuffer);
  for (const Aov aov : settings.aovs) {
    switch (aov) {
      case Aov::kPosition:
        append(groupLayers(gbuffer, world.position, {"P.X", "P.Y", "P.Z"}));
        break;
      case Aov::kNormal:
        append(groupLayers(gbuffer, world.normal, {"N.X", "N.Y", "N.Z"}));
        break;
      case Aov::kDepth:
        append({{"Z", world.depth.data()}});
        break;
      case Aov::kDiffuse:
        append(groupLayers(gbuffer, gbuffer.diffuse, {"diffuse.R", "diffuse.G", "diffuse.B"}));
        break;
      case Aov::kMaterial:
        append(
            groupLayers(gbuffer, gbuffer.specular, {"specular.R", "specular.G", "specular.B", "shininess"}));
        append(groupLayers(gbuffer, gbuffer.ambient, {"ambient.R", "ambient.G", "ambient.B"}));
        append(groupLayers(gbuffer, gbuffer.emission, {"emission.R", "emission.G", "emission.B"}));
        break;
      case Aov::kLightCount:
        append({{"light_count", first.light_count.data()}});
        break;
      case Aov::kListLength:
        append({{"list_length", first.list_length.data()}});
        break;
      case Aov::kShadow:
        append({{"shadow", first.color.size() == 4 * n ? first.color.data() + 3 * n : all_visible.data()}});
        break;
      case Aov::kLightError:
        append({{kLightErrorR, nullptr}, {"light_error.G", nullptr}, {"light_error.B", nullptr}});
        break;
      case Aov::kShadingCount:
        append({{kShadingCount, nullptr}});
        break;
      case Aov::kObjectId:
        append({{"object_id", nullptr, -1.0f}});
        break;
      case Aov::kMaterialId:
        append({{"material_id", nullptr, -1.0f}});
        break;
      case Aov::kCryptoObject:
      case Aov::kCryptoMaterial:
        for (std::string& name :
             cryptomatteChannels(aov == Aov::kCryptoObject ? kCryptoObject : kCryptoMaterial))
          append({{std::move(name), nullptr}});
        break;
      case Aov::kAmbient:
      case Aov::kDiffuseLight:
      case Aov::kSpecularLight:
      case Aov::kEmission:
      case Aov::kFog:
        break;  // come last, see below
    }
  }
  Image image{gbuffer.width, gbuffer.height, {"R", "G", "B"}, std::move(used.pixels)};
  if (settings.alpha) image.channels.push_back("A");
  const std::size_t first_layer = image.channels.size();
  for (const Layer& layer : layers) image.channels.push_back(layer.name);
  for (const std::string& layer : light_layers)
    for (const char* component : {"R", "G", "B"}) image.channels.push_back(layer + component);
  image.pixels.resize(std::size_t(image.width) * image.height * image.channels.size());
  if (layers.empty()) return image;
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (std::size_t c = 0; c < layers.size(); ++c)
      pixel[first_layer + c] = layers[c].plane ? layers[c].plane[place] : layers[c].otherwise;
  });
  return image;
}

void setLightLayer(const GBuffer& gbuffer, const Plane& sums, const RenderSettings& settings,
                   std::size_t first_channel, Image& image) {
  const std::size_t n = gbuffer.pixels();
  const float scale = scaleOf(settings);
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (std::size_t c = 0; c < 3; ++c) pixel[first_channel + c] = finiteColor(sums[place + c * n] * scale);
  });
}

void countCovered(const GBuffer& gbuffer, Plane& covered) {
  const std::size_t n = gbuffer.pixels();
  covered.resize(n);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    covered[i] += std::isfinite(gbuffer.position[i + 2 * n]) ? 1.0f : 0.0f;
  });
}

void setColors(const GBuffer& gbuffer, const PixelSums& sums, const RenderSettings& settings, Image& image) {
  const std::size_t n = gbuffer.pixels();
  const Plane& shadings = sums.shadings.empty() ? sums.covered : sums.shadings;
  const std::size_t counted = channelOf(image, kShadingCount);
  const std::size_t bounded =
      sums.light_error.empty() ? image.channels.size() : channelOf(image, kLightErrorR);
  const float scale = scaleOf(settings);
  // Each of n samples' products and sums rounds both colour and bound, and so do the factor and the product
  // with it: fewer than 2n + 3 roundings of 2⁻²⁴, of terms ≥ 0.
  const double rounding = (2 * settings.samples + 3) * 0x1p-24;
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (int c = 0; c < 3; ++c) pixel[c] = finiteColor(sums.color[place + c * n] * scale);
    if (settings.alpha) pixel[3] = sums.covered[place] / float(settings.samples);
    for (int c = 0; c < 3 && bounded < image.channels.size(); ++c) {
      const double bound = double(sums.light_error[place + c * n]) * scale;
      pixel[bounded + c] = finiteColor(float((1 + rounding) * bound + rounding * double(pixel[c])));
    }
    if (counted < image.channels.size()) pixel[counted] = shadings[place];
  });
}

}  // namespace luciole
