#include "tools/bench/shading_rate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/embedded_files.hpp"
#include "cl/kernel_source.hpp"
#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "lighting/stats.hpp"
#include "render/render.hpp"

namespace luciole {
namespace {

constexpr int kLights = 64;
constexpr glm::ivec2 kAllPairsSize(512);

std::string yardstickSource(std::string_view name) {
  const auto& files = yardstickKernels();
  const auto file = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.name == name; });
  return expandKernelSource(name, file->text);
}

/// The lights for plain.cl and roof.cl. The camera is at the origin and looks along −z, so world space is
/// view space.
std::vector<ShadeLight> shadeLights(const Scene& scene) {
  const auto pack = [](const glm::vec3& v, float w) { return float4{v.x, v.y, v.z, w}; };
  std::vector<ShadeLight> lights;
  for (const Light& light : scene.lights) {
    ShadeLight out{};
    out.position = pack(light.position, 1 / (light.range * light.range));
    out.diffuse = pack(light.diffuse, 0);
    out.specular = pack(light.specular, 0);
    out.attenuation = pack(light.attenuation, 0);
    out.shadow = kNoShadow;
    lights.push_back(out);
  }
  return lights;
}

double launchMilliseconds(OpenedDevice& device, Kernel& kernel, const std::vector<KernelArgument>& arguments,
                          const WorkItems& work) {
  return millisecondsOf([&] {
    launch(device, kernel, arguments, work);
    finish(device);
  });
}

/// A group of planes as the plain kernel takes it: a float4 for each pixel.
std::vector<float4> packed(const Plane& planes, std::size_t pixels) {
  std::vector<float4> values(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float w = planes.size() > 3 * pixels ? planes[i + 3 * pixels] : 0;
    values[i] = {planes[i], planes[i + pixels], planes[i + 2 * pixels], w};
  }
  return values;
}

/// tests/kernels/plain.cl and its arguments.
struct Plain {
  Plain(OpenedDevice& on_device, const AllPairs& pairs)
      : device(on_device),
        pixels(pairs.gbuffer.pixels()),
        position(packed(pairs.gbuffer.position, pixels)),
        normal(packed(pairs.gbuffer.normal, pixels)),
        diffuse(packed(pairs.gbuffer.diffuse, pixels)),
        specular(packed(pairs.gbuffer.specular, pixels)),
        lights(shadeLights(pairs.scene)),
        position_buffer(borrowed(device, position)),
        normal_buffer(borrowed(device, normal)),
        diffuse_buffer(borrowed(device, diffuse)),
        specular_buffer(borrowed(device, specular)),
        light_buffer(borrowed(device, lights)),
        image(makeBuffer<float4>(device, pixels)),
        kernel(makeKernelFromSource(device, yardstickSource("plain.cl"), "plain", "")) {}
  Plain(const Plain&) = delete;
  Plain& operator=(const Plain&) = delete;

  double run() {
    return launchMilliseconds(device, kernel,
                              {{"position", position_buffer},
                               {"normal", normal_buffer},
                               {"diffuse", diffuse_buffer},
                               {"specular", specular_buffer},
                               {"lights", light_buffer},
                               {"light_count", uint(lights.size())},
                               {"image", image}},
                              {.items = pixels, .group = 64});
  }

  std::vector<float4> picture() {
    std::vector<float4> colors(pixels);
    download(device, image, colors);
    return colors;
  }

  OpenedDevice& device;
  std::size_t pixels;
  std::vector<float4> position, normal, diffuse, specular;
  std::vector<ShadeLight> lights;
  Buffer<const float4> position_buffer, normal_buffer, diffuse_buffer, specular_buffer;
  Buffer<const ShadeLight> light_buffer;
  Buffer<float4> image;
  Kernel kernel;
};

/// tests/kernels/roof.cl and its arguments, for the same number of pairs.
struct Roof {
  Roof(OpenedDevice& on_device, const AllPairs& pairs)
      : device(on_device),
        rows(pairs.gbuffer.pixels() / std::size_t(device.description.lanes)),
        lights(shadeLights(pairs.scene)),
        light_buffer(borrowed(device, lights)),
        image(makeBuffer<float>(device, pairs.gbuffer.pixels())),
        kernel(makeKernelFromSource(device, yardstickSource("roof.cl"), "roof", "")) {
    frame.light_count = uint(lights.size());
    frame.plane_stride = uint(pairs.gbuffer.pixels());
  }
  Roof(const Roof&) = delete;
  Roof& operator=(const Roof&) = delete;

  double run() {
    return launchMilliseconds(
        device, kernel,
        {{"frame", frame}, {"lights", light_buffer}, {"light_count", uint(lights.size())}, {"image", image}},
        {.items = rows, .group = std::size_t(kTilePixels / device.description.lanes)});
  }

  OpenedDevice& device;
  std::size_t rows;
  std::vector<ShadeLight> lights;
  Buffer<const ShadeLight> light_buffer;
  Buffer<float> image;
  ShadeFrame frame{};
  Kernel kernel;
};

