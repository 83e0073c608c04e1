// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/language.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/docs/language_allowance.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// "LINE RULE TEXT" of each fault.
std::vector<std::string> Faults(const std::string& file, const std::string& text) {
  std::vector<std::string> faults;
  for (const LanguageFault& fault :
       LanguageFaultsOf(file, text, {"docs/page.md", "common/base/error.h"})) {
    faults.push_back(fmt::format("{} {} {}", fault.line, fault.rule, fault.text));
  }
  return faults;
}

TEST(Language, NoFileHasMoreFaultsThanItIsAllowed) {
  const FaultsByFile faults = FindLanguageFaults(SourcePath(""));
  const LanguageAllowance allowance =
      ReadAllowance(ReadFile(SourcePath("tests/docs/language_allowance.txt")));
  const std::vector<std::string> differences = Differences(allowance, faults, SourcePath(""));
  EXPECT_TRUE(differences.empty()) << fmt::format(
      "{}\nThe rules: tests/docs/language.h and "
      "docs/decisions/0021-faults-of-language-only-become-fewer.md.\n",
      fmt::join(differences, "\n"));
}

TEST(Language, ACommentOpensWithItsSubject) {
  EXPECT_THAT(
      Faults("a.cpp",
             "// SPDX-License-Identifier: Apache-2.0\n// What a file is.\n// Where it goes "
             "on, in one paragraph.\n//\n// As a new paragraph.\n\nint a;  // Of a line\n"
             "// A good start. What follows is fine.\n// With the second line\n"
             "call(\"// What\");\nint b;\n  // Whoever calls.\n// Whatever\n"),
      ElementsAre("2 opening What a file is.", "5 opening As a new paragraph.",
                  "7 opening Of a line", "12 opening Whoever calls.", "12 phrase \"whoever\""));
  EXPECT_THAT(Faults("run", "#!/usr/bin/env bash\n# Where it is.\nx=1  # With a value\n"),
              ElementsAre("2 opening Where it is.", "3 opening With a value"));
  EXPECT_THAT(Faults("docs/a.md", "# What it is\nAs text.\n"), IsEmpty()) << "headings and pages";
}

TEST(Language, PhrasesAreFoundInCommentsTextsAndPages) {
  EXPECT_THAT(Faults("a.cpp",
                     "// Nobody waits.\nThrow(\"the one who is told\");\n"
                     "// a file that lies\n// in a folder\nint anybody = nobody_s;\n"),
              ElementsAre("1 phrase \"nobody\"", "2 phrase \"is told\"", "3 phrase \"lies in\""));
  EXPECT_THAT(Faults("docs/a.md", "It goes by\nthe former.\n```\nnobody\n```\n"),
              ElementsAre("1 phrase \"goes by\"", "2 phrase \"the former\""));
}

TEST(Language, LinesOfPagesThatCouldWrapAreNotTooWide) {
  const std::string wide(101, 'x'), words = "two words " + wide.substr(10);
  EXPECT_THAT(Faults("docs/a.md", words + "\n" + words.substr(1) + "\n| " + words + " |\n```\n" +
                                      words + "\n```\n- " + wide + "\n<img " + words + ">\n"),
              ElementsAre("1 width 101 columns"));
  std::string umlauts = "two ";
  for (int i = 0; i < 96; ++i) umlauts += "\u00e4";
  EXPECT_THAT(Faults("docs/a.md", umlauts), IsEmpty()) << "100 columns, 196 bytes";
  EXPECT_THAT(Faults("a.cpp", "// " + words), IsEmpty()) << "clang-format sees to sources";
}

TEST(Language, FilesThatAreNamedExist) {
  EXPECT_THAT(Faults("a.cpp",
                     "// error.h, base/error.h (docs/page.md).\n// See old/page.md.\n"
                     "#include \"gone.h\"\nint a;  // gone.h, config.json, 1.h, x.hpp\n"
                     "// https://example.org/formats.md\n"),
              ElementsAre("2 reference old/page.md", "4 reference gone.h"));
  EXPECT_THAT(Faults("docs/a.md", "`gone.cpp` and [p](page.md), [q](../common/base/error.h)\n"),
              ElementsAre("1 reference gone.cpp"));
}

TEST(Language, ADifferenceNamesTheLinesOrTheCommand) {
  const TemporaryFolder no_repository;
  const FaultsByFile faults = {{"a.cpp", {{"phrase", 3, "x"}, {"phrase", 7, "y"}}},
                               {"new.cpp", {{"opening", 1, "What"}}}};
  const LanguageAllowance allowance = {{"a.cpp", {{"opening", 2}, {"phrase", 1}}}};
  EXPECT_THAT(
      Differences(allowance, faults, no_repository.path()),
      ElementsAre(
          AllOf(HasSubstr("2 faults of 'phrase', allowed are 1"), HasSubstr("Change 1 of these"),
                HasSubstr("a.cpp:3: x"), HasSubstr("a.cpp:7: y")),
          AllOf(HasSubstr("1 faults of 'opening', allowed are 0"), HasSubstr("new.cpp:1: What")),
          AllOf(HasSubstr("a.cpp: 0 faults of 'opening', allowed are 2"),
                HasSubstr("shoal-language --lower"))));
}

TEST(Language, TheYoungestLinesAreNamedWhereGitKnowsThem) {
  const TemporaryFolder repository;
  const std::string git = "git -C '" + repository.path().string() + "' ";
  const std::string identity = "-c user.name=a -c user.email=a@example.org ";
  const auto run = [](const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str());
  };
  WriteFileAtomically(repository.path() / "a.md", "old one\nold two\n");
  ASSERT_EQ(run(git + "init"), 0);
  ASSERT_EQ(run(git + "add a.md"), 0);
  ASSERT_EQ(run(git + identity + "commit -m a"), 0);
  WriteFileAtomically(repository.path() / "a.md", "old one\nnew\nold two\n");
  const FaultsByFile faults = {
      {"a.md", {{"phrase", 1, "x"}, {"phrase", 2, "y"}, {"phrase", 3, "z"}}}};
  EXPECT_THAT(Differences({{"a.md", {{"phrase", 2}}}}, faults, repository.path()),
              ElementsAre(AllOf(HasSubstr("a.md:2: y"), Not(HasSubstr("a.md:1")),
                                Not(HasSubstr("a.md:3")))));
}

TEST(Language, AllowancesOnlyBecomeLower) {
  const LanguageAllowance allowance = {{"a", {{"width", 3}, {"phrase", 1}}},
                                       {"gone", {{"width", 1}}}};
  const LanguageAllowance counts = {{"a", {{"width", 2}, {"phrase", 4}, {"opening", 1}}},
                                    {"new", {{"width", 9}}}};
  const LanguageAllowance lowered = {{"a", {{"width", 2}, {"phrase", 1}}}};
  EXPECT_EQ(Lowered(allowance, counts), lowered);
  EXPECT_EQ(ReadAllowance(AllowanceText(allowance)), allowance);
  EXPECT_THROW(ReadAllowance("a width\n"), Error);
  EXPECT_THROW(ReadAllowance("a width 0\n"), Error);
  EXPECT_THROW(ReadAllowance("a\n"), Error);
}

}  // namespace
}  // namespace shoal
