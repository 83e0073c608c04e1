// SIGKILL of each role while training: the run goes on, nothing acknowledged is lost, the account
// balances exactly.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <thread>

#include "common/base/clock.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

// The newest line of a role in metrics.jsonl; null when there is none yet.
json LastReport(const std::filesystem::path& run, const std::string& role) {
  std::ifstream in(run / "metrics.jsonl");
  json last;
  for (std::string line; std::getline(in, line);) {
    const json report = json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (report.is_object() && report.value("role", "") == role) last = report;
  }
  return last;
}

// Looks at a role's reports until `done`, up to `deadline`.
template <class Done>
json WaitForReport(const std::filesystem::path& run, const std::string& role, Done done,
                   seconds deadline = seconds(60)) {
  const SteadyTime end = Now() + deadline;
  while (Now() < end) {
    const json report = LastReport(run, role);
    if (!report.is_null() && done(report)) return report;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ADD_FAILURE() << role << " did not get there; last: " << LastReport(run, role).dump();
  return {};
}

class RunningTraining {
 public:
  explicit RunningTraining(const TrainingRun::Keys& keys) : child_(Spec(keys)) {}

  const std::filesystem::path path() const { return run_.path(); }

  // Kills the process of a role and waits until another one reports in its place.
  void KillAndWaitForSuccessor(const std::string& role) {
    const json before = WaitForReport(path(), role, [](const json&) { return true; });
    if (before.is_null()) return;
    const pid_t victim = before.at("pid").get<pid_t>();
    ASSERT_EQ(kill(victim, SIGKILL), 0) << role;
    WaitForReport(path(), role, [&](const json& r) { return r.at("pid") != victim; });
  }

  void WaitForMoreSteps(int64_t steps) {
    const auto stored = [](const json& r) { return int64_t(r.value("stored_steps", 0.0)); };
    const json before = WaitForReport(path(), "replay", [](const json&) { return true; });
    if (before.is_null()) return;
    WaitForReport(path(), "replay",
                  [&](const json& r) { return stored(r) >= stored(before) + steps; });
  }

  // Waits for the end; exit code or -1.
  int End(seconds deadline) {
    const SteadyTime end = Now() + deadline;
    while (Now() < end) {
      if (const auto status = child_.Poll()) return status->by_signal ? -1 : status->code;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return -1;
  }

  std::string Output() const { return ReadFile(run_.parent() / "output"); }
  const TrainingRun& run() const { return run_; }

 private:
  launch::ProcessSpec Spec(const TrainingRun::Keys& keys) const {
    launch::ProcessSpec spec;
    spec.role = "train";
    spec.command = run_.Command(keys);
    spec.command[0] = std::string(SHOAL_BIN) + "/shoal";
    spec.output = run_.parent() / "output";
    return spec;
  }

  TrainingRun run_;
  launch::ChildProcess child_;
};

TEST(Kill, TrainingSurvivesTheDeathOfEachRole) {
  RunningTraining training({{"env_steps", "30000"}, {"actors", "2"}, {"eval.interval", "10000"}});
  training.WaitForMoreSteps(1500);
  for (const char* role : {"actor", "replay", "learner", "eval"}) {
    training.KillAndWaitForSuccessor(role);
    training.WaitForMoreSteps(500);
  }
  ASSERT_EQ(training.End(seconds(240)), 0) << training.Output();
  const json meta = training.run().Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("rejected"), 0);
  // Only an actor's death loses records, and only those not yet acknowledged: its window.
  EXPECT_LE(meta.at("accounting").at("lost_with_process").get<int64_t>(), 5 * 24);
}

}  // namespace
}  // namespace shoal
