// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/run_under_test.h"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <set>
#include <thread>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/interrupted.h"
#include "common/base/stop.h"
#include "tests/support/processes.h"

namespace shoal::soak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kLookAgain{50};
constexpr seconds kStart{60};
// Progress that counts as going on: more than the work in flight at the fault.
constexpr double kMoreSteps = 200, kMoreUpdates = 5;

// "actor-1" of a child's command line; empty for other programs.
std::string NameOf(const std::vector<std::string>& command) {
  if (command.empty()) return "";
  const std::string program = fs::path(command[0]).filename();
  // An actor of an environment of Python is "python -m shoal_rl.actor".
  const bool python = command.size() > 2 && command[2] == "shoal_rl.actor";
  if (program == "shoal-replay") return "replay-0";
  if (program == "shoal-learner") return "learner-0";
  if (program != "shoal-actor" && !python) return "";
  for (size_t i = 1; i + 1 < command.size(); ++i) {
    if (command[i] == "--role" && command[i + 1] == "eval") return "eval-0";
    if (command[i] == "--id") return "actor-" + command[i + 1];
  }
  return "";
}

double Figure(const json& report, const char* name) {
  const auto it = report.find(name);
  return it != report.end() && it->is_number() ? it->get<double>() : 0;
}

}  // namespace

RunUnderTest::RunUnderTest(const RunOptions& options)
    : options_(options),
      path_(options.folder / "run"),
      coordinator_(Spec(FirstArguments())),
      reports_(options.folder / "run") {
  const SteadyTime start = Now();
  while (TakeProgress().updates < kMoreUpdates) {
    CheckAlive();
    if (Now() - start > kStart) throw Broken("no training within 60 s of the start: " + Output());
    std::this_thread::sleep_for(kLookAgain);
  }
}

std::vector<std::string> RunUnderTest::FirstArguments() const {
  std::vector<std::string> arguments{"train", "--preset", options_.preset, "--run-name", "run"};
  std::vector<std::string> keys{fmt::format("run_dir={}", options_.folder.string()),
                                fmt::format("actors={}", options_.actors),
                                fmt::format("seed={}", options_.seed),
                                "env_steps=1000000000",
                                "stop.success=2",
                                "eval.interval=20000",
                                "eval.episodes=8",
                                "eval.final_episodes=0",
                                "learner.threads=1",
                                "learner.checkpoint_period=500",
                                "replay.capacity=20000",
                                "replay.samples_per_insert=32"};
  if (!options_.environment.empty()) {
    arguments.insert(arguments.end(), {"--env", options_.environment});
  }
  keys.insert(keys.end(), options_.keys.begin(), options_.keys.end());
  for (const std::string& key : keys) {
    arguments.push_back("--set");
    arguments.push_back(key);
  }
  return arguments;
}

launch::ProcessSpec RunUnderTest::Spec(const std::vector<std::string>& arguments) const {
  MakeFolders(temporary_files());
  launch::ProcessSpec spec;
  spec.role = "train";
  spec.command = {(options_.programs / "shoal").string()};
  spec.command.insert(spec.command.end(), arguments.begin(), arguments.end());
  spec.environment = {{"TMPDIR", temporary_files().string()}};
  spec.output = options_.folder / "output";
  return spec;
}

void RunUnderTest::KillCoordinator(seconds deadline) {
  CheckAlive();
  coordinator_.Signal(SIGKILL);
  const SteadyTime end = Now() + deadline;
  while (!coordinator_.Poll()) {
    if (Now() > end) throw Broken("the coordinator outlived SIGKILL");
    std::this_thread::sleep_for(kLookAgain);
  }
  // This process adopts orphans (main.cpp).
  for (const pid_t pid : ChildrenOf(getpid())) {
    const std::string name = NameOf(CommandLine(pid));
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) == 0) {
      if (Now() > end) throw Broken(name + " did not leave after its coordinator's death");
      std::this_thread::sleep_for(kLookAgain);
    }
    // SIGHUP is how they hear of the coordinator's death: they end in order, then die by it.
    if (WIFSIGNALED(status) && WTERMSIG(status) != SIGHUP) {
      throw Broken(fmt::format("{}, left alone, ended by signal {}", name, WTERMSIG(status)));
    }
  }
}

void RunUnderTest::Resume() {
  coordinator_ = launch::ChildProcess(Spec({"train", "--resume", path_.string()}));
}

std::vector<std::string> RunUnderTest::ProcessNames() const {
  std::vector<std::string> names{"replay-0", "learner-0", "eval-0"};
  for (int i = 0; i < options_.actors; ++i) names.push_back(fmt::format("actor-{}", i));
  return names;
}

pid_t RunUnderTest::Pid(const std::string& name) const {
  if (name == "coordinator") return coordinator_.pid();
  for (const pid_t pid : ChildrenOf(coordinator_.pid())) {
    if (NameOf(CommandLine(pid)) == name && !HasEnded(pid)) return pid;
  }
  return 0;
}

const json& RunUnderTest::Report(const std::string& process) {
  const size_t dash = process.rfind('-');
  return reports_.Last(process.substr(0, dash), std::stoi(process.substr(dash + 1)));
}

