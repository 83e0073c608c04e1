#include "tests/benchmark/many_actors.h"

#include <fmt/core.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "actor/sending/made_page.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/dds/publisher.h"
#include "common/dds/subscriber.h"
#include "launch/processes/child_process.h"
#include "launch/record/accounting.h"

namespace shoal::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kPoll{5};
constexpr seconds kFound{60}, kEnd{60};

RunConfig Run(int actors) {
  RunConfig run;
  run.config.run_name = "many-actors";
  run.config.actors = actors;
  run.config.envs_per_actor = 1;
  run.config.replay.capacity = 2000;
  run.config.replay.min_size = 100;
  run.config.replay.samples_per_insert = 0;  // nobody learns, so nobody is to be waited for
  run.config.network.filters = {8};
  run.config.network.strides = {2};
  run.config.network.hidden = {16};
  run.spec.task = "Fake";
  run.spec.cameras = {"front"};
  run.spec.channels = 3;
  run.spec.height = run.spec.width = 84;
  run.spec.stack = 1;
  run.spec.action_size = 4;
  run.spec.model_fingerprint = "none";
  return run;
}

// User and system time of a process.
double CpuSeconds(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(in, text);
  const size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0;
  std::istringstream fields(text.substr(name_end + 2));
  std::string field;
  double ticks = 0;
  for (int i = 3; i <= 15 && fields >> field; ++i) {  // 14 and 15: utime, stime
    if (i >= 14) ticks += std::stod(field);
  }
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// The coordinator of the run, as far as its processes notice, and what the replay says.
class Bystander {
 public:
  Bystander(std::unique_ptr<dds::Bus> bus)
      : bus_(std::move(bus)),
        control_(*bus_),
        credits_(*bus_, [this](const CreditsMessage& message) { OnCredits(message); }),
        metrics_(*bus_, [this](const ReplayMetrics& message) { OnMetrics(message); }) {}

  // Looks and sends heartbeats until `done`. False at the deadline.
  template <class Done>
  bool Until(Done done, std::chrono::duration<double> deadline) {
    const SteadyTime start = Now();
    while (!done()) {
      if (StopRequested()) throw RuntimeError("interrupted");
      if (Now() - start > deadline) return false;
      Beat();
      std::this_thread::sleep_for(kPoll);
    }
    return true;
  }
  void Tell(RunState state) {
    order_.state = state;
    ++order_.epoch;
    last_beat_ = {};
    Beat();
  }
  size_t ActorsAnswered() {
    const std::lock_guard lock(mutex_);
    return answered_.size();
  }
  double Stored() {
    const std::lock_guard lock(mutex_);
    return stored_;
  }

 private:
  void Beat() {
    if (Now() - last_beat_ < milliseconds(300)) return;
    last_beat_ = Now();
    order_.time = WallTimeSeconds();
    control_.Write(order_);
  }
  void OnCredits(const CreditsMessage& message) {
    const std::lock_guard lock(mutex_);
    for (const Credit& credit : message.credits) {
      if (credit.stored > 0) answered_.insert(credit.actor);
    }
  }
  void OnMetrics(const ReplayMetrics& message) {
    const std::lock_guard lock(mutex_);
    for (size_t i = 0; i < message.names.size(); ++i) {
      if (message.names[i] == "stored_records") stored_ = message.values[i];
    }
  }

  std::mutex mutex_;
  std::set<uint32_t> answered_;
  double stored_ = 0;
  ControlMessage order_{.epoch = 1};
  SteadyTime last_beat_{};
  std::unique_ptr<dds::Bus> bus_;
  dds::Publisher<ControlMessage> control_;
  dds::Subscriber<CreditsMessage> credits_;
  dds::Subscriber<ReplayMetrics> metrics_;
};

launch::ProcessSpec Spec(const ManyActorsOptions& options, const std::string& program,
                         std::vector<std::string> arguments) {
  launch::ProcessSpec spec;
  spec.role = program;
  spec.command = {(options.programs / program).string(), "--run", options.folder.string()};
  spec.command.insert(spec.command.end(), arguments.begin(), arguments.end());
  spec.environment = {{"OMP_NUM_THREADS", "1"}, {"OMP_WAIT_POLICY", "passive"}};
  spec.output = options.folder / "log";
  return spec;
}

double CpuSeconds(const std::vector<launch::ChildProcess>& processes) {
  double sum = 0;
  for (const launch::ChildProcess& process : processes) sum += CpuSeconds(process.pid());
  return sum;
}

void RequireEnd(Bystander* bystander, std::vector<launch::ChildProcess>* processes,
                const std::string& what) {
  const bool ended = bystander->Until(
      [&] {
        for (launch::ChildProcess& process : *processes) {
          if (!process.Poll()) return false;
        }
        return true;
      },
      kEnd);
  for (launch::ChildProcess& process : *processes) {
    const auto status = process.Poll();
    if (!ended || !status || !status->Clean()) {
      throw RuntimeError("{}: {}", what, status ? status->Describe() : "did not end");
    }
  }
}

void TakeAccount(const fs::path& run, ManyActorsFigures* figures) {
  std::vector<launch::MadeRecords> made;
  for (const actor::MadeCount& page : actor::ReadMadePages(run)) {
    made.push_back({page.actor, page.session, page.made});
  }
  const launch::Accounting account = launch::Account(
      made, launch::ReadSeenByReplay(run), {.own_actors = static_cast<uint32_t>(figures->actors)});
  if (!account.Balances()) throw RuntimeError("{}: {}", account.faults[0], account.Line());
  figures->made = account.made;
  figures->stored = account.stored;
  figures->lost = account.lost_with_process;
}

}  // namespace

