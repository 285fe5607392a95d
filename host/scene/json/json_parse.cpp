#include <fmt/format.h>

#include <unordered_set>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/json_fields.hpp"

namespace luciole {
namespace {

constexpr std::size_t kDeepestNesting = 64;

/// The library's message without its own prefix.
std::string plainMessage(const Json::exception& error) {
  std::string message = error.what();
  for (const char* prefix : {"] ", "parse error at "}) {
    const std::size_t at = message.find(prefix);
    if (at != std::string::npos && at < 60) message.erase(0, at + std::string_view(prefix).size());
  }
  return forMessage(message);
}

/// Builds JSON values from the events of the library's parser. (The library's own builder with a callback
/// scans all of an array's elements whenever one ends: minutes for 200 000.)
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(const std::string& file, const std::function<bool(const JsonNode&)>& take)
      : file_(file), take_(take) {}
  Json takeWhole() { return std::move(whole_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // not in JSON text
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    levels_.back().key = std::move(value);
    if (!levels_.back().keys.insert(levels_.back().key).second) fail("this key is given twice");
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    if (dynamic_cast<const Json::out_of_range*>(&error))
      fail("expected a finite number: " + plainMessage(error));
    refuse({nullptr, nullptr, file_, JsonNode::kNoIndex}, plainMessage(error));
  }

 private:
  /// An object or array that the parser is in, and its position there.
  struct Level {
    Json value;
    std::size_t index = 0;  ///< array: of the element being read
    std::string key;        ///< object: of the member being read
    std::unordered_set<std::string> keys;
  };

  bool open(Json container) {
    if (levels_.size() == kDeepestNesting) fail(fmt::format("nested deeper than {} levels", kDeepestNesting));
    levels_.push_back({std::move(container), 0, {}, {}});
    return true;
  }

  bool close() {
    Json value = std::move(levels_.back().value);
    levels_.pop_back();
    return add(std::move(value));
  }

  bool add(Json value) {
    if (levels_.empty()) {
      whole_ = std::move(value);
      return true;
    }
    Level& level = levels_.back();
    const bool taken = levels_.size() == 2 && take_(nodes(&value).back());
    if (!taken && level.value.is_array()) level.value.push_back(std::move(value));
    if (!taken && level.value.is_object()) level.value.emplace(level.key, std::move(value));
    ++level.index;
    return true;
  }

  /// The chain of nodes from the file to the value being read; the last is that value's.
  std::vector<JsonNode> nodes(const Json* value) const {
    std::vector<JsonNode> chain;
    chain.reserve(levels_.size() + 1);  // nodes point to each other: the vector must not move
    chain.push_back({nullptr, nullptr, file_, JsonNode::kNoIndex});
    for (const Level& level : levels_) {
      const JsonNode* parent = &chain.back();
      const bool is_array = level.value.is_array();
      chain.push_back({nullptr, parent, is_array ? std::string_view() : level.key,
                       is_array ? level.index : JsonNode::kNoIndex});
    }
    chain.back().json = value;
    return chain;
  }

  [[noreturn]] void fail(const std::string& what) const { refuse(nodes(nullptr).back(), what); }

  const std::string& file_;
  const std::function<bool(const JsonNode&)>& take_;
  std::vector<Level> levels_;
  Json whole_;
};

}  // namespace

Json parseJson(const std::string& text, const std::string& file,
               const std::function<bool(const JsonNode&)>& take) {
  // The parser takes a zero for the end of the text.
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    throw InputError(fmt::format("{}: byte {} is 0, expected text in UTF-8", file, zero + 1));
  Builder builder(file, take);
  Json::sax_parse(text, &builder, Json::input_format_t::json, true, true);
  return builder.takeWhole();
}

}  // namespace luciole
