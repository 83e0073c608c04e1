// SPDX-License-Identifier: Apache-2.0
// Batches of rollouts from actors, for the training loop. While the loop learns, a separate thread
// receives chunks, counts and acknowledges their records.
//
// The counts of records are written to RUN/accounting.json before the records are acknowledged. If
// the learner is killed, the file is therefore correct, and the next learner continues from its
// counts. If the file cannot be written (a full disk), training continues, and the next successful
// write corrects the file. Does not depend on DDS: OnChunk receives chunks, `send` sends credits.
//
// A batch is complete when every environment for which the update waits has a rollout. After
// ppo.rollout_deadline has passed since the first rollout, half of the environments are enough;
// after three times this deadline, any number is enough. A batch contains at least one minibatch
// (learner.batch). Updates do not wait for environments that have stopped sending
// (RolloutCore::Expected).
//
// Threads: receive threads call OnChunk; one other thread calls Next, SetActors and counters.
// Memory: two rollouts of every environment, more with ppo.versions_ahead.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "common/base/aligned_bytes.h"
#include "common/base/log.h"
#include "common/base/mutex.h"
#include "common/base/thread_group.h"
#include "common/base/write_faults.h"
#include "common/intake/chunk_pool.h"
#include "common/intake/intake_problems.h"
#include "common/intake/session_clock.h"
#include "learner/batch_stream.h"
#include "learner/rollouts/rollout_core.h"

namespace shoal::learner {

class RolloutSource final : public BatchStream {
 public:
  using Send = std::function<void(const CreditsMessage&)>;

  // `learner_session`, `updates`: version of the weights for the first rollouts. Throws Error if
  // RUN/accounting.json cannot be read.
  RolloutSource(const RunConfig& run, const std::filesystem::path& folder, uint64_t learner_session,
                uint64_t updates, Send send);
  // Writes RUN/accounting.json for the last time.
  ~RolloutSource() override;
  RolloutSource(const RolloutSource&) = delete;
  RolloutSource& operator=(const RolloutSource&) = delete;

  void OnChunk(const TransitionChunk& chunk);

  // Call this function after the update with the previous batch. It waits for rollouts with the
  // weights of that update.
  std::optional<Batch> Next(SteadyTime deadline) override;
  BatchCounters counters() const override;
  // Sets the run's number of actors; a higher number takes effect with the next update.
  void SetActors(int actors) override;

  // After the coordinator is lost, continues to acknowledge records until no chunk has arrived for
  // kFarewell, but at most for kFarewellLimit.
  void DrainAfterCoordinatorLoss();

 private:
  void Serve();
  // Returns the chunks that arrived since the last call; waits briefly if there are none.
  std::deque<std::unique_ptr<PooledChunk>> Arrivals() SHOAL_EXCLUDES(inbox_mutex_);
  void TakeChunks(std::deque<std::unique_ptr<PooledChunk>> chunks) SHOAL_EXCLUDES(mutex_);
  // Writes RUN/accounting.json, then acknowledges records.
  void Tell(bool all) SHOAL_EXCLUDES(mutex_);
  void WriteAccount() SHOAL_REQUIRES(mutex_);
  bool Complete(SteadyTime now) SHOAL_REQUIRES(mutex_);
  Batch HandOut() SHOAL_REQUIRES(mutex_);
  // Logs a line when updates stop waiting for more environments.
  void SayAbsent() SHOAL_REQUIRES(mutex_);
  size_t MaxChunks(int actors) const;

  const RunConfig run_;
  const std::filesystem::path folder_;
  const uint64_t learner_session_;
  const Send send_;
  const std::chrono::duration<double> deadline_;
  ChunkPool pool_;

  mutable Mutex inbox_mutex_;
  ConditionVariable inbox_changed_;
  std::deque<std::unique_ptr<PooledChunk>> inbox_ SHOAL_GUARDED_BY(inbox_mutex_);
  bool stopping_ SHOAL_GUARDED_BY(inbox_mutex_) = false;

  mutable Mutex mutex_;
  ConditionVariable changed_;
  RolloutCore core_ SHOAL_GUARDED_BY(mutex_);
  uint64_t updates_ SHOAL_GUARDED_BY(mutex_);  // update of the awaited weights
  bool handed_out_ SHOAL_GUARDED_BY(mutex_) = false;
  std::optional<SteadyTime> first_ready_ SHOAL_GUARDED_BY(mutex_);
  uint64_t late_rollouts_ SHOAL_GUARDED_BY(mutex_) = 0;
  int absent_said_ SHOAL_GUARDED_BY(mutex_) = 0;
  SessionClock session_clock_ SHOAL_GUARDED_BY(mutex_);
  SteadyTime last_chunk_ SHOAL_GUARDED_BY(mutex_);
  IntakeProblems problems_ SHOAL_GUARDED_BY(mutex_);
  WriteFaults faults_ SHOAL_GUARDED_BY(mutex_){
      [](const std::string& line) { log::Warning("{}", line); }};

  // Schema of the handed-out batch; used by the loop's thread.
  std::optional<BatchSchema> schema_;
  AlignedBytes memory_;
  uint64_t memory_bytes_ = 0;

  Thread thread_;  // last, because it uses the other members
};

}  // namespace shoal::learner
