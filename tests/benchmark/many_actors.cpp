// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/many_actors.h"

#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "actor/sending/sequence_log.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/interrupted.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "common/wire/weights_parts.h"
#include "launch/processes/child_process.h"
#include "launch/processes/process_plan.h"
#include "launch/record/accounting.h"
#include "tests/support/processes.h"

namespace shoal::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr milliseconds kPoll{5};
constexpr std::chrono::seconds kFound{120}, kEnd{120};

// Frames of one camera of 84x84, without physics.
RunConfig FakeRun(int actors) {
  RunConfig run = UnlearnedRun(actors);
  run.config.envs_per_actor = 1;
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

// Replaces the coordinator for the processes of the run, and receives the replay's reports.
class Bystander {
 public:
  Bystander(std::unique_ptr<dds::Bus> bus)
      : bus_(std::move(bus)),
        control_(*bus_),
        weights_(*bus_),
        credits_(*bus_, [this](const CreditsMessage& message) { OnCredits(message); }),
        metrics_(*bus_, [this](const ReplayMetrics& message) { OnMetrics(message); }) {}

  // Looks and sends heartbeats until `done`. False at the deadline.
  template <class Done>
  bool Until(Done done, std::chrono::duration<double> deadline) {
    const SteadyTime start = Now();
    while (!done()) {
      if (StopRequested()) throw Interrupted("nothing was measured");
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
  // Publishes the weights of all actors, including those that start later.
  void Publish(const RunConfig& run, const std::string& weights) {
    WeightsMessage message;
    message.spec_hash = run.spec.Hash();
    message.version = {/*session=*/1, /*update=*/1};
    message.payload = {reinterpret_cast<const uint8_t*>(weights.data()), weights.size()};
    for (uint32_t part = 0; part < WeightsParts(weights.size()); ++part) {
      if (!weights_.Write(PartOf<WeightsPart>(message, part))) {
        throw RuntimeError("the weights were not taken");
      }
    }
  }
  size_t ActorsAnswered() {
    const std::lock_guard lock(mutex_);
    return answered_.size();
  }
  // Counts of records and of the steps among them.
  struct Stored {
    double records = 0, steps = 0;
  };
  Stored StoredNow() {
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
      if (message.names[i] == "stored_records") stored_.records = message.values[i];
      if (message.names[i] == "stored_steps") stored_.steps = message.values[i];
    }
  }

  std::mutex mutex_;
  std::set<uint32_t> answered_;
  Stored stored_;
  ControlMessage order_{.epoch = 1};
  SteadyTime last_beat_{};
  std::unique_ptr<dds::Bus> bus_;
  link::Writer<ControlMessage> control_;
  link::Writer<WeightsPart> weights_;
  link::Reader<CreditsMessage> credits_;
  link::Reader<ReplayMetrics> metrics_;
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

double SecondsOfAll(const std::vector<launch::ChildProcess>& processes) {
  double sum = 0;
  for (const launch::ChildProcess& process : processes) sum += ProcessorSeconds(process.pid());
  return sum;
}

launch::ProcessSpec ActorSpec(const ManyActorsOptions& options, int id) {
  std::vector<std::string> arguments{"--id", std::to_string(id)};
  if (options.run) {
    launch::ProcessSpec spec = Spec(options, "shoal-actor", arguments);
    if (options.run->config.env.id.empty()) return spec;
    const launch::ProcessSpec python = launch::ActorSpec(options.run->config, {});
    spec.command.erase(spec.command.begin());
    spec.command.insert(spec.command.begin(), python.command.begin(), python.command.end());
    return spec;
  }
  const int step_us = std::max(1, static_cast<int>(1e6 / options.steps_per_second));
  arguments.insert(arguments.end(), {"--step-us", std::to_string(step_us)});
  return Spec(options, "shoal-fake-actor", arguments);
}

// From one report of the replay's to another, so that both ends of the span are exact.
void MeasureSpan(const ManyActorsOptions& options, pid_t replay,
                 const std::vector<launch::ChildProcess>& actors, Bystander* bystander,
                 ManyActorsFigures* figures) {
  const auto next_report = [&] {
    const double before = bystander->StoredNow().records;
    bystander->Until([&] { return bystander->StoredNow().records > before; },
                     std::chrono::seconds(10));
  };
  next_report();
  const SteadyTime begin = Now();
  const Bystander::Stored stored = bystander->StoredNow();
  const double replay_cpu = ProcessorSeconds(replay), actor_cpu = SecondsOfAll(actors);
  bystander->Until([&] { return SecondsSince(begin) > options.seconds; }, kFound);
  next_report();
  const double span = SecondsSince(begin);
  const double transitions = bystander->StoredNow().records - stored.records;
  if (transitions <= 0) throw RuntimeError("nothing was stored in {:.0f} s", span);
  figures->transitions_per_second = transitions / span;
  figures->env_steps_per_second = (bystander->StoredNow().steps - stored.steps) / span;
  figures->replay_us_per_transition = 1e6 * (ProcessorSeconds(replay) - replay_cpu) / transitions;
  figures->actor_us_per_transition = 1e6 * (SecondsOfAll(actors) - actor_cpu) / transitions;
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
  for (const actor::MadeCount& page : actor::ReadSequenceLogs(run)) {
    made.push_back({page.actor, page.session, page.made});
  }
  const launch::Accounting account = launch::Account(
      made, ReadAccount(run), {.own_actors = static_cast<uint32_t>(figures->actors)});
  if (!account.Balances()) throw RuntimeError("{}: {}", account.faults[0], account.Line());
  figures->made = account.made;
  figures->stored = account.stored;
  figures->lost = account.lost_with_process;
}

}  // namespace

RunConfig UnlearnedRun(int actors) {
  RunConfig run;
  run.config.run_name = "many-actors";
  run.config.actors = actors;
  run.config.replay.capacity = 2000;
  run.config.replay.min_size = 100;
  run.config.replay.samples_per_insert = Schedule::Constant(0);
  return run;
}

ManyActorsFigures MeasureManyActors(const ManyActorsOptions& options) {
  RunConfig run = options.run.value_or(FakeRun(options.actors));
  run.config.actors = options.actors;
  ClusterAddress address;
  Bystander bystander(dds::ClaimDomain(run.config.transport, &address));
  WriteRunConfig(options.folder, run);
  WriteClusterAddress(options.folder, address);
  if (!options.weights.empty()) bystander.Publish(run, options.weights);
  std::vector<launch::ChildProcess> replay, actors;
  replay.emplace_back(Spec(options, "shoal-replay", {}));
  if (!bystander.Until([&] { return fs::exists(options.folder / "accounting.json"); }, kFound)) {
    throw RuntimeError("the replay did not start: {}", launch::LastLine(options.folder / "log"));
  }
  ManyActorsFigures figures{.actors = options.actors};
  const SteadyTime start = Now();
  for (int i = 0; i < options.actors; ++i) actors.emplace_back(ActorSpec(options, i));
  figures.start_seconds = SecondsSince(start);
  const auto all = static_cast<size_t>(options.actors);
  if (!bystander.Until([&] { return bystander.ActorsAnswered() == all; }, kFound)) {
    throw RuntimeError("{} of {} actors were found within {} s: {}", bystander.ActorsAnswered(),
                       all, kFound.count(), launch::LastLine(options.folder / "log"));
  }
  figures.found_seconds = SecondsSince(start) - figures.start_seconds;
  MeasureSpan(options, replay[0].pid(), actors, &bystander, &figures);

  bystander.Tell(RunState::kDraining);
  RequireEnd(&bystander, &actors, "an actor");
  bystander.Tell(RunState::kStopping);
  RequireEnd(&bystander, &replay, "the replay");
  TakeAccount(options.folder, &figures);
  return figures;
}

}  // namespace shoal::bench
