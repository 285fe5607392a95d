#include "tools/bench/variants.hpp"
#include "scene/models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace luciole {
namespace {

/// The degrees of kernels/math.clh other than the defaults.
constexpr int kLog2Degrees[] = {3, 4, 5, 6, 8, 9};
constexpr int kExp2Degrees[] = {2, 3, 4, 5, 7};

constexpr std::pair<ShadowMethod, const char*> kSharpMethods[] = {
    {ShadowMethod::kHard, "hard"}, {ShadowMethod::kPcf, "pcf"}, {ShadowMethod::kExact, "exact"}};

VariantGroup shadingVariants(int lanes) {
  Variant usual{.lanes = lanes, .is_default = true};
  usual.shade.shadows = ShadowMethod::kOff;
  usual.name =
      fmt::format("lanes {}, log2 {}, exp2 {}", lanes, usual.shade.log2_degree, usual.shade.exp2_degree);
  VariantGroup group{.name = "shading",
                     .chosen_by = "shading",
                     .measured = "culling and shading, against the same G-buffer shaded in double precision",
                     .stages = {Stage::kCull, Stage::kShade},
                     .variants = {usual}};
  const auto add = [&](const std::string& name, auto&& change) {
    Variant variant = usual;
    variant.name = name;
    variant.is_default = false;
    change(variant);
    group.variants.push_back(variant);
  };
  for (const int other : {1, 4, 8, 16})
    if (other != lanes) add(fmt::format("lanes {}", other), [&](Variant& v) { v.lanes = other; });
  add("no culling", [](Variant& v) { v.shade.culling = Culling::kNone; });
  for (const int degree : kLog2Degrees)
    add(fmt::format("log2 {}", degree), [&](Variant& v) { v.shade.log2_degree = degree; });
  for (const int degree : kExp2Degrees)
    add(fmt::format("exp2 {}", degree), [&](Variant& v) { v.shade.exp2_degree = degree; });
  return group;
}

VariantGroup modelVariants(int lanes) {
  VariantGroup group{.name = "models",
                     .chosen_by = "models",
                     .measured = "culling and shading, each model against itself in double precision",
                     .stages = {Stage::kCull, Stage::kShade}};
  for (const Model model : kAllModels) {
    Variant variant{.name = modelName(model), .lanes = lanes, .is_default = model == ShadeSettings{}.model};
    variant.shade.model = model;
    variant.shade.shadows = ShadowMethod::kOff;
    group.variants.push_back(variant);
  }
  return group;
}

bool hasSize(const Light& light) {
  return light.shadow && (light.kind == LightKind::kDirectional ? light.half_angle : light.radius) > 0;
}

Variant shadowVariant(int lanes, ShadowMethod method, const std::string& name, int size) {
  const ShadeSettings usual;
  Variant variant{.name = fmt::format("{} {}", name, size), .lanes = lanes};
  variant.shade.shadows = method;
  variant.shade.shadow_limits.size = size;
  variant.is_default = method == usual.shadows && size == usual.shadow_limits.size;
  return variant;
}

VariantGroup shadowGroup(const std::string& name, const std::string& truth, TruthShadows shadows) {
  return {.name = name,
          .chosen_by = "shadows",
          .measured = "shadow maps, culling and shading, against " + truth +
                      " from the same G-buffer in double precision",
          .stages = {Stage::kFindShadowTexels, Stage::kShadowMaps, Stage::kTriangleTree, Stage::kCull,
                     Stage::kBeamShadows, Stage::kShadowRays, Stage::kShade},
          .shadows = shadows};
}

/// One group, or two if lights have a size. The truth of the second has their penumbrae; in it the methods
/// that take lights for points have a row each, too.
std::vector<VariantGroup> shadowVariants(const Scene& scene, int lanes, std::optional<int> only_size) {
  const std::vector<int> sizes =
      only_size ? std::vector{*only_size} : std::vector(std::begin(kShadowSizes), std::end(kShadowSizes));
  const int usual_size = only_size.value_or(ShadowLimits{}.size);
  Variant off{.name = "no shadows", .lanes = lanes};
  off.shade.shadows = ShadowMethod::kOff;
  std::vector<VariantGroup> groups{
      shadowGroup("shadows", "shadows by rays to the lights' middles", TruthShadows::kSharp)};
  for (const auto& [method, name] : kSharpMethods)
    for (const int size : sizes) groups[0].variants.push_back(shadowVariant(lanes, method, name, size));
  const bool soft = std::any_of(scene.lights.begin(), scene.lights.end(), hasSize);
  if (soft) {
    groups[0].variants.push_back(off);
    groups.push_back(shadowGroup("soft shadows", "shadows by many rays to each light that has a size",
                                 TruthShadows::kSoft));
    for (const auto& [method, name] : kSharpMethods)
      groups[1].variants.push_back(shadowVariant(lanes, method, name, usual_size));
  }
  for (const int size : sizes)
    groups.back().variants.push_back(shadowVariant(lanes, ShadowMethod::kSoft, "soft", size));
  for (const int samples : kSoftSamples) {
    if (!soft) break;
    Variant variant = shadowVariant(lanes, ShadowMethod::kSoftExact, "soft-exact", usual_size);
    variant.name = fmt::format("soft-exact, {} samples", samples);
    variant.shade.soft_samples = samples;
    groups.back().variants.push_back(variant);
  }
  groups.back().variants.push_back(off);
  return groups;
}

VariantGroup sampleVariants(int lanes) {
  VariantGroup group{.name = "samples",
                     .chosen_by = "samples",
                     .measured =
                         "the whole picture but shadows, against the mean of many more samples in "
                         "double precision",
                     .samples = true};
  for (const int samples : {1, 2, 4, 8, 16}) {
    Variant variant{.name = fmt::format("samples {}", samples),
                    .lanes = lanes,
                    .samples = samples,
                    .is_default = samples == 1};
    variant.shade.shadows = ShadowMethod::kOff;
    group.variants.push_back(variant);
  }
  return group;
}

}  // namespace

bool haveOneTruth(const VariantGroup& group) {
  return std::all_of(group.variants.begin(), group.variants.end(), [&](const Variant& variant) {
    return variant.shade.model == group.variants.front().shade.model;
  });
}

std::vector<VariantGroup> benchVariants(const Scene& scene, int lanes, std::optional<int> shadow_size) {
  std::vector<VariantGroup> groups{shadingVariants(lanes), modelVariants(lanes)};
  const bool shadows = scene.lighting && std::any_of(scene.lights.begin(), scene.lights.end(),
                                                     [](const Light& l) { return l.shadow; });
  if (shadows)
    for (VariantGroup& group : shadowVariants(scene, lanes, shadow_size)) groups.push_back(std::move(group));
  groups.push_back(sampleVariants(lanes));
  return groups;
}

}  // namespace luciole
