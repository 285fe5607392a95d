#include "tools/assets/theatre.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tools/assets/lathe.hpp"

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStageRadius = 12.5, kStageHeight = 0.12, kRowWidth = 1.3, kRowHeight = 0.6;
constexpr int kRows = 19;
constexpr double kTop = kRows * kRowHeight, kBack = 41.0;
constexpr double kTempleFloor = 0.6;
/// Steps of a full turn, and those of the rows: five eighths of it around −z.
constexpr int kSteps = 256;
constexpr Turn kRowsTurn{kSteps, 112, 272};

constexpr double kRimRadius = 39.4, kTempleColumns = 5.2, kPedestals = 9.6;

struct Shape {
  std::vector<Profile> profiles;
  Turn turn;
};

GltfTriangles trianglesOf(const Shape& shape) {
  GltfTriangles triangles;
  for (const Profile& profile : shape.profiles) addLathe(profile, shape.turn, triangles);
  return triangles;
}

/// The ends of the rows: a wall below each row's seats, at both sides.
void addRowEnds(GltfTriangles& triangles) {
  const std::vector<glm::dvec2> circle = unitCircle(kSteps);
  for (const int end : {kRowsTurn.first, kRowsTurn.last}) {
    const glm::dvec2 along = circle[static_cast<std::size_t>(end % kSteps)];
    const auto place = [&](double radius, double y) {
      return glm::dvec3(radius * along.x, y, radius * along.y);
    };
    for (int row = 0; row <= kRows; ++row) {
      const double from = kStageRadius + row * kRowWidth, to = row == kRows ? kBack : from + kRowWidth;
      const double height = std::min(row + 1, kRows) * kRowHeight;
      if (end == kRowsTurn.first)
        addQuad({place(from, 0), place(from, height), place(to, height), place(to, 0)}, triangles);
      else
        addQuad({place(from, 0), place(to, 0), place(to, height), place(from, height)}, triangles);
    }
  }
}

GltfTriangles rows() {
  Profile profile{{{kBack, 0}, {kBack, kTop}}};
  for (int row = kRows; row > 0; --row) {
    const double radius = kStageRadius + (row - 1) * kRowWidth;
    // A seat's edge is bevelled: it catches light.
    profile.points.emplace_back(radius + 0.08, row * kRowHeight);
    profile.points.emplace_back(radius, row * kRowHeight - 0.08);
    profile.points.emplace_back(radius, (row - 1) * kRowHeight);
  }
  GltfTriangles triangles = trianglesOf({{profile}, kRowsTurn});
  addRowEnds(triangles);
  return triangles;
}

/// A ring with a rectangular section.
Profile ringProfile(double inner, double outer, double low, double high) {
  return {{{inner, low}, {outer, low}, {outer, high}, {inner, high}, {inner, low}}};
}

/// A column with a base and a capital.
Shape column(double radius, double height) {
  const double r = radius;
  Profile shaft{{}, true};
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    shaft.points.emplace_back(r * (1 - 0.18 * t * t), 0.3 * r + t * (height - 1.1 * r));
  }
  return {{{{{1.35 * r, 0}, {1.35 * r, 0.3 * r}, {r, 0.3 * r}}},
           shaft,
           {{{0.82 * r, height - 0.8 * r},
             {1.3 * r, height - 0.45 * r},
             {1.4 * r, height - 0.45 * r},
             {1.4 * r, height}}}},
          fullTurn(32)};
}

/// Part of an ellipse around (0, height), from the height up to the axis; or inside out.
Profile dome(double radius, double height, double rise, bool inside) {
  const std::vector<glm::dvec2> circle = unitCircle(64);
  Profile profile{{}, true};
  for (std::size_t i = 0; i <= 16; ++i)
    profile.points.emplace_back(i == 16 ? 0.0 : radius * circle[i].x, height + rise * circle[i].y);
  if (inside) std::reverse(profile.points.begin(), profile.points.end());
  return profile;
}

/// A ball that stands on height `low`.
Profile ball(double radius, double low) {
  const std::vector<glm::dvec2> circle = unitCircle(64);
  Profile profile{{}, true};
  for (std::size_t i = 0; i <= 32; ++i) {
    const glm::dvec2 at = circle[(48 + i) % 64];
    profile.points.emplace_back(i % 32 == 0 ? 0.0 : radius * at.x, low + radius * (1 + at.y));
  }
  return profile;
}

Shape templeFloor() {
  return {{{{{6.4, 0},
             {6.4, 0.2},
             {6.05, 0.2},
             {6.05, 0.4},
             {5.7, 0.4},
             {5.7, kTempleFloor},
             {0, kTempleFloor}}}},
          fullTurn(128)};
}

