// SPDX-License-Identifier: Apache-2.0
// The learner of a run, put together: networks, batches and weights over the link, checkpoints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "common/config/run_config.h"
#include "common/link/hub.h"
#include "common/link/reader.h"
#include "common/nn/precision.h"
#include "common/run_folder/update_page.h"
#include "common/wire/control_state.h"
#include "common/wire/process_name.h"
#include "learner/agent/agent.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/resizable_agent.h"
#include "learner/batch_feed.h"
#include "learner/checkpoint_store.h"
#include "learner/hub_learner_sink.h"
#include "learner/pending_evaluations.h"

namespace shoal::learner {

// Members are in construction order: readers, which end first, write to what is above them.
class LearnerProgram {
 public:
  // The learner `name` of the run in `folder`. Restores the newest checkpoint, or starts fresh. Its
  // networks use `threads` threads. `make`: the run's agent; tests bring a cheaper one. One thread
  // constructs and runs it. Borrows the hub. Throws Error.
  LearnerProgram(const std::filesystem::path& folder, const ProcessName& name, const RunConfig& run,
                 int threads, link::Hub& hub, const AgentFactory& make = learner::MakeAgent);

  // Trains until an order to stop (0; kUnwrittenExit where the last checkpoint could not be
  // written) or the coordinator is gone (1). Throws Error.
  int Run();

 private:
  std::optional<CheckpointState> Restore();

  void StartFresh();

  // Gives the agent so many threads, unless they do not fit, and returns how many it has.
  int Resize(int threads);

  const std::filesystem::path folder_;
  const ProcessName name_;
  const RunConfig run_;
  const uint64_t session_;
  const nn::Precision precision_;
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
