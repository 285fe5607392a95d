// What each function of kernels/math.clh costs at full lane width, and how wrong it is over its whole range:
// the table that the polynomials' degrees are chosen from. Run it alone on a quiet machine:
//   build/tests/math_benchmark --benchmark_repetitions=9 --benchmark_enable_random_interleaving
//   --benchmark_report_aggregates_only
#include <benchmark/benchmark.h>

#include "kernels/math_functions.hpp"
#include "luciole/gbuffer.hpp"

namespace luciole::test {
namespace {

constexpr std::size_t kBlock = 2048;  // values: three columns of them fit a first-level cache of 32 KiB
constexpr std::size_t kItems = 2048;

OpenedDevice& device() {
  static OpenedDevice opened;
  static const bool once = (openDevice("", opened), true);
  (void)once;
  return opened;
}

/// Times `kernel` of math_benchmark.cl on values picked evenly from those of the function's range.
void timeKernel(benchmark::State& state, const char* kernel_name, const std::vector<Column>& in,
                const std::string& defines) {
  Plane block;  // aligned to whole rows
  for (const Column& column : in)
    for (std::size_t i = 0; i < kBlock; ++i) block.push_back(column[i * column.size() / kBlock]);
  const Buffer<const float> input = borrowed(device(), block);
  const Buffer<float> sums = makeBuffer<float>(device(), kItems * std::size_t(device().description.lanes));
  Kernel kernel = makeKernelFromSource(device(), probeSource("math_benchmark.cl"), kernel_name, defines);
  const auto run = [&] {
    launch(device(), kernel, {{"in", input}, {"out", sums}, {"stride", uint(kBlock)}}, {.items = kItems});
    finish(device());
  };
  run();  // compiles
  for ([[maybe_unused]] auto _ : state) run();
  using benchmark::Counter;
  state.counters["seconds_a_value"] =
      Counter(kBlock * kItems, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void timeAndMeasure(benchmark::State& state, const char* kernel, const MathFunction& function,
                    const std::string& defines) {
  timeKernel(state, kernel, function.in, defines);
  const MathErrors errors = measureErrors(device(), function, defines);
  state.counters["max_ulp"] = errors.max_ulp;
  state.counters["mean_ulp"] = errors.mean_ulp;
  state.counters["max_relative"] = errors.max_relative;
  state.counters["max_absolute"] = errors.max_absolute;
}

void add(const std::string& name, const char* kernel, const MathFunction& function,
         const std::string& defines) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    timeAndMeasure(state, kernel, function, defines);
  })->UseRealTime();
}

void addAll() {
  benchmark::RegisterBenchmark("load", [](benchmark::State& state) {
    timeKernel(state, "time_load", rsqrtFunction().in, "");
  })->UseRealTime();
  add("rsqrt", "time_rsqrt", rsqrtFunction(), "");
  add("normalize", "time_normalize", normalizeFunction(), "");
  for (int exp2 = 2; exp2 <= 7; ++exp2)
    add(fmt::format("exp2_product/{}", exp2), "time_exp2_product", exp2ProductFunction(),
        degreeDefines(7, exp2));
  for (int exp2 = 2; exp2 <= 7; ++exp2)
    add(fmt::format("exp/{}", exp2), "time_exp", expFunction(), degreeDefines(7, exp2));
  for (int log2 = 3; log2 <= 9; ++log2)
    add(fmt::format("log2_one_plus/{}", log2), "time_log2_one_plus", log2OnePlusFunction(),
        degreeDefines(log2, 6));
  constexpr std::pair<int, int> kLadder[] = {{3, 2}, {4, 3}, {5, 4}, {6, 5}, {7, 5}, {7, 6}, {8, 6}, {9, 7}};
  for (const auto& [log2, exp2] : kLadder)
    add(fmt::format("pow_one_plus/{}/{}", log2, exp2), "time_pow_one_plus", powOnePlusFunction(),
        degreeDefines(log2, exp2));
}

}  // namespace
}  // namespace luciole::test

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  luciole::test::addAll();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
