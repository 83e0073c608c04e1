// SPDX-License-Identifier: Apache-2.0
// Checks size of functions, spelling of names and casts in the whole tree. clang-tidy checks the
// same rules and names of members with a compiler, in changed files (./run tidy).
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "tests/layering/source_functions.h"
#include "tests/layering/source_names.h"
#include "tests/layering/source_tokens.h"
#include "tests/support/paths.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int kMostLines = 60;

std::vector<std::string> LongFunctions(const std::string& file, std::string_view text) {
  std::vector<std::string> faults;
  for (const SourceFunction& function : FunctionsOf(ReadSource(text))) {
    if (function.lines <= kMostLines) continue;
    faults.push_back(fmt::format("{}:{}: {} has {} lines, at most {} are allowed: split it", file,
                                 function.line, function.name, function.lines, kMostLines));
  }
  return faults;
}

// The spelling that a name should have; empty if it has it. Names of C and of other libraries,
// which are not in namespace shoal, are free.
std::string ExpectedShape(const SourceName& name) {
  static const std::regex camel_case("[A-Z][A-Za-z0-9]*"), constant("k[A-Z0-9][A-Za-z0-9]*"),
      snake_case("[a-z][a-z0-9_]*"), macro("[A-Z][A-Z0-9_]*"), hook("operator .*|(to|from)_json"),
      test_class("[A-Za-z0-9_]*_Test");
  const auto matches = [&](const std::regex& shape) { return std::regex_match(name.name, shape); };
  if (name.kind == NameKind::kMacro) return matches(macro) ? "" : "UPPER_CASE";
  if (!name.scope.starts_with("shoal")) return "";
  switch (name.kind) {
    case NameKind::kFunction:
      // A constant with its value in brackets, and an annotation of a type, look like functions.
      return matches(camel_case) || matches(hook) || matches(constant) || matches(macro)
                 ? ""
                 : "CamelCase";
    case NameKind::kType:
      return matches(camel_case) || matches(test_class) ? "" : "CamelCase";
    case NameKind::kValue:
      return matches(constant) || matches(snake_case) ? "" : "kConstant or snake_case";
    default:
      return "";
  }
}

std::vector<std::string> MisspelledNames(const std::string& file, std::string_view text) {
  std::vector<std::string> faults;
  for (const SourceName& name : NamesOf(text)) {
    const std::string shape = ExpectedShape(name);
    if (shape.empty()) continue;
    faults.push_back(fmt::format("{}:{}: {}: expected {}", file, name.line, name.name, shape));
  }
  return faults;
}

bool IsArithmeticType(std::string_view text) {
  static constexpr std::array kTypes = {"bool",     "char",    "double",   "float",    "int",
                                        "int16_t",  "int32_t", "int64_t",  "int8_t",   "long",
                                        "short",    "size_t",  "ssize_t",  "uint16_t", "uint32_t",
                                        "uint64_t", "uint8_t", "unsigned", "ptrdiff_t"};
  return std::ranges::find(kTypes, text) != kTypes.end();
}

// (float) x: brackets that contain only a type, followed by a possible operand of a cast.
std::vector<std::string> CStyleCasts(const std::string& file, std::string_view text) {
  std::vector<std::string> faults;
  const std::vector<SourceToken> tokens = ReadSource(text).tokens;
  for (size_t i = 1; i + 3 < tokens.size(); ++i) {
    if (tokens[i].text != "(" || !IsArithmeticType(tokens[i + 1].text)) continue;
    if (tokens[i + 2].text != ")") continue;
    const std::string &before = tokens[i - 1].text, &behind = tokens[i + 3].text;
    // Parameters without a name follow a name: int Get(int) const, std::function<void(int)>.
    if ((tokens[i - 1].IsIdentifier() && before != "return") || before == ">" || before == "]" ||
        before == ")" || before == "*") {
      continue;
    }
    if (behind == ";" || behind == "," || behind == ")" || behind == "{" || behind == ">") continue;
    faults.push_back(fmt::format("{}:{}: ({}) {}: expected static_cast<{}>", file, tokens[i].line,
                                 tokens[i + 1].text, behind, tokens[i + 1].text));
  }
  return faults;
}

// Spellings of casts of numbers: T(x) and static_cast<T>(x). T{x} is checked by the compiler.
struct Casts {
  int as_function = 0, as_static_cast = 0;
};

