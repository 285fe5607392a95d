#include "luciole/validate_scene.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/picture_size.hpp"
#include "base/text_file.hpp"
#include "base/trace.hpp"
#include "luciole/error.hpp"
#include "scene/check_vertices.hpp"
#include "scene/models.hpp"
#include "scene/place_limits.hpp"
#include "scene/posing.hpp"
#include "scene/source_fault.hpp"

namespace luciole {
namespace {

constexpr std::size_t kNowhere = std::size_t(-1);

/// How far products of a camera's axes may be from 0 and 1, and angles beyond their range: what rounding to
/// floats does, tenfold.
constexpr double kUnitError = 1e-6;

// What is wrong with something is a text that begins with its field, "range: -1, expected …"; "" is nothing.

std::string wrong(const char* field, double value, const char* expected) {
  return fmt::format("{}: {}, expected {}", field, value, expected);
}

template <glm::length_t N, class T>
std::string wrong(const char* field, const glm::vec<N, T>& value, const char* expected) {
  std::string numbers;
  for (int i = 0; i < N; ++i) numbers += fmt::format("{}{}", i > 0 ? ", " : "", value[i]);
  return fmt::format("{}: ({}), expected {}", field, numbers, expected);
}

/// Of an index into `count` things; -1 is none.
std::string wrongIndex(const char* field, std::int64_t index, const char* things, std::size_t count) {
  return fmt::format("{}: {}, but the number of {} is {}", field, index, things, count);
}

bool isIndex(int index, std::size_t count) { return index >= 0 && std::size_t(index) < count; }
bool isIndexOrNone(int index, std::size_t count) { return index == -1 || isIndex(index, count); }

template <class Enum>
bool isOneOf(Enum value, Enum last) {
  return unsigned(value) <= unsigned(last);
}

template <glm::length_t N, class T>
bool areFinite(const glm::vec<N, T>& value) {
  bool all = true;
  for (int i = 0; i < N; ++i) all &= std::isfinite(value[i]);
  return all;
}

/// Throws what is wrong with a thing of the scene.
[[noreturn]] void fail(const Scene& scene, const std::string& place, const std::string& fault) {
  throw InputError(fmt::format("{}{}{}{}{}", forMessage(scene.name), scene.name.empty() ? "" : ": ", place,
                               place.empty() ? "" : ".", fault));
}

/// Throws what is wrong with the first thing of a list that has a fault. faultOf: of one, "" where it is
/// well.
template <class T, class FaultOf>
void checkAll(const Scene& scene, const char* list, const std::vector<T>& things, const FaultOf& faultOf) {
  using Range = tbb::blocked_range<std::size_t>;
  const std::size_t first = tbb::parallel_reduce(
      Range(0, things.size(), 256), kNowhere,
      [&](const Range& range, std::size_t found) {
        for (std::size_t i = range.begin(); i < range.end() && i < found; ++i)
          if (!faultOf(i).empty()) found = i;
        return found;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
  if (first != kNowhere) fail(scene, fmt::format("{}[{}]", list, first), faultOf(first));
}

/// The largest of some words, each with its bits beyond `mask` cleared.
std::uint32_t largestOf(std::span<const std::uint32_t> words, std::uint32_t mask) {
  using Range = tbb::blocked_range<std::size_t>;
  constexpr std::size_t kPart = 1 << 15;
  const auto ofRange = [&](const Range& range, std::uint32_t largest) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) largest = std::max(largest, words[i] & mask);
    return largest;
  };
  // Of the few a task would take longer.
  if (words.size() <= kPart) return ofRange(Range(0, words.size()), 0);
  return tbb::parallel_reduce(Range(0, words.size(), kPart), 0u, ofRange,
                              [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); });
}

/// The same of an array of vectors or numbers of 32 bits.
template <class T>
std::uint32_t largestOf(const std::vector<T>& values, std::uint32_t mask) {
  static_assert(sizeof(T) % 4 == 0);
  return largestOf({reinterpret_cast<const std::uint32_t*>(values.data()), values.size() * (sizeof(T) / 4)},
                   mask);
}

constexpr std::uint32_t kAllBits = 0xffffffff, kMagnitude = 0x7fffffff;

/// Magnitudes of floats are in the order of their bits, those of infinity and NaN above all others.
template <class T>
std::string magnitudeFault(const char* field, const std::vector<T>& values, float largest) {
  if (largestOf(values, kMagnitude) <= std::bit_cast<std::uint32_t>(largest)) return "";
  const auto at = std::find_if(values.begin(), values.end(), [&](const T& value) {
    for (int i = 0; i < T::length(); ++i)
      if (!(std::abs(value[i]) <= largest)) return true;
    return false;
  });
  const std::string place = fmt::format("{}[{}]", field, at - values.begin());
  return wrong(place.c_str(), *at, fmt::format("numbers up to {}", largest).c_str());
}

/// Of an array of indices below `count`.
std::string indexFault(const char* field, const std::vector<std::uint32_t>& indices, const char* things,
                       std::size_t count) {
  if (indices.empty() || largestOf(indices, kAllBits) < count) return "";
  const auto at = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= count; });
  return wrongIndex(fmt::format("{}[{}]", field, at - indices.begin()).c_str(), *at, things, count);
}

