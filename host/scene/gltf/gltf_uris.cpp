#include "scene/gltf/gltf_uris.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/text_file.hpp"

namespace luciole {
namespace {

bool isHexDigit(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

/// A SAX handler that checks the URIs of a glTF file's buffers and images.
class UriCheck : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit UriCheck(const std::string& path) : path_(path) {}

  bool null() override { return next(); }
  bool boolean(bool) override { return next(); }
  bool number_integer(number_integer_t) override { return next(); }
  bool number_unsigned(number_unsigned_t) override { return next(); }
  bool number_float(number_float_t, const string_t&) override { return next(); }
  bool binary(binary_t&) override { return next(); }
  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
    return false;
  }

  bool key(string_t& name) override {
    levels_.back().key = name;
    return true;
  }

  bool string(string_t& value) override {
    // buffers[2].uri
    if (levels_.size() == 3 && levels_[2].key == "uri" &&
        (levels_[0].key == "buffers" || levels_[0].key == "images"))
      check(value, fmt::format("{}[{}].uri", levels_[0].key, levels_[1].index));
    return next();
  }

 private:
  /// An object or array that the parser is in, and its position there.
  struct Level {
    std::string key;        ///< object: of the member being read
    std::size_t index = 0;  ///< array: of the element being read
  };

  bool open() {
    levels_.emplace_back();
    return true;
  }
  bool close() {
    levels_.pop_back();
    return next();
  }
  bool next() {
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }

  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}", path_, place, what));
  }

  void check(const std::string& uri, const std::string& place) const {
    if (uri.starts_with("data:")) return;
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      if (uri[i] != '%') {
        name += uri[i];
        continue;
      }
      const std::string digits = uri.substr(i + 1, 2);
      if (digits.size() < 2 || !isHexDigit(digits[0]) || !isHexDigit(digits[1]) || digits == "00")
        fail(place, fmt::format("'%{}' stands for no character, expected % and two hexadecimal digits (a % "
                                "itself is %25)",
                                forMessage(digits)));
      name += static_cast<char>(std::strtol(digits.c_str(), nullptr, 16));
      i += 2;
    }
    std::error_code none;
    const auto status = std::filesystem::status(std::filesystem::path(path_).parent_path() / name, none);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
      fail(place, fmt::format("'{}' is not a file", forMessage(name)));
  }

  const std::string& path_;
  std::vector<Level> levels_;
};

}  // namespace

void checkUris(const std::string& path, std::string_view json) {
  UriCheck check(path);
  nlohmann::json::sax_parse(json, &check);
}

}  // namespace luciole
