// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/fault_soak.h"

#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/base/clock.h"
#include "tests/soak/fault_plan.h"
#include "tests/soak/leftovers.h"
#include "tests/soak/run_under_test.h"
#include "tests/support/processes.h"

namespace shoal::soak {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kStopped{10};
constexpr seconds kEnd{180};
constexpr milliseconds kPoll{50};

// The time of faults is the thing under test, not a wait for something.
void Pause(RunUnderTest* run, milliseconds span) {
  const SteadyTime start = Now();
  while (Now() - start < span) {
    run->CheckAlive();
    run->TakeProgress();
    std::this_thread::sleep_for(std::min(kPoll, span));
  }
}

pid_t AwaitProcess(RunUnderTest* run, const std::string& name, seconds recovery) {
  const SteadyTime start = Now();
  while (true) {
    if (const pid_t pid = run->Pid(name); pid != 0) return pid;
    run->CheckAlive();
    if (Now() - start > recovery / 2) throw Broken(name + " was not restarted");
    std::this_thread::sleep_for(kPoll);
  }
}

pid_t Send(RunUnderTest* run, const std::string& name, int signal, seconds recovery) {
  while (true) {  // it may end by itself (a former fault's restart) between the two calls
    const pid_t pid = AwaitProcess(run, name, recovery);
    if (kill(pid, signal) == 0) return pid;
  }
}

// Stops the process for ten seconds, in which another one may be killed.
void Stop(RunUnderTest* run, const Fault& fault, seconds recovery) {
  const pid_t pid = Send(run, fault.process, SIGSTOP, recovery);
  Pause(run, kStopped / 2);
  if (!fault.killed_meanwhile.empty()) Send(run, fault.killed_meanwhile, SIGKILL, recovery);
  Pause(run, kStopped / 2);
  kill(pid, SIGCONT);
  if (HasEnded(pid)) throw Broken(fault.process + " ended while it was stopped");
}

struct Tally {
  int count = 0;
  double sum = 0, most = 0;
  void Add(double recovery) {
    ++count;
    sum += recovery;
    most = std::max(most, recovery);
  }
};

std::string Describe(const Fault& fault) {
  if (fault.kind == FaultKind::kKill) return fault.process + " SIGKILL";
  std::string text = fmt::format("{} SIGSTOP {} s", fault.process, kStopped.count());
  if (!fault.killed_meanwhile.empty()) text += ", meanwhile " + fault.killed_meanwhile + " SIGKILL";
  return text;
}

// Seconds until all processes continue.
double Strike(RunUnderTest* run, const Fault& fault, seconds recovery) {
  Pause(run, fault.delay);
  RunUnderTest::Progress before = run->TakeProgress();
  pid_t killed = 0;
  if (fault.kind == FaultKind::kKill && fault.process == "coordinator") {
    // Processes without a coordinator exit after the lease, the replay's last acknowledgements to
    // actors that still send, and a checkpoint.
    run->KillCoordinator(recovery);
    before = run->TakeProgress();
    run->Resume();
  } else if (fault.kind == FaultKind::kKill) {
    killed = Send(run, fault.process, SIGKILL, recovery);
  } else {
    Stop(run, fault, recovery);
    before = run->TakeProgress();
  }
  const SteadyTime struck = Now();
  run->AwaitRecovery(fault.process, killed, before, recovery);
  if (!fault.killed_meanwhile.empty()) {
    run->AwaitRecovery(fault.killed_meanwhile, 0, before, recovery);
  }
  return SecondsSince(struck);
}

}  // namespace

nlohmann::ordered_json SoakFaults(const SoakOptions& options, int faults) {
  const auto shared_memory = SharedMemoryObjects();
  std::map<std::string, Tally> tallies;
  nlohmann::json meta;
  std::filesystem::path path, temporary_files;
  {
    RunUnderTest run({.folder = options.folder,
                      .programs = options.programs,
                      .actors = options.actors,
                      .seed = static_cast<int64_t>(options.seed),
                      .preset = options.preset,
                      .environment = options.environment,
                      .keys = options.keys});
    FaultPlan plan(options.seed, run.ProcessNames(), options.kills_alone);
    for (int i = 1; i <= faults; ++i) {
      const Fault fault = plan.Next(Now());
      fmt::print("{}/{} {} ... ", i, faults, Describe(fault));
      std::fflush(stdout);
      const double recovery = Strike(&run, fault, seconds(options.recovery));
      fmt::print("went on within {:.1f} s\n", recovery);
      std::fflush(stdout);
      const std::string role = fault.process.substr(0, fault.process.find('-'));
      tallies[role + (fault.kind == FaultKind::kKill ? " SIGKILL" : " SIGSTOP")].Add(recovery);
      if (!fault.killed_meanwhile.empty()) tallies["killed meanwhile"].Add(recovery);
    }
    meta = run.End(kEnd);
    path = run.path();
    temporary_files = run.temporary_files();
  }
  CheckNothingIsLeft(path, temporary_files, shared_memory);
  nlohmann::ordered_json result{{"schema", "shoal-soak-1"},
                                {"faults", faults},
                                {"seed", options.seed},
                                {"preset", options.preset},
                                {"environment", options.environment},
                                {"seconds", meta.at("wall_seconds")},
                                {"env_steps", meta.at("env_steps")},
                                {"updates", meta.at("updates")},
                                {"restarts", meta.at("restarts")},
                                {"accounting", meta.at("accounting")}};
  for (const auto& [what, tally] : tallies) {
    result["recovery_seconds"][what] = {
        {"faults", tally.count}, {"mean", tally.sum / tally.count}, {"most", tally.most}};
  }
  return result;
}

}  // namespace shoal::soak
