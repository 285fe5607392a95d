// Each measurement of speed at a tiny size: its rows, and what must hold between their figures however fast
// the machine is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "base/embedded_files.hpp"
#include "kernels/probe.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "shared_files.hpp"
#include "tools/bench/culled_shading.hpp"
#include "tools/bench/light_errors.hpp"
#include "tools/bench/many_lights.hpp"
#include "tools/bench/memory_use.hpp"
#include "tools/bench/picture_time.hpp"
#include "tools/bench/raster_speed.hpp"
#include "tools/bench/shading_rate.hpp"
#include "tools/bench/shadow_scenes.hpp"
#include "tools/bench/shadowed_lights.hpp"
#include "tools/bench/start_time.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;

SpeedInput tinyInput() {
  return {.device = deviceWithLanes(16),
          .device_selector = "",
          .scene = nullptr,
          .size = glm::ivec2(64, 36),
          .shadow_size = {},
          .repeats = 2,
          .program = LUCIOLE_BINARY,
          .on_progress = {},
          .most_lights = 1000};
}

std::vector<std::string> rowNames(const SpeedTable& table) {
  std::vector<std::string> names;
  for (const SpeedRow& row : table.rows) names.push_back(row.name);
  return names;
}

const SpeedCell& cellOf(const SpeedTable& table, std::size_t row, const std::string& key) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (table.columns[i].key == key) return table.rows.at(row).cells.at(i);
  throw std::logic_error("no column " + key);
}

double count(const SpeedTable& table, std::size_t row, const std::string& key) {
  return std::get<double>(cellOf(table, row, key));
}

double median(const SpeedTable& table, std::size_t row, const std::string& key) {
  return std::get<Repeated>(cellOf(table, row, key)).median;
}

/// What holds for every table: as many cells as columns, a sentence, and no figure that can't be.
void expectWhole(const SpeedTable& table) {
  EXPECT_GT(table.measured.size(), 20u) << table.name;
  for (const SpeedRow& row : table.rows) {
    ASSERT_EQ(row.cells.size(), table.columns.size()) << row.name;
    for (const SpeedCell& cell : row.cells) {
      if (const double* value = std::get_if<double>(&cell)) {
        EXPECT_TRUE(std::isfinite(*value) && *value >= 0) << row.name;
      }
      if (const Repeated* runs = std::get_if<Repeated>(&cell)) {
        EXPECT_TRUE(std::isfinite(runs->median) && runs->spread >= 0) << row.name;
      }
    }
  }
}

TEST(ShadingRate, OursIsHeldAgainstTheYardsticks) {
  const SpeedTable table = measureShadingRate(tinyInput());
  expectWhole(table);
  ASSERT_EQ(table.rows.size(), 1 + yardstickKernels().size());
  EXPECT_EQ(table.rows[0].name, "plain");
  EXPECT_EQ(table.rows[1].name, "ours");
  EXPECT_EQ(median(table, 0, "times_plain"), 1);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    // 64 lights on 64 x 48 pixels, the tiles' last rows included.
    const double pairs = 64.0 * 64 * 48;
    EXPECT_NEAR(
        count(table, row, "million_pairs_per_second") * median(table, row, "milliseconds") * 1000 / pairs, 1,
        1e-12);  // a few operations in double
    EXPECT_GT(median(table, row, "times_plain"), 0);
  }
}

TEST(CulledShading, CountsPairsWithAndWithoutCulling) {
  const SpeedTable table = measureCulledShading(tinyInput());
  expectWhole(table);
  ASSERT_THAT(rowNames(table), ElementsAre("in one, no lists", "lists of 8 x 8 pixels",
                                           "lists of 16 x 16 pixels", "no culling"));
  const std::size_t none = 3;
  EXPECT_DOUBLE_EQ(count(table, none, "million_pairs_evaluated"), 1e-6 * 1024 * 64 * 36);
  EXPECT_EQ(median(table, none, "cull_milliseconds"), 0);
  for (std::size_t row = 0; row < none; ++row) {
    EXPECT_EQ(count(table, row, "million_pairs_in_range"), count(table, none, "million_pairs_in_range"));
    EXPECT_GT(count(table, row, "million_pairs_evaluated"), 0);
    EXPECT_LT(count(table, row, "million_pairs_evaluated"), count(table, none, "million_pairs_evaluated"));
    EXPECT_EQ(median(table, row, "cull_milliseconds") > 0, row > 0)
        << "lists are culled for before they are shaded by";
    EXPECT_GT(median(table, row, "shade_milliseconds"), 0);
  }
}