std::string sizeFault(const char* field, std::size_t size, std::size_t expected, const char* what) {
  return size == expected
             ? ""
             : fmt::format("{}: has {} elements, expected {}, as {}", field, size, expected, what);
}

/// The first text that isn't empty.
std::string firstOf(std::initializer_list<std::string> faults) {
  for (const std::string& fault : faults)
    if (!fault.empty()) return fault;
  return "";
}

/// Of an array that has an element for each vertex, or none.
template <class T>
std::string vertexFault(const char* field, const std::vector<T>& values, const Mesh& mesh) {
  if (values.empty()) return "";
  const std::string fault = sizeFault(field, values.size(), mesh.positions.size(), "positions");
  return fault.empty() ? magnitudeFault(field, values, std::numeric_limits<float>::max()) : fault;
}

std::string trianglesFault(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (mesh.triangles.empty() || largestOf(mesh.triangles, kAllBits) < count) return "";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      if (const std::uint32_t vertex = mesh.triangles[i][corner]; vertex >= count)
        return fmt::format("triangles[{}]: refers to vertex {}, but the mesh has {}", i, vertex, count);
  return "";
}

/// The largest magnitude of a mesh's coordinates, in its own space; infinite or NaN where one is.
float reachOf(const Mesh& mesh) { return std::bit_cast<float>(largestOf(mesh.positions, kMagnitude)); }

/// Of what a mesh has of its vertices beside positions and normals, and of who refers to them.
std::string verticesFault(const Mesh& mesh) {
  return firstOf(
      {vertexFault("uvs", mesh.uvs, mesh), vertexFault("emission_uvs", mesh.emission_uvs, mesh),
       vertexFault("tangents", mesh.tangents, mesh), vertexFault("normal_uvs", mesh.normal_uvs, mesh),
       vertexFault("colors", mesh.colors, mesh),
       mesh.lightmap_uvs.empty()  // any numbers, see lightMapUvs()
           ? ""
           : sizeFault("lightmap_uvs", mesh.lightmap_uvs.size(), mesh.positions.size(), "positions"),
       trianglesFault(mesh)});
}

/// reach: of the mesh.
std::string meshFault(const Scene& scene, const Mesh& mesh, float reach) {
  const std::size_t vertices = mesh.positions.size();
  if (std::string fault = firstOf(
          {reach <= float(kLargestNumber)
               ? ""
               : magnitudeFault("positions", mesh.positions, float(kLargestNumber)),
           sizeFault("normals", mesh.normals.size(), vertices, "positions"),
           vertexFault("normals", mesh.normals, mesh), verticesFault(mesh),
           sizeFault("triangle_materials", mesh.triangle_materials.size(), mesh.triangles.size(),
                     "triangles"),
           indexFault("triangle_materials", mesh.triangle_materials, "materials", scene.materials.size())});
      !fault.empty())
    return fault;
  const std::string fault = mesh.divided ? meshFault(scene, *mesh.divided, reachOf(*mesh.divided)) : "";
  return fault.empty() ? "" : "divided." + fault;
}

std::string textureFault(const Texture& texture) {
  if (!isOneOf(texture.kind, TextureKind::kBump)) return wrong("kind", int(texture.kind), "a TextureKind");
  if (texture.levels.empty()) return "levels: empty, expected the picture and its mip chain";
  for (std::size_t i = 0; i < texture.levels.size(); ++i) {
    const MipLevel& level = texture.levels[i];
    const std::string place = fmt::format("levels[{}]", i);
    if (level.width < 1 || level.height < 1)
      return wrong(place.c_str(), glm::ivec2(level.width, level.height),
                   "a width and a height of at least 1");
    if (i > 0) {
      const glm::ivec2 half(std::max(1, texture.levels[i - 1].width / 2),
                            std::max(1, texture.levels[i - 1].height / 2));
      if (level.width != half.x || level.height != half.y)
        return wrong(place.c_str(), glm::ivec2(level.width, level.height),
                     "half the size of the level before");
    }
    const std::size_t count = 4 * std::size_t(level.width) * std::size_t(level.height);
    if (level.texels.size() != count)
      return fmt::format("{}.texels: has {} elements, expected {}, 4 a texel", place, level.texels.size(),
                         count);
  }
  const MipLevel& last = texture.levels.back();
  return last.width == 1 && last.height == 1 ? "" : "levels: end before a level of 1x1 texels";
}

