#include "render/surface_ids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/utf8.hpp"
#include "image/cryptomatte.hpp"
#include "raster/shading_points.hpp"
#include "render/assemble.hpp"

namespace luciole {
namespace {

/// What a triangle belongs to, by numbers in the scene.
struct SurfaceId {
  std::uint32_t object, material;
};

SurfaceId surfaceOf(const Scene& scene, const std::vector<PlacedObject>& objects, std::uint32_t triangle) {
  const PlacedObject& object = objectOfTriangle(objects, triangle);
  const Material& material = materialOf(scene, object, triangle - object.first_triangle);
  return {std::uint32_t(&object - objects.data()), std::uint32_t(&material - scene.materials.data())};
}

/// How many of a pixel's samples show each name.
using Tally = std::vector<std::pair<float, int>>;

void count(float id, int samples, Tally& tally) {
  for (auto& [known, sum] : tally)
    if (known == id) {
      sum += samples;
      return;
    }
  tally.emplace_back(id, samples);
}

/// Writes a pixel's ranks: those that cover most first, and of two alike the one whose sample came first.
void storeRanks(Tally& tally, int samples, float* out) {
  std::stable_sort(tally.begin(), tally.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  for (std::size_t rank = 0; rank < std::size_t(kCryptomatteRanks); ++rank) {
    const bool is_there = rank < tally.size();
    out[2 * rank] = is_there ? tally[rank].first : 0.0f;
    out[2 * rank + 1] = is_there ? float(tally[rank].second) / float(samples) : 0.0f;
  }
}

}  // namespace

bool wantsSurfaceIds(const RenderSettings& settings) {
  return wants(settings, Aov::kObjectId) || wants(settings, Aov::kMaterialId) ||
         wants(settings, Aov::kCryptoObject) || wants(settings, Aov::kCryptoMaterial);
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
  if (wants(settings, Aov::kCryptoObject)) add(cryptomatteTexts(kCryptoObject, objectNames(scene)));
  if (wants(settings, Aov::kCryptoMaterial)) add(cryptomatteTexts(kCryptoMaterial, materialNames(scene)));
  return texts;
}

MatteIds matteIds(const Scene& scene, const RenderSettings& settings) {
  MatteIds ids;
  if (wants(settings, Aov::kCryptoObject))
    for (const std::string& name : objectNames(scene)) ids.objects.push_back(cryptomatteId(name));
  if (wants(settings, Aov::kCryptoMaterial))
    for (const std::string& name : materialNames(scene)) ids.materials.push_back(cryptomatteId(name));
  return ids;
}

void setSurfaceIds(const Scene& scene, const View& view, const RenderSettings& settings, const MatteIds& ids,
                   Image& picture) {
  const auto object = channelOf(picture, settings, Aov::kObjectId),
             material = channelOf(picture, settings, Aov::kMaterialId),
             objects = channelOf(picture, settings, Aov::kCryptoObject),
             materials = channelOf(picture, settings, Aov::kCryptoMaterial);
  const SampledView sampled = setupSamples(scene, allObjects(scene), view, Margin::kPixel, settings.samples,
                                           settings.shading, {}, {});
  const std::size_t channels = picture.channels.size();
  visitSamples(sampled, [&](const glm::ivec2& at, std::span<const std::uint32_t> triangles) {
    const glm::ivec2 in_picture = at - view.crop_origin;
    float* pixel =
        picture.pixels.data() +
        (std::size_t(in_picture.y) * std::size_t(picture.width) + std::size_t(in_picture.x)) * channels;
    Tally of_objects, of_materials;
    for (std::size_t i = 0, end; i < triangles.size(); i = end) {
      for (end = i + 1; end < triangles.size() && triangles[end] == triangles[i];) ++end;
      if (triangles[i] == kNoTriangle) continue;
      const SurfaceId surface = surfaceOf(scene, sampled.objects, triangles[i]);
      if (i == 0 && object) pixel[*object] = float(surface.object);
      if (i == 0 && material) pixel[*material] = float(surface.material);
      if (objects) count(ids.objects[surface.object], int(end - i), of_objects);
      if (materials) count(ids.materials[surface.material], int(end - i), of_materials);
    }
    if (objects) storeRanks(of_objects, settings.samples, pixel + *objects);
    if (materials) storeRanks(of_materials, settings.samples, pixel + *materials);
  });
}

}  // namespace luciole
