// --log json: what happens, as lines of JSON on standard error.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using Events = std::vector<nlohmann::json>;

class EventLog : public ProgramTest {
 protected:
  EventLog() { writeText(folder / "scene.json", kSmallScene); }

  /// Runs a line, expects this exit status and that every line on standard error is an event, the first
  /// `start` and the last `end` with this status. Returns the events.
  Events log(const std::string& line, int status = 0) {
    const Outcome outcome = runLine(folder, line);
    EXPECT_EQ(outcome.status, status) << line << "\n" << outcome.err;
    Events events;
    std::istringstream lines(outcome.err);
    for (std::string text; std::getline(lines, text);) {
      const auto event = nlohmann::json::parse(text, nullptr, false);
      EXPECT_TRUE(event.is_object()) << text;
      if (event.is_object()) events.push_back(event);
    }
    EXPECT_EQ(outcome.err.back(), '\n');
    static const std::regex time("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]{3}Z");
    for (const auto& event : events)
      EXPECT_TRUE(std::regex_match(event.at("time").get<std::string>(), time)) << event;
    EXPECT_EQ(events.front()["event"], "start");
    EXPECT_EQ(events.back()["event"], "end");
    EXPECT_EQ(events.back()["status"], status);
    EXPECT_GT(events.back()["milliseconds"], 0);
    return events;
  }
  static Events named(const Events& events, const std::string& name) {
    Events found;
    for (const auto& event : events)
      if (event["event"] == name) found.push_back(event);
    return found;
  }
  /// The names of the events, those that follow each other only once.
  static std::vector<std::string> order(const Events& events) {
    std::vector<std::string> names;
    for (const auto& event : events)
      if (names.empty() || event["event"] != names.back()) names.push_back(event["event"]);
    return names;
  }
};

TEST_F(EventLog, FramesAreToldFromBeginToEnd) {
  const Events events = log("luciole render scene.json --frames 3-4 --log json -o f.#.png");
  EXPECT_THAT(order(events),
              ElementsAre("start", "loaded", "device", "frame_begun", "progress", "stage", "frame_done",
                          "frame_begun", "progress", "stage", "frame_done", "end"));
  EXPECT_EQ(events[0]["command"], "luciole render scene.json --frames 3-4 --log json -o f.#.png");
  EXPECT_EQ("luciole " + events[0]["version"].get<std::string>() + "\n", succeed("luciole --version"));
  const auto loaded = named(events, "loaded")[0];
  EXPECT_EQ(loaded["scene"], "scene.json");
  EXPECT_EQ(loaded["lights"], 203);
  EXPECT_GT(loaded["milliseconds"], 0);
  EXPECT_FALSE(named(events, "device")[0]["name"].get<std::string>().empty());
  const Events done = named(events, "frame_done");
  ASSERT_EQ(done.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(done[i]["frame"], 3 + i);
    EXPECT_EQ(done[i]["file"], fmt::format("f.{}.png", 3 + i));
    EXPECT_EQ(done[i]["width"], 96);
    EXPECT_GT(done[i]["milliseconds"], 0);
    EXPECT_TRUE(std::filesystem::exists(folder / done[i]["file"].get<std::string>()));
  }
  EXPECT_EQ(named(events, "progress").front()["percent"], 0);
  EXPECT_EQ(named(events, "progress").back()["percent"], 100);
  EXPECT_EQ(named(events, "progress").back()["frame"], 4);
  double rasterizing = 0;
  for (const auto& stage : named(events, "stage"))
    if (stage["stage"] == "rasterize") rasterizing += stage["milliseconds"].get<double>();
  EXPECT_GT(rasterizing, 0);
}

TEST_F(EventLog, TimesRise) {
  const Events events = log("luciole render scene.json --frames 1-3 --log=json -o f.#.png");
  // Such texts are in the order of the times that they tell.
  for (std::size_t i = 1; i < events.size(); ++i) EXPECT_LE(events[i - 1]["time"], events[i]["time"]);
}

TEST_F(EventLog, EveryPictureCommandTellsItsPicture) {
  for (const char* line : {"render scene.json -o out.png", "gbuffer scene.json -o g.exr",
                           "gbuffer scene.json --shading gouraud -o gouraud.exr",
                           "shade g.exr --scene scene.json -o out.exr", "reference scene.json -o out.exr"}) {
    const Events events = log(fmt::format("luciole {} --frames 7 --log json", line));
    for (const char* name : {"loaded", "frame_begun", "frame_done"})
      EXPECT_EQ(named(events, name).size(), 1u) << line << ": " << name;
    EXPECT_EQ(named(events, "frame_done")[0]["frame"], 7) << line;
    EXPECT_GT(named(events, "stage").size(), 1u) << line;
    const bool has_device =
        !testing::Matches(HasSubstr("reference"))(line) &&
        (!testing::Matches(StartsWith("gbuffer"))(line) || testing::Matches(HasSubstr("gouraud"))(line));
    EXPECT_EQ(named(events, "device").size(), has_device ? 1u : 0u) << line;
  }
}

