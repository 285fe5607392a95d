#include "tools/models/check_model.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <iterator>
#include <numbers>
#include <sstream>

#include "base/spawn.hpp"
#include "base/text_file.hpp"
#include "cl/device.hpp"
#include "cl/launch.hpp"
#include "lighting/stats.hpp"
#include "luciole/error.hpp"
#include "reference/model_truth.hpp"
#include "reference/models.hpp"
#include "render/render.hpp"
#include "scene/models.hpp"
#include "shade/features.hpp"
#include "shaders/shader_text.hpp"
#include "tools/bench/child_process.hpp"
#include "tools/bench/shading_rate.hpp"
#include "tools/figures/rounds.hpp"

namespace luciole {
namespace {

constexpr double kShininesses[] = {0, 0.5, 1, 10, 100, 1e3, 1e4, 1e6};
/// Of albedo and reciprocity: narrower lobes than these need more directions than are summed.
constexpr double kWideLobes[] = {0, 1, 10, 100, 1000};
constexpr int kWidths[] = {1, 4, 8, 16};

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Normals along and between the axes.
const glm::dvec3 kNormals[] = {{0, 0, 1}, {0.267261, -0.534522, 0.801784}, {-0.7, 0.1, 0.707107}};
/// Metres to the light; 0: a directional one.
constexpr double kDistances[] = {0, 0.01, 3.7, 1000};

/// A pair as kernels get it, in floats, and as it is meant.
struct Pair {
  Place place;
  glm::vec3 normal{0}, way{0}, to_eye{0}, tangent{0};
  float shininess = 0, inverse = 1;
};

struct Frame {
  glm::dvec3 normal, tangent, bitangent;
};
Frame frameAround(const glm::dvec3& direction) {
  const glm::dvec3 normal = glm::normalize(direction);
  const glm::dvec3 tangent = glm::normalize(glm::cross(glm::dvec3(0.1, 1, 0.2), normal));
  return {normal, tangent, glm::cross(normal, tangent)};
}

glm::dvec3 directionIn(const Frame& frame, double theta, double phi) {
  return std::sin(theta) * (std::cos(phi) * frame.tangent + std::sin(phi) * frame.bitangent) +
         std::cos(theta) * frame.normal;
}

Pair pairAt(const Place& place, std::size_t number) {
  const Frame frame = frameAround(kNormals[number % std::size(kNormals)]);
  const double turn = 0.3 + double(number % 7);  // of both directions, for models with tangents
  const double distance = kDistances[number % std::size(kDistances)];
  const glm::dvec3 to_light = directionIn(frame, radians(place.light), radians(place.between) + turn);
  Pair pair;
  pair.place = place;
  pair.normal = frame.normal;
  pair.tangent = frame.tangent;
  pair.to_eye = directionIn(frame, radians(place.eye), turn);
  pair.way = distance > 0 ? to_light * distance : to_light;
  pair.inverse = distance > 0 ? float(1 / glm::length(glm::dvec3(pair.way))) : 1.0f;
  pair.shininess = float(place.shininess);
  return pair;
}

/// Pairs in all directions, also grazing ones, at the mirror direction and around it, with eyes in the
/// surface and behind it.
std::vector<Pair> hardPairs() {
  constexpr double kAngles[] = {0, 1e-4, 5, 20, 45, 60, 75, 85, 89, 89.9, 89.9999};
  constexpr double kBetween[] = {0, 40, 90, 150, 180};
  std::vector<Pair> pairs;
  const auto add = [&](const Place& place) { pairs.push_back(pairAt(place, pairs.size())); };
  for (const double shininess : kShininesses) {
    for (const double eye : kAngles) {
      for (const double light : kAngles)
        for (const double between : kBetween) add({light, eye, between, shininess});
      const double width = 1 / std::sqrt(shininess + 1);
      for (const double off : {0.01, 0.1, 0.3, 1.0, 2.0})
        for (const double side : {-1.0, 1.0}) {
          const double light = eye + side * off * width * 57.3;
          if (light >= 0 && light < 90) add({light, eye, 180, shininess});
        }
    }
    for (const double eye :
         {90.0, 90.5, 100.0})  // in the surface, and behind what an interpolated normal says
      for (const double light : {0.0, 30.0, 89.0})
        for (const double between : {0.0, 180.0}) add({light, eye, between, shininess});
  }
  // Whole rows for every width.
  while (pairs.size() % std::size(kWidths) != 0 || pairs.size() % 16 != 0) add(pairs.back().place);
  return pairs;
}

/// What the probe kernel writes: planes of pairs.
struct Probed {
  std::vector<float> n_dot_l, shares, given;  ///< the latter two three planes each
};

/// The scene's part that a model needs.
std::vector<Shader> shadersOf(const CheckedModel& model) {
  return model.shader ? std::vector{*model.shader} : std::vector<Shader>();
}
Model modelOfCheck(const CheckedModel& model) { return model.shader ? userModel(0) : model.built_in; }

Probed probe(OpenedDevice& device, const CheckedModel& model, const std::vector<Pair>& pairs) {
  const std::size_t n = pairs.size();
  Plane surfaces(20 * n), reflections(7 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Pair& pair = pairs[i];
    const glm::vec3 white(1);
    std::size_t plane = 0;
    for (const glm::vec3* v : {&pair.normal, &pair.way, &pair.to_eye, &pair.tangent, &white, &white})
      for (int c = 0; c < 3; ++c) surfaces[plane++ * n + i] = (*v)[c];
    surfaces[plane++ * n + i] = pair.shininess;
    surfaces[plane * n + i] = pair.inverse;
  }
  FeatureSet features;
  for (const Feature feature : {Feature::kPointLights, Feature::kSpecular, featureOf(modelOfCheck(model))})
    features.set(feature);
  features.set(Feature::kTangents, usesTangents(shadersOf(model)));
  const std::string user_text = shaderProgram(shadersOf(model), ShaderKind::kModel);
  Kernel kernel = makeKernel(device, "model_probe.cl", "model_probe",
                             featureDefines(features) + mathDefines({}), user_text);
  const Buffer<const float> in = borrowed(device, surfaces);
  const Buffer<float> out = borrowedForOutput(device, reflections);
  launch(device, kernel,
         {{"stride", uint(n)}, {"model", uint(modelOfCheck(model))}, {"surfaces", in}, {"reflections", out}},
         {.items = n / std::size_t(device.description.lanes)});
  download(device, out, reflections);
  const auto planes = [&](std::size_t first, std::size_t count) {
    return std::vector<float>(reflections.begin() + std::ptrdiff_t(first * n),
                              reflections.begin() + std::ptrdiff_t((first + count) * n));
  };
  const bool is_user = model.shader.has_value();
  return {planes(0, 1), planes(1, 3), planes(is_user ? 4 : 1, 3)};
}

ReflectionQuery queryOf(const Pair& pair) {
  return {glm::normalize(glm::dvec3(pair.normal)),
          glm::normalize(glm::dvec3(pair.way)),
          glm::normalize(glm::dvec3(pair.to_eye)),
          glm::normalize(glm::dvec3(pair.tangent)),
          glm::dvec3(1),
          glm::dvec3(1),
          double(pair.shininess)};
}

/// The diffuse factor, and that of a specular colour of 1.
struct Parts {
  double diffuse = 0, specular = 0;
};

/// The model in double: a built-in one as the papers have it, one from a file by its text.
std::vector<Parts> truthOf(const CheckedModel& model, const std::vector<ReflectionQuery>& queries) {
  std::vector<Parts> parts(queries.size());
  if (model.shader) {
    const std::vector<ReflectionFactors> factors = trueReflections(shadersOf(model), 0, queries);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Reflected reflected = reflectedBy(factors[i], glm::dvec3(1));
      parts[i] = {reflected.diffuse, reflected.specular.x};
    }
  } else {
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
      const ReflectionQuery& query = queries[i];
      const Reflected reflected = reflectedLight(model.built_in, {query.normal, query.to_light, query.to_eye},
                                                 glm::dvec3(1), query.shininess);
      parts[i] = {reflected.diffuse, reflected.specular.x};
    });
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (glm::dot(queries[i].normal, queries[i].to_light) <= 0) parts[i] = {};
  return parts;
}

