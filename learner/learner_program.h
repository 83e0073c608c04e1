// SPDX-License-Identifier: Apache-2.0
// The complete learner of a run: networks, batches and weights over the link, and checkpoints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "common/base/usable_cores.h"
#include "common/config/run_config.h"
#include "common/link/hub.h"
#include "common/link/reader.h"
#include "common/run_folder/update_page.h"
#include "common/wire/control_state.h"
#include "common/wire/process_name.h"
#include "learner/agent/agent.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/resizable_agent.h"
#include "learner/batch_feed.h"
#include "learner/checkpoint_store.h"
#include "learner/hub_learner_sink.h"
#include "learner/learner_device.h"
#include "learner/node_affinity.h"
#include "learner/pending_evaluations.h"

namespace shoal::learner {

// Members are in construction order. The readers are last and are destroyed first, because their
// callbacks write to the other members.
class LearnerProgram {
 public:
  // Makes the learner `name` of the run in `folder`. Restores the newest checkpoint, or starts
  // without one. On a CPU its networks use `threads` threads, and `make` makes the run's agent;
  // tests pass a cheaper agent. `affinity` places the threads of a process of its own; null leaves
  // them where they are. The same thread must construct and run the program. Borrows the hub and
  // `affinity`. Throws Error.
  LearnerProgram(const std::filesystem::path& folder, const ProcessName& name, const RunConfig& run,
                 int threads, link::Hub& hub, const AgentFactory& make = learner::MakeAgent,
                 NodeAffinity* affinity = nullptr);

  // Trains until the run stops and returns the exit code: 0 after a stop request, kUnwrittenExit if
  // the last checkpoint could not be written, 1 if the coordinator was lost. Throws Error; of the
  // kind kDevice if the GPU failed, which is then counted in the run's learner_device.json.
  int Run();

 private:
  // Run, without counting a loss of the GPU.
  int Train();

  std::optional<CheckpointState> Restore();

  void StartFresh();

  // Changes the agent's number of threads, if possible, and returns the resulting number.
  int Resize(int threads);

  // Limits of the process on cores, whatever node its threads are kept on.
  CoreLimits Limits() const;

  const std::filesystem::path folder_;
  const ProcessName name_;
  const RunConfig run_;
  const uint64_t session_;
  NodeAffinity* const affinity_;
  LearnerDevice device_;
  ResizableAgent agent_;
  CheckpointStore checkpoints_;
  const std::optional<CheckpointState> restored_;
  UpdatePage update_page_;
  PendingEvaluations pending_evaluations_;
  ControlState control_;
  HubLearnerSink sink_;
  const std::unique_ptr<BatchFeed> batches_;
  link::Reader<EvalMessage> evaluation_subscriber_;
  link::Reader<ControlMessage> control_subscriber_;
};

}  // namespace shoal::learner