// Position of the bracket that closes the one at `open`.
size_t ClosingBracket(const std::vector<SourceToken>& tokens, size_t open) {
  int depth = 0;
  for (size_t i = open; i < tokens.size(); ++i) {
    if (tokens[i].text == "(") ++depth;
    if (tokens[i].text == ")" && --depth == 0) return i;
  }
  return tokens.size();
}

// At `i`, int(x): neither int() nor the type of a function, as in std::function<int(bool)>, nor a
// declarator.
bool IsFunctionalCast(const std::vector<SourceToken>& tokens, size_t i) {
  if (i + 2 >= tokens.size() || !IsArithmeticType(tokens[i].text)) return false;
  if (tokens[i + 1].text != "(" || tokens[i + 2].text == ")") return false;
  // Behind a name: long int(...), operator bool(...).
  if (i > 0 && tokens[i - 1].IsIdentifier()) {
    static constexpr std::array kBeforeValues = {"case", "else", "return"};
    if (std::ranges::find(kBeforeValues, tokens[i - 1].text) == kBeforeValues.end()) return false;
  }
  const size_t close = ClosingBracket(tokens, i + 1);
  const std::string_view behind =
      close + 1 < tokens.size() ? std::string_view(tokens[close + 1].text) : std::string_view();
  // int (*f)(), int (&array)[2]
  if (behind == "(" || behind == "[") return false;
  const bool is_type = i > 0 && tokens[i - 1].text == "<" && behind == ">";
  return !is_type;
}

Casts CastsOf(std::string_view text) {
  Casts casts;
  const std::vector<SourceToken> tokens = ReadSource(text).tokens;
  for (size_t i = 0; i < tokens.size(); ++i) {
    casts.as_function += IsFunctionalCast(tokens, i) ? 1 : 0;
    if (tokens[i].text != "static_cast") continue;
    const bool is_qualified = i + 5 < tokens.size() && tokens[i + 2].text == "std";
    const size_t type = i + (is_qualified ? 4 : 2);
    // static_cast<unsigned char>(x) has no other spelling.
    casts.as_static_cast += type + 1 < tokens.size() && IsArithmeticType(tokens[type].text) &&
                                    tokens[type + 1].text == ">"
                                ? 1
                                : 0;
  }
  return casts;
}

std::vector<std::string> MixedCasts(const std::string& file, std::string_view text) {
  const Casts casts = CastsOf(text);
  if (casts.as_function == 0 || casts.as_static_cast == 0) return {};
  return {
      fmt::format("{}: {} casts of numbers as T(x), {} as static_cast<T>(x): expected one "
                  "spelling in a file",
                  file, casts.as_function, casts.as_static_cast)};
}

using Rule = std::vector<std::string> (*)(const std::string& file, std::string_view text);

// Faults of all sources of the tree.
std::vector<std::string> FaultsOfTheTree(Rule rule) {
  std::vector<std::string> faults;
  int files = 0;
  const fs::path root = SourcePath("");
  for (const char* top : {"actor", "common", "launch", "learner", "replay_server", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      std::ranges::copy(rule(entry.path().lexically_relative(root), ReadFile(entry.path())),
                        std::back_inserter(faults));
    }
  }
  EXPECT_GT(files, 1000);
  return faults;
}

TEST(CodeShape, FunctionsHaveAtMostSixtyLines) {
  EXPECT_THAT(FaultsOfTheTree(LongFunctions), IsEmpty());
}

TEST(CodeShape, NamesAreSpelledByTheirKind) {
  EXPECT_THAT(FaultsOfTheTree(MisspelledNames), IsEmpty());
}

TEST(CodeShape, NumbersAreNotCastAsInC) { EXPECT_THAT(FaultsOfTheTree(CStyleCasts), IsEmpty()); }

TEST(CodeShape, AFileSpellsCastsOfNumbersInOneWay) {
  EXPECT_THAT(FaultsOfTheTree(MixedCasts), IsEmpty());
}

// A body of `lines` lines, with its braces.
std::string Body(int lines) {
  std::string text = "{\n";
  for (int line = 2; line < lines; ++line) text += "  Do();\n";
  return text + "}\n";
}

