// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/top_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "launch/watch/run_figures.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

MetricsMessage Process(const std::string& role, uint32_t id,
                       const std::vector<std::pair<std::string, double>>& figures) {
  MetricsMessage process;
  process.role = role;
  process.id = id;
  process.host = "box";
  process.pid = 100 + static_cast<int>(id);
  process.state = "running";
  process.time = 1;
  for (const auto& [name, value] : figures) {
    process.names.push_back(name);
    process.values.push_back(value);
  }
  return process;
}

RunViewMessage View() {
  RunViewMessage view;
  view.run = "reach";
  view.state = "running";
  view.env_steps = 1200;
  view.updates = 300;
  view.processes = {
      Process("actor", 0, {{"env_steps_per_second", 20}, {"rss_mb", 90}, {"outstanding", 12}}),
      Process("actor", 1, {{"env_steps_per_second", 55}, {"rss_mb", 80}}),
      Process("coordinator", 0, {{"budget_env_steps", 5000}, {"elapsed_seconds", 61}}),
      Process("learner", 0,
              {{"updates_per_second", 30.25},
               {"share_forward", 0.3},
               {"share_backward", 0.5},
               {"data_age_updates_p50", 40},
               {"data_age_updates_p90", 90},
               {"data_age_updates_p99", 99}}),
      Process("replay", 0,
              {{"limiter_blocked_insert_share", 0.1},
               {"limiter_blocked_sample_share", 0.25},
               {"queue_depth", 3},
               {"queue_age_seconds", 0.0124}})};
  return view;
}

// The rows' first words, top to bottom.
std::vector<std::string> Names(const TopOrder& order) {
  std::vector<std::string> names;
  const std::vector<std::string> lines = FormatTop(View(), order, 0);
  for (size_t i = 3; i < lines.size(); ++i) names.push_back(lines[i].substr(0, lines[i].find(' ')));
  return names;
}

int ColumnOf(const std::string& name) {
  for (int i = 0; i < TopColumns(); ++i) {
    if (TopColumnName(i) == name) return i;
  }
  return -1;
}

TEST(TopTable, RowsAreInTheOrderOfRolesAndIds) {
  EXPECT_THAT(Names({}), ::testing::ElementsAre("coordinator-0", "learner-0", "replay-0", "actor-0",
                                                "actor-1"));
}

TEST(TopTable, SortsByAColumnLargestFirstAndThoseWithoutAFigureLast) {
  EXPECT_THAT(
      Names({.column = ColumnOf("RATE")}),
      ::testing::ElementsAre("actor-1", "learner-0", "actor-0", "coordinator-0", "replay-0"));
  EXPECT_EQ(Names({.column = ColumnOf("MB")})[0], "actor-0");
  EXPECT_EQ(Names({.column = ColumnOf("MB"), .reversed = true}).back(), "actor-0");
}

TEST(TopTable, ShowsEachRolesOwnFigures) {
  const std::vector<std::string> lines = FormatTop(View(), {}, 0);
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_THAT(lines[0], HasSubstr("reach: 01:01 running | 1200/5000 env steps"));
  EXPECT_THAT(lines[4], HasSubstr("30.2 updates/s"));
  EXPECT_THAT(lines[4], HasSubstr("40/90/99"));
  EXPECT_THAT(lines[4], HasSubstr("backward 50 %"));
  EXPECT_THAT(lines[5], HasSubstr("25 % out"));
  EXPECT_THAT(lines[5], HasSubstr("12 ms"));
  EXPECT_THAT(lines[6], HasSubstr("20.0 steps/s"));
}

// Position of a column in the heading of a table.
size_t StartOf(const std::vector<std::string>& lines, const std::string& column) {
  for (const std::string& line : lines) {
    if (line.starts_with("PROCESS")) return line.find(column);
  }
  return std::string::npos;
}

TEST(TopTable, ColumnsStayWhereTheyAreWhileATableIsWatched) {
  TopWidths widths;
  RunViewMessage view = View();
  const size_t usual = StartOf(FormatTop(view, {}, 0, &widths), "CREDIT");
  view.processes[3] = Process("learner", 0, {{"updates_per_second", 1234.5}});
  view.processes[3].state = "evaluating";
  view.processes[4].values[3] = 0.9;
  EXPECT_EQ(StartOf(FormatTop(view, {}, 0, &widths), "CREDIT"), usual) << "of usual figures";
  view.processes[4].values[3] = 123456;
  const size_t wider = StartOf(FormatTop(view, {}, 0, &widths), "CREDIT");
  EXPECT_GT(wider, usual);
  EXPECT_EQ(StartOf(FormatTop(View(), {}, 0, &widths), "CREDIT"), wider) << "as it was shown once";
  EXPECT_EQ(StartOf(FormatTop(View(), {}, 0), "CREDIT"), usual);
}

TEST(TopTable, ABusiestStageOfALongNameFitsOnANarrowTerminal) {
  RunViewMessage view = View();
  view.processes[0].names.emplace_back("share_waiting_credit");
  view.processes[0].values.push_back(1);
  EXPECT_TRUE(FormatTop(view, {}, 79).end()[-2].ends_with("waiting credit 100 %"));
}

TEST(TopTable, TheHeadingMarksTheSortedColumn) {
  EXPECT_THAT(FormatTop(View(), {}, 0)[2], HasSubstr("PROCESS*"));
  const std::string heading = FormatTop(View(), {.column = ColumnOf("RATE")}, 0)[2];
  EXPECT_THAT(heading, HasSubstr("RATE*"));
  EXPECT_THAT(heading, Not(HasSubstr("PROCESS*")));
}

