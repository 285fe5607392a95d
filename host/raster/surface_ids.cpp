#include "raster/surface_ids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "base/utf8.hpp"
#include "image/cryptomatte.hpp"
#include "raster/shading_points.hpp"

namespace luciole {
namespace {

/// The indices of a triangle's object and material in the scene.
struct SurfaceId {
  std::uint32_t object, material;
};

SurfaceId surfaceOf(const Scene& scene, const std::vector<PlacedObject>& objects, std::uint32_t triangle) {
  const PlacedObject& object = objectOfTriangle(objects, triangle);
  const Material& material = materialOf(scene, object, triangle - object.first_triangle);
  return {std::uint32_t(&object - objects.data()), std::uint32_t(&material - scene.materials.data())};
}

/// The number of a pixel's samples for each Cryptomatte id.
using Tally = std::vector<std::pair<float, int>>;

void count(float id, int samples, Tally& tally) {
  for (auto& [known, sum] : tally)
    if (known == id) {
      sum += samples;
      return;
    }
  tally.emplace_back(id, samples);
}

/// Writes a pixel's ranks by falling coverage; equal ones in the order of their first samples.
void storeRanks(Tally& tally, int samples, float* out) {
  std::stable_sort(tally.begin(), tally.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  for (std::size_t rank = 0; rank < std::size_t(kCryptomatteRanks); ++rank) {
    const bool is_used = rank < tally.size();
    out[2 * rank] = is_used ? tally[rank].first : 0.0f;
    out[2 * rank + 1] = is_used ? float(tally[rank].second) / float(samples) : 0.0f;
  }
}

}  // namespace

bool wantsSurfaceIds(const RenderSettings& settings) {
  return settings.wants(Aov::kObjectId) || settings.wants(Aov::kMaterialId) ||
         settings.wants(Aov::kCryptoObject) || settings.wants(Aov::kCryptoMaterial);
}

std::vector<std::string> objectNames(const Scene& scene) {
  std::vector<std::string> names;
  std::map<std::string, int> unnamed;
  for (const Object& object : scene.objects) {
    names.push_back(object.name);
    if (!object.name.empty()) continue;
    names.back() = utf8Of(std::filesystem::path(scene.meshes[object.mesh].name).stem().string());
    ++unnamed[names.back()];
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    if (scene.objects[i].name.empty() && (names[i].empty() || unnamed[names[i]] > 1))
      names[i] = fmt::format("{}.{}", names[i].empty() ? "object" : names[i], i);
  return names;
}

std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    names.push_back(scene.materials[i].name.empty() ? fmt::format("material.{}", i)
                                                    : scene.materials[i].name);
  return names;
}

Metadata surfaceIdTexts(const Scene& scene, const RenderSettings& settings) {
  Metadata texts;
  const auto add = [&](Metadata more) { texts.insert(texts.end(), more.begin(), more.end()); };
  if (settings.wants(Aov::kCryptoObject)) add(cryptomatteTexts(kCryptoObject, objectNames(scene)));
  if (settings.wants(Aov::kCryptoMaterial)) add(cryptomatteTexts(kCryptoMaterial, materialNames(scene)));
  return texts;
}

MatteIds matteIds(const Scene& scene, const RenderSettings& settings) {
  MatteIds ids;
  if (settings.wants(Aov::kCryptoObject))
    for (const std::string& name : objectNames(scene)) ids.objects.push_back(cryptomatteId(name));
  if (settings.wants(Aov::kCryptoMaterial))
    for (const std::string& name : materialNames(scene)) ids.materials.push_back(cryptomatteId(name));
  return ids;
}

void setSurfaceIds(const Scene& scene, const View& view, const RenderSettings& settings, const MatteIds& ids,
                   const SurfaceIdChannels& channels, Image& picture) {
  const SampledView sampled = setupSamples(scene, allObjects(scene), view, Margin::kPixel, settings.samples,
                                           settings.shading, {}, {});
  const std::size_t pixel_size = picture.channels.size();
  visitSamples(sampled, [&](const glm::ivec2& at, std::span<const std::uint32_t> triangles) {
    const glm::ivec2 in_picture = at - view.crop_origin;
    float* pixel =
        picture.pixels.data() +
        (std::size_t(in_picture.y) * std::size_t(picture.width) + std::size_t(in_picture.x)) * pixel_size;
    Tally of_objects, of_materials;
    for (std::size_t i = 0, end; i < triangles.size(); i = end) {
      for (end = i + 1; end < triangles.size() && triangles[end] == triangles[i];) ++end;
      if (triangles[i] == kNoTriangle) continue;
      const SurfaceId surface = surfaceOf(scene, sampled.objects, triangles[i]);
      if (i == 0 && channels.object_id) pixel[*channels.object_id] = float(surface.object);
      if (i == 0 && channels.material_id) pixel[*channels.material_id] = float(surface.material);
      if (channels.crypto_object) count(ids.objects[surface.object], int(end - i), of_objects);
      if (channels.crypto_material) count(ids.materials[surface.material], int(end - i), of_materials);
    }
    if (channels.crypto_object) storeRanks(of_objects, settings.samples, pixel + *channels.crypto_object);
    if (channels.crypto_material)
      storeRanks(of_materials, settings.samples, pixel + *channels.crypto_material);
  });
}

}  // namespace luciole