TEST(ManyLights, ASeriesOfPowersOfTenAfterTheSphere) {
  const SpeedTable table = measureManyLights(tinyInput());
  expectWhole(table);
  ASSERT_THAT(rowNames(table), ElementsAre("sphere", "city", "city", "city", "city"));
  double lights = 1;
  for (std::size_t row = 1; row < table.rows.size(); ++row, lights *= 10) {
    EXPECT_EQ(count(table, row, "lights"), lights);
    EXPECT_EQ(count(table, row, "list_bytes") > 0, lights < 1000) << "many lights need no lists in memory";
    EXPECT_GT(count(table, row, "list_entries"), 0);
    for (const char* stage : {"prepare_lights_milliseconds", "shade_milliseconds"}) {
      EXPECT_GT(median(table, row, stage), 0) << stage;
      EXPECT_LE(median(table, row, stage), median(table, row, "milliseconds")) << stage;
    }
  }
}

TEST(LightErrors, ThreePlacementsOfTwoNumbersKeepFourBounds) {
  SpeedInput input = tinyInput();
  input.most_lights = 10'000;
  const SpeedTable table = measureLightErrors(input);
  expectWhole(table);
  ASSERT_EQ(table.rows.size(), 3u * 2 * 4);
  EXPECT_EQ(table.rows[0].name, "box, 1/16");
  EXPECT_EQ(table.rows[12].name, "clusters, 1/16");
  EXPECT_EQ(table.rows[23].name, "surfaces, 1/1024");
  EXPECT_TRUE(table.failures.empty());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double steps = 255.0 / std::array{16, 64, 256, 1024}[row % 4];
    EXPECT_EQ(count(table, row, "lights"), row / 4 % 2 == 0 ? 1000 : 10'000);
    EXPECT_LE(count(table, row, "runs"), input.repeats);
    EXPECT_GT(median(table, row, "milliseconds"), 0);
    EXPECT_GT(median(table, row, "exact_milliseconds"), 0);
    EXPECT_GT(median(table, row, "times_faster"), 0);
    // A float's rounding more.
    EXPECT_LE(count(table, row, "max_bound_steps"), 1.000001 * steps);
    EXPECT_GT(count(table, row, "max_bound_steps"), 0.5 * steps);
    EXPECT_LT(count(table, row, "mean_bound_steps"), count(table, row, "max_bound_steps"));
    EXPECT_GT(count(table, row, "max_error_steps"), 0);
    EXPECT_LT(count(table, row, "mean_error_steps"), count(table, row, "max_error_steps"));
    EXPECT_LE(count(table, row, "max_used"), 1);
    EXPECT_LT(count(table, row, "mean_used"), count(table, row, "max_used"));
    EXPECT_EQ(count(table, row, "violations"), 0);
  }
}

TEST(LightErrors, WithNothingToLightThereIsNothingToMeasure) {
  SpeedInput input = tinyInput();
  Scene scene;
  scene.name = "nothing";
  scene.cameras.emplace_back();
  input.scene = &scene;
  EXPECT_THROW(measureLightErrors(input), InputError);
}

