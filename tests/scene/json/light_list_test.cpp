#include "scene/json/light_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using testing::HasSubstr;

class LightList : public testing::Test {
 protected:
  std::vector<Light> read(const std::string& text, std::optional<std::uint64_t> count = {}) {
    std::ofstream(folder_ / "l.csv", std::ios::binary) << text;
    return readLightList(folder_ / "l.csv", count);
  }
  /// The message for a file that must be refused, without its folder.
  std::string refusal(const std::string& text, std::optional<std::uint64_t> count = {}) {
    try {
      read(text, count);
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message.substr(folder_.path().string().size() + 1);
    }
    ADD_FAILURE() << "accepted: " << text;
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(LightList, ReadsPlacesColoursAndRanges) {
  const std::vector<Light> lights = read("1,-2.5,3e1,0,0.5,2,4\n4,5,6,1,1,1,\n7,8,9,1,1,1");
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights[0].kind, LightKind::kPoint);
  EXPECT_EQ(lights[0].position, glm::dvec3(1, -2.5, 30));
  EXPECT_EQ(lights[0].diffuse, glm::vec3(0, 0.5f, 2));
  EXPECT_EQ(lights[0].specular, glm::vec3(0, 0.5f, 2));
  EXPECT_EQ(lights[0].range, 4);
  EXPECT_TRUE(std::isinf(lights[1].range));
  EXPECT_TRUE(std::isinf(lights[2].range));
}

TEST_F(LightList, HeaderCommentsBlanksAndLineEndingsAreFine) {
  const std::vector<Light> lights = read(
      "\xef\xbb\xbf# lamps\r\n\r\n x, y ,z,r,g,b,range\r\n \t1 , 2,3 ,4,5,6, 7\r\n  \r\n# "
      "end\r\n1,2,3,4,5,6,\r\n");
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(lights[0].range, 7);
  EXPECT_EQ(read("x,y,z,r,g,b\n1,2,3,4,5,6\n").size(), 1u);
  EXPECT_TRUE(read("").empty());
  EXPECT_TRUE(read("x,y,z,r,g,b,range").empty());
}

TEST_F(LightList, TheFirstLineNamesTheColumnsInAnyOrder) {
  const std::vector<Light> lights = read(
      "r,g,b,x,y,z,quadratic,linear,constant,dx,dy,dz,cutoff,exponent,inner_cone,outer_cone,range\n"
      "1,2,3,4,5,6,0.5,,2,,,,,,,,\n"
      "1,1,1,0,0,0,,,,0,-2,0,30,4,,,9\n"
      "1,1,1,0,0,0,,,,1,0,0,,,10,,\n"
      "1,1,1,0,0,0,,,,1,0,0,180,4,,,\n"
      "1,1,1,,,,,,,0,0,3,,,,,\n");
  ASSERT_EQ(lights.size(), 5u);
  EXPECT_EQ(lights[0].kind, LightKind::kPoint);
  EXPECT_EQ(lights[0].position, glm::dvec3(4, 5, 6));
  EXPECT_EQ(lights[0].diffuse, glm::vec3(1, 2, 3));
  EXPECT_EQ(lights[0].attenuation, glm::vec3(2, 0, 0.5f));
  EXPECT_TRUE(std::isinf(lights[0].range));
  EXPECT_EQ(lights[1].kind, LightKind::kSpot);
  EXPECT_EQ(lights[1].direction, glm::dvec3(0, -1, 0));
  EXPECT_EQ(lights[1].falloff, SpotFalloff::kExponent);
  EXPECT_EQ(lights[1].cutoff, glm::radians(30.0));
  EXPECT_EQ(lights[1].exponent, 4);
  EXPECT_EQ(lights[1].attenuation, glm::vec3(1, 0, 0));
  EXPECT_EQ(lights[1].range, 9);
  EXPECT_EQ(lights[2].kind, LightKind::kSpot);
  EXPECT_EQ(lights[2].falloff, SpotFalloff::kCone);
  EXPECT_EQ(lights[2].inner_cone, glm::radians(10.0));
  EXPECT_EQ(lights[2].cutoff, glm::radians(45.0));
  EXPECT_EQ(lights[3].kind, LightKind::kPoint) << "OpenGL's cutoff of 180";
  EXPECT_EQ(lights[4].kind, LightKind::kDirectional);
  EXPECT_EQ(lights[4].direction, glm::dvec3(0, 0, 1));
  EXPECT_EQ(read("dx,dy,dz,r,g,b\n0,-1,0,1,1,1\n")[0].kind, LightKind::kDirectional);
}

TEST_F(LightList, WhatALightOfItsKindCantHaveIsRefused) {
  const std::string head =
      "x,y,z,r,g,b,range,constant,linear,quadratic,dx,dy,dz,cutoff,exponent,inner_cone,outer_cone\n";
  EXPECT_EQ(refusal(head + "1,2,3,4,5,6\n"), "l.csv: line 2: expected 17 fields as in the first line, got 6");
  EXPECT_EQ(refusal(head + "0,0,0,1,1,1,,0,0,0,,,,,,,\n"),
            "l.csv: line 2: constant, linear and quadratic are all 0");
  EXPECT_EQ(refusal(head + "0,0,0,1,1,1,,,,,0,0,0,,,,\n"),
            "l.csv: line 2: dx, dy and dz are all 0, expected a direction");
  EXPECT_EQ(refusal(head + "0,0,0,1,1,1,,,,,,,,30,,,\n"),
            "l.csv: line 2: a spot has a direction: dx, dy, dz are empty");
  EXPECT_EQ(refusal(head + "0,0,0,1,1,1,,,,,0,1,0,120,,,\n"),
            "l.csv: line 2: cutoff: expected degrees from 0 to 90, or 180, got 120");
  EXPECT_EQ(refusal(head + "0,0,0,1,1,1,,,,,0,1,0,,,40,30\n"),
            "l.csv: line 2: inner_cone 40 isn't smaller than outer_cone 30");
  EXPECT_EQ(refusal(head + "0,0,0,1,1,1,,,,,0,1,0,30,,,30\n"),
            "l.csv: line 2: cutoff and exponent mean nothing beside inner_cone and outer_cone");
  EXPECT_EQ(refusal(head + ",,,1,1,1,5,,,,0,1,0,,,,\n"),
            "l.csv: line 2: range means nothing for a light without x, y, z");
  EXPECT_THAT(refusal(head + "1,,3,1,1,1,5,,,,0,1,0,,,,\n"), HasSubstr("line 2: y: expected a number"));
  EXPECT_THAT(refusal(head + ",,,1,1,1,,,,,,,,,,,\n"), HasSubstr("line 2: x: expected a number"));
  EXPECT_EQ(refusal("x,y,z,r,g\n"), "l.csv: line 1: no column \"b\", expected x, y, z, r, g, b and others");
  EXPECT_EQ(refusal("x,y,z,r,g,b,x\n"), "l.csv: line 1: column \"x\" is there twice");
}

TEST_F(LightList, CountTakesTheFirstAndLooksNoFurther) {
  const std::string text = "1,0,0,1,1,1,1\n2,0,0,1,1,1,1\nnonsense\n";
  const std::vector<Light> lights = read(text, 2);
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[1].position.x, 2);
  EXPECT_TRUE(read(text, 0).empty());
  EXPECT_EQ(refusal("1,0,0,1,1,1,1\n", 2), "l.csv: 1 lights, expected 2 or more");
}

