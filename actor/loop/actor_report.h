// SPDX-License-Identifier: Apache-2.0
// A training actor's report, once a second (docs/monitoring.md): its work and its waiting times.
#pragma once

#include <cstdint>

#include "actor/acting/host_weights.h"
#include "actor/loop/actor_loop.h"
#include "actor/loop/rollout.h"
#include "common/tasks/task.h"
#include "common/wire/metrics_report.h"
#include "common/wire/process_name.h"

namespace shoal::actor {

// Borrows its parts. One thread.
class ActorReport {
 public:
  struct Parts {
    const Rollout& rollout;
    const ActionSelector& selector;
    const ChunkSender& sender;
    const HostWeights& weights;
    const ActorLoop& loop;
    tasks::Task task;
  };
  ActorReport(uint32_t id, const Parts& parts) : parts_(parts), report_(ProcessName::Actor(id)) {}

  bool Due(SteadyTime now) { return report_.Due(now); }
  // Valid until the next call.
  const MetricsMessage& Make(const char* state);

 private:
  void AddSending();
  void AddStages();
  void AddEpisodes();
  void AddFaults();

  const Parts parts_;
  MetricsReport report_;
};

}  // namespace shoal::actor