void raise(PlacedValue& largest, double value, const Place& at) {
  if (value > largest.value) largest = {value, at};
}

/// The error that float's rounding may make in a pair, as a share of the larger of 1 and the exact value.
///
/// A direction's components are rounded to u = 2^-24, and so is what is computed of them. A cosine c has the
/// relative error u/c then. A lobe of the shininess n is some 1/√n wide, so that a direction's error of u
/// moves it by √n·u of its height. Some 16 such errors may come together. A power n below 1 of a small number
/// has no steepest slope: an error e of the number becomes eⁿ.
double allowedError(const Pair& pair) {
  const double cosine =
      std::min(std::abs(std::cos(radians(pair.place.light))), std::abs(std::cos(radians(pair.place.eye))));
  constexpr double kError = 16 * 0x1p-24;
  const double n = pair.shininess, smooth = kError * (4 + std::sqrt(n)) / std::max(cosine, 0x1p-24);
  return n > 0 && n < 1 ? std::max(smooth, std::pow(kError, n)) : smooth;
}

/// The distance of the floats around an exact value.
double ulpOf(double value) { return std::exp2(std::floor(std::log2(value)) - 23); }

void compareWithTruth(const CheckedModel& model, const std::vector<Pair>& pairs, const Probed& probed,
                      ModelCheck& check) {
  const std::size_t n = pairs.size();
  std::vector<ReflectionQuery> queries;
  for (const Pair& pair : pairs) queries.push_back(queryOf(pair));
  const std::vector<Parts> exact = truthOf(model, queries);
  for (const double shininess : kShininesses) {
    ModelError error{.shininess = shininess};
    std::size_t values = 0, large_values = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (pairs[i].place.shininess != shininess || !(probed.n_dot_l[i] > 0)) continue;
      const double specular = double(probed.shares[i + n]) + double(probed.shares[i + 2 * n]);
      for (const auto& [computed, truth] :
           {std::pair(double(probed.shares[i]), exact[i].diffuse), std::pair(specular, exact[i].specular)}) {
        const double off = std::abs(computed - truth), share = off / std::max(1.0, truth);
        raise(error.largest, share, pairs[i].place);
        raise(error.of_allowed, share / allowedError(pairs[i]), pairs[i].place);
        error.mean += share;
        ++values;
        if (truth < 0x1p-10) continue;
        error.largest_ulps = std::max(error.largest_ulps, off / ulpOf(truth));
        error.mean_ulps += off / ulpOf(truth);
        ++large_values;
      }
    }
    error.mean /= double(std::max<std::size_t>(values, 1));
    error.mean_ulps /= double(std::max<std::size_t>(large_values, 1));
    check.errors.push_back(error);
  }
}

