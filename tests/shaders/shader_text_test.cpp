#include "shaders/shader_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "luciole/error.hpp"

namespace luciole {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kSignature =
    "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l) {\n";

/// A model whose function has these statements, from line 2 on.
std::string modelOf(const std::string& statements) {
  return kSignature + statements + "\n  Reflection r = {n_dot_l, n_dot_l};\n  return r;\n}\n";
}

ShaderFacts factsOf(const std::string& text, ShaderKind kind = ShaderKind::kModel) {
  return shaderFacts({"mine.clh", text}, kind);
}

/// What a text is refused with; empty if it isn't.
std::string refusal(const std::string& text, ShaderKind kind = ShaderKind::kModel) {
  try {
    factsOf(text, kind);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ShaderText, APlainModelPasses) {
  EXPECT_EQ(refusal(modelOf("")), "");
  EXPECT_EQ(refusal("#include \"math.clh\"\n#define K (2.0f * 3 - 1)\n#define L (K + 1.0e-3f)\n"
                    "INLINE floatL square(floatL x) { return x * x; }\n" +
                    modelOf("floatL a = square(s->n_dot_v) * K - -L;\n"
                            "UNROLLED(i, 4) { a = a > 0.5f && i < 3 ? a * 0.5f : a; if (a < 0) break; }\n"
                            "vec3L h = {to_light.x + s->to_eye.x, 0, 0}; a += h.x * n_dot_l;")),
            "");
}

TEST(ShaderText, WhatLoopsWithoutEndIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal(modelOf("  for (;;) {}")),
              StartsWith("mine.clh:2:3: `for`: the only loop is UNROLLED"));
  EXPECT_THAT(refusal(modelOf("while (1);")), HasSubstr("`while`"));
  EXPECT_THAT(refusal(modelOf("do {} while (1);")), HasSubstr("`do`"));
  EXPECT_THAT(refusal(modelOf("again: goto again;")), HasSubstr("`goto`"));
  EXPECT_THAT(refusal(modelOf("UNROLLED(i, n) {}")), HasSubstr("a number of turns, 1 to 64"));
  EXPECT_THAT(refusal(modelOf("UNROLLED(i, 65) {}")), HasSubstr("a number of turns, 1 to 64"));
  EXPECT_THAT(refusal(modelOf("UNROLLED(i, 2) i;")), HasSubstr("body stands in { }"));
}

TEST(ShaderText, OnlyTheLoopChangesItsVariable) {
  for (const char* change : {"i = 0;", "i -= 1;", "i--;", "--i;", "uint i = 0;"})
    EXPECT_THAT(refusal(modelOf(std::string("UNROLLED(i, 2) { ") + change + " }")),
                HasSubstr("only the loop changes it"))
        << change;
  for (const char* change : {"(i) = 0;", "((i)) -= 1;", "--(i);", "(i)--;"})
    EXPECT_THAT(refusal(modelOf(std::string("UNROLLED(i, 2) { ") + change + " }")),
                HasSubstr("without parentheses"))
        << change;
  EXPECT_EQ(refusal(modelOf("UNROLLED(i, 2) { uint j = i; j = 0; } int i = 0; i = 1;")), "");
}

TEST(ShaderText, NoFunctionCallsItself) {
  EXPECT_THAT(refusal("INLINE floatL f(floatL x) { return f(x); }\n" + modelOf("")),
              StartsWith("mine.clh:1:36: f() calls itself"));
  EXPECT_THAT(refusal("INLINE floatL f(floatL x);\n" + modelOf("")),
              HasSubstr("is defined where it is declared"));
}

// A function that knew its name in the program could call itself by it.
TEST(ShaderText, NoFunctionCanWriteTheNameThatItHasInAProgram) {
  const std::string helper = "INLINE floatL f(floatL x) { return x; }\n";
  const std::string program =
      shaderProgram(std::vector{Shader{"mine.clh", helper + modelOf("")}}, ShaderKind::kModel);
  for (const char* name : {"f", "reflect_light"}) {
    EXPECT_THAT(program, HasSubstr(std::string("#define ") + name + " __" + name + "_0\n"));
    EXPECT_THAT(refusal(helper + modelOf(std::string("__") + name + "_0(n_dot_l);")),
                HasSubstr("the compiler's"));
  }
  EXPECT_EQ(shaderError("mine.clh:1:2: error: no matching function for call to '__f_0'\n", program),
            "mine.clh:1:2: no matching function for call to 'f'");
}

TEST(ShaderText, WhatRepeatsTextTooOftenIsRefused) {
  EXPECT_THAT(refusal(modelOf("UNROLLED(i, 64) { UNROLLED(j, 64) { UNROLLED(k, 64) { n_dot_l += 1; } } }")),
              HasSubstr("words and signs"));
  std::string doubling = "INLINE floatL f0(floatL x) { return x; }\n";
  for (int i = 1; i < 40; ++i)
    doubling += "INLINE floatL f" + std::to_string(i) + "(floatL x) { return f" + std::to_string(i - 1) +
                "(x) + f" + std::to_string(i - 1) + "(x); }\n";
  EXPECT_THAT(refusal(doubling + modelOf("")), HasSubstr("words and signs"));
  std::string laughs = "#define M0 1\n";
  for (int i = 1; i < 60; ++i)
    laughs += "#define M" + std::to_string(i) + " M" + std::to_string(i - 1) + " + M" +
              std::to_string(i - 1) + "\n";
  EXPECT_THAT(refusal(laughs + modelOf("")), HasSubstr("words and signs"));
  std::string chain = "n_dot_l = 1";
  for (int i = 0; i < 2000; ++i) chain += "+1";
  EXPECT_THAT(refusal(modelOf(chain + ";")), HasSubstr("a statement has 1000"));
  EXPECT_THAT(refusal(modelOf("n_dot_l = " + std::string(100, '(') + "1" + std::string(100, ')') + ";")),
              HasSubstr("64 deep"));
}

TEST(ShaderText, SizesAreLimitedBeforeTheTextIsRead) {
  EXPECT_THAT(refusal(std::string(kMostShaderBytes + 1, ' ')), HasSubstr("bytes, expected 65536 at most"));
  EXPECT_THAT(refusal(std::string(10'000, '\n')), HasSubstr("has 10000 lines, expected 2000 at most"));
}

TEST(ShaderText, PointersStayWhatTheFunctionWasGiven) {
  for (const char* misuse :
       {"Surface *p = s;", "const Surface *p = s;", "(s + 1)->normal;", "s = 0;", "s++;", "s[1];",
        "*(s + 1);", "float x; f(&x);", "(float *)s;", "if (s) ;", "vec3L *v = 0;",
        "Reflection q; q = *s * 1; s - 1;", "(s) + 1;", "clamp01((s));", "n_dot_l = (0, s);", "n_dot_l->x;"})
    EXPECT_NE(refusal(modelOf(misuse)), "") << misuse;
  EXPECT_EQ(refusal("INLINE floatL f(const Surface *at, floatL x) { return at->n_dot_v * x; }\n" +
                    modelOf("n_dot_l = f(s, 2) * f(s, n_dot_l);\nSurface copy = *s;")),
            "");
  EXPECT_THAT(refusal("INLINE void f(floatL *x) { *x = 1; }\n" + modelOf("")),
              HasSubstr("to a Surface or a Screen"));
}

TEST(ShaderText, AProductMayBeginAListOfValues) {
  EXPECT_EQ(refusal(modelOf("Reflection q = {n_dot_l * n_dot_l, s->n_dot_v * n_dot_l};\n"
                            "vec3L v = (vec3L){n_dot_l * 2, n_dot_l * 3, 0};")),
            "");
  for (const char* block : {"{ Pair *p = 0; }", "if (n_dot_l) { Pair *p = 0; }", "{ { Pair *p = 0; } }"})
    EXPECT_THAT(refusal(modelOf(block)), HasSubstr("pointers are parameters alone")) << block;
}

TEST(ShaderText, WordsThatReachFurtherAreRefused) {
  for (const char* word :
       {"printf(\"x\");", "asm(\"nop\");", "__global float x;", "global float *x;", "barrier(1);",
        "vstore4(0, 0, s);", "get_global_id(0);", "typedef int x;", "struct x {int y;};", "static int x;",
        "int x = 5 % 0;", "n_dot_l /= 2;", "_Pragma(\"x\")", "float a[2];", "atomic_inc(0);",
        "as_intL(n_dot_l);", "a <: 1 :> b;", "n_dot_l @ 2;"})
    EXPECT_NE(refusal(modelOf(word)), "") << word;
}

TEST(ShaderText, LinesEndWhereACompilerEndsThem) {
  EXPECT_THAT(refusal(modelOf("// comment \\\nfor(;;);")), HasSubstr("a \\ at a line's end"));
  EXPECT_THAT(refusal(modelOf("/* comment *\\\n/ for(;;);*/")), HasSubstr("a \\ at a line's end"));
  EXPECT_THAT(refusal(modelOf("// comment \rfor(;;);")), HasSubstr("control character 13"));
  EXPECT_THAT(refusal(modelOf("// comment ?"
                              "?/\nfor(;;);")),
              HasSubstr("two question marks"));
  EXPECT_THAT(refusal(modelOf("/* no end")), HasSubstr("this comment has no end"));
  EXPECT_EQ(refusal("// é \\alpha\r\n" + modelOf("\r")), "");
}

TEST(ShaderText, MacrosStandForNumbers) {
  for (const char* macro : {"#define CALL reflect_light",
                            "#define STAR *",
                            "#define X (s + 5)",
                            "#define F(x) x",
                            "#define OPEN (",
                            "#define LOOP for(;;)",
                            "#define A B",
                            "#define A 1\n#define A 2",
                            "#define EMPTY",
                            "#define A 1)(1",
                            "#define A 2 *",
                            "#if 1",
                            "#ifdef X",
                            "#undef X",
                            "#pragma unroll",
                            "#include <stdio.h>",
                            "#include \"/etc/passwd\"",
                            "#include \"../x.clh\"",
                            "#line 5",
                            "#error x",
                            "#"})
    EXPECT_NE(refusal(std::string(macro) + "\n" + modelOf("")), "") << macro;
  EXPECT_THAT(refusal("#include \"secret.clh\"\n" + modelOf("")),
              HasSubstr("a shader may include \"lanes.clh\""));
}

TEST(ShaderText, AnotherFunctionsNameOrParametersAreToldWithWhatIsExpected) {
  EXPECT_THAT(refusal("INLINE floatL lobe(floatL x) { return x; }\n"),
              HasSubstr("mine.clh: has no reflect_light(), expected INLINE Reflection reflect_light("));
  EXPECT_THAT(refusal("INLINE Reflection reflect_light(floatL x) { Reflection r; return r; }\n"),
              StartsWith("mine.clh:1:19: expected INLINE Reflection reflect_light("));
  EXPECT_THAT(refusal(modelOf(""), ShaderKind::kSurface), HasSubstr("has no surface()"));
  EXPECT_THAT(refusal(""), HasSubstr("has no reflect_light()"));
  EXPECT_THAT(refusal("floatL x;\n"), HasSubstr("outside of functions stand functions"));
}

TEST(ShaderText, AScreenSaysItsRadius) {
  const std::string screen = "INLINE vec3L screen(const Screen *at) { return color_at(at, 0, 1); }\n";
  EXPECT_EQ(factsOf("#define RADIUS 3\n" + screen, ShaderKind::kScreen).radius, 3);
  EXPECT_THAT(refusal(screen, ShaderKind::kScreen), HasSubstr("needs a #define RADIUS, 0 to 8 pixels"));
  for (const char* radius : {"9", "-1", "1.5", "(2)", "99999999999"})
    EXPECT_THAT(refusal("#define RADIUS " + std::string(radius) + "\n" + screen, ShaderKind::kScreen),
                HasSubstr("RADIUS is 0 to 8 pixels"));
}

TEST(ShaderText, ArithmeticThatOpenClDoesNotFixIsNoted) {
  const ShaderFacts facts =
      factsOf(modelOf("n_dot_l = pow(n_dot_l, 2.0f) / native_exp(n_dot_l) + fma(1, 2, 3);"));
  ASSERT_EQ(facts.loose.size(), 3u);
  EXPECT_EQ(facts.loose[0],
            "mine.clh:2:11: the last bits of pow() differ between devices; pow_one_plus(x - 1, n) "
            "is the same on all");
  EXPECT_THAT(facts.loose[1], HasSubstr("a quotient differ"));
  EXPECT_THAT(facts.loose[2], HasSubstr("native_exp()"));
  EXPECT_TRUE(factsOf(modelOf("// a / b, sqrt(x)")).loose.empty());
}

TEST(ShaderText, FactsAreOfWhatTheTextNames) {
  const ShaderFacts plain = factsOf(modelOf("// tangent grazing"));
  EXPECT_FALSE(plain.uses_tangents || plain.uses_colors || plain.uses_grazing);
  EXPECT_TRUE(factsOf(modelOf("n_dot_l = s->bitangent.x;")).uses_tangents);
  EXPECT_TRUE(factsOf(modelOf("n_dot_l = s->diffuse.x;")).uses_colors);
  EXPECT_TRUE(factsOf(modelOf("Reflection q; q.grazing = 1;")).uses_grazing);
}

TEST(ShaderText, MembersThatAreOnlyReadArentChanged) {
  const auto facts = [](const std::string& body) {
    return shaderFacts({"mine.clh", "INLINE void surface(Surface *s) {\n" + body + "\n}\n"},
                       ShaderKind::kSurface);
  };
  const ShaderFacts read =
      facts("floatL x = s->normal.x + s->uv.y; s->diffuse.x = x == s->exponent ? x : -s->normal.y;");
  EXPECT_EQ(read.named, (std::set<std::string, std::less<>>{"normal", "uv", "diffuse", "exponent"}));
  EXPECT_EQ(read.changed, (std::set<std::string, std::less<>>{"diffuse"}));
  for (const char* change : {"s->normal = s->to_eye;", "s->normal.x += 1.0f;", "s->normal.y *= s->exponent;",
                             "s->normal.y++;", "++s->normal.x;"})
    EXPECT_TRUE(facts(change).changed.contains("normal")) << change;
}

TEST(ShaderText, ProgramsKeepTheUsersLinesAndPlaces) {
  const Shader shader{"dir/mine.clh",
                      "#include \"math.clh\"\n#define K 2\n" + modelOf("  n_dot_l = K / n_dot_v;")};
  const std::string program = shaderProgram(std::vector{shader}, ShaderKind::kModel);
  EXPECT_THAT(program,
              HasSubstr("#line 1 \"dir/mine.clh\"\n\n#define K 2\nINLINE Reflection reflect_light("));
  // The quotient's column is moved back.
  EXPECT_EQ(shaderError("In file included from x:1:\ndir/mine.clh:4:22: error: use of undeclared 'n_dot_v'\n",
                        program),
            "dir/mine.clh:4:17: use of undeclared 'n_dot_v'");
  EXPECT_EQ(shaderError("error: dir/mine.clh:4:7: use of undeclared 'n_dot_v'\nDevice x failed\n", program),
            "dir/mine.clh:4:7: use of undeclared 'n_dot_v'");
  EXPECT_EQ(shaderError("kernels/math.clh:4:22: error: something\n", program),
            "dir/mine.clh: does not compile: something");
}

}  // namespace
}  // namespace luciole
