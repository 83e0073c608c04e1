// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PageParts, ThePageIsBuiltInAsItIsWritten) {
  const auto parts = LoadPageParts();
  for (const char* file :
       {"index.html", "style.css", "page.js", "charts.js", "steering.js", "requests.js"}) {
    EXPECT_TRUE(parts.at(file).content == ReadFile(SourcePath("launch/tools/web/pages/") + file))
        << file;
  }
  EXPECT_GT(parts.at("dygraph.min.js").content.size(), 10'000u);
}

TEST(PageParts, NothingComesFromElsewhere) {
  for (const auto& [name, part] : LoadPageParts()) {
    if (name.starts_with("dygraph")) continue;  // names its own site in comments
    for (const char* elsewhere : {"http:", "https:", "src=\"//", "@import", "innerHTML", "eval("}) {
      EXPECT_THAT(part.content, Not(HasSubstr(elsewhere))) << name;
    }
  }
}

TEST(PageParts, AMissingLibraryIsNamedWithItsPackage) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "dygraph.min.js") << "x";
  const std::string message = ErrorMessage([&] { LoadPageParts(folder.path()); });
  EXPECT_THAT(message, HasSubstr((folder.path() / "dygraph.min.css").string()));
  EXPECT_THAT(message, HasSubstr("apt-get install libjs-dygraphs"));
}

}  // namespace
}  // namespace shoal::launch
