// Lights the planes of a G-buffer that a program fills itself: a triangle, in view space, metres.
#include <cstdio>
#include <luciole/planes.hpp>
#include <luciole/render.hpp>

int main() {
  constexpr int kSide = 32;  // pixels
  luciole::Device device = luciole::Device::open();

  luciole::GBuffer gbuffer{.width = kSide, .height = kSide};
  gbuffer.tiles_x = gbuffer.tiles_y = kSide / luciole::GBuffer::kTileSide;
  gbuffer.camera.fov_y = 1.5707963267948966;
  gbuffer.picture_size = {kSide, kSide};
  luciole::allocatePlanes({}, gbuffer);  // they show nothing
  const std::size_t stride = gbuffer.pixels();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x <= y; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      // 2 m ahead, where 90 degrees span 4 m.
      luciole::storePixel({(x + 0.5f) / 8 - 2, 2 - (y + 0.5f) / 8, -2}, place, stride, gbuffer.position);
      luciole::storePixel({0, 0, 1}, place, stride, gbuffer.normal);
      luciole::storePixel(glm::vec3(0.5f), place, stride, gbuffer.diffuse);
    }

  luciole::Scene scene;
  scene.lights = {{.diffuse = glm::vec3(6)}};  // at the eye
  const luciole::Picture picture = luciole::shade(device, scene, gbuffer, {});
  std::printf("red in the middle: %.3f\n", picture.image.pixels[3 * (16 * kSide + 16)]);
}
