#include "reference/reference.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>

#include "gbuffer/packed_normal.hpp"
#include "gbuffer/tangent_plane.hpp"
#include "gbuffer/validate_gbuffer.hpp"
#include "luciole/error.hpp"
#include "luciole/validate_scene.hpp"
#include "reference/model_truth.hpp"
#include "reference/models.hpp"

namespace luciole {
namespace {

/// A light as it arrives at a point: its direction and the share of its colours, before shadows.
struct Incoming {
  glm::dvec3 to_light{0.0};  ///< unit; zero at the light's own place
  double share = 1.0;
};

double rangeWindow(const Light& light, double distance) {
  const double fade = 1 - std::pow(distance / light.range, 4);
  return light.window == RangeWindow::kSmooth ? fade * fade : fade;
}

double attenuation(const Light& light, double distance) {
  const glm::dvec3 k(light.attenuation);
  // Finite where the polynomial is 0.
  return 1 / std::max(k.x + k.y * distance + k.z * distance * distance, std::exp2(-100.0));
}

/// cosine: of the angle between the spot's axis and the way from it to the point.
double spotEffect(const Light& light, double cosine) {
  const double edge = std::cos(light.cutoff);
  if (cosine < edge) return 0;
  if (light.falloff == SpotFalloff::kExponent) return std::pow(std::max(cosine, 0.0), double(light.exponent));
  const double width = std::cos(light.inner_cone) - edge;
  if (width <= 0) return 1;
  const double ramp = std::min((cosine - edge) / width, 1.0);
  return ramp * ramp;
}

/// The entry of a table's axis at or before an angle, and how far it is from there to the next.
std::pair<std::size_t, double> entryAt(const std::vector<double>& angles, double angle) {
  const auto next = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
  const auto i = std::size_t(next - angles.begin()) - 1;
  return {i, std::clamp((angle - angles[i]) / (angles[i + 1] - angles[i]), 0.0, 1.0)};
}

/// A profile's light in a unit direction, over its peak. axis: unit, the way that the luminaire shines.
double profileShare(const Luminaire& luminaire, const glm::dvec3& axis, const glm::dvec3& direction) {
  const LightProfile& profile = *luminaire.profile;
  glm::dvec3 up = glm::cross(axis, glm::cross(unitOrZero(luminaire.up), axis));
  if (glm::length(up) < 1e-6)
    up = glm::cross(axis,
                    glm::cross(std::abs(axis.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), axis));
  up = unitOrZero(up);
  const double ahead = glm::dot(direction, axis), upwards = glm::dot(direction, up),
               right = glm::dot(direction, glm::cross(axis, up));
  double polar = 0, azimuth = 0;
  switch (profile.type) {
    case PhotometricType::kC:  // γ and C
      polar = std::atan2(std::hypot(upwards, right), ahead);
      azimuth = std::atan2(-right, upwards);
      break;
    case PhotometricType::kA:  // a right angle less V, and H
      polar = std::atan2(std::hypot(ahead, right), upwards);
      azimuth = std::atan2(right, ahead);
      break;
    case PhotometricType::kB:  // a right angle less H, and V
      polar = std::atan2(std::hypot(ahead, upwards), right);
      azimuth = std::atan2(upwards, ahead);
      break;
  }
  // What rounding puts outside counts as inside.
  constexpr double kTurn = 2 * std::numbers::pi, kSlack = 1e-7;
  if (azimuth < profile.azimuth.front() - kSlack) azimuth += kTurn;
  if (polar < profile.polar.front() - kSlack || polar > profile.polar.back() + kSlack ||
      azimuth > profile.azimuth.back() + kSlack || !(profile.peak > 0))
    return 0;
  const auto [i, below] = entryAt(profile.polar, polar);
  const auto [j, beside] = entryAt(profile.azimuth, azimuth);
  const auto row = [&, j = j, beside = beside](std::size_t at) {
    const float* entry = &profile.candela[at * profile.azimuth.size() + j];
    return (1 - beside) * double(entry[0]) + beside * double(entry[1]);
  };
  return ((1 - below) * row(i) + below * row(i + 1)) / profile.peak;
}

Incoming incomingLight(const Scene& scene, const Light& light, const glm::dvec3& position) {
  if (light.kind == LightKind::kDirectional) return {unitOrZero(-light.direction), 1.0};
  const glm::dvec3 to_light_center = light.position - position;
  const double distance = glm::length(to_light_center);
  if (distance >= light.range) return {unitOrZero(to_light_center), 0.0};
  Incoming incoming{unitOrZero(to_light_center), attenuation(light, distance) * rangeWindow(light, distance)};
  if (light.kind == LightKind::kSpot)
    incoming.share *= spotEffect(light, glm::dot(-incoming.to_light, unitOrZero(light.direction)));
  if (light.luminaire >= 0)
    incoming.share *= profileShare(scene.luminaires[std::size_t(light.luminaire)],
                                   unitOrZero(light.direction), -incoming.to_light);
  return incoming;
}

glm::dvec3 eyePosition(const Camera& camera) { return glm::dvec3(camera.camera_to_world[3]); }
glm::dvec3 backward(const Camera& camera) { return glm::dvec3(camera.camera_to_world[2]); }

/// Share of the surface's colour that gets through the fog.
double fogShare(const Fog& fog, double density, double distance) {
  double share = 1;
  switch (fog.mode) {
    case FogMode::kNone:
      return 1;
    case FogMode::kLinear:
      share = (fog.end - distance) / (double(fog.end) - fog.start);
      break;
    case FogMode::kExp:
      share = std::exp(-density * distance);
      break;
    case FogMode::kExp2:
      share = std::exp(-density * distance * density * distance);
      break;
  }
  // If linear fog starts and ends at the same distance, the share there is 0/0. It counts as 0.
  return share > 0 ? std::min(share, 1.0) : 0.0;
}

/// Reads three planes of a group at one place; zero where the group is absent.
glm::dvec3 triple(const Plane& group, std::size_t stride, std::size_t place) {
  if (group.empty()) return glm::dvec3(0.0);
  return {group[place], group[place + stride], group[place + 2 * stride]};
}

/// A hash of the pixel's place in the whole picture, so that the rays' pattern differs from pixel to pixel.
std::uint32_t pixelSeed(const glm::ivec2& pixel) {
  std::uint32_t bits = std::uint32_t(pixel.x) * 0x9e3779b1u ^ std::uint32_t(pixel.y) * 0x85ebca6bu;
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
  return bits ^ bits >> 13;
}

/// What a pixel of a G-buffer shows.
struct ShownPoint {
  SurfacePoint point;
  Model model = Model::kPhong;
  Visibility visibility;
};

/// Nothing for the background. `scene` and the settings' rays must outlive the result.
std::optional<ShownPoint> shownPoint(const GBuffer& gbuffer, const glm::ivec2& pixel,
                                     const ReferenceSettings& settings) {
  const std::size_t stride = gbuffer.pixels(), place = gbuffer.index(pixel.x, pixel.y);
  const glm::dvec3 view_position = triple(gbuffer.position, stride, place);
  if (!std::isfinite(view_position.z)) return std::nullopt;
  const glm::dmat4& to_world = gbuffer.camera.camera_to_world;
  ShownPoint shown;
  SurfacePoint& point = shown.point;
  point.position = glm::dvec3(to_world * glm::dvec4(view_position, 1));
  point.normal = glm::dmat3(to_world) * triple(gbuffer.normal, stride, place);
  if (!gbuffer.unbent_normal.empty())
    point.unbent_normal = glm::dmat3(to_world) * unpackNormal(gbuffer.unbent_normal[place]);
  point.diffuse = triple(gbuffer.diffuse, stride, place);
  point.specular = triple(gbuffer.specular, stride, place);
  point.ambient = triple(gbuffer.ambient, stride, place);
  point.emission = triple(gbuffer.emission, stride, place);
  point.shininess = gbuffer.specular.empty() ? 0.0 : double(gbuffer.specular[place + 3 * stride]);
  // As the rounded direction lies in the surface, and without a plane around the upright axis.
  const glm::dmat3 to_view = glm::transpose(glm::dmat3(to_world));
  const glm::dvec3 along = gbuffer.tangent.empty() ? glm::dvec3(0.0) : unpackNormal(gbuffer.tangent[place]);
  point.tangent =
      glm::dmat3(to_world) * unitOrZero(tangentOf(along, unitOrZero(to_view * point.normal), to_view));
  const std::uint32_t seed = pixelSeed(pixel + gbuffer.crop_origin);
  // Shadow rays start on the smooth surface above the facet (Hanika 2021, see raster/lift.hpp).
  glm::dvec3 start = point.position;
  if (!gbuffer.lift.empty()) start += double(gbuffer.lift[place]) * unitOrZero(point.normal);
  if (settings.shadow_rays)
    shown.visibility = [&settings, start, seed](const Light& light) {
      return lightVisibility(*settings.shadow_rays, light, start, settings.shadow_samples, seed);
    };
  shown.model = modelOfNumber(gbuffer.model.empty() ? 0 : gbuffer.model[place], settings.model);
  return shown;
}

}  // namespace

/// The sine of the angle by which a packed normal may be off, with some to spare: a light that is so little
/// behind a surface counts as before it, as in kernels/shade/shading.clh.
static constexpr double kPackedNormalMargin = 0x1p-13;

/// Calls take(LightTerm) for each light that reaches the point, in the scene's order.
// The lighting equation of OpenGL 1.x (The OpenGL Graphics System: A Specification, section "Lighting") with
// a local viewer. Its highlight is replaced by Phong's, or by another model's.
template <class Take>
static void eachLightTerm(const Scene& scene, const Camera& camera, const SurfacePoint& point, Model model,
                          const Visibility& visibility, UserReflections& user, const Take& take) {
  // Normalized again in double: an exponent of 10⁶ turns an error in a float's last bit into one of 10 %.
  const glm::dvec3 normal = unitOrZero(point.normal);
  const glm::dvec3 to_eye =
      unitOrZero(camera.orthographic ? backward(camera) : eyePosition(camera) - point.position);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const Incoming incoming = incomingLight(scene, light, point.position);
    if (incoming.share == 0) continue;
    LightTerm term;
    term.light = i;
    term.falloff = incoming.share;
    term.ambient = glm::dvec3(light.ambient) * point.ambient;
    term.n_dot_l = glm::dot(normal, incoming.to_light);
    const bool behind = glm::dot(point.unbent_normal, incoming.to_light) <= -kPackedNormalMargin;
    const bool faces = term.n_dot_l > 0 && !behind;
    term.visibility = !faces ? 0.0 : light.shadow && visibility ? visibility(light) : 1.0;
    const double cell = double(light.cell) * incoming.share;
    Reflected by_user;
    if (faces && isUserModel(model)) {
      const glm::dmat3 to_view = glm::transpose(glm::dmat3(camera.camera_to_world));
      by_user = user.next(
          model, {to_view * normal, to_view * incoming.to_light, to_view * to_eye, to_view * point.tangent,
                  point.diffuse, point.specular, std::min(point.shininess, 2 / cell)});
    }
    if (term.visibility > 0) {
      const auto [diffuse, specular] = isUserModel(model)
                                           ? by_user
                                           : reflectedLight(model, {normal, incoming.to_light, to_eye},
                                                            point.specular, point.shininess, cell);
      term.diffuse = glm::dvec3(light.diffuse) * point.diffuse * (diffuse * term.visibility);
      term.specular = glm::dvec3(light.specular) * specular * term.visibility;
    }
    take(term);
  }
}

