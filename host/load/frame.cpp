#include "load/frame.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "luciole/pose.hpp"
#include "rays/ray_cast.hpp"
#include "scene/bounds.hpp"
#include "scene/count_triangles.hpp"

namespace luciole {
namespace {

constexpr double kAspect = 16.0 / 9.0;
constexpr double kMargin = 1.06;  // the picture's size relative to that of the scene's box
/// With more triangles the rays that find a room would take seconds; such a scene is framed from outside.
constexpr std::uint64_t kMostTrianglesForRays = 8'000'000;

glm::dvec3 centerOf(const Bounds& bounds) { return bounds.low + (bounds.high - bounds.low) / 2.0; }

std::array<glm::dvec3, 8> cornersOf(const Bounds& bounds) {
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
                  i & 4 ? bounds.high.z : bounds.low.z};
  }
  return corners;
}

/// The 26 directions to a cube's neighbours.
std::vector<glm::dvec3> allRound() {
  std::vector<glm::dvec3> directions;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x || y || z) directions.push_back(glm::normalize(glm::dvec3(x, y, z)));
      }
    }
  }
  return directions;
}

/// Whether a place is in a room: rays in nearly all directions hit the front of a surface. Inside a solid
/// they hit backs, and outside everything they hit nothing.
bool isInRoom(const RayScene& rays, const glm::dvec3& place) {
  static const std::vector<glm::dvec3> kDirections = allRound();
  int fronts = 0;
  int backs = 0;
  for (const glm::dvec3& direction : kDirections) {
    if (const auto hit = castRay(rays, place, direction)) ++(hit->front ? fronts : backs);
  }
  return fronts >= 21 && backs <= 2;  // of 26: a roof may be open, a leaf or a curtain have one side only
}

/// Candidates for the eye: the centres of 13 × 5 × 13 cells of the box (odd numbers, for the middle of a
/// symmetrical hall), and the positions of up to 500 lights, which authors put into rooms.
std::vector<glm::dvec3> placesToStand(const Scene& scene, const Bounds& bounds) {
  constexpr glm::ivec3 kCells{13, 5, 13};
  std::vector<glm::dvec3> places;
  for (int x = 0; x < kCells.x; ++x) {
    for (int z = 0; z < kCells.z; ++z) {
      for (int y = 0; y < kCells.y; ++y) {
        places.push_back(bounds.low +
                         (bounds.high - bounds.low) * (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(kCells));
      }
    }
  }
  constexpr std::size_t kMostLightsToTry = 500;
  const std::size_t step = scene.lights.size() / kMostLightsToTry + 1;
  for (std::size_t i = 0; i < scene.lights.size(); i += step) {
    if (scene.lights[i].kind != LightKind::kDirectional) places.push_back(scene.lights[i].position);
  }
  return places;
}

/// How many of 15 × 15 parallel rays from outside, against the direction `back`, hit fronts and backs of
/// surfaces.
struct Sides {
  int fronts = 0;
  int backs = 0;
};
Sides sidesSeen(const RayScene& rays, const Bounds& bounds, const glm::dvec3& back) {
  constexpr int kRays = 15;
  const double radius = glm::length(bounds.high - bounds.low) / 2;
  const glm::dmat4 frame = cameraToWorld(back, glm::dvec3(0), {0, 1, 0});
  Sides sides;
  for (int i = 0; i < kRays * kRays; ++i) {
    const glm::dvec2 at = (glm::dvec2(i % kRays, i / kRays) + 0.5) / (0.5 * kRays) - 1.0;
    const glm::dvec3 from =
        centerOf(bounds) + radius * (at.x * glm::dvec3(frame[0]) + at.y * glm::dvec3(frame[1]) + 1.01 * back);
    if (const auto hit = castRay(rays, from, -back)) ++(hit->front ? sides.fronts : sides.backs);
  }
  return sides;
}

/// The side where the wall is left out to look in, as on a stage: the horizontal direction in which rays from
/// most of the places in a room hit nothing.
std::optional<glm::dvec3> openSide(const RayScene& rays, const std::vector<glm::dvec3>& places_in_room) {
  for (const glm::dvec3& out :
       {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1)}) {
    const auto free = std::count_if(places_in_room.begin(), places_in_room.end(),
                                    [&](const glm::dvec3& place) { return !castRay(rays, place, out); });
    if (2 * static_cast<std::size_t>(free) > places_in_room.size()) return out;
  }
  return std::nullopt;
}