TEST(ShadowedLights, EachWayIsHeldAgainstEveryRay) {
  SpeedInput input = tinyInput();
  const Scene hall = makeLampHall(4);
  input.scene = &hall;
  const SpeedTable table = measureShadowedLights(input);
  expectWhole(table);
  EXPECT_TRUE(table.failures.empty());
  const std::vector<std::string> ways{"every ray", "one by one", "sampled, 95 %", "sampled, 99 %",
                                      "light tree"};
  ASSERT_EQ(table.rows.size(), ways.size()) << "1000 lights";
  for (std::size_t i = 0; i < ways.size(); ++i) {
    EXPECT_EQ(table.rows[i].name, "hall, 4 lamps, " + ways[i]);
    EXPECT_EQ(count(table, i, "lights"), 1000);
    if (i > 0) {
      EXPECT_GT(median(table, i, "milliseconds"), 0);
    }
  }
  EXPECT_GT(std::get<Estimate>(cellOf(table, 0, "milliseconds")).value, 0);
  EXPECT_LT(count(table, 0, "rays"), 1000) << "no point faces all lights";
  EXPECT_LT(count(table, 1, "rmse"), 0.01) << "but for rounding exact";
  EXPECT_EQ(count(table, 1, "within_error"), 100);
  for (const std::size_t i : {2, 3}) {
    EXPECT_GT(count(table, i, "rays"), 0);
    EXPECT_LT(count(table, i, "rmse"), 1);
    EXPECT_GT(count(table, i, "within_error"), 95);
    EXPECT_GT(count(table, i, "within_interval"), 90);
  }
  EXPECT_GE(count(table, 4, "rays"), 1);
  EXPECT_GT(count(table, 4, "rmse"), count(table, 1, "rmse"));
  EXPECT_LE(count(table, 4, "rmse"), count(table, 4, "percentile_99"));
}

TEST(RasterSpeed, DrawsAGBufferAndADepthMapOfTheHallOrOfTheNamedScene) {
  SpeedInput input = tinyInput();
  const SpeedTable hall = measureRasterizer(input);
  expectWhole(hall);
  EXPECT_THAT(rowNames(hall), ElementsAre("G-buffer, 64 x 36", "depth, 64 x 36"));
  EXPECT_THAT(hall.measured, testing::HasSubstr("hall, 263584 triangles"));
  for (std::size_t row = 0; row < 2; ++row)
    for (const char* figure : {"milliseconds", "one_thread_milliseconds", "times_one_thread"})
      EXPECT_GT(median(hall, row, figure), 0) << figure;
  Scene scene;
  scene.name = "nothing";
  scene.cameras.emplace_back();
  input.scene = &scene;
  EXPECT_THAT(measureRasterizer(input).measured, testing::HasSubstr("nothing, 0 triangles"));
}

TEST(StartTime, RunsTheProgramColdOnceAndWarmThrice) {
  const SpeedTable table = measureStart(tinyInput());
  expectWhole(table);
  ASSERT_THAT(rowNames(table), ElementsAre("cold", "warm"));
  EXPECT_EQ(count(table, 0, "runs"), 1);
  EXPECT_EQ(count(table, 1, "runs"), 3);
  EXPECT_GT(median(table, 1, "milliseconds"), 0);
}

std::size_t rowOf(const SpeedTable& table, const std::string& name) {
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (table.rows[row].name == name) return row;
  throw std::logic_error("no row " + name);
}

