#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "raster/rasterize.hpp"

namespace luciole::test {

/// Half a unit in the last place of a float, relative: the error of storing a number.
constexpr double kFloatRounding = 0x1p-24;

/// How far, in pixels, a drawn edge may lie from the true one: each corner moves by half of 1/256 pixel along
/// x and y when it is snapped, and again when it was made by clipping; 0.5 / 256 · √2 · 2 < 1/128.
constexpr double kEdgeShift = 1.0 / 128.0;

inline Material doubleSided() {
  Material material;
  material.diffuse = glm::vec3(1.0f);
  material.double_sided = true;
  return material;
}

/// A scene of one mesh with one material, at the origin, its normals along +z.
inline Scene meshScene(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles,
                       const Material& material = doubleSided()) {
  Scene scene;
  scene.materials.push_back(material);
  Mesh mesh;
  mesh.normals.assign(positions.size(), {0.0f, 0.0f, 1.0f});
  mesh.triangle_materials.assign(triangles.size(), 0);
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back({});
  return scene;
}

/// A texture of random texels, of a size and its coarser levels down to a width of 1.
inline Texture randomChain(glm::ivec2 size, std::mt19937& random) {
  std::uniform_int_distribution<int> code(0, 65535);
  Texture texture;
  for (; texture.levels.empty() || texture.levels.back().width > 1;
       size = glm::max(size / 2, glm::ivec2(1))) {
    MipLevel level{size.x, size.y, {}};
    for (int i = 0; i < size.x * size.y * 4; ++i) level.texels.push_back(std::uint16_t(code(random)));
    texture.levels.push_back(level);
  }
  return texture;
}

/// Two triangles a cell of a grid of cells², whose vertices come row by row.
inline std::vector<glm::uvec3> gridTriangles(std::uint32_t cells) {
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x;
      triangles.push_back({a, a + 1, a + cells + 2});
      triangles.push_back({a, a + cells + 2, a + cells + 1});
    }
  return triangles;
}

/// A rectangle facing +z at depth z; texture coordinates (0,0) at its top left, (1,1) at its bottom right.
inline Scene rectangleScene(float half_width, float half_height, float z,
                            const Material& material = doubleSided()) {
  Scene scene = meshScene({{-half_width, -half_height, z},
                           {half_width, -half_height, z},
                           {half_width, half_height, z},
                           {-half_width, half_height, z}},
                          {{0, 1, 2}, {0, 2, 3}}, material);
  scene.meshes[0].uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  return scene;
}

/// At the origin, looking along −z.
inline Camera frontCamera() {
  Camera camera;
  camera.near = 0.01;
  camera.far = 1e4;
  return camera;
}

/// A parallel view whose unit of length is a pixel: pixel (i, j)'s centre is at (i + ½ − width/2, height/2 −
/// j − ½).
inline View pixelView(glm::ivec2 size) {
  Camera camera = frontCamera();
  camera.orthographic = true;
  camera.half_height = 0.5 * size.y;
  return cameraView(camera, size);
}

inline GBuffer draw(const Scene& scene, const View& view, Shading shading = Shading::kPhong,
                    PlaneSet planes = {}, RasterCounts* counts = nullptr) {
  const std::vector<std::uint32_t> objects = allObjects(scene);
  return rasterize(scene, objects, view, shading, planes, {}, counts);
}

/// The depth map of the whole scene: the view's crop, row by row.
inline std::vector<ShadowTexel> depthOf(const Scene& scene, const View& view) {
  const Meshlets meshlets = findMeshlets(scene);
  // Not cleared, so that a texel that isn't drawn shows.
  std::vector<ShadowTexel> texels(std::size_t(view.crop_size.x) * view.crop_size.y, {-1.0f, 0xffffffffu});
  rasterizeDepth(scene, meshlets, allMeshlets(meshlets), view, {}, texels);
  return texels;
}

