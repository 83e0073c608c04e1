// SPDX-License-Identifier: Apache-2.0
// Requests batches from the replay. learner.request_credits requests are outstanding at any time. A
// request is sent again if no part of its answer has arrived for some time. Either the replay was
// restarted, or its limiter withholds the batch; in the second case, the repeated request does no
// harm. Does not depend on DDS: `send` sends requests, OnPart receives parts, and OnSlot receives
// messages about batches in shared memory.
//
// A batch in shared memory is read without a copy; later requests release its slot. If the memory
// cannot be used, this is logged, and every further request refuses the memory; the replay then
// sends parts.
//
// Request r brings the errors of batch r - request_credits - kErrorDelay, if samples have
// priorities. These errors are known when the request is made, although updates may be in flight. A
// request therefore has the same errors in each run of a lockstep learner.
//
// Threads: receive threads call OnPart and OnSlot; one other thread calls the other functions.
// `send` is called without a lock held. Memory: request_credits + 1 batches; the pages are used
// only if parts arrive.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/mutex.h"
#include "common/config/batch_options.h"
#include "learner/batch_assembler.h"
#include "learner/batch_stream.h"
#include "learner/pin_memory.h"
#include "learner/slot_batches.h"

namespace shoal::learner {

class BatchSource final : public BatchStream {
 public:
  // Sends a request. Returns false if the request was not sent; BatchSource then tries again.
  using Send = std::function<bool(const SampleRequest&)>;

  // `first_request`: number of the next update, so that a resumed learner continues with the right
  // request. In lockstep, the replay answers a request in the phase of its update, and the last
  // request is for the run's last update. `pin` is given the memory of batches at its first use.
  BatchSource(const RunConfig& run, uint64_t learner_session, uint64_t first_request, Send send,
              std::chrono::milliseconds resend_after = kResendAfter, PinMemory pin = {});

  void OnPart(const BatchPart& part);
  void OnSlot(const BatchSlot& slot);

  std::optional<Batch> Next(SteadyTime deadline) override;
  void TakeErrors(const SampleErrors& errors) override;
  BatchCounters counters() const override;

  static constexpr std::chrono::milliseconds kResendAfter{2'000};
  // More updates than an engine has in flight.
  static constexpr uint64_t kErrorDelay = 3;

 private:
  struct Outstanding {
    uint64_t request = 0;
    bool sent = false;       // whether the request was sent at least once
    SteadyTime next_send{};  // time of the next sending; max() if the batch is complete
    SampleErrors errors{};   // that the request brings
  };

  SampleRequest MakeRequest(const Outstanding& outstanding) const SHOAL_REQUIRES(mutex_);
  Outstanding* Find(uint64_t request) SHOAL_REQUIRES(mutex_);
  bool Whole(uint64_t request) SHOAL_REQUIRES(mutex_);
  // Adds requests while credits and buffers are available, and sends the requests that are due.
  void SendDue() SHOAL_EXCLUDES(mutex_);
  void Extend() SHOAL_REQUIRES(mutex_);
  // The errors that request `request` brings; empty if there are none.
  SampleErrors ErrorsFor(uint64_t request) SHOAL_REQUIRES(mutex_);
  std::vector<SampleRequest> TakeDue() SHOAL_REQUIRES(mutex_);
  void TryAgain(const std::vector<uint64_t>& unsent) SHOAL_REQUIRES(mutex_);
  std::optional<Batch> TakeFirst() SHOAL_REQUIRES(mutex_);
  std::optional<Batch> FindBatch(uint64_t request) SHOAL_REQUIRES(mutex_);
  // Returns empty if the memory cannot be used; the batch is then requested again.
  std::optional<Batch> OpenSlot(uint64_t request) SHOAL_REQUIRES(mutex_);
  void Pin(const uint8_t* assembled) SHOAL_REQUIRES(mutex_);
  void SayWay(bool shared) SHOAL_REQUIRES(mutex_);
  void SayRefusal(const char* why) SHOAL_REQUIRES(mutex_);
  void ReleaseHandedOut() SHOAL_REQUIRES(mutex_);
  // Time at which the next request is due to be sent again.
  SteadyTime NextDue() const SHOAL_REQUIRES(mutex_);
  void RefuseOtherSpec() const SHOAL_REQUIRES(mutex_);

  const RunConfig run_;
  const uint64_t spec_hash_;
  const uint64_t learner_session_;
  const uint64_t last_request_;
  const BatchSchema schema_;
  const bool has_priorities_;
  const Send send_;
  const std::chrono::milliseconds resend_after_;
  const PinMemory pin_;

  mutable Mutex mutex_;
  ConditionVariable arrived_;
  BatchAssembler assembler_ SHOAL_GUARDED_BY(mutex_);
  // By the address of an assembled batch.
  std::map<const uint8_t*, std::shared_ptr<const void>> pinned_ SHOAL_GUARDED_BY(mutex_);
  SlotBatches slots_ SHOAL_GUARDED_BY(mutex_);
  std::deque<SampleErrors> errors_ SHOAL_GUARDED_BY(mutex_);  // for later requests, oldest first
  std::deque<Outstanding> outstanding_ SHOAL_GUARDED_BY(mutex_);  // ascending request ids
  uint64_t next_request_ SHOAL_GUARDED_BY(mutex_);
  // Request whose batch the caller uses; 0 = no batch.
  uint64_t handed_out_ SHOAL_GUARDED_BY(mutex_) = 0;
  uint64_t released_ SHOAL_GUARDED_BY(mutex_) = 0;  // highest request whose batch was released
  // Whether batches are in shared memory, according to the last log line.
  std::optional<bool> shared_ SHOAL_GUARDED_BY(mutex_);
  uint64_t other_spec_hash_ SHOAL_GUARDED_BY(mutex_) = 0;  // hash of a refused part; 0 = no part
  std::optional<SteadyTime> refusal_said_ SHOAL_GUARDED_BY(mutex_);
  BatchCounters counters_ SHOAL_GUARDED_BY(mutex_);
};

}  // namespace shoal::learner
