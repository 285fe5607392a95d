#include "tools/cli/scale_against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/dump_utf8.hpp"
#include "base/sha256.hpp"
#include "base/split.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "base/write_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/write_scene.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/scale/scale_method.hpp"

namespace luciole {
namespace {

constexpr const char* kAsked = "-";
constexpr const char* kLights = "{lights}";
constexpr const char* kTimes = ",ms=";
/// Bytes of the longest answer that is read.
constexpr int kLongestAnswer = 1 << 16;

/// A method as it was typed.
struct AgainstOption {
  std::string name, pictures;
  std::string times;  ///< a number or a .csv file; empty: none
};

[[noreturn]] void refuseAgainst(const std::string& typed, const std::string& why) {
  throw InputError(fmt::format("scale: --against {}: {}", forMessage(typed), why));
}

AgainstOption parseAgainst(const std::string& typed, std::size_t light_counts) {
  const std::size_t equals = typed.find('=');
  AgainstOption option{utf8Of(typed.substr(0, equals)), {}, {}};
  if (equals == std::string::npos || option.name.empty() || option.name == kNotThis ||
      option.name == kOwnMethod)
    refuseAgainst(typed, fmt::format("expected NAME=PICTURES, with a name other than {}", kOwnMethod));
  option.pictures = typed.substr(equals + 1);
  const std::size_t times = option.pictures.rfind(kTimes);
  if (times != std::string::npos) {
    option.times = option.pictures.substr(times + std::strlen(kTimes));
    if (option.times.empty()) refuseAgainst(typed, "expected milliseconds or a .csv file after ms=");
    option.pictures.resize(times);
  }
  if (option.pictures == kAsked) {
    if (times != std::string::npos)
      refuseAgainst(typed, "pictures that are asked for are timed; expected no ms");
  } else if (option.pictures.empty()) {
    refuseAgainst(typed, "expected the name of a picture");
  } else if (light_counts > 1 && option.pictures.find(kLights) == std::string::npos) {
    refuseAgainst(typed, fmt::format("expected {} in the name, for there are {} numbers of lights", kLights,
                                     light_counts));
  }
  return option;
}

/// A number above 0 that is the whole text; nothing where it isn't.
std::optional<double> timeIn(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !(number > 0) || !std::isfinite(number))
    return std::nullopt;
  return number;
}

/// The times in a file of lines "lights,milliseconds", the first of which may name these columns.
std::map<std::uint64_t, double> readTimes(const std::string& path) {
  std::map<std::uint64_t, double> times;
  std::size_t number = 0;
  for (std::string line : split(readFile(path), '\n')) {
    ++number;
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    if (line.empty() || (number == 1 && line == "lights,milliseconds")) continue;
    const std::size_t comma = std::min(line.find(','), line.size());
    std::uint64_t lights = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + comma, lights);
    const std::optional<double> time = comma < line.size() ? timeIn(line.substr(comma + 1)) : std::nullopt;
    if (error != std::errc() || end != line.data() + comma || !time)
      throw InputError(fmt::format("{}: line {}: expected lights,milliseconds, got \"{}\"", path, number,
                                   forMessage(line)));
    if (!times.emplace(lights, *time).second)
      throw InputError(fmt::format("{}: line {}: {} lights are there twice", path, number, lights));
  }
  return times;
}

double timeOf(const AgainstOption& option, const std::map<std::uint64_t, double>& times,
              std::uint64_t lights) {
  if (!option.times.ends_with(".csv")) {
    if (const auto time = timeIn(option.times)) return *time;
    refuseAgainst(option.name, fmt::format("ms={}: expected milliseconds above 0 or a .csv file",
                                           forMessage(option.times)));
  }
  const auto time = times.find(lights);
  if (time == times.end())
    throw InputError(fmt::format("{}: no time of {} lights, of which {} has a picture", option.times, lights,
                                 option.name));
  return time->second;
}

/// How the pictures of a method come that are files, all of which are looked at. hash: of all of them.
std::vector<std::optional<OtherPicture>> filePictures(const AgainstOption& option, Sha256& hash,
                                                      ScaleExperiment& experiment) {
  const glm::ivec2 size = experiment.tasks.front().settings.size;
  const auto takeFile = [&](const std::string& path) {
    const std::string bytes = readFile(path);
    hash.add(bytes.data(), bytes.size());
  };
  std::map<std::uint64_t, double> times;
  if (option.times.ends_with(".csv")) {
    times = readTimes(option.times);
    takeFile(option.times);
  }
  std::vector<std::optional<OtherPicture>> pictures;
  std::vector<std::string> missing;
  for (const std::uint64_t lights : experiment.description.lights) {
    std::string file = option.pictures;
    for (std::size_t at = 0; (at = file.find(kLights, at)) != std::string::npos;)
      file.replace(at, std::strlen(kLights), std::to_string(lights));
    if (!isFile(file)) {
      missing.push_back(file);
      pictures.emplace_back();
      continue;
    }
    readMethodPicture(file, size);
    takeFile(file);
    pictures.push_back(OtherPicture{file, {}});
    if (!option.times.empty()) pictures.back()->milliseconds = timeOf(option, times, lights);
  }
  if (missing.size() == pictures.size())
    refuseAgainst(option.name, fmt::format("{}: there is no such picture", missing.front()));
  for (const std::string& file : missing)
    experiment.missing.push_back(
        fmt::format("{}: {} is not there, so its point is left out", option.name, file));
  return pictures;
}

