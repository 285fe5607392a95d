#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdio.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/embedded_files.hpp"
#include "cl/kernel_source.hpp"
#include "kernels/probe.hpp"
#include "shade/features.hpp"
#include "shared_files.hpp"

// The kernels through a compiler that, unlike an OpenCL runtime's, warns.
namespace luciole::test {
namespace {

std::string findClang() {
  std::vector<std::string> names{"clang"};
  for (int version = 25; version >= 13; --version) names.push_back("clang-" + std::to_string(version));
  for (const std::string& name : names)
    if (programIsThere(name)) return name;
  return "clang";
}

std::string quoted(const std::filesystem::path& path) { return fmt::format("'{}'", path.string()); }

std::string filesIn(const char* folder, const std::vector<std::string>& extensions) {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(LUCIOLE_SOURCE_DIR) / folder))
    // Examples are parts of programs: tests/shaders/ compiles them.
    if (std::count(extensions.begin(), extensions.end(), entry.path().extension()) != 0 &&
        entry.path().parent_path().filename() != "examples")
      files.push_back(quoted(entry.path()));
  std::sort(files.begin(), files.end());
  std::string joined;
  for (const std::string& file : files) joined += " " + file;
  return joined;
}

struct Compiled {
  bool succeeded = false;
  std::string output;
};

/// What clang says of OpenCL C, with these options and files.
Compiled compile(const std::string& clang, const std::string& options) {
  const std::string command = clang + " -x cl -cl-std=CL1.2 -I " +
                              quoted(std::filesystem::path(LUCIOLE_SOURCE_DIR) / "kernels") + " " + options +
                              " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {};
  Compiled compiled;
  char buffer[4096];
  for (std::size_t got; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    compiled.output.append(buffer, got);
  const int status = pclose(pipe);
  compiled.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return compiled;
}

/// Compiles each file alone, without writing anything. A header's functions are unused there.
void expectClean(const std::string& clang, const std::string& options) {
  const Compiled compiled = compile(clang,
                                    "-Xclang -finclude-default-header -Xclang -fdeclare-opencl-builtins "
                                    "-fsyntax-only -Wall -Wextra -Wshadow "
                                    "-Werror -Wno-unused-parameter -Wno-unused-function " +
                                        options);
  EXPECT_TRUE(compiled.succeeded) << options << "\n" << compiled.output;
}

TEST(KernelLint, EachFileAloneWithoutWarningsAtEveryWidth) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  // At other widths headers are seen in the programs.
  expectClean(clang, "-DLANES=8" + filesIn("kernels", {".clh", ".h"}));
  const std::string programs =
      filesIn("kernels", {".cl"}) + filesIn("tests/kernels", {".cl"}) + filesIn("tests/cl", {".cl"});
  for (const int lanes : kAllLanes) expectClean(clang, "-DLANES=" + std::to_string(lanes) + programs);
}

bool hasWord(std::string_view text, std::string_view word) {
  const auto is_part = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(text[at]) != 0 || text[at] == '_');
  };
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1))
    if (!is_part(at - 1) && !is_part(at + word.size())) return true;
  return false;
}

/// A feature's macro, and those that features.clh makes of it.
std::vector<std::string> wordsOf(Feature feature) {
  std::vector<std::string> words{isModel(feature) ? "MODELS" : kFeatureTable[std::size_t(feature)].define};
  std::istringstream lines{std::string(embeddedText(embeddedKernels(), "features.clh"))};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream parts(line);
    std::string define, name, value;
    if (!(parts >> define >> name) || define != "#define" || !std::getline(parts, value)) continue;
    const auto is_in = [&](const std::string& word) { return hasWord(value, word); };
    if (std::any_of(words.begin(), words.end(), is_in)) words.push_back(name.substr(0, name.find('(')));
  }
  return words;
}

/// The text of each program but features.clh, by its name.
std::map<std::string, std::string> textsWithoutFeatures() {
  const std::string_view features = embeddedText(embeddedKernels(), "features.clh");
  std::map<std::string, std::string> texts;
  for (const EmbeddedFile& file : embeddedKernels()) {
    if (!file.name.ends_with(".cl")) continue;
    std::string& text = texts[std::string(file.name)] = kernelSource(file.name);
    if (const std::size_t at = text.find(features); at != text.npos) text.erase(at, features.size());
  }
  return texts;
}

