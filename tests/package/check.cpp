// Holds a triangle, given as the planes of a G-buffer, a mesh and its light map to the formula. Prints the
// brightest colours, and how far the pictures are from it.
#include <cmath>
#include <cstdio>

#include <luciole/planes.hpp>
#include <luciole/primitives.hpp>
#include <luciole/render.hpp>

using namespace luciole;

constexpr int kSide = 32;  // pixels of both pictures

/// What the eye, at the origin, sees at a pixel 2 m ahead, where 90° span 4 m.
glm::vec3 pointAt(int x, int y) { return {(x + 0.5f) / 8 - 2, 2 - (y + 0.5f) / 8, -2}; }

/// The largest difference between a picture and Phong's formula. Light L and eye V are both at the origin, so
/// for a surface that faces +z they enclose one angle with its normal, of cosine c = 2 m / distance, and with
/// it L mirrored and V enclose twice that:
///   colour = 6 (diffuse · c + specular · (2c² − 1)⁸), with diffuse ½, specular ¼ and, where 2c² < 1, no
///   specular.
template <class Covers>
float errorOf(const Image& picture, Covers&& covers) {
  float error = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double c = 2 / std::sqrt(glm::dot(glm::dvec3(pointAt(x, y)), glm::dvec3(pointAt(x, y))));
      const double expected = covers(x, y) ? 6 * (c / 2 + std::pow(std::max(2 * c * c - 1, 0.0), 8) / 4) : 0;
      for (int i = 0; i < 3; ++i)
        error = std::max(error, std::abs(picture.pixels[3 * (y * kSide + x) + i] - float(expected)));
    }
  return error;
}

int main() {
  Device device = Device::open();
  Scene scene;
  scene.lights = {{.diffuse = glm::vec3(6), .specular = glm::vec3(6)}};
  RenderSettings settings{.size{kSide, kSide}, .camera{.fov_y = glm::radians(90.0)}};

  // The triangle: a G-buffer in view space, whose other pixels stay background.
  GBuffer gbuffer{.width = kSide,
                  .height = kSide,
                  .tiles_x = kSide / GBuffer::kTileSide,
                  .tiles_y = kSide / GBuffer::kTileSide};
  gbuffer.camera = settings.camera;
  gbuffer.picture_size = settings.size;
  allocatePlanes({.specular = true}, gbuffer);
  const std::size_t stride = gbuffer.pixels();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x <= y; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      storePixel(pointAt(x, y), place, stride, gbuffer.position);
      storePixel({0, 0, 1}, place, stride, gbuffer.normal);
      storePixel(glm::vec3(0.5f), place, stride, gbuffer.diffuse);
      storePixel(glm::vec3(0.25f), place, stride, gbuffer.specular);
      gbuffer.specular[3 * stride + place] = 8;  // the shininess
    }
  const Image triangle = shade(device, scene, gbuffer, settings).image;

  // The mesh: a square of 2 m, the middle quarter of the picture, turned from +y to face the eye. Its texture
  // is white, and its normals are made anew: neither changes a colour.
  const std::uint16_t white[] = {65535, 65535, 65535, 65535};
  scene.textures = {makeTexture(1, 1, white)};
  scene.materials = {
      {.diffuse = glm::vec3(0.5f), .specular = glm::vec3(0.25f), .shininess = 8, .diffuse_map{.texture = 0}}};
  scene.meshes = {makePrimitive({.kind = PrimitiveKind::kPlane}, 0)};
  scene.meshes[0].normals.clear();
  addNormals(scene);
  scene.objects = {{.object_to_world = {{2, 0, 0, 0}, {0, 0, 2, 0}, {0, -2, 0, 0}, {0, 0, -2, 1}}}};
  const Image mesh = render(device, scene, settings).image;

  // The light that arrives at its texels.
  const Image map = bakeLight(device, scene, 0, {.irradiance = true}, settings).image;
  float map_error = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec3 place((x + 0.5) * 2 / kSide - 1, (y + 0.5) * 2 / kSide - 1, 2);
      const double light = 6 * 2 / std::sqrt(glm::dot(place, place));
      for (int i = 0; i < 3; ++i)
        map_error = std::max(map_error, std::abs(map.pixels[3 * (y * kSide + x) + i] - float(light)));
    }

  const float triangle_error = errorOf(triangle, [](int x, int y) { return x <= y; });
  const float mesh_error = errorOf(mesh, [](int x, int y) { return x >= 8 && x < 24 && y >= 8 && y < 24; });
  const std::size_t middle = 3 * (16 * kSide + 16);
  std::printf("triangle %.6f, error %.1e; mesh %.6f, error %.1e; map %.6f, error %.1e\n",
              triangle.pixels[middle], triangle_error, mesh.pixels[middle], mesh_error, map.pixels[middle],
              map_error);
  // A float's half ulp is u = 2⁻²⁴ of it. Position, distance and cosine each take fewer than 8 roundings; the
  // lobe's power of 8 has 8 times the relative error of its base, and exp2 and log2 (kernels/math.clh) add
  // 2⁻²². Colours are at most 4.5, the map's at most 6.
  constexpr double kUnit = 1.0 / (1 << 24);
  return triangle_error <= 4.5 * 128 * kUnit && mesh_error <= 4.5 * 128 * kUnit &&
                 map_error <= 6 * 128 * kUnit
             ? 0
             : 1;
}