/// What leaves the point without any light's help.
static glm::dvec3 ownRadiance(const Scene& scene, const SurfacePoint& point) {
  return scene.lighting ? point.emission + glm::dvec3(scene.ambient) * point.ambient
                        : point.emission + point.diffuse;
}

static glm::dvec3 radianceOf(const Scene& scene, const Camera& camera, const SurfacePoint& point, Model model,
                             const Visibility& visibility, UserReflections& user) {
  glm::dvec3 radiance = ownRadiance(scene, point);
  if (scene.lighting)
    eachLightTerm(scene, camera, point, model, visibility, user,
                  [&](const LightTerm& term) { radiance += term.sum(); });
  return radiance;
}

glm::dvec3 referenceRadiance(const Scene& scene, const Camera& camera, const SurfacePoint& point, Model model,
                             const Visibility& visibility) {
  return withUserReflections(scene, [&](UserReflections& user, bool is_asking) {
    return radianceOf(scene, camera, point, model, is_asking ? Visibility() : visibility, user);
  });
}

/// A level of a sky at a place in turns around and half turns down, as weights of all texels nearby: each
/// texel reaches to its neighbours' middles.
static glm::dvec3 skyLevelAt(const SkyLevel& level, double around, double down) {
  const double column = around * level.width, row = down * level.height;
  glm::dvec3 sum(0.0);
  for (int y = int(std::floor(row)) - 1; y <= int(std::floor(row)) + 1; ++y)
    for (int x = int(std::floor(column)) - 1; x <= int(std::floor(column)) + 1; ++x) {
      const double weight =
          std::max(0.0, 1 - std::abs(x + 0.5 - column)) * std::max(0.0, 1 - std::abs(y + 0.5 - row));
      const int inside_x = ((x % level.width) + level.width) % level.width;
      const int inside_y = std::clamp(y, 0, level.height - 1);
      const std::size_t texel =
          3 * (std::size_t(inside_y) * std::size_t(level.width) + std::size_t(inside_x));
      for (int c = 0; c < 3; ++c) sum[c] += weight * level.texels[texel + std::size_t(c)];
    }
  return sum;
}