TEST(KernelLint, EachFeatureAloneAndNoneWithoutWarnings) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  expectClean(clang, "-DLANES=8 " + featureDefines(FeatureSet{}) + filesIn("kernels", {".cl"}));
  const std::map<std::string, std::string> texts = textsWithoutFeatures();
  for (std::size_t i = 0; i < kFeatureCount; ++i) {
    FeatureSet features;
    features.set(static_cast<Feature>(i));
    // The other programs are those of no feature.
    std::string files;
    for (const auto& [name, text] : texts) {
      const auto is_used = [&text = text](const std::string& word) { return hasWord(text, word); };
      const std::vector<std::string> words = wordsOf(static_cast<Feature>(i));
      if (std::any_of(words.begin(), words.end(), is_used))
        files += " " + quoted(std::filesystem::path(LUCIOLE_SOURCE_DIR) / "kernels" / name);
    }
    if (!files.empty()) expectClean(clang, "-DLANES=8 " + featureDefines(features) + files);
  }
}

// Arithmetic. Only what OpenCL and IEEE 754 fix to the bit may be computed; everything else is a vendor's
// choice. It is looked for in what the compiler makes of the kernels before it optimizes, where each function
// still stands by itself.

/// Functions of others that may be called, by their mangled names: work-items and bits; integers; conversions
/// between float and int; what IEEE 754 rounds.
const std::regex kFixedFunctions(
    "_Z13get_global_idj|_Z15get_global_sizej|_Z(3clz|8popcount)[jm]|_Z3(min|max)(ii|jj|mm)|_Z10atomic_(min|"
    "add).*jj|_Z10atomic_inc.*j"
    "|_Z\\d+convert_(float\\d*(i|j|Dv\\d+_[ij])|int\\d*(f|Dv\\d+_f))|_Z3fma(fff|Dv\\d+_fS_S_)"
    "|llvm\\.(lifetime\\.|memcpy\\.|memset\\.|prefetch\\.|vector\\.reduce\\.(or|smin|smax)\\.|ctlz\\.|"
    "ctpop\\.).*"
    "|llvm\\.x86\\.(avx512\\.mask\\.(gather\\.dpq|compress)\\.|avx\\.movmsk\\.ps\\.|sse\\.movmsk\\.ps).*");

/// What only these functions may do: fma_lanes() says where a product and a sum are one operation, those of
/// quotient.clh know whether the device rounds, and in doubles every device does (OpenCL C 1.2, 7.4).
const std::map<std::string, std::regex> kAlsoFixed{
    {"fma_lanes", std::regex("llvm\\.fmuladd\\..*")}, {"quotient", std::regex("fdiv")},
    {"quotient_lanes", std::regex("fdiv")},           {"quotient_of_any", std::regex("fdiv")},
    {"square_root", std::regex("fdiv|_Z4sqrtf")},     {"see_light", std::regex("fdiv|_Z4sqrtd")},
    {"place_sample", std::regex("_Z4sqrtd")}};

/// What a line of LLVM's text defines or calls by its name, after that word; empty where it has none.
std::string_view nameAfter(std::string_view line, std::string_view word) {
  const std::size_t begin = line.find(word);
  const std::size_t at = begin == line.npos ? begin : line.find('@', begin);
  if (at == line.npos) return {};
  return line.substr(at + 1, line.find('(', at) - at - 1);
}

/// Of a program in LLVM's text what isn't fixed, a line each: the function, and what it does.
std::set<std::string> looseArithmetic(const std::string& program) {
  // Quotients, and flags that loosen what is computed.
  const std::array inexact{" fdiv ", " frem ", " fast ",     " nnan ", " ninf ",
                           " nsz ",  " arcp ", " contract ", " afn ",  " reassoc "};
  std::vector<std::string_view> lines;
  for (std::string_view rest = program; !rest.empty();) {
    lines.push_back(rest.substr(0, rest.find('\n')));
    rest.remove_prefix(std::min(rest.size(), lines.back().size() + 1));
  }
  std::set<std::string, std::less<>> own, fixed;
  std::set<std::string> loose;
  for (const std::string_view line : lines)
    if (line.starts_with("define ")) own.emplace(nameAfter(line, "define "));
  std::string function;
  for (const std::string_view line : lines) {
    if (line.starts_with("define ")) function = nameAfter(line, "define ");
    if (!line.starts_with("  ")) continue;
    const auto judge = [&](const std::string& what) {
      const auto also = kAlsoFixed.find(function);
      if (also != kAlsoFixed.end() && std::regex_match(what, also->second)) return;
      loose.insert(function + ": " + what);
    };
    if (line.find("call ") != line.npos) {
      const std::string called(nameAfter(line, "call "));
      if (called.empty()) {
        judge("a pointer to a function");
      } else if (!own.contains(called) && !fixed.contains(called)) {
        if (std::regex_match(called, kFixedFunctions))
          fixed.insert(called);
        else
          judge(called);
      }
    }
    for (const std::string_view word : inexact)
      if (line.find(word) != line.npos) judge(std::string(word.substr(1, word.size() - 2)));
  }
  return loose;
}