TEST_F(LightList, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(refusal("# a\n1,2,3,4,5\n"), "l.csv: line 2: expected x,y,z,r,g,b,range, got 5 fields");
  EXPECT_EQ(refusal("1,2,3,4,5,6,7,8\n"), "l.csv: line 1: expected x,y,z,r,g,b,range, got 8 fields");
  EXPECT_EQ(refusal("1;2;3;4;5;6;7\n"), "l.csv: line 1: expected x,y,z,r,g,b,range, got 1 fields");
  EXPECT_EQ(refusal("\n1,2,north,4,5,6,7\n"),
            "l.csv: line 2: z: expected a number from -1e+18 to 1e+18, got \"north\"");
  EXPECT_EQ(refusal("1,2,3,-4,5,6,7\n"), "l.csv: line 1: r: expected a number from 0 to 1e+18, got \"-4\"");
  EXPECT_EQ(refusal("1,2,3,4,5,6,0\n"),
            "l.csv: line 1: range: expected a number from 1e-18 to 1e+18, got \"0\"");
  for (const char* number : {"nan", "inf", "1e19", "1e999", "", "1.5m", "0x10", "--1", "\x01"}) {
    EXPECT_THAT(refusal(std::string("1,2,") + number + ",4,5,6,7"),
                HasSubstr("l.csv: line 1: z: expected a number"));
  }
  EXPECT_THAT(refusal("x,y,z,red,green,blue,range\n1,2,3,4,5,6,7"),
              HasSubstr("line 1: column \"red\": expected names of x, y, z, r, g, b, range"));
  EXPECT_THAT(refusal("1,2,3,4,5,6,7\nx,y,z,r,g,b,range\n"), HasSubstr("line 2: x: expected a number"));
}

TEST_F(LightList, FilesThatAreNotThereAreNamed) {
  EXPECT_THROW(readLightList(folder_ / "none.csv"), InputError);
  EXPECT_THROW(readLightList(folder_.path().string()), InputError);
}

}  // namespace
}  // namespace luciole
