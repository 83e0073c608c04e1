// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/grouped_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two sources of the target "room".
class Pair {
 public:
  Pair(const std::string& first, const std::string& second) {
    Write("a.cpp", first);
    Write("b.cpp", second);
  }
  void Write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_.path() / file) << text;
  }
  std::vector<std::string> Collisions() const {
    return FindCollisions(folder_.path(), {{"room", {"a.cpp", "b.cpp"}}});
  }

 private:
  TemporaryFolder folder_;
};

// Collisions of two sources with these texts in the unnamed namespace of `shoal`.
std::vector<std::string> Unnamed(const std::string& first, const std::string& second) {
  const std::string start = "namespace shoal {\nnamespace {\n", end = "\n}\n}\n";
  return Pair(start + first + end, start + second + end).Collisions();
}

TEST(GroupedNames, SourcesOfATargetHaveNamesOfTheirOwn) {
  const GroupedSources targets = ReadGroupedSources(ProgramPath("../grouped_sources.txt"));
  ASSERT_GT(targets.size(), 60u);
  ASSERT_TRUE(targets.contains("shoal_rl")) << "which most builds leave out";
  ASSERT_FALSE(targets.contains("shoal_acting")) << "which is never compiled in groups";
  EXPECT_THAT(FindCollisions(SourcePath(""), targets), IsEmpty())
      << "rename one of each pair, or let both use one definition: a build without a compiler "
         "cache "
         "compiles them as one source (docs/decisions/0016)";
}

TEST(GroupedNames, EachKindOfNameIsFound) {
  const std::vector<std::string> both = {"room: X in a.cpp:3 and b.cpp:3"};
  EXPECT_EQ(Unnamed("int X() { return 1; }", "int X() { return 2; }"), both);
  EXPECT_EQ(Unnamed("struct X { int a; };", "class X;"), both);
  EXPECT_EQ(Unnamed("enum { W, X };", "constexpr std::array<int, 2> W2 = {1, 2}, X = {};"), both);
  EXPECT_EQ(Unnamed("using X = int;", "using X = float;"), both);
  EXPECT_EQ(Unnamed("template <typename T> T X(T t) { return t; }", "const auto X = [] {}; "),
            both);
  EXPECT_EQ(Unnamed("TEST(A, B) {} MATCHER_P(X, y, \"\") { return true; }", "struct {} X[2];"),
            both);
  EXPECT_EQ(
      Unnamed("std::map<std::string, int> X{{\"}\", '}'}};", "A::B (*X)[2];\nint X = 1 << 2;"),
      std::vector<std::string>{"room: X in a.cpp:3 and b.cpp:4"});
  EXPECT_EQ(Unnamed("#define X 1", "#define X 2"), both);
}

TEST(GroupedNames, OverloadsCollideAsTheirPointersAreAmbiguous) {
  EXPECT_THAT(Unnamed("int F(int a) { return a; }", "int F(const char*) { return 0; }"),
              ElementsAre("room: F in a.cpp:3 and b.cpp:3"));
  EXPECT_THAT(Unnamed("bool operator==(A, A) { return true; }\nvoid PrintTo(A, int*) {}",
                      "bool operator==(B, B) { return true; }\nvoid PrintTo(B, int*) {}"),
              IsEmpty());
}

TEST(GroupedNames, WhatSaysTheSameTwiceIsNoCollision) {
  const std::string same =
      "namespace fs = std::filesystem;\nusing nlohmann::json;\nusing Floats = std::vector<float>;\n"
      "#define X 1\n";
  EXPECT_THAT(Unnamed(same, same), IsEmpty());
  EXPECT_THAT(Unnamed("using ::testing::Each;", "using testing::Each;"), IsEmpty());
  EXPECT_THAT(Unnamed("using a::Each;", "using b::Each;"),
              ElementsAre("room: Each in a.cpp:3 and b.cpp:3"));
  EXPECT_THAT(Unnamed("#define X 1\n#undef X", "#define X 2"), IsEmpty());
}

TEST(GroupedNames, OtherScopesAndMembersDoNotMeet) {
  EXPECT_THAT(Pair("namespace a { namespace { int F() { return 1; } } }",
                   "namespace b { namespace { int F() { return 1; } } }")
                  .Collisions(),
              IsEmpty());
  EXPECT_THAT(
      Unnamed("struct A { int F(); static constexpr int kX = 1; };\nint A::F() { return 1; }",
              "struct B { int F(); };\nint B::F() { return 1; }\nconstexpr int kX = 2;"),
      IsEmpty());
  EXPECT_THAT(Pair("int F() { return 1; }", "int F(int) { return 1; }").Collisions(), IsEmpty());
}

TEST(GroupedNames, TypesAndConstantsNeedNoUnnamedNamespaceToCollide) {
  EXPECT_THAT(Pair("struct S { int a; };\nconst int kX = 1;\nstatic void F() {}",
                   "struct S { char a; };\nconst int kX = 1;\nstatic void F() {}")
                  .Collisions(),
              ElementsAre("room: F in a.cpp:3 and b.cpp:3", "room: S in a.cpp:1 and b.cpp:1",
                          "room: kX in a.cpp:2 and b.cpp:2"));
}

TEST(GroupedNames, AnUnnamedNameMayNotHideWhatTheOthersHeadersDeclare) {
  const Pair pair("#include \"a.h\"\nnamespace shoal { int G() { return F(); } }",
                  "namespace shoal {\nnamespace { int F() { return 1; } }\n}");
  pair.Write("a.h", "#include \"inner.h\"\n");
  pair.Write("inner.h", "namespace shoal { int F(); }\n");
  EXPECT_THAT(pair.Collisions(), ElementsAre("room: F in b.cpp:2 and inner.h:1"));
  pair.Write("b.cpp", "#include \"inner.h\"\nnamespace shoal { namespace { int F(int) {} } }");
  EXPECT_THAT(pair.Collisions(), IsEmpty()) << "it compiles alone with that header";
}

TEST(GroupedNames, AVariableInLowerCaseIsNamedNowhereElse) {
  EXPECT_THAT(Unnamed("int expected = 0;\nvoid F() { expected = 1; }",
                      "void G(int a) {\n  const int expected = a;\n}"),
              ElementsAre("room: expected in a.cpp:3 and b.cpp:4"));
  EXPECT_THAT(Unnamed("int expected = 0;", "void G(A* a) { a->expected = a->b.expected; }"),
              IsEmpty());
}

TEST(GroupedNames, ALocalConstantMayNotShadowAnothersConstant) {
  EXPECT_THAT(Unnamed("constexpr int kX = 1;",
                      "int F(int a) {\n  constexpr int kX = 2;\n"
                      "  return a > kX ? kX : a;\n}"),
              ElementsAre("room: kX in a.cpp:3 and b.cpp:4"));
  EXPECT_THAT(Unnamed("constexpr int kX = 1;", "int F() { return kY * kX; }"), IsEmpty());
}

}  // namespace
}  // namespace shoal
