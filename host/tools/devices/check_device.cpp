#include "tools/devices/check_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <sstream>

#include "base/random.hpp"
#include "base/sha256.hpp"
#include "base/text_file.hpp"
#include "base/write_file.hpp"
#include "cl/build_program.hpp"
#include "cl/kernel_source.hpp"
#include "cl/launch.hpp"
#include "cl/program_cache.hpp"
#include "image/picture_hash.hpp"
#include "luciole/array_memory.hpp"
#include "luciole/primitives.hpp"
#include "render/render.hpp"

namespace luciole {
namespace {

constexpr int kRandomCases = 3000;
constexpr std::size_t kMostLanes = 16;
constexpr const char* kKernelFile = "check_arithmetic.cl";

/// One NaN for all, and zeroes for denormals.
std::uint32_t comparable(std::uint32_t bits, bool is_float) {
  const std::uint32_t size = bits & 0x7fffffff;
  if (!is_float) return bits;
  return size > 0x7f800000 ? 0x7fc00000 : size < 0x00800000 ? bits & 0x80000000 : bits;
}

std::string valueText(std::uint32_t bits, bool is_float) {
  return is_float ? fmt::format("{:.9g} ({:#010x})", std::bit_cast<float>(bits), bits)
                  : fmt::format("{:#010x}", bits);
}

std::string keptPlace(const OpenedDevice& device) {
  const std::string folder = userCache("checks");
  if (folder.empty()) return "";
  const std::string description =
      describeProgram(device, kernelSource(kKernelFile),
                      fmt::format("{} -DLANES={}{}", device.arithmetic, device.description.lanes,
                                  compilesQuickly(device) ? " quickly" : ""));
  Sha256 hash;
  hash.add(description.data(), description.size());
  return std::filesystem::path(folder) / hash.hex();
}

/// A wall of bricks of light: a ground, balls of three exponents, and lights of every kind.
Scene checkScene() {
  Scene scene;
  scene.background = {0.02f, 0.03f, 0.05f};
  scene.ambient = {0.05f, 0.05f, 0.06f};
  scene.fog.mode = FogMode::kExp2;
  scene.fog.density = glm::vec3(0.0625f);
  scene.fog.color = {0.2f, 0.25f, 0.3f};
  scene.meshes.push_back(makePrimitive({PrimitiveKind::kPlane}, 0));
  scene.meshes.push_back(makePrimitive({PrimitiveKind::kSphere, 32}, 0));
  for (const float shininess : {1.0f, 20.0f, 1000.0f}) {
    Material material;
    material.diffuse = {0.6f, 0.5f, 0.4f};
    material.ambient = material.diffuse;
    material.specular = glm::vec3(0.5f);
    material.shininess = shininess;
    scene.materials.push_back(material);
  }
  scene.objects.push_back({0, glm::scale(glm::dmat4(1), glm::dvec3(32)), -1});
  for (int ball = 0; ball < 3; ++ball)
    scene.objects.push_back(
        {1, glm::translate(glm::dmat4(1), glm::dvec3(2.5 * (ball - 1), 1, -8 + ball)), ball});
  std::uint64_t state = 22;
  for (int i = 0; i < 200; ++i) {
    Light light;
    light.kind = i % 8 == 0 ? LightKind::kSpot : LightKind::kPoint;
    for (int axis = 0; axis < 3; ++axis) {
      light.position[axis] =
          glm::dvec3(-6, 0.25, -16)[axis] + nextUniform(state) * glm::dvec3(12, 2, 14)[axis];
      light.diffuse[axis] = float(nextUniform(state));
    }
    light.specular = light.diffuse;
    light.direction = {0, -1, 0};
    light.cutoff = 0.75;
    light.exponent = float(i);
    light.attenuation = {0.5f, 0.25f, 1};
    light.range = 3;
    scene.lights.push_back(light);
  }
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.direction = {0.48, -0.6, -0.64};
  sun.diffuse = sun.specular = glm::vec3(0.25f);
  scene.lights.push_back(sun);
  Camera camera;
  camera.camera_to_world = glm::translate(glm::dmat4(1), glm::dvec3(0, 1.5, 0));
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace

const char* const kCheckedPicture = "bed358fd74b114e701af968112840053a312115bdb3e82e2044517ef59f42671";

std::vector<Operands> hardOperands() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kHard[] = {0.0f,
                             0x1p-60f,
                             0x1.fffffep-31f,
                             0.1f,
                             1.0f / 3,
                             0x1.fffffep-2f,
                             0.5f,
                             0x1.000002p-1f,
                             0x1.fffffep-1f,
                             1.0f,
                             0x1.000002p0f,
                             1.5f,
                             0x1.fffffep0f,
                             2.0f,
                             2.5f,
                             3.0f,
                             7.0f,
                             0x1.fffffep22f,
                             0x1p23f,
                             0x1.000002p23f,
                             0x1.8p23f,
                             0x1p24f,
                             0x1.000002p24f,
                             0x1.fffffep29f,
                             0x1p60f,
                             0x1.fffffep127f,
                             kInfinity};
  std::vector<float> hard;
  for (const float number : kHard) hard.insert(hard.end(), {number, -number});
  hard.push_back(std::numeric_limits<float>::quiet_NaN());
  std::vector<Operands> cases;
  // The largest number's products with fractions would do no harm, but 1 / it is a denormal.
  const auto add = [&](float a, float b, float c) { cases.push_back({a, b, c}); };
  for (std::size_t i = 0; i < hard.size(); ++i)
    for (std::size_t j = 0; j < hard.size(); ++j) {
      add(hard[i], hard[j], hard[(i + 2 * j) % hard.size()]);
      add(hard[i], hard[j], -(hard[i] * hard[j]));
    }
  std::uint64_t state = 1;
  const auto number = [&] {
    const auto bits = std::uint32_t(nextBits(state) >> 32);
    return std::bit_cast<float>((bits & 0x807fffff) | (127 - 30 + (bits >> 23) % 60) << 23);
  };
  for (int i = 0; i < kRandomCases; ++i) {
    const float a = number(), b = number();
    add(a, b, -(a * b));
    add(a, b, number());
  }
  return cases;
}

std::vector<WrongOperation> wrongOperations(std::span<const Operands> cases,
                                            std::span<const std::uint32_t> results) {
  const std::vector<std::uint32_t> expected = hostArithmetic(cases);
  std::vector<WrongOperation> wrong;
  std::size_t at = 0;
  for (const CheckedOperation& operation : checkedOperations()) {
    bool is_wrong = false;
    for (const Operands& operands : cases) {
      const std::uint32_t got = results[at], right = expected[at];
      ++at;
      if (is_wrong || comparable(got, operation.is_float) == comparable(right, operation.is_float)) continue;
      is_wrong = true;
      wrong.push_back({operation.name, operands, operation.is_float, got, right});
    }
  }
  return wrong;
}

std::string describe(const WrongOperation& wrong) {
  return fmt::format("{} of a = {:.9g}, b = {:.9g} and c = {:.9g} gives {}, not {}", wrong.name,
                     wrong.operands[0], wrong.operands[1], wrong.operands[2],
                     valueText(wrong.got, wrong.is_float), valueText(wrong.expected, wrong.is_float));
}

ArithmeticCheck checkArithmetic(OpenedDevice& device) {
  const std::vector<Operands> cases = hardOperands();
  const std::size_t stride = (cases.size() + kMostLanes - 1) / kMostLanes * kMostLanes;
  std::vector<float, ArrayAllocator<float>> columns(3 * stride);
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t i = 0; i < cases.size(); ++i) columns[column * stride + i] = cases[i][column];
  const std::span<const CheckedOperation> operations = checkedOperations();
  std::vector<int> stored(operations.size() * stride);
  Kernel kernel = makeKernel(device, kKernelFile, "check_arithmetic", "");
  {
    const Buffer<const float> in = borrowed(device, columns);
    const Buffer<int> out = makeBuffer<int>(device, stored.size());
    launch(device, kernel, {{"in", in}, {"out", out}, {"stride", uint(stride)}},
           {.items = stride / std::size_t(device.description.lanes)});
    download(device, out, stored);
  }
  std::vector<std::uint32_t> results;
  for (std::size_t i = 0; i < operations.size(); ++i)
    for (std::size_t at = 0; at < cases.size(); ++at)
      results.push_back(std::uint32_t(stored[i * stride + at]));
  ArithmeticCheck check;
  for (const WrongOperation& wrong : wrongOperations(cases, results)) check.wrong.push_back(describe(wrong));
  for (std::size_t i = 0; i < results.size(); ++i)
    results[i] = comparable(results[i], operations[i / cases.size()].is_float);
  Sha256 hash;
  hash.add(results.data(), results.size() * sizeof results[0]);
  check.sha256 = hash.hex();
  return check;
}

ArithmeticCheck knownArithmetic(OpenedDevice& device) {
  const std::string place = keptPlace(device);
  ArithmeticCheck check;
  if (!place.empty() && isFile(place)) {
    std::istringstream lines(readFile(place));
    std::getline(lines, check.sha256);
    for (std::string line; std::getline(lines, line);) check.wrong.push_back(line);
    if (check.sha256.size() == 64) return check;
  }
  check = checkArithmetic(device);
  if (place.empty()) return check;
  std::string text = check.sha256 + "\n";
  for (const std::string& line : check.wrong) text += line + "\n";
  try {
    std::filesystem::create_directories(std::filesystem::path(place).parent_path());
    writeTextFile(place, text);
  } catch (const std::exception&) {
    // A cache that can't be written to is no error: the next run checks again.
  }
  return check;
}

std::string checkPicture(OpenedDevice& device) {
  const Scene scene = checkScene();
  RenderSettings settings;
  settings.size = {96, 64};
  settings.camera = scene.cameras.front();
  settings.shade.shadows = ShadowMethod::kOff;
  Stats stats;
  return pictureHash(renderScene(device, scene, settings, stats));
}

}  // namespace luciole
