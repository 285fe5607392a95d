#include "shaders/shader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "shaders/shader_tokens.hpp"

namespace luciole {
namespace {

constexpr const char* kHeaders[] = {"lanes.clh",
                                    "math.clh",
                                    "quotient.clh",
                                    "random.clh",
                                    "shade/phong.clh",
                                    "shade/toon.clh",
                                    "shade/surface.clh",
                                    "shade/cook_torrance.clh",
                                    "shade/oren_nayar.clh",
                                    "shade/ward.clh",
                                    "shade/noise.clh"};

template <class List>
bool isIn(const List& list, Text text) {
  return std::find(std::begin(list), std::end(list), text) != std::end(list);
}

constexpr Text kAssignments[] = {"=", "+=", "-=", "*=", "/=", "&=", "|=", "^=", "<<=", ">>=", "++", "--"};

/// Words and signs that a shader may not have, with the reason.
struct Refused {
  Text word;
  const char* reason;
};
constexpr const char* kLoops =
    "the only loop is UNROLLED(i, n) {...}, with a number for n; a screen also has EACH_NEIGHBOR(dx, dy) "
    "{...}";
constexpr const char* kJumps = "a shader has no jumps but if, break, continue and return";
constexpr const char* kTypes = "a shader defines functions alone, and no types or variables of its own file";
constexpr const char* kMemory = "a shader reads and writes what its function is given alone";
constexpr const char* kArrays = "a shader has no arrays: elements of vectors are .x, .y ...";
constexpr const char* kSpelling = "another spelling of a bracket or #";
constexpr Refused kRefused[] = {{"for", kLoops},
                                {"while", kLoops},
                                {"do", kLoops},
                                {"goto", kJumps},
                                {"switch", kJumps},
                                {"case", kJumps},
                                {"asm", kJumps},
                                {"typedef", kTypes},
                                {"struct", kTypes},
                                {"union", kTypes},
                                {"enum", kTypes},
                                {"static", kTypes},
                                {"extern", kTypes},
                                {"typeof", kTypes},
                                {"volatile", kTypes},
                                {"kernel", kTypes},
                                {"constant", "numbers have names by #define"},
                                {"global", kMemory},
                                {"local", kMemory},
                                {"store_chosen", kMemory},
                                {"printf", "kernels print nothing"},
                                {"[", kArrays},
                                {"]", kArrays},
                                {"<:", kSpelling},
                                {":>", kSpelling},
                                {"<%", kSpelling},
                                {"%>", kSpelling},
                                {"%:", kSpelling},
                                {"##", "names aren't made of pieces"},
                                {"%", "a remainder by 0 ends the program: take & of a power of two less 1"},
                                {"%=", "a remainder by 0 ends the program: take & of a power of two less 1"},
                                {"/=", "write x = x / y"}};
/// Beginnings of such words.
constexpr Refused kRefusedBeginnings[] = {{"__", "names that begin with __ are the compiler's"},
                                          {"vload", kMemory},
                                          {"vstore", kMemory},
                                          {"atom", kMemory},
                                          {"async_", kMemory},
                                          {"prefetch", kMemory},
                                          {"read_image", kMemory},
                                          {"write_image", kMemory},
                                          {"barrier", kMemory},
                                          {"mem_fence", kMemory},
                                          {"get_", "a shader doesn't know the work-item"}};

/// Words before a ( that calls nothing, or before an expression.
constexpr Text kKeywords[] = {"if", "else", "return", "sizeof", "const", "break", "continue", "INLINE"};
constexpr Text kTypeNames[] = {"void",   "char",     "uchar",   "short",  "ushort",    "int",
                               "uint",   "long",     "ulong",   "float",  "double",    "half",
                               "bool",   "floatL",   "intL",    "uintL",  "vec3L",     "size_t",
                               "signed", "unsigned", "Surface", "Screen", "Reflection"};

/// Functions of OpenCL C whose results differ between devices, and what gives the same everywhere.
constexpr std::pair<Text, Text> kLoose[] = {
    {"/", "quotient_lanes(a, b)"},       {"sqrt", "x * rsqrt_lanes(x)"},
    {"rsqrt", "rsqrt_lanes(x)"},         {"mad", "fma_lanes(a, b, c)"},
    {"normalize", "normalize_lanes(v)"}, {"dot", "dot3(a, b)"},
    {"exp", "exp_lanes(x) for x <= 0"},  {"exp2", "exp2_product(a, b)"},
    {"pow", "pow_one_plus(x - 1, n)"},   {"log2", "log2_one_plus(x - 1)"}};
constexpr Text kAlsoLoose[] = {
    "acos",           "acosh",    "acospi", "asin",     "asinh", "asinpi",     "atan",          "atan2",
    "atan2pi",        "atanh",    "atanpi", "cbrt",     "cos",   "cosh",       "cospi",         "cross",
    "degrees",        "distance", "erf",    "erfc",     "exp10", "expm1",      "fast_distance", "fast_length",
    "fast_normalize", "fract",    "frexp",  "hypot",    "ldexp", "length",     "lgamma",        "log",
    "log10",          "log1p",    "mix",    "modf",     "pown",  "powr",       "radians",       "remquo",
    "rootn",          "sin",      "sincos", "sinh",     "sinpi", "smoothstep", "tan",           "tanh",
    "tanpi",          "tgamma",   "fmod",   "remainder"};

struct Signature {
  const char* name;
  Text returned;
  std::vector<Text> parameters;  ///< tokens but for the names
  const char* shown;
};
Signature signatureOf(ShaderKind kind) {
  switch (kind) {
    case ShaderKind::kModel:
      return {"reflect_light",
              "Reflection",
              {"const", "Surface", "*", ",", "vec3L", ",", "floatL"},
              "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l)"};
    case ShaderKind::kSurface:
      return {"surface", "void", {"Surface", "*"}, "INLINE void surface(Surface *s)"};
    case ShaderKind::kScreen:
      break;
  }
  return {"screen", "vec3L", {"const", "Screen", "*"}, "INLINE vec3L screen(const Screen *at)"};
}

/// Goes through a shader's tokens once, holds them against the rules, and collects what programs must know.
class Checker {
 public:
  Checker(const Shader& shader, ShaderKind kind)
      : shader_(shader), kind_(kind), signature_(signatureOf(kind)), tokens_(tokensOf(shader)) {}