/// LLVM's text of a file, before any pass, with what the standard's header declares.
Compiled programOf(const std::string& clang, const std::string& options) {
  return compile(clang,
                 "-Xclang -finclude-default-header -Xclang -fdeclare-opencl-builtins -S -emit-llvm -Xclang "
                 "-disable-llvm-passes -O1 -o - " +
                     options);
}

std::string joined(const std::set<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(KernelLint, OnlyArithmeticThatTheStandardFixes) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  for (const int lanes : kAllLanes)
    for (const char* machine :
         {"", "-march=x86-64-v3", "-march=x86-64-v4", "-DOWN_QUOTIENTS", "-DSTANDARD_ONLY"}) {
      // Only the widths of their registers have lines of their own for these machines.
      if (std::string_view(machine).starts_with("-march") && lanes < 8) continue;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(
               std::filesystem::path(LUCIOLE_SOURCE_DIR) / "kernels")) {
        if (entry.path().extension() != ".cl") continue;
        // The truth of models from files: it is compared within bounds, and its last bits may differ.
        if (entry.path().filename() == "model_truth.cl") continue;
        const std::string options = fmt::format("-DLANES={} {} {}", lanes, machine, quoted(entry.path()));
        const Compiled program = programOf(clang, options);
        ASSERT_TRUE(program.succeeded) << options << "\n" << program.output;
        EXPECT_EQ(joined(looseArithmetic(program.output)), "") << options;
      }
    }
}

// NVIDIA's compiler refuses a prefetch from an address space of its own.
TEST(KernelLint, GpusAreNotAskedForWhatProcessorsHave) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  const std::string shade = quoted(std::filesystem::path(LUCIOLE_SOURCE_DIR) / "kernels" / "shade/shade.cl");
  const auto prefetches = [&](const std::string& target) {
    const Compiled program = programOf(clang, "-DLANES=4 " + target + " " + shade);
    EXPECT_TRUE(program.succeeded) << program.output;
    return program.output.find("llvm.prefetch") != std::string::npos;
  };
  EXPECT_TRUE(prefetches("-target x86_64-linux-gnu"));
  EXPECT_FALSE(prefetches("-target nvptx64-nvidia-nvcl"));
}

/// A function in LLVM's text: its instructions, those that it calls, and whether it is always inlined.
struct FunctionText {
  double instructions = 0;
  std::vector<std::string> calls;
  std::string attributes;
};

/// Instructions of a program in LLVM's text, before any pass, once all is inlined that always is.
double inlinedInstructions(const std::string& program) {
  std::map<std::string, FunctionText> functions;
  std::set<std::string> inlined;
  const auto nameIn = [](const std::string& line) {
    const std::size_t at = line.find('@') + 1;
    return line.substr(at, line.find('(', at) - at);
  };
  FunctionText* function = nullptr;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("define ")) {
      function = &functions[nameIn(line)];
      const std::size_t at = line.rfind(" #");
      function->attributes = line.substr(at + 1, line.find(' ', at + 1) - at - 1);
    } else if (line.starts_with("attributes ") && line.find(" alwaysinline ") != std::string::npos) {
      inlined.insert(line.substr(11, line.find(' ', 11) - 11));
    } else if (line.starts_with("  ")) {
      ++function->instructions;
      if (line.find("call ") != std::string::npos && line.find('@') != std::string::npos)
        function->calls.push_back(nameIn(line));
    }
  }
  std::map<std::string, double> sizes;
  const std::function<double(const std::string&)> sizeOf = [&](const std::string& name) {
    const auto found = functions.find(name);
    if (found == functions.end()) return 0.0;
    if (const auto known = sizes.find(name); known != sizes.end()) return known->second;
    double size = found->second.instructions;
    for (const std::string& called : found->second.calls) {
      const auto it = functions.find(called);
      if (it != functions.end() && inlined.count(it->second.attributes) != 0) size += sizeOf(called);
    }
    return sizes[name] = size;
  };
  double all = 0;
  for (const auto& [name, one] : functions)
    if (inlined.count(one.attributes) == 0) all += sizeOf(name);
  return all;
}

