#include "scene/scene_digest.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "base/random.hpp"
#include "scene/scene_fields.hpp"

namespace luciole {
namespace {

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Types that consist of numbers without padding, so that their bytes can be hashed.
template <class T>
struct IsPacked : std::bool_constant<Number<T> && !std::is_same_v<T, bool>> {};
template <glm::length_t Count, class T>
struct IsPacked<glm::vec<Count, T>> : std::true_type {};
template <glm::length_t Columns, glm::length_t Rows, class T>
struct IsPacked<glm::mat<Columns, Rows, T>> : std::true_type {};

struct Digest {
  std::uint64_t state = 0;
  std::unordered_map<const void*, std::uint64_t> of_shared = {};  ///< what many share is read once

  /// Mixes eight bytes into the state. The new state is a bijection of the word for each old state, and of
  /// the old state for each word, and every bit of both matters.
  void add(std::uint64_t word) {
    state ^= word;
    state = nextBits(state);
  }

  void addBytes(const void* data, std::size_t bytes) {
    const char* next = static_cast<const char*>(data);
    for (; bytes > 0;) {
      std::uint64_t word = 0;
      const std::size_t here = std::min(bytes, sizeof word);
      std::memcpy(&word, next, here);
      add(word);
      next += here;
      bytes -= here;
    }
  }

  template <class T>
  void addField(const T& value) {
    if constexpr (std::is_same_v<T, bool>)
      add(std::uint64_t(value));
    else if constexpr (IsPacked<T>::value)
      addBytes(&value, sizeof value);
    else
      withFields(value, [this](const auto&... fields) { (this->addField(fields), ...); });
  }
  void addField(const std::string& text) {
    add(text.size());
    addBytes(text.data(), text.size());
  }
  template <class T, class Allocator>
  void addField(const std::vector<T, Allocator>& values) {
    add(values.size());
    if constexpr (IsPacked<T>::value)
      addBytes(values.data(), values.size() * sizeof(T));
    else
      for (const T& value : values) addField(value);
  }
  template <class T>
  void addField(const std::optional<T>& value) {
    add(value.has_value());
    if (value) addField(*value);
  }
  template <class T>
  void addField(const std::shared_ptr<const T>& value) {
    add(value != nullptr);
    if (!value) return;
    const auto [seen, is_new] = of_shared.emplace(value.get(), 0);
    if (is_new) {
      Digest own;
      own.addField(*value);
      seen->second = own.state;
    }
    add(seen->second);
  }
};

}  // namespace

std::uint64_t sceneDigest(const Scene& scene) {
  Digest digest;
  digest.addField(scene);
  return digest.state;
}

}  // namespace luciole
