#include "gbuffer/validate_gbuffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/picture_size.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "luciole/validate_scene.hpp"
#include "scene/models.hpp"

namespace luciole {

void validateGBuffer(const GBuffer& gbuffer) {
  for (const auto& [field, size] : {std::pair("gbuffer", glm::ivec2(gbuffer.width, gbuffer.height)),
                                    {"gbuffer.picture_size", gbuffer.picture_size}})
    if (size.x < 1 || size.y < 1 || size.x > kLargestSide || size.y > kLargestSide)
      throw InputError(
          fmt::format("{}: {}x{} pixels, expected 1 to {} a side", field, size.x, size.y, kLargestSide));
  if (glm::any(glm::greaterThan(glm::abs(gbuffer.crop_origin), glm::ivec2(kLargestSide))))
    throw InputError(fmt::format("gbuffer.crop_origin: ({}, {}), expected at most {}", gbuffer.crop_origin.x,
                                 gbuffer.crop_origin.y, kLargestSide));
  const auto tiles = [](int side) { return (side + kTileSize - 1) / kTileSize; };
  if (gbuffer.tiles_x != tiles(gbuffer.width) || gbuffer.tiles_y != tiles(gbuffer.height))
    throw InputError(fmt::format("gbuffer: {}x{} tiles, expected {}x{}", gbuffer.tiles_x, gbuffer.tiles_y,
                                 tiles(gbuffer.width), tiles(gbuffer.height)));
  const std::size_t pixels = gbuffer.pixels();
  const auto check = [&](const char* plane, std::size_t size, std::size_t components, bool optional = true) {
    if (size != components * pixels && !(optional && size == 0))
      throw InputError(
          fmt::format("gbuffer.{}: has {} numbers, expected {}", plane, size, components * pixels));
  };
  check("position", gbuffer.position.size(), 3, false);
  check("normal", gbuffer.normal.size(), 3, false);
  check("diffuse", gbuffer.diffuse.size(), 3, false);
  check("specular", gbuffer.specular.size(), 4);
  check("ambient", gbuffer.ambient.size(), 3);
  check("emission", gbuffer.emission.size(), 3);
  check("geometric_normal", gbuffer.geometric_normal.size(), 1);
  check("unbent_normal", gbuffer.unbent_normal.size(), 1);
  if (!gbuffer.geometric_normal.empty() && !gbuffer.unbent_normal.empty())
    throw InputError("gbuffer.unbent_normal: beside geometric_normal, expected one of them");
  check("lift", gbuffer.lift.size(), 1);
  check("model", gbuffer.model.size(), 1);
  check("tangent", gbuffer.tangent.size(), 1);
  check("uv", gbuffer.uv.size(), 2);
  check("object", gbuffer.object.size(), 1);
  check("material", gbuffer.material.size(), 1);
  if (std::any_of(gbuffer.model.begin(), gbuffer.model.end(),
                  [](std::uint32_t number) { return number > kMostModelNumber; }))
    throw InputError(fmt::format("gbuffer.model: has a number above {}", kMostModelNumber));
  if (const std::string fault = cameraFault(gbuffer.camera); !fault.empty() && gbuffer.knows_camera)
    throw InputError("gbuffer.camera." + fault);
}

}  // namespace luciole
