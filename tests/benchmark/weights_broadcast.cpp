// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/weights_broadcast.h"

#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include "actor/acting/action_selector.h"
#include "actor/acting/host_weights.h"
#include "actor/loop/actor_loop.h"
#include "actor/loop/hub_parts.h"
#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/files.h"
#include "common/base/host_name.h"
#include "common/dds/bus.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/scratch_folder.h"
#include "learner/agent/agent.h"
#include "learner/hub_learner_sink.h"
#include "learner/weights_sender.h"
#include "tests/benchmark/forked_processes.h"

namespace shoal::bench {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kDeadline{60};
constexpr uint64_t kLearnerSession = 1;

RunConfig RunOf(const BroadcastOptions& options) {
  RunConfig run = TwoCameraRun("broadcast");
  run.config.network.encoder = options.encoder;
  run.config.envs_per_actor = 1;
  return run;
}

nn::Precision PrecisionOf(const RunConfig& run) {
  return nn::ChoosePrecision(run.config.learner.precision, run.spec.HasPixels());
}

// A policy as it starts, of which there is always a newer version.
class StillAgent final : public learner::Agent {
 public:
  explicit StillAgent(const RunConfig& run)
      : parameters_(nn::PolicyParameters(run.config.network, run.spec),
                    nn::ParameterSet::Use::kInference) {
    parameters_.Initialise(1);
  }

  std::vector<learner::UpdateOutcome> Submit(const BatchView&,
                                             const learner::OnStageEnd&) override {
    ++updates_;
    return std::vector<learner::UpdateOutcome>(1);
  }
  uint64_t updates() const override { return updates_; }
  nn::TensorMap PolicyTensors() const override {
    nn::TensorMap tensors;
    parameters_.Export(&tensors);
    return tensors;
  }
  nn::TensorMap AveragedPolicyTensors() const override { return PolicyTensors(); }
  nn::TensorMap AllTensors() const override { return PolicyTensors(); }
  void Restore(const nn::TensorMap&, const std::string&) override {
    CHECK(false) << "nothing was kept";
  }

 private:
  nn::ParameterSet parameters_;
  uint64_t updates_ = 0;
};

// Sends a version at once and then as many as each order says, at the requested rate.
void Learn(const BroadcastOptions& options, const ClusterAddress& address, const Pipe<int>& orders,
           const Pipe<int>& done) {
  const RunConfig run = RunOf(options);
  dds::Bus bus(address, run.config.transport, dds::Role::kLearner);
  learner::HubLearnerSink sink(bus);
  StillAgent agent(run);
  learner::WeightsSender sender(run, PrecisionOf(run), kLearnerSession, agent, sink);
  const std::chrono::duration<double> period(1 / options.versions_per_second);
  const auto send = [&] {
    const uint64_t unsent = sender.unsent();
    sender.Send(/*env_steps=*/0);
    return sender.unsent() == unsent;
  };
  int versions = 1;
  while (true) {
    bool sent = true;
    const SteadyTime begin = Now();
    for (int i = 0; i < versions; ++i) {
      const auto due = std::chrono::duration_cast<SteadyTime::duration>(i * period);
      std::this_thread::sleep_until(begin + due);  // the rate is what is being measured
      agent.Update({}, {});
      sent = send();
    }
    while (!sent) sent = send();  // the last version is awaited
    done.Write(static_cast<int>(agent.updates()));
    versions = orders.Read();
  }
}

// Loads each received version. The policy acts once with the first version, because only then it
// has memory layouts, into which later loads convert the weights, as in a run.
void Act(const BroadcastOptions& options, const ClusterAddress& address,
         const std::filesystem::path& folder, const Pipe<int>& acting_by) {
  const RunConfig run = RunOf(options);
  actor::ActionSelector selector(run.config, run.spec, run.config.envs_per_actor);
  dds::Bus bus(address, run.config.transport, dds::Role::kActor);
  actor::HostWeights host_weights(folder, HostName(), run.spec.Hash(), actor::WeightsOver(bus));
  bool acted = false;
  while (true) {
    const auto weights = host_weights.TryTake();
    if (!weights) {
      std::this_thread::sleep_for(actor::ActorLoop::kBlockedWait);
      continue;
    }
    selector.Load(*weights);
    if (!std::exchange(acted, true)) selector.Select(actor::Acting::kMean);
    acting_by.Write(static_cast<int>(weights->version.update));
  }
}

// CPU time of another process so far.
double CpuSecondsOf(pid_t pid) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) {
    throw RuntimeError("a process of the measurement has ended");
  }
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The learner, then the actors; killed and waited for at the end.
class Processes {
 public:
  Processes() = default;
  ~Processes() {
    for (const pid_t pid : pids_) kill(pid, SIGKILL);
    for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
  }
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  void Add(pid_t pid) { pids_.push_back(pid); }
  struct Cpu {
    SteadyTime time{};
    double learner = 0, actors = 0;
  };
  Cpu CpuNow() const {
    Cpu cpu{.time = Now(), .learner = CpuSecondsOf(pids_[0])};
    for (size_t i = 1; i < pids_.size(); ++i) cpu.actors += CpuSecondsOf(pids_[i]);
    return cpu;
  }