std::string mapFault(const Scene& scene, const char* field, const TextureUse& use, bool of_normals = false) {
  if (!isIndexOrNone(use.texture, scene.textures.size()))
    return wrongIndex(fmt::format("{}.texture", field).c_str(), use.texture, "textures",
                      scene.textures.size());
  if (!isOneOf(use.wrap_u, Wrap::kClampToEdge) || !isOneOf(use.wrap_v, Wrap::kClampToEdge))
    return fmt::format("{}: wraps as no Wrap says", field);
  if (!isOneOf(use.mips, Mips::kNone))
    return wrong(fmt::format("{}.mips", field).c_str(), int(use.mips), "a Mips");
  if (of_normals && use.texture >= 0 && scene.textures[std::size_t(use.texture)].kind == TextureKind::kColor)
    return fmt::format("{}.texture: {} is a texture of colours, expected one of normals", field, use.texture);
  return "";
}

std::string materialFault(const Scene& scene, const Material& material) {
  for (const auto& [field, color] : {std::pair("ambient", &material.ambient),
                                     {"diffuse", &material.diffuse},
                                     {"specular", &material.specular},
                                     {"emission", &material.emission}})
    if (!areFinite(*color)) return wrong(field, *color, "finite numbers");
  if (!(material.shininess >= 0 && std::isfinite(material.shininess)))
    return wrong("shininess", material.shininess, "at least 0");
  if (!(std::abs(material.normal_scale) <= kMostNormalScale))
    return wrong("normal_scale", material.normal_scale, "-1000 to 1000");
  if (!std::isfinite(material.alpha)) return wrong("alpha", material.alpha, "a finite number");
  if (!std::isfinite(material.alpha_cutoff))
    return wrong("alpha_cutoff", material.alpha_cutoff, "a finite number");
  if (material.model && std::size_t(*material.model) >= kNumberOfModels + scene.user_models.size())
    return wrong("model", int(*material.model), "a Model");
  if (material.facets && !areFinite(material.facets->f0))
    return wrong("facets.f0", material.facets->f0, "finite numbers");
  if (material.facets && !(material.facets->alpha > 0 && material.facets->alpha <= 1))
    return wrong("facets.alpha", material.facets->alpha, "above 0, up to 1");
  return firstOf({mapFault(scene, "diffuse_map", material.diffuse_map),
                  mapFault(scene, "emission_map", material.emission_map),
                  mapFault(scene, "normal_map", material.normal_map, true),
                  mapFault(scene, "alpha_map", material.alpha_map)});
}

std::string objectFault(const Scene& scene, const Object& object) {
  if (object.mesh >= scene.meshes.size())
    return wrongIndex("mesh", object.mesh, "meshes", scene.meshes.size());
  if (!isIndexOrNone(object.material, scene.materials.size()))
    return wrongIndex("material", object.material, "materials", scene.materials.size());
  return isFinite(object.object_to_world) ? "" : "object_to_world: has a number that isn't finite";
}

/// A bound for the world coordinates of an object whose mesh reaches so far.
double worldReach(const glm::dmat4& to_world, float reach) {
  glm::dvec3 most = glm::abs(glm::dvec3(to_world[3]));
  for (int i = 0; i < 3; ++i) most += glm::abs(glm::dvec3(to_world[i])) * double(reach);
  return std::max({most.x, most.y, most.z});
}

template <glm::length_t N>
bool areNegative(const glm::vec<N, float>& value) {
  return glm::any(glm::lessThan(value, glm::vec<N, float>(0)));
}

// Of lights and fog many numbers may be any: shading says what each gives, and it is finite
// (tests/pictures).