/// A place to stand in a room, and the best direction to look from there.
struct Stand {
  glm::dvec3 eye{0.0};
  double floor = 0;
  double ceiling = 0;
  glm::dvec3 ahead{0.0};  ///< unit, horizontal
  double length = 0;      ///< clear distance ahead, metres
  double score = 0;       ///< 0: nothing to be seen from here
};

double clearDistance(const RayScene& rays, const Bounds& bounds, const glm::dvec3& from,
                     const glm::dvec3& direction) {
  const auto hit = castRay(rays, from, direction);
  return hit ? hit->distance : glm::length(bounds.high - bounds.low);
}

/// Puts the eye at a quarter of the room's height: 1.5 m, eye level, in a room of 6 m. It is relative to the
/// room, since files don't say their unit.
Stand standAt(const RayScene& rays, const Bounds& bounds, const glm::dvec3& place) {
  Stand stand;
  stand.floor = std::max(place.y - clearDistance(rays, bounds, place, {0, -1, 0}), bounds.low.y);
  stand.ceiling = std::min(place.y + clearDistance(rays, bounds, place, {0, 1, 0}), bounds.high.y);
  stand.eye = {place.x, stand.floor + 0.25 * (stand.ceiling - stand.floor), place.z};
  return stand;
}

/// Chooses the direction with the highest score: clear distance ahead · √(open space in the field of view) ·
/// number of different triangles that rays hit. So the view goes far, passes nothing close, and shows many
/// things rather than bare walls. `best`: the highest score of any stand yet, which this raises; directions
/// that can't reach it are left out.
void lookAround(const RayScene& rays, const Bounds& bounds, std::atomic<double>& best, Stand& stand) {
  if (!isInRoom(rays, stand.eye)) return;
  constexpr int kDirections = 16;
  constexpr double kRays = 9 * 5;  // each sees a thing at most, and no open space beyond the beam
  const glm::dvec3 up{0, 1, 0};
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const glm::dvec3 ahead{std::sin(angle), 0, std::cos(angle)};
    const glm::dvec3 right = glm::cross(ahead, up);
    const double length = clearDistance(rays, bounds, stand.eye, ahead);
    double beam = length;
    for (double x : {-0.03, 0.03}) {
      for (double y : {0.0, 0.05}) {
        beam = std::min(beam,
                        clearDistance(rays, bounds, stand.eye, glm::normalize(ahead + x * right + y * up)));
      }
    }
    // With a margin for rounding, and for the choice among equals below.
    if (kRays * beam * std::sqrt(kRays * beam) * (1 + 1e-5) < std::max(best.load(), stand.score)) continue;
    double room = 0;
    std::vector<std::uint32_t> seen;
    for (int x = -4; x <= 4; ++x) {
      for (int y = -1; y <= 3; ++y) {
        const auto hit = castRay(rays, stand.eye, glm::normalize(ahead + 0.2 * x * right + 0.2 * y * up));
        room += hit ? std::min(beam, hit->distance) : beam;
        if (hit) seen.push_back(hit->triangle);
      }
    }
    std::sort(seen.begin(), seen.end());
    const auto things = std::unique(seen.begin(), seen.end()) - seen.begin();
    const double score = beam * std::sqrt(room) * static_cast<double>(things);
    if (score > stand.score * (1 + 1e-6)) {  // of equals the first, whatever the rounding
      stand.score = score;
      stand.ahead = ahead;
      stand.length = length;
    }
  }
  double before = best;
  while (before < stand.score && !best.compare_exchange_weak(before, stand.score)) {
  }
}

Framing frameFromInside(const Bounds& bounds, const Stand& stand) {
  Framing framing;
  framing.inside = true;
  framing.floor = stand.floor;
  framing.ceiling = stand.ceiling;
  framing.view_length = stand.length;
  const double height = stand.ceiling - stand.floor;
  glm::dvec3 target = stand.eye + stand.ahead * stand.length;
  target.y += std::min(0.2 * height, 0.2 * stand.length);
  framing.camera.camera_to_world = cameraToWorld(stand.eye, target, {0, 1, 0});
  framing.camera.target = stand.eye;  // in a room one turns about oneself
  framing.camera.fov_y = glm::radians(60.0);
  framing.camera.far = 1.1 * glm::length(bounds.high - bounds.low);
  framing.camera.near = std::max(0.01 * height, 1e-5 * framing.camera.far);
  return framing;
}