 private:
  std::vector<pid_t> pids_;
};

// How many versions were loaded until all actors act by the last one.
int AwaitVersion(int version, int actors, const Pipe<int>& acting_by) {
  int loaded = 0;
  for (int arrived = 0; arrived < actors; ++loaded) {
    arrived += acting_by.Read(kDeadline) == version;
  }
  return loaded;
}

// Shares of one core, for each side.
Processes::Cpu Shares(const Processes::Cpu& from, const Processes::Cpu& to) {
  const double span = std::chrono::duration<double>(to.time - from.time).count();
  return {.learner = (to.learner - from.learner) / span,
          .actors = (to.actors - from.actors) / span};
}

double VersionBytes(const RunConfig& run) {
  nn::TensorMap tensors = StillAgent(run).PolicyTensors();
  if (PrecisionOf(run) == nn::Precision::kBf16) tensors = nn::ToBf16(tensors);
  return static_cast<double>(nn::WriteSafetensors(tensors, {}).size());
}

}  // namespace

BroadcastFigures MeasureBroadcast(const BroadcastOptions& options) {
  const RunConfig run = RunOf(options);
  const double version_bytes = VersionBytes(run);
  const launch::ScratchFolder folder;
  MakeFolders(folder.path() / kMadeFolder);
  Pipe<Meeting> meeting;
  Pipe<int> orders, done, acting_by;
  Processes processes;
  processes.Add(Fork("learner", [&] {
    orders.CloseWriter();
    const Meeting where = FreeMeeting(run.config.transport);
    meeting.Write(where);
    Learn(options, AddressOf(where), orders, done);
  }));
  const Meeting where = meeting.Read(kDeadline);
  for (int i = 0; i < options.actors; ++i) {
    processes.Add(Fork("actor", [&] { Act(options, AddressOf(where), folder.path(), acting_by); }));
  }
  AwaitVersion(done.Read(kDeadline), options.actors, acting_by);

  const Processes::Cpu settled = processes.CpuNow();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  const Processes::Cpu before = processes.CpuNow();
  const int versions =
      std::max(1, static_cast<int>(std::lround(options.seconds * options.versions_per_second)));
  orders.Write(versions);
  const int last = done.Read(std::chrono::duration_cast<milliseconds>(
      kDeadline + std::chrono::duration<double>(options.seconds)));
  const int loaded = AwaitVersion(last, options.actors, acting_by);
  // A version lasts until the next one would come.
  const std::chrono::duration<double> whole(versions / options.versions_per_second);
  std::this_thread::sleep_until(before.time +
                                std::chrono::duration_cast<SteadyTime::duration>(whole));
  const Processes::Cpu after = processes.CpuNow();

  const Processes::Cpu idle = Shares(settled, before), sending = Shares(before, after);
  return {.learner = sending.learner - idle.learner,
          .actors = sending.actors - idle.actors,
          .idle = idle.learner + idle.actors,
          .taken = static_cast<double>(loaded) / (static_cast<double>(versions) * options.actors),
          .version_bytes = version_bytes};
}

}  // namespace shoal::bench
