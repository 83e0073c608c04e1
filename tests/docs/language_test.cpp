// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/language.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/paths.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// "LINE RULE TEXT" of each fault.
std::vector<std::string> Faults(const std::string& file, const std::string& text) {
  std::vector<std::string> faults;
  for (const LanguageFault& fault :
       LanguageFaultsOf(file, text, {"docs/page.md", "common/base/error.h"})) {
    faults.push_back(fmt::format("{} {} {}", fault.line, fault.rule, fault.text));
  }
  return faults;
}

TEST(Language, TheTreeHasNoFaults) {
  std::string faults;
  for (const auto& [file, found] : FindLanguageFaults(SourcePath(""))) {
    for (const LanguageFault& fault : found) {
      faults += fmt::format("{}:{}: {}: {}\n", file, fault.line, fault.rule, fault.text);
    }
  }
  EXPECT_EQ(faults, "") << "The rules: tests/docs/language.h and "
                           "docs/decisions/0021-plain-english-is-tested.md.";
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

}  // namespace
}  // namespace shoal