std::string luminaireFault(const Luminaire& luminaire) {
  if (!luminaire.profile) return "profile: is missing";
  if (!(glm::length(luminaire.up) > 0 && std::isfinite(glm::length(luminaire.up))))
    return "up: has no direction";
  const LightProfile& profile = *luminaire.profile;
  if (!isOneOf(profile.type, PhotometricType::kA))
    return wrong("profile.type", int(profile.type), "a PhotometricType");
  constexpr double kPi = 3.14159265358979324, kSlack = 1e-6;
  const auto ascends = [](const std::vector<double>& angles) {
    return angles.size() >= 2 && std::adjacent_find(angles.begin(), angles.end(), [](double a, double b) {
                                   return !(a < b);
                                 }) == angles.end();
  };
  const std::vector<double>&polar = profile.polar, &azimuth = profile.azimuth;
  if (!ascends(polar) || !(polar.front() >= -kSlack && polar.back() <= kPi + kSlack))
    return "profile.polar: expected two or more radians, ascending from 0 to pi";
  if (!ascends(azimuth) || !(azimuth.front() >= -kPi - kSlack && azimuth.front() <= kPi / 2 + kSlack &&
                             azimuth.back() - azimuth.front() <= 2 * kPi + kSlack))
    return "profile.azimuth: expected two or more radians, ascending over 2 pi at most";
  if (std::string fault = sizeFault("profile.candela", profile.candela.size(), polar.size() * azimuth.size(),
                                    "all pairs of the angles");
      !fault.empty())
    return fault;
  const auto wrong_one = std::find_if(profile.candela.begin(), profile.candela.end(), [&](float candela) {
    return !(candela >= 0 && double(candela) <= profile.peak);
  });
  if (wrong_one == profile.candela.end() && std::isfinite(profile.peak)) return "";
  return "profile.candela: expected numbers from 0 to its peak";
}

/// luminaires, groups: how many there are.
std::string lightFault(const Light& light, std::size_t luminaires, std::size_t groups) {
  if (!isIndexOrNone(light.luminaire, luminaires))
    return wrongIndex("luminaire", light.luminaire, "luminaires", luminaires);
  if (!isOneOf(light.kind, LightKind::kSpot)) return wrong("kind", int(light.kind), "a LightKind");
  for (const auto& [field, color] : {std::pair("ambient", &light.ambient),
                                     {"diffuse", &light.diffuse},
                                     {"specular", &light.specular},
                                     {"attenuation", &light.attenuation}})
    if (areNegative(*color)) return wrong(field, *color, "numbers of at least 0");
  if (!isOneOf(light.window, RangeWindow::kKhr)) return wrong("window", int(light.window), "a RangeWindow");
  if (!isOneOf(light.falloff, SpotFalloff::kCone))
    return wrong("falloff", int(light.falloff), "a SpotFalloff");
  if (light.exponent < 0) return wrong("exponent", light.exponent, "at least 0");
  if (!(light.radius >= 0 && light.radius <= kLargestNumber))
    return wrong("radius", light.radius, "0 to 1e18");
  if (!(light.half_angle >= 0 && light.half_angle <= glm::radians(45.0) + kUnitError))
    return wrong("half_angle", light.half_angle, "radians from 0 to half a right angle");
  if (!(light.cell >= 0 && std::isfinite(light.cell))) return wrong("cell", light.cell, "at least 0");
  return light.group < groups ? "" : wrongIndex("group", light.group, "light_groups", groups);
}

std::string fogFault(const Fog& fog) {
  if (!isOneOf(fog.mode, FogMode::kExp2)) return wrong("mode", int(fog.mode), "a FogMode");
  if (areNegative(fog.density)) return wrong("density", fog.density, "numbers of at least 0");
  if (!areFinite(fog.color)) return wrong("color", fog.color, "finite numbers");
  if (!std::isfinite(fog.start)) return wrong("start", fog.start, "a finite number");
  return std::isfinite(fog.end) ? "" : wrong("end", fog.end, "a finite number");
}

std::string curveFault(const Curve& curve) {
  if (!isOneOf(curve.interpolation, Interpolation::kCubic))
    return wrong("interpolation", int(curve.interpolation), "an Interpolation");
  for (std::size_t i = 0; i < curve.keys.size(); ++i) {
    const CurveKey& key = curve.keys[i];
    if (!std::isfinite(key.frame) || !areFinite(key.value) || !areFinite(key.slope_in) ||
        !areFinite(key.slope_out))
      return fmt::format("keys[{}]: has a number that isn't finite", i);
    if (i > 0 && key.frame < curve.keys[i - 1].frame)
      return wrong(fmt::format("keys[{}].frame", i).c_str(), key.frame, "none before the key's before it");
  }
  return "";
}