ManyActorsFigures MeasureManyActors(const ManyActorsOptions& options) {
  const RunConfig run = Run(options.actors);
  ClusterAddress address;
  Bystander bystander(dds::ClaimDomain(run.config.transport, &address));
  WriteRunConfig(options.folder, run);
  WriteClusterAddress(options.folder, address);
  std::vector<launch::ChildProcess> replay, actors;
  replay.emplace_back(Spec(options, "shoal-replay", {}));
  if (!bystander.Until([&] { return fs::exists(options.folder / "accounting.json"); }, kFound)) {
    throw RuntimeError("the replay did not start: {}", launch::LastLine(options.folder / "log"));
  }
  ManyActorsFigures figures{.actors = options.actors};
  const SteadyTime start = Now();
  const int step_us = static_cast<int>(1e6 / options.steps_per_second);
  for (int i = 0; i < options.actors; ++i) {
    actors.emplace_back(Spec(options, "shoal-fake-actor",
                             {"--id", std::to_string(i), "--step-us", std::to_string(step_us)}));
  }
  figures.start_seconds = SecondsSince(start);
  const auto all = static_cast<size_t>(options.actors);
  if (!bystander.Until([&] { return bystander.ActorsAnswered() == all; }, kFound)) {
    throw RuntimeError("{} of {} actors were found within {} s", bystander.ActorsAnswered(), all,
                       kFound.count());
  }
  figures.found_seconds = SecondsSince(start) - figures.start_seconds;

  // Whole seconds of the replay's reports, so that both ends of the span are reports.
  const auto next_report = [&] {
    const double before = bystander.Stored();
    bystander.Until([&] { return bystander.Stored() > before; }, seconds(10));
  };
  next_report();
  const SteadyTime begin = Now();
  const double stored = bystander.Stored(), replay_cpu = CpuSeconds(replay[0].pid()),
               actor_cpu = CpuSeconds(actors);
  bystander.Until([&] { return SecondsSince(begin) > options.seconds; }, kFound);
  next_report();
  const double transitions = bystander.Stored() - stored;
  figures.transitions_per_second = transitions / SecondsSince(begin);
  figures.replay_us_per_transition = 1e6 * (CpuSeconds(replay[0].pid()) - replay_cpu) / transitions;
  figures.actor_us_per_transition = 1e6 * (CpuSeconds(actors) - actor_cpu) / transitions;

  bystander.Tell(RunState::kDraining);
  RequireEnd(&bystander, &actors, "an actor");
  bystander.Tell(RunState::kStopping);
  RequireEnd(&bystander, &replay, "the replay");
  TakeAccount(options.folder, &figures);
  return figures;
}

}  // namespace shoal::bench