  ShaderFacts check() {
    while (at_ < tokens_.size()) {
      if (tokens_[at_].of_directive)
        checkDirective();
      else
        checkFunction();
    }
    if (!functions_.contains(signature_.name))
      throw InputError(
          fmt::format("{}: has no {}(), expected {}", shader_.path, signature_.name, signature_.shown));
    if (kind_ == ShaderKind::kScreen && !has_radius_)
      throw InputError(
          fmt::format("{}: needs a #define RADIUS, 0 to {} pixels", shader_.path, kMostScreenRadius));
    return std::move(facts_);
  }

 private:
  [[noreturn]] void fail(const Token& at, const std::string& what) const {
    failAt(shader_, at.line, at.column, what);
  }
  const Token& token(std::size_t index) const { return tokens_[std::min(index, tokens_.size() - 1)]; }
  Text text(std::size_t index) const { return index < tokens_.size() ? tokens_[index].text : Text(); }
  const Token& here() const { return token(at_); }

  void expect(Text sign, const char* what) {
    if (text(at_) != sign || here().of_directive) fail(here(), what);
    ++at_;
  }

  /// The end of the directive at at_.
  std::size_t endOfDirective() const {
    std::size_t end = at_ + 1;
    while (end < tokens_.size() && tokens_[end].of_directive && tokens_[end].line == here().line) ++end;
    return end;
  }

  void checkDirective() {
    const std::size_t end = endOfDirective();
    const Text name = at_ + 1 < end ? text(at_ + 1) : Text();
    if (name == "include") {
      const Text quoted = at_ + 3 == end ? text(at_ + 2) : Text();
      if (quoted.size() < 2 || quoted[0] != '"' || !isIn(kHeaders, quoted.substr(1, quoted.size() - 2)))
        fail(here(), fmt::format("a shader may include \"{}\"", fmt::join(kHeaders, "\", \"")));
      if (kind_ == ShaderKind::kModel && quoted == "\"shade/noise.clh\"")
        fail(here(),
             "noise is of surfaces: a model is compiled in double, too, where floats have other bits");
    } else if (name == "define") {
      checkMacro(end);
    } else {
      fail(here(), fmt::format("#{}: a shader has #include and #define alone", name));
    }
    at_ = end;
  }

