// SPDX-License-Identifier: Apache-2.0
// A training actor: steps environments, sends their records within its credit, and takes the newest
// weights between steps. Owns the parts of the loop (actor_loop.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "actor/acting/action_selector.h"
#include "actor/acting/environments.h"
#include "actor/acting/host_weights.h"
#include "actor/loop/actor_loop.h"
#include "actor/loop/actor_report.h"
#include "actor/loop/hub_parts.h"
#include "actor/loop/rollout.h"
#include "actor/loop/rollout_state.h"
#include "actor/sending/actor_lock.h"
#include "actor/sending/chunk_sender.h"
#include "actor/sending/chunk_window.h"
#include "actor/sending/sequence_log.h"
#include "common/config/run_config.h"
#include "common/link/hub.h"
#include "common/link/metrics_writer.h"

namespace shoal::actor {

// Members are in construction order; destruction is the reverse.
class TrainingActor {
 public:
  // Actor `id` of the run in `folder`. Waits until an earlier process of the same id has ended.
  // `make` makes the task's environments; tests of the transport use cheaper environments. The same
  // thread constructs the actor and calls Run. Borrows the hub. Throws Error.
  TrainingActor(const std::filesystem::path& folder, uint32_t id, link::Hub& hub,
                const EnvironmentFactory& make = MakeEnvironments);

  // Runs until the coordinator ends the run or a stop is requested. Returns 0 if all records were
  // acknowledged, 1 if the coordinator was lost or records were not acknowledged, kUnwrittenExit if
  // the state of a run in lockstep could not be written. Throws Error.
  int Run();

 private:
  ActorLoop::End RunLoop(ActorLoop& loop, ActorReport& report);

  // Lockstep: continues exactly from the state of the previous process.
  void Restore();

  // Lockstep: writes the state for the next process. False if the state could not be written.
  bool Leave();

  const RunConfig run_;
  const ActorLock lock_;
  const std::filesystem::path folder_;
  const uint32_t id_;
  const std::optional<RolloutState> resumed_;  // lockstep
  const uint64_t session_;
  const uint32_t first_env_;
  SequenceLog made_;
  ChunkWindow window_;
  ActionSelector selector_;
  Rollout rollout_;
  link::MetricsWriter<ActorMetrics> metrics_;
  HubChunkLink link_;
  HostWeights weights_;
  HubRunControl control_;
  ChunkSender sender_;
};

}  // namespace shoal::actor
