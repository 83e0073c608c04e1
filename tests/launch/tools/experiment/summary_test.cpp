// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "launch/tools/experiment/frames_table.h"
#include "launch/tools/experiment/stored_summary.h"
#include "tests/launch/tools/experiment/planted_run.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

// Two arms: both seeds of "state" finished; of "pixels" one finished, one interrupted.
class SummaryTest : public testing::Test {
 protected:
  SummaryTest() {
    Definition definition{.name = "mine", .base = "fetch-reach-state"};
    definition.question = "Pixels or state?";
    definition.arms = {{"state", nlohmann::ordered_json::object()},
                       {"pixels", {{"learner.batch", 64}}}};
    definition.seeds = {0, 1};
    folder_.emplace(PlanExperiment(temporary_.path() / "mine", definition, "x.json"));
    for (const ExperimentRun& run : folder_->experiment().Runs({0, 1})) {
      const RunPlanter planter(run.folder);
      planter.Begin();
      const bool first = run.arm == 0;
      planter.WriteEvaluation(100, first ? 0.9 : 0.2, -3);
      planter.WriteEvaluation(200, 0.95, -2);
      planter.WriteEvaluation(300, 0.95, -1);
      planter.WriteMeta(run.name == "pixels-s1" ? "interrupted" : "budget");
      if (run.name != "pixels-s1") planter.WriteFinal(first ? 1 : 0.5, 20, first ? -1 : -2);
    }
  }

  // The same experiment with further tasks.
  void Transfer(const std::vector<std::string>& tasks) {
    Definition definition = folder_->experiment().definition;
    definition.transfer = tasks;
    folder_.reset();
    folder_.emplace(PlanExperiment(temporary_.path() / "mine", definition, "x.json"));
  }
  nlohmann::ordered_json Json() const { return ToJson(ReadOutcome(folder_->experiment())); }

  const TemporaryFolder temporary_;
  std::optional<ExperimentFolder> folder_;
};

TEST_F(SummaryTest, HasEveryMemberThatOthersRead) {
  WriteSummary(ReadOutcome(folder_->experiment()));
  const auto json = nlohmann::json::parse(ReadFile(folder_->experiment().folder / "summary.json"));
  EXPECT_EQ(json.at("schema"), "shoal-experiment-1");
  EXPECT_EQ(json.at("name"), "mine");
  EXPECT_EQ(json.at("n_to_target_rule"), "together");
  for (const char* name : {"commit", "created", "baselines"}) EXPECT_TRUE(json.contains(name));
  const auto& arm = json.at("arms").at(0);
  EXPECT_EQ(arm.at("name"), "state");
  EXPECT_EQ(json.at("arms").at(1).at("overrides").at("learner.batch"), 64);
  const auto& run = arm.at("runs").at(1);
  EXPECT_EQ(run.at("run"), "state-s1");
  EXPECT_EQ(run.at("seed"), 1);
  EXPECT_EQ(run.at("status"), "finished");
  EXPECT_EQ(run.at("env_steps"), 1000);
  EXPECT_EQ(run.at("updates"), 100);
  EXPECT_EQ(run.at("wall_seconds"), 360);
  EXPECT_EQ(run.at("cpu_seconds"), 712.4);
  EXPECT_EQ(run.at("energy_wh"), 1.234);
  EXPECT_EQ(run.at("n_to_target"), 100);
  EXPECT_EQ(run.at("success"), 1.0);
  EXPECT_EQ(run.at("episodes"), 20);
  EXPECT_EQ(run.at("return_mean"), -1.0);
  EXPECT_EQ(run.at("final_distance_mean"), 0.02);
  EXPECT_EQ(run.at("commits"), (std::vector<std::string>{"abc", "def"}));
}

TEST_F(SummaryTest, TakesSeedsAsTheUnit) {
  const auto json = Json();
  const auto& state = json.at("arms").at(0);
  EXPECT_EQ(state.at("success").at("pooled"), 1.0);
  EXPECT_EQ(state.at("success").at("episodes"), 40);
  EXPECT_EQ(state.at("success").at("seeds"), 2);
  EXPECT_NEAR(state.at("success").at("ci95").at(0).get<double>(), Wilson95(40, 40).low, 1e-12);
  EXPECT_TRUE(state.at("success").at("wilson95").is_null()) << "of several seeds there is none";
  EXPECT_EQ(state.at("return").at("mean"), -1.0);
  EXPECT_EQ(state.at("return").at("seeds"), 2);
  const auto& pixels = json.at("arms").at(1);
  EXPECT_EQ(pixels.at("success").at("episodes"), 20) << "of the finished run alone";
  EXPECT_TRUE(pixels.at("return").at("ci95").is_null()) << "one seed has no spread";
  EXPECT_NEAR(pixels.at("success").at("wilson95").at(0).get<double>(), Wilson95(10, 20).low, 1e-12);
  EXPECT_EQ(pixels.at("success").at("failed"), 0) << "what is interrupted has not failed";
  EXPECT_EQ(pixels.at("runs").at(1).at("status"), "interrupted");
  EXPECT_TRUE(pixels.at("runs").at(1).at("success").is_null());
}