  /// A macro stands for a number: digits, + - * / and ( ), and macros above.
  void checkMacro(std::size_t end) {
    const std::size_t first = at_ + 3;
    const Token& name = token(at_ + 2);
    if (at_ + 2 >= end || !isName(name.text)) fail(here(), "a macro needs a name");
    checkWord(name);
    if (macros_.contains(name.text) || functions_.contains(name.text))
      fail(name, fmt::format("`{}` is defined twice", name.text));
    std::size_t weight = 0;
    int depth = 0;
    bool is_value = false;  // whether the last token ends a value
    for (std::size_t i = first; i < end; ++i) {
      const Text word = text(i);
      const bool begins_value = isNumber(word) || macros_.contains(word) || word == "(";
      const bool is_sign = word == "+" || word == "-";
      if (begins_value ? is_value
          : is_value   ? !(is_sign || word == "*" || word == "/" || word == ")")
                       : !is_sign)
        fail(token(i), "a macro stands for a number: digits, + - * / ( ) and macros above it");
      depth += word == "(" ? 1 : word == ")" ? -1 : 0;
      if (depth < 0) break;
      is_value = word == ")" || (begins_value && word != "(");
      weight += macros_.contains(word) ? macros_.find(word)->second : 1;
      if (word == "/") noteLoose(token(i));
    }
    if (depth != 0 || !is_value)
      fail(name, "a macro stands for a number: digits, + - * / ( ) and macros above it");
    if (name.text == "RADIUS" && kind_ == ShaderKind::kScreen)
      readRadius(name, end == first + 1 ? text(first) : "");
    checkWeight(name, weight);
    macros_.emplace(name.text, weight);
  }

  void readRadius(const Token& name, Text value) {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), facts_.radius);
    if (error != std::errc() || end != value.data() + value.size() || facts_.radius > kMostScreenRadius)
      fail(name, fmt::format("RADIUS is 0 to {} pixels", kMostScreenRadius));
    has_radius_ = true;
  }

  void checkWeight(const Token& at, std::size_t weight) const {
    if (weight > kMostRepeated)
      fail(at,
           fmt::format("with all that loops and calls repeat this is {} words and signs or more, expected "
                       "{} at most",
                       weight, kMostRepeated));
  }

  /// INLINE type name(parameters) { … }
  void checkFunction() {
    const std::size_t begin = at_;
    expect("INLINE", "outside of functions stand functions, which begin with INLINE, and #define");
    if (text(at_) == "const") fail(here(), "a function's type has no const");
    if (!isName(text(at_)) || !isName(text(at_ + 1)) || text(at_ + 2) != "(")
      fail(here(), "a function is INLINE type name(parameters) {...}");
    checkWord(here());
    const Token& name = token(at_ + 1);
    checkWord(name);
    if (functions_.contains(name.text) || macros_.contains(name.text))
      fail(name, fmt::format("`{}` is defined twice", name.text));
    at_ += 3;
    function_ = name.text;
    pointers_.clear();
    loops_.clear();
    const std::vector<Text> parameters = takeParameters();
    if (name.text == signature_.name) {
      const bool returns = text(begin + 1) == signature_.returned;
      if (!returns || parameters != signature_.parameters)
        fail(name, fmt::format("expected {}", signature_.shown));
    }
    if (text(at_) == ";")
      fail(here(), "a function is defined where it is declared, above those that call it");
    expect("{", "a function's { is missing");
    const std::size_t weight = checkBody(name);
    functions_.emplace(name.text, weight);
    function_ = {};
  }

