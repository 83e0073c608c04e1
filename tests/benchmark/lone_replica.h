// SPDX-License-Identifier: Apache-2.0
// One of N replicas of a SAC agent, run by itself on one thread: what an update costs a replica
// without waiting for the others.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/replica.h"
#include "learner/agent/agent.h"
#include "learner/engine/cpu_engine.h"
#include "tests/benchmark/noise_batch.h"

namespace shoal::bench {

class LoneReplica {
 public:
  // `encoder` and batch of the default configuration. All N replicas are made, on this thread, and
  // do one update together.
  LoneReplica(const std::string& encoder, int batch, int replicas);

  // An update of one rank alone. Its parameters soon mean nothing; its cost is that of an update.
  void Update(
      int rank, const learner::OnStageEnd& on_stage_end = [](learner::UpdateStage) {});

  int replicas() const { return int(agents_.size()); }

 private:
  const Config config_;
  const NoiseBatch noise_;
  nn::Exchange exchange_;
  std::deque<nn::Replica> replicas_;
  std::deque<learner::CpuEngine> engines_;
  std::vector<std::unique_ptr<learner::Agent>> agents_;
};

}  // namespace shoal::bench
