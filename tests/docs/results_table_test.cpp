// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/results_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json Evaluation(double rate, int episodes) {
  return {{"aggregate", {{"episodes", episodes}, {"success_rate", rate}, {"return_mean", -2.5}}}};
}

json Meta(double steps, double seconds) {
  return {{"env_steps", steps}, {"wall_seconds", seconds}, {"machine", {{"cores", 2}}}};
}

class ResultsTableTest : public testing::Test {
 protected:
  void Write(const std::string& name, const json& value) const {
    WriteFileAtomically(folder_.path() / name, value.dump());
  }
  json Row(json files) const {
    files.update({{"task", "Reach"},
                  {"preset", "`fast`"},
                  {"input", "pixels"},
                  {"privileged", "–"},
                  {"page", "reach.md"}});
    return files;
  }
  // The row's line of the table.
  std::string Line(const json& row) const {
    Write("table.json", {{"schema", "shoal-results-1"},
                         {"groups", {{{"title", "From pixels"}, {"rows", {row}}}}}});
    const std::string text = ResultsTables(folder_.path());
    return text.substr(text.find("| [Reach]"));
  }

  const TemporaryFolder folder_;
};

TEST(ResultsPage, HasTheTablesOfTheCommittedFigures) {
  const std::string page = ReadFile(SourcePath("docs/results.md"));
  EXPECT_EQ(page, WithResults(page, ResultsTables(SourcePath("docs/results"))))
      << "build/release/bin/shoal-results writes it anew";
}

// Whether a meta.json lists privileged inputs of this kind.
bool Lists(const json& meta, const char* kind) {
  const json inputs = meta.value("privileged_inputs", json::object());
  return !inputs.value(kind, json::array()).empty();
}

// "critic" and "encoder" are in the text of a row exactly if the runs had such inputs.
TEST(ResultsPage, NamesThePrivilegedInputsOfTheRuns) {
  const std::string folder = SourcePath("docs/results");
  const json table = json::parse(ReadFile(folder + "/table.json"));
  int metas = 0, privileged = 0;
  for (const json& group : table.at("groups")) {
    for (const json& row : group.at("rows")) {
      const auto text = row.at("privileged").get<std::string>();
      const json names = row.value("metas", json::array());
      for (const json& name : names) {
        const json meta = json::parse(ReadFile(folder + "/" + name.get<std::string>()));
        if (!meta.contains("privileged_inputs")) continue;
        ++metas;
        privileged += Lists(meta, "critic_blocks") ? 1 : 0;
        EXPECT_EQ(text.find("critic") != text.npos, Lists(meta, "critic_blocks")) << name;
        EXPECT_EQ(text.find("encoder") != text.npos, Lists(meta, "labels")) << name;
      }
    }
  }
  EXPECT_GE(metas, 10);
  EXPECT_GE(privileged, 3);
}

// Pages link a percentage to the evaluation that it is from: "[98.2 %](runs/a-eval200.json)".
TEST(ResultsPage, LinkedPercentagesAreThoseOfTheirFiles) {
  const std::regex link(R"(\[([0-9.]+) %\]\(([^)]+\.json)\))");
  const std::filesystem::path folder = SourcePath("docs/results");
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".md") continue;
    const std::string page = ReadFile(entry.path());
    for (std::sregex_iterator it(page.begin(), page.end(), link), end; it != end; ++it) {
      const json file = json::parse(ReadFile(folder / (*it)[2].str()));
      const json& figures = file.contains("aggregate") ? file.at("aggregate") : file;
      ++found;
      EXPECT_NEAR(std::stod((*it)[1]), 100 * figures.at("success_rate").get<double>(), 0.051)
          << entry.path() << ": " << it->str();
    }
  }
  EXPECT_GE(found, 30);
}

// The README repeats some rows: each success with its interval is one of the tables.
TEST(ResultsPage, HasEverySuccessOfTheReadme) {
  const std::string page = ReadFile(SourcePath("docs/results.md"));
  const std::string readme = ReadFile(SourcePath("README.md"));
  const std::regex success(R"(\*\*[0-9.]+ %\*\* \([0-9.]+–[0-9.]+\))");
  int found = 0;
  for (std::sregex_iterator it(readme.begin(), readme.end(), success), end; it != end; ++it) {
    ++found;
    EXPECT_THAT(page, HasSubstr(it->str()));
  }
  EXPECT_GE(found, 5);
}

