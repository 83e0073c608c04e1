// Batches pulled from the replay: keeps learner.request_credits requests outstanding and sends one
// again when nothing of its answer has arrived for a while (the replay has restarted, or its
// limiter holds it back: sending it again is harmless). Knows nothing of DDS: requests go out
// through `send`, shards come in through OnShard.
//
// Threads: OnShard from one receive thread; everything else from one other. `send` is called
// without a lock held. Memory: request_credits + 1 batches.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

#include "common/config/run_files.h"
#include "learner/batch_assembler.h"
#include "learner/batch_stream.h"

namespace shoal::learner {

class BatchSource final : public BatchStream {
 public:
  // Sends a request; false: not sent, to be tried again.
  using Send = std::function<bool(const SampleRequest&)>;

  // `first_request` is the number of the next update, so that a learner that resumed asks for what
  // comes next. In lockstep requests wait for their phase and end with the run's last update.
  BatchSource(const RunConfig& run, uint64_t learner_session, uint64_t first_request, Send send,
              std::chrono::milliseconds resend_after = kResendAfter);

  void OnShard(const BatchShard& shard);

  std::optional<Batch> Next(SteadyTime deadline) override;
  BatchCounters counters() const override;

  static constexpr std::chrono::milliseconds kResendAfter{2'000};

 private:
  struct Outstanding {
    uint64_t request = 0;
    bool sent = false;       // at least once
    SteadyTime next_send{};  // when it is due to be sent (again); max() once its batch is whole
  };

  SampleRequest MakeRequest(uint64_t request) const;
  // Expects further requests while credits and buffers last.
  void Extend();
  // Sends what is due; gives up the lock while it does.
  void SendDue(std::unique_lock<std::mutex>& lock);
  std::optional<Batch> TakeFirst();
  void RefuseOtherSpec() const;

  const RunConfig run_;
  const uint64_t spec_hash_;
  const uint64_t learner_session_;
  const uint64_t last_request_;
  const BatchLayout layout_;
  const Send send_;
  const std::chrono::milliseconds resend_after_;

  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  BatchAssembler assembler_;
  std::deque<Outstanding> outstanding_;  // ascending request ids
  uint64_t next_request_;
  uint64_t handed_out_ = 0;       // request whose batch the caller holds; 0 = none
  uint64_t other_spec_hash_ = 0;  // of a refused shard; 0 = none
  BatchCounters counters_;
};

}  // namespace shoal::learner
