#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/find_file.hpp"
#include "scene/place_limits.hpp"

namespace luciole {

using Json = nlohmann::json;

/// A JSON value and where it lies, for messages such as "lights[3].position[1]". A node refers to its parent
/// and to its value, which must outlive it.
struct JsonNode {
  static constexpr std::size_t kNoIndex = ~std::size_t{0};
  const Json* json = nullptr;
  const JsonNode* parent = nullptr;  ///< null for the whole file
  std::string_view key;              ///< inside an object; of the whole file: its name
  std::size_t index = kNoIndex;      ///< inside an array
};

/// "file: place: what".
std::string messageAt(const JsonNode& node, const std::string& what);

/// Throws InputError with messageAt(node, what), as the functions below do for values of another kind.
[[noreturn]] void refuse(const JsonNode& node, const std::string& what);

/// Parses JSON with // and /* */ comments. Throws InputError for syntax errors (with line and column), a key
/// given twice in one object, numbers that overflow, and more than 64 levels of nesting. `take` is called
/// with every member of a top-level member (lights[3], cameras.main) as soon as it is complete. Where it
/// returns true the value is dropped, so that a million lights are never in memory as JSON. `file` is the
/// name for messages.
Json parseJson(const std::string& text, const std::string& file,
               const std::function<bool(const JsonNode&)>& take);

/// Refuses any key that isn't among `known`, naming the nearest one that is. The node must be an object.
void allowKeys(const JsonNode& object, std::span<const std::string_view> known);
inline void allowKeys(const JsonNode& object, std::initializer_list<std::string_view> known) {
  allowKeys(object, std::span(known.begin(), known.size()));
}
/// Refuses the given keys, which mean nothing `where` ("for a point light").
void refuseKeys(const JsonNode& object, std::initializer_list<std::string_view> keys,
                const std::string& where);

/// A member of an object: find() returns nothing where it is missing, need() throws. element() is a value of
/// an array, whose index must be in range. Throws InputError where the node is no object (find, need).
std::optional<JsonNode> find(const JsonNode& object, std::string_view key);
JsonNode need(const JsonNode& object, std::string_view key);
JsonNode element(const JsonNode& array, std::size_t index);
/// Throw InputError unless the node is an object, or an array.
void needObject(const JsonNode& node);
void needArray(const JsonNode& node);

/// A number of magnitude at most kLargestNumber, so that its square is a finite float; in the second form
/// from `low` to `high`.
double readNumber(const JsonNode& node);
double readNumber(const JsonNode& node, double low, double high);
/// Between 1 / kLargestNumber and kLargestNumber.
double readPositive(const JsonNode& node);
/// A whole number from 0 to `largest`; it may be written as 1e6.
std::uint64_t readCount(const JsonNode& node, std::uint64_t largest);
/// A boolean, and a text.
bool readBool(const JsonNode& node);
std::string readText(const JsonNode& node);
/// The path of the named file, see findFile(). If there is none, the first path that was tried.
std::string pathOf(const JsonNode& node, const SearchFolders& where);
/// The reason why no file can be read at the path, or "".
std::string faultOfPath(const std::string& path);
/// The same of a file that exists. Throws InputError.
std::string readPath(const JsonNode& node, const SearchFolders& where);
/// [x,y,z], each of magnitude at most kLargestNumber.
glm::dvec3 readVector(const JsonNode& node);
/// A vector's direction, unit. Refuses a vector shorter than 1 / kLargestNumber.
glm::dvec3 readDirection(const JsonNode& node);
/// [r,g,b], or one number for all three; each ≥ 0.
glm::vec3 readColor(const JsonNode& node);
/// OpenGL's [constant, linear, quadratic], each ≥ 0, not all 0.
glm::vec3 readAttenuation(const JsonNode& node);

}  // namespace luciole
