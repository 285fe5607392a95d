#include "tools/bench/picture_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text_file.hpp"
#include "base/write_file.hpp"
#include "lighting/stats.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "tools/bench/child_process.hpp"

namespace luciole {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kShipped[] = {"fireflies", "colonnade", "underwater", "city", "spheres", "cornell"};

constexpr int kRunsAfterCold = 3;  ///< after each cold one

constexpr const char* kStandardInput =
    "a picture is made by another process, which can't read this one's input";

/// Stages that are told together, and how.
struct StageGroup {
  const char *key, *head;
  std::vector<Stage> stages;
};
const std::vector<StageGroup> kGroups{
    {"load_milliseconds", "load", {Stage::kLoadScene}},
    {"wait_milliseconds", "wait", {Stage::kWaitForDevice, Stage::kWaitForKernels}},
    {"rasterize_milliseconds", "rasterize", {Stage::kRasterize}},
    {"lights_milliseconds", "lights", {Stage::kPrepareLights, Stage::kCull}},
    {"shadow_milliseconds",
     "shadows",
     {Stage::kTriangleTree, Stage::kFindShadowTexels, Stage::kShadowMaps, Stage::kBeamShadows,
      Stage::kShadowRays}},
    {"shade_milliseconds", "shade", {Stage::kShade, Stage::kReadBack, Stage::kResolve}},
    {"write_milliseconds", "write", {Stage::kWrite}}};

/// What luciole is to render, where to, and how.
Arguments renderArguments(const SpeedInput& input, const std::string& scene, const std::string& output,
                          const Arguments& options) {
  Arguments all{"render", scene, "-o", output, "--device", input.device_selector, "--quiet"};
  if (input.size)
    for (const std::string& word :
         {std::string("--size"), fmt::format("{}x{}", input.size->x, input.size->y)})
      all.push_back(word);
  for (const Arguments& more : {input.picture_options, sameThreads(), options})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Milliseconds of each group of stages, from the statistics of a run that took so long; then of the rest of
/// it but counting lights, which only statistics ask for.
std::vector<double> groupTimes(const nlohmann::json& stats, double milliseconds) {
  const auto share = [&](Stage stage) {
    double sum = 0;
    for (const auto& one : stats["stages"])
      if (one["name"] == stageName(stage)) sum += one["wall_milliseconds"].get<double>();
    return sum;
  };
  std::vector<double> times;
  double rest = milliseconds - share(Stage::kCountLights);
  for (const StageGroup& group : kGroups) {
    times.push_back(0);
    for (const Stage stage : group.stages) times.back() += share(stage);
    rest -= times.back();
  }
  times.push_back(rest);
  return times;
}

/// A scene's cold and warm time, the times of groups, and its peak memory in MiB.
std::vector<double> pictureFigures(const SpeedInput& input, const std::string& scene) {
  const ScratchFolder folder;
  const auto cache = kernelCacheIn(folder);
  const Arguments arguments = renderArguments(input, scene, folder / "picture.png", {});
  const double cold = runChild(input.program, arguments, cache);
  std::vector<double> warm;
  for (int i = 0; i < kRunsAfterCold; ++i) warm.push_back(runChild(input.program, arguments, cache));
  const Arguments with_stats =
      renderArguments(input, scene, folder / "picture.png", {"--stats", folder / "stats.json"});
  runChild(input.program, with_stats, cache);  // counting has a kernel of its own
  const double milliseconds = runChild(input.program, with_stats, cache);
  std::ifstream file(folder / "stats.json");
  const auto stats = nlohmann::json::parse(file);
  std::vector<double> figures{cold, summarize(warm).median};
  for (const double time : groupTimes(stats, milliseconds)) figures.push_back(time);
  figures.push_back(stats["memory"]["peak_bytes"].get<double>() / (1 << 20));
  return figures;
}

/// Whether the copy of a scene can be read and has no textures.
bool isUntextured(const std::string& path) {
  return loadScene(path, 1, {.missing = MissingTextures::kWarn}).textures.empty();
}

/// Writes a copy of a Luciole scene, without fog or without the textures of its own materials, to `copy`.
void writeJsonWithout(const std::string& path, bool is_fog, const std::string& copy) {
  OrderedJson scene = OrderedJson::parse(readFile(path), nullptr, true, true);
  const fs::path folder = fs::absolute(path).parent_path();
  const auto makeAbsolute = [&](OrderedJson& holder, const char* key) {
    if (holder.contains(key)) holder[key] = (folder / holder[key].get<std::string>()).string();
  };
  scene.erase("$schema");
  if (is_fog) scene.erase("fog");
  if (scene.contains("materials")) {
    for (auto& [name, material] : scene["materials"].items()) {
      for (const char* map : {"diffuse_map", "emission_map", "normal_map", "bump_map", "alpha_map"}) {
        if (!is_fog) material.erase(map);
        makeAbsolute(material, map);
      }
    }
  }
  if (scene.contains("objects"))
    for (OrderedJson& object : scene["objects"]) makeAbsolute(object, "mesh");
  writeTextFile(copy, scene.dump());
}

/// Copies the MTL files beside an OBJ file to `folder`, without what names pictures, and links to the OBJ
/// file there. Returns the link's path.
std::string linkObjWithoutTextures(const std::string& path, const ScratchFolder& folder) {
  const fs::path obj = fs::absolute(path);
  for (const fs::directory_entry& entry : fs::directory_iterator(obj.parent_path())) {
    if (entry.path().extension() != ".mtl") continue;
    std::ifstream lines(entry.path());
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t word = line.find_first_not_of(" \t");
      const std::string statement = word == std::string::npos ? "" : line.substr(word);
      const auto begins = [&](const char* with) { return statement.starts_with(with); };
      if (!begins("map_") && !begins("bump") && !begins("disp") && !begins("norm")) text += line + "\n";
    }
    writeTextFile(folder / entry.path().filename().string(), text);
  }
  const std::string link = folder / obj.filename().string();
  fs::create_symlink(obj, link);
  return link;
}

/// A scene's copy without its textures. Nothing where they can't be taken out.
std::optional<std::string> copyWithoutTextures(const std::string& scene, const ScratchFolder& folder) {
  const std::string extension = fs::path(scene).extension().string();
  std::string copy;
  if (extension == ".obj") {
    copy = linkObjWithoutTextures(scene, folder);
  } else if (extension == ".json") {
    copy = folder / "untextured.json";
    writeJsonWithout(scene, false, copy);
  }
  if (copy.empty() || !isUntextured(copy)) return std::nullopt;
  return copy;
}

/// A feature, and the arguments of two runs that differ by it; `without` is empty where it can't be left out.
struct FeaturePair {
  std::string name;
  Arguments with, without;
};

std::vector<FeaturePair> featurePairs(const SpeedInput& input, const Scene& scene, const std::string& path,
                                      const ScratchFolder& folder) {
  const auto render = [&](const std::string& file, const char* output, const Arguments& options) {
    return renderArguments(input, file, folder / output, options);
  };
  const Arguments plain = render(path, "a.png", {}), exr = render(path, "a.exr", {});
  std::vector<FeaturePair> pairs;
  if (std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& one) { return one.shadow; })) {
    const Arguments hard = render(path, "a.png", {"--shadows", "hard"});
    pairs.push_back({"shadows", hard, render(path, "b.png", {"--shadows", "off"})});
    pairs.push_back({"pcf for hard shadows", render(path, "b.png", {"--shadows", "pcf"}), hard});
  }
  if (scene.fog.mode != FogMode::kNone) {
    const std::string clear = folder / "clear.json";  // only Luciole's own scenes have fog
    writeJsonWithout(path, true, clear);
    pairs.push_back({"fog", plain, render(clear, "b.png", {})});
  }
  if (!scene.textures.empty()) {
    const auto copy = copyWithoutTextures(path, folder);
    pairs.push_back({"textures", plain, copy ? render(*copy, "b.png", {}) : Arguments{}});
  }
  for (const char* samples : {"4", "16"})
    pairs.push_back(
        {fmt::format("{} samples", samples), render(path, "b.png", {"--samples", samples}), plain});
  pairs.push_back({"EXR for PNG", exr, plain});
  pairs.push_back({"a layer, depth", render(path, "b.exr", {"--aov", "depth"}), exr});
  return pairs;
}