  /// The parameters' tokens but for their names, up to the ) and with it taken.
  std::vector<Text> takeParameters() {
    std::vector<Text> all;
    if (text(at_) == "void" && text(at_ + 1) == ")") ++at_;
    while (text(at_) != ")") {
      if (!all.empty()) {
        expect(",", "a function's parameters are `type name`, with , between");
        all.emplace_back(",");
      }
      if (text(at_) == "const") all.push_back(text(at_++));
      if (!isName(text(at_)) || isIn(kKeywords, text(at_))) fail(here(), "a parameter's type is missing");
      checkWord(here());
      all.push_back(text(at_++));
      const bool is_pointer = text(at_) == "*";
      if (is_pointer && all.back() != "Surface" && all.back() != "Screen")
        fail(here(), "a pointer is one to a Surface or a Screen");
      if (is_pointer) all.push_back(text(at_++));
      if (!isName(text(at_)) || isIn(kKeywords, text(at_)) || macros_.contains(text(at_)))
        fail(here(), "a parameter's name is missing");
      checkWord(here());
      if (is_pointer) pointers_.push_back(text(at_));
      ++at_;
    }
    ++at_;
    return all;
  }

  /// An open bracket.
  struct Open {
    char sign;
    bool takes_pointers =
        false;              ///< of a parenthesis: before it stands a function that pointers are given to
    std::size_t turns = 1;  ///< of a loop's body
    bool is_loop = false;
    std::size_t loops_around = 0;  ///< of a loop's body: the variables of the loops around it
  };

  /// From behind a function's { to behind its }. Returns its weight.
  std::size_t checkBody(const Token& name) {
    std::vector<Open> open{{'{'}};
    std::size_t weight = 0, statement = 0, turns = 1;
    for (; !open.empty(); ++at_) {
      if (at_ >= tokens_.size()) fail(name, fmt::format("{}() has no closing }}", name.text));
      const Token& now = here();
      if (now.of_directive) fail(now, "directives stand outside of functions");
      checkWord(now);
      const Text word = now.text;
      if (word == "UNROLLED" || isNeighborLoop(word)) {
        const std::size_t loops_around = loops_.size();
        open.push_back(
            {'{', false, word == "UNROLLED" ? loopHeader() : neighborHeader(), true, loops_around});
        if (turns > kMostRepeated) checkWeight(now, turns);
        turns *= open.back().turns;
      } else if (word == "{" || word == "(") {
        open.push_back({word[0], word == "(" && takesPointers(text(at_ - 1))});
        if (open.size() > 64) fail(now, "brackets stand 64 deep at most");
      } else if (word == "}" || word == ")") {
        if (open.back().sign != (word == "}" ? '{' : '('))
          fail(now, fmt::format("this {} closes nothing", word));
        turns /= open.back().turns;
        if (open.back().is_loop) loops_.resize(open.back().loops_around);
        open.pop_back();
      } else {
        checkUse(now, open.back());
      }
      const std::size_t tokens = weightOf(word);
      weight += turns * tokens;
      checkWeight(now, weight);
      statement = word == ";" || word == "{" || word == "}" ? 0 : statement + tokens;
      if (statement > kMostStatement)
        fail(now, fmt::format("a statement has {} words and signs at most", kMostStatement));
    }
    return weight;
  }

  bool takesPointers(Text function) const {
    return functions_.contains(function) || (kind_ == ShaderKind::kScreen && function.ends_with("_at"));
  }

  /// The words and signs that stand for one.
  std::size_t weightOf(Text word) const {
    if (const auto macro = macros_.find(word); macro != macros_.end()) return macro->second;
    if (const auto function = functions_.find(word); function != functions_.end()) return function->second;
    // What a header's function is made of, about.
    constexpr std::size_t kOfHeaders = 16;
    return isName(word) && text(at_ + 1) == "(" && !isIn(kKeywords, word) ? kOfHeaders : 1;
  }

  /// UNROLLED(i, n) {, up to the {. Returns n.
  std::size_t loopHeader() {
    const Token& loop = here();
    ++at_;
    expect("(", "a loop is UNROLLED(i, n) {...}");
    const Text variable = text(at_);
    if (!isName(variable) || isIn(kKeywords, variable) || macros_.contains(variable))
      fail(here(), "a loop is UNROLLED(i, n) {...}, with a name for i");
    checkWord(here());
    ++at_;
    expect(",", "a loop is UNROLLED(i, n) {...}");
    const Token& count = here();
    unsigned turns = 0;
    const auto [end, error] =
        std::from_chars(count.text.data(), count.text.data() + count.text.size(), turns);
    if (error != std::errc() || end != count.text.data() + count.text.size() || turns < 1 ||
        turns > kMostTurns)
      fail(count, fmt::format("a loop has a number of turns, 1 to {}", kMostTurns));
    ++at_;
    expect(")", "a loop is UNROLLED(i, n) {...}");
    if (text(at_) != "{") fail(loop, "a loop's body stands in { }");
    loops_.push_back(variable);
    return turns;
  }