TEST_F(EventLog, DoesNotChangeThePicture) {
  succeed("luciole render scene.json -o a.exr && luciole render scene.json --log json -o b.exr");
  succeed("luciole compare a.exr b.exr --max-abs 0");
}

TEST_F(EventLog, FailedFramesAndWhatIsThereAlreadyAreEvents) {
  std::filesystem::create_directory(folder / "f.2.png");
  const Events first = log("luciole render scene.json --frames 1-3 --log json -o f.#.png", 2);
  const Events failed = named(first, "frame_failed");
  ASSERT_EQ(failed.size(), 1u);
  EXPECT_EQ(failed[0]["frame"], 2);
  EXPECT_EQ(failed[0]["status"], 2);
  EXPECT_THAT(failed[0]["message"], StartsWith("f.2.png: "));
  EXPECT_EQ(named(first, "frame_done").size(), 2u);
  EXPECT_EQ(named(first, "error")[0]["message"], "1 of 3 frames failed: 2");
  std::filesystem::remove(folder / "f.2.png");
  const Events second = log("luciole render scene.json --frames 1-3 --log json --resume -o f.#.png");
  EXPECT_EQ(named(second, "resumed")[0]["frames_there"], 2);
  EXPECT_EQ(named(second, "resumed")[0]["frames"], 3);
  EXPECT_EQ(named(second, "frame_done").size(), 1u);
}

TEST_F(EventLog, WarningsAndErrorsAreEventsWithTheirStatus) {
  const Events warned =
      log("luciole render scene.json --cast-shadows none --shadows pcf --log json -o out.png");
  EXPECT_THAT(named(warned, "warning")[0]["message"], HasSubstr("no light casts shadows"));
  for (const auto& [line, status, message] :
       {std::tuple{"render nowhere.json --log json -o out.png", 2, "nowhere.json"},
        {"render scene.json -o out.xyz --log json", 2, "out.xyz"},
        {"render scene.json -o out.png --smples 3 --log json", 2, "luciole render: no option --smples"},
        {"render --log json", 2, "(see luciole help)"},
        {"frobnicate --log json", 2, "no command frobnicate"},
        {"devices --log json", 2, "luciole devices: no option --log"},
        {"render scene.json --log json --quiet -o out.png", 2, "--quiet"},
        {"render scene.json --device nobody --log json -o out.png", 2, "nobody"}}) {
    const Events events = log(fmt::format("luciole {}", line), status);
    const Events errors = named(events, "error");
    ASSERT_EQ(errors.size(), 1u) << line;
    EXPECT_THAT(errors[0]["message"], HasSubstr(message)) << line;
    EXPECT_EQ(errors[0]["status"], status) << line;
  }
  const Events machine = log(
      "OCL_ICD_VENDORS=/nonexistent OCL_ICD_FILENAMES= luciole render scene.json --log json -o out.png", 3);
  EXPECT_EQ(named(machine, "error")[0]["status"], 3);
  refuse("luciole render scene.json --log yaml -o out.png", 2, "'yaml' is none of json");
}

TEST_F(EventLog, NamesMayHoldAnything) {
  // A quote, a backslash, a line's end, a control character, and bytes that are no UTF-8, taken as Latin-1.
  const std::string name = "\"\\\n\x01\xff\xc3(ä";
  succeed("cp scene.json '" + name + ".json'");
  const Events events = log("luciole render '" + name + ".json' --log json -o '" + name + ".png'");
  EXPECT_EQ(named(events, "frame_done")[0]["file"], "\"\\\n\x01\u00FF\u00C3(ä.png");
  EXPECT_TRUE(std::filesystem::exists(folder / (name + ".png")));
  const Events failed = log("luciole render '" + name + ".none' --log json -o out.png", 2);
  EXPECT_THAT(named(failed, "error")[0]["message"], StartsWith("\"\\\n\x01\u00FF\u00C3(ä.none"));
}

TEST_F(EventLog, ComparisonsTellTheirFramesAndTheWorst) {
  for (const char* name : {"a.1.exr", "a.2.exr", "b.1.exr"})
    writeImage({1, 1, {"Y"}, {1}}, folder / name, {});
  writeImage({1, 1, {"Y"}, {3}}, folder / "b.2.exr", {});
  const Events events = log("luciole compare a.#.exr b.#.exr --max-abs 0 --log json", 1);
  EXPECT_EQ(named(events, "progress")[1]["frame"], 2);
  EXPECT_THAT(named(events, "error")[0]["message"],
              StartsWith("1 of 2 frames over --max-abs 0; worst frame 2: max_abs 2 "));
  EXPECT_EQ(named(events, "error")[0]["status"], 1);
}

}  // namespace
}  // namespace luciole::test