/// What a pixel shows of an environment.
static glm::dvec3 skySeenBy(const LightSource& sky, const GBuffer& gbuffer, const glm::ivec2& pixel) {
  const Camera& camera = gbuffer.camera;
  const glm::dvec2 size(gbuffer.picture_size);
  const double up = std::tan(camera.fov_y / 2);
  const double across = up * camera.pixel_aspect * double(gbuffer.display.pixel_aspect) * size.x / size.y;
  const auto ray = [&](double x, double y) {
    if (camera.orthographic) return -glm::dvec3(camera.camera_to_world[2]);
    const glm::dvec2 screen(2 * (pixel.x + gbuffer.crop_origin.x + x) / size.x - 1,
                            1 - 2 * (pixel.y + gbuffer.crop_origin.y + y) / size.y);
    const glm::dvec3 way((screen.x - camera.shift.x) * across, (screen.y - camera.shift.y) * up, -1);
    return glm::dmat3(camera.camera_to_world) * glm::normalize(way);
  };
  const glm::dvec3 middle = ray(0.5, 0.5);
  const double width = std::max(glm::length(ray(1.5, 0.5) - middle), glm::length(ray(0.5, 1.5) - middle));
  // Turning the sky counter-clockwise moves what is seen the other way.
  const double longitude = std::atan2(middle.x, -middle.z) + sky.rotate;
  const double latitude = std::atan2(middle.y, std::hypot(middle.x, middle.z));
  const double pi = std::acos(-1.0);
  const std::vector<SkyLevel>& levels = sky.sky->levels;
  const double texels = std::max(width * levels[0].width / (2 * pi * std::max(std::cos(latitude), 1e-9)),
                                 width * levels[0].height / pi);
  const double level = std::min(std::max(0.0, std::log2(texels)), double(levels.size()) - 1);
  const std::size_t finer = std::min(std::size_t(level), levels.size() - 1);
  const double turns = 0.5 + longitude / (2 * pi), around = turns - std::floor(turns);
  const double down = 0.5 - latitude / pi;
  glm::dvec3 color = skyLevelAt(levels[finer], around, down) * (1 - (level - double(finer)));
  if (finer + 1 < levels.size())
    color += skyLevelAt(levels[finer + 1], around, down) * (level - double(finer));
  return color * glm::dvec3(sky.radiance);
}

