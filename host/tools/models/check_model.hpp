#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "luciole/model.hpp"
#include "luciole/shader.hpp"
#include "tools/figures/statistics.hpp"

// The check of a shading model, built in or from a file: by single pairs of a surface and a light in all
// directions, through the code that lights pictures.
namespace luciole {

/// A model to be checked.
struct CheckedModel {
  std::string name;  ///< as it was typed
  Model built_in = Model::kPhong;
  std::optional<Shader> shader;  ///< instead of a built-in one
};

/// The place of a figure: the directions' angles, in degrees, and the shininess.
struct Place {
  double light = 0, eye = 0;  ///< from the normal
  double between = 0;         ///< of both around the normal; 180: the light mirrors into the eye
  double shininess = 0;
};

struct PlacedValue {
  double value = 0;
  Place at;
};

/// How far a model's floats are from double precision.
struct ModelError {
  double shininess = 0;
  PlacedValue largest = {};                ///< as a share of the larger of 1 and the exact value
  double mean = 0;                         ///< likewise
  double largest_ulps = 0, mean_ulps = 0;  ///< of exact values from 2^-10 on
  PlacedValue of_allowed = {};  ///< as a share of what float's rounding may make of such directions
};

/// The share of light from everywhere that leaves towards one direction: 1/π ∫ f dω, for colours of 1.
struct AlbedoCurve {
  double shininess = 0;
  std::vector<double> degrees = {}, diffuse = {}, specular = {};
};

/// A lobe: what reaches an eye in the plane of the light and the normal, by its angle from the normal, −90 to
/// 90 degrees; the light's is positive, its mirror direction negative.
struct Lobe {
  double light_degrees = 0, shininess = 0;
  std::vector<double> degrees = {}, value = {};
};

struct ModelCheck {
  std::string name;
  std::size_t pairs = 0;
  std::vector<int> lanes;                           ///< the widths that were compared
  std::optional<Place> other_bits;                  ///< where widths differ
  std::size_t nan = 0, infinite = 0, negative = 0;  ///< pairs with such a number
  std::optional<Place> first_faulty;
  std::vector<ModelError> errors;   ///< by shininess
  PlacedValue reciprocity;          ///< the largest |f(l,v) − f(v,l)| as a share of the larger
  PlacedValue diffuse_reciprocity;  ///< of the diffuse part alone
  std::vector<AlbedoCurve> albedo;
  std::vector<Lobe> lobes;
  Repeated nanoseconds, phong_nanoseconds, roof_nanoseconds;  ///< a pair
  std::vector<std::string> loose;                             ///< see ShaderFacts
  std::optional<std::string>
      oclgrind;                     ///< Oclgrind's first report; empty: none. No value: it isn't installed
  std::vector<std::string> broken;  ///< promises that don't hold, a line each
};

/// Checks a model on PoCL's device, or on the one of `selector`. Takes some seconds. program: luciole itself,
/// to run probeFew() under Oclgrind where that is installed; empty: not. Throws as openDevice() and
/// makeKernel().
ModelCheck checkModel(const CheckedModel& model, const std::string& selector,
                      const std::string& program = {});

/// Computes a few pairs on the first device, for Oclgrind to look at. Throws likewise.
void probeFew(const CheckedModel& model);

/// The check as lines for people, and as JSON.
std::string modelCheckText(const ModelCheck& check);
std::string modelCheckJson(const ModelCheck& check);

/// The lobes and the albedo as an SVG picture.
std::string modelPlot(const ModelCheck& check);

}  // namespace luciole
