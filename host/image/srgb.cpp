#include "image/srgb.hpp"

#include <cstddef>

namespace luciole {

const std::vector<float>& linearOfSrgb16() {
  static const std::vector<float> table = [] {
    std::vector<float> values(65536);
    for (int code = 0; code < 65536; ++code) values[code] = float(decodeSrgb(code / 65535.0));
    return values;
  }();
  return table;
}

const std::vector<std::uint16_t>& srgb16OfLinear16() {
  static const std::vector<std::uint16_t> table = [] {
    std::vector<std::uint16_t> codes(65536);
    for (std::size_t i = 0; i < codes.size(); ++i)
      codes[i] = std::uint16_t(encodeSrgb(float(double(i) / 65535.0)) * 65535.0f + 0.5f);
    return codes;
  }();
  return table;
}

}  // namespace luciole
