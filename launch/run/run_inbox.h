// SPDX-License-Identifier: Apache-2.0
// Holds the messages of a run's processes to the coordinator until the coordinator's loop takes
// them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/link/hub.h"
#include "common/link/reader.h"
#include "common/link/run_topology.h"
#include "common/wire/messages.h"
#include "launch/watch/message_inbox.h"

namespace shoal::launch {

// Messages arrive on threads of the hub; one thread takes them. Messages of processes that are not
// in the run's topology are refused and counted. The order of the members makes readers end before
// the inboxes that they fill.
class RunInbox {
 public:
  RunInbox(link::Hub& hub, const link::RunTopology& topology);

  // Each of these functions returns the messages that arrived since its last call.
  std::vector<MetricsMessage> TakeReports() { return reports_.TakeAll(); }
  std::vector<EvalMessage> TakeEvaluations() { return evaluations_.TakeAll(); }
  std::vector<ReplayProgress> TakeReplayProgress() { return replay_words_.TakeAll(); }
  std::vector<LearnerProgress> TakeLearnerProgress() { return learner_words_.TakeAll(); }

  // Number of messages that arrived while an inbox was full.
  uint64_t dropped() const;
  // Number of refused reports and progress messages.
  uint64_t refused() const { return refused_; }

 private:
  // Makes the callback of the reader of messages M.
  template <class M>
  std::function<void(const M&)> HoldReports();

  const link::RunTopology topology_;
  MessageInbox<MetricsMessage> reports_;
  MessageInbox<EvalMessage> evaluations_;
  MessageInbox<ReplayProgress> replay_words_;
  MessageInbox<LearnerProgress> learner_words_;
  std::atomic<uint64_t> refused_{0};
  link::Reader<ActorMetrics> actor_reports_;
  link::Reader<EvalMetrics> eval_reports_;
  link::Reader<ReplayMetrics> replay_reports_;
  link::Reader<LearnerMetrics> learner_reports_;
  link::Reader<ReplayProgress> replay_progress_;
  link::Reader<LearnerProgress> learner_progress_;
  link::Reader<EvalMessage> evaluation_subscriber_;
};

}  // namespace shoal::launch
