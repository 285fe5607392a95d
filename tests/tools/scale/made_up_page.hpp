#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace luciole::test {

/// PNGs of 4 × 2 pixels, each of one colour: red, green, blue.
inline const std::vector<std::string> kTinyPictures{
    "data:image/"
    "png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAACCAIAAADwyuo0AAAAEElEQVR42mO4IycHRwzIHAB3ygjBBv3NOQAAAABJRU5ErkJggg==",
    "data:image/"
    "png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAACCAIAAADwyuo0AAAAEElEQVR42mOQOyEHRwzIHABpugghSRyuZAAAAABJRU5ErkJggg==",
    "data:image/"
    "png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAACCAIAAADwyuo0AAAAEElEQVR42mOQk7sDRwzIHABr6gjBYwphawAAAABJRU5ErkJggg=="};

/// A point whose figures follow from its lights and its variant's number: time 2 + (variant + 1) lights / 100
/// milliseconds. The first variant has no error.
inline nlohmann::json madeUpPoint(int lights, int variant, const nlohmann::json& values) {
  const double shade = (variant + 1) * lights / 100.0, error = variant * 1e-6;
  return {{"lights", lights},
          {"values", values},
          {"milliseconds", {{"median", 2 + shade}, {"low", 1.9 + shade}, {"high", 2.5 + shade}}},
          {"stages",
           {{{"name", "rasterize"}, {"median", 2}, {"low", 1.8}, {"high", 2.2}},
            {{"name", "shade"}, {"median", shade}, {"low", shade * 0.9}, {"high", shade * 1.1}}}},
          {"pairs_evaluated", 2000 * lights},
          {"pairs_in_range", 1000 * lights},
          {"pixels_lit", 230400},
          {"list_entries", variant == 0 ? 0 : 3 * lights},
          {"device_bytes", 40000000 + 64 * lights},
          {"peak_bytes", 180000000 + 200 * lights},
          {"error",
           {{"mean_abs", error},
            {"max_abs", 50 * error},
            {"mean_signed", -error / 2},
            {"rmse", 2 * error},
            {"psnr", variant == 0 ? nlohmann::json() : nlohmann::json(114)},
            {"relmse", 3 * error},
            {"smape", 4 * error},
            {"pixels", 1024}}},
          {"front", true},
          {"picture", 0},
          {"error_map", 1},
          {"tile_map", variant == 0 ? nlohmann::json() : nlohmann::json(2)}};
}

/// An experiment without points.
inline nlohmann::json madeUpPageOfNoPoints() {
  return {{"title", "a scene.obj, 1 to 10,000 lights"},
          {"scene", "a scene.obj"},
          {"command", "luciole scale 'a scene.obj' --lights 1,100,10000 -o results"},
          {"version", "0.1.0"},
          {"machine", {{"processor", "A processor"}, {"threads", 2}, {"memory_bytes", 8589934592}}},
          {"settings", {{"size", {640, 360}}, {"field", "box"}, {"seed", 1}}},
          {"axes", nlohmann::json::array()},
          {"points", nlohmann::json::array()},
          {"growth", nlohmann::json::array()},
          {"pictures", kTinyPictures},
          {"incomplete", 0}};
}

/// Three variants at 1, 100 and 10000 lights.
inline nlohmann::json madeUpVariants() {
  nlohmann::json data = madeUpPageOfNoPoints();
  const std::vector<std::string> names{"none", "tiles", "a \"tree\", in full"};
  data["axes"] = {{{"name", "culling"}, {"values", names}}};
  for (int variant = 0; variant < 3; ++variant) {
    const nlohmann::json values{{"culling", names[variant]}};
    for (int lights : {1, 100, 10000}) data["points"].push_back(madeUpPoint(lights, variant, values));
    data["growth"].push_back({{"values", values},
                              {"stage", "total"},
                              {"a", 2},
                              {"b", 0.01 * (variant + 1)},
                              {"c", 1},
                              {"c_low", 0.95},
                              {"c_high", 1.05},
                              {"reason", nullptr}});
    data["growth"].push_back({{"values", values},
                              {"stage", "rasterize"},
                              {"a", nullptr},
                              {"b", nullptr},
                              {"c", nullptr},
                              {"c_low", nullptr},
                              {"c_high", nullptr},
                              {"reason", "no growth beyond noise"}});
  }
  return data;
}

