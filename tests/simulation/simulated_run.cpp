// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_run.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>

#include "common/base/check.h"
#include "common/base/descriptor.h"
#include "common/base/random.h"
#include "common/base/sleep.h"
#include "common/link/local_network.h"
#include "tests/simulation/fiber_scheduler.h"
#include "tests/simulation/oracles.h"
#include "tests/simulation/run_operator.h"
#include "tests/simulation/simulated_disk.h"
#include "tests/simulation/train_session.h"

namespace shoal::simulation {
namespace {

using std::chrono::seconds;

constexpr int64_t kWallTimeNs = 1'700'000'000'000'000'000;
// A run that has not ended so long after its last fault never will: it lasts 20 s without faults.
constexpr seconds kPatience{300};

// The coordinator shows its progress on standard output: its log has the same lines.
class SilentOutput {
 public:
  SilentOutput() : kept_((std::fflush(stdout), dup(STDOUT_FILENO))) {
    const Descriptor nothing(open("/dev/null", O_WRONLY | O_CLOEXEC));
    CHECK(dup2(nothing.get(), STDOUT_FILENO) == STDOUT_FILENO);
  }
  ~SilentOutput() {
    std::fflush(stdout);
    dup2(kept_.get(), STDOUT_FILENO);
  }
  SilentOutput(const SilentOutput&) = delete;
  SilentOutput& operator=(const SilentOutput&) = delete;

 private:
  const Descriptor kept_;
};

bool Any(const std::vector<Fault>& faults, const char* follows) {
  return std::ranges::any_of(faults, [&](const Fault& fault) { return fault.text == follows; });
}

bool FailsWrites(const Fault& fault) {
  return fault.kind == Fault::Kind::kFullDisk || fault.kind == Fault::Kind::kFailingDisk;
}

// A process that leaves or is held up for longer than peers wait for it.
bool Disturbs(const Fault& fault) {
  switch (fault.kind) {
    case Fault::Kind::kPause:
    case Fault::Kind::kStall:
    case Fault::Kind::kSlow:
      return fault.span > link::kLivenessLimit;
    case Fault::Kind::kAttach:
    case Fault::Kind::kSecond:
      return false;
    default:
      return true;
  }
}

bool StrikesReplay(const Fault& fault) {
  return fault.process == "replay-0" && (fault.kind == Fault::Kind::kKill || Disturbs(fault));
}

double OrderlyUntil(const std::vector<Fault>& faults) {
  const auto first = std::ranges::find_if(faults, Disturbs);
  if (first == faults.end()) return std::numeric_limits<double>::infinity();
  return static_cast<double>(kWallTimeNs) * 1e-9 + std::chrono::duration<double>(first->at).count();
}

}  // namespace

Outcome Simulate(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
                 const std::filesystem::path& folder) {
  FiberScheduler scheduler(seed, kWallTimeNs);
  SimulatedDisk disk(HashWords({seed, 2}));
  // A run that does not end leaves hubs, which must not outlive their network, and threads that use
  // other objects. They end with this process, as killed ones do.
  auto& network = *new link::LocalNetwork(  // NOLINT: see above
      [&](size_t count) { return scheduler.Draw(count); });
  Story story;
  SimulatedProcesses processes(scheduler, network,
                               [&](const launch::ProcessSpec& spec, link::Hub& hub) {
                                 return RunChild(blueprint, folder, story, spec, hub);
                               });
  const World world{blueprint, folder, processes, story};
  RunOperator person(world, scheduler, disk);
  ThreadGroup own("operator", folder.string() + ".operator.log");
  ThreadGroup faulter("faults", folder.string() + ".operator.log");
  Witness::Acknowledged acknowledged;
  scheduler.StartIn(&own, [&] {
    processes.StartOther("witness", link::Role::kActor, folder.string() + ".operator.log",
                         [&](link::Hub& hub) {
                           const Witness witness(hub);
                           while (!person.finished()) SleepFor(seconds(1));
                           acknowledged = witness.acknowledged();
                           return 0;
                         });
    person.Work();
  });
  scheduler.StartIn(&faulter, [&] { person.Strike(faults); });
  const SilentOutput silent;
  const SteadyTime last = SteadyTime() + (faults.empty() ? seconds(0) : seconds(30));
  while (scheduler.Alive(&own) > 0 &&
         scheduler.NowOutside() < std::max(last, person.quiet_from()) + kPatience) {
    scheduler.RunUntil(scheduler.NowOutside() + seconds(1));
  }
  scheduler.RunUntil(scheduler.NowOutside() + seconds(2));  // the witness ends
  Outcome outcome{
      .violations = story.violations(),
      .story = {},
      .trace = scheduler.TraceHash(),
      .switches = scheduler.switches(),
      .seconds = std::chrono::duration<double>(scheduler.NowOutside().time_since_epoch()).count(),
      .sessions = person.sessions()};
  if (person.finished()) {
    const Facts facts{.struck = !faults.empty(),
                      .last_clean = person.last_clean(),
                      .overwritten = Any(faults, kThenOverwrite),
                      .cut = Any(faults, kThenCutRing),
                      .lost = Any(faults, kThenLoseRing),
                      .unwritten = std::ranges::any_of(faults, FailsWrites),
                      .replay_struck = std::ranges::any_of(faults, StrikesReplay),
                      .orderly_from = static_cast<double>(kWallTimeNs) * 1e-9,
                      .orderly_until = OrderlyUntil(faults),
                      .acknowledged = acknowledged};
    for (std::string& line : BrokenPromises(world, facts)) {
      outcome.violations.push_back(std::move(line));
    }
  } else if (outcome.violations.empty()) {
    outcome.violations.push_back(
        fmt::format("the run has not ended {} s after its last fault", kPatience.count()));
  }
  outcome.story = story.lines();
  return outcome;
}

}  // namespace shoal::simulation
