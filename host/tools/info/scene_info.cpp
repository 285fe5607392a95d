#include "tools/info/scene_info.hpp"

#include <algorithm>
#include <cmath>

#include "scene/count_triangles.hpp"

namespace luciole {
namespace {

std::optional<KeyFrames> keyFrames(const Animation& animation) {
  std::optional<KeyFrames> all;
  const auto add = [&](const Curve& curve) {
    if (curve.keys.size() < 2) return;  // constant
    const double first = curve.keys.front().frame, last = curve.keys.back().frame;
    all = all ? KeyFrames{std::min(all->first, first), std::max(all->last, last)} : KeyFrames{first, last};
  };
  for (const Curve& curve : animation.curves) add(curve);
  for (const CameraMotion& motion : animation.cameras)
    for (const Curve* curve : {&motion.eye, &motion.target, &motion.fov_y}) add(*curve);
  for (const std::vector<LightMotion>* motions : {&animation.lights, &animation.sources})
    for (const LightMotion& motion : *motions)
      for (const Curve* curve : {&motion.position, &motion.direction, &motion.target, &motion.color,
                                 &motion.intensity, &motion.range, &motion.rotate})
        add(*curve);
  return all;
}

LightCounts lightCounts(const Scene& scene) {
  LightCounts counts;
  for (const Light& light : scene.lights) {
    ++(light.kind == LightKind::kPoint         ? counts.point
       : light.kind == LightKind::kDirectional ? counts.directional
                                               : counts.spot);
    counts.casting += light.shadow;
    counts.everywhere += light.kind == LightKind::kDirectional || !std::isfinite(light.range);
  }
  return counts;
}

}  // namespace

SceneInfo sceneInfo(const Scene& scene) {
  SceneInfo info;
  info.triangles = countTriangles(scene);
  for (const Mesh& mesh : scene.meshes) {
    info.mesh_triangles += mesh.triangles.size();
    info.meshes += !mesh.triangles.empty();
  }
  for (const Texture& texture : scene.textures)
    if (!texture.levels.empty())
      info.texels += std::uint64_t(texture.levels[0].width) * texture.levels[0].height;
  info.lights = lightCounts(scene);
  info.bounds = sceneBounds(scene);
  info.moves = keyFrames(scene.animation);
  return info;
}

}  // namespace luciole
