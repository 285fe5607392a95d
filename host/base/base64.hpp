#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace luciole {

/// Base 64 as in RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// The bytes of base 64, of either alphabet of RFC 4648. Blanks, line ends and missing padding are fine.
/// Empty for any other text.
std::optional<std::string> fromBase64(std::string_view text);

}  // namespace luciole
