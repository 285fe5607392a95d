#include "tools/cli/profile_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "image/side_by_side.hpp"
#include "luciole/primitives.hpp"
#include "reference/reference.hpp"
#include "render/render.hpp"
#include "tools/cli/commands.hpp"

namespace luciole {
namespace {

constexpr int kSide = 480;      ///< pixels of each picture
constexpr double kReach = 0.9;  ///< of the peak, from the middle to the border

/// A lamp at the origin that shines down, C 0 towards +x, as bright as its file says.
Scene lampAlone(std::shared_ptr<const LightProfile> profile) {
  Scene scene;
  Light lamp;
  lamp.direction = {0, -1, 0};
  lamp.attenuation = {0, 0, 1};
  lamp.diffuse = lamp.specular = glm::vec3(float(profile->peak));
  lamp.luminaire = 0;
  scene.luminaires = {{std::move(profile), {1, 0, 0}}};
  scene.lights = {lamp};
  return scene;
}

/// Candela in a direction, unit: the light on a white surface 1 m away.
double candelaIn(const Scene& lamp, const glm::dvec3& direction) {
  SurfacePoint point;
  point.position = direction;
  point.normal = -direction;
  point.diffuse = glm::dvec3(1);
  return referenceRadiance(lamp, {}, point, Model::kPhong).g;
}

Image polarCurve(const Scene& lamp) {
  const double peak = std::max(lamp.luminaires[0].profile->peak, 1e-30);
  Image image{.width = kSide, .height = kSide, .channels = {"R", "G", "B"}};
  image.pixels.resize(std::size_t(kSide) * kSide * 3);
  const auto covered = [](double inside) { return std::clamp(inside * kSide / 2 + 0.5, 0.0, 1.0); };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec2 at((x + 0.5) / kSide * 2 - 1, 1 - (y + 0.5) / kSide * 2);
      const double radius = std::max(glm::length(at), 1e-9);
      const glm::dvec2 way = at / radius;
      const double filled = kReach * candelaIn(lamp, {way.x, way.y, 0}) / peak;
      const double line = kReach * candelaIn(lamp, {0, way.y, way.x}) / peak;
      glm::dvec3 color(1.0);
      // Circles of quarters of the peak, and a ray each 30 degrees.
      const double circle = std::abs(radius * 4 / kReach - std::round(radius * 4 / kReach)) * kReach / 4;
      const double turn = std::atan2(at.x, at.y) / glm::radians(30.0);
      const double ray = std::abs(turn - std::round(turn)) * glm::radians(30.0) * radius;
      if (radius < kReach + 2.0 / kSide)
        color = glm::mix(color, glm::dvec3(0.6), covered(1.0 / kSide - std::min(circle, ray)));
      color = glm::mix(color, glm::dvec3(1.0, 0.55, 0.08), 0.75 * covered(filled - radius));
      color = glm::mix(color, glm::dvec3(0.05, 0.15, 0.6), covered(3.0 / kSide - std::abs(line - radius)));
      for (int c = 0; c < 3; ++c) image.pixels[3 * (std::size_t(y) * kSide + x) + c] = float(color[c]);
    }
  return image;
}

/// The lamp's light on a wall behind it, as bright as the picture can show.
Image wallPicture(OpenedDevice& device, Scene scene) {
  Material white;
  white.diffuse = glm::vec3(1.0f);
  scene.materials = {white};
  scene.meshes = {makePrimitive({.kind = PrimitiveKind::kPlane}, 0)};
  glm::dmat4 place = glm::translate(glm::dmat4(1.0), {0, -1.2, -0.5});
  place = glm::scale(glm::rotate(place, glm::radians(90.0), {1, 0, 0}), glm::dvec3(8));
  scene.objects = {{0, place}};
  RenderSettings settings;
  settings.size = {kSide, kSide};
  settings.camera.orthographic = true;
  settings.camera.half_height = 2;
  settings.camera.camera_to_world[3] = {0, -1.2, 3, 1};
  settings.shade.shadows = ShadowMethod::kOff;
  Stats ignored;
  Image image = renderScene(device, scene, settings, ignored);
  const float most = *std::max_element(image.pixels.begin(), image.pixels.end());
  for (float& value : image.pixels) value = most > 0 ? value / most : 0.0f;
  return image;
}

}  // namespace

bool isProfile(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return equalIgnoringCase(extension, ".ies") || equalIgnoringCase(extension, ".ldt");
}

Image profilePicture(OpenedDevice& device, const std::string& path) {
  std::vector<Warning> warnings;
  const std::shared_ptr<const LightProfile> profile = readLightProfile(path, warnings);
  reportWarnings(warnings);
  const Scene lamp = lampAlone(profile);
  return labelledSheet({polarCurve(lamp), wallPicture(device, lamp)},
                       {fmt::format("C 0-180 filled, C 90-270: up to {:.4g} cd", profile->peak),
                        fmt::format("4 m of a wall 0.5 m behind it: {:.4g} lm", profile->lumens)},
                       {fmt::format("{:.4g} cd", profile->peak), fmt::format("{:.4g} lm", profile->lumens)},
                       2);
}

}  // namespace luciole
