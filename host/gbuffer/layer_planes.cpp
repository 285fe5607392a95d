#include "gbuffer/layer_planes.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

std::string placeOf(const PicturePart& part) {
  return fmt::format("{} x {} pixels at {},{} of {} x {}", part.size.x, part.size.y, part.crop_origin.x,
                     part.crop_origin.y, part.picture_size.x, part.picture_size.y);
}

}  // namespace

LayerReader::LayerReader(const std::string& path) : path_(path), exr_(path) {}

void LayerReader::read(const std::vector<FoundLayer>& layers) {
  std::map<int, std::set<int>> wanted;
  for (const FoundLayer& layer : layers)
    for (const int channel : layer.channels)
      if (layer.isThere() && channel >= 0) wanted[layer.part].insert(channel);
  const PicturePart* first = nullptr;
  for (const auto& [part, channels] : wanted) {
    const PicturePart& one = parts()[std::size_t(part)];
    if (!first) first = &one;
    if (one.size != first->size || one.crop_origin != first->crop_origin ||
        one.picture_size != first->picture_size)
      throw InputError(fmt::format("{}: parts {} and {} differ: {}, and {}", path_, forMessage(first->name),
                                   forMessage(one.name), placeOf(*first), placeOf(one)));
  }
  if (!first) return;
  for (const auto& [part, channels] : wanted) {
    const std::vector<int> list(channels.begin(), channels.end());
    const std::size_t pixels = std::size_t(first->size.x) * std::size_t(first->size.y);
    memory_.push_back(exr_.read(part, list));
    for (std::size_t i = 0; i < list.size(); ++i)
      planes_[{part, list[i]}] = memory_.back().data() + i * pixels;
  }
}

LayerPlanes LayerReader::planes(const FoundLayer& layer) const {
  LayerPlanes planes;
  if (!layer.isThere()) return planes;
  for (std::size_t i = 0; i < 3; ++i) {
    if (layer.channels[i] < 0) continue;
    planes.planes[i] = planes_.at({layer.part, layer.channels[i]});
    planes.names[i] = forMessage(parts()[std::size_t(layer.part)].channels[std::size_t(layer.channels[i])]);
  }
  return planes;
}

}  // namespace luciole