static glm::dvec3 shadePixel(const Scene& scene, const GBuffer& gbuffer, const glm::ivec2& pixel,
                             const ReferenceSettings& settings, UserReflections& user, bool is_asking) {
  const std::optional<ShownPoint> shown = shownPoint(gbuffer, pixel, settings);
  if (!shown) {
    const LightSource* sky = environmentOf(scene);
    return sky ? skySeenBy(*sky, gbuffer, pixel) : glm::dvec3(scene.background);
  }
  const glm::dvec3 radiance = radianceOf(scene, gbuffer.camera, shown->point, shown->model,
                                         is_asking ? Visibility() : shown->visibility, user);
  return settings.fog ? referenceFog(scene.fog, gbuffer.camera, shown->point.position, radiance) : radiance;
}

std::optional<PixelTerms> referenceTerms(const Scene& scene, const GBuffer& gbuffer, const glm::ivec2& pixel,
                                         const ReferenceSettings& settings) {
  std::vector<LightTerm> lights;
  std::optional<PixelTerms> terms =
      referenceTerms(scene, gbuffer, pixel, settings, [&](const LightTerm& term) { lights.push_back(term); });
  if (terms) terms->lights = std::move(lights);
  return terms;
}

std::optional<PixelTerms> referenceTerms(const Scene& scene, const GBuffer& gbuffer, const glm::ivec2& pixel,
                                         const ReferenceSettings& settings,
                                         const std::function<void(const LightTerm&)>& take) {
  const std::optional<ShownPoint> shown = shownPoint(gbuffer, pixel, settings);
  if (!shown) return std::nullopt;
  PixelTerms terms;
  terms.point = shown->point;
  terms.model = shown->model;
  terms.own = ownRadiance(scene, terms.point) - terms.point.emission;
  glm::dvec3 radiance = ownRadiance(scene, terms.point);
  withUserReflections(scene, [&](UserReflections& user, bool is_asking) {
    if (!scene.lighting) return;
    eachLightTerm(scene, gbuffer.camera, terms.point, terms.model,
                  is_asking ? Visibility() : shown->visibility, user, [&](const LightTerm& term) {
                    if (is_asking) return;
                    radiance += term.sum();
                    take(term);
                  });
  });
  terms.fog_share = referenceFog(
      {scene.fog.mode, scene.fog.radial, scene.fog.density, scene.fog.start, scene.fog.end, glm::vec3(0.0f)},
      gbuffer.camera, terms.point.position, glm::dvec3(1.0));
  terms.color = referenceFog(scene.fog, gbuffer.camera, terms.point.position, radiance);
  return terms;
}

