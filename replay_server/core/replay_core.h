// SPDX-License-Identifier: Apache-2.0
// The replay server without threads, clocks and network: receives chunks and returns credits,
// receives requests and returns batches. Not thread-safe; the core and its parts have one owner:
//
//   ring             stored records
//   episode index    successors of records, sampleable steps
//   intake           chunks -> ring
//   session table    counts of stored, rejected and lost records
//   policies         choice of samples and of their goals
//   gather           ring -> batch
//   rate limiter     ratio of samples to inserts: whether actors or the learner must wait
//   credit book      credits of the actors
//   request queue    requests of the learner
//   drawn plans      with priorities: samples of the batches that the learner may request again
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/run_config.h"
#include "common/intake/credit_book.h"
#include "common/intake/intake_counters.h"
#include "common/wire/batch_schema.h"
#include "common/wire/messages.h"
#include "replay_server/core/batch_gather.h"
#include "replay_server/core/drawn_plans.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/intake.h"
#include "replay_server/core/rate_limiter.h"
#include "replay_server/core/replay_policies.h"
#include "replay_server/core/request_queue.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/session_table.h"

namespace shoal::replay {

// Number of steps n of a sample, and discount between these steps, from the configuration.
NStep NStepOf(const Config& config);

// Throws Error (kUsage) if no batch could ever be drawn, because the ring is too small for min_size
// samples of n steps, or if actors and learner could wait for each other, because the limiter's
// band is too narrow.
void CheckSampling(const RunConfig& run);

// The answer to one request, without its bytes.
struct DrawnBatch {
  SampleRequest request;
  uint64_t stored_records = 0, stored_steps = 0, unsampleable_steps = 0;  // at the time of the draw
};

// A batch whose frames are still to be copied.
struct BegunBatch {
  DrawnBatch batch;
  FrameCopies copies;
};

// Counts since construction unless stated otherwise.
struct CoreCounters {
  IntakeCounters intake;
  uint64_t batches = 0, repeated_batches = 0;
  uint64_t relabelled = 0;        // batch elements whose goal was replaced
  uint64_t zero_rewards = 0;      // batch elements of reward 0
  uint64_t refused_requests = 0;  // requests with a wrong spec or a wrong schema
  uint64_t surplus_requests = 0;  // requests beyond the learner's credits
  uint64_t stale_requests = 0;    // requests of a learner session that has been replaced
  // Errors of requests that set the priority of a sample, and those whose sample had gone.
  uint64_t priorities_set = 0, priorities_ignored = 0;
};

class ReplayCore {
 public:
  // Opens or makes the ring in `folder` (or in memory, as configured). `replay_session` must
  // increase from start to start. `former`: counts of the run's earlier servers; a count is used
  // only if it is higher than the count in the ring. `progress` is called often while an existing
  // ring is read. Throws Error if there is not enough space, if the ring does not fit the run, or
  // if the band is too small.
  ReplayCore(const RunConfig& run, const std::filesystem::path& folder, uint64_t replay_session,
             const FormerServer& former = {}, const StartupProgress& progress = {});
  // Neither copied nor moved, because the parts refer to each other.
  ReplayCore(const ReplayCore&) = delete;
  ReplayCore& operator=(const ReplayCore&) = delete;

  // See ChunkIntake::Take.
  ChunkResult TakeChunk(const TransitionChunk& chunk,
                        uint64_t latest_session = std::numeric_limits<uint64_t>::max());
  RequestFate TakeRequest(const SampleRequest& request);

  // Draws the batch of the next request and writes it to `data` (batch_schema().total_bytes()
  // bytes, aligned to 64). Returns empty if there is no request or if the next request must wait
  // longer.
  std::optional<DrawnBatch> TryAnswer(uint8_t* data);
  // Does the same except for the frames. The caller makes the copies that write the frames, before
  // it stores the record copies.oldest + ring().capacity().
  std::optional<BegunBatch> BeginAnswer(uint8_t* data);
  // The request that TryAnswer would answer now, if this request was answered before; else empty.
  // If the caller still has the earlier batch, the caller sends the earlier batch again and calls
  // AnsweredAgain() instead of TryAnswer.
  std::optional<SampleRequest> NextRepeated() const;
  void AnsweredAgain();
  // The elements of the batch that was drawn last.
  const BatchPlan& last_plan() const { return last_plan_; }

  // Credits to send to the actors: all credits, or only those that have changed since the last
  // call.
  std::vector<Credit> TakeCredits(bool changed_only);
  // Updates the credit book with the limiter's state and the budget, and returns
  // CreditBook::Urgent.
  bool CreditsUrgent();
  // Answer to an actor that has another spec or that a newer session has replaced. It contains this
  // server's spec hash, the actor's newest session and no credit.
  Credit Refusal(const TransitionChunk& chunk) const;

  void SetDraining(bool draining);
  bool draining() const { return draining_; }
  // Sets the budget of env steps (initially the configured budget). After this number of env steps
  // is stored, actors get no more credit. The budget does not apply while draining, and not in
  // lockstep, which has its own end.
  void SetBudget(uint64_t env_steps) { budget_ = env_steps; }
  void SetSamplesPerInsert(const Schedule& samples) { limiter_.SetSamplesPerInsert(samples); }

  // Whether an actor has less credit than its window now.
  bool InsertsBlocked() const;
  // Whether a request waits for the limiter, for min_size or for after_steps now.
  bool SamplesBlocked() const;

  const RunConfig& run() const { return run_; }
  const BatchSchema& batch_schema() const { return batch_schema_; }
  uint64_t window_records() const;
  uint64_t replay_session() const { return replay_session_; }
  const Ring& ring() const { return ring_; }
  const EpisodeIndex& index() const { return index_; }
  const SessionTable& sessions() const { return sessions_; }
  // Whether an earlier server stored records that are missing in this ring. Such records are lost.
  bool ring_replaced() const { return ring_replaced_; }
  const RateLimiter& limiter() const { return limiter_; }
  const RequestQueue& requests() const { return requests_; }
  const Selector& selector() const { return *policies_.selector; }
  const CoreCounters& counters() const { return counters_; }
  uint64_t budget() const { return budget_; }

 private:
  // Sets the priorities that a request brings.
  void TakeErrors(const SampleRequest& request);
  // Draws the samples of a batch, or returns those of the request's first answer.
  std::optional<BatchPlan> PlanOf(const SampleRequest& request);
  // Whether all records of the plan are still stored.
  bool Stored(const BatchPlan& plan) const;
  // Remaining env steps of the budget; empty if there is no limit.
  std::optional<uint64_t> StepsLeft() const;

  const RunConfig run_;
  const uint64_t spec_hash_;
  const uint64_t replay_session_;
  const BatchSchema batch_schema_;
  Ring ring_;
  SessionTable sessions_;
  EpisodeIndex index_;
  Intake intake_;
  ReplayPolicies policies_;
  BatchGather gather_;
  RateLimiter limiter_;
  CreditBook credits_;
  RequestQueue requests_;
  const bool has_priorities_;
  DrawnPlans plans_;  // empty without priorities
  CoreCounters counters_;
  BatchPlan last_plan_;
  uint64_t budget_;  // env steps
  bool ring_replaced_ = false;
  bool draining_ = false;
};

}  // namespace shoal::replay