TEST_F(SummaryTest, RatiosAreOfFinishedPairs) {
  const auto ratios = Json().at("ratios");
  ASSERT_EQ(ratios.size(), 1u);
  EXPECT_EQ(ratios[0].at("name"), "pixels/state");
  ASSERT_EQ(ratios[0].at("pairs").size(), 1u) << "the other one is not finished";
  EXPECT_EQ(ratios[0].at("pairs").at(0).at("n"), 200);
  EXPECT_EQ(ratios[0].at("pairs").at(0).at("n_reference"), 100);
  EXPECT_EQ(ratios[0].at("median"), 2.0);
  EXPECT_EQ(ratios[0].at("not_reached"), 0);
}

TEST_F(SummaryTest, TheTextNamesWhatIsMissing) {
  const std::string text = SummaryText(ReadOutcome(folder_->experiment()));
  EXPECT_THAT(text, HasSubstr("Pixels or state?"));
  EXPECT_THAT(text, HasSubstr("100.0 % [91.2, 100.0] (2 seeds, 40/40)"));
  EXPECT_THAT(text, HasSubstr("pixels / state: median 2.00 of 1 pair (seed 0: 2.00)"));
  EXPECT_THAT(text, HasSubstr("not finished: pixels-s1 (interrupted)"));
  EXPECT_THAT(StatusText(ReadOutcome(folder_->experiment())), HasSubstr("pixels-s1"));
}

// A run with numbers that are not finite has no figures; the row of its arm reports this.
TEST_F(SummaryTest, AFailedSeedIsCountedInTheRowOfItsArm) {
  const RunPlanter failed(folder_->experiment().folder / "runs/state-s1");
  failed.WriteMeta("failed", "critic_loss is nan");
  const auto json = Json();
  const auto& state = json.at("arms").at(0);
  EXPECT_EQ(state.at("success").at("failed"), 1);
  EXPECT_EQ(state.at("success").at("seeds"), 1);
  EXPECT_EQ(state.at("success").at("mean_with_failed_as_0"), 0.5);
  EXPECT_EQ(state.at("return").at("failed"), 1);
  EXPECT_THAT(
      SummaryText(ReadOutcome(folder_->experiment())),
      HasSubstr("1/2, 1 failed  100.0 % [83.9, 100.0] (20/20; 1 failed: 50.0 % with it as 0) "
                " -1.00 (1 seed; 1 failed, left out)"));
}

TEST_F(SummaryTest, ARunWithoutItsTransferEvaluationIsNotFinished) {
  Transfer({"FetchReach"});
  const auto folder = folder_->experiment().folder;
  for (const char* name : {"state-s0", "pixels-s0"}) {
    WriteFileAtomically(TransferFile(folder / "runs" / name, "FetchReach"),
                        PlantedEvaluation(1000, 0.5, 10).dump());
  }
  folder_->experiment().Log().Write(RunStart{.run = "state-s1"});
  folder_->experiment().Log().Write(
      RunEnding{.run = "state-s1", .code = 1, .problem = "no such task"});
  const auto state = Json().at("arms").at(0);
  EXPECT_EQ(state.at("runs").at(0).at("status"), "finished");
  EXPECT_EQ(state.at("runs").at(1).at("status"), "failed");
  EXPECT_EQ(state.at("runs").at(1).at("problem"), "no such task");
  EXPECT_EQ(state.at("success").at("episodes"), 20) << "of the finished run alone";
  const ExperimentOutcome outcome = ReadOutcome(folder_->experiment());
  EXPECT_THAT(SummaryText(outcome), HasSubstr("state-s1 (failed)"));
  EXPECT_THAT(StatusText(outcome), HasSubstr("no such task"));
}

