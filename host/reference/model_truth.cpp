#include "reference/model_truth.hpp"

#include <algorithm>
#include <cctype>
#include <mutex>
#include <string>
#include <string_view>

#include "cl/device.hpp"
#include "cl/kernel_source.hpp"
#include "cl/launch.hpp"
#include "luciole/error.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

/// A program's text with its float numbers as doubles: 0.45f is 0.45 itself then, not the float next to it.
std::string withoutSuffixes(std::string_view text) {
  std::string doubles;
  const auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  while (!text.empty()) {
    std::size_t length = 1;
    if (is_part(text[0])) {
      // A sign inside of a number follows its exponent's letter.
      const auto goes_on = [&](std::size_t at) {
        const bool is_sign = text[at] == '+' || text[at] == '-';
        const std::string_view letters = text.starts_with("0x") ? "pP" : "eEpP";
        return is_part(text[at]) ||
               (is_sign && std::isdigit(text[0]) && letters.find(text[at - 1]) != letters.npos);
      };
      while (length < text.size() && goes_on(length)) ++length;
      const std::string_view word = text.substr(0, length);
      const bool is_number = std::isdigit(word[0]) || (word[0] == '.' && length > 1);
      const bool is_whole_hex = word.starts_with("0x") && word.find_first_of("pP") == word.npos;
      const bool has_suffix = is_number && !is_whole_hex && (word.back() == 'f' || word.back() == 'F');
      doubles += word.substr(0, length - (has_suffix ? 1 : 0));
    } else {
      doubles += text[0];
    }
    text.remove_prefix(length);
  }
  return doubles;
}

/// The device that computes the truth: PoCL's first where there is one.
struct TruthDevice {
  std::mutex turn;
  OpenedDevice device;
  bool is_open = false;
};

/// Never destroyed: OpenCL's platforms may be gone before this process's last objects are.
TruthDevice& truthDevice() {
  static auto* const only = new TruthDevice;
  return *only;
}

void open(TruthDevice& truth) {
  if (truth.is_open) return;
  openDevice("", truth.device);
  truth.device.owns_stderr = true;
  if (truth.device.device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() == 0)
    throw MachineError(truth.device.description.name + ": computes no doubles, by which models are judged");
  truth.is_open = true;
}

}  // namespace

std::vector<ReflectionFactors> trueReflections(std::span<const Shader> models, std::size_t index,
                                               std::span<const ReflectionQuery> queries) {
  const std::size_t n = queries.size();
  if (n == 0) return {};
  std::vector<double> surfaces(19 * n), reflections(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const ReflectionQuery& query = queries[i];
    std::size_t plane = 0;
    for (const glm::dvec3* v :
         {&query.normal, &query.to_light, &query.to_eye, &query.tangent, &query.diffuse, &query.specular})
      for (int c = 0; c < 3; ++c) surfaces[plane++ * n + i] = (*v)[c];
    surfaces[plane * n + i] = query.shininess;
  }
  TruthDevice& truth = truthDevice();
  {
    const std::lock_guard lock(truth.turn);
    open(truth);
    const std::string user_text = shaderProgram(models, ShaderKind::kModel);
    Kernel kernel =
        makeKernelFromSource(truth.device, withoutSuffixes(kernelSource("model_truth.cl", user_text)),
                             "model_truth", "", user_text);
    const Buffer<const double> in = borrowed(truth.device, surfaces);
    const Buffer<double> out = borrowedForOutput(truth.device, reflections);
    launch(truth.device, kernel,
           {{"count", uint(n)}, {"model", uint(index)}, {"surfaces", in}, {"reflections", out}},
           {.items = n});
    download(truth.device, out, reflections);
  }
  std::vector<ReflectionFactors> factors(n);
  for (std::size_t i = 0; i < n; ++i)
    factors[i] = {reflections[i], reflections[i + n], reflections[i + 2 * n]};
  return factors;
}

Reflected reflectedBy(const ReflectionFactors& factors, const glm::dvec3& specular) {
  const auto share = [](double given) { return given >= 0 && given <= 0x1p60 ? given : 0.0; };
  // F90 of a specular colour: see grazing_color() in kernels/shade/cook_torrance.clh.
  const glm::dvec3 grazing = glm::min(50.0 * specular, 1.0);
  return {share(factors.diffuse), share(factors.specular) * specular + share(factors.grazing) * grazing};
}

Reflected UserReflections::next(Model model, const ReflectionQuery& query) {
  if (is_answered_) return answers_[next_++];
  asked_.emplace_back(std::size_t(model) - kNumberOfModels, query);
  return {};
}

void UserReflections::answer(std::span<const Shader> models) {
  answers_.resize(asked_.size());
  for (std::size_t model = 0; model < models.size(); ++model) {
    std::vector<ReflectionQuery> queries;
    for (const auto& [of, query] : asked_)
      if (of == model) queries.push_back(query);
    const std::vector<ReflectionFactors> factors = trueReflections(models, model, queries);
    for (std::size_t i = 0, taken = 0; i < asked_.size(); ++i)
      if (asked_[i].first == model) answers_[i] = reflectedBy(factors[taken++], asked_[i].second.specular);
  }
  is_answered_ = true;
}

}  // namespace luciole
