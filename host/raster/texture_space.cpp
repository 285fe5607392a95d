#include "raster/texture_space.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/machine_memory.hpp"
#include "luciole/error.hpp"
#include "luciole/validate_scene.hpp"
#include "raster/empty_gbuffer.hpp"
#include "raster/resolve_square.hpp"
#include "raster/seen_surface.hpp"
#include "raster/shading_points.hpp"

namespace luciole {
namespace {

/// Samples that tell whether a chart covers a part of a texel.
constexpr int kSamplesOfATexel = 16;

/// Of a texel: all groups of a G-buffer, and three labels.
constexpr double kBytesPerTexel = (3 + 3 + 3 + 4 + 3 + 3 + 1 + 1 + 1 + 1 + 2 + 1 + 1 + 3) * 4;

/// A scene of the object alone, flattened into texture space: a parallel camera at the origin sees the map.
/// Triangles keep their order, or are reversed.
Scene flattenedObject(const Mesh& mesh, const std::vector<glm::vec2>& uvs, double aspect, bool from_the_end) {
  Scene flat;
  flat.materials.resize(1);
  flat.materials[0].double_sided = true;
  Mesh& spread = flat.meshes.emplace_back();
  for (const glm::vec2& uv : uvs)
    spread.positions.emplace_back(aspect * (2.0 * uv.x - 1), 1 - 2.0 * uv.y, -1);
  spread.normals.resize(spread.positions.size(), {0, 0, 1});
  spread.triangles = mesh.triangles;
  if (from_the_end) std::reverse(spread.triangles.begin(), spread.triangles.end());
  spread.triangle_materials.resize(spread.triangles.size(), 0);
  flat.objects.emplace_back();
  return flat;
}

/// Which triangle each texel shows, row by row, in its middle or with more samples anywhere.
std::vector<std::uint32_t> labelsOf(const Scene& flat, const View& view, int samples) {
  const SampledView sampled =
      setupSamples(flat, allObjects(flat), view, Margin::kPixel, samples, Shading::kPhong, {}, {});
  std::vector<std::uint32_t> labels(std::size_t(view.size.x) * view.size.y, kNoTriangle);
  visitSamples(sampled, [&](const glm::ivec2& at, std::span<const std::uint32_t> triangles) {
    const auto seen = std::find_if(triangles.begin(), triangles.end(),
                                   [](std::uint32_t triangle) { return triangle != kNoTriangle; });
    if (seen != triangles.end()) labels[std::size_t(at.y) * view.size.x + at.x] = *seen;
  });
  return labels;
}

}  // namespace

std::vector<glm::vec2> lightMapUvs(const Scene& scene, const Mesh& mesh) {
  std::vector<glm::vec2> uvs = mesh.lightmap_uvs.empty() ? mesh.uvs : mesh.lightmap_uvs;
  const std::string of = fmt::format("{}: mesh {}", scene.name, mesh.name);
  if (uvs.empty()) throw InputError(of + " has no texture coordinates, by which a map could be laid out");
  glm::vec2 low(std::numeric_limits<float>::max());
  for (const glm::vec2& uv : uvs) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
      throw InputError(of + ": a texture coordinate is not finite");
    low = glm::min(low, uv);
  }
  const glm::vec2 square = glm::floor(low);
  for (glm::vec2& uv : uvs) {
    uv -= square;
    if (!(uv.x <= 1 && uv.y <= 1))
      throw InputError(fmt::format(
          "{}: texture coordinates from {}, {} to {}, {}, expected such as fit into a square of one unit", of,
          low.x, low.y, uv.x + square.x, uv.y + square.y));
  }
  return uvs;
}

TextureSpace rasterizeTextureSpace(const Scene& scene, std::uint32_t object, glm::ivec2 size,
                                   const Camera& camera, PlaneSet planes) {
  validateScene(scene);
  if (object >= scene.objects.size())
    throw InputError(fmt::format("object: {}, but there are {} objects", object, scene.objects.size()));
  if (const std::string fault = cameraFault(camera); !fault.empty()) throw InputError("camera." + fault);
  const Mesh& mesh = scene.meshes[scene.objects[object].mesh];
  const std::vector<glm::vec2> uvs = lightMapUvs(scene, mesh);
  Camera before;
  before.orthographic = true;
  const View view = cameraView(before, size);
  checkView(view);
  requireMemory(kBytesPerTexel * size.x * size.y, fmt::format("a map of {}x{} texels", size.x, size.y));
  TextureSpace result;
  result.gbuffer = emptyGBuffer(view, planes);
  GBuffer& gbuffer = result.gbuffer;
  gbuffer.camera = camera;
  gbuffer.knows_camera = false;

  const double aspect = double(size.x) / size.y;
  const Scene flat = flattenedObject(mesh, uvs, aspect, false);
  std::vector<std::uint32_t> labels = labelsOf(flat, view, 1);
  {
    // Where triangles overlap the first is visible. In reverse order that is another one.
    const std::vector<std::uint32_t> others = labelsOf(flattenedObject(mesh, uvs, aspect, true), view, 1);
    const auto last = std::uint32_t(mesh.triangles.size() - 1);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      result.covered += labels[i] != kNoTriangle;
      result.overlapping += labels[i] != kNoTriangle && labels[i] != last - others[i];
    }
  }
  if (result.covered < labels.size()) {
    const std::vector<std::uint32_t> anywhere = labelsOf(flat, view, kSamplesOfATexel);
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (labels[i] == kNoTriangle) labels[i] = anywhere[i];
  }

  const std::uint32_t drawn[] = {object};
  const glm::dmat4 world_to_view = worldToView(camera);
  const std::vector<PlacedObject> objects = placeObjects(scene, drawn, world_to_view);
  const std::vector<PlacedObject> spread = placeObjects(flat, allObjects(flat), view.world_to_view);
  const ViewPlane plane = viewPlane(view);
  const ResolveInput input{scene, objects, plane, Shading::kPhong, {}, planes, world_to_view, &spread};
  tbb::parallel_for(0, (size.y + kSquareSize - 1) / kSquareSize, [&](int row) {
    SurfaceCache surfaces(input);
    for (int x = 0; x < size.x; x += kSquareSize) {
      const glm::ivec2 square(x, row * kSquareSize);
      Lanes<std::uint32_t> triangles;
      for (int i = 0; i < kSquarePixels; ++i) {
        const int texel_x = square.x + kSquareLayout.x[i], texel_y = square.y + kSquareLayout.y[i];
        const bool inside = texel_x < size.x && texel_y < size.y;
        triangles[i] = inside ? labels[std::size_t(texel_y) * size.x + texel_x] : kNoTriangle;
      }
      resolveSquare(input, squarePlace(plane, square), triangles, surfaces, gbuffer.index(square.x, square.y),
                    gbuffer);
    }
    finishSquares();
  });
  return result;
}

}  // namespace luciole