  bool isNeighborLoop(Text word) const { return kind_ == ShaderKind::kScreen && word == "EACH_NEIGHBOR"; }

  /// EACH_NEIGHBOR(dx, dy) {, up to the {. Returns the turns.
  std::size_t neighborHeader() {
    constexpr const char* kExpected = "a loop over all neighbours is EACH_NEIGHBOR(dx, dy) {...}";
    const Token& loop = here();
    if (!has_radius_) fail(loop, "the #define RADIUS stands above its neighbours");
    ++at_;
    for (const Text sign : {"(", ","}) {
      expect(sign, kExpected);
      const Text variable = text(at_);
      if (!isName(variable) || isIn(kKeywords, variable) || macros_.contains(variable))
        fail(here(), kExpected);
      checkWord(here());
      ++at_;
      loops_.push_back(variable);
    }
    expect(")", kExpected);
    if (text(at_) != "{") fail(loop, "a loop's body stands in { }");
    const auto side = 2 * std::size_t(facts_.radius) + 1;
    return side * side;
  }

  /// Whether the token before ends a value, so that * and & after it have two operands.
  bool endsValue(Text before) const {
    return before == ")" || isNumber(before) ||
           (isName(before) && !isIn(kKeywords, before) && !isIn(kTypeNames, before));
  }

  /// Holds a token of a function's body against the rules for pointers and loops' variables.
  void checkUse(const Token& now, const Open& in) {
    const Text word = now.text, before = text(at_ - 1), after = text(at_ + 1);
    if (word == "*") {
      if (!endsValue(before)) {
        if (!isIn(pointers_, after)) fail(now, "* stands before a pointer that the function was given");
      } else if (after == ")" || (isName(before) && beginsStatement(at_ - 1))) {
        fail(now, "pointers are parameters alone");
      }
    } else if ((word == "&" || word == "&&") && !endsValue(before)) {
      fail(now, fmt::format("{} stands between two values", word));
    } else if (word == "->" && !isIn(pointers_, before)) {
      fail(now, "-> follows a pointer that the function was given");
    } else if (isIn(kAssignments, word)) {
      const bool is_step = word == "++" || word == "--";
      if (before == ")" || (is_step && after == "(")) fail(now, "what changes is named without parentheses");
      if (isIn(loops_, before) && text(at_ - 2) != "." && text(at_ - 2) != "->")
        fail(token(at_ - 1), fmt::format("`{}` counts the loop, and only the loop changes it", before));
      if (is_step && isIn(loops_, after))
        fail(token(at_ + 1), fmt::format("`{}` counts the loop, and only the loop changes it", after));
    } else if (isIn(pointers_, word)) {
      const bool is_member = before == "." || before == "->",
                 is_read = before == "*" && !endsValue(text(at_ - 2));
      const bool is_argument =
          in.takes_pointers && (before == "(" || before == ",") && (after == "," || after == ")");
      if (!is_member && !is_read && after != "->" && !is_argument)
        fail(now, fmt::format("the pointer `{}` is followed by ->, or given on as it is", word));
    } else if (!function_.empty() && word == function_ && after == "(") {
      fail(now, fmt::format("{}() calls itself, and a device has no stack for that", word));
    }
  }

  /// Whether a { begins a list of values: behind = or , or a type in parentheses.
  bool beginsList(std::size_t index) const {
    const Text before = text(index - 1);
    return before == "=" || before == "," ||
           (before == ")" && isIn(kTypeNames, text(index - 2)) && text(index - 3) == "(");
  }

  /// Whether the token with this index is a statement's first, or stands behind its const.
  bool beginsStatement(std::size_t index) const {
    const Text before = text(index - 1);
    return before == ";" || before == "}" || before == "const" || (before == "{" && !beginsList(index - 1));
  }