/// Of an index of a curve that is there, and has keys.
std::string curveIndexFault(const Animation& animation, const char* field, int curve) {
  if (!isIndexOrNone(curve, animation.curves.size()))
    return wrongIndex(field, curve, "curves", animation.curves.size());
  if (curve >= 0 && animation.curves[std::size_t(curve)].keys.empty())
    return fmt::format("{}: curve {} has no keys", field, curve);
  return "";
}

std::string nodeFault(const Animation& animation, std::size_t index) {
  const MovingNode& node = animation.nodes[index];
  if (!isIndexOrNone(node.parent, index))
    return fmt::format("parent: {}, expected an earlier node, or -1", node.parent);
  if (!isFinite(node.before)) return "before: has a number that isn't finite";
  return firstOf({curveIndexFault(animation, "translate", node.translate),
                  curveIndexFault(animation, "rotate", node.rotate),
                  curveIndexFault(animation, "scale", node.scale)});
}

/// meshes: of the scene, for objects.
std::string attachmentFault(const Animation& animation, const Attachment& attachment, const char* things,
                            std::size_t count, std::size_t meshes) {
  if (attachment.index >= count) return wrongIndex("index", attachment.index, things, count);
  if (attachment.node >= animation.nodes.size())
    return wrongIndex("node", attachment.node, "nodes", animation.nodes.size());
  if (!isFinite(attachment.after)) return "after: has a number that isn't finite";
  return attachment.mesh < meshes ? "" : wrongIndex("mesh", attachment.mesh, "meshes", meshes);
}

/// Of a motion's curve.
std::string motionFault(const char* field, const Curve& curve, bool needs_keys = false) {
  if (needs_keys && curve.keys.empty()) return fmt::format("{}: has no keys", field);
  const std::string fault = curveFault(curve);
  return fault.empty() ? "" : fmt::format("{}.{}", field, fault);
}

std::string cameraMotionFault(const Scene& scene, const CameraMotion& motion) {
  if (motion.camera >= scene.cameras.size())
    return wrongIndex("camera", motion.camera, "cameras", scene.cameras.size());
  if (!areFinite(motion.up)) return wrong("up", motion.up, "finite numbers");
  return firstOf({motionFault("eye", motion.eye, true), motionFault("target", motion.target, true),
                  motionFault("fov_y", motion.fov_y)});
}

std::string lightMotionFault(const Scene& scene, const LightMotion& motion) {
  if (motion.light >= scene.lights.size())
    return wrongIndex("light", motion.light, "lights", scene.lights.size());
  for (const auto& [field, color] :
       {std::pair("ambient", &motion.ambient), {"diffuse", &motion.diffuse}, {"specular", &motion.specular}})
    if (!areFinite(*color)) return wrong(field, *color, "finite numbers");
  if (!std::isfinite(motion.own_intensity))
    return wrong("own_intensity", motion.own_intensity, "a finite number");
  return firstOf({motionFault("position", motion.position), motionFault("direction", motion.direction),
                  motionFault("target", motion.target), motionFault("color", motion.color),
                  motionFault("intensity", motion.intensity), motionFault("range", motion.range)});
}

/// Of a level and its numbers.
std::string skyLevelFault(const SkyLevel& level) {
  if (level.width < 1 || level.height < 1 || level.width > kLargestSide || level.height > kLargestSide)
    return fmt::format("width, height: {}x{}, expected 1 to {} a side", level.width, level.height,
                       kLargestSide);
  const std::size_t count = 3 * std::size_t(level.width) * level.height;
  if (level.texels.size() != count) return sizeFault("texels", level.texels.size(), count, "3 of a texel");
  const bool are_light = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count), true,
      [&](const tbb::blocked_range<std::size_t>& range, bool so_far) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          so_far &= level.texels[i] >= 0 && level.texels[i] <= std::numeric_limits<float>::max();
        return so_far;
      },
      [](bool one, bool other) { return one && other; });
  return are_light ? "" : "texels: expected finite numbers of at least 0";
}

std::string skyFault(const Sky& sky) {
  for (std::size_t i = 0; i < sky.levels.size(); ++i)
    if (const std::string fault = skyLevelFault(sky.levels[i]); !fault.empty())
      return fmt::format("sky.levels[{}].{}", i, fault);
  return "";
}

