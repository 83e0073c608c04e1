#include "launch/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/launch/experiment/planted_run.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RunPlanter Plant(const std::filesystem::path& folder) {
  const RunPlanter planter(folder);
  planter.Begin();
  planter.WriteEvaluation(100, 0.5);
  planter.WriteEvaluation(200, 0.95);
  planter.WriteEvaluation(300, 0.95);
  planter.WriteFinal(1, 100);
  planter.WriteMeta("budget");
  return planter;
}

TEST(Report, IsOnePageThatNeedsNothingElse) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "needs gnuplot";
  const TemporaryFolder folder;
  Plant(folder.path() / "a");
  MakeFolders(folder.path() / "a/videos");
  std::ofstream(folder.path() / "a/videos/film.mp4") << "Man";
  const std::string html =
      ReportHtml(GatherReport({.names = {"a"}, .run_dir = folder.path().string()}));
  for (const char* part :
       {"100.0 % [96.3, 100.0] (100/100)", "<svg", "&quot;batch&quot;: ", "abc, def",
        "a fast one (2 cores)", "shoal train --config", "data:video/mp4;base64,TWFu"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  for (const char* link : {"<script", "src=\"http", "<link", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(link)));
  }
}

TEST(Report, WhatComesFromOutsideIsEscaped) {
  ReportContent content{.title = "<b>", .question = "a & \"b\""};
  content.comparison.groups.push_back({.name = "<script>x</script>"});
  const std::string html = ReportHtml(content);
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, HasSubstr("a &amp; &quot;b&quot;"));
}

TEST(Report, NamesWhatIsMissing) {
  ReportContent content{.title = "t"};
  content.comparison.groups.push_back({.name = "a", .unevaluated = {"a-s3"}});
  EXPECT_THAT(ReportHtml(content), HasSubstr("Missing: a-s3."));
}

}  // namespace
}  // namespace shoal::launch
