// SPDX-License-Identifier: Apache-2.0
// One of N replicas of a SAC agent, run alone on one thread: the cost of an update for one replica
// without waiting for the other replicas.
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
  // The default configuration with `encoder` and `batch`. Creates all N replicas on this thread;
  // together they make one update.
  LoneReplica(const std::string& encoder, int batch, int replicas);

  // Makes an update of replica `rank` alone. The cost is that of a real update; the parameters
  // become useless.
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
