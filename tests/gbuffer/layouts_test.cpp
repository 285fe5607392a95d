#include "gbuffer/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "luciole/error.hpp"

namespace luciole {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

PicturePart partOf(const std::vector<std::string>& channels, const std::string& name = "") {
  return {.name = name, .size = {4, 3}, .picture_size = {4, 3}, .channels = channels};
}

FoundLayers found(const std::vector<std::string>& channels, const ChosenLayers& chosen = {}) {
  return findLayers({partOf(channels)}, chosen, "in.exr");
}

TEST(Layouts, EachProgramIsKnownByItsNames) {
  const struct {
    const char *program, *position, *normal, *diffuse, *depth;
    std::vector<std::string> channels;
  } cases[] = {
      {"Luciole",
       "P",
       "N",
       "diffuse",
       "Z",
       {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z", "diffuse.R", "diffuse.G", "diffuse.B"}},
      {"Blender",
       "ViewLayer.Position",
       "ViewLayer.Normal",
       "ViewLayer.DiffCol",
       "ViewLayer.Depth.Z",
       {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
        "ViewLayer.Depth.Z", "ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B",
        "ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z", "ViewLayer.Position.X",
        "ViewLayer.Position.Y", "ViewLayer.Position.Z"}},
      {"Blender 5",
       "View.Position",
       "View.Normal",
       "View.Diffuse Color",
       "View.Depth.Z",
       {"View.Position.X", "View.Position.Y", "View.Position.Z", "View.Normal.X", "View.Normal.Y",
        "View.Normal.Z", "View.Diffuse Color.R", "View.Diffuse Color.G", "View.Diffuse Color.B",
        "View.Depth.Z"}},
      {"pbrt",
       "P",
       "Ns",
       "Albedo",
       "",
       {"R", "G", "B", "Albedo.R", "Albedo.G", "Albedo.B", "P.X", "P.Y", "P.Z", "dzdx", "dzdy", "N.X", "N.Y",
        "N.Z", "Ns.X", "Ns.Y", "Ns.Z", "u", "v"}},
      {"Mitsuba",
       "pos",
       "nn",
       "albedo",
       "dd.T",
       {"R", "G", "B", "pos.X", "pos.Y", "pos.Z", "nn.X", "nn.Y", "nn.Z", "albedo.R", "albedo.G", "albedo.B",
        "dd.T", "img.R", "img.G", "img.B"}},
      {"RenderMan",
       "__Pworld",
       "__Nworld",
       "albedo",
       "z",
       {"Ci.r", "Ci.g", "Ci.b", "a", "__Pworld.r", "__Pworld.g", "__Pworld.b", "__Nworld.r", "__Nworld.g",
        "__Nworld.b", "albedo.r", "albedo.g", "albedo.b", "z"}},
      {"Arnold",
       "P",
       "N",
       "albedo",
       "Z",
       {"R", "G", "B", "A", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z", "albedo.R", "albedo.G", "albedo.B",
        "diffuse.R", "diffuse.G", "diffuse.B"}},  // its "diffuse" is light
      {"3Delight",
       "P.world",
       "N.world",
       "albedo",
       "z",
       {"Ci.r", "Ci.g", "Ci.b", "P.world.x", "P.world.y", "P.world.z", "N.world.x", "N.world.y", "N.world.z",
        "albedo.r", "albedo.g", "albedo.b", "z"}},
      {"3Delight in camera space",
       "P.camera",
       "N.camera",
       "",
       "",
       {"P.camera.x", "P.camera.y", "P.camera.z", "N.camera.x", "N.camera.y", "N.camera.z"}},
  };
  for (const auto& one : cases) {
    const FoundLayers layers = found(one.channels);
    EXPECT_STREQ(layers.layout->program, one.program);
    EXPECT_EQ(layers[Role::kPosition].name, one.position) << one.program;
    EXPECT_EQ(layers[Role::kNormal].name, one.normal) << one.program;
    EXPECT_EQ(layers[Role::kDiffuse].name, one.diffuse) << one.program;
    EXPECT_EQ(layers[Role::kDepth].name, one.depth) << one.program;
    const auto& places = layers[Role::kPosition].channels;
    for (int c = 0; c < 3; ++c) {
      const char component = one.channels[std::size_t(places[std::size_t(c)])].back();
      EXPECT_TRUE(std::string("XxRr").find(component) == std::string::npos || c == 0) << one.program;
    }
  }
}

TEST(Layouts, ArraysOfPythonAreUnderstood) {
  const FoundLayers layers = found({"P.b", "P.g", "P.r", "N.b", "N.g", "N.r"});
  EXPECT_EQ(layers[Role::kPosition].channels, (std::array{2, 1, 0}));
  EXPECT_EQ(layers[Role::kNormal].channels, (std::array{5, 4, 3}));
}

TEST(Layouts, APartsNameCountsAsItsLayers) {
  const FoundLayers layers = findLayers({partOf({"R", "G", "B", "A"}, "beauty"), partOf({"X", "Y", "Z"}, "P"),
                                         partOf({"N.X", "N.Y", "N.Z"}, "N"), partOf({"Z"}, "depth")},
                                        {}, "in.exr");
  EXPECT_EQ(layers[Role::kPosition].part, 1);
  EXPECT_EQ(layers[Role::kNormal].part, 2);
  EXPECT_EQ(layers[Role::kColor].part, 0);
}

TEST(Layouts, WhatIsChosenComesFirst) {
  const std::vector<std::string> channels{"P.X",     "P.Y",     "P.Z", "where.X",
                                          "where.Y", "where.Z", "far", "gloss"};
  const FoundLayers layers =
      found(channels, {{Role::kPosition, "where"}, {Role::kDepth, "far"}, {Role::kShininess, "40"}});
  EXPECT_EQ(layers[Role::kPosition].name, "where");
  EXPECT_EQ(layers[Role::kDepth].name, "far");
  EXPECT_EQ(layers[Role::kShininess].constant, 40.0f);
  EXPECT_EQ(found(channels, {{Role::kShininess, "gloss"}})[Role::kShininess].channels[0], 7);
  EXPECT_THAT(
      [&] {
        found(channels, {{Role::kNormal, "Nw"}});
      },
      ThrowsMessage<InputError>(AllOf(HasSubstr("in.exr: normal Nw: no such layer"), HasSubstr("where.X"))));
}

TEST(Layouts, OfSeveralViewLayersThePositionsIsTaken) {
  std::vector<std::string> channels;
  for (const char* view : {"A", "B"})
    for (const char* layer : {"Position", "Normal"})
      for (const char* c : {"X", "Y", "Z"}) channels.push_back(std::string(view) + "." + layer + "." + c);
  EXPECT_THAT(
      [&] { found(channels); },
      ThrowsMessage<InputError>(HasSubstr("position: is it A.Position or B.Position? request.layers")));
  const FoundLayers layers = found(channels, {{Role::kPosition, "B.Position"}});
  EXPECT_EQ(layers[Role::kNormal].name, "B.Normal");
}

TEST(Layouts, WhatCannotBeKnownIsRefusedInOneLineWithTheChannels) {
  EXPECT_THAT(
      [] {
        found({"R", "G", "B", "odd\nname"});
      },
      ThrowsMessage<InputError>(AllOf(HasSubstr("in.exr: no layer that is known to hold positions"),
                                      HasSubstr("channels R, G, B, odd name"), Not(HasSubstr("\n")))));
  EXPECT_THAT(
      [] {
        found({"P.X", "P.Z", "N.X", "N.Y", "N.Z"});
      },
      ThrowsMessage<InputError>(HasSubstr("channel P.Y: missing, expected P.X P.Y P.Z")));
  PicturePart deep = partOf({}, "deep");
  deep.is_deep = true;
  EXPECT_THAT([&] { findLayers({deep}, {}, "in.exr"); },
              ThrowsMessage<InputError>(HasSubstr("deep pixels are not read")));
  std::vector<std::string> many;
  for (int i = 0; i < 1000; ++i) many.push_back("c" + std::to_string(i));
  EXPECT_THAT([&] { found(many); }, ThrowsMessage<InputError>(HasSubstr("c99 and 900 more")));
}

}  // namespace
}  // namespace luciole
