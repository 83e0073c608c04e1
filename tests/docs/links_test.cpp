// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// Faults of a page docs/a.md of this text, beside docs/b.md and a file.
std::vector<std::string> Faults(const std::string& text) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "docs");
  std::ofstream(folder.path() / "docs/b.md");
  std::ofstream(folder.path() / "docs/a.md");
  std::ofstream(folder.path() / "file.cpp");
  return LinkFaults(folder.path(), {ParsePage("docs/a.md", text),
                                    ParsePage("docs/b.md", "# One\n## `shoal top`, 2nd\n# One\n")});
}

TEST(DocsLinks, EveryLinkOfThePagesLeadsSomewhere) {
  const std::vector<Page> pages = ReadPages(SourcePath(""));
  size_t links = 0;
  for (const Page& page : pages) links += page.links.size();
  ASSERT_GT(pages.size(), 20u);
  ASSERT_GT(links, 150u);
  EXPECT_THAT(LinkFaults(SourcePath(""), pages), IsEmpty());
}

TEST(DocsLinks, FilesPagesAndHeadingsAreFound) {
  EXPECT_THAT(Faults("[a](b.md), [b](../file.cpp) [c](b.md#one) [d](b.md#shoal-top-2nd)\n"
                     "[e](b.md#one-1) [f](#here) [g](https://nowhere.example/x.md#y)\n# Here\n"),
              IsEmpty());
}

TEST(DocsLinks, WhatIsNotThereIsNamedWithItsLine) {
  EXPECT_THAT(
      Faults("\n[a](c.md)\n[b](b.md#two)\n[c](#gone)\n<img src=\"no.png\" width=\"1\">\n"),
      ElementsAre("docs/a.md:2: no 'c.md'", "docs/a.md:3: docs/b.md has no heading '#two'",
                  "docs/a.md:4: docs/a.md has no heading '#gone'", "docs/a.md:5: no 'no.png'"));
}

TEST(DocsLinks, WhatStandsInCodeIsNoLink) {
  EXPECT_THAT(Faults("`[a](c.md)`\n```python\nx[1](c.md)\n# y\n```\n"), IsEmpty());
  EXPECT_THAT(Faults("```\n# Heading\n```\n[a](#heading)\n"), SizeIs(1));
}

}  // namespace
}  // namespace shoal