void lookForFaults(const std::vector<Pair>& pairs, const Probed& probed, ModelCheck& check) {
  const std::size_t n = pairs.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(probed.n_dot_l[i] > 0)) continue;
    bool nan = false, infinite = false, negative = false;
    for (int plane = 0; plane < 3; ++plane) {
      const float given = probed.given[i + plane * n];
      nan |= std::isnan(given);
      infinite |= given > 0x1p60f;
      negative |= given < 0;
    }
    check.nan += nan;
    check.infinite += infinite;
    check.negative += negative;
    if ((nan || infinite || negative) && !check.first_faulty) check.first_faulty = pairs[i].place;
  }
}

void compareWidths(const CheckedModel& model, const std::vector<Pair>& pairs, const std::string& selector,
                   const Probed& probed, ModelCheck& check) {
  for (const int lanes : kWidths) {
    OpenedDevice device;
    openDevice(fmt::format("{},lanes={}", selector, lanes), device);
    device.owns_stderr = true;
    device.compiles_quickly = true;
    const Probed other = probe(device, model, pairs);
    check.lanes.push_back(lanes);
    // What users gave counts too, but for NaN, which has many bits.
    for (std::size_t i = 0; i < 3 * pairs.size() && !check.other_bits; ++i) {
      const bool same = std::memcmp(&probed.shares[i], &other.shares[i], sizeof(float)) == 0 &&
                        (probed.given[i] == other.given[i] || std::isnan(probed.given[i]));
      if (!same) check.other_bits = pairs[i % pairs.size()].place;
    }
  }
}