  /// Holds a word or a sign against what no shader may have, and notes what programs must know of it.
  void checkWord(const Token& now) {
    const Text word = now.text;
    for (const auto& [refused, reason] : kRefused)
      if (word == refused) fail(now, fmt::format("`{}`: {}", word, reason));
    for (const auto& [beginning, reason] : kRefusedBeginnings)
      if (word.starts_with(beginning)) fail(now, fmt::format("`{}`: {}", word, reason));
    if (word[0] == '"') fail(now, "text in quotes has no meaning here");
    if (word.size() > 1 && word[0] == '_' && word[1] >= 'A' && word[1] <= 'Z')
      fail(now, fmt::format("`{}`: names that begin with _ and a capital are the compiler's", word));
    if (kind_ == ShaderKind::kModel && word.starts_with("as_"))
      fail(now, fmt::format("`{}`: a model is compiled in double, too, where floats have other bits", word));
    const bool is_member = at_ > 0 && text(at_ - 1) == "->";
    facts_.uses_tangents |= word == "tangent" || word == "bitangent";
    facts_.uses_grazing |= word == "grazing";
    if (is_member) facts_.named.emplace(word);
    if (is_member && isChanged()) facts_.changed.emplace(word);
    facts_.uses_colors |= is_member && (word == "diffuse" || word == "specular");
    if (word == "/" || text(at_ + 1) == "(") noteLoose(now);
  }

  /// Whether the member at_, or a component of it, is changed. What changes is named without parentheses.
  bool isChanged() const {
    const std::size_t next = text(at_ + 1) == "." ? at_ + 3 : at_ + 1;
    const Text before = at_ >= 3 ? text(at_ - 3) : Text();
    return isIn(kAssignments, text(next)) || before == "++" || before == "--";
  }

  /// Notes arithmetic that OpenCL doesn't fix.
  void noteLoose(const Token& now) {
    const Text word = now.text;
    const auto* const known = std::find_if(std::begin(kLoose), std::end(kLoose),
                                           [&](const auto& row) { return row.first == word; });
    const bool has_substitute = known != std::end(kLoose);
    if (!has_substitute && !isIn(kAlsoLoose, word) && !word.starts_with("native_") &&
        !word.starts_with("half_"))
      return;
    const std::string what = word == "/" ? "a quotient" : fmt::format("{}()", word);
    facts_.loose.push_back(fmt::format(
        "{}:{}:{}: the last bits of {} differ between devices{}", shader_.path, now.line, now.column, what,
        has_substitute ? fmt::format("; {} is the same on all", known->second) : std::string()));
  }

  const Shader& shader_;
  const ShaderKind kind_;
  const Signature signature_;
  const std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::map<Text, std::size_t, std::less<>> macros_, functions_;  ///< with their weights
  Text function_;                                                ///< that the tokens are of
  std::vector<Text> pointers_;                                   ///< its parameters that are pointers
  std::vector<Text> loops_;                                      ///< variables of the loops around the token
  bool has_radius_ = false;
  ShaderFacts facts_;
};

}  // namespace

std::span<const char* const> shaderHeaders() { return kHeaders; }

ShaderFacts shaderFacts(const Shader& shader, ShaderKind kind) {
  if (shader.text.size() > kMostShaderBytes)
    throw InputError(fmt::format("{}: has {} bytes, expected {} at most", shader.path, shader.text.size(),
                                 kMostShaderBytes));
  const auto lines = std::size_t(std::count(shader.text.begin(), shader.text.end(), '\n'));
  if (lines > kMostShaderLines)
    throw InputError(
        fmt::format("{}: has {} lines, expected {} at most", shader.path, lines, kMostShaderLines));
  return Checker(shader, kind).check();
}

bool usesTangents(std::span<const Shader> models) {
  return std::any_of(models.begin(), models.end(), [](const Shader& model) {
    return shaderFacts(model, ShaderKind::kModel).uses_tangents;
  });
}

Shader readShader(const std::string& path, ShaderKind kind) {
  if (!isFile(path)) throw InputError(fmt::format("{}: no such file", path));
  Shader shader{path, readFile(path)};
  shaderFacts(shader, kind);
  return shader;
}

}  // namespace luciole
