// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/bench_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/base/files.h"
#include "tests/benchmark/bench_page.h"
#include "tests/benchmark/scale_model.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"

namespace shoal::bench {
namespace {

using testing::HasSubstr;

// A file with these rows, a comma between each two.
std::string File(const std::string& rows) {
  return R"({"schema": "shoal-bench-1", "commit": "abc",
             "machine": {"cpu": "X", "cores": 2, "isa": "avx"}, "rows": [)" +
         rows + "]}";
}

std::string RowText(const std::string& stage, double figure) {
  return R"({"stage": ")" + stage + R"(", "unit": "u/s", "against": "b", "figure": )" +
         std::to_string(figure) + R"(, "against_figure": 8, "ratio": 0.5, "target": 0.8,
                                      "spread": 0.1})";
}

Report OneRow(double figure, const std::string& stage = "s") {
  return ParseReport(File(RowText(stage, figure)), "file");
}

TEST(BenchReport, ATableSaysWhichLimitsAreMissed) {
  const Report report = ParseReport(
      File(RowText("slow", 4) + R"(, {"stage": "share", "unit": "of a core", "against": "nothing",
                                      "figure": 0.04, "at_most": 0.05, "target": null})"),
      "file");
  const std::string table = MarkdownTable(report);
  EXPECT_THAT(table,
              HasSubstr("| slow | 4.00 u/s | b (8.00) | 0.50 | 0.80: **missed** | 0.10 |\n"));
  EXPECT_THAT(table, HasSubstr("| share | 0.0400 of a core | nothing |  | at most 0.0500 |  |\n"));
}

TEST(BenchReport, WhatIsNoReportIsNamed) {
  for (const std::string text :
       {"", "[]", "{}", R"({"schema": "shoal-bench-2", "rows": []})",
        R"({"schema": "shoal-bench-1", "commit": 1, "machine": {}, "rows": []})"}) {
    EXPECT_THAT(ErrorMessage([&] { ParseReport(text, "odd.json"); }), HasSubstr("odd.json"))
        << text;
  }
  EXPECT_THAT(ErrorMessage([] { ParseReport(File(R"({"stage": "s"})"), "odd.json"); }),
              HasSubstr("odd.json"));
}

TEST(BenchPage, APageKeepsAllButWhatStandsBetweenItsMarks) {
  const std::string page =
      "before\n<!-- bench a.json: fast -->\nold\n<!-- end of bench -->\nafter\n";
  const auto read = [](const std::string& file) {
    EXPECT_EQ(file, "a.json");
    return File(RowText("fast one", 4) + "," + RowText("other", 4));
  };
  const std::string once = RewritePage(page, read);
  EXPECT_THAT(once, testing::StartsWith("before\n<!-- bench a.json: fast -->\n\nCommit abc, X, 2 "
                                        "cores, avx.\n[File](a.json).\n\n| stage"));
  EXPECT_THAT(once, testing::EndsWith("<!-- end of bench -->\nafter\n"));
  EXPECT_THAT(once, HasSubstr("fast one"));
  EXPECT_EQ(once.find("other"), std::string::npos);
  EXPECT_EQ(once.find("old"), std::string::npos);
  EXPECT_EQ(RewritePage(once, read), once);
}

TEST(BenchPage, RowsOfSeveralTextsKeepTheirOrder) {
  const auto read = [](const std::string&) {
    return File(RowText("one", 4) + "," + RowText("two", 4) + "," + RowText("three", 4));
  };
  const std::string page =
      RewritePage("<!-- bench a.json: three; one -->\n<!-- end of bench -->\n", read);
  EXPECT_LT(page.find("| one"), page.find("| three"));
  EXPECT_NE(page.find("| three"), std::string::npos);
  EXPECT_EQ(page.find("| two"), std::string::npos);
  EXPECT_THAT(ErrorMessage([&] {
                RewritePage("<!-- bench a.json: one; four -->\n<!-- end of bench -->\n", read);
              }),
              HasSubstr("'a.json' has no row 'four'"));
}

