#include "tools/cli/probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "luciole/error.hpp"
#include "raster/view.hpp"
#include "reference/reference.hpp"
#include "reference/reference_picture.hpp"
#include "tools/figures/text_table.hpp"

namespace luciole {
namespace {

/// Lights that get a line of their own.
constexpr std::size_t kMostLines = 20;

constexpr std::array kLightKindNames{"point", "directional", "spot"};

std::string shown(const glm::dvec3& v) { return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z); }

/// A float's nine digits tell its bits.
std::string exactly(const glm::vec3& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z); }

double brightness(const LightTerm& term) {
  const glm::dvec3 sum = term.sum();
  return std::max({sum.x, sum.y, sum.z});
}

/// What arrives at the point, as Aov::kIlluminance has it.
double luxAt(const Scene& scene, const PixelTerms& terms) {
  double lux = 0;
  for (const LightTerm& term : terms.lights) {
    const glm::vec3& color = scene.lights[term.light].diffuse;
    lux += luxOfColor(scene.lights[term.light]) * term.falloff * term.visibility *
           std::max(term.n_dot_l, 0.0) * (0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b);
  }
  return lux;
}

/// A line for each light, with the sum so far.
std::string lightTable(const Scene& scene, const PixelTerms& terms) {
  std::vector<LightTerm> lights = terms.lights;
  std::stable_sort(lights.begin(), lights.end(),
                   [](const LightTerm& a, const LightTerm& b) { return brightness(a) > brightness(b); });
  std::vector<std::vector<std::string>> lines{{"light", "kind", "metres", "N.L", "falloff", "visible",
                                               "ambient", "diffuse", "specular", "sum so far"}};
  const auto addOther = [&](const std::string& name, const glm::dvec3& sum) {
    lines.push_back({name, "", "", "", "", "", "", "", "", shown(sum)});
  };
  glm::dvec3 sum = terms.point.emission;
  addOther("emission", sum);
  sum += terms.own;
  addOther(scene.lighting ? "ambient light" : "diffuse colour, unlit", sum);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const LightTerm& term = lights[i];
    sum += term.sum();
    if (i >= kMostLines) continue;
    const Light& light = scene.lights[term.light];
    const bool has_place = light.kind != LightKind::kDirectional;
    lines.push_back(
        {fmt::format("{} {}", term.light, scene.light_groups[light.group]),
         kLightKindNames[std::size_t(light.kind)],
         has_place ? fmt::format("{:.5g}", glm::distance(light.position, terms.point.position)) : "",
         fmt::format("{:.5g}", term.n_dot_l), fmt::format("{:.5g}", term.falloff),
         fmt::format("{:.5g}", term.visibility), shown(term.ambient * term.falloff),
         shown(term.diffuse * term.falloff), shown(term.specular * term.falloff), shown(sum)});
  }
  if (lights.size() > kMostLines) addOther(fmt::format("{} dimmer", lights.size() - kMostLines), sum);
  return textTable(lines);
}

std::string surfaceText(const Scene& scene, const PixelTerms& terms, const Camera& camera) {
  const SurfacePoint& point = terms.point;
  return fmt::format(
      "surface: at {}, {:.5g} m from the eye, normal {}\n"
      "material: {}, diffuse {}, specular {}, shininess {:.5g}\n"
      "lights: {} of {} reach it\n\n",
      shown(point.position), glm::distance(point.position, glm::dvec3(camera.camera_to_world[3])),
      shown(point.normal), modelName(terms.model), shown(point.diffuse), shown(point.specular),
      point.shininess, terms.lights.size(), scene.lights.size());
}

}  // namespace

std::string probeText(OpenedDevice& device, const Scene& scene, RenderSettings settings,
                      const glm::ivec2& pixel) {
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= settings.size.x || pixel.y >= settings.size.y)
    throw InputError(fmt::format("--probe {},{}: the picture has {}x{} pixels, from 0,0 on", pixel.x, pixel.y,
                                 settings.size.x, settings.size.y));
  if (settings.shading == Shading::kGouraud)
    throw InputError("--probe: with --shading gouraud lights shine on vertices, and on no pixel");
  settings.crop = Crop{pixel.x, pixel.y, 1, 1};
  settings.aovs.clear();
  settings.light_groups = false;
  settings.on_pass = {};
  Stats ignored;
  const Image picture = renderScene(device, scene, settings, ignored);
  const glm::vec3 made(picture.pixels[0], picture.pixels[1], picture.pixels[2]);

  const bool has_shadows = settings.shade.shadows != ShadowMethod::kOff;
  const std::optional<RayScene> rays =
      has_shadows ? std::optional(buildShadowRays(scene, glm::dvec3(settings.camera.camera_to_world[3])))
                  : std::nullopt;
  const ReferenceSettings by_rays{.model = settings.shade.model, .shadow_rays = rays ? &*rays : nullptr};
  const GBuffer gbuffer = rasterizeScene(&device, scene, settings, ignored);
  const std::optional<PixelTerms> terms = referenceTerms(scene, gbuffer, {0, 0}, by_rays);
  std::string text =
      fmt::format("pixel {},{} of {}x{}\n", pixel.x, pixel.y, settings.size.x, settings.size.y);
  glm::dvec3 color(scene.background);
  if (terms) {
    text += surfaceText(scene, *terms, settings.camera) + lightTable(scene, *terms) + "\n";
    text += fmt::format("illuminance: {:.6g} lux, if lights' colours are candela\n", luxAt(scene, *terms));
    if (scene.fog.mode != FogMode::kNone)
      text += fmt::format("fog: {} of that gets through, and the rest is {}\n", shown(terms->fog_share),
                          shown(scene.fog.color));
    color = terms->color;
  } else {
    text += "surface: none, the background\n";
  }
  if (settings.samples > 1) {
    const View view = cameraView(settings.camera, settings.size, settings.crop);
    const glm::ivec2 only[1] = {{0, 0}};
    color = referencePicture(scene, view, settings.shading, settings.samples, only, by_rays).front();
    text += fmt::format("that was the pixel's middle; below is the mean of {} samples\n", settings.samples);
  }
  if (settings.exposure != 0) text += fmt::format("exposure: times 2^{}\n", settings.exposure);
  color *= std::exp2(double(settings.exposure));
  return text + fmt::format("reference: {}\npicture: {}\ndifference: {}\n", exactly(glm::vec3(color)),
                            exactly(made), shown(glm::dvec3(made) - color));
}

}  // namespace luciole