Shape templeRoof() {
  const double low = kTempleFloor + 4.4;
  return {{ringProfile(4.7, 5.7, low, low + 0.7),
           ringProfile(4.7, 6.0, low + 0.7, low + 0.95),
           dome(5.3, low + 0.95, 3.4, false),
           dome(4.7, low + 0.7, 3.2, true),
           {{{0.12, low + 4.3}, {0.12, low + 4.7}}},
           ball(0.32, low + 4.6)},
          fullTurn(64)};
}

Shape pedestal(double radius, double height) {
  const double r = radius;
  return {{{{{1.3 * r, 0},
             {1.3 * r, 0.25 * r},
             {r, 0.4 * r},
             {r, height - 0.3 * r},
             {1.15 * r, height - 0.15 * r},
             {1.15 * r, height},
             {0, height}}}},
          fullTurn(32)};
}

Shape cypress() {
  return {{{{{0.18, 0}, {0.18, 1.0}}},
           {{{0.0, 0.7}, {0.7, 0.8}, {1.1, 1.8}, {1.2, 3.0}, {1.05, 4.6}, {0.8, 6.4}, {0.4, 8.2}, {0.0, 9.6}},
            true}},
          fullTurn(16)};
}

/// A material of glTF's core. Returns its index.
int addMaterial(const char* name, const glm::dvec3& color, double metallic, double roughness,
                GltfDocument& document) {
  Json& materials = document.root["materials"];
  materials.push_back({{"name", name},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {color.x, color.y, color.z, 1}},
                         {"metallicFactor", metallic},
                         {"roughnessFactor", roughness}}}});
  return static_cast<int>(materials.size()) - 1;
}

int addMesh(const char* name, const GltfTriangles& triangles, int material, GltfDocument& document) {
  Json primitive = addTriangles(triangles, document);
  primitive["material"] = material;
  Json& meshes = document.root["meshes"];
  meshes.push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
  return static_cast<int>(meshes.size()) - 1;
}

/// The same triangles as the mesh's, of another material.
int addMeshLike(int mesh, const char* name, int material, GltfDocument& document) {
  Json copy = document.root["meshes"][static_cast<std::size_t>(mesh)];
  copy["name"] = name;
  copy["primitives"][0]["material"] = material;
  document.root["meshes"].push_back(std::move(copy));
  return static_cast<int>(document.root["meshes"].size()) - 1;
}

int addMeshNode(const char* name, int mesh, const glm::dvec3& place, GltfDocument& document) {
  Json node{{"name", name}, {"mesh", mesh}};
  if (place != glm::dvec3(0))
    node["translation"] = {millimetres(place.x), millimetres(place.y), millimetres(place.z)};
  return addNode(node.dump(), document);
}

/// Places around the y axis: every `stride` steps of the circle.
std::vector<glm::dvec2> around(double radius, int first, int last, int stride) {
  const std::vector<glm::dvec2> circle = unitCircle(kSteps);
  std::vector<glm::dvec2> places;
  for (int i = first; i <= last; i += stride)
    places.push_back(radius * circle[static_cast<std::size_t>(i % kSteps)]);
  return places;
}

std::vector<glm::dvec2> rimPlaces() { return around(kRimRadius, kRowsTurn.first + 2, kRowsTurn.last - 2, 6); }
std::vector<glm::dvec2> templePlaces() { return around(kTempleColumns, 0, kSteps - 1, kSteps / 16); }
std::vector<glm::dvec2> pedestalPlaces() { return around(kPedestals, 16, kSteps - 1, kSteps / 8); }
std::vector<glm::dvec2> cypressPlaces() {
  constexpr double kAt[][2] = {{17.5, 17.0}, {21.5, 21.0}, {25.5, 25.0}, {30.0, 18.5}, {34.0, 22.5}};
  std::vector<glm::dvec2> places;
  for (const double side : {-1.0, 1.0}) {
    for (const auto& [x, z] : kAt) places.emplace_back(side * x, z);
  }
  return places;
}

void addCamera(GltfDocument& document) {
  // Looks along −z, turned down by an angle whose half has this tangent.
  constexpr double kHalfTangent = 0.075;
  document.root["cameras"] = {
      {{"name", "from the entrance"},
       {"type", "perspective"},
       {"perspective", {{"yfov", 0.72}, {"aspectRatio", 16.0 / 9.0}, {"znear", 0.1}, {"zfar", 300}}}}};
  const double length = std::sqrt(1 + kHalfTangent * kHalfTangent);
  addNode(Json{{"name", "camera"},
               {"camera", 0},
               {"translation", {kTheatreEye.x, kTheatreEye.y, kTheatreEye.z}},
               {"rotation", {-kHalfTangent / length, 0, 0, 1 / length}}}
              .dump(),
          document);
}

}  // namespace

std::vector<Standing> standingThings() {
  std::vector<Standing> things{{{0, 0}, 1.3}};
  const auto add = [&](const std::vector<glm::dvec2>& places, double radius) {
    for (const glm::dvec2& place : places) things.push_back({place, radius});
  };
  add(rimPlaces(), 0.75);
  add(templePlaces(), 0.55);
  add(pedestalPlaces(), 0.85);
  add(cypressPlaces(), 1.3);
  return things;
}

