// SPDX-License-Identifier: Apache-2.0
// A run continues without an actor that cannot run, reports this, and restarts the actor later.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/running_training.h"
#include "tests/support/slow_point.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;

// Processes crash while a file with their name exists (crashing_point/physics.cpp).
class ExpendableActors : public testing::Test {
 protected:
  ExpendableActors() { MakeFolders(crashes_); }

  std::vector<std::string> Command(TrainingRun::Keys keys = {}) const {
    TrainingRun::Keys all = SlowPoint({{"env_steps", "10000000"},
                                       {"actors", "2"},
                                       {"eval.interval", "10000000"},
                                       {"eval.final_episodes", "0"}});
    for (const auto& [key, value] : keys) all[key] = value;
    return run_.Command(all);
  }
  RunningTraining Start(const TrainingRun::Keys& keys = {}) const {
    return {run_, Command(keys), Environment()};
  }
  RunningTraining::Environment Environment() const {
    return {{"SHOAL_TEST_CRASH_FOLDER", crashes_.string()}};
  }
  void Crash(const std::string& process) const { WriteFileAtomically(crashes_ / process, ""); }
  void Mend(const std::string& process) const { std::filesystem::remove(crashes_ / process); }

  // The coordinator's next report with a figure of at least `value`; null at the deadline.
  static json WaitFor(RunningTraining* training, const char* figure, double value) {
    return training->reports().WaitFor(
        "coordinator", [=](const json& r) { return r.value(figure, -1.0) >= value; }, seconds(90));
  }
  static json WaitForWorking(RunningTraining* training, double actors) {
    return training->reports().WaitFor(
        "coordinator", [=](const json& r) { return r.value("actors_working", -1.0) == actors; },
        seconds(90));
  }
  // Lines of the coordinator's log that hold the text.
  int Said(const std::string& text) const {
    std::istringstream in(ReadFile(run_.path() / "logs" / "coordinator.log"));
    int lines = 0;
    for (std::string line; std::getline(in, line);) lines += line.find(text) != std::string::npos;
    return lines;
  }
  json EndInOrder(RunningTraining* training) const {
    training->Interrupt();
    EXPECT_EQ(training->End(seconds(120)), kInterruptedExit) << training->Output();
    json meta = run_.Json("meta.json");
    ExpectBalanced(meta);
    return meta;
  }

  const TrainingRun run_{};
  const std::filesystem::path crashes_ = run_.parent() / "crashes";
};

TEST_F(ExpendableActors, OneThatCrashesAgainAndAgainIsTriedOnAndTheRunLearnsFromTheOther) {
  Crash("actor-1");
  RunningTraining training = Start();
  // Six deaths within a minute would end a run that needs the process.
  ASSERT_FALSE(WaitFor(&training, "restarts", 6).is_null()) << training.Output();
  ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
  EXPECT_EQ(training.reports().Last("coordinator").value("actors_working", 0.0), 1);
  EXPECT_THAT(training.Output(),
              AllOf(HasSubstr("| actors 1 of 2: actor-1: killed by SIGSEGV (death "),
                    HasSubstr("next try in ")));
  EXPECT_THAT(Said("actor-1: killed by SIGSEGV; restart in"), testing::AnyOf(3, 4))
      << "deaths 1, 2, 4 and by now perhaps 8";
  const ProgramResult top =
      RunProgram({"shoal", "top", "--run", run_.path(), "--once"}, seconds(30));
  EXPECT_THAT(top.out, HasSubstr("actors 1 of 2: actor-1: killed by SIGSEGV")) << top.err;

  Mend("actor-1");
  ASSERT_FALSE(WaitForWorking(&training, 2).is_null()) << training.Output();
  const json meta = EndInOrder(&training);
  EXPECT_GE(meta.at("restarts"), 6);
  EXPECT_THAT(training.Output(), HasSubstr("deaths: actor-1 "));
}

TEST_F(ExpendableActors, WhereNoneEverWorkedTheRunEndsSoon) {
  Crash("actor-0");
  Crash("actor-1");
  RunningTraining training = Start();
  EXPECT_EQ(training.End(seconds(60)), 1) << training.Output();
  const json meta = run_.Json("meta.json");
  EXPECT_EQ(meta.at("exit"), "failed");
  EXPECT_THAT(meta.at("error"), AllOf(HasSubstr("killed by SIGSEGV"),
                                      HasSubstr("died more than 5 times within 60 s")));
}

TEST_F(ExpendableActors, WhereNoneWorksAnyMoreTheRunEndsAfterTheTimeThatTheKeySays) {
  RunningTraining training = Start({{"stop.without_actors", "20"}});
  ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
  for (int id : {0, 1}) {  // they count as working after ten seconds
    ASSERT_FALSE(training.reports()
                     .WaitFor(
                         "actor", [](const json& r) { return r.value("uptime_seconds", 0.0) > 13; },
                         seconds(60), id)
                     .is_null());
  }
  Crash("actor-0");
  Crash("actor-1");
  const SteadyTime start = Now();
  EXPECT_EQ(training.End(seconds(100)), 1) << training.Output();
  EXPECT_GE(Now() - start, seconds(20));
  EXPECT_THAT(run_.Json("meta.json").at("error"),
              AllOf(HasSubstr("no training actor has worked for 20 s (stop.without_actors)"),
                    HasSubstr("actor-0"), HasSubstr("actor-1")));
}

TEST_F(ExpendableActors, TrainingGoesOnWithoutAnEvaluationActorOnceThereWasAnEvaluation) {
  RunningTraining training = Start({{"eval.interval", "500"}, {"actors", "1"}});
  const json evaluated = training.reports().WaitFor(
      "coordinator", [](const json& r) { return r.value("last_evaluation_env_steps", 0.0) > 0; },
      seconds(60));
  ASSERT_FALSE(evaluated.is_null()) << training.Output();
  Crash("eval");
  ASSERT_FALSE(WaitFor(&training, "restarts", 6).is_null()) << training.Output();
  ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
  EXPECT_THAT(training.Output(), HasSubstr("no evaluation actor: eval-0: killed by SIGSEGV"));
  EndInOrder(&training);
}

}  // namespace
}  // namespace shoal