glm::dvec3 referenceFog(const Fog& fog, const Camera& camera, const glm::dvec3& position,
                        const glm::dvec3& radiance) {
  const glm::dvec3 from_eye = position - eyePosition(camera);
  const double distance = fog.radial ? glm::length(from_eye) : -glm::dot(from_eye, backward(camera));
  glm::dvec3 seen;
  for (int c = 0; c < 3; ++c) {
    const double share = fogShare(fog, fog.density[c], distance);
    seen[c] = share * radiance[c] + (1 - share) * fog.color[c];
  }
  return seen;
}

std::vector<glm::ivec2> allPixels(const glm::ivec2& size) {
  std::vector<glm::ivec2> pixels;
  pixels.reserve(std::size_t(size.x) * size.y);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) pixels.emplace_back(x, y);
  return pixels;
}

std::vector<glm::dvec3> referencePixels(const Scene& scene, const GBuffer& gbuffer,
                                        std::span<const glm::ivec2> pixels,
                                        const ReferenceSettings& settings) {
  validateScene(scene);
  if (settings.shadow_samples < 1)
    throw InputError(
        fmt::format("settings.shadow_samples: {}, expected at least 1", settings.shadow_samples));
  for (const glm::ivec2& pixel : pixels)
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= gbuffer.width || pixel.y >= gbuffer.height)
      throw InputError(fmt::format("pixels: ({}, {}) is not inside the G-buffer of {}x{}", pixel.x, pixel.y,
                                   gbuffer.width, gbuffer.height));
  std::vector<glm::dvec3> colors(pixels.size());
  std::size_t done = 0;
  std::mutex progress;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 256), [&](const auto& range) {
    // Models from files are asked for the lights of some pixels at once.
    const std::size_t together = std::max<std::size_t>(1, (1 << 18) / (scene.lights.size() + 1));
    for (std::size_t first = range.begin(); first < range.end(); first += together) {
      const std::size_t end = std::min(first + together, range.end());
      withUserReflections(scene, [&](UserReflections& user, bool is_asking) {
        for (std::size_t i = first; i < end; ++i)
          colors[i] = shadePixel(scene, gbuffer, pixels[i], settings, user, is_asking);
      });
    }
    if (!settings.on_progress) return;
    const std::lock_guard lock(progress);
    done += range.size();
    settings.on_progress(done, pixels.size());
  });
  return colors;
}

float pictureValue(double channel) {
  return static_cast<float>(std::min(channel, double(std::numeric_limits<float>::max())));
}

Image referenceShade(const Scene& scene, const GBuffer& gbuffer, const ReferenceSettings& settings) {
  validateGBuffer(gbuffer);
  const std::vector<glm::ivec2> pixels = allPixels({gbuffer.width, gbuffer.height});
  Image image{gbuffer.width, gbuffer.height, {"R", "G", "B"}, {}};
  for (const glm::dvec3& color : referencePixels(scene, gbuffer, pixels, settings))
    for (int c = 0; c < 3; ++c) image.pixels.push_back(pictureValue(color[c]));
  return image;
}

}  // namespace luciole
