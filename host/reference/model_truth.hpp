#pragma once

#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "luciole/scene.hpp"
#include "reference/models.hpp"

namespace luciole {

/// A surface and a light, for a model from a file. View space, where the model is written for it.
struct ReflectionQuery {
  glm::dvec3 normal{0.0}, to_light{0.0}, to_eye{0.0};  ///< unit
  glm::dvec3 tangent{0.0};                             ///< unit, across the normal
  glm::dvec3 diffuse{0.0}, specular{0.0};              ///< the material's
  double shininess = 0;
};

/// The factors that a model's function gives: see Reflection in kernels/shade/surface.clh.
struct ReflectionFactors {
  double diffuse = 0, specular = 0, grazing = 0;
};

/// What models[index] reflects: its text compiled in double, with numbers as they are written and exact
/// helpers in the place of those of kernels/math.clh. What is NaN, infinite or negative stays so. Any thread
/// may call it; calls take turns, and each takes some 50 µs beside its queries. Throws InputError for a text
/// that doesn't compile, and MachineError where no OpenCL device computes in double.
std::vector<ReflectionFactors> trueReflections(std::span<const Shader> models, std::size_t index,
                                               std::span<const ReflectionQuery> queries);

/// The factors with a specular colour. What is no share of light counts as 0, as in pictures.
Reflected reflectedBy(const ReflectionFactors& factors, const glm::dvec3& specular);

/// What models from files reflect of the lights that points face. The same lighting is computed twice: first
/// it asks for all of them, and gets nothing, then it takes the answers in the same order.
class UserReflections {
 public:
  Reflected next(Model model, const ReflectionQuery& query);

  /// Answers all that was asked. Throws as trueReflections().
  void answer(std::span<const Shader> models);

 private:
  std::vector<std::pair<std::size_t, ReflectionQuery>> asked_;  ///< with the model's index
  std::vector<Reflected> answers_;
  std::size_t next_ = 0;
  bool is_answered_ = false;
};

/// Lights something by compute(reflections, is_asking) and returns what it returns. Without models from files
/// it is called once.
template <class Compute>
auto withUserReflections(const Scene& scene, const Compute& compute) {
  UserReflections reflections;
  if (!scene.user_models.empty()) {
    compute(reflections, true);
    reflections.answer(scene.user_models);
  }
  return compute(reflections, false);
}

}  // namespace luciole
