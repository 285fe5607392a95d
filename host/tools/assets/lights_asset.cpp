#include "tools/assets/lights_asset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <vector>

#include "base/random.hpp"
#include "tools/assets/lathe.hpp"
#include "tools/assets/theatre.hpp"

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPi = 3.14159265358979323846;

struct Glow {
  const char* name;
  glm::dvec3 color;
};
constexpr Glow kGlows[] = {{"candle", {1.0, 0.55, 0.18}}, {"amber", {1.0, 0.36, 0.07}},
                           {"ivory", {1.0, 0.74, 0.42}},  {"rose", {1.0, 0.12, 0.2}},
                           {"teal", {0.04, 0.75, 0.55}},  {"blue", {0.1, 0.24, 1.0}}};
/// The first ones are lamps' of every size; the others, of one lamp in five, are small ones' only.
constexpr int kWarm = 3, kBigOctaves = 5;

/// What the lamps of an octave have in common.
struct Octave {
  double spacing;   ///< metres between neighbours
  double strength;  ///< candela, but for a factor of all
  double height() const { return 0.42 * spacing; }
  double range() const { return 1.9 * spacing; }
  double ball() const { return std::min(0.03 * spacing, 0.2); }
};

/// The first lamp hangs in front of the temple, so that one alone shows something.
constexpr glm::dvec2 kFirstLamp{2.0, 12.0};
constexpr double kMostSpacing = 28;

/// Octave k has 2^k lamps. Each octave gives 1.25 times the light of the one before: pools of light of every
/// size are seen.
std::vector<Octave> octaves(std::uint64_t lamps) {
  const double area = kPi * kTheatreRadius * kTheatreRadius, growth = std::sqrt(std::sqrt(std::sqrt(6.0)));
  std::vector<Octave> all;
  double count = 1, weight = 1;
  for (std::uint64_t first = 0; first < lamps; first = 2 * first + 1, count *= 2, weight *= growth) {
    const double spacing = std::min(std::sqrt(area / count), kMostSpacing);
    all.push_back({spacing, weight * spacing * spacing});
  }
  return all;
}

/// Candela for each unit of strength. A horizontal plane gets 2π I of a light, of which the window of the
/// range leaves some 0.6; what's wanted are 1.5 lux on average, and from the highest lamp 3 lux below it.
double candelaOf(const std::vector<Octave>& all, std::uint64_t lamps) {
  constexpr double kMean = 1.5, kPeak = 3.0;
  double sum = 0;
  std::uint64_t left = lamps;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::uint64_t here = std::min(left, std::uint64_t{1} << k);
    sum += static_cast<double>(here) * all[k].strength;
    left -= here;
  }
  const double area = kPi * kTheatreRadius * kTheatreRadius;
  const double top = all.front().height();
  return std::min(kMean * area / (2 * kPi * 0.6 * sum), kPeak * top * top / all.front().strength);
}

/// A lamp's place, half a metre or so off where its number puts it.
struct Lamp {
  glm::dvec3 place;
  std::size_t octave;
  int glow;
  bool is_spot;
};

/// The point of the unit circle at this share of a turn, from the halves that its bits name.
glm::dvec2 pointAt(double share) {
  static const std::vector<glm::dvec2> kCircle = unitCircle(1024);
  const double steps = share * 1024;
  const auto step = static_cast<std::size_t>(steps);
  const glm::dvec2 a = kCircle[step % 1024], b = kCircle[(step + 1) % 1024];
  const glm::dvec2 between = a + (steps - std::floor(steps)) * (b - a);
  return between / std::sqrt(between.x * between.x + between.y * between.y);
}

/// Moves a place that lies in one of the standing things to its edge.
glm::dvec2 keptFree(glm::dvec2 place, const std::vector<Standing>& things, double margin) {
  for (const auto& [center, radius] : things) {
    const glm::dvec2 away = place - center;
    const double distance = std::sqrt(away.x * away.x + away.y * away.y);
    if (distance < radius + margin)
      place = center + (radius + margin) * (distance > 0 ? away / distance : glm::dvec2(0, 1));
  }
  return place;
}

/// Places of the sequence R2 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), whose
/// every beginning fills the unit square evenly, made a disc.
class Places {
 public:
  explicit Places(std::uint64_t& state) : shift_(nextUniform(state), nextUniform(state)) {}
  glm::dvec2 at(std::uint64_t number) const {
    const double u = shareOf(shift_.x + 0.7548776662466927 * static_cast<double>(number)),
                 v = shareOf(shift_.y + 0.5698402909980532 * static_cast<double>(number));
    return kTheatreRadius * std::sqrt(u) * pointAt(v);
  }

