#include "experiment/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace luciole {
namespace {

/// Degrees that kernels/math.clh has besides the defaults.
constexpr int kLog2Degrees[] = {3, 4, 5, 6, 7, 9};
constexpr int kExp2Degrees[] = {2, 3, 4, 5, 7};

constexpr std::pair<ShadowMethod, const char*> kFilters[] = {{ShadowMethod::kHard, "hard"},
                                                             {ShadowMethod::kPcf, "pcf"}};
constexpr int kShadowSizes[] = {512, 1024, 2048, 4096};

VariantGroup shadingVariants(int lanes) {
  Variant usual{.lanes = lanes, .is_default = true};
  usual.shade.shadows = ShadowMethod::kOff;
  usual.name =
      fmt::format("lanes {}, log2 {}, exp2 {}", lanes, usual.shade.log2_degree, usual.shade.exp2_degree);
  VariantGroup group{.name = "shading",
                     .measured = "culling and shading, against the same G-buffer shaded in double precision",
                     .stages = {"cull", "shade"},
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
                     .measured = "culling and shading, each model against itself in double precision",
                     .stages = {"cull", "shade"}};
  for (const Model model : kAllModels) {
    Variant variant{.name = modelName(model), .lanes = lanes, .is_default = model == ShadeSettings{}.model};
    variant.shade.model = model;
    variant.shade.shadows = ShadowMethod::kOff;
    group.variants.push_back(variant);
  }
  return group;
}

VariantGroup shadowVariants(int lanes) {
  const ShadeSettings usual;
  VariantGroup group{.name = "shadows",
                     .measured =
                         "shadow maps, culling and shading, against shadows by rays from the same "
                         "G-buffer in double precision",
                     .stages = {"find shadow texels", "shadow maps", "cull", "shade"},
                     .shadows = true};
  for (const auto& [method, name] : kFilters) {
    for (const int size : kShadowSizes) {
      Variant variant{.name = fmt::format("{} {}", name, size), .lanes = lanes};
      variant.shade.shadows = method;
      variant.shade.shadow_limits.size = size;
      variant.is_default = method == usual.shadows && size == usual.shadow_limits.size;
      group.variants.push_back(variant);
    }
  }
  Variant off{.name = "no shadows", .lanes = lanes};
  off.shade.shadows = ShadowMethod::kOff;
  group.variants.push_back(off);
  return group;
}

VariantGroup sampleVariants(int lanes) {
  VariantGroup group{.name = "samples",
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

std::vector<VariantGroup> benchVariants(const Scene& scene, int lanes) {
  std::vector<VariantGroup> groups{shadingVariants(lanes), modelVariants(lanes)};
  const bool shadows = scene.lighting && std::any_of(scene.lights.begin(), scene.lights.end(),
                                                     [](const Light& l) { return l.shadow; });
  if (shadows) groups.push_back(shadowVariants(lanes));
  groups.push_back(sampleVariants(lanes));
  return groups;
}

}  // namespace luciole