// What several places call is not inlined into each of them, and into each place that calls these: at one
// lane beam_shadows.cl would have 200,000 instructions, before loops are unrolled, and take minutes to
// compile.
TEST(KernelLint, NoProgramGrowsManyfoldByWhatIsInlined) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(LUCIOLE_SOURCE_DIR) / "kernels")) {
    if (entry.path().extension() != ".cl") continue;
    for (const int lanes : {1, 4}) {
      const Compiled program = programOf(clang, fmt::format("-DLANES={} {}", lanes, quoted(entry.path())));
      ASSERT_TRUE(program.succeeded) << program.output;
      EXPECT_LE(inlinedInstructions(program.output), 1e5) << entry.path() << " at " << lanes << " lanes";
    }
  }
}

TEST(KernelLint, LooseArithmeticIsFound) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  const TemporaryFolder folder;
  const auto judged = [&](const std::string& body, const std::string& options = "") {
    writeText(folder / "loose.cl",
              "#include \"quotient.clh\"\n__kernel void probe(__global float *x, __global int *i) { " + body +
                  " }\n");
    const Compiled program =
        programOf(clang, "-DLANES=4 " + options + " " + quoted(folder.path() / "loose.cl"));
    EXPECT_TRUE(program.succeeded) << body << "\n" << program.output;
    return joined(looseArithmetic(program.output));
  };
  for (const char* call : {"native_sqrt(x[0])",
                           "native_recip(x[0])",
                           "half_rsqrt(x[0])",
                           "rsqrt(x[0])",
                           "sqrt(x[0])",
                           "exp2(x[0])",
                           "exp(x[0])",
                           "log(x[0])",
                           "pow(x[0], x[1])",
                           "sin(x[0])",
                           "tan(x[0])",
                           "mad(x[0], x[1], x[2])",
                           "mix(x[0], x[1], x[2])",
                           "max(x[0], x[1])",
                           "min(x[0], x[1])",
                           "fmin(x[0], x[1])",
                           "fmod(x[0], x[1])",
                           "step(x[0], x[1])",
                           "clamp(x[0], x[1], x[2])",
                           "length((float2)(x[0], x[1]))",
                           "dot((float2)(x[0], x[1]), (float2)(x[2], x[3]))",
                           "normalize((float2)(x[0], x[1])).x",
                           "ldexp(x[0], i[0])",
                           "convert_int_sat(x[0])",
                           "convert_int_rte(x[0])",
                           "mad24(i[0], i[1], i[2])"}) {
    const std::string name = std::string(call).substr(0, std::string(call).find('('));
    const std::string found = judged(fmt::format("x[0] = {};", call));
    EXPECT_NE(found.find(name), std::string::npos) << call << "\n" << found;
  }
  EXPECT_EQ(judged("x[0] = x[1] / x[2];"), "probe: fdiv\n");
  EXPECT_EQ(judged("x[0] += 2.0f * x[1];"), "") << "contraction is off below lanes.clh";
  EXPECT_EQ(judged("{\n#pragma OPENCL FP_CONTRACT ON\nx[0] = x[1] * x[2] + x[3]; }"),
            "probe: llvm.fmuladd.f32\n");
  EXPECT_NE(judged("x[0] = x[1] + x[2];", "-cl-fast-relaxed-math"), "");
  EXPECT_EQ(
      judged(
          "x[0] = quotient(fma(x[1], x[2], x[3]), square_root(x[4])); i[0] = min(i[1], convert_int(x[0]));"),
      "");
}

// PoCL takes these alone for a start that reads little (build_program.cpp).
TEST(KernelLint, BuiltinsDeclareNoMoreThanIsFixed) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  const TemporaryFolder folder;
  const auto compiles = [&](const std::string& body) {
    writeText(folder / "call.cl",
              "#include \"builtins.clh\"\n__kernel void probe(__global float *x) { " + body + " }\n");
    return compile(clang, "-D_OPENCL_H_ -cl-no-stdinc -fsyntax-only " + quoted(folder.path() / "call.cl"))
        .succeeded;
  };
  EXPECT_TRUE(compiles("x[0] = fma(x[0], x[1], sqrt(x[2]));"));
  for (const char* call : {"max(x[0], x[1])", "exp2(x[0])", "rsqrt(x[0])", "mad(x[0], x[1], x[2])"})
    EXPECT_FALSE(compiles(fmt::format("x[0] = {};", call))) << call;
}

}  // namespace
}  // namespace luciole::test
