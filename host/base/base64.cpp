#include "base/base64.hpp"

#include <nettle/base64.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace luciole {

std::string base64(std::string_view bytes) {
  std::string text(BASE64_ENCODE_RAW_LENGTH(bytes.size()), '\0');
  base64_encode_raw(text.data(), bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return text;
}

std::optional<std::string> fromBase64(std::string_view text) {
  const std::size_t end = std::min(text.find('='), text.size());
  if (text.find_first_not_of("= \t\r\n", end) != std::string_view::npos) return {};
  std::string digits(text.substr(0, end));
  for (char& c : digits) c = c == '-' ? '+' : c == '_' ? '/' : c;  // the alphabet for URLs
  base64_decode_ctx context;
  base64_decode_init(&context);
  std::string bytes(BASE64_DECODE_LENGTH(digits.size()), '\0');
  std::size_t count = bytes.size();
  const bool is_valid = base64_decode_update(&context, &count, reinterpret_cast<std::uint8_t*>(bytes.data()),
                                             digits.size(), digits.data()) != 0;
  constexpr unsigned kDigitBits = 6;  // so many left: the last digit belongs to no byte
  if (!is_valid || context.bits >= kDigitBits) return {};
  bytes.resize(count);
  return bytes;
}

}  // namespace luciole
