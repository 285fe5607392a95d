#include "image/srgb.hpp"

namespace luciole {

const std::vector<float>& linearOfSrgb16() {
  static const std::vector<float> table = [] {
    std::vector<float> values(65536);
    for (int code = 0; code < 65536; ++code) values[code] = float(decodeSrgb(code / 65535.0));
    return values;
  }();
  return table;
}

}  // namespace luciole
