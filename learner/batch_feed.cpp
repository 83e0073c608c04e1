// SPDX-License-Identifier: Apache-2.0
#include "learner/batch_feed.h"

#include <utility>

#include "common/config/on_policy.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "learner/batch_source.h"
#include "learner/rollouts/rollout_source.h"

namespace shoal::learner {
namespace {

// Members are in construction order. The readers end first, because they use the members above
// them.
class ReplayFeed final : public BatchFeed {
 public:
  ReplayFeed(const RunConfig& run, uint64_t learner_session, uint64_t updates, link::Hub& hub,
             PinMemory pin)
      : requests_(hub),
        source_(
            run, learner_session, updates + 1,
            [this](const SampleRequest& request) { return Ask(request); },
            BatchSource::kResendAfter, std::move(pin)),
        parts_(hub, [this](const BatchPart& part) { source_.OnPart(part); }),
        slots_(hub, [this](const BatchSlot& slot) { source_.OnSlot(slot); }) {}

  BatchStream& stream() override { return source_; }

 private:
  // Without a matched reader the transport would accept the request and lose it.
  bool Ask(const SampleRequest& request) {
    return requests_.Matched() > 0 && requests_.Write(request);
  }

  link::Writer<SampleRequest> requests_;
  BatchSource source_;
  link::Reader<BatchPart> parts_;
  link::Reader<BatchSlot> slots_;
};

class RolloutFeed final : public BatchFeed {
 public:
  RolloutFeed(const std::filesystem::path& folder, const RunConfig& run, uint64_t learner_session,
              uint64_t updates, link::Hub& hub)
      : credits_(hub),
        source_(run, folder, learner_session, updates,
                [this](const CreditsMessage& message) { credits_.Write(message); }),
        chunks_(hub, [this](const TransitionChunk& chunk) { source_.OnChunk(chunk); }) {}

  BatchStream& stream() override { return source_; }
  void DrainAfterCoordinatorLoss() override { source_.DrainAfterCoordinatorLoss(); }

 private:
  link::Writer<CreditsMessage> credits_;
  RolloutSource source_;
  link::Reader<TransitionChunk> chunks_;
};

}  // namespace

std::unique_ptr<BatchFeed> MakeFeed(const std::filesystem::path& folder, const RunConfig& run,
                                    uint64_t learner_session, uint64_t updates, link::Hub& hub,
                                    PinMemory pin) {
  if (LearnsOnPolicy(run.config)) {
    return std::make_unique<RolloutFeed>(folder, run, learner_session, updates, hub);
  }
  return std::make_unique<ReplayFeed>(run, learner_session, updates, hub, std::move(pin));
}

}  // namespace shoal::learner