 private:
  static double shareOf(double x) { return x - std::floor(x); }
  glm::dvec2 shift_;
};

Lamp makeLamp(const glm::dvec2& where, std::size_t k, const Octave& octave,
              const std::vector<Standing>& things, std::uint64_t& state) {
  Lamp lamp;
  lamp.octave = k;
  const double lift = between(0.8, 1.2, nextUniform(state));
  const bool is_warm = k < kBigOctaves || nextUniform(state) < 0.8;
  const int glows = static_cast<int>(std::size(kGlows));
  lamp.glow = is_warm ? static_cast<int>(nextUniform(state) * kWarm)
                      : kWarm + static_cast<int>(nextUniform(state) * (glows - kWarm));
  lamp.is_spot = nextUniform(state) < 0.25 && k > 0;
  glm::dvec2 place = where;
  const double margin = 2 * octave.ball();
  // Small lamps stand on the rows, not in them.
  const double outwards = theatreGround(place).to_middle;
  const double most = std::max(0.45 - margin, 0.0);
  if (std::abs(outwards) > most) {
    const double radius = std::sqrt(place.x * place.x + place.y * place.y);
    place *= 1 + (outwards - std::copysign(most, outwards)) / radius;
  }
  place = keptFree(place, things, margin);
  const double radius = std::sqrt(place.x * place.x + place.y * place.y);
  double height = octave.height() * lift;
  if (radius < kTempleRadius) height = std::min(height, kTempleRoom - 2 * margin);
  lamp.place = {place.x, theatreGround(place).height + height, place.y};
  const glm::dvec3 from_eye = lamp.place - kTheatreEye;
  if (from_eye.x * from_eye.x + from_eye.y * from_eye.y + from_eye.z * from_eye.z < 36) lamp.place.z -= 12;
  return lamp;
}