double shadeMilliseconds(OpenedDevice& device, const AllPairs& pairs) {
  RenderSettings settings;
  settings.shade.culling = Culling::kNone;
  Stats stats;
  shadeGBuffer(device, pairs.scene, pairs.gbuffer, settings, stats);
  return stageTime(stats, Stage::kShade);
}

}  // namespace

AllPairs makeAllPairs(glm::ivec2 size, int lights) {
  std::uint32_t bits = 1;
  const auto random = [&](float low, float high) {
    bits = bits * 1664525u + 1013904223u;
    return low + (high - low) * float(bits >> 8) * 0x1p-24f;
  };
  AllPairs pairs;
  pairs.scene.name = "all pairs";
  // From any surface, lights are within 65 degrees of the view axis. Normals lean by 20 degrees at most, so
  // all surfaces face all lights.
  for (int i = 0; i < lights; ++i) {
    Light light;
    light.position = {random(-3, 3), random(-3, 3), random(-6, -4)};
    light.diffuse = light.specular = glm::vec3(random(0.01f, 0.05f));
    light.range = 30;
    pairs.scene.lights.push_back(light);
  }
  GBuffer& gbuffer = pairs.gbuffer;
  gbuffer.tiles_x = (size.x + kTileSize - 1) / kTileSize;
  gbuffer.tiles_y = (size.y + kTileSize - 1) / kTileSize;
  gbuffer.width = gbuffer.tiles_x * kTileSize;
  gbuffer.height = gbuffer.tiles_y * kTileSize;
  gbuffer.picture_size = {gbuffer.width, gbuffer.height};
  const std::size_t n = gbuffer.pixels();
  gbuffer.position.resize(3 * n);
  gbuffer.normal.resize(3 * n);
  gbuffer.diffuse.assign(3 * n, 0.5f);
  gbuffer.specular.assign(4 * n, 0.5f);
  for (std::size_t i = 0; i < n; ++i) {
    const glm::vec3 position(random(-3, 3), random(-3, 3), random(-15, -10));
    const glm::vec3 normal = glm::normalize(glm::vec3(random(-0.25f, 0.25f), random(-0.25f, 0.25f), 1));
    for (int c = 0; c < 3; ++c) {
      gbuffer.position[i + std::size_t(c) * n] = position[c];
      gbuffer.normal[i + std::size_t(c) * n] = normal[c];
    }
    gbuffer.specular[i + 3 * n] = random(1, 100);
  }
  return pairs;
}

Image shadePlainly(OpenedDevice& device, const AllPairs& pairs) {
  Plain plain(device, pairs);
  plain.run();
  const std::vector<float4> colors = plain.picture();
  const GBuffer& gbuffer = pairs.gbuffer;
  Image image{gbuffer.width, gbuffer.height, {"R", "G", "B"}, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float4 color = colors[gbuffer.index(x, y)];
      image.pixels.insert(image.pixels.end(), {color.x, color.y, color.z});
    }
  return image;
}

double roofMilliseconds(OpenedDevice& device, const AllPairs& pairs) {
  Roof roof(device, pairs);
  return roof.run();
}

SpeedTable measureShadingRate(const SpeedInput& input) {
  const AllPairs pairs = makeAllPairs(input.size.value_or(kAllPairsSize), kLights);
  const double million_pairs = 1e-6 * double(pairs.gbuffer.pixels()) * double(pairs.scene.lights.size());
  Plain plain(input.device, pairs);
  Roof roof(input.device, pairs);
  struct Row {
    const char* name;
    std::function<double()> run;
  };
  const std::vector<Row> rows{{"plain", [&] { return plain.run(); }},
                              {"ours", [&] { return shadeMilliseconds(input.device, pairs); }},
                              {"roof", [&] { return roof.run(); }}};
  SpeedTable table{.name = "shading rate",
                   .measured = fmt::format(
                       "{} lights on each of {} pixels, Phong's highlights of exponents from 1 to 100, no "
                       "culling; plain: one pixel a work-item and built-in functions; roof: the "
                       "instructions of ours with nothing to load or to wait for",
                       pairs.scene.lights.size(), pairs.gbuffer.pixels()),
                   .columns = {{"milliseconds", "ms", 2},
                               {"million_pairs_per_second", "million pairs/s", 0},
                               {"times_plain", "times plain", 1},
                               {"share_of_roof", "share of roof", 2}}};
  for (const Row& row : rows) row.run();  // compiles
  const auto rounds = runInRounds(rows.size(), input.repeats, table.name, input.on_progress,
                                  [&](std::size_t row) { return std::vector{rows[row].run()}; });
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const Repeated time = rounds[i].summary(0);
    table.rows.push_back(
        {rows[i].name,
         {time, quotient(1000 * million_pairs, time.median, "a time is too short to be measured"),
          ratio(rounds[0].figures[0], rounds[i].figures[0]),
          ratio(rounds[2].figures[0], rounds[i].figures[0])}});
  }
  return table;
}

}  // namespace luciole