/// The answer in a line of standard input. Throws as PictureQuestions::ask().
double answeredTime(const std::string& line, std::size_t number, const std::string& who) {
  const nlohmann::json answer = nlohmann::json::parse(line, nullptr, false);
  if (answer.is_object() && answer.contains("error") && answer["error"].is_string())
    throw NoPicture(forMessage(answer["error"].get<std::string>()));
  const bool has_time =
      answer.is_object() && answer.contains("milliseconds") && answer["milliseconds"].is_number();
  const double time = has_time ? answer["milliseconds"].get<double>() : 0;
  if (!(time > 0) || !std::isfinite(time))
    throw InputError(
        fmt::format("standard input: line {}: expected {{\"milliseconds\": a number above 0}} or "
                    "{{\"error\": \"why\"}} of {}, got {}",
                    number, who, forMessage(line)));
  return time;
}

}  // namespace

void addAgainst(const std::vector<std::string>& against, ScaleExperiment& experiment) {
  if (against.empty()) return;
  ScaleDescription& description = experiment.description;
  std::vector<ScaleMethod> methods;
  std::vector<std::vector<std::optional<OtherPicture>>> of_lights;
  for (const std::string& typed : against) {
    const AgainstOption option = parseAgainst(typed, description.lights.size());
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const ScaleMethod& other) { return other.name == option.name; }))
      refuseAgainst(typed, "the name is there twice");
    const bool is_asked = option.pictures == kAsked;
    const std::string name = "against " + option.name;
    description.settings.emplace_back(name,
                                      is_asked ? "asked for" : utf8Of(typed.substr(typed.find('=') + 1)));
    if (is_asked) {
      of_lights.emplace_back(description.lights.size(), OtherPicture{});
    } else {
      // So that an experiment goes on only with the same files.
      Sha256 hash;
      of_lights.push_back(filePictures(option, hash, experiment));
      description.settings.emplace_back(name + "'s SHA-256", hash.hex());
    }
    methods.push_back({option.name, is_asked ? description.repeats : option.times.empty() ? 0 : 1});
  }
  addMethods(experiment, methods, of_lights);
}

bool asksForPictures(const ScaleExperiment& experiment) {
  return std::any_of(experiment.tasks.begin(), experiment.tasks.end(),
                     [](const ScaleTask& task) { return task.other && task.other->file.empty(); });
}

PictureQuestions::PictureQuestions(const std::string& scene_path, const std::string& gbuffer, int frame)
    : scene_path_(scene_path), gbuffer_(gbuffer), frame_(frame) {}

AskedPicture PictureQuestions::ask(const PictureRequest& request) {
  const auto inFolder = [&](const std::string& name) {
    return std::filesystem::absolute(folder_ / name).string();
  };
  const std::string scene = inFolder(fmt::format("{}.json", request.lights)),
                    output = inFolder("picture.npy");
  if (written_.insert(request.lights).second)
    writeTextFile(scene,
                  pictureScene(scene_path_, folder_ / "", request.scene, request.camera, request.size));
  std::error_code none;
  std::filesystem::remove(output, none);  // that of another question is no answer to this
  nlohmann::ordered_json question{{"method", request.method}, {"lights", request.lights},
                                  {"round", request.round},   {"scene", scene},
                                  {"frame", frame_},          {"size", {request.size.x, request.size.y}},
                                  {"output", output}};
  if (!gbuffer_.empty()) question["gbuffer"] = std::filesystem::absolute(gbuffer_).string();
  const std::string line = dumpUtf8(std::move(question)) + "\n";
  if (std::fwrite(line.data(), 1, line.size(), stdout) != line.size() || std::fflush(stdout) != 0) {
    std::clearerr(stdout);
    throw InputError(fmt::format("standard output: nobody reads the question about {} by {} lights",
                                 request.method, request.lights));
  }
  std::vector<char> answer(kLongestAnswer);
  if (!std::fgets(answer.data(), kLongestAnswer, stdin))
    throw InputError(fmt::format("standard input: ended, expected an answer about {} by {} lights, round {}",
                                 request.method, request.lights, request.round));
  return {answeredTime(answer.data(), ++answers_, request.method), output};
}

}  // namespace luciole
