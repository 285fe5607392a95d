#include "tools/view/file_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gbuffer/foreign_file.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "shared_files.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole {
namespace {

using nlohmann::json;
using test::ForeignChannel;
using test::kFloat;
using test::kHalf;
using testing::HasSubstr;

class FilesOfViews : public testing::Test {
 protected:
  /// An EXR of colours, two groups of lights, normals, depths and ids.
  std::string writeFile(const std::string& name, int width = 40, int height = 30, float bright = 1) const {
    std::vector<ForeignChannel> channels;
    const auto color = [=](int x, int y) { return bright * glm::vec3(0.02f * x, 0.03f * y, 0.1f); };
    test::addLayer(channels, "", "RGB", kFloat, color);
    test::addLayer(channels, "light_groups.key", "RGB", kFloat,
                   [=](int x, int y) { return 0.5f * color(x, y); });
    test::addLayer(channels, "light_groups.rest", "RGB", kFloat,
                   [=](int x, int y) { return 0.5f * color(x, y); });
    test::addLayer(channels, "normal", "XYZ", kFloat,
                   [](int x, int) { return glm::vec3(x % 2, 0, 1 - x % 2); });
    channels.push_back({"depth.Z", kFloat, [](int x, int y) {
                          return y == 0 ? std::numeric_limits<float>::infinity() : float(1 + x);
                        }});
    channels.push_back({"object_id", kFloat, [](int x, int) { return float(x / 10 - 1); }});
    test::writeForeignParts(folder / name, width, height, {{channels, {}}});
    return folder / name;
  }

  struct Shown {
    json about;
    Image picture;
  };
  Shown shown(FileView& view, const json& request) const {
    const Answer answer = view.picture(request.dump());
    EXPECT_EQ(answer.type, "application/octet-stream");
    std::uint32_t length = 0;
    for (int i = 0; i < 4; ++i) length |= std::uint32_t(std::uint8_t(answer.body[std::size_t(i)])) << 8 * i;
    const std::string path = folder / "shown.png";
    test::writeText(path, answer.body.substr(4 + length));
    return {json::parse(answer.body.substr(4, length)), readImage(path)};
  }
  /// What a command writes into out.png.
  Image written(const std::string& command) const {
    const test::Outcome outcome = test::runLine(folder, "luciole " + command + " -o out.png --quiet");
    EXPECT_EQ(outcome.status, 0) << command << outcome.err;
    return readImage(folder / "out.png");
  }
  static std::string complaint(const std::function<void()>& call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was wrong";
  }