/// A row without any figure.
SpeedRow emptyRow(const std::string& name, const SpeedTable& table, const std::string& why) {
  return {name, std::vector<SpeedCell>(table.columns.size(), NoValue{why})};
}

}  // namespace

std::vector<std::string> shippedScenes(const std::string& program) {
  for (fs::path folder = fs::absolute(program).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* place : {"scenes", "share/luciole/scenes"}) {
      std::vector<std::string> found;
      for (const char* name : kShipped)
        if (const fs::path path = folder / place / (std::string(name) + ".json"); isFile(path))
          found.push_back(path.string());
      if (found.size() == std::size(kShipped)) return found;
    }
  }
  throw MachineError(fmt::format("{}: its scenes are in no folder above it; name a scene", program));
}

SpeedTable measurePictures(const SpeedInput& input) {
  const bool is_named = !input.scene_path.empty();
  const std::vector<std::string> scenes =
      is_named ? std::vector{input.scene_path} : shippedScenes(input.program);
  const int rounds = (input.repeats + kRunsAfterCold - 1) / kRunsAfterCold;
  SpeedTable table{
      .name = "picture",
      .measured = fmt::format(
          "luciole render SCENE -o picture.png from its start to its end{}; cold: with an empty cache of "
          "kernels; warm: the median of {} runs with a full one; then the parts of another, with --stats: "
          "stages, without the time they ran beside others and without counting lights, and the rest, "
          "starting and ending the process among it; and its peak memory; rounds: {}",
          input.size ? fmt::format(", {} x {} pixels", input.size->x, input.size->y) : "", kRunsAfterCold,
          rounds),
      .columns = {{"cold_milliseconds", "cold, ms", 0}, {"warm_milliseconds", "warm, ms", 0}}};
  for (const StageGroup& group : kGroups) table.columns.push_back({group.key, group.head, 0});
  table.columns.push_back({"rest_milliseconds", "rest", 0});
  table.columns.push_back({"peak_mebibytes", "peak, MiB", 0});
  if (input.scene_path == "-") {
    table.rows.push_back(emptyRow("standard input", table, kStandardInput));
    return table;
  }
  const auto figures = runInRounds(scenes.size(), rounds, table.name, input.on_progress,
                                   [&](std::size_t row) { return pictureFigures(input, scenes[row]); });
  for (std::size_t row = 0; row < scenes.size(); ++row) {
    table.rows.push_back({fs::path(scenes[row]).stem().string(), {}});
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      table.rows.back().cells.emplace_back(figures[row].summary(i));
  }
  return table;
}

