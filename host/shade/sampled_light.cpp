#include "shade/sampled_light.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cl/launch.hpp"
#include "kernels/sampled/sampled_light.h"
#include "raster/geometry.hpp"
#include "shadow/exact/beam_frame.hpp"

namespace luciole {

template <>
constexpr std::string_view kernelTypeName<SampleFrame>() {
  return "SampleFrame";
}
template <>
constexpr std::string_view kernelTypeName<std::uint64_t>() {
  return "ulong";
}
template <>
constexpr std::string_view kernelTypeName<Stratum>() {
  return "Stratum";
}

namespace {

/// Rays a pixel that a group begins with: fewer need more rounds, more are too many where little is seen.
constexpr uint kPilot = 128, kFinePilot = 256;
/// Degrees of freedom of the variance that samples estimate. Chosen by build/tests/light_confidence, so that
/// at a confidence of 0.99 intervals of small scenes hold as often as they state. Even.
constexpr int kFreedom = 40;
/// Errors below take kFinePilot.
constexpr float kFineError = 1.0f / 128;

uint pilotRays(float light_error) { return light_error < kFineError ? kFinePilot : kPilot; }

SampleFrame sampleFrame(const SampledLightArguments& arguments) {
  const BeamScene& beams = arguments.beams;
  const SampleSettings& settings = arguments.settings;
  const BeamFrame in_tree = beamFrame(beams, arguments.frame.plane_stride);
  SampleFrame frame{};
  frame.shade = arguments.frame;
  frame.to_tree_x = in_tree.to_tree_x;
  frame.to_tree_y = in_tree.to_tree_y;
  frame.to_tree_z = in_tree.to_tree_z;
  frame.tree_most = in_tree.tree_most;
  frame.to_pixel = settings.to_pixel;
  frame.tree_scale = in_tree.tree_scale;
  frame.tree_root = in_tree.tree_root;
  frame.light_count = uint(arguments.lights.lights);
  frame.levels = uint(arguments.lights.diffuse.levels);
  frame.light_error = settings.light_error;
  frame.least_value = settings.least_value;
  frame.deviations = float(settings.deviations);
  frame.seed = settings.seed;
  frame.tiles = arguments.frame.plane_stride / kTilePixels;
  frame.pilot = pilotRays(settings.light_error);
  frame.parallel = arguments.directions;
  frame.largest_cell = arguments.lights.largest_cell;
  return frame;
}

}  // namespace

double deviationsOf(double confidence) {
  // M. Abramowitz and I. Stegun, Handbook of Mathematical Functions, 1964, 26.7.4: the probability that a
  // value of Student's distribution with an even number of degrees of freedom lies within ±t.
  const auto within = [](double t) {
    const double cosine2 = kFreedom / (kFreedom + t * t);
    double term = 1, sum = 1;
    for (int i = 2; i < kFreedom; i += 2) sum += term *= cosine2 * (i - 1) / i;
    return sum * std::sqrt(1 - cosine2);
  };
  double low = 0, high = 16;
  for (int i = 0; i < 56; ++i) {
    const double middle = (low + high) / 2;
    (within(middle) < confidence ? low : high) = middle;
  }
  return high;
}

float4 pixelsOf(const View& view) {
  const double x = view.projection[0][0] * view.size.x / 2, y = view.projection[1][1] * view.size.y / 2;
  const glm::dvec2 axis = axisInPicture(view);
  return {float(x), float(-y), float((1 + axis.x) * view.size.x / 2), float((1 - axis.y) * view.size.y / 2)};
}

SampledLightCounts sampledLight(OpenedDevice& device, const std::string& defines,
                                const SampledLightArguments& arguments) {
  Kernel kernel = makeKernel(device, "sampled/sampled_light.cl", "sampled_light", defines);
  const SampleFrame frame = sampleFrame(arguments);
  const BeamScene& beams = arguments.beams;
  const GBufferBuffers& gbuffer = arguments.gbuffer;
  const SampledSet& lights = arguments.lights;
  const std::size_t items =
      std::clamp<std::size_t>(device.description.compute_units, 1, std::max<std::size_t>(frame.tiles, 1));
  const std::size_t strata_count = items * kMostStrata;
  const Buffer<Stratum> strata = makeBuffer<Stratum>(device, strata_count);
  const Buffer<uint> heap = makeBuffer<uint>(device, strata_count),
                     order = makeBuffer<uint>(device, strata_count),
                     free_values = makeBuffer<uint>(device, strata_count);
  const Buffer<float> values = makeBuffer<float>(device, strata_count * kStratumValues);
  const Buffer<std::uint64_t> unsure =
      makeBuffer<std::uint64_t>(device, arguments.holes ? 2 * strata_count : 2);
  std::vector<uint> counts(kSampleCounts * std::max<std::size_t>(frame.tiles, 1));
  const Buffer<uint> next_tile = makeBuffer<uint>(device, 1),
                     counts_buffer = borrowedForOutput(device, counts);
  fill(device, next_tile, 0);
  const Buffer<const float> rows = borrowed(device, lights.diffuse.rows),
                            light_rows = borrowed(device, lights.diffuse.light_rows);
  const bool one_color = lights.specular.lights == 0;
  launch(device, kernel,
         withTriangleTree(
             beams,
             {{"frame", frame},
              {"position", gbuffer.position},
              {"normal", gbuffer.normal},
              {"diffuse", gbuffer.diffuse},
              {"specular", gbuffer.specular},
              {"lift", gbuffer.lift},
              {"surface_normal", gbuffer.surface_normal},
              {"rows", rows},
              {"light_rows", light_rows},
              {"specular_rows", one_color ? rows : borrowed(device, lights.specular.rows)},
              {"specular_light_rows", one_color ? light_rows : borrowed(device, lights.specular.light_rows)},
              {"places", borrowed(device, lights.places)},
              {"lobes", borrowed(device, lights.lobes)},
              {"strata", strata},
              {"heap", heap},
              {"order", order},
              {"free_values", free_values},
              {"values", values},
              {"unsure", unsure},
              {"light", arguments.light},
              {"bound", arguments.bound},
              {"half_width", arguments.half_width},
              {"counts", counts_buffer},
              {"next_tile", next_tile}}),
         {.items = items, .group = 1});
  download(device, counts_buffer, counts);
  SampledLightCounts sums;
  for (std::size_t at = 0; at < counts.size(); at += kSampleCounts) {
    sums.rays += counts[at + kSampledRays];
    sums.strata += counts[at + kSampledStrata];
    sums.rounds += counts[at + kSampledRounds];
    sums.groups += counts[at + kSampledGroups];
    sums.missed += counts[at + kMissedPixels];
  }
  return sums;
}

// Fitted to city, cornell and Sponza with 10³ to 10⁶ lights in a box and errors of 1/16 to 1/256: rays are
// between 0.4 and 5 times as many, depending on how bright and how shadowed the light is, and take their time
// within a factor of 1.5.
double sampledRays(std::size_t lights, const ShadeSettings& settings) {
  const double deviations = deviationsOf(settings.confidence) / double(settings.light_error);
  const double rays =
      pilotRays(settings.light_error) + 0.05 * std::pow(deviations, 1.1) * std::pow(double(lights), 0.3);
  return std::min(rays, 1.2 * double(lights));
}

double sampledMilliseconds(const SampleableLights& lights, const ShadeSettings& settings) {
  const double casting = double(lights.casting) / double(std::max<std::size_t>(lights.count, 1)),
               of_ray = 1e-6 * (6 + 7 * casting * std::log2(std::max(lights.triangles, 2.0))),
               of_tree = 1.2e-3 * double(lights.count);
  return of_tree + lights.points * sampledRays(lights.count, settings) * of_ray;
}

}  // namespace luciole