TEST(BenchPage, MarksWithoutPartnersAndRowsThatAreNotThereAreNamed) {
  const auto read = [](const std::string&) { return File(RowText("s", 4)); };
  const auto fault = [&](const std::string& page) {
    return ErrorMessage([&] { RewritePage(page, read); });
  };
  EXPECT_THAT(fault("<!-- bench a.json -->\n"), HasSubstr("has no '<!-- end of bench -->'"));
  EXPECT_THAT(fault("<!-- bench a.json -->\n<!-- bench a.json -->\n<!-- end of bench -->\n"),
              HasSubstr("has no '<!-- end of bench -->'"));
  EXPECT_THAT(fault("<!-- end of bench -->\n"), HasSubstr("ends nothing"));
  EXPECT_THAT(fault("<!-- bench a.json: t -->\n<!-- end of bench -->\n"),
              HasSubstr("'a.json' has no row 't'"));
}

TEST(BenchReport, CommitsAreComparedRepetitionByRepetition) {
  // Ratios 2, 3 and 1: the machine's speed, which halves in the second, does not matter.
  const Report ours[] = {OneRow(20), OneRow(15), OneRow(10)};
  const Report theirs[] = {OneRow(10), OneRow(5), OneRow(10)};
  const auto rows = Compare(ours, theirs);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_DOUBLE_EQ(rows[0].ratio, 2);
  EXPECT_DOUBLE_EQ(rows[0].spread, 1);
  EXPECT_DOUBLE_EQ(rows[0].ours, 15);
  EXPECT_DOUBLE_EQ(rows[0].theirs, 10);
}

TEST(BenchReport, OnlyRowsThatBothCommitsHaveAreCompared) {
  const Report ours[] = {OneRow(20, "new")}, theirs[] = {OneRow(20, "old")};
  EXPECT_TRUE(Compare(ours, theirs).empty());
}

TEST(BenchPage, PagesAreWhatTheirFilesSay) {
  const std::filesystem::path docs = SourcePath("docs");
  for (const char* name : {"performance.md", "performance_tables.md", "scale.md"}) {
    const std::string page = ReadFile(docs / name);
    const std::string anew =
        RewritePage(page, [&](const std::string& file) { return ReadFile(docs / file); });
    EXPECT_EQ(anew, page) << "shoal-bench-report tables docs/" << name;
    EXPECT_THAT(page, HasSubstr("<!-- bench "));
  }
}

constexpr ScaleConstants kRound{.actor_rate = 1000,
                                .intake = 1e-5,
                                .gather = 1e-3,
                                .handover_near = 0,
                                .handover_far = 1e-9,
                                .update = 0.01};

TEST(ScaleModel, LoadsAreThoseOfTheFormula) {
  // 16 samples of 128 for each of 1000 transitions: 125 batches a second of 5.42 MB.
  const ScaleLoad near = LoadOf(kRound, 1000, 16, false);
  EXPECT_NEAR(near.replay, 0.01 + 125 * 1e-3, 1e-12);
  EXPECT_NEAR(near.learner, 1.25, 1e-12);
  EXPECT_EQ(near.link_out, 0);
  const ScaleLoad far = LoadOf(kRound, 1000, 16, true);
  EXPECT_NEAR(far.replay - near.replay, 125 * 256 * 21168e-9, 1e-9);
  EXPECT_NEAR(far.link_out, 125 * 256 * 21168 / 1.25e9, 1e-9);
  EXPECT_GT(far.link_in, 1000 * 21168 / 1.25e9);
}

TEST(ScaleModel, ARowThatNoFileHasIsNamed) {
  const Report reports[] = {OneRow(1)};
  EXPECT_THAT(ErrorMessage([&] { ReadScaleConstants(reports); }),
              HasSubstr("none of the files has a row"));
}

TEST(ScaleModel, TheMostExceededIsTheNextLimit) {
  // 16 actors of 1000: 2000 batches a second with 64 samples per insert.
  EXPECT_THAT(ScaleTables(kRound), HasSubstr("| 16 | 8 | 16000 |"));
  EXPECT_THAT(ScaleTables(kRound), HasSubstr("80 learner cores"));
}

}  // namespace
}  // namespace shoal::bench