TEST(CodeShape, LongFunctionsAreFoundInNamespacesAndTypes) {
  const std::string is_too_long = " has 61 lines, at most 60 are allowed: split it";
  EXPECT_THAT(LongFunctions("a.cpp", "namespace a {\nint F(int b) " + Body(60) +
                                         "int A::G() const " + Body(61) + "}\n"),
              ElementsAre("a.cpp:62: A::G" + is_too_long));
  EXPECT_THAT(LongFunctions("a.h",
                            "template <class T = int>\nclass A : public B<T> {\n public:\n"
                            "  A() : b_{1}, c_(2) " +
                                Body(61) + "  int operator()(int) const " + Body(61) +
                                "  std::map<int, int> d_{{1, 2}};\n};\n"),
              ElementsAre("a.h:4: A()" + is_too_long, "a.h:65: operator()" + is_too_long));
  EXPECT_THAT(LongFunctions("a.cpp", "extern \"C\" {\nTEST(B, c) " + Body(61) + "}\n"),
              ElementsAre("a.cpp:2: TEST(B, c)" + is_too_long));
}

TEST(CodeShape, TablesAndTextsCountAsOneLine) {
  std::string table = "{\n  static const int kTable[] = {\n", text = "{\n  Say(R\"(\n";
  for (int i = 0; i < 80; ++i) table += "      {1, F(2)},\n", text += "line\n";
  EXPECT_THAT(LongFunctions("a.cpp", "void F() " + table + "  };\n}\n"), IsEmpty());
  EXPECT_THAT(LongFunctions("a.cpp", "void F() " + text + ")\");\n}\n"), IsEmpty());
  EXPECT_THAT(LongFunctions("a.cpp", "void F() {\n  if (a) " + Body(62) + "}\n").size(), 1u)
      << "a block is no table";
}

TEST(CodeShape, NamesOfEachKindAreFound) {
  EXPECT_THAT(MisspelledNames(
                  "a.cpp",
                  "#define Bad(x) x\n#define GOOD 1\nextern \"C\" int their_name();\n"
                  "namespace shoal {\nint bad_function();\nint Good();\nclass bad_type;\n"
                  "struct Good2 { int member_; };\nconst int BAD = 1;\nconstexpr int kGood = 1;\n"
                  "template <class T>\nconcept Good3 = true;\n"
                  "int good_variable = 2;\nbool operator==(Good2 a, Good2 b);\n}\n"),
              ElementsAre("a.cpp:5: bad_function: expected CamelCase",
                          "a.cpp:7: bad_type: expected CamelCase",
                          "a.cpp:9: BAD: expected kConstant or snake_case",
                          "a.cpp:1: Bad: expected UPPER_CASE"));
}

TEST(CodeShape, CastsOfCAreFoundAndParametersWithoutANameAreNot) {
  EXPECT_THAT(CStyleCasts("a.cpp",
                          "int a = (int)b;\nreturn (float)(c);\nf(1, (size_t) -1);\n"
                          "int Get(int) const;\nauto g = [](int) { return 1; };\n"
                          "std::function<void(int)> h; void (*p)(int) = q; sizeof(int) * 2;\n"),
              ElementsAre("a.cpp:1: (int) b: expected static_cast<int>",
                          "a.cpp:2: (float) (: expected static_cast<float>",
                          "a.cpp:3: (size_t) -: expected static_cast<size_t>"));
}

TEST(CodeShape, BothSpellingsOfACastInOneFileAreFound) {
  EXPECT_THAT(MixedCasts("a.cpp", "auto a = int(b);\nauto c = static_cast<std::size_t>(d);\n"),
              ElementsAre("a.cpp: 1 casts of numbers as T(x), 1 as static_cast<T>(x): expected one "
                          "spelling in a file"));
  EXPECT_THAT(MixedCasts("a.cpp", "if (a < float(b)) return std::ptrdiff_t(c);\n"), IsEmpty());
  EXPECT_THAT(MixedCasts("a.cpp",
                         "auto a = static_cast<int>(b);\nstd::function<int(bool)> c;\n"
                         "explicit operator bool() const;\nint (*f)(bool), (&g)[2];\nauto d = "
                         "size_t{3} + int();\n"),
              IsEmpty());
  EXPECT_THAT(MixedCasts("a.cpp",
                         "auto a = int(b);\nauto c = static_cast<unsigned char>(d);\n"
                         "auto e = static_cast<Kind>(f);\n"),
              IsEmpty());
}

}  // namespace
}  // namespace shoal
