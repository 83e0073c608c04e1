// SPDX-License-Identifier: Apache-2.0
// What the processes of a run say to its coordinator, received and held until its loop takes it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/link/hub.h"
#include "common/link/reader.h"
#include "common/wire/messages.h"
#include "launch/watch/message_inbox.h"

namespace shoal::launch {

// Messages arrive on threads of DDS; what is here is for one thread. A message of a process that
// cannot be is not held: each topic may be written by one role only, which has one process, and
// actors have numbers below kMostActors. Members are in construction order: subscribers end before
// the inboxes they fill.
class RunInbox {
 public:
  explicit RunInbox(link::Hub& hub);

  // What has come since the last call.
  std::vector<MetricsMessage> TakeReports() { return reports_.TakeAll(); }
  std::vector<EvalMessage> TakeEvaluations() { return evaluations_.TakeAll(); }
  std::vector<ReplayProgress> TakeReplayProgress() { return replay_words_.TakeAll(); }
  std::vector<LearnerProgress> TakeLearnerProgress() { return learner_words_.TakeAll(); }

  // Came faster than they were taken.
  uint64_t dropped() const;
  // Reports and progress of processes that cannot be.
  uint64_t refused() const { return refused_; }

 private:
  // Holds the reports of a topic that only this role may write.
  template <class M>
  std::function<void(const M&)> ReportsOf(std::string_view role);

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
