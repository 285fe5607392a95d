#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "gbuffer/layouts.hpp"
#include "image/exr_input.hpp"
#include "image/layers.hpp"

namespace luciole {

/// A layer's pixels, row by row. False if the file lacks the layer.
struct LayerPlanes {
  std::array<const float*, 3> planes{};
  std::array<std::string, 3> names;

  explicit operator bool() const { return planes[0] != nullptr; }
  float value(std::size_t pixel, int component = 0) const { return planes[component][pixel]; }
  glm::vec3 vector(std::size_t pixel) const { return {value(pixel, 0), value(pixel, 1), value(pixel, 2)}; }
};

/// An EXR whose layers are read.
class LayerReader {
 public:
  /// Reads the headers. Throws InputError.
  explicit LayerReader(const std::string& path);

  const std::vector<PicturePart>& parts() const { return exr_.parts(); }

  /// Reads the channels of these layers, which stay in this object's memory. One call a reader. Throws
  /// InputError and MachineError, also where parts differ in size or place.
  void read(const std::vector<FoundLayer>& layers);

  /// The planes of a layer that was read.
  LayerPlanes planes(const FoundLayer& layer) const;

 private:
  std::string path_;
  ExrInput exr_;
  std::vector<ChannelPlanes> memory_;
  std::map<std::pair<int, int>, const float*> planes_;  ///< by part and channel
};

}  // namespace luciole
