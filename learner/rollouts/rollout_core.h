// SPDX-License-Identifier: Apache-2.0
// Assembles rollouts from records, without threads, clocks and network. Receives chunks, returns
// credits, and makes batches of complete rollouts. Each rollout belongs to one environment.
//
// A rollout consists of `ppo.rollout_steps` consecutive steps of one environment with one version
// of the weights; it may contain parts of several episodes. A step is used only if the observation
// before the step is known, from the record before it. A rollout is used for the update that
// follows its version or, with ppo.versions_ahead = 1, for the update after that one. Older
// rollouts are dropped. Newer rollouts are kept: weights are sent before the update's checkpoint is
// written, so rollouts with these weights may arrive before the learner waits for them.
//
// Counts of records: a record is counted when it arrives. It counts as discarded until an update
// uses it. Records of rollouts that are dropped, never completed, or lost with this process
// therefore stay discarded, so the counts are correct whenever the process ends.
//
// Starts no threads; not thread-safe, one owner.
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

// Counters since construction.
struct RolloutCounters {
  IntakeCounters intake;
  uint64_t dropped_rollouts = 0;  // complete and incomplete rollouts that no update used
};

// Size of the window of unacknowledged records of one actor.
SendingWindow WindowOf(const RunConfig& run);

class RolloutCore final : private RecordTaker {
 public:
  // The same limit as in the replay.
  static constexpr size_t kMostSessions = 4096;

  // `receiver_session`: session of this process. `before`: the counts of the run's previous
  // learner.
  RolloutCore(const RunConfig& run, uint64_t receiver_session, const RunAccount& before);
  RolloutCore(const RolloutCore&) = delete;
  RolloutCore& operator=(const RolloutCore&) = delete;

  // See ChunkIntake.
  ChunkResult TakeChunk(const TransitionChunk& chunk,
                        uint64_t latest_session = std::numeric_limits<uint64_t>::max());
  // Returns credits for actors; with `changed_only`, only those that changed since the last call.
  std::vector<Credit> TakeCredits(bool changed_only);
  // Returns the credit for an actor whose chunk was refused.
  Credit RefusalOf(const TransitionChunk& chunk) const;

  // Sets the weights of the next update. Drops rollouts that are too old for this update.
  void Await(const WeightsVersion& version);
  // Sets the number of actors for which the next update waits. An increase takes effect at the next
  // Await.
  void SetActors(int actors);

  // Number of environments for whose rollouts the next update waits: all environments of the run's
  // actors, except the absent environments. An environment is absent if the last kAbsentAfter
  // updates were made without it and none of its records arrived in this time. The next record ends
  // the absence.
  int Expected() const { return Environments() - Absent(); }
  // Number of absent environments.
  int Absent() const;
  // Number of environments that have a rollout for the next update.
  int Ready() const;
  static constexpr int kAbsentAfter = 3;
  // Schema of a batch of the ready rollouts. At least one rollout must be ready.
  BatchSchema ReadySchema() const;
  // Copies the ready rollouts, in the order of environments, to `data`, which has the layout of
  // ReadySchema() and is aligned to 64. Removes these rollouts and counts their records as used.
  void TakeReady(const BatchSchema& schema, uint8_t* data);

  // Totals of the whole run: step records that were received, and records that updates used.
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
  // Records of one environment with one version of the weights, in the order of steps.
  struct Rollout {
    WeightsVersion version;
    int session = 0;                             // index of the actor session in sessions_
    uint64_t records = 0;                        // number of records, including resets
    int rows = 0;                                // number of steps
    std::vector<uint8_t> frames;                 // (rows, K*C, H, W)
    std::vector<float> vectors, actions, drawn;  // (rows, V), (rows, A), (rows, A)
    std::vector<float> rewards, bootstraps, log_probs, ends, continues;  // (rows)
    // Next observations of the rows whose `continues` is 0, in the order of rows.
    std::vector<uint8_t> next_frames;
    std::vector<float> next_vectors;

    void Clear();
  };
  // State of one environment.
  struct Lane {
    uint64_t actor_session = 0;
    int session = -1;   // index of actor_session in sessions_
    bool open = false;  // whether the observation before the next step is known
    uint32_t episode = 0, index = 0;
    std::vector<uint8_t> stack;  // (K*C, H, W), observation before the next step
    std::vector<float> vector;   // (V), observation before the next step
    Rollout building;            // incomplete rollout
    std::deque<Rollout> whole;   // complete rollouts, oldest first
    int missed = 0;              // updates without this environment since its last record
  };

  bool Take(const SessionCounters& session, const uint8_t* record) override;
  void OnGap(const SessionCounters& session, uint32_t env) override;
  // The lane of an environment that this actor may run; null for any other environment.
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
  const int steps_, envs_per_actor_;  // steps_: ppo.rollout_steps
  const uint64_t versions_ahead_;
  const uint64_t receiver_session_;
  const size_t stack_bytes_;
  SessionLedger sessions_;
  ChunkIntake intake_;
  CreditBook credits_;
  std::map<uint32_t, Lane> lanes_;  // by environment
  std::vector<Rollout> spare_;      // memory of earlier rollouts, for reuse
  WeightsVersion awaited_;
  int actors_ = 1, expected_actors_ = 1;
  uint64_t stored_steps_ = 0, used_records_ = 0;
  RolloutCounters counters_;
};

}  // namespace shoal::learner