std::string sourceMotionFault(const Scene& scene, const LightMotion& motion) {
  if (motion.light >= scene.sources.size())
    return wrongIndex("light", motion.light, "sources", scene.sources.size());
  if (!areFinite(motion.diffuse)) return wrong("diffuse", motion.diffuse, "finite numbers");
  if (!std::isfinite(motion.own_intensity))
    return wrong("own_intensity", motion.own_intensity, "a finite number");
  return firstOf({motionFault("position", motion.position), motionFault("direction", motion.direction),
                  motionFault("color", motion.color), motionFault("intensity", motion.intensity),
                  motionFault("rotate", motion.rotate)});
}

std::string targetFault(const RestShape& rest, const MorphTarget& target) {
  const std::size_t count = target.vertices.size();
  const float most = std::numeric_limits<float>::max();
  return firstOf({indexFault("vertices", target.vertices, "positions at rest", rest.positions.size()),
                  sizeFault("positions", target.positions.size(), count, "vertices"),
                  sizeFault("normals", target.normals.size(), count, "vertices"),
                  sizeFault("tangents", target.tangents.size(), count, "vertices"),
                  magnitudeFault("positions", target.positions, most),
                  magnitudeFault("normals", target.normals, most),
                  magnitudeFault("tangents", target.tangents, most)});
}

/// Of the joints that move the vertices of a rest.
std::string influencesFault(const RestShape& rest, std::size_t joints) {
  if (std::string fault = firstOf({sizeFault("first_influence", rest.first_influence.size(),
                                             rest.positions.size() + 1, "positions, and one more"),
                                   sizeFault("influence_weights", rest.influence_weights.size(),
                                             rest.influence_joints.size(), "influence_joints"),
                                   indexFault("influence_joints", rest.influence_joints, "joints", joints)});
      !fault.empty())
    return fault;
  if (!std::is_sorted(rest.first_influence.begin(), rest.first_influence.end()) ||
      rest.first_influence.back() != rest.influence_joints.size())
    return "first_influence: doesn't rise to the count of influence_joints";
  const auto at = std::find_if(rest.influence_weights.begin(), rest.influence_weights.end(),
                               [](float weight) { return !(weight > 0 && std::isfinite(weight)); });
  return at == rest.influence_weights.end()
             ? ""
             : wrong(fmt::format("influence_weights[{}]", at - rest.influence_weights.begin()).c_str(), *at,
                     "above 0");
}

std::string restFault(const Scene& scene, const Deformation& deformation) {
  const RestShape& rest = *deformation.rest;
  for (std::size_t i = 0; i < rest.targets.size(); ++i)
    if (const std::string fault = targetFault(rest, rest.targets[i]); !fault.empty())
      return fmt::format("targets[{}].{}", i, fault);
  const Mesh& mesh = scene.meshes[deformation.mesh];
  return firstOf(
      {sizeFault("normals", rest.normals.size(), rest.positions.size(), "positions"),
       magnitudeFault("positions", rest.positions, float(kLargestNumber)),
       magnitudeFault("normals", rest.normals, std::numeric_limits<float>::max()),
       indexFault("positions: sources of the mesh", mesh.sources, "positions", rest.positions.size()),
       deformation.joints.empty() ? "" : influencesFault(rest, deformation.joints.size())});
}

std::string deformationFault(const Scene& scene, const Deformation& deformation) {
  const Animation& animation = scene.animation;
  if (deformation.mesh >= scene.meshes.size())
    return wrongIndex("mesh", deformation.mesh, "meshes", scene.meshes.size());
  const Mesh& mesh = scene.meshes[deformation.mesh];
  if (!deformation.rest) return "rest: is missing";
  const std::size_t weights = deformation.weights.size(), joints = deformation.joints.size();
  for (const Joint& joint : deformation.joints)
    if (!isIndexOrNone(joint.node, animation.nodes.size()) || !isFinite(joint.after))
      return "joints: one has a node that there isn't, or numbers that aren't finite";
  for (const int curve : deformation.weight_curves)
    if (std::string fault = curveIndexFault(animation, "weight_curves", curve); !fault.empty()) return fault;
  for (const double weight : deformation.weights)
    if (!std::isfinite(weight)) return wrong("weights", weight, "finite numbers");
  for (const double number : deformation.pose)
    if (!std::isfinite(number)) return wrong("pose", number, "finite numbers");
  if (!isFinite(deformation.world_to_mesh)) return "world_to_mesh: has a number that isn't finite";
  const std::string fault = restFault(scene, deformation);
  return firstOf(
      {fault.empty() ? "" : "rest." + fault,
       sizeFault("mesh: its sources", mesh.sources.size(), mesh.positions.size(), "its positions"),
       mesh.tangents.empty()
           ? ""
           : sizeFault("tangents", deformation.tangents.size(), mesh.tangents.size(), "its mesh's"),
       magnitudeFault("tangents", deformation.tangents, std::numeric_limits<float>::max()),
       sizeFault("weights", weights, deformation.rest->targets.size(), "the targets"),
       deformation.weight_curves.empty() ? ""
                                         : sizeFault("weight_curves", deformation.weight_curves.size(),
                                                     (weights + 3) / 4, "one for four weights"),
       deformation.pose.empty()
           ? ""
           : sizeFault("pose", deformation.pose.size(), 16 * joints + weights, "poseNumbers()")});
}