/// Looks along −back at the box's centre, from where all its corners are in the picture.
Framing frameFromOutside(const Bounds& bounds, const glm::dvec3& back) {
  Framing framing;
  const glm::dvec3 center = centerOf(bounds);
  // A scene of one point gets a size that its coordinates can resolve.
  const double radius =
      std::max(glm::length(bounds.high - bounds.low) / 2, 1e-6 * std::max(1.0, glm::length(center)));
  const glm::dmat4 rotation = cameraToWorld(back, glm::dvec3(0), {0, 1, 0});
  const double tangent_y = std::tan(framing.camera.fov_y / 2) / kMargin;
  const double tangent_x = tangent_y * kAspect;
  double distance = 1.01 * radius;
  for (const glm::dvec3& corner : cornersOf(bounds)) {
    const glm::dvec3 p = glm::transpose(glm::dmat3(rotation)) * (corner - center);
    distance = std::max({distance, p.z + std::abs(p.x) / tangent_x, p.z + std::abs(p.y) / tangent_y});
  }
  framing.camera.camera_to_world = rotation;
  framing.camera.camera_to_world[3] = glm::dvec4(center + back * distance, 1);
  framing.camera.target = center;
  framing.camera.near = std::max(0.5 * (distance - radius), 1e-3 * distance);
  framing.camera.far = distance + 1.5 * radius;
  return framing;
}

/// The direction from the scene towards the camera: the front, to the right and a little above, or the
/// mirrored direction that shows more than twice as many fronts. A scene that is flat in z is seen straight
/// on.
glm::dvec3 outsideDirection(const RayScene& rays, const Bounds& bounds) {
  const glm::dvec3 extent = bounds.high - bounds.low;
  std::vector<glm::dvec3> backs;
  if (extent.z <= 1e-3 * std::max(extent.x, extent.y)) {
    backs = {{0, 0, 1}, {0, 0, -1}};
  } else {
    const glm::dvec3 usual = glm::normalize(glm::dvec3(0.5, 0.35, 1));
    for (double y : {1, -1}) {
      for (double z : {1, -1}) {
        for (double x : {1, -1}) backs.push_back(usual * glm::dvec3(x, y, z));
      }
    }
  }
  glm::dvec3 best = backs[0];
  int most = sidesSeen(rays, bounds, best).fronts;
  for (const glm::dvec3& back : backs) {
    const int fronts = sidesSeen(rays, bounds, back).fronts;
    if (fronts > 2 * most) {
      most = fronts;
      best = back;
    }
  }
  return best;
}

}  // namespace

Framing frameScene(const Scene& scene) {
  const Bounds bounds = sceneBounds(scene);
  if (bounds.low.x > bounds.high.x) {
    Framing framing;
    framing.camera.camera_to_world = cameraToWorld({0, 0, 5}, glm::dvec3(0), {0, 1, 0});
    return framing;
  }
  if (countTriangles(scene) > kMostTrianglesForRays)
    return frameFromOutside(bounds, glm::normalize(glm::dvec3(0.5, 0.35, 1)));

  const RayScene rays = buildRayScene(scene, centerOf(bounds));
  const std::vector<glm::dvec3> tried = placesToStand(scene, bounds);
  std::vector<char> in_room(tried.size());
  tbb::parallel_for(std::size_t{0}, tried.size(),
                    [&](std::size_t i) { in_room[i] = isInRoom(rays, tried[i]); });
  std::vector<glm::dvec3> places;
  for (std::size_t i = 0; i < tried.size(); ++i)
    if (in_room[i]) places.push_back(tried[i]);
  const glm::dvec3 usual = outsideDirection(rays, bounds);
  const Sides outside = sidesSeen(rays, bounds, usual);
  // A car has a cabin and is still seen from outside. A hall is mostly rooms, or shows mostly backs from
  // outside.
  const bool is_hall =
      2 * places.size() >= tried.size() || (!places.empty() && outside.backs > outside.fronts);
  if (!is_hall) return frameFromOutside(bounds, usual);
  if (const auto open = openSide(rays, places)) return frameFromOutside(bounds, *open);

  std::vector<Stand> stands;
  const double close = 1e-3 * glm::length(bounds.high - bounds.low);
  for (const glm::dvec3& place : places) {
    const Stand stand = standAt(rays, bounds, place);
    if (stands.empty() || glm::distance(stands.back().eye, stand.eye) > close) stands.push_back(stand);
  }
  std::atomic<double> highest = 0;
  tbb::parallel_for(std::size_t{0}, stands.size(),
                    [&](std::size_t i) { lookAround(rays, bounds, highest, stands[i]); });
  const auto best = std::max_element(stands.begin(), stands.end(),
                                     [](const Stand& a, const Stand& b) { return a.score < b.score; });
  return best->score > 0 ? frameFromInside(bounds, *best) : frameFromOutside(bounds, usual);
}

}  // namespace luciole
