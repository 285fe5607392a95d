#include "image/header_text.hpp"

#include <nlohmann/json.hpp>

namespace luciole {

bool isUtf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

std::string headerText(const std::string& bytes) {
  if (isUtf8(bytes)) return bytes;
  std::string text;
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      text += c;
    } else {
      text += char(0xc0 | code >> 6);
      text += char(0x80 | (code & 0x3f));
    }
  }
  return text;
}

}  // namespace luciole
