// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_inbox.h"

namespace shoal::launch {
namespace {

constexpr size_t kMessages = 10'000;
constexpr size_t kMostEvaluations = 64;  // an invalid one may have a megabyte

}  // namespace

RunInbox::RunInbox(link::Hub& hub, const link::RunTopology& topology)
    : topology_(topology),
      reports_(kMessages),
      evaluations_(kMostEvaluations),
      replay_words_(kMessages),
      learner_words_(kMessages),
      actor_reports_(hub, HoldReports<ActorMetrics>()),
      eval_reports_(hub, HoldReports<EvalMetrics>()),
      replay_reports_(hub, HoldReports<ReplayMetrics>()),
      learner_reports_(hub, HoldReports<LearnerMetrics>()),
      replay_progress_(hub,
                       [this](const ReplayProgress& word) {
                         const char* role = link::RoleName(link::Role::kReplay);
                         if (topology_.CanWrite<ReplayProgress>(role, word.replay)) {
                           replay_words_.Put(word);
                         } else {
                           ++refused_;
                         }
                       }),
      learner_progress_(hub, [this](const LearnerProgress& word) { learner_words_.Put(word); }),
      evaluation_subscriber_(hub, [this](const EvalMessage& m) { evaluations_.Put(m); }) {}

template <class M>
std::function<void(const M&)> RunInbox::HoldReports() {
  return [this](const M& report) {
    if (topology_.CanWrite<M>(report.role, report.id)) {
      reports_.Put(report);
    } else {
      ++refused_;
    }
  };
}

uint64_t RunInbox::dropped() const {
  return reports_.dropped() + evaluations_.dropped() + replay_words_.dropped() +
         learner_words_.dropped();
}

}  // namespace shoal::launch
