// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_inbox.h"

#include "common/config/config.h"
#include "common/wire/process_name.h"

namespace shoal::launch {
namespace {

constexpr size_t kMessages = 10'000;
constexpr size_t kMostEvaluations = 64;  // of a megabyte each, where they are nonsense

}  // namespace

RunInbox::RunInbox(link::Hub& hub)
    : reports_(kMessages),
      evaluations_(kMostEvaluations),
      replay_words_(kMessages),
      learner_words_(kMessages),
      actor_reports_(hub, ReportsOf<ActorMetrics>(ProcessName::Actor(0).role)),
      eval_reports_(hub, ReportsOf<EvalMetrics>(ProcessName::Evaluation().role)),
      replay_reports_(hub, ReportsOf<ReplayMetrics>(ProcessName::Replay(0).role)),
      learner_reports_(hub, ReportsOf<LearnerMetrics>(ProcessName::Learner().role)),
      replay_progress_(hub,
                       [this](const ReplayProgress& word) {
                         if (word.replay == ProcessName::Replay(0).index) {
                           replay_words_.Put(word);
                         } else {
                           ++refused_;
                         }
                       }),
      learner_progress_(hub, [this](const LearnerProgress& word) { learner_words_.Put(word); }),
      evaluation_subscriber_(hub, [this](const EvalMessage& m) { evaluations_.Put(m); }) {}

template <class M>
std::function<void(const M&)> RunInbox::ReportsOf(std::string_view role) {
  const uint32_t ids = role == ProcessName::Actor(0).role ? kMostActors : 1;
  return [this, role, ids](const M& report) {
    if (report.role == role && report.id < ids) {
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