/// A folder with a textured mesh, and tables of scenes in it.
class PictureTime : public testing::Test {
 protected:
  PictureTime() {
    input.repeats = 1;
    writeText(folder / "map.pgm", "P5\n2 1\n255\n\x40\xc0");
    writeText(folder / "mesh.mtl", "newmtl m\nKd 1 1 1\n  map_Kd map.pgm\n");
    writeText(
        folder / "mesh.obj",
        "mtllib mesh.mtl\nusemtl m\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  }
  /// Makes this the named scene.
  void name(const std::string& file) {
    input.scene_path = folder / file;
    scene = loadScene(input.scene_path);
    input.scene = &scene;
  }
  void nameJson(const std::string& members, const std::string& light, const std::string& material) {
    writeText(folder / "scene.json", R"({"camera": {"eye": [3, 2, 5], "target": [0, 0, 0]}, )" + members +
                                         R"("materials": {"m": {"diffuse": 1)" + material +
                                         R"(}}, "objects": [{"primitive": "plane", "material": "m"}],
                   "lights": [{"type": "spot", "position": [0, 4, 0], "direction": [0, -1, 0], "cutoff": 40)" +
                                         light + "}]}");
    name("scene.json");
  }
  const TemporaryFolder folder;
  Scene scene;
  SpeedInput input = tinyInput();
};

TEST_F(PictureTime, TheShippedScenesAreFoundAboveTheProgram) {
  const std::vector<std::string> scenes = shippedScenes(input.program);
  ASSERT_EQ(scenes.size(), 6u);
  for (const std::string& path : scenes) EXPECT_TRUE(std::filesystem::is_regular_file(path)) << path;
  EXPECT_THROW(shippedScenes(folder / "luciole"), MachineError);
}

TEST_F(PictureTime, IsToldColdAndWarmByStagesAndWithItsMemory) {
  nameJson("", "", "");
  const SpeedTable table = measurePictures(input);
  expectWhole(table);
  ASSERT_THAT(rowNames(table), ElementsAre("scene"));
  // A compiler's work on any kernel is many times that of looking it up.
  EXPECT_GT(median(table, 0, "cold_milliseconds"), median(table, 0, "warm_milliseconds"));
  for (const char* stage : {"load_milliseconds", "rasterize_milliseconds", "lights_milliseconds",
                            "shade_milliseconds", "write_milliseconds", "rest_milliseconds"})
    EXPECT_GT(median(table, 0, stage), 0) << stage;
  EXPECT_EQ(median(table, 0, "shadow_milliseconds"), 0) << "there are none";
  EXPECT_GT(median(table, 0, "peak_mebibytes"), 1);
}

TEST_F(PictureTime, FeaturesThatASceneHasAreHeldAgainstItWithoutThem) {
  nameJson(R"("fog": {"mode": "exp", "density": 0.1}, )", R"(, "shadow": true)",
           R"(, "diffuse_map": "map.pgm")");
  const SpeedTable table = measureFeatureCosts(input);
  expectWhole(table);
  EXPECT_THAT(rowNames(table), ElementsAre("shadows", "pcf for hard shadows", "fog", "textures", "4 samples",
                                           "16 samples", "EXR for PNG", "a layer, depth"));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    // A round each: its medians are its figures.
    const double with = median(table, row, "with_milliseconds"),
                 without = median(table, row, "without_milliseconds");
    EXPECT_GT(with, 0);
    EXPECT_EQ(median(table, row, "cost_milliseconds"), with - without);
    EXPECT_EQ(median(table, row, "times_without"), with / without);
  }
}

TEST_F(PictureTime, FeaturesThatASceneLacksHaveNoRow) {
  nameJson("", "", "");
  EXPECT_THAT(rowNames(measureFeatureCosts(input)),
              ElementsAre("4 samples", "16 samples", "EXR for PNG", "a layer, depth"));
}

TEST_F(PictureTime, TexturesOfAnObjAreLeftOutOfACopyOfItsMaterials) {
  name("mesh.obj");
  ASSERT_FALSE(scene.textures.empty());
  const SpeedTable table = measureFeatureCosts(input);
  expectWhole(table);
  EXPECT_GT(median(table, rowOf(table, "textures"), "without_milliseconds"), 0);
}

TEST_F(PictureTime, TexturesThatAMeshFileNamesInAnotherSceneHaveNoPrice) {
  writeText(folder / "scene.json", R"({"objects": [{"mesh": "mesh.obj"}], "lights": []})");
  name("scene.json");
  ASSERT_FALSE(scene.textures.empty());
  const SpeedTable table = measureFeatureCosts(input);
  for (const SpeedColumn& column : table.columns)
    EXPECT_TRUE(std::holds_alternative<NoValue>(cellOf(table, rowOf(table, "textures"), column.key)));
}

TEST(MemoryUse, GrowsWithPixelsAndLights) {
  SpeedInput input = tinyInput();
  input.size = glm::ivec2(512);
  input.repeats = 1;
  input.most_lights = 200'000;
  const SpeedTable table = measureMemory(input);
  expectWhole(table);
  ASSERT_THAT(rowNames(table), ElementsAre("pixel", "light"));
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_GT(median(table, row, "device_bytes"), 0);
    EXPECT_GT(median(table, row, "peak_bytes"), 0);
  }
}

}  // namespace
}  // namespace luciole::test