SpeedTable measureFeatureCosts(const SpeedInput& input) {
  SpeedTable table{.name = "cost of a feature",
                   .measured = "",
                   .columns = {{"with_milliseconds", "with, ms", 0},
                               {"without_milliseconds", "without, ms", 0},
                               {"cost_milliseconds", "costs, ms", 0},
                               {"times_without", "times without", 2}}};
  const bool is_named = !input.scene_path.empty();
  const std::string path = is_named ? input.scene_path : shippedScenes(input.program).front();
  const int rounds = (input.repeats + 1) / 2;  // of two runs each
  table.measured = fmt::format(
      "luciole render {} from its start to its end, with a full cache of kernels, with and without a "
      "feature, one after the other; PNG, one sample, hard shadows unless said; pairs: {}",
      is_named ? input.scene->name : fs::path(path).stem().string(), rounds);
  if (path == "-") {
    table.rows.push_back(emptyRow("standard input", table, kStandardInput));
    return table;
  }
  const Scene shipped = is_named ? Scene{} : loadScene(path);
  const ScratchFolder folder;
  const std::vector<FeaturePair> pairs = featurePairs(input, is_named ? *input.scene : shipped, path, folder);
  for (const FeaturePair& pair : pairs)
    for (const Arguments& arguments : {pair.with, pair.without})
      if (!arguments.empty()) runChild(input.program, arguments, {});  // compiles what no cache has
  std::vector<int> runs(pairs.size());
  const auto figures = runInRounds(pairs.size(), rounds, table.name, input.on_progress, [&](std::size_t row) {
    const auto& [name, with, without] = pairs[row];
    if (without.empty()) return std::vector<double>(3);
    // Either goes first in turn.
    const bool with_first = runs[row]++ % 2 == 0;
    const double first = runChild(input.program, with_first ? with : without, {});
    const double second = runChild(input.program, with_first ? without : with, {});
    const double milliseconds = with_first ? first : second, less = with_first ? second : first;
    return std::vector<double>{milliseconds, less, milliseconds - less};
  });
  for (std::size_t row = 0; row < pairs.size(); ++row) {
    const RoundFigures& all = figures[row];
    if (pairs[row].without.empty())
      table.rows.push_back(
          emptyRow(pairs[row].name, table, "textures that a mesh file holds or names can't be left out"));
    else
      table.rows.push_back(
          {pairs[row].name,
           {all.summary(0), all.summary(1), all.summary(2), ratio(all.figures[0], all.figures[1])}});
  }
  return table;
}

}  // namespace luciole
