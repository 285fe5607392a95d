// Rays from the points of a picture to many lights, on the device and by Embree's robust tree, in turns:
//   build/tests/ray_benchmark SCENE [--lights N] [--rays N] [--lanes N]
// Both trace the same rays, on all cores.
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <random>

#include "luciole/load_scene.hpp"
#include "raster/opacity.hpp"
#include "rays/ray_cast.hpp"
#include "raster/rasterize.hpp"
#include "render/render.hpp"
#include "scene/lights/light_field.hpp"
#include "shade/features.hpp"
#include "shadow/exact/brute_shadows.hpp"
#include "shadow/exact/light_rays.hpp"

namespace luciole::test {
namespace {

struct Experiment {
  std::string scene, device, dump;
  std::size_t lights = 100'000, rays = 1 << 21;
  std::vector<int> size{320, 180};
  int repeats = 3;
  std::size_t checked = 20'000, window = 128;
  bool holes = true;
  int embree = 1;
};

struct Points {
  std::vector<float, RawArrayAllocator<float>> starts;
  std::size_t stride;
  std::vector<glm::vec3> normals;               // in the tree's axes, by place
  std::vector<std::vector<uint>> groups;        // covered places of 8x8 pixels
};

std::uint32_t mortonOf(const glm::vec3& unit) {
  std::uint32_t code = 0;
  for (int bit = 9; bit >= 0; --bit)
    for (int axis = 0; axis < 3; ++axis)
      code = code << 1 | (std::uint32_t(std::clamp(unit[axis], 0.0f, 0.9999f) * 1024) >> bit & 1);
  return code;
}

/// Seconds of all threads' work, by two: others share the machine's two cores.
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 0.5 * (double(time.tv_sec) + 1e-9 * double(time.tv_nsec));
}

using Rays = std::vector<LightRay, RawArrayAllocator<LightRay>>;
using Lights = std::vector<BeamLight, RawArrayAllocator<BeamLight>>;

glm::vec3 startOf(const Points& points, uint place) {
  return {points.starts[place], points.starts[place + points.stride], points.starts[place + 2 * points.stride]};
}

bool faces(const Points& points, const Lights& lights, const LightRay& ray) {
  const float4& p = lights[ray.light].place;
  return glm::dot(points.normals[ray.point], glm::vec3(p.x, p.y, p.z) - startOf(points, ray.point)) > 0;
}

Rays makeRays(const Points& points, const Lights& lights, std::size_t count, const std::string& order,
              std::size_t window) {
  std::mt19937 random(1);
  Rays rays;
  const auto below = [&](std::size_t n) { return std::size_t(std::uint64_t(random()) * n >> 32); };
  // Groups in the picture's order, each with several packets.
  const std::size_t packets = count / 16, each = std::max<std::size_t>(1, packets / points.groups.size());
  for (std::size_t g = 0; rays.size() < packets * 16; g = (g + 1) % points.groups.size()) {
    const std::vector<uint>& group = points.groups[g];
    for (std::size_t k = 0; k < each && rays.size() < packets * 16; ++k) {
      const std::size_t base = below(lights.size() - window), at = below(std::max<std::size_t>(group.size() / 16, 1)) * 16;
      const std::size_t before = rays.size();
      for (int tries = 0; rays.size() < before + 16 && tries < 200; ++tries) {
        LightRay ray;
        if (order == "coherent") {
          if (tries == 16) break;
          ray = {group[std::min(at + std::size_t(tries), group.size() - 1)], uint(base)};
        } else if (order == "near") {
          ray = {group[below(group.size())], uint(base + below(window))};
        } else {
          ray = {group[below(group.size())], uint(below(lights.size()))};
        }
        if (faces(points, lights, ray)) rays.push_back(ray);
      }
      // As a caller would: what is left of a packet is filled by the next ones.
      if (order == "near")
        std::sort(rays.begin() + std::ptrdiff_t(before), rays.end(),
                  [](const LightRay& a, const LightRay& b) { return a.light < b.light; });
    }
  }
  rays.resize(packets * 16);
  return rays;
}

template <int kWidth>
void castEmbree(RTCScene scene, const Points& points, const Lights& lights, const Rays& rays, bool coherent,
                std::vector<std::uint8_t>& blocked) {
  const std::size_t packets = rays.size() / 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, packets, 64), [&](const tbb::blocked_range<std::size_t>& range) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    for (std::size_t packet = range.begin(); packet < range.end(); ++packet) {
      alignas(64) int valid[16];
      alignas(64) RTCRay16 ray{};
      RTCRay8 half[2];
      RTCRay4 quarter[4];
      for (std::size_t i = 0; i < 16; ++i) {
        const LightRay& one = rays[packet * 16 + i];
        const glm::vec3 s = startOf(points, one.point);
        const float4& p = lights[one.light].place;
        const glm::vec3 d = glm::vec3(p.x, p.y, p.z) - s;
        valid[i] = -1;
        const auto set = [&](auto& r, std::size_t k) {
          r.org_x[k] = s.x, r.org_y[k] = s.y, r.org_z[k] = s.z;
          r.dir_x[k] = d.x, r.dir_y[k] = d.y, r.dir_z[k] = d.z;
          r.tnear[k] = 1e-4f, r.tfar[k] = 1, r.mask[k] = ~0u, r.time[k] = 0, r.flags[k] = 0;
        };
        if constexpr (kWidth == 16) set(ray, i);
        if constexpr (kWidth == 8) set(half[i / 8], i % 8);
        if constexpr (kWidth == 4) set(quarter[i / 4], i % 4);
        if constexpr (kWidth == 1) {
          RTCRay single{};
          single.org_x = s.x, single.org_y = s.y, single.org_z = s.z;
          single.dir_x = d.x, single.dir_y = d.y, single.dir_z = d.z;
          single.tnear = 1e-4f, single.tfar = 1, single.mask = ~0u;
          rtcOccluded1(scene, &context, &single);
          blocked[packet * 16 + i] = single.tfar < 0;
        }
      }
      if constexpr (kWidth == 16) {
        rtcOccluded16(valid, scene, &context, &ray);
        for (std::size_t i = 0; i < 16; ++i) blocked[packet * 16 + i] = ray.tfar[i] < 0;
      }
      if constexpr (kWidth == 8)
        for (std::size_t k = 0; k < 2; ++k) {
          rtcOccluded8(valid, scene, &context, &half[k]);
          for (std::size_t i = 0; i < 8; ++i) blocked[packet * 16 + 8 * k + i] = half[k].tfar[i] < 0;
        }
      if constexpr (kWidth == 4)
        for (std::size_t k = 0; k < 4; ++k) {
          rtcOccluded4(valid, scene, &context, &quarter[k]);
          for (std::size_t i = 0; i < 4; ++i) blocked[packet * 16 + 4 * k + i] = quarter[k].tfar[i] < 0;
        }
    }
  });
}