TEST(TopTable, EveryColumnIsExplainedOnOneLine) {
  const std::vector<std::string> lines = DescribeTopColumns();
  ASSERT_EQ(lines.size(), static_cast<size_t>(TopColumns()));
  for (int i = 0; i < TopColumns(); ++i) {
    EXPECT_TRUE(lines[static_cast<size_t>(i)].starts_with("  " + TopColumnName(i) + " ")) << i;
    EXPECT_LE(lines[static_cast<size_t>(i)].size(), 79u) << i;
  }
}

TEST(TopTable, ShowsTheProcessorTimeOfEach) {
  RunViewMessage view = View();
  view.processes[3].names.emplace_back("cpu_share");
  view.processes[3].values.push_back(1.254);
  EXPECT_THAT(FormatTop(view, {}, 0)[4], HasSubstr(" 125 % "));
}

TEST(TopTable, LinesAreCutToTheWidth) {
  for (const std::string& line : FormatTop(View(), {}, 30)) EXPECT_LE(line.size(), 30u) << line;
}

TEST(TopTable, ANarrowTerminalShowsAllWordsAndFewerColumns) {
  const std::vector<std::string> wide = FormatTop(View(), {}, 0),
                                 narrow = FormatTop(View(), {}, 80);
  const auto heading = std::ranges::find_if(
      narrow, [](const std::string& line) { return line.starts_with("PROCESS"); });
  ASSERT_EQ(narrow.end() - heading, 6) << "heading and five processes";
  std::string words;
  for (auto line = narrow.begin(); line != heading; ++line) {
    EXPECT_LE(line->size(), 80u);
    words += (words.empty() ? "" : " ") + *line;
  }
  EXPECT_EQ(words, wide[0] + " " + wide[1]);
  for (const char* column : {"STATE", "RATE", "QUEUE", "BLOCKED", "MOST TIME IN"}) {
    EXPECT_THAT(*heading, HasSubstr(column));
  }
  EXPECT_THAT(*heading, Not(HasSubstr("FILES")));
  EXPECT_TRUE(heading[2].ends_with("backward 50 %")) << heading[2];
}

TEST(TopTable, TheJsonReplacesWhatIsNotUtf8) {
  RunViewMessage view = View();
  view.processes[0].host = "\xff";
  EXPECT_EQ(nlohmann::json::parse(TopJson(view)).at("processes")[0].at("host"), "\xef\xbf\xbd");
}

TEST(TopTable, TheJsonHasTheSchemaAndEveryFigureByItsName) {
  const auto json = nlohmann::json::parse(TopJson(View()));
  EXPECT_EQ(json.at("schema"), "shoal-top-1");
  EXPECT_EQ(json.at("run"), "reach");
  EXPECT_EQ(json.at("env_steps"), 1200);
  EXPECT_EQ(json.at("updates"), 300);
  ASSERT_EQ(json.at("processes").size(), 5u);
  const auto& actor = json.at("processes")[0];
  EXPECT_EQ(actor.at("role"), "actor");
  EXPECT_EQ(actor.at("id"), 0);
  EXPECT_EQ(actor.at("host"), "box");
  EXPECT_EQ(actor.at("pid"), 100);
  EXPECT_EQ(actor.at("state"), "running");
  EXPECT_EQ(actor.at("outstanding"), 12);
}

TEST(TopTable, CellsAreThoseOfTheTable) {
  const TopCells cells = MakeTopCells(View());
  // Without the column of a GPU.
  ASSERT_EQ(cells.columns.size(), static_cast<size_t>(TopColumns() - 1));
  ASSERT_EQ(cells.rows.size(), View().processes.size());
  const std::vector<std::string> lines = FormatTop(View(), TopOrder(), 0);
  for (size_t i = 0; i < cells.rows.size(); ++i) {
    for (const std::string& text : cells.rows[i]) {
      EXPECT_THAT(lines[lines.size() - cells.rows.size() + i], HasSubstr(text));
    }
  }
  EXPECT_EQ(lines[1], AdviceOfView(View()));
}

TEST(TopTable, HasAColumnForTheGpuIfTheLearnerUsesOne) {
  RunViewMessage view = View();
  const auto table = [&] { return FormatTop(view, TopOrder(), 0); };
  EXPECT_THAT(table(), Not(::testing::Contains(HasSubstr("GPU"))));
  EXPECT_THAT(MakeTopCells(view).columns, Not(::testing::Contains("GPU")));
  for (const auto& [name, value] :
       {std::pair("card_memory_mb", 3210.0), std::pair("card_memory_size_mb", 85'000.0),
        std::pair("card_busy", 0.41)}) {
    view.processes[3].names.emplace_back(name);
    view.processes[3].values.push_back(value);
  }
  EXPECT_THAT(table(), ::testing::Contains(HasSubstr("GPU")));
  EXPECT_THAT(table(), ::testing::Contains(HasSubstr("41 %, 3.2 of 85 GB")));
  const TopCells cells = MakeTopCells(view);
  EXPECT_THAT(cells.columns, ::testing::Contains("GPU"));
  for (const auto& row : cells.rows) EXPECT_EQ(row.size(), cells.columns.size());
}

}  // namespace
}  // namespace shoal::launch