/// BRDFs of the directions swapped differ by so much at most, of pairs that reflect anything to speak of.
void testReciprocity(const CheckedModel& model, ModelCheck& check) {
  std::vector<Place> places;
  std::vector<ReflectionQuery> there, back;
  for (const double shininess : kWideLobes)
    for (int light = 5; light < 90; light += 10)
      for (int eye = 5; eye < light; eye += 10)
        for (int between = 0; between <= 180; between += 30) {
          places.push_back({double(light), double(eye), double(between), shininess});
          ReflectionQuery query = queryOf(pairAt(places.back(), 0));
          there.push_back(query);
          std::swap(query.to_light, query.to_eye);
          back.push_back(query);
        }
  const std::vector<Parts> a = truthOf(model, there), b = truthOf(model, back);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double of_light = glm::dot(there[i].normal, there[i].to_light),
                 of_eye = glm::dot(there[i].normal, there[i].to_eye);
    const auto compare = [&](double f, double g, PlacedValue& largest) {
      const double one = f / of_light, other = g / of_eye, most = std::max(one, other);
      if (most > 1e-3) raise(largest, std::abs(one - other) / most, places[i]);
    };
    compare(a[i].specular, b[i].specular, check.reciprocity);
    compare(a[i].diffuse, b[i].diffuse, check.diffuse_reciprocity);
  }
}

/// By midpoints of 128 angles from the normal and 256 around it, of all lights for one eye.
void sumAlbedo(const CheckedModel& model, ModelCheck& check) {
  constexpr int kRings = 128, kTurns = 256;
  const Frame frame = frameAround(kNormals[0]);
  for (const double shininess : kWideLobes) {
    AlbedoCurve curve{.shininess = shininess};
    for (const double degrees : {0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 75.0, 80.0, 85.0, 88.0}) {
      std::vector<ReflectionQuery> queries;
      std::vector<double> solid_angles;
      for (int ring = 0; ring < kRings; ++ring)
        for (int turn = 0; turn < kTurns; ++turn) {
          const double theta = (ring + 0.5) / kRings * std::numbers::pi / 2,
                       phi = (turn + 0.5) / kTurns * 2 * std::numbers::pi;
          queries.push_back({frame.normal, directionIn(frame, theta, phi),
                             directionIn(frame, radians(degrees), 0), frame.tangent, glm::dvec3(1),
                             glm::dvec3(1), shininess});
          solid_angles.push_back(std::sin(theta) * (std::numbers::pi / 2 / kRings) *
                                 (2 * std::numbers::pi / kTurns));
        }
      const std::vector<Parts> parts = truthOf(model, queries);
      double diffuse = 0, specular = 0;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        diffuse += parts[i].diffuse * solid_angles[i] / std::numbers::pi;
        specular += parts[i].specular * solid_angles[i] / std::numbers::pi;
      }
      curve.degrees.push_back(degrees);
      curve.diffuse.push_back(diffuse);
      curve.specular.push_back(specular);
    }
    check.albedo.push_back(std::move(curve));
  }
}

void drawLobes(const CheckedModel& model, ModelCheck& check) {
  const Frame frame = frameAround(kNormals[0]);
  for (const double light : {0.0, 20.0, 40.0, 60.0, 80.0})
    for (const double shininess : {8.0, 32.0, 128.0}) {
      Lobe lobe{.light_degrees = light, .shininess = shininess};
      std::vector<ReflectionQuery> queries;
      for (int half = -180; half <= 180; ++half) {
        const double degrees = half / 2.0;
        lobe.degrees.push_back(degrees);
        queries.push_back({frame.normal, directionIn(frame, radians(light), 0),
                           directionIn(frame, radians(degrees), 0), frame.tangent, glm::dvec3(1),
                           glm::dvec3(1), shininess});
      }
      for (const Parts& parts : truthOf(model, queries)) lobe.value.push_back(parts.diffuse + parts.specular);
      check.lobes.push_back(std::move(lobe));
    }
}