RunUnderTest::Progress RunUnderTest::TakeProgress() {
  Progress progress;
  const json& replay = Report("replay-0");
  if (replay.contains("stored_records")) {  // it has not while it reads its ring
    const double stored = Figure(replay, "stored_records");
    if (stored < most_stored_) {
      throw Broken(fmt::format("the replay reports {} stored records, it had {} before", stored,
                               most_stored_));
    }
    most_stored_ = stored;
    progress.stored_steps = Figure(replay, "stored_steps");
  }
  if (const json& learner = Report("learner-0"); learner.is_object()) {
    progress.updates = Figure(learner, "updates");
    if (learner.value("batches_shared", 1.0) == 0) {
      throw Broken("the learner's batches come over the network, no more through shared memory");
    }
  }
  for (int i = 0; i < options_.actors; ++i) {
    const std::string name = fmt::format("actor-{}", i);
    const json& report = Report(name);
    if (!report.is_object()) continue;
    double& acknowledged = acknowledged_[{name, report.at("pid").get<pid_t>()}];
    acknowledged = std::max(acknowledged, Figure(report, "made") - Figure(report, "outstanding"));
  }
  return progress;
}

void RunUnderTest::AwaitRecovery(const std::string& process, pid_t former, const Progress& before,
                                 seconds deadline) {
  const SteadyTime start = Now();
  const double since = process == "coordinator" ? 0 : Figure(Report(process), "t");
  // A restarted learner goes on from its newest checkpoint: count from where it begins.
  double least_updates = before.updates;
  while (true) {
    CheckAlive();
    const Progress now = TakeProgress();
    least_updates = std::min(least_updates, now.updates);
    bool reported = true;
    if (process != "coordinator") {
      const json& report = Report(process);
      const pid_t pid = report.value("pid", 0);
      reported =
          pid == Pid(process) && (former == 0 || pid != former) && Figure(report, "t") > since;
    }
    if (reported && now.stored_steps >= before.stored_steps + kMoreSteps &&
        now.updates >= least_updates + kMoreUpdates) {
      return;
    }
    if (Now() - start > deadline) {
      throw Broken(fmt::format(
          "{} s after {} was struck: reported {}, stored steps {} -> {}, updates {} -> {}",
          deadline.count(), process, reported, before.stored_steps, now.stored_steps, least_updates,
          now.updates));
    }
    std::this_thread::sleep_for(kLookAgain);
  }
}

std::map<std::string, double> RunUnderTest::QueueDepths() {
  std::map<std::string, double> depths;
  depths["replay-0 chunks waiting"] = Figure(Report("replay-0"), "queue_depth");
  depths["replay-0 requests waiting"] = Figure(Report("replay-0"), "requests_waiting");
  for (int i = 0; i < options_.actors; ++i) {
    const std::string name = fmt::format("actor-{}", i);
    depths[name + " records outstanding"] = Figure(Report(name), "outstanding");
  }
  return depths;
}

void RunUnderTest::CheckAlive() {
  if (StopRequested()) throw Interrupted("the soak did not end");
  if (const auto status = coordinator_.Poll()) {
    throw Broken(fmt::format("the run has ended ({}): {}", status->Describe(), Output()));
  }
}

json RunUnderTest::End(seconds deadline) {
  TakeProgress();
  coordinator_.Signal(SIGINT);
  const SteadyTime start = Now();
  while (true) {
    if (const auto status = coordinator_.Poll()) {
      if (status->ShellCode() != kInterruptedExit) {
        throw Broken("the run ended with " + status->Describe() + ": " + Output());
      }
      break;
    }
    if (Now() - start > deadline) throw Broken("the run did not stop in time: " + Output());
    std::this_thread::sleep_for(kLookAgain);
  }
  TakeProgress();
  json meta = json::parse(ReadFile(path_ / "meta.json"));
  const json& accounting = meta.at("accounting");
  const int64_t made = accounting.at("made"), stored = accounting.at("stored"),
                lost = accounting.at("lost_with_process").get<int64_t>() +
                       accounting.at("lost_with_replay").get<int64_t>(),
                rejected = accounting.at("rejected"), after_gap = accounting.at("after_gap");
  if (made != stored + lost + rejected + after_gap) {
    throw Broken("the account does not balance: " + accounting.dump());
  }
  if (rejected != 0) throw Broken("records were rejected: " + accounting.dump());
  CheckAcknowledged(accounting);
  return meta;
}

// Each acknowledged record must be accounted for in the end.
void RunUnderTest::CheckAcknowledged(const json& accounting) {
  double told = 0;
  for (const auto& [process, acknowledged] : acknowledged_) told += acknowledged;
  const double dealt =
      accounting.at("made").get<double>() - accounting.at("lost_with_process").get<double>();
  if (dealt < told) {
    throw Broken(fmt::format("{} records were acknowledged, {} are accounted for as dealt with",
                             told, dealt));
  }
}

std::string RunUnderTest::Output() const {
  const std::string output = ReadFile(options_.folder / "output");
  constexpr size_t kTail = 2000;
  return output.size() <= kTail ? output : "..." + output.substr(output.size() - kTail);
}

}  // namespace shoal::soak
