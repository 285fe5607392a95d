#include "raster/empty_gbuffer.hpp"

#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "base/picture_size.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "luciole/planes.hpp"

namespace luciole {

void checkView(const View& view) {
  const auto& [size, origin, crop] = std::tie(view.size, view.crop_origin, view.crop_size);
  if (size.x < 1 || size.y < 1 || size.x > kLargestSide || size.y > kLargestSide)
    throw InputError(fmt::format("size: a picture of {}x{} pixels, expected 1 to {} a side", size.x, size.y,
                                 kLargestSide));
  if (origin.x < 0 || origin.y < 0 || crop.x < 1 || crop.y < 1 || crop.x > size.x - origin.x ||
      crop.y > size.y - origin.y)
    throw InputError(fmt::format("crop: {}x{} pixels at {},{}, expected a part of the picture of {}x{}",
                                 crop.x, crop.y, origin.x, origin.y, size.x, size.y));
}

GBuffer emptyGBuffer(const View& view, PlaneSet planes, GBuffer recycled) {
  GBuffer gbuffer = std::move(recycled);
  gbuffer.width = view.crop_size.x;
  gbuffer.height = view.crop_size.y;
  gbuffer.tiles_x = (gbuffer.width + kTileSize - 1) / kTileSize;
  gbuffer.tiles_y = (gbuffer.height + kTileSize - 1) / kTileSize;
  gbuffer.camera = viewCamera(view);
  gbuffer.picture_size = view.size;
  gbuffer.crop_origin = view.crop_origin;
  allocatePlanes(planes, gbuffer);
  return gbuffer;
}

GBuffer emptyPoints(const View& view, glm::ivec2 tiles, PlaneSet planes, GBuffer recycled) {
  GBuffer gbuffer = std::move(recycled);
  gbuffer.tiles_x = tiles.x;
  gbuffer.tiles_y = tiles.y;
  gbuffer.width = tiles.x * kTileSize;
  gbuffer.height = tiles.y * kTileSize;
  gbuffer.camera = viewCamera(view);
  gbuffer.picture_size = {gbuffer.width, gbuffer.height};
  allocatePlanes(planes, gbuffer);
  return gbuffer;
}

}  // namespace luciole
