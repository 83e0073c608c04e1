// SPDX-License-Identifier: Apache-2.0
// Rollouts put together from records, without threads, clocks and network: chunks in, credits out;
// whole rollouts of one environment each, and batches of them.
//
// A rollout is `ppo.rollout_steps` steps of one environment, one after another, by one version of
// the weights, over episodes' ends. Of each environment the observation that its next step starts
// from is known, once it was reset: a step is of use where it goes on from there. Rollouts are for
// the update that follows the version they were played by, or, with ppo.versions_ahead = 1, for the
// one after that; older ones are dropped. Newer ones are kept: weights go out before the update's
// checkpoint is written, and by the time that the next rollouts are awaited they may have come.
//
// Accounting. A record is dealt with when it came, whatever becomes of it. It counts as discarded
// until an update is made of it, and so do those of rollouts that are dropped, never completed, or
// lost with this process: what the account says at any instant is true if the process ends there.
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "common/config/run_config.h"
#include "common/config/sending_window.h"
#include "common/intake/chunk_intake.h"
#include "common/intake/credit_book.h"
#include "common/intake/intake_counters.h"
#include "common/intake/session_ledger.h"
#include "common/run_folder/accounting_file.h"
#include "common/spec/record.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

// Since construction.
struct RolloutCounters {
  IntakeCounters intake;
  uint64_t dropped_rollouts = 0;  // whole and begun ones that no update was made of
};

// The window of unacknowledged records of an actor of the run.
SendingWindow WindowOf(const RunConfig& run);

class RolloutCore final : private RecordTaker {
 public:
  // The limit of a replay.
  static constexpr size_t kMostSessions = 4096;

  // `receiver_session`: this process's. `before`: what a former learner of the run left.
  RolloutCore(const RunConfig& run, uint64_t receiver_session, const RunAccount& before);
  RolloutCore(const RolloutCore&) = delete;
  RolloutCore& operator=(const RolloutCore&) = delete;

  // See ChunkIntake.
  ChunkResult TakeChunk(const TransitionChunk& chunk,
                        uint64_t latest_session = std::numeric_limits<uint64_t>::max());
  // Words to actors; `changed_only`: those that differ from what was taken last.
  std::vector<Credit> TakeCredits(bool changed_only);
  // The word to an actor whose chunk was refused.
  Credit RefusalOf(const TransitionChunk& chunk) const;

  // The weights whose update is next. Drops rollouts that are too old for it.
  void Await(const WeightsVersion& version);
  // How many actors the next update waits for; more only from the next Await on.
  void SetActors(int actors);

  // Environments whose rollouts the next update waits for: those of the run's actors but the absent
  // ones. Absent is an environment of which nothing came while the last kAbsentAfter updates were
  // made without it, until a record of it comes.
  int Expected() const { return Environments() - Absent(); }
  int Absent() const;
  // Environments that have a rollout for the next update.
  int Ready() const;
  static constexpr int kAbsentAfter = 3;
  // The schema of a batch of the rollouts that are ready: at least one.
  BatchSchema ReadySchema() const;
  // Fills `data`, of ReadySchema(), aligned to 64, and takes the rollouts off, in the order of
  // environments: an update is made of them.
  void TakeReady(const BatchSchema& schema, uint8_t* data);

  // For the whole run: step records taken, and records that updates used.
  uint64_t stored_steps() const { return stored_steps_; }
  uint64_t used_records() const { return used_records_; }
  const SessionLedger& sessions() const { return sessions_; }
  const RolloutCounters& counters() const { return counters_; }
  RunAccount Account() const {
    return {.stored_steps = stored_steps_,
            .stored_records = used_records_,
            .sessions = sessions_.all()};
  }

 private:
  // Records of one environment by one version of the weights, in the order of steps.
  struct Rollout {
    WeightsVersion version;
    int session = 0;                             // index of the actor session
    uint64_t records = 0;                        // resets too
    int rows = 0;                                // steps
    std::vector<uint8_t> frames;                 // (rows, K*C, H, W)
    std::vector<float> vectors, actions, drawn;  // (rows, V), (rows, A) twice
    std::vector<float> rewards, bootstraps, log_probs, ends, continues;  // (rows)
    // Next observations of the rows that the next row does not continue, in order.
    std::vector<uint8_t> next_frames;
    std::vector<float> next_vectors;

    void Clear();
  };
  struct Lane {
    uint64_t actor_session = 0;
    int session = -1;   // its index
    bool open = false;  // the observation and the episode of the next step are known
    uint32_t episode = 0, index = 0;
    std::vector<uint8_t> stack;  // (K*C, H, W): the observation of the next step
    std::vector<float> vector;   // (V)
    Rollout building;
    std::deque<Rollout> whole;  // oldest first
    int missed = 0;             // updates made without it since its last record
  };

  bool Take(const SessionCounters& session, const uint8_t* record) override;
  void OnGap(const SessionCounters& session, uint32_t env) override;
  // The lane of an environment that this actor may host; null for any other.
  Lane* FindLane(uint32_t actor, uint32_t env);
  int Environments() const { return expected_actors_ * envs_per_actor_; }
  void EndEpisode(Lane* lane);
  void TakeReset(const uint8_t* record, Lane* lane);
  bool TakeStep(const uint8_t* record, Lane* lane);
  void AddRow(const uint8_t* record, Lane* lane);
  void Observe(const uint8_t* record, bool reset, Lane* lane);
  void Drop(Rollout* rollout);
  void DropOld(Lane* lane);
  bool TooOld(const Rollout& rollout) const;
  void CopyRows(const BatchView& batch, int first_row, uint32_t env, const Rollout& rollout);

  const RunConfig run_;
  const RecordLayout layout_;
  const BlockPicker observed_;
  const int steps_, envs_per_actor_;  // T
  const uint64_t versions_ahead_;
  const uint64_t receiver_session_;
  const size_t stack_bytes_;
  SessionLedger sessions_;
  ChunkIntake intake_;
  CreditBook credits_;
  std::map<uint32_t, Lane> lanes_;  // by environment
  std::vector<Rollout> spare_;      // memory of former ones
  WeightsVersion awaited_;
  int actors_ = 1, expected_actors_ = 1;
  uint64_t stored_steps_ = 0, used_records_ = 0;
  RolloutCounters counters_;
};

}  // namespace shoal::learner