int run(int count, char** arguments) {
  Experiment experiment;
  CLI::App app("Rays to lights, by the device and by Embree.");
  std::string orders = "coherent,near,random", places = "box,surface";
  app.add_option("SCENE", experiment.scene)->required();
  app.add_option("--device", experiment.device);
  app.add_option("--lights", experiment.lights);
  app.add_option("--rays", experiment.rays);
  app.add_option("--dump", experiment.dump);
  app.add_option("--size", experiment.size)->delimiter('x')->expected(2)->allow_extra_args(false);
  app.add_option("--repeats", experiment.repeats);
  app.add_option("--checked", experiment.checked);
  app.add_option("--window", experiment.window);
  app.add_option("--orders", orders);
  app.add_option("--places", places);
  app.add_flag("--holes,!--solid", experiment.holes);
  app.add_option("--embree", experiment.embree);
  CLI11_PARSE(app, count, arguments);
  OpenedDevice device;
  openDevice(experiment.device, device);
  Scene scene = loadScene(experiment.scene);
  const Camera camera = scene.cameras.front();
  const View view = cameraView(camera, {experiment.size[0], experiment.size[1]});
  const GBuffer gbuffer = rasterize(scene, allObjects(scene), view, Shading::kPhong, {});
  auto tree = std::make_shared<const TriangleTree>(buildTriangleTree(scene, glm::dvec3(camera.camera_to_world[3])));
  auto masks = std::make_shared<const HoleMasks>(makeHoleMasks(scene, *tree));
  if (masks->triangles.empty() || !experiment.holes) masks = nullptr;
  BeamScene beams;
  prepareBeams(device, camera, tree, masks, 0, beams);
  const RayScene embree = buildRayScene(scene, tree->origin);
  Points points;
  points.stride = gbuffer.pixels();
  points.starts.resize(3 * points.stride);
  points.normals.resize(points.stride);
  for (std::size_t place = 0; place < points.stride; ++place) {
    if (place % 64 == 0) points.groups.emplace_back();
    if (!std::isfinite(gbuffer.position[place + 2 * points.stride])) continue;
    const glm::vec3 start = startInTree(beams, gbuffer, place);
    for (std::size_t axis = 0; axis < 3; ++axis) points.starts[place + axis * points.stride] = start[int(axis)];
    points.normals[place] = beams.view_to_tree * glm::vec3(gbuffer.normal[place], gbuffer.normal[place + points.stride],
                                                            gbuffer.normal[place + 2 * points.stride]);
    points.groups.back().push_back(uint(place));
  }
  std::erase_if(points.groups, [](const auto& group) { return group.empty(); });
  glm::dvec3 low(1e30), high(-1e30);
  for (const Object& object : scene.objects)
    for (const glm::vec3& p : scene.meshes[object.mesh].positions) {
      const glm::dvec3 at = object.object_to_world * glm::dvec4(p, 1);
      low = glm::min(low, at), high = glm::max(high, at);
    }
  fmt::print("{}: {} triangles, {} nodes, {} blocks, {} groups of pixels, lanes {}\n", experiment.scene,
             tree->triangles.size(), tree->children.size() / 16, tree->block_bits.size(), points.groups.size(),
             device.description.lanes);
  FeatureSet features;
  features.set(Feature::kHoles, masks != nullptr);
  const std::string defines = featureDefines(features);
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    if (!masks) return false;
    const PlacedObject& object = objectOfTriangle(objects, triangle);
    return isHoleAt(scene, object, triangle - object.first_triangle, weights);
  };
  for (const std::string place : {"box", "surface"}) {
    if (places.find(place) == places.npos) continue;
    LightField field;
    field.shape = place == "box" ? FieldShape::kBox : FieldShape::kSurface;
    field.low = low, field.high = high;
    field.offset = 0.01 * glm::length(high - low);
    field.count = experiment.lights;
    Scene lit = scene;
    lit.lights.clear();
    expandLightField(field, lit);
    std::sort(lit.lights.begin(), lit.lights.end(), [&](const Light& a, const Light& b) {
      const glm::dvec3 size = high - low;
      return mortonOf(glm::vec3((a.position - low) / size)) < mortonOf(glm::vec3((b.position - low) / size));
    });
    Lights lights;
    for (const Light& light : lit.lights) lights.push_back(beamLight(light, true, beams));
    for (const std::string order : {"coherent", "near", "random"}) {
      if (orders.find(order) == orders.npos) continue;
      const Rays rays = makeRays(points, lights, experiment.rays, order, experiment.window);
      std::vector<uint, RawArrayAllocator<uint>> lit_bits(wordsForRays(rays.size())), unsure_bits(lit_bits.size());
      const Buffer<uint> lit_buffer = borrowedForOutput(device, lit_bits), unsure_buffer = borrowedForOutput(device, unsure_bits);
      const RayArguments to_trace{borrowed(device, rays), rays.size(), borrowed(device, points.starts), points.stride,
                                  borrowed(device, lights), beams};
      if (!experiment.dump.empty()) {
        std::FILE* file = std::fopen(fmt::format("{}_{}_{}.bin", experiment.dump, place, order).c_str(), "wb");
        const auto write = [&](const auto& array) {
          const std::size_t bytes = array.size() * sizeof(array[0]);
          std::fwrite(&bytes, 8, 1, file);
          std::fwrite(array.data(), 1, bytes, file);
        };
        write(std::vector<float4>{beams.largest_coordinates});
        write(std::vector<int>{tree->root});
        write(tree->nodes), write(tree->children), write(tree->blocks);
        if (masks) write(masks->block_bits); else write(tree->block_bits);
        write(points.starts), write(lights), write(rays);
        if (masks) write(masks->texels), write(masks->triangles), write(masks->first_triangle);
        std::fclose(file);
        continue;
      }
      std::vector<std::uint8_t> blocked(rays.size());
      double ours = 1e30, theirs = 1e30;
      std::string best;
      for (int i = 0; i < experiment.repeats + 1; ++i) {
        const double start = now();
        traceLightRays(device, defines, to_trace, lit_buffer, unsure_buffer);
        finish(device);
        if (i > 0) ours = std::min(ours, now() - start);
        if (!experiment.embree) continue;
        for (const int width : {1, 4, 8, 16})
          for (const bool coherent : {false, true}) {
            if (width == 1 && coherent) continue;
            const double from = now();
            const auto cast = width == 1 ? castEmbree<1> : width == 4 ? castEmbree<4> : width == 8 ? castEmbree<8> : castEmbree<16>;
            cast(embree.scene.get(), points, lights, rays, coherent, blocked);
            const double took = now() - from;
            if (took < theirs) {
              theirs = took;
              best = fmt::format("{}{}", width, coherent ? "c" : "i");
            }
          }
      }
      download(device, lit_buffer, lit_bits);
      if (masks) download(device, unsure_buffer, unsure_bits);
      std::size_t lit_count = 0, unsure_count = 0, wrong = 0, differ = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool is_lit = lit_bits[i / 32] >> i % 32 & 1, is_unsure = masks && (unsure_bits[i / 32] >> i % 32 & 1);
        lit_count += is_lit, unsure_count += is_unsure;
        if (!is_unsure && experiment.embree) differ += is_lit == (blocked[i] != 0);
      }
      const std::size_t step = std::max<std::size_t>(1, rays.size() / std::max<std::size_t>(experiment.checked, 1));
      double host = now();
      std::size_t asked = 0;
      std::optional<std::size_t> likely;
      for (std::size_t i = 0; i < rays.size() && experiment.checked; i += step) {
        const bool is_unsure = masks && (unsure_bits[i / 32] >> i % 32 & 1);
        const bool truth = countUnblocked(*tree, startOf(points, rays[i].point), {&lights[rays[i].light].place, 1}, is_hole, likely) > 0;
        ++asked;
        wrong += !is_unsure && truth != ((lit_bits[i / 32] >> i % 32 & 1) != 0);
      }
      host = now() - host;
      fmt::print("{:8} {:9} lit {:4.1f} % unsure {:.4f} %  ours {:6.2f} M/s  embree {:6.2f} M/s ({})  ratio {:.2f}  wrong {}/{} differ {:.4f} % host {:.2f} M/s\n", place,
                 order, 100.0 * double(lit_count) / double(rays.size()), 100.0 * double(unsure_count) / double(rays.size()),
                 double(rays.size()) / ours * 1e-6, double(rays.size()) / theirs * 1e-6, best, theirs / ours, wrong,
                 asked, 100.0 * double(differ) / double(rays.size()), double(asked) / host * 1e-6);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace luciole::test

int main(int count, char** arguments) { return luciole::test::run(count, arguments); }
