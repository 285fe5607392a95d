#include "cl/build_program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/embedded_files.hpp"
#include "cl/kernel_source.hpp"
#include "cl/launch.hpp"
#include "cl/program_cache.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kOptions = "-cl-std=CL1.2 -cl-denorms-are-zero -cl-kernel-arg-info";

std::string optionsOf(const OpenedDevice& device, const Program& program) {
  return program.program.getBuildInfo<CL_PROGRAM_BUILD_OPTIONS>(device.device);
}

/// PoCL's compiler, which reads builtins.clh in place of its own header.
struct PoclCompiler : testing::Test {
  OpenedDevice device;
  void SetUp() override {
    openDevice("", device);
    if (device.description.platform != "Portable Computing Language") GTEST_SKIP() << "not PoCL";
  }
};

TEST_F(PoclCompiler, NeedsNoOtherFunctionsForTheKernels) {
  for (const EmbeddedFile& file : embeddedKernels()) {
    // The truth of models from files may call what it likes.
    if (!file.name.ends_with(".cl") || file.name == "model_truth.cl") continue;
    for (const int lanes : {1, 16}) {
      const std::string source = kernelSource(file.name);
      const Program program = buildProgram(device, source, fmt::format("{} -DLANES={}", kOptions, lanes));
      if (optionsOf(device, program).find("_OPENCL_H_") != std::string::npos) continue;
      // What it lacks is in the log of a build without the header.
      cl::Program without(device.context, kernelSource("builtins.clh") + source);
      std::string log;
      try {
        without.build({device.device}, fmt::format("{} -DLANES={} -D_OPENCL_H_", kOptions, lanes).c_str());
      } catch (const cl::BuildError& error) {
        log = error.getBuildLog().front().second.substr(0, 500);
      }
      ADD_FAILURE() << file.name << " calls a function that kernels/builtins.clh doesn't declare: " << log;
    }
  }
}

/// What functions give for arguments of every kind, in bits.
constexpr const char* kCalls = R"(
#ifdef cl_khr_fp64
#define WIDE(x) ((float)sqrt((double)(x)))
#else
#define WIDE(x) 0.0f
#endif
__kernel void probe(__global const float *in, __global uint *out) {
  float x = in[0];
  int i = convert_int(x);
  uint u = convert_uint(x);
  out[get_global_id(0)] = as_uint(sqrt(x));
  out[1] = as_uint(fma(x, 3.1f, 0.7f));
  out[2] = as_uint(WIDE(x));
  out[3] = clz(i) + 100 * clz((uchar)i) + 10000 * clz((ulong)i) + 1000000 * popcount(u);
  out[4] = max((char)(i - 400), (char)5) + 1000 * max((uchar)(i - 400), (uchar)5);
  out[5] = min(-i, 3) + 1000 * (int)min(0u - u, 3u);
  out[6] = max((short)(i - 400), (short)-7);
  out[7] = min((long4)(i), (long)55).w;
  out[8] = max((int8)(i), 1000).s7 + min((uint2)(u), (uint2)(7u, 8u)).y;
  out[9] = as_uint(convert_float16((int16)(i)).sf + convert_float4((uint4)(u)).x);
  out[10] = convert_int4((float4)(-x)).y;
  atomic_min(out + 11, u);
  atomic_add(out + 11, u);
  UNDECLARED
}
)";

TEST_F(PoclCompiler, CallsMeanWhatTheyMeanWithItsWholeHeader) {
  std::vector<std::vector<std::uint32_t>> results;
  const std::vector<float> values{300.7f};
  for (const char* more : {"", "out[12] = mul24(u, 3u);"}) {
    // What builtins.clh doesn't declare has it compiled with the header.
    const std::string source = fmt::format("#define UNDECLARED {}\n{}", more, kCalls);
    Kernel kernel = makeKernelFromSource(device, source, "probe", "");
    const Buffer<const float> in = borrowed(device, values);
    const Buffer<uint> out = makeBuffer<uint>(device, 13);
    fill(device, out, 1000u);
    launch(device, kernel, {{"in", in}, {"out", out}}, {.items = 1});
    results.emplace_back(12);
    download(device, out, results.back());
  }
  std::vector<std::string> options;
  for (const auto& [key, program] : device.programs) options.push_back(optionsOf(device, program));
  EXPECT_THAT(options, testing::UnorderedElementsAre(HasSubstr("_OPENCL_H_"), Not(HasSubstr("_OPENCL_H_"))));
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0][11], 600u);  // the lesser of 1000 and 300, and 300 more
}

/// Programs that are kept in a folder of the test's own, whatever the platform does by itself.
struct KeptPrograms : testing::Test {
  const TemporaryFolder folder;
  const std::string cache = folder / "programs";
  const std::string source =
      "__kernel void probe(__global float *out, float value) { *out = value + PLUS; }\n"
      "__kernel void other(__global const int *in) {}\n";