TEST_F(SummaryTest, ARunThatFailedBeforeItHadAFolderIsThere) {
  folder_->experiment().Log().Write(RunStart{.run = "pixels-s9"});
  folder_->experiment().Log().Write(RunEnding{.run = "pixels-s9", .code = 2, .problem = "refused"});
  const auto run = Json().at("arms").at(1).at("runs").at(2);
  EXPECT_EQ(run.at("run"), "pixels-s9");
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_EQ(run.at("problem"), "refused");
}

TEST_F(SummaryTest, WithoutFramesItSaysNothingAboutThem) {
  const auto json = Json();
  for (const char* name : {"frames", "mean_of_tasks", "reference"})
    EXPECT_FALSE(json.contains(name));
  EXPECT_FALSE(json.at("arms").at(0).contains("task"));
  EXPECT_FALSE(json.at("arms").at(0).contains("at_frames"));
  EXPECT_FALSE(json.at("arms").at(0).at("runs").at(0).contains("at_frames"));
  EXPECT_THAT(SummaryText(ReadOutcome(folder_->experiment())),
              testing::Not(HasSubstr("environment frames")));
}

// One seed on two tasks with the repeats 8 and 2; the second seed has failed on the second task.
class FramesSummaryTest : public testing::Test {
 protected:
  FramesSummaryTest() {
    Definition definition{.name = "mine", .base = "cartpole-swingup-state"};
    definition.arms = {{"cartpole", nlohmann::ordered_json::object()},
                       {"walker", {{"task", "walker_walk"}}}};
    definition.seeds = {0, 1};
    definition.frames = {100'000, 500'000};
    definition.reference = "planet-6";
    folder_.emplace(PlanExperiment(temporary_.path() / "mine", definition, "x.json"));
    for (const ExperimentRun& run : folder_->experiment().Runs({0, 1})) {
      const bool walker = run.arm == 1;
      const RunPlanter planter(run.folder);
      planter.Begin({walker ? "task=walker_walk" : "task=cartpole_swingup"});
      planter.WriteEvaluation(12'504, 0, walker ? 1 : 700);
      planter.WriteEvaluation(50'002, 0, walker ? 500 : 900);
      planter.WriteMeta(run.name == "walker-s1" ? "failed" : "interrupted");
    }
  }

  const TemporaryFolder temporary_;
  std::optional<ExperimentFolder> folder_;
};

TEST_F(FramesSummaryTest, TakesEvaluationsByTheRepeatOfTheirTask) {
  const auto json = ToJson(ReadOutcome(folder_->experiment()));
  EXPECT_EQ(json.at("frames"), (std::vector<int>{100'000, 500'000}));
  const auto& walker = json.at("arms").at(1);
  EXPECT_EQ(walker.at("task"), "walker_walk");
  EXPECT_EQ(walker.at("runs").at(0).at("at_frames"),
            nlohmann::ordered_json::parse(
                R"([{"frames": 100000, "env_steps": 50002, "episodes": 50, "return_mean": 500}])"))
      << "of a run that is not finished, too";
  EXPECT_TRUE(walker.at("runs").at(1).at("at_frames").empty()) << "it has failed";
  EXPECT_EQ(walker.at("at_frames").at(0).at("return").at("failed"), 1);
  const auto& cartpole = json.at("arms").at(0).at("at_frames").at(0);
  EXPECT_EQ(cartpole.at("frames"), 100'000);
  EXPECT_EQ(cartpole.at("return").at("mean"), 700.0);
  EXPECT_EQ(cartpole.at("return").at("seeds"), 2);
  const auto& mean = json.at("mean_of_tasks").at("at_frames").at(0);
  EXPECT_EQ(mean.at("return").at("mean"), 600.0) << "of seed 0, which both arms have";
  EXPECT_EQ(json.at("reference").at("name"), "planet-6");
}

TEST_F(FramesSummaryTest, TheTextHasTheTableAndThePublishedReturns) {
  const std::string text = SummaryText(ReadOutcome(folder_->experiment()));
  EXPECT_THAT(text, HasSubstr("mean of 2 tasks  600.0 (1 seed; 1 failed, left out)"));
  EXPECT_THAT(text, HasSubstr("reference planet-6 at 100000 environment frames:\n"
                              "TASK              DrQ    DrQ K=M=1"));
}

// The summary of finished runs must not depend on a file of another project.
TEST_F(FramesSummaryTest, AMissingReferenceIsOneLine) {
  ExperimentOutcome outcome = ReadOutcome(folder_->experiment());
  EXPECT_EQ(outcome.reference_problem, "");
  StoredExperiment other = folder_->experiment();
  other.definition.reference = "gone";
  outcome = ReadOutcome(other);
  EXPECT_THAT(SummaryText(outcome),
              HasSubstr("the reference is not shown: no reference 'gone': expected"));
  EXPECT_FALSE(ToJson(outcome).contains("reference"));
  EXPECT_EQ(ToJson(outcome).at("mean_of_tasks").at("tasks"), 2);
}

TEST_F(FramesSummaryTest, AStoredSummaryHasTheSameTables) {
  WriteSummary(ReadOutcome(folder_->experiment()));
  const auto file = folder_->experiment().folder / "summary.json";
  const auto written = nlohmann::ordered_json::parse(ReadFile(file));
  const auto read = ReadStoredSummary(file);
  EXPECT_EQ(read, written);
  const std::string tables = FramesText(ReadOutcome(folder_->experiment()).frames);
  EXPECT_THAT(tables, HasSubstr("mean of 2 tasks"));
  EXPECT_THAT(StoredSummaryText(read), HasSubstr(tables));
  auto changed = written;
  changed.at("arms").at(0).at("runs").at(0).at("at_frames").at(0).at("return_mean") = 900;
  WriteFileAtomically(file, changed.dump());
  EXPECT_EQ(
      ReadStoredSummary(file).at("mean_of_tasks").at("at_frames").at(0).at("return").at("mean"),
      700.0)
      << "computed from the rows";
}

TEST_F(SummaryTest, EveryWorldHasItsBaselines) {
  Definition definition = folder_->experiment().definition;
  definition.name = "worlds";
  definition.arms = {{"usual", nlohmann::ordered_json::object()},
                     {"batch", {{"learner.batch", 64}}},
                     {"wide", {{"distance_threshold", 0.2}}},
                     {"push", {{"task", "FetchPush"}}},
                     {"close", {{"task", "FetchPush"}, {"distance_threshold", 0.01}}}};
  definition.transfer = {"FetchReach", "FetchPush"};
  const ExperimentFolder worlds(PlanExperiment(temporary_.path() / "worlds", definition, "x.json"));
  std::vector<std::string> names;
  for (const JudgedWorld& world : JudgedWorlds(worlds.experiment())) names.push_back(world.name);
  EXPECT_THAT(names,
              testing::ElementsAre("FetchReachDense", "wide", "FetchPush", "close", "FetchReach"));
  const auto push_alone =
      WithArmsOf({*worlds.experiment().RunNamed("push-s0")}, worlds.experiment());
  names.clear();
  for (const JudgedWorld& world : JudgedWorlds(push_alone)) names.push_back(world.name);
  EXPECT_THAT(names, testing::ElementsAre("FetchPush", "FetchReach"));
  ExperimentOutcome outcome = ReadOutcome(worlds.experiment());
  outcome.baselines.clear();
  for (const JudgedWorld& world : JudgedWorlds(worlds.experiment())) {
    Baselines baselines;
    baselines.noop.task = world.config.task;
    baselines.noop.return_mean = world.config.distance_threshold;
    outcome.baselines.push_back({world, baselines});
  }
  auto json = ToJson(outcome).at("baselines");
  EXPECT_EQ(json.at("noop").at("task"), "FetchReachDense");
  EXPECT_EQ(json.at("other_arms").at("wide").at("noop").at("return_mean"), 0.2);
  EXPECT_EQ(json.at("other_arms").at("close").at("noop").at("return_mean"), 0.01);
  EXPECT_EQ(json.at("other_tasks").size(), 2u);
  EXPECT_EQ(json.at("other_tasks").at("FetchPush").at("noop").at("return_mean"), 0.0);
  EXPECT_THAT(SummaryText(outcome), HasSubstr("FetchReachDense of arm wide without a policy"));
  outcome.baselines.erase(outcome.baselines.begin());  // the first one has not been measured
  json = ToJson(outcome).at("baselines");
  EXPECT_FALSE(json.contains("noop")) << "another world's do not take its place";
}

TEST_F(SummaryTest, ABrokenRunIsAFailedOne) {
  const auto run = folder_->experiment().folder / "runs/state-s0";
  WriteFileAtomically(run / "eval/final.json", "{}");
  const auto json = Json();
  EXPECT_EQ(json.at("arms").at(0).at("runs").at(0).at("status"), "failed");
  EXPECT_THAT(json.at("arms").at(0).at("runs").at(0).at("problem").get<std::string>(),
              HasSubstr("final.json"));
}

}  // namespace
}  // namespace shoal::launch