Ground theatreGround(const glm::dvec2& place) {
  const double radius = std::sqrt(place.x * place.x + place.y * place.y);
  if (radius < 5.7) return {kTempleFloor, 0};
  if (radius < kTempleRadius) return {0.4, 0};
  if (radius < kStageRadius) return {kStageHeight, 0};
  // The rows end where the circle has its step 16 below +x on both sides: at −x they do likewise.
  const std::vector<glm::dvec2>& end = around(1.0, kRowsTurn.last, kRowsTurn.last, 1);
  if (place.y > end.front().y * radius) return {0, 0};
  const double row = std::floor((radius - kStageRadius) / kRowWidth);
  return {std::min(row + 1, double(kRows)) * kRowHeight, kStageRadius + (row + 0.5) * kRowWidth - radius};
}

std::vector<int> addTheatre(GltfDocument& document) {
  const int sandstone = addMaterial("sandstone", {0.62, 0.54, 0.44}, 0, 0.85, document),
            marble = addMaterial("marble", {0.8, 0.78, 0.74}, 0, 0.35, document),
            paving = addMaterial("paving", {0.3, 0.29, 0.28}, 0, 0.6, document),
            stage = addMaterial("polished stage", {0.34, 0.3, 0.28}, 0, 0.28, document),
            leaves = addMaterial("cypress", {0.09, 0.17, 0.07}, 0, 0.9, document),
            gold = addMaterial("gold", {1.0, 0.77, 0.34}, 1, 0.3, document);
  std::vector<int> nodes;
  const auto add = [&](const char* name, int mesh, const std::vector<glm::dvec2>& places, double height) {
    for (const glm::dvec2& place : places)
      nodes.push_back(addMeshNode(name, mesh, {place.x, height, place.y}, document));
  };
  const std::vector<glm::dvec2> middle{{0, 0}};
  add("ground", addMesh("ground", trianglesOf({{{{{90, 0}, {0, 0}}}}, fullTurn(64)}), paving, document),
      middle, 0);
  add("stage",
      addMesh("stage",
              trianglesOf(
                  {{{{{kStageRadius, 0}, {kStageRadius, kStageHeight}, {0, kStageHeight}}}}, fullTurn(128)}),
              stage, document),
      middle, 0);
  add("rows", addMesh("rows", rows(), sandstone, document), middle, 0);
  add("column", addMesh("column", trianglesOf(column(0.42, 4.6)), marble, document), rimPlaces(), kTop);
  add("entablature",
      addMesh("entablature",
              trianglesOf({{ringProfile(38.9, 39.9, kTop + 4.6, kTop + 5.3),
                            ringProfile(38.7, 40.1, kTop + 5.3, kTop + 5.55)},
                           kRowsTurn}),
              marble, document),
      middle, 0);
  add("temple floor", addMesh("temple floor", trianglesOf(templeFloor()), marble, document), middle, 0);
  add("temple column", addMesh("temple column", trianglesOf(column(0.3, 4.4)), marble, document),
      templePlaces(), kTempleFloor);
  add("temple roof", addMesh("temple roof", trianglesOf(templeRoof()), marble, document), middle, 0);
  const int post = addMesh("pedestal", trianglesOf(pedestal(0.5, 1.1)), sandstone, document);
  nodes.push_back(addMeshNode("pedestal", post, {0, kTempleFloor, 0}, document));
  add("pedestal", post, pedestalPlaces(), kStageHeight);
  const int sphere = addMesh("ball", trianglesOf({{ball(0.75, 0)}, fullTurn(64)}), gold, document);
  nodes.push_back(addMeshNode("golden ball", sphere, {0, kTempleFloor + 1.1, 0}, document));
  // What highlights are judged by: from mirror-like to matt, of metal and not, in turns.
  const std::vector<glm::dvec2> places = pedestalPlaces();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool is_metal = i % 2 == 0;
    const std::size_t steps = 3 * i / 2;
    const double roughness = 0.25 + 0.05 * static_cast<double>(steps);
    const std::string name = fmt::format("{} of roughness {:.2f}", is_metal ? "metal" : "lacquer", roughness);
    const int material =
        addMaterial(name.c_str(), is_metal ? glm::dvec3(0.9, 0.87, 0.82) : glm::dvec3(0.55, 0.06, 0.05),
                    is_metal ? 1 : 0, millimetres(roughness), document);
    const int mesh = addMeshLike(sphere, name.c_str(), material, document);
    nodes.push_back(
        addMeshNode(name.c_str(), mesh, {places[i].x, kStageHeight + 1.1, places[i].y}, document));
  }
  add("cypress", addMesh("cypress", trianglesOf(cypress()), leaves, document), cypressPlaces(), 0);
  nodes.push_back(document.node_count);
  addCamera(document);
  return nodes;
}

}  // namespace luciole