/// Six variants at one number of lights, from fast and wrong to slow and right: times and errors that the
/// front joins by a line that falls less and less.
inline nlohmann::json madeUpFront() {
  nlohmann::json data = madeUpPageOfNoPoints();
  data["axes"] = {{{"name", "way"}, {"values", {0, 1, 2, 3, 4, 5}}}};
  const double errors[] = {1e-3, 3e-5, 1e-5, 7e-6, 6e-6, 5.9e-6};
  for (int way = 0; way < 6; ++way) {
    nlohmann::json point = madeUpPoint(1000, way, {{"way", way}});
    point["error"]["mean_abs"] = errors[way];
    data["points"].push_back(point);
  }
  return data;
}

/// Three light errors at 100 and 10000 lights, the last of them none; 100 lights are all exact. A bound is
/// half of what is promised, and an error a tenth of that.
inline nlohmann::json madeUpPageOfLightErrors() {
  nlohmann::json data = madeUpPageOfNoPoints();
  const std::vector<std::string> names{"0", "1/16", "1/256"};
  const double errors[] = {0, 1.0 / 16, 1.0 / 256};
  data["axes"] = {{{"name", "light-error"}, {"values", names}}};
  for (int lights : {100, 10000})
    for (int i = 0; i < 3; ++i) {
      nlohmann::json point = madeUpPoint(lights, 2 * i, {{"light-error", names[i]}});
      const bool is_bounded = lights > 100 && i > 0;
      point["picture"] = i;
      point["bound_map"] = is_bounded ? nlohmann::json(3 - i) : nlohmann::json();
      if (is_bounded)
        point["bounds"] = {{"max_bound", errors[i] / 2},
                           {"mean_bound", errors[i] / 4},
                           {"max_error", errors[i] / 20},
                           {"mean_error", errors[i] / 80},
                           {"max_used", 0.1},
                           {"mean_used", 0.05},
                           {"bounded_values", 3072},
                           {"violations", 0}};
      data["points"].push_back(point);
    }
  return data;
}

/// Two ways of Luciole's and two other methods at 100 and 10000 lights. Of the first the time is known, of
/// the second its error alone.
inline nlohmann::json madeUpMethods() {
  nlohmann::json data = madeUpPageOfNoPoints();
  data["axes"] = {{{"name", "culling"}, {"values", {"none", "tiles", "-"}}},
                  {{"name", "method"}, {"values", {"luciole", "theirs", "untimed"}}}};
  data["first"] = {{"culling", "none"}, {"method", "luciole"}};
  for (int lights : {100, 10000})
    for (int i = 0; i < 4; ++i) {
      const char* const culling[] = {"none", "tiles", "-", "-"};
      const char* const method[] = {"luciole", "luciole", "theirs", "untimed"};
      nlohmann::json point = madeUpPoint(lights, i + 1, {{"culling", culling[i]}, {"method", method[i]}});
      point["front"] = i == 0;
      if (i > 0) point["times_first"] = {{"median", i + 0.5}, {"low", i + 0.25}, {"high", i + 0.75}};
      if (i > 1) {
        point["stages"] = nlohmann::json::array();
        for (const char* name : {"pairs_evaluated", "pairs_in_range", "pixels_lit", "list_entries",
                                 "device_bytes", "peak_bytes"})
          point[name] = nullptr;
        point["tile_map"] = nullptr;
      }
      if (i == 3) {
        for (const char* name : {"median", "low", "high"}) point["milliseconds"][name] = nullptr;
        point["times_first"] = nullptr;
        point["front"] = false;
      }
      data["points"].push_back(point);
    }
  return data;
}

/// 24 variants of three axes at seven numbers of lights.
inline nlohmann::json madeUpHundreds() {
  nlohmann::json data = madeUpPageOfNoPoints();
  data["axes"] = {{{"name", "culling"}, {"values", {"none", "tiles", "tree"}}},
                  {{"name", "tile"}, {"values", {4, 8, 16, 32}}},
                  {{"name", "shadows"}, {"values", {"off", "hard"}}}};
  int variant = 0;
  for (const auto& culling : data["axes"][0]["values"])
    for (const auto& tile : data["axes"][1]["values"])
      for (const auto& shadows : data["axes"][2]["values"]) {
        for (int lights = 1; lights <= 1000000; lights *= 10)
          data["points"].push_back(
              madeUpPoint(lights, variant, {{"culling", culling}, {"tile", tile}, {"shadows", shadows}}));
        ++variant;
      }
  return data;
}

}  // namespace luciole::test