  test::TemporaryFolder folder;
};

TEST_F(FilesOfViews, PicturesAreThoseOfShow) {
  FileView view({writeFile("a.exr")}, true);
  const json state = json::parse(view.state().body);
  EXPECT_EQ(state["kind"], "files");
  ASSERT_EQ(state["files"].size(), 1u);
  EXPECT_EQ(state["files"][0]["size"], json({40, 30}));
  EXPECT_EQ(state["files"][0]["groups"], json({"key", "rest"}));
  std::vector<std::string> kinds;
  for (const json& layer : state["files"][0]["layers"]) {
    const std::string name = layer["name"];
    kinds.push_back(layer["kind"]);
    const Shown one = shown(view, {{"file", 0}, {"layer", name}, {"exposure", 0}});
    EXPECT_EQ(one.picture.pixels, written("show a.exr --layer " + name).pixels) << name;
    EXPECT_EQ(one.about["size"], json({40, 30}));
    EXPECT_EQ(one.picture.width, 40 * one.about["scale"].get<int>()) << name << ": as the page draws it";
  }
  EXPECT_THAT(kinds, testing::UnorderedElementsAre("color", "color", "color", "vector", "value", "id"));
  const Shown bright = shown(view, {{"file", 0}, {"layer", "color"}, {"exposure", 1.5}});
  EXPECT_EQ(bright.picture.pixels, written("show a.exr --exposure 1.5").pixels);
}

TEST_F(FilesOfViews, GroupsOfLightsAreMixedAsMixDoes) {
  FileView view({writeFile("a.exr")}, true);
  const Shown mixed = shown(
      view, {{"file", 0}, {"layer", "color"}, {"exposure", -0.5}, {"mix", {{"key", {2.5, "#ff8000"}}}}});
  EXPECT_EQ(mixed.picture.pixels, written("mix a.exr --light-mixer key=2.5:#ff8000 --exposure -0.5").pixels);
  for (const char* layer : {"", "groups", "light_groups."})
    EXPECT_THAT(complaint([&] {
                  view.picture(json{{"file", 0}, {"layer", layer}, {"exposure", "x"}}.dump());
                }),
                HasSubstr(*layer ? "no layer" : "exposure"))
        << "no request names all groups at once: " << layer;
  const Shown other = shown(view, {{"file", 0}, {"layer", "normal"}, {"mix", {{"key", {2.5, "#ff8000"}}}}});
  EXPECT_EQ(other.picture.pixels, written("show a.exr --layer normal").pixels);
}

TEST_F(FilesOfViews, NumbersOfAPixelAreTheFilesOwn) {
  FileView view({writeFile("a.exr")}, true);
  const auto picked = [&](const char* layer, double x, double y) {
    return json::parse(view.pick(json{{"file", 0}, {"layer", layer}, {"at", {x, y}}}.dump()).body);
  };
  const json color = picked("color", 7.5 / 40, 29.0 / 30);
  EXPECT_EQ(color["pixel"], json({7, 29}));
  EXPECT_EQ(color["values"], json::array({json::array({"R", 0.02f * 7}), json::array({"G", 0.03f * 29}),
                                          json::array({"B", 0.1f})}));
  EXPECT_EQ(picked("depth.Z", 1, 1)["values"], json::array({json::array({"Z", 40.0f})}));
  EXPECT_EQ(picked("depth.Z", 0, 0)["values"], json::parse(R"([["Z", "inf"]])"));
}

TEST_F(FilesOfViews, PartsCropsAndWhatIsNotANumberAreShown) {
  std::vector<ForeignChannel> combined, extra;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  test::addLayer(combined, "ViewLayer.Combined", "RGB", kHalf,
                 [=](int x, int) { return x == 3 ? glm::vec3(nan) : glm::vec3(0.5f); });
  test::addLayer(extra, "N", "XYZ", kFloat, [](int, int) { return glm::vec3(0, 0, 1); });
  const auto crop = [](const char* name) {
    return [name](OIIO::ImageSpec& spec) {
      spec.attribute("name", name);
      spec.x = 5;
      spec.y = 6;
      spec.full_width = 64;
      spec.full_height = 48;
    };
  };
  test::writeForeignParts(folder / "parts.exr", 8, 4, {{combined, crop("left")}, {extra, crop("right")}});
  FileView view({folder / "parts.exr"}, true);
  const json state = json::parse(view.state().body);
  EXPECT_EQ(state["files"][0]["size"], json({8, 4}));
  ASSERT_EQ(state["files"][0]["layers"].size(), 2u);
  const std::string first = state["files"][0]["layers"][0]["name"],
                    second = state["files"][0]["layers"][1]["name"];
  const Image picture = shown(view, {{"file", 0}, {"layer", first}}).picture;
  ASSERT_EQ(picture.pixels.size(), 8u * 4 * 3);
  EXPECT_GT(picture.pixels[9], 0.9f) << "NaN is red";
  EXPECT_EQ(picture.pixels[10], 0.0f);
  EXPECT_EQ(
      json::parse(view.pick(json{{"file", 0}, {"layer", first}, {"at", {0.4, 0.5}}}.dump()).body)["values"],
      json::parse(R"([["R", "NaN"], ["G", "NaN"], ["B", "NaN"]])"));
  EXPECT_EQ(shown(view, {{"file", 0}, {"layer", second}}).picture.width, 8);
}

TEST_F(FilesOfViews, TwoFilesDifferInFalseColorsAndNumbersWhateverTheirLayersAreCalled) {
  std::vector<ForeignChannel> channels;
  test::addLayer(channels, "Other.Name", "RGB", kFloat, [](int x, int y) {
    return glm::vec3(0.02f * x, 0.03f * y, x == 5 && y == 7 ? 0.6f : 0.1f);
  });
  test::writeForeignParts(folder / "b.exr", 40, 30, {{channels, {}}});
  FileView view({writeFile("a.exr"), folder / "b.exr", writeFile("c.exr", 20, 30)}, true);
  const auto ask = [](const char* layer, int file, const char* other) {
    return json{
        {"file", 0}, {"layer", layer}, {"mode", "difference"}, {"other", {{"file", file}, {"layer", other}}}};
  };
  const Shown difference = shown(view, ask("color", 1, "Other.Name"));
  const int scale = difference.about["scale"];
  EXPECT_EQ(difference.picture.width, 40 * scale);
  EXPECT_GT(difference.picture.height, 30 * scale) << "a scale is below";
  EXPECT_THAT(difference.about["notes"][0].get<std::string>(), HasSubstr("at most 0.5, at pixel 5, 7"));
  const auto at = [&](int x, int y) {
    const std::size_t place = std::size_t(y * scale) * difference.picture.width + std::size_t(x * scale);
    return std::vector(difference.picture.pixels.begin() + std::ptrdiff_t(3 * place),
                       difference.picture.pixels.begin() + std::ptrdiff_t(3 * place + 3));
  };
  EXPECT_EQ(at(6, 7), std::vector<float>(3, 0.0f)) << "equal";
  EXPECT_NE(at(5, 7), std::vector<float>(3, 0.0f));
  EXPECT_EQ(complaint([&] { view.picture(ask("color", 2, "color").dump()); }),
            "A has 40 x 30 pixels, and B 20 x 30: only pictures of one size have a difference");
  EXPECT_EQ(complaint([&] { view.picture(ask("color", 0, "depth").dump()); }),
            "A has 3 numbers a pixel, and B 1: choose layers of one kind");
}

TEST_F(FilesOfViews, ChangedFileIsReadAgainAndOneThatBecameWrongIsTold) {
  const std::string path = writeFile("a.exr");
  FileView view({path}, true), blind({path}, false);
  const auto touch = [&](int seconds) {
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  const auto brightest = [&] {
    const json picked =
        json::parse(view.pick(json{{"file", 0}, {"layer", "color"}, {"at", {1, 1}}}.dump()).body);
    return picked["values"][0][1].get<float>();
  };
  EXPECT_EQ(json::parse(view.state().body)["generation"], 1);
  EXPECT_EQ(brightest(), 0.02f * 39);
  writeFile("a.exr", 40, 30, 3);
  touch(2);
  const json changed = json::parse(view.state().body);
  EXPECT_EQ(changed["generation"], 2);
  EXPECT_EQ(changed["fault"], nullptr);
  EXPECT_EQ(brightest(), 3 * (0.02f * 39));
  test::writeText(path, test::readText(path).substr(0, 300));
  touch(4);
  const json wrong = json::parse(view.state().body);
  EXPECT_EQ(wrong["generation"], 3);
  EXPECT_THAT(wrong["fault"].get<std::string>(), HasSubstr("a.exr"));
  EXPECT_EQ(wrong["files"], changed["files"]) << "as they were";
  EXPECT_THAT(complaint([&] { brightest(); }), HasSubstr("a.exr"));
  EXPECT_EQ(json::parse(view.state().body)["generation"], 3) << "told once";
  std::filesystem::remove(path);
  EXPECT_THAT(json::parse(view.state().body)["fault"].get<std::string>(), HasSubstr("a.exr"));
  writeFile("a.exr", 20, 10);
  touch(6);
  const json mended = json::parse(view.state().body);
  EXPECT_EQ(mended["fault"], nullptr);
  EXPECT_EQ(mended["files"][0]["size"], json({20, 10}));
  EXPECT_EQ(json::parse(blind.state().body)["generation"], 1);
}

TEST_F(FilesOfViews, WrongRequestsAndFilesAreRefused) {
  FileView view({writeFile("a.exr")}, true);
  for (const char* body :
       {"", "[]", "null", "{", "{}", R"({"file": 1})", R"({"file": -1, "layer": "color"})",
        R"({"file": "0"})", R"({"file": 1e300})", R"({"file": 0, "layer": 3})",
        R"({"file": 0, "layer": "no such"})", R"({"file": 0, "layer": "color", "exposure": 101})",
        R"({"file": 0, "layer": "color", "exposure": "1"})",
        R"({"file": 0, "layer": "color", "mode": "difference"})",
        R"({"file": 0, "layer": "color", "mode": 3})", R"({"file": 0, "layer": "color", "mix": {"key": 2}})",
        R"({"file": 0, "layer": "color", "mix": {"key": [2, "red"]}})",
        R"({"file": 0, "layer": "color", "mix": {"key": [-2, "#ffffff"]}})",
        "{\"file\": 0, \"layer\": \"\xff\"}"})
    EXPECT_THROW(view.picture(body), InputError) << body;
  for (const char* body :
       {"{}", R"({"file": 0, "layer": "color"})", R"({"file": 0, "layer": "color", "at": [0]})",
        R"({"file": 0, "layer": "color", "at": [2, 0]})", R"({"file": 0, "layer": "color", "at": ["0", 0]})"})
    EXPECT_THROW(view.pick(body), InputError) << body;
  const json deep = json::parse(view.pick(R"({"file": 0, "layer": "color", "at": [0, 0], "more": )" +
                                          std::string(100000, '[') + std::string(100000, ']') + "}")
                                    .body);
  EXPECT_EQ(deep["pixel"], json({0, 0})) << "what nobody asks for is passed over";
  EXPECT_THROW(FileView({folder / "none.exr"}, true), InputError);
  test::writeText(folder / "text.exr", "no picture");
  EXPECT_THROW(FileView({folder / "text.exr"}, true), InputError);
}

}  // namespace
}  // namespace luciole