/// The surface's steps of depth a texel, right and down.
inline glm::dvec2 slopesOf(const ShadowTexel& texel) {
  return {std::bit_cast<float>(texel.slopes & 0xffff0000u), std::bit_cast<float>(texel.slopes << 16)};
}

/// Half a unit in the last of the 8 places that a slope keeps, relative.
constexpr double kSlopeRounding = 0x1p-8;

inline bool sameTexel(const ShadowTexel& a, const ShadowTexel& b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline glm::vec3 valueAt(const Plane& group, const GBuffer& gbuffer, int x, int y) {
  const std::size_t i = gbuffer.index(x, y);
  return {group[i], group[gbuffer.pixels() + i], group[2 * gbuffer.pixels() + i]};
}
inline glm::vec3 positionAt(const GBuffer& gbuffer, int x, int y) {
  return valueAt(gbuffer.position, gbuffer, x, y);
}
inline bool isCovered(const GBuffer& gbuffer, int x, int y) {
  return std::isfinite(positionAt(gbuffer, x, y).z);
}

/// How many of the scene's triangles cover each pixel, each of them drawn alone.
inline std::vector<int> coverageCounts(const Scene& scene, const View& view) {
  std::vector<int> counts(std::size_t(view.size.x) * view.size.y);
  Scene single = scene;
  for (const glm::uvec3& triangle : scene.meshes[0].triangles) {
    single.meshes[0].triangles = {triangle};
    single.meshes[0].triangle_materials = {0};
    const GBuffer gbuffer = draw(single, view);
    for (int y = 0; y < view.size.y; ++y)
      for (int x = 0; x < view.size.x; ++x)
        counts[std::size_t(y) * view.size.x + x] += isCovered(gbuffer, x, y);
  }
  return counts;
}

/// A ray in view space through a point of the picture, in pixels from the top left corner.
struct Ray {
  glm::dvec3 origin;
  glm::dvec3 direction;
};
inline Ray pixelRay(const Camera& camera, glm::ivec2 size, double x, double y) {
  const double ndc_x = 2.0 * x / size.x - 1.0;
  const double ndc_y = 1.0 - 2.0 * y / size.y;
  const double aspect = double(size.x) / size.y;
  if (camera.orthographic)
    return {{ndc_x * aspect * camera.half_height, ndc_y * camera.half_height, 0.0}, {0.0, 0.0, -1.0}};
  const double reach = std::tan(0.5 * camera.fov_y);
  return {{0.0, 0.0, 0.0}, {ndc_x * aspect * reach, ndc_y * reach, -1.0}};
}

struct Hit {
  double t;
  glm::dvec3 weights;
};
/// By areas of the three triangles that the hit point makes with the corners.
inline std::optional<Hit> intersect(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b,
                                    const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double t = glm::dot(normal, a - ray.origin) / glm::dot(normal, ray.direction);
  const glm::dvec3 p = ray.origin + t * ray.direction;
  const double area = glm::dot(normal, normal);
  const glm::dvec3 weights(glm::dot(normal, glm::cross(c - b, p - b)) / area,
                           glm::dot(normal, glm::cross(a - c, p - c)) / area,
                           glm::dot(normal, glm::cross(b - a, p - a)) / area);
  if (!(t > 0.0 && weights.x >= 0.0 && weights.y >= 0.0 && weights.z >= 0.0)) return std::nullopt;
  return Hit{t, weights};
}

/// The rays through a pixel's centre (first) and through the corners of the square in which edges may move.
inline std::vector<Ray> raysAround(const Camera& camera, glm::ivec2 size, int x, int y) {
  std::vector<Ray> rays{pixelRay(camera, size, x + 0.5, y + 0.5)};
  for (const double dx : {-kEdgeShift, kEdgeShift})
    for (const double dy : {-kEdgeShift, kEdgeShift})
      rays.push_back(pixelRay(camera, size, x + 0.5 + dx, y + 0.5 + dy));
  return rays;
}

}  // namespace luciole::test
