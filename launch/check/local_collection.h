// SPDX-License-Identifier: Apache-2.0
// Actor and replay of a run in one process, without DDS. Environments play random actions, their
// records pass through the actor's chunk window into a replay core, and batches have the learner's
// format.
#pragma once

#include <cstdint>
#include <filesystem>

#include "actor/acting/action_selector.h"
#include "actor/loop/rollout.h"
#include "actor/sending/chunk_window.h"
#include "actor/sending/sequence_log.h"
#include "common/base/aligned_bytes.h"
#include "common/config/run_config.h"
#include "common/wire/batch_schema.h"
#include "replay_server/core/replay_core.h"

namespace shoal::launch {

// One thread. Borrows nothing.
class LocalCollection {
 public:
  // Writes to `folder` the actor's sequence log and, if replay.storage = file, the ring. Throws
  // Error if the environment does not match the run, or if there is no space for the ring.
  LocalCollection(const RunConfig& run, const std::filesystem::path& folder);

  // Plays and stores at least `env_steps` more steps. Throws Error with the reason if the replay
  // refuses a record.
  void Collect(uint64_t env_steps);

  // Draws the next batch. Valid until the next call. Throws Error if the replay returns no batch.
  BatchView Draw();

  const replay::ReplayCore& core() const { return core_; }
  const actor::Rollout& rollout() const { return rollout_; }

 private:
  void Deliver();

  const RunConfig run_;
  replay::ReplayCore core_;
  actor::SequenceLog made_;
  actor::ChunkWindow window_;
  actor::ActionSelector selector_;
  actor::Rollout rollout_;
  AlignedBytes batch_;
  uint64_t requests_ = 0;
};

}  // namespace shoal::launch