TEST_F(ResultsTableTest, SeveralSeedsHaveAnIntervalOverSeedsAndRanges) {
  Write("a.json", Evaluation(0.96, 200));
  Write("b.json", Evaluation(0.995, 200));
  Write("c.json", Evaluation(0.985, 200));
  Write("a-meta.json", Meta(52004, 171.8));
  Write("b-meta.json", Meta(51216, 88.6));
  EXPECT_EQ(Line(Row({{"evals", {"a.json", "b.json", "c.json"}},
                      {"metas", {"a-meta.json", "b-meta.json"}}})),
            "| [Reach](results/reach.md) | `fast` | pixels | **98.0 %** (93.5–100) | 51,200–52,000 "
            "| 89–172 s, 2 cores "
            "| 3 | – |\n\n");
}

TEST_F(ResultsTableTest, OneSeedHasTheIntervalOfItsEpisodes) {
  Write("a.json", Evaluation(1, 200));
  Write("meta.json", Meta(300012, 4696));
  EXPECT_THAT(
      Line(Row({{"evals", {"a.json"}}, {"metas", {"meta.json"}}, {"busy", true}, {"cores", 1}})),
      HasSubstr("| **100 %** (98.1–100) | 300,000 | 78 min†, 1 core | 1 |"));
}

TEST_F(ResultsTableTest, AMemberOfAFileCanBeTheEvaluation) {
  Write("a.json", {{"eval400", {{"episodes", 400}, {"success_rate", 0.9}}}});
  Write("meta.json", Meta(300000, 8743));
  EXPECT_THAT(Line(Row({{"evals", {"a.json#eval400"}}, {"metas", {"meta.json"}}})),
              HasSubstr("**90.0 %** (86.7–92.6) | 300,000 | 2.4 h, 2 cores"));
  Write(
      "curve.json",
      {{"evaluations",
        {{{"episodes", 50}, {"success_rate", 0.1}}, {{"episodes", 400}, {"success_rate", 0.9}}}}});
  EXPECT_THAT(Line(Row({{"evals", {"curve.json#evaluations/1"}}, {"metas", {"meta.json"}}})),
              HasSubstr("**90.0 %** (86.7–92.6)"));
}

TEST_F(ResultsTableTest, AnArmGivesItsFinishedRunsAndReturns) {
  const json run = {
      {"status", "finished"}, {"success", nullptr},  {"episodes", 100}, {"return_mean", 3472},
      {"env_steps", 1e6},     {"wall_seconds", 196}, {"cores", 2}};
  json other = run, interrupted = run;
  other["return_mean"] = 3276;
  interrupted["status"] = "interrupted";
  Write("summary.json", {{"arms", {{{"name", "mujoco"}, {"runs", {run, other, interrupted}}}}}});
  const json row = Row({{"summary", "summary.json"}, {"arm", "mujoco"}});
  EXPECT_THAT(Line(row), HasSubstr("| return **3,374** (2,129 to 4,619) | 1,000,000 | 3 min, 2 "
                                   "cores | 2 |"));
  json wrong = row;
  wrong["arm"] = "zoo";
  EXPECT_THAT(ErrorMessage([&] { Line(wrong); }),
              HasSubstr("row '`fast`': the summary has no arm 'zoo'"));
}

TEST_F(ResultsTableTest, ARowWithoutFiguresIsNamed) {
  EXPECT_THROW(Line(Row({{"evals", {"gone.json"}}})), Error);
  EXPECT_THROW(Line(Row(json::object())), Error);
}

TEST_F(ResultsTableTest, ThePageKeepsWhatIsAroundTheTables) {
  EXPECT_EQ(WithResults("a\n<!-- results -->\nold\n<!-- end of results -->\nb\n", "new\n"),
            "a\n<!-- results -->\nnew\n<!-- end of results -->\nb\n");
  EXPECT_THROW(WithResults("a\n", "new\n"), Error);
}

}  // namespace
}  // namespace shoal