/// A ball of radius 1 with 8 · 4^level triangles, its middle beside the origin, where the light is: in front
/// of it, so that a ball doesn't shade what its light is for where a viewer draws shadows.
GltfTriangles lampBall(int level, const glm::dvec3& middle) {
  std::vector<glm::dvec3> corners{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  std::vector<glm::uvec3> triangles{{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                                    {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  for (; level > 0; --level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> halves;
    const auto half = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          halves.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(corners.size()));
      if (is_new) {
        const glm::dvec3 sum = corners[a] + corners[b];
        corners.push_back(sum / std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z));
      }
      return entry->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : triangles) {
      const std::uint32_t a = half(t.x, t.y), b = half(t.y, t.z), c = half(t.z, t.x);
      finer.insert(finer.end(), {{t.x, a, c}, {a, t.y, b}, {c, b, t.z}, {a, b, c}});
    }
    triangles = finer;
  }
  GltfTriangles ball;
  for (const glm::dvec3& corner : corners) {
    ball.positions.emplace_back(corner + middle);
    ball.normals.emplace_back(corner);
  }
  ball.corners = triangles;
  return ball;
}

/// The balls of so many lamps have 4 million triangles or, of 32 each, more.
int ballLevel(std::uint64_t lamps) {
  int level = 3;
  while (level > 1 && lamps * (std::uint64_t{8} << 2 * level) > 4'000'000) --level;
  return level;
}

/// The lights that the file lists: nodes share them.
class Lights {
 public:
  Lights(const std::vector<Octave>& all, double candela) : octaves_(all), candela_(candela) {}

  int of(const Lamp& lamp) {
    const auto [entry, is_new] =
        known_.try_emplace({lamp.octave, lamp.glow, lamp.is_spot}, static_cast<int>(list.size()));
    if (!is_new) return entry->second;
    const auto& [name, color] = kGlows[lamp.glow];
    const Octave& octave = octaves_[lamp.octave];
    Json light{{"name", fmt::format("{} {} of octave {}", name, lamp.is_spot ? "spot" : "lamp", lamp.octave)},
               {"type", lamp.is_spot ? "spot" : "point"},
               {"color", {color.x, color.y, color.z}},
               {"intensity", static_cast<float>(candela_ * octave.strength)},
               {"range", static_cast<float>(octave.range())}};
    if (lamp.is_spot) light["spot"] = {{"innerConeAngle", 0.6}, {"outerConeAngle", 1.1}};
    list.push_back(std::move(light));
    return entry->second;
  }

  Json list = Json::array();

 private:
  const std::vector<Octave>& octaves_;
  double candela_;
  std::map<std::tuple<std::size_t, int, bool>, int> known_;
};

/// A node's light, as JSON.
std::string lightExtension(int light) {
  return fmt::format(R"("extensions":{{"KHR_lights_punctual":{{"light":{}}}}})", light);
}

/// Adds the moon: from behind the rows, left.
int addMoon(Lights& lights, GltfDocument& document) {
  lights.list.push_back(
      {{"name", "moon"}, {"type", "directional"}, {"color", {0.55, 0.7, 1.0}}, {"intensity", 0.5}});
  // The rotation that takes −z to this direction.
  const glm::dvec3 to(0.48, -0.6, 0.64);
  const glm::dvec4 rotation(to.y, -to.x, 0, 1 - to.z);
  const double length =
      std::sqrt(rotation.x * rotation.x + rotation.y * rotation.y + rotation.w * rotation.w);
  return addNode(
      fmt::format(R"({{"name":"moon","rotation":[{},{},0,{}],{}}})", rotation.x / length, rotation.y / length,
                  rotation.w / length, lightExtension(static_cast<int>(lights.list.size()) - 1)),
      document);
}

/// The meshes of lamps, made when a lamp needs them: a file has nothing that it doesn't use.
class Balls {
 public:
  Balls(int level, GltfDocument& document) : level_(level), document_(document) {}

  int of(const Lamp& lamp) {
    const auto [entry, is_new] = meshes_.try_emplace({lamp.glow, lamp.is_spot}, 0);
    if (!is_new) return entry->second;
    Json& primitive = primitives_[lamp.is_spot];
    if (primitive.is_null())
      primitive = addTriangles(lampBall(level_, lamp.is_spot ? glm::dvec3(0, 0, 1.5) : glm::dvec3(0, 1.5, 0)),
                               document_);
    primitive["material"] = materialOf(lamp.glow);
    const auto& [name, color] = kGlows[lamp.glow];
    Json& meshes = document_.root["meshes"];
    meshes.push_back({{"name", fmt::format("{} {}", name, lamp.is_spot ? "spot" : "lamp")},
                      {"primitives", Json::array({primitive})}});
    return entry->second = static_cast<int>(meshes.size()) - 1;
  }

 private:
  int materialOf(int glow) {
    Json& materials = document_.root["materials"];
    const auto [entry, is_new] = materials_.try_emplace(glow, static_cast<int>(materials.size()));
    const auto& [name, color] = kGlows[glow];
    if (is_new)
      materials.push_back(
          {{"name", fmt::format("{} glow", name)},
           {"pbrMetallicRoughness",
            {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
           {"emissiveFactor", {color.x, color.y, color.z}}});
    return entry->second;
  }

  int level_;
  GltfDocument& document_;
  std::array<Json, 2> primitives_;
  std::map<int, int> materials_;
  std::map<std::pair<int, bool>, int> meshes_;
};

}  // namespace

GltfDocument lightsAsset(std::uint64_t count, std::uint64_t seed) {
  GltfDocument document;
  document.root["asset"] = {{"version", "2.0"},
                            {"generator", "Luciole " LUCIOLE_VERSION},
                            {"copyright", "CC0 1.0"},
                            {"extras", {{"count", count}, {"seed", seed}}}};
  document.root["extensionsUsed"] = {"KHR_lights_punctual"};
  std::vector<int> top = addTheatre(document);

  const bool has_moon = count > 1;
  const std::uint64_t lamps = count - has_moon;
  const std::vector<Octave> all = octaves(lamps);
  Lights lights(all, candelaOf(all, lamps));
  if (has_moon) top.push_back(addMoon(lights, document));
  Balls balls(ballLevel(lamps), document);
  std::uint64_t state = seed;
  const Places places(state);
  const std::vector<Standing> things = standingThings();
  for (std::uint64_t i = 0; i < lamps; ++i) {
    std::size_t k = 0;
    while ((i + 1) >> (k + 1) != 0) ++k;
    const Lamp lamp = makeLamp(i == 0 ? kFirstLamp : places.at(i), k, all[k], things, state);
    const double scale = millimetres(std::max(all[k].ball(), 0.001));
    // A spot's node is turned so that its −z looks down.
    top.push_back(addNode(
        fmt::format(R"({{"mesh":{},"translation":[{},{},{}],{}"scale":[{},{},{}],{}}})", balls.of(lamp),
                    millimetres(lamp.place.x), millimetres(lamp.place.y), millimetres(lamp.place.z),
                    lamp.is_spot ? R"("rotation":[-0.70710678,0,0,0.70710678],)" : "", scale, scale, scale,
                    lightExtension(lights.of(lamp))),
        document));
  }
  document.root["extensions"]["KHR_lights_punctual"]["lights"] = lights.list;
  document.root["scene"] = 0;
  document.root["scenes"] = {{{"name", fmt::format("theatre of {} lights", count)}, {"nodes", top}}};
  return document;
}

}  // namespace luciole
