#include "tools/scale/scale_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "luciole/error.hpp"
#include "shared_files.hpp"
#include "tools/scale/made_up_experiment.hpp"

namespace luciole::test {
namespace {

void writeTextInFolder(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  writeText(path, text);
}

/// What an InputError says; empty where none is thrown.
template <class Function>
std::string refusal(Function&& function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

using testing::HasSubstr;

TEST(ScaleLog, HoldsWhatWasAppendedWhenItIsOpenedAgain) {
  const TemporaryFolder folder;
  const std::string path = folder / "run";
  const ScaleDescription description = madeUpExperiment();
  const std::string point = pointName(description, description.points[1]);
  EXPECT_EQ(point, "lights=1 culling=tiles");
  PointCheck check = madeUpCheck("a", 0.1 + 0.2);  // takes all 17 digits
  check.reach = HUGE_VAL;
  {
    ScaleLog log(path, description);
    log.append(madeUpMachine("one"));
    log.append(point, check);
    log.append(point, 1, madeUpRun(1.0 / 3, 2));
    log.append(madeUpMachine("one"));
  }
  const std::string text = readText(path + "/results.jsonl");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);  // the machine once
  ScaleLog log(path, description);
  EXPECT_EQ(log.results().machines.size(), 1u);
  EXPECT_EQ(log.results().machines[0].processor, "one");
  EXPECT_EQ(log.results().machines[0].memory_bytes, std::uint64_t(1) << 34);
  const PointRecord& record = log.record(point);
  ASSERT_TRUE(record.check);
  EXPECT_EQ(record.check->error.mean_abs, 0.1 + 0.2);
  EXPECT_EQ(record.check->reach, HUGE_VAL);
  EXPECT_EQ(record.check->list_map, check.list_map);
  ASSERT_EQ(record.runs.size(), 1u);
  EXPECT_EQ(record.runs.at(1).stages, madeUpRun(1.0 / 3, 2).stages);
  EXPECT_EQ(record.runs.at(1).peak_bytes, 2000u);
  EXPECT_FALSE(log.record(pointName(description, description.points[0])).check);
}

TEST(ScaleLog, HoldsBoundsWhereACheckHasThem) {
  const TemporaryFolder folder;
  const ScaleDescription description = madeUpExperiment();
  PointCheck check = madeUpCheck("a", 0.5);
  {
    ScaleLog log(folder / "run", description);
    log.append("lights=1 culling=none", check);
    check.bounds = madeUpBounds(0.1 + 0.2, 0.75);
    check.bounds->violations = 3;
    check.bound_map = "pictures/a-bounds.png";
    log.append("lights=1 culling=tiles", check);
  }
  const ScaleResults read = readScaleLog(folder / "run");
  EXPECT_FALSE(read.records.at("lights=1 culling=none").check->bounds);
  const PointCheck& bounded = *read.records.at("lights=1 culling=tiles").check;
  ASSERT_TRUE(bounded.bounds);
  for (const auto& [name, figure] : kBoundFigures)
    EXPECT_EQ(*bounded.bounds.*figure, *check.bounds.*figure) << name;
  for (const auto& [name, number] : kBoundCounts)
    EXPECT_EQ(*bounded.bounds.*number, *check.bounds.*number) << name;
  EXPECT_EQ(bounded.bound_map, check.bound_map);
}

TEST(ScaleLog, CutsOffALineThatWasNotFinished) {
  const TemporaryFolder folder;
  const std::string path = folder / "run", file = path + "/results.jsonl";
  const ScaleDescription description = madeUpExperiment();
  const std::string point = pointName(description, description.points[0]);
  { ScaleLog(path, description).append(point, 0, madeUpRun(1, 2)); }
  const std::string whole = readText(file);
  writeText(file, whole + R"({"point": "lights=1 cul)");
  EXPECT_EQ(readScaleLog(path).records.at(point).runs.size(), 1u);
  {
    ScaleLog log(path, description);
    EXPECT_EQ(readText(file), whole);
    log.append(point, 1, madeUpRun(3, 4));
  }
  EXPECT_EQ(readScaleLog(path).records.at(point).runs.size(), 2u);
  // Even the first line.
  writeText(file, R"({"experiment")");
  ScaleLog anew(path, description);
  EXPECT_TRUE(anew.results().records.empty());
  EXPECT_EQ(readText(file), whole.substr(0, whole.find('\n') + 1));
}

TEST(ScaleLog, RefusesAnotherExperimentAndSaysWhatDiffers) {
  const TemporaryFolder folder;
  const std::string path = folder / "run";
  const ScaleDescription first = madeUpExperiment();
  { ScaleLog log(path, first); }
  const std::string text = readText(path + "/results.jsonl");
  const auto refusalWith = [&](auto change) {
    ScaleDescription other = first;
    change(other);
    return refusal([&] { ScaleLog(path, other); });
  };
  EXPECT_THAT(refusalWith([](auto& d) { d.scene = "c.json"; }), HasSubstr("c.json"));
  EXPECT_THAT(refusalWith([](auto& d) { d.digest = 1; }), HasSubstr("another state of the scene"));
  EXPECT_THAT(refusalWith([](auto& d) { d.version = "2"; }), HasSubstr("version"));
  EXPECT_THAT(refusalWith([](auto& d) { d.settings[1].second = "8"; }), HasSubstr("seed 7"));
  EXPECT_THAT(refusalWith([](auto& d) { d.lights.back() = 50; }), HasSubstr("numbers of lights"));
  EXPECT_THAT(refusalWith([](auto& d) { d.repeats = 3; }), HasSubstr("2 repeats"));
  EXPECT_THAT(refusalWith([](auto& d) { d.points.pop_back(); }), HasSubstr("variants"));
  EXPECT_EQ(readText(path + "/results.jsonl"), text);
  EXPECT_EQ(refusal([&] { ScaleLog(path, first); }), "");
}

TEST(ScaleLog, RefusesWhatIsNoLogAndNamesTheLine) {
  const TemporaryFolder folder;
  const std::string path = folder / "run", file = path + "/results.jsonl";
  { ScaleLog log(path, madeUpExperiment()); }
  const std::string head = readText(file);
  for (const auto& [text, line] : {std::pair<std::string, const char*>{"hello\n", "line 1"},
                                   {"{}\n", "line 1"},
                                   {head + "[1]\n", "line 2"},
                                   {head + "{\"point\": 3}\n", "line 2"},
                                   {head + "\n", "line 2"},
                                   {head + "{\"point\": \"a\", \"check\": {}}\n", "line 2"}}) {
    writeText(file, text);
    EXPECT_THAT(refusal([&] { ScaleLog(path, madeUpExperiment()); }), HasSubstr(line)) << text;
    EXPECT_THAT(refusal([&] { readScaleLog(path); }), HasSubstr(line)) << text;
    EXPECT_EQ(readText(file), text);
  }
  EXPECT_THAT(refusal([&] { readScaleLog(folder / "nothing"); }), HasSubstr("nothing"));
  writeText(file, "");
  EXPECT_THAT(refusal([&] { readScaleLog(path); }), HasSubstr("empty"));
}

TEST(ScaleLog, OneProcessAtATime) {
  const TemporaryFolder folder;
  const ScaleLog log(folder / "run", madeUpExperiment());
  EXPECT_THAT(refusal([&] { ScaleLog(folder / "run", madeUpExperiment()); }), HasSubstr("another"));
}

TEST(ScaleLog, FolderThatCannotBeIsRefused) {
  const TemporaryFolder folder;
  writeText(folder / "file", "");
  EXPECT_THAT(refusal([&] { ScaleLog(folder / "file/run", madeUpExperiment()); }), HasSubstr("file/run"));
}

/// A shard's folder with one run of the point, and its pictures.
void makeShard(const std::string& folder, const ScaleDescription& description, std::size_t index,
               const std::string& processor) {
  ScaleLog log(folder, description);
  log.append(madeUpMachine(processor));
  const std::string point = pointName(description, description.points[index]);
  const PointCheck check = madeUpCheck(std::to_string(index), 0.5);
  for (const std::string& file : {check.picture, check.error_map, check.list_map})
    writeTextInFolder(folder + "/" + file, file);
  log.append(point, check);
  log.append(point, 0, madeUpRun(1, 2));
}

TEST(ScaleLog, MergedShardsHoldEveryRunPictureAndMachine) {
  const TemporaryFolder folder;
  const ScaleDescription description = madeUpExperiment();
  for (std::size_t i = 0; i < 3; ++i)
    makeShard(folder / std::to_string(i), description, i, i == 0 ? "one" : "two");
  const ScaleResults merged = mergeScaleLogs({folder / "0", folder / "1", folder / "2"}, folder / "merged");
  EXPECT_EQ(merged.machines.size(), 2u);
  EXPECT_EQ(merged.records.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "pictures/" + std::to_string(i) + "-lists.png";
    EXPECT_EQ(readText(folder / ("merged/" + name)), name);
  }
  const ScaleResults read = readScaleLog(folder / "merged");
  EXPECT_TRUE(read.description == description);
  EXPECT_EQ(read.records.size(), 3u);
}

TEST(ScaleLog, MergedShardsHoldMapsOfBounds) {
  const TemporaryFolder folder;
  const ScaleDescription description = madeUpExperiment();
  makeShard(folder / "one", description, 0, "one");
  {
    ScaleLog log(folder / "one", description);
    PointCheck check = madeUpCheck("0", 0.5);
    check.bounds = madeUpBounds(0.5, 0.5);
    check.bound_map = "pictures/0-bounds.png";
    writeTextInFolder(folder / "one/pictures/0-bounds.png", "bounds");
    log.append(pointName(description, description.points[1]), check);
  }
  mergeScaleLogs({folder / "one"}, folder / "merged");
  EXPECT_EQ(readText(folder / "merged/pictures/0-bounds.png"), "bounds");
}

TEST(ScaleLog, MergeRefusesDevicesOfOtherBitsUnlessTold) {
  const TemporaryFolder folder;
  const ScaleDescription description = madeUpExperiment();
  const char* arithmetic[] = {"aa", "aa", "", "bb"};  // of none it isn't known
  for (std::size_t i = 0; i < 4; ++i) {
    if (i < 3) makeShard(folder / std::to_string(i), description, i, "one");
    ScaleLog log(folder / std::to_string(i), description);
    Machine machine = madeUpMachine("with hash");
    machine.device.arithmetic = arithmetic[i];
    log.append(machine);
  }
  EXPECT_EQ(readScaleLog(folder / "3").machines[0].device.arithmetic, "bb");
  const auto merge = [&](std::vector<std::string> names, const char* to, bool mixes) {
    for (std::string& name : names) name = folder / name;
    return refusal([&] { mergeScaleLogs(names, folder / to, mixes); });
  };
  EXPECT_EQ(merge({"0", "1", "2"}, "alike", false), "");
  EXPECT_THAT(merge({"0", "3"}, "other", false), HasSubstr("--mix-devices"));
  EXPECT_FALSE(std::filesystem::exists(folder / "other"));
  EXPECT_EQ(merge({"0", "3"}, "other", true), "");
}

TEST(ScaleLog, MergeRefusesWhatIsNotOneExperiment) {
  const TemporaryFolder folder;
  const ScaleDescription description = madeUpExperiment();
  ScaleDescription other = description;
  other.settings[1].second = "8";
  makeShard(folder / "0", description, 0, "one");
  makeShard(folder / "again", description, 0, "one");
  makeShard(folder / "other", other, 1, "one");
  makeShard(folder / "bare", description, 1, "one");
  std::filesystem::remove(folder / "bare/pictures/1.png");
  const auto merge = [&](const char* second, const char* to) {
    return refusal([&] { mergeScaleLogs({folder / "0", folder / second}, folder / to); });
  };
  EXPECT_THAT(merge("other", "merged"), HasSubstr("seed"));
  EXPECT_THAT(merge("again", "merged"), HasSubstr("lights=1 culling=none"));
  EXPECT_THAT(merge("nothing", "merged"), HasSubstr("nothing"));
  EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
  EXPECT_THAT(merge("bare", "merged"), HasSubstr("pictures/1.png"));
  EXPECT_THAT(merge("other", "0"), HasSubstr("already"));
}

TEST(ScaleLog, NumbersThatDoNotFitAreRefusedWithTheirKeyAndLine) {
  const TemporaryFolder folder;
  const std::string path = folder / "run", file = path + "/results.jsonl";
  makeShard(path, madeUpExperiment(), 0, "one");
  const std::string whole = readText(file);
  for (const auto& [good, bad, said] :
       {std::array{"\"repeats\":2", "\"repeats\":1e300", "line 1: repeats 1e+300: expected a whole number"},
        std::array{"\"repeats\":2", "\"repeats\":3000000000", "line 1: repeats 3000000000: expected"},
        std::array{"\"lights\":[1,100]", "\"lights\":[1,-1]", "line 1: lights -1: expected"},
        std::array{"\"digest\":", "\"digest\":-", "line 1: digest -"},
        std::array{"\"threads\":2", "\"threads\":2.5", "line 2: threads 2.5: expected"},
        std::array{"\"pixels\":16", "\"pixels\":true", "line 3: pixels true: expected"},
        std::array{"\"repeat\":0", "\"repeat\":-4000000000", "line 4: repeat -4000000000: expected"}}) {
    std::string text = whole;
    ASSERT_NE(text.find(good), text.npos) << good;
    writeText(file, text.replace(text.find(good), std::string(good).size(), bad));
    EXPECT_THAT(refusal([&] { readScaleLog(path); }), HasSubstr(said)) << bad;
  }
}

/// A shard whose log says that the first point's picture is `file`.
void makeShardNaming(const std::string& folder, const std::string& file) {
  makeShard(folder, madeUpExperiment(), 0, "one");
  std::string log = readText(folder + "/results.jsonl");
  const std::string named = "\"pictures/0.png\"";
  log.replace(log.find(named), named.size(), "\"" + file + "\"");
  writeTextInFolder(folder + "/results.jsonl", log);
}

TEST(ScaleLog, NamesPicturesOfItsOwnFolderOrIsRefusedWithItsLine) {
  const TemporaryFolder folder;
  writeText(folder / "secret.png", "secret");
  for (const std::string file :
       {"../secret.png", "pictures/../../secret.png", "/etc/hostname", "", ".", "..", "pictures", "0.png",
        "results.jsonl", "pictures/../results.jsonl", "other/pictures/0.png"}) {
    makeShardNaming(folder / "shard", file);
    const std::string said = refusal([&] { mergeScaleLogs({folder / "shard"}, folder / "merged"); });
    EXPECT_THAT(said, HasSubstr("results.jsonl: line 3: picture \"" + file + "\"")) << file;
    EXPECT_EQ(said.find('\n'), std::string::npos);
    EXPECT_EQ(refusal([&] { readScaleLog(folder / "shard"); }), said);
    EXPECT_EQ(refusal([&] { ScaleLog(folder / "shard", madeUpExperiment()); }), said);
    EXPECT_FALSE(std::filesystem::exists(folder / "merged")) << file;
    std::filesystem::remove_all(folder / "shard");
  }
  EXPECT_EQ(readText(folder / "secret.png"), "secret");
}

TEST(ScaleLog, LinksOutOfItsFolderAreNotFollowed) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  writeText(folder / "secret.png", "secret");
  writeTextInFolder(folder / "elsewhere/0.png", "secret");
  for (const char* name : {"file", "chain", "folder", "device"})
    makeShard(folder / name, madeUpExperiment(), 0, "one");
  const auto relink = [&](const std::string& link, const std::string& target) {
    fs::remove_all(link);
    fs::create_symlink(target, link);
  };
  relink(folder / "file/pictures/0.png", folder / "secret.png");
  relink(folder / "chain/pictures/0.png", "again.png");
  relink(folder / "chain/pictures/again.png", "../../secret.png");
  relink(folder / "folder/pictures", "../elsewhere");
  relink(folder / "device/pictures/0.png", "/dev/zero");
  for (const char* name : {"file", "chain", "folder", "device"}) {
    EXPECT_THAT(refusal([&] { mergeScaleLogs({folder / name}, folder / "merged"); }),
                HasSubstr("pictures/0.png: expected a file in the experiment's folder"))
        << name;
    EXPECT_FALSE(fs::exists(folder / "merged")) << name;
  }
  // One that stays inside is as good as the file.
  makeShard(folder / "inside", madeUpExperiment(), 0, "one");
  fs::rename(folder / "inside/pictures/0.png", folder / "inside/kept.png");
  relink(folder / "inside/pictures/0.png", "../kept.png");
  EXPECT_EQ(refusal([&] { mergeScaleLogs({folder / "inside"}, folder / "merged"); }), "");
  EXPECT_EQ(readText(folder / "merged/pictures/0.png"), "pictures/0.png");
}

TEST(ScaleLog, DescriptionThatContradictsItselfIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "run", file = path + "/results.jsonl";
  { ScaleLog log(path, madeUpExperiment()); }
  const std::string head = readText(file);
  for (const auto& [part, by] : {std::pair<std::string, std::string>{R"("lights":[1,100])", R"("lights":[])"},
                                 {R"("values":["tiles"]})", R"("values":[]})"},
                                 {R"("values":["tiles"]})", R"("values":["tiles","4"]})"}}) {
    std::string text = head;
    ASSERT_NE(text.find(part), std::string::npos) << text;
    writeText(file, text.replace(text.find(part), part.size(), by));
    EXPECT_THAT(refusal([&] { readScaleLog(path); }), HasSubstr("line 1: expected numbers of lights")) << by;
  }
}

TEST(ScaleLog, SaysWhyAFigureIsNull) {
  const TemporaryFolder folder;
  ScaleLog log(folder / "run", madeUpExperiment());
  PointCheck check = madeUpCheck("a", 0.5);
  log.append("lights=1 culling=none", check);
  check.reach = HUGE_VAL;
  log.append("lights=1 culling=tiles", check);
  const std::string text = readText(folder / "run/results.jsonl");
  EXPECT_THAT(text, HasSubstr(R"("reasons":{"reach":"a light without a range reaches everywhere"})"));
  EXPECT_EQ(text.find("reasons"), text.rfind("reasons"));
}

}  // namespace
}  // namespace luciole::test