/// Pairs of many pixels and lights in all of which something is lit.
void measureTime(OpenedDevice& device, const CheckedModel& model, ModelCheck& check) {
  constexpr int kSide = 256, kLights = 64, kRounds = 5;
  AllPairs pairs = makeAllPairs(glm::ivec2(kSide), kLights);
  pairs.scene.user_models = shadersOf(model);
  const double count = double(kSide) * kSide * kLights;
  const auto shadeBy = [&](Model by) {
    RenderSettings settings;
    settings.shade.culling = Culling::kNone;
    settings.shade.model = by;
    Stats stats;
    shadeGBuffer(device, pairs.scene, pairs.gbuffer, settings, stats);
    return 1e6 * stageTime(stats, Stage::kShade) / count;
  };
  const auto run = [&](std::size_t row) {
    return row == 0   ? shadeBy(modelOfCheck(model))
           : row == 1 ? shadeBy(Model::kPhong)
                      : 1e6 * roofMilliseconds(device, pairs) / count;
  };
  for (std::size_t row = 0; row < 3; ++row) run(row);  // compiles
  const auto rounds =
      runInRounds(3, kRounds, "time", {}, [&](std::size_t row) { return std::vector{run(row)}; });
  check.nanoseconds = rounds[0].summary(0);
  check.phong_nanoseconds = rounds[1].summary(0);
  check.roof_nanoseconds = rounds[2].summary(0);
}

std::string placeText(const Place& place) {
  return fmt::format("light {:.6g} and eye {:.6g} degrees from the normal, {:.0f} between, shininess {:g}",
                     place.light, place.eye, place.between, place.shininess);
}

void judge(ModelCheck& check) {
  if (check.other_bits)
    check.broken.push_back("lane widths give other bits: " + placeText(*check.other_bits));
  if (check.first_faulty)
    check.broken.push_back(fmt::format("of {} pairs {} are NaN, {} infinite and {} negative; the first: {}",
                                       check.pairs, check.nan, check.infinite, check.negative,
                                       placeText(*check.first_faulty)));
  const auto worst = std::max_element(
      check.errors.begin(), check.errors.end(),
      [](const ModelError& a, const ModelError& b) { return a.of_allowed.value < b.of_allowed.value; });
  if (worst->of_allowed.value > 1)
    check.broken.push_back(fmt::format("the error is {:.2g} of what float's rounding explains: {}",
                                       worst->of_allowed.value, placeText(worst->of_allowed.at)));
}

/// Oclgrind interprets kernels and reports reads of what was never written, and of what isn't there.
void runUnderOclgrind(const CheckedModel& model, const std::string& program, ModelCheck& check) {
  const std::string oclgrind = programFile("oclgrind");
  if (oclgrind.empty()) return;
  const ScratchFolder folder;
  runChild(
      oclgrind,
      {"--uninitialized", "--check-api", "--max-errors", "3", "--log", folder / "reports", "--build-options",
       "-disable-llvm-passes -DSTANDARD_ONLY", program, "check-model", model.name, "--probe-only"},
      {});
  std::istringstream reports(isFile(folder / "reports") ? readFile(folder / "reports") : "");
  check.oclgrind.emplace();
  while (check.oclgrind->empty() && std::getline(reports, *check.oclgrind)) continue;
  if (!check.oclgrind->empty()) check.broken.push_back("Oclgrind reports: " + forMessage(*check.oclgrind));
}

}  // namespace

void probeFew(const CheckedModel& model) {
  OpenedDevice device;
  openDevice("", device);
  // Of what lies in the host's memory Oclgrind doesn't know that it was written.
  device.shares_host_memory = false;
  std::vector<Pair> pairs = hardPairs();
  pairs.resize(64);
  probe(device, model, pairs);
}

ModelCheck checkModel(const CheckedModel& model, const std::string& selector, const std::string& program) {
  ModelCheck check;
  check.name = model.name;
  if (model.shader) check.loose = shaderFacts(*model.shader, ShaderKind::kModel).loose;
  OpenedDevice device;
  openDevice(selector, device);
  device.owns_stderr = true;
  const std::vector<Pair> pairs = hardPairs();
  check.pairs = pairs.size();
  const Probed probed = probe(device, model, pairs);
  lookForFaults(pairs, probed, check);
  compareWithTruth(model, pairs, probed, check);
  compareWidths(model, pairs, selector, probed, check);
  testReciprocity(model, check);
  sumAlbedo(model, check);
  drawLobes(model, check);
  measureTime(device, model, check);
  judge(check);
  if (!program.empty()) runUnderOclgrind(model, program, check);
  return check;
}

}  // namespace luciole