void checkAnimation(const Scene& scene) {
  const Animation& animation = scene.animation;
  if (!(animation.frame_rate > 0 && std::isfinite(animation.frame_rate)))
    fail(scene, "animation", wrong("frame_rate", animation.frame_rate, "above 0"));
  if (!isIndexOrNone(animation.no_mesh, scene.meshes.size()) ||
      (animation.no_mesh < 0 && !animation.objects.empty()))
    fail(scene, "animation", wrongIndex("no_mesh", animation.no_mesh, "meshes", scene.meshes.size()));
  checkAll(scene, "animation.curves", animation.curves,
           [&](std::size_t i) { return curveFault(animation.curves[i]); });
  checkAll(scene, "animation.nodes", animation.nodes, [&](std::size_t i) { return nodeFault(animation, i); });
  checkAll(scene, "animation.objects", animation.objects, [&](std::size_t i) {
    return attachmentFault(animation, animation.objects[i], "objects", scene.objects.size(),
                           scene.meshes.size());
  });
  checkAll(scene, "animation.attached_cameras", animation.attached_cameras, [&](std::size_t i) {
    return attachmentFault(animation, animation.attached_cameras[i], "cameras", scene.cameras.size(),
                           kNowhere);
  });
  checkAll(scene, "animation.attached_lights", animation.attached_lights, [&](std::size_t i) {
    return attachmentFault(animation, animation.attached_lights[i], "lights", scene.lights.size(), kNowhere);
  });
  checkAll(scene, "animation.cameras", animation.cameras,
           [&](std::size_t i) { return cameraMotionFault(scene, animation.cameras[i]); });
  checkAll(scene, "animation.lights", animation.lights,
           [&](std::size_t i) { return lightMotionFault(scene, animation.lights[i]); });
  checkAll(scene, "animation.sources", animation.sources,
           [&](std::size_t i) { return sourceMotionFault(scene, animation.sources[i]); });
  checkAll(scene, "animation.deformations", animation.deformations,
           [&](std::size_t i) { return deformationFault(scene, animation.deformations[i]); });
}

}  // namespace

std::string sourceFault(const LightSource& source, std::size_t groups) {
  if (!isOneOf(source.kind, SourceKind::kDisc)) return wrong("kind", int(source.kind), "a SourceKind");
  if (source.count > kMostSourceLights)
    return fmt::format("count: {}, expected {} at most", source.count, kMostSourceLights);
  if (source.group >= groups) return wrongIndex("group", source.group, "light_groups", groups);
  if (!areFinite(source.radiance) || areNegative(source.radiance))
    return wrong("radiance", source.radiance, "numbers of at least 0");
  if (source.kind == SourceKind::kEnvironment) {
    if (!std::isfinite(source.rotate)) return wrong("rotate", source.rotate, "a finite number");
    for (const SkyCell& cell : source.cells)
      if (!areFinite(cell.direction) || !areFinite(cell.light) || areNegative(cell.light) ||
          !(cell.solid_angle >= 0 && std::isfinite(cell.solid_angle)))
        return "cells: one has numbers that are no light";
    return source.sky && !source.sky->levels.empty() ? "" : "sky: is missing";
  }
  if (!glm::all(glm::lessThanEqual(glm::abs(source.position), glm::dvec3(kLargestNumber))))
    return wrong("position", source.position, "numbers up to 1e18");
  if (!(source.width > 0 && source.height > 0 && source.width <= kLargestNumber &&
        source.height <= kLargestNumber))
    return "width, height: expected above 0";
  if (!areFinite(source.direction) || std::abs(glm::length(source.direction) - 1) > kUnitError)
    return wrong("direction", source.direction, "a unit vector");
  const double length = glm::length(glm::cross(source.up, source.direction));
  return length > 0 && std::isfinite(length) ? "" : "up: is parallel to the direction";
}

