#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "pictures/random_scene_file.hpp"

// Makes a scene that fails a test smaller as long as it goes on failing: delta debugging (A. Zeller and R.
// Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", IEEE Transactions on Software Engineering
// 28(2), 2002), then key by key and number by number.
namespace luciole::test {

/// Whether a scene still fails, and in the way that counts.
using Fails = std::function<bool(const SceneJson& scene)>;

namespace shrink_steps {

using Pointer = SceneJson::json_pointer;

/// The scene so far, and how many more may be tried.
struct Search {
  SceneJson scene;
  const Fails& fails;
  int steps;

  bool over() const { return steps <= 0; }
  bool accept(SceneJson candidate) {
    --steps;
    if (!fails(candidate)) return false;
    scene = std::move(candidate);
    return true;
  }
};

/// Every place in the file, outer ones first.
inline void collect(const SceneJson& json, const Pointer& here, std::vector<Pointer>& places) {
  places.push_back(here);
  if (json.is_object())
    for (const auto& [key, value] : json.items()) collect(value, here / key, places);
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i) collect(json[i], here / i, places);
}

inline std::vector<Pointer> placesIn(const SceneJson& scene) {
  std::vector<Pointer> places;
  collect(scene, Pointer(), places);
  return places;
}

/// Leaves out elements of an array of the scene: halves, quarters … single ones.
inline bool dropElements(Search& search, const char* key) {
  bool dropped = false;
  if (!search.scene.contains(key)) return false;
  for (std::size_t run = search.scene[key].size(); run >= 1; run /= 2) {
    for (std::size_t first = 0; first < search.scene[key].size() && !search.over();) {
      SceneJson candidate = search.scene;
      SceneJson& array = candidate[key];
      const std::size_t end = std::min(first + run, array.size());
      array.erase(array.begin() + std::ptrdiff_t(first), array.begin() + std::ptrdiff_t(end));
      if (search.accept(std::move(candidate))) {
        dropped = true;
      } else {
        first += run;
      }
    }
  }
  return dropped;
}

/// Leaves out keys, wherever they are; without one that it needs the scene isn't read, so it can't fail.
inline bool dropKeys(Search& search) {
  bool dropped = false;
  for (const Pointer& place : placesIn(search.scene)) {
    if (search.over()) break;
    if (place.empty() || !search.scene.contains(place)) continue;
    const Pointer parent = place.parent_pointer();
    if (!search.scene.at(parent).is_object()) continue;
    SceneJson candidate = search.scene;
    candidate.at(parent).erase(place.back());
    dropped |= search.accept(std::move(candidate));
  }
  return dropped;
}

/// Puts 0, 1 or fewer digits in a number's place.
inline bool simplifyNumbers(Search& search) {
  bool simplified = false;
  for (const Pointer& place : placesIn(search.scene)) {
    if (search.over()) break;
    if (!search.scene.at(place).is_number()) continue;
    const double value = search.scene.at(place).get<double>();
    for (const double simpler : {0.0, 1.0, std::round(value), std::round(10 * value) / 10}) {
      if (value == 0 || value == 1 || value == simpler || search.over()) break;
      SceneJson candidate = search.scene;
      if (candidate.at(place).is_number_integer()) {
        candidate.at(place) = std::int64_t(simpler);
      } else {
        candidate.at(place) = simpler;
      }
      if (search.accept(std::move(candidate))) {
        simplified = true;
        break;
      }
    }
  }
  return simplified;
}

}  // namespace shrink_steps

/// The smallest scene found that still fails, after `steps` tries at most. `scene` itself must fail.
inline SceneJson shrink(SceneJson scene, const Fails& fails, int steps) {
  shrink_steps::Search search{std::move(scene), fails, steps};
  bool smaller = true;
  while (smaller && !search.over()) {
    smaller = shrink_steps::dropElements(search, "lights");
    smaller |= shrink_steps::dropElements(search, "objects");
    smaller |= shrink_steps::dropKeys(search);
    smaller |= shrink_steps::simplifyNumbers(search);
  }
  return std::move(search.scene);
}

}  // namespace luciole::test
