#include "scene/obj/mtl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "luciole/error.hpp"
#include "scene/find_file.hpp"
#include "scene/load_textures.hpp"
#include "scene/obj/obj_text.hpp"

namespace luciole {
namespace {

/// A material as it is read: its statements by keyword in small letters, of several alike the last.
struct MtlSource {
  const MtlEntry& entry;
  MtlReading& reading;
  struct Statement {
    std::string keyword;  ///< as written
    std::string words;
  };
  std::map<std::string, Statement> statements = {};

  const Statement* find(const char* keyword) const {
    const auto found = statements.find(keyword);
    return found == statements.end() ? nullptr : &found->second;
  }
  std::string at(const std::string& what) const {
    return fmt::format("{}: material '{}': {}", entry.file, forMessage(entry.name), what);
  }
  void repair(const std::string& what) const {
    reading.scene.warnings.push_back({at(what), "material statement", true});
  }
  /// Says once a file that something is ignored.
  void ignore(const std::string& thing, const std::string& what) const {
    if (!reading.reported.insert({entry.file, thing}).second) return;
    reading.scene.warnings.push_back({at(what), "ignored " + thing});
  }
};

std::string inSmallLetters(std::string_view word) {
  std::string small(word);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

/// Statements that are read, those that are reported to be ignored, and those that are known and change
/// nothing here.
constexpr std::string_view kRead[] = {"ka",    "kd",   "ks",   "ke",       "ns", "illum", "map_kd", "map_ke",
                                      "map_d", "norm", "bump", "map_bump", "d",  "tr",    "map_ka"};
constexpr std::string_view kIgnoredMaps[] = {"map_ks", "map_ns",   "disp",    "map_disp", "decal",
                                             "refl",   "map_refl", "map_tr",  "map_pr",   "map_pm",
                                             "map_ps", "map_pc",   "map_pcr", "map_rma",  "map_orm"};
constexpr std::string_view kSilent[] = {"ni", "tf", "sharpness", "map_aat", "km",    "kt",    "pr",
                                        "pm", "ps", "pc",        "pcr",     "aniso", "anisor"};

template <std::size_t kCount>
bool isOneOf(const std::string& keyword, const std::string_view (&list)[kCount]) {
  return std::find(std::begin(list), std::end(list), keyword) != std::end(list);
}

MtlSource readStatements(const MtlEntry& entry, MtlReading& reading) {
  MtlSource source{entry, reading};
  for (std::string_view rest = entry.statements; !rest.empty();) {
    std::string_view words = takeLine(rest);
    const std::string_view keyword = takeWord(words);
    const std::string small = inSmallLetters(keyword);
    const bool is_ignored = isOneOf(small, kIgnoredMaps);
    if (is_ignored)
      source.ignore(small, fmt::format("{} is not drawn", keyword));
    else if (isOneOf(small, kRead))
      source.statements[small] = {std::string(keyword), std::string(trimmed(words))};
    else if (!isOneOf(small, kSilent))
      source.ignore("unknown statement",
                    fmt::format("'{}' is no statement that is known here; it and others are left out",
                                forMessage(keyword)));
  }
  return source;
}

/// CIE XYZ to linear Rec.709, white D65 (IEC 61966-2-1, with more digits).
glm::vec3 rec709OfXyz(const glm::dvec3& xyz) {
  return glm::vec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                   -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                   0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
}

/// Reads Ka, Kd, Ks or Ke: r g b, or xyz x y z. The first number stands for others that are missing.
void readColor(const MtlSource& source, const char* name, glm::vec3& color) {
  const MtlSource::Statement* const statement = source.find(name);
  if (!statement) return;
  const std::string& keyword = statement->keyword;
  std::string_view rest = withoutComment(statement->words);
  std::string_view after = rest;
  const std::string_view first = takeWord(after);
  if (isKeyword(first, "spectral")) {
    source.ignore(std::string(name) + " spectral",
                  fmt::format("{} spectral is not supported; the default is taken", keyword));
    return;
  }
  const bool is_xyz = isKeyword(first, "xyz");
  if (is_xyz) rest = after;
  glm::vec3 numbers;
  int count = 0;
  for (std::string_view word; count < 3 && !(word = takeWord(rest)).empty(); ++count) {
    const std::optional<float> number = finiteNumber(word);
    if (!number) {
      source.repair(
          fmt::format("{}: '{}' is not a finite number; the default is taken", keyword, forMessage(word)));
      return;
    }
    numbers[count] = *number;
  }
  if (count == 0 || count == 2)
    source.repair(fmt::format("{} has {} numbers, expected 1 or 3; {}", keyword, count,
                              count == 0 ? "the default is taken" : "the first is taken for the third"));
  if (count == 0) return;
  for (int i = count; i < 3; ++i) numbers[i] = numbers[0];
  if (glm::any(glm::lessThan(numbers, glm::vec3(0))))
    source.repair(fmt::format("{} has a number below 0; 0 is taken", keyword));
  numbers = glm::max(numbers, glm::vec3(0));
  if (is_xyz) numbers = glm::max(rec709OfXyz(numbers), glm::vec3(0));
  color = numbers;
}

/// A statement of one number; `otherwise` where it is missing, or no number.
float readNumber(const MtlSource& source, const char* name, float otherwise) {
  const MtlSource::Statement* const statement = source.find(name);
  if (!statement) return otherwise;
  std::string_view rest = withoutComment(statement->words);
  const std::string_view word = takeWord(rest);
  const std::optional<float> number = finiteNumber(word);
  if (!number)
    source.repair(fmt::format("{}: '{}' is not a finite number; the default is taken", statement->keyword,
                              forMessage(word)));
  return number.value_or(otherwise);
}

/// What stands before the name of a map's picture.
struct MapOptions {
  MapPlace place;
  bool clamps = false;
  float bump_scale = 1;
};

struct MapOption {
  std::string_view name;
  int least, most;  ///< arguments
  bool takes_numbers;
  std::string_view silent;  ///< what changes nothing: words, or numbers that are all the same as these
};
/// By the MTL specification; -colorspace is of other programs.
constexpr MapOption kMapOptions[] = {
    {"-blendu", 1, 1, false, "on"},   {"-blendv", 1, 1, false, "on"},   {"-boost", 1, 1, true, ""},
    {"-bm", 1, 1, true, "any"},       {"-cc", 1, 1, false, "off"},      {"-clamp", 1, 1, false, "any"},
    {"-colorspace", 1, 1, false, ""}, {"-imfchan", 1, 1, false, "l m"}, {"-mm", 2, 2, true, "0 1"},
    {"-o", 1, 3, true, "any"},        {"-s", 1, 3, true, "any"},        {"-t", 1, 3, true, "0 0 0"},
    {"-texres", 1, 1, true, ""},      {"-type", 1, 1, false, "sphere"}};

const MapOption* mapOption(std::string_view word) {
  const auto found = std::find_if(std::begin(kMapOptions), std::end(kMapOptions),
                                  [&](const MapOption& option) { return isKeyword(word, option.name); });
  return found == std::end(kMapOptions) ? nullptr : found;
}

/// Whether a word is a number, finite or not.
bool isNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && error != std::errc::invalid_argument && end == word.data() + word.size();
}

/// Takes an option's arguments off the front of `rest`. Where a name follows, the last word is that.
std::vector<std::string_view> takeArguments(const MapOption& option, bool name_follows,
                                            std::string_view& rest) {
  std::vector<std::string_view> arguments;
  while (static_cast<int>(arguments.size()) < option.most) {
    std::string_view after = rest;
    const std::string_view word = takeWord(after);
    const bool is_missing = word.empty() || (name_follows && trimmed(after).empty());
    const bool is_wanted = static_cast<int>(arguments.size()) < option.least;
    if (is_missing || (option.takes_numbers && !is_wanted && !isNumber(word))) break;
    arguments.push_back(word);
    rest = after;
  }
  return arguments;
}

bool changesNothing(const MapOption& option, const std::vector<std::string_view>& arguments) {
  std::string_view silent = option.silent;
  if (silent == "any") return true;
  if (!option.takes_numbers) {
    for (std::string_view word; !(word = takeWord(silent)).empty();)
      if (isKeyword(arguments[0], word)) return true;
    return false;
  }
  for (const std::string_view argument : arguments)
    if (finiteNumber(argument) != finiteNumber(takeWord(silent))) return false;
  return true;
}

/// Reads the options at the front of `rest`.
void takeOptions(const MtlSource& source, const std::string& keyword, bool name_follows,
                 std::string_view& rest, MapOptions& options) {
  for (;;) {
    std::string_view after = rest;
    const std::string_view word = takeWord(after);
    const MapOption* const option = mapOption(word);
    if (!option) return;
    rest = after;
    const std::vector<std::string_view> arguments = takeArguments(*option, name_follows, rest);
    const bool lacks_numbers = option->takes_numbers &&
                               !std::all_of(arguments.begin(), arguments.end(),
                                            [](std::string_view argument) { return finiteNumber(argument); });
    if (static_cast<int>(arguments.size()) < option->least || lacks_numbers) {
      source.repair(fmt::format("{}: {} has '{}', expected {}; left out", keyword, option->name,
                                forMessage(fmt::format("{}", fmt::join(arguments, " "))),
                                option->takes_numbers ? "finite numbers" : "a word"));
      continue;
    }
    if (option->name == "-clamp") options.clamps = isKeyword(arguments[0], "on");
    if (option->name == "-bm") options.bump_scale = *finiteNumber(arguments[0]);
    for (std::size_t i = 0; i < std::min<std::size_t>(arguments.size(), 2); ++i) {
      if (option->name == "-s") options.place.scale[int(i)] = *finiteNumber(arguments[i]);
      if (option->name == "-o") options.place.offset[int(i)] = *finiteNumber(arguments[i]);
    }
    if (!changesNothing(*option, arguments))
      source.ignore(std::string(option->name),
                    fmt::format("{}: the option {} is ignored", keyword, option->name));
  }
}

/// The first spelling of a name that is a file's.
std::optional<std::string> findSpelling(std::string_view name, const SearchFolders& where) {
  for (const std::string& spelling : spellings(name))
    if (const auto path = findFile(spelling, where)) return path;
  return std::nullopt;
}

/// Finds the picture that the rest of a statement names. Options may stand behind the name, and unknown ones
/// before it.
std::optional<std::string> findPicture(const MtlSource& source, const std::string& keyword,
                                       std::string_view name, MapOptions& options) {
  const SearchFolders where{std::filesystem::path(source.entry.file).parent_path().string(),
                            source.reading.search};
  if (const auto path = findSpelling(name, where)) return path;
  for (std::string_view rest = name; !rest.empty();) {
    const std::string_view word = takeWord(rest);
    std::string_view behind = {word.data() + word.size(), rest.data() + rest.size()};
    std::string_view next = behind;
    if (!mapOption(takeWord(next))) continue;
    const std::string_view before = {name.data(), word.data() + word.size()};
    const auto path = findSpelling(before, where);
    if (!path) break;
    takeOptions(source, keyword, false, behind, options);
    return path;
  }
  if (!name.starts_with('-')) return std::nullopt;
  std::string_view rest = name;
  const std::string_view option = takeWord(rest);
  MapOptions others = options;
  while (!trimmed(rest).empty()) {
    takeOptions(source, keyword, true, rest, others);
    if (const auto path = findSpelling(trimmed(rest), where)) {
      options = others;
      source.ignore("unknown option",
                    fmt::format("{}: the option {} is not known; left out", keyword, forMessage(option)));
      return path;
    }
    takeWord(rest);
  }
  return std::nullopt;
}

/// A map and where it lies.
struct MtlMap {
  TextureUse use;
  MapOptions options;
};

MtlMap readMap(const MtlSource& source, const char* name, TextureKind kind = TextureKind::kColor) {
  MtlMap map;
  const MtlSource::Statement* const statement = source.find(name);
  if (!statement) return map;
  std::string_view rest = statement->words;
  takeOptions(source, statement->keyword, true, rest, map.options);
  rest = trimmed(rest);
  if (rest.empty()) {
    source.repair(statement->keyword + " names no picture; drawn without");
    return map;
  }
  const auto path = findPicture(source, statement->keyword, rest, map.options);
  if (!path) {
    source.reading.scene.missing_textures.push_back(
        source.at(fmt::format("{}: there is no picture '{}'", statement->keyword, forMessage(rest))));
    return map;
  }
  map.use.texture = addTexture(source.reading.scene, *path, kind);
  map.use.wrap_u = map.use.wrap_v = map.options.clamps ? Wrap::kClampToEdge : Wrap::kRepeat;
  return map;
}

bool hasAlpha(const Texture& texture) {
  return texture.alpha_varies || texture.levels[0].texels[3] != 0xffff;
}

/// Reads the maps that bend normals: `norm` is for that alone; `bump` and `map_bump` mean the same.
MtlMap readBends(const MtlSource& source, Material& material) {
  const bool has_norm = source.find("norm") != nullptr;
  const char* const name = has_norm ? "norm" : source.find("bump") ? "bump" : "map_bump";
  const MtlMap map = readMap(source, name, has_norm ? TextureKind::kNormals : TextureKind::kBump);
  material.normal_map = map.use;
  const float scale = map.options.bump_scale;
  if (std::abs(scale) <= kMostNormalScale)
    material.normal_scale = scale;
  else
    source.repair(fmt::format("{}: -bm is {}, expected -{} to {}; 1 is taken", name, scale, kMostNormalScale,
                              kMostNormalScale));
  return map;
}

/// Reads d and Tr, which change nothing, and says so.
void passOpacity(const MtlSource& source) {
  for (const auto& [name, opaque] : {std::pair("d", 1.0f), {"tr", 0.0f}}) {
    const MtlSource::Statement* const statement = source.find(name);
    if (!statement) continue;
    std::string_view rest = withoutComment(statement->words);
    std::string_view word = takeWord(rest);
    if (isKeyword(word, "-halo")) word = takeWord(rest);
    if (finiteNumber(word) != opaque)
      source.ignore(name, fmt::format("{} {} is ignored: surfaces are opaque but for their maps' holes",
                                      statement->keyword, forMessage(word)));
  }
}

}  // namespace

std::vector<std::string> spellings(std::string_view words) {
  std::vector<std::string> names{std::string(words)};
  const auto add = [&](std::string name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  };
  for (const bool any_word : {false, true}) {
    const std::string_view bare = nameWithoutComment(words, any_word);
    add(std::string(bare));
    add(std::string(withoutQuotes(bare)));
    std::string unescaped;
    for (std::size_t i = 0; i < bare.size(); ++i)
      if (bare.substr(i, 2) != "\\ ") unescaped += bare[i];
    add(std::move(unescaped));
  }
  return names;
}

std::vector<MtlEntry> readMtl(const std::string& path, std::vector<Warning>& warnings) {
  const std::string text = readFile(path);
  std::vector<MtlEntry> entries;
  if (text.find('\0') != text.npos) {
    warnings.push_back({path + ": holds zero bytes, expected MTL as ASCII or UTF-8 text; left out",
                        "unreadable material file", true});
    return entries;
  }
  std::string_view rest = withoutMark(text);
  std::string joined;
  bool has_stray = false;
  for (int line = 1, lines = 0; !rest.empty(); line += lines) {
    const std::string_view statement = takeStatement(rest, joined, lines);
    std::string_view words = statement;
    const std::string_view keyword = takeWord(words);
    if (keyword.empty() || keyword.starts_with('#')) continue;
    if (isKeyword(keyword, "newmtl")) {
      entries.push_back({utf8Of(trimmed(words)), path, ""});
    } else if (!entries.empty()) {
      entries.back().statements += statement;
      entries.back().statements += '\n';
    } else if (!std::exchange(has_stray, true)) {
      warnings.push_back({fmt::format("{}: line {}: '{}' stands before the first newmtl; left out", path,
                                      line, forMessage(keyword)),
                          "statement of no material", true});
    }
  }
  return entries;
}

MtlMaterial readMaterial(const MtlEntry& entry, MtlReading& reading) {
  const MtlSource source = readStatements(entry, reading);
  if (entry.is_given_twice)
    reading.scene.warnings.push_back(
        {source.at("is given again otherwise; the first counts"), "material given twice", true});
  MtlMaterial result;
  Material& material = result.material;
  material.name = entry.name;
  readColor(source, "ka", material.ambient);
  readColor(source, "kd", material.diffuse);
  readColor(source, "ke", material.emission);
  float illumination = readNumber(source, "illum", 2);
  if (!(illumination >= 0 && illumination <= 10)) {
    source.repair(fmt::format("illum is {}, expected 0 to 10; 2 is taken", illumination));
    illumination = 2;
  }
  if (illumination > 1) readColor(source, "ks", material.specular);
  material.shininess = readNumber(source, "ns", 1);
  if (material.shininess < 0) {
    source.repair("Ns is below 0; 0 is taken");
    material.shininess = 0;
  }
  passOpacity(source);
  const MtlMap diffuse = readMap(source, "map_kd"), alpha = readMap(source, "map_d");
  material.diffuse_map = diffuse.use;
  material.alpha_map = alpha.use;
  MapPlaces& places = result.places;
  if (diffuse.use.texture >= 0)
    places.diffuse = diffuse.options.place;
  else if (alpha.use.texture >= 0)
    places.diffuse = alpha.options.place;
  if (alpha.use.texture >= 0 && alpha.options.place != places.diffuse)
    source.ignore("place of a map_d", "map_d: -s and -o are ignored, for map_Kd has others");
  // The diffuse map multiplies the ambient colour, too.
  const MtlSource::Statement *const ambient = source.find("map_ka"), *const plain = source.find("map_kd");
  if (ambient && (!plain || plain->words != ambient->words))
    source.ignore("map_ka", fmt::format("{} is not drawn: map_Kd counts", ambient->keyword));
  places.emission = places.normal = places.diffuse;
  if (illumination < 1) {
    // A constant colour, whatever shines on it.
    material.emission = material.diffuse;
    material.emission_map = material.diffuse_map;
    material.colored_emission = true;
    material.ambient = material.diffuse = material.specular = glm::vec3(0);
  } else {
    const MtlMap glow = readMap(source, "map_ke");
    material.emission_map = glow.use;
    // With a map_Ke and no Ke the factor is 1, or the map would not be seen. Where the picture is missing,
    // there is no emission.
    if (glow.use.texture >= 0) {
      places.emission = glow.options.place;
      if (material.emission == glm::vec3(0)) material.emission = glm::vec3(1);
    } else if (source.find("map_ke")) {
      material.emission = glm::vec3(0);
    }
    const MtlMap bends = readBends(source, material);
    if (bends.use.texture >= 0) places.normal = bends.options.place;
  }
  material.double_sided = true;
  return result;
}

void cutHoles(Material& material, const Scene& scene) {
  const bool holes =
      material.alpha_map.texture >= 0 ||
      (material.diffuse_map.texture >= 0 && hasAlpha(scene.textures[material.diffuse_map.texture]));
  material.alpha_cutoff = holes ? 0.5f : 0.0f;
}

}  // namespace luciole