std::string cameraFault(const Camera& camera) {
  const glm::dmat4& place = camera.camera_to_world;
  if (!isFinite(place)) return "camera_to_world: has a number that isn't finite";
  const glm::dmat3 axes(place);
  const glm::dmat3 product = glm::transpose(axes) * axes;
  for (int i = 0; i < 9; ++i)
    if (std::abs(product[i / 3][i % 3] - (i % 4 == 0 ? 1 : 0)) > kUnitError)
      return "camera_to_world: scales or shears, expected a rotation and a translation";
  if (glm::any(glm::greaterThan(glm::abs(glm::dvec3(place[3])), glm::dvec3(kLargestNumber))))
    return wrong("camera_to_world: its place", glm::dvec3(place[3]), "numbers up to 1e18");
  if (camera.orthographic && !(camera.half_height > 0 && camera.half_height <= kLargestNumber))
    return wrong("half_height", camera.half_height, "above 0");
  if (!camera.orthographic && !(camera.fov_y > 0 && camera.fov_y < glm::radians(180.0)))
    return wrong("fov_y", camera.fov_y, "radians above 0 and below half a turn");
  if (!glm::all(glm::lessThanEqual(glm::abs(camera.shift), glm::dvec2(kMostLensShift))))
    return wrong("shift", camera.shift, "numbers up to 1e6");
  if (!(camera.pixel_aspect >= 1 / kMostPixelAspect && camera.pixel_aspect <= kMostPixelAspect))
    return wrong("pixel_aspect", camera.pixel_aspect, "1e-6 to 1e6");
  if (!(camera.near > 0)) return wrong("near", camera.near, "above 0");
  return camera.far > camera.near ? "" : wrong("far", camera.far, "above near");
}

void checkVertices(const Scene& scene, std::size_t mesh) {
  if (const std::string fault = verticesFault(scene.meshes[mesh]); !fault.empty())
    fail(scene, fmt::format("meshes[{}]", mesh), fault);
}

void validateScene(const Scene& scene) {
  const TraceSpan span("validate scene");
  const auto checkNumbers = [&](const char* field, const glm::vec3& color) {
    if (!areFinite(color)) fail(scene, "", wrong(field, color, "finite numbers"));
  };
  checkNumbers("background", scene.background);
  checkNumbers("ambient", scene.ambient);
  if (scene.size && (glm::any(glm::lessThan(*scene.size, glm::ivec2(1))) ||
                     glm::any(glm::greaterThan(*scene.size, glm::ivec2(kLargestSide)))))
    fail(scene, "", wrong("size", *scene.size, fmt::format("1 to {} a side", kLargestSide).c_str()));
  if (const std::string fault = fogFault(scene.fog); !fault.empty()) fail(scene, "fog", fault);
  checkAll(scene, "textures", scene.textures, [&](std::size_t i) { return textureFault(scene.textures[i]); });
  checkAll(scene, "materials", scene.materials,
           [&](std::size_t i) { return materialFault(scene, scene.materials[i]); });
  std::vector<float> reaches(scene.meshes.size());
  checkAll(scene, "meshes", scene.meshes, [&](std::size_t i) {
    reaches[i] = reachOf(scene.meshes[i]);
    return meshFault(scene, scene.meshes[i], reaches[i]);
  });
  checkAll(scene, "objects", scene.objects,
           [&](std::size_t i) { return objectFault(scene, scene.objects[i]); });
  checkAll(scene, "luminaires", scene.luminaires,
           [&](std::size_t i) { return luminaireFault(scene.luminaires[i]); });
  checkAll(scene, "lights", scene.lights, [&](std::size_t i) {
    return lightFault(scene.lights[i], scene.luminaires.size(), scene.light_groups.size());
  });
  checkAll(scene, "sources", scene.sources, [&](std::size_t i) {
    const LightSource& source = scene.sources[i];
    return firstOf({sourceFault(source, scene.light_groups.size()),
                    source.sky && source.kind == SourceKind::kEnvironment ? skyFault(*source.sky) : ""});
  });
  if (scene.source_lights > scene.lights.size())
    fail(scene, "", wrongIndex("source_lights", scene.source_lights, "lights", scene.lights.size()));
  checkAll(scene, "cameras", scene.cameras, [&](std::size_t i) { return cameraFault(scene.cameras[i]); });
  checkAnimation(scene);
  if (std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        return !(worldReach(object.object_to_world, reaches[object.mesh]) <= kLargestNumber);
      }))
    checkPlaces(scene);
}

}  // namespace luciole