  /// What the kernel gives for 1, on a device opened anew, as in another run. restored: whether its program
  /// came from the folder.
  float run(bool& restored, const std::string& defines = "-DPLUS=2") const {
    OpenedDevice device;
    openDevice("", device);
    device.program_cache = cache;
    Kernel kernel = makeKernelFromSource(device, source, "probe", defines);
    restored = !device.programs.begin()->second.arguments.empty();
    const Buffer<float> out = makeBuffer<float>(device, 1);
    launch(device, kernel, {{"value", 1.0f}, {"out", out}}, {.items = 1});
    std::vector<float> result(1);
    download(device, out, result);
    return result.front();
  }
  void expectCompiled(float result, const std::string& defines = "-DPLUS=2") const {
    bool restored = true;
    EXPECT_EQ(run(restored, defines), result);
    EXPECT_FALSE(restored);
  }
  void expectRestored(float result, const std::string& defines = "-DPLUS=2") const {
    bool restored = false;
    EXPECT_EQ(run(restored, defines), result);
    EXPECT_TRUE(restored);
  }
  std::vector<std::string> kept() const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(cache)) files.push_back(entry.path());
    return files;
  }
};

TEST_F(KeptPrograms, AreNotCompiledAgain) {
  expectCompiled(3);
  EXPECT_EQ(kept().size(), 1u);
  expectRestored(3);
  expectRestored(3);
}

TEST_F(KeptPrograms, ThoseOfOtherOptionsAreOthers) {
  expectCompiled(3);
  expectCompiled(6, "-DPLUS=5");
  expectRestored(3);
  expectRestored(6, "-DPLUS=5");
}

TEST_F(KeptPrograms, AreKeptUnderAllThatTheirBitsDependOn) {
  expectCompiled(3);
  const nlohmann::json file = nlohmann::json::from_cbor(readText(kept().front()).substr(16));
  OpenedDevice device;
  openDevice("", device);
  const cl::Platform platform(device.device.getInfo<CL_DEVICE_PLATFORM>());
  for (const std::string& part :
       {std::string(LUCIOLE_VERSION), platform.getInfo<CL_PLATFORM_NAME>(),
        platform.getInfo<CL_PLATFORM_VERSION>(), device.device.getInfo<CL_DEVICE_NAME>(),
        device.device.getInfo<CL_DEVICE_VERSION>(), device.device.getInfo<CL_DRIVER_VERSION>(),
        fmt::format("-DLANES={}", device.description.lanes), std::string("-DPLUS=2"), source})
    EXPECT_THAT(file["description"].get<std::string>(), HasSubstr(part));
  setenv("CL_CONFIG_TEST", "1", 1);
  expectCompiled(3);
  unsetenv("CL_CONFIG_TEST");
  expectRestored(3);
}

TEST_F(KeptPrograms, ADamagedFileIsCompiledAgainAndReplaced) {
  expectCompiled(3);
  const std::string file = kept().front(), whole = readText(file);
  for (const std::string& damaged : {std::string(), whole.substr(0, whole.size() / 2), whole + "x"}) {
    writeText(file, damaged);
    expectCompiled(3);
    expectRestored(3);
  }
}

// After an update that kept its version's name, for example.
TEST_F(KeptPrograms, ABinaryThatTheDriverRefusesIsCompiledAgainAndReplaced) {
  expectCompiled(3);
  const std::string file = kept().front();
  const std::string description =
      nlohmann::json::from_cbor(readText(file).substr(16))["description"].get<std::string>();
  KeptProgram program = findProgram(cache, description).value();
  program.binary.assign(1000, 'x');
  keepProgram(cache, description, program);
  expectCompiled(3);
  expectRestored(3);
}

TEST_F(KeptPrograms, OneWithOtherArgumentsIsCompiledAgain) {
  expectCompiled(3);
  const std::string file = kept().front();
  const std::string description =
      nlohmann::json::from_cbor(readText(file).substr(16))["description"].get<std::string>();
  KeptProgram program = findProgram(cache, description).value();
  program.arguments["probe"].pop_back();
  keepProgram(cache, description, program);
  expectCompiled(3);
}

TEST_F(KeptPrograms, WithoutAPlaceForThemNothingElseIsMissing) {
  writeText(cache, "a file");
  expectCompiled(3);
  expectCompiled(3);
  EXPECT_EQ(readText(cache), "a file");
}

TEST(ProgramCacheOf, PlatformsThatKeepProgramsThemselvesHaveNone) {
  EXPECT_EQ(programCacheOf("Portable Computing Language"), "");
  EXPECT_EQ(programCacheOf("NVIDIA CUDA"), "");
  EXPECT_EQ(programCacheOf("Intel(R) OpenCL"), userProgramCache());
}

}  // namespace
}  // namespace luciole::test
