// SPDX-License-Identifier: Apache-2.0
#include "learner/rollouts/rollout_source.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/sleep.h"
#include "common/config/sending_window.h"
#include "common/intake/receiver_terms.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::learner {
namespace {

constexpr int kAnyNumber = 3;  // deadlines after which fewer than half of the rollouts suffice

int RecordBytes(const RunConfig& run) { return RecordLayout(run.spec).record_bytes(); }

}  // namespace

RolloutSource::RolloutSource(const RunConfig& run, const std::filesystem::path& folder,
                             uint64_t learner_session, uint64_t updates, Send send)
    : run_(run),
      folder_(folder),
      learner_session_(learner_session),
      send_(std::move(send)),
      deadline_(run.config.ppo.rollout_deadline),
      pool_(run.spec.Hash(), ChunkBytes(WindowOf(run), RecordBytes(run)),
            MaxChunks(run.config.actors)),
      core_(run, learner_session, ReadAccountBefore(folder)),
      updates_(updates),
      session_clock_(learner_session),
      last_chunk_(Now()),
      problems_(run.spec.Hash(), "learner") {
  {
    const MutexLock lock(mutex_);
    core_.SetActors(run.config.actors);
    core_.Await({learner_session_, updates_});
  }
  thread_ = Thread([this] { Serve(); });
}

RolloutSource::~RolloutSource() {
  {
    const MutexLock lock(inbox_mutex_);
    stopping_ = true;
    inbox_changed_.NotifyAll();
  }
  thread_.join();
}

size_t RolloutSource::MaxChunks(int actors) const {
  return MostChunks(WindowOf(run_), static_cast<size_t>(std::max(actors, 1)));
}

void RolloutSource::OnChunk(const TransitionChunk& chunk) {
  std::unique_ptr<PooledChunk> copy = pool_.Copy(chunk);
  if (!copy) return;  // the actor will send the chunk again
  const MutexLock lock(inbox_mutex_);
  inbox_.push_back(std::move(copy));
  inbox_changed_.NotifyOne();
}

std::deque<std::unique_ptr<PooledChunk>> RolloutSource::Arrivals() {
  const SteadyTime deadline = Now() + kCreditSpacing;
  const MutexLock lock(inbox_mutex_);
  while (inbox_.empty() && !stopping_) {
    if (!inbox_changed_.WaitUntil(inbox_mutex_, deadline)) break;
  }
  return std::exchange(inbox_, {});
}

void RolloutSource::Serve() {
  SteadyTime last_all{}, last_told{};
  bool stopping = false;
  while (!stopping) {
    {
      const MutexLock lock(inbox_mutex_);
      stopping = stopping_;
    }
    TakeChunks(Arrivals());
    const SteadyTime now = Now();
    const bool all = stopping || now - last_all >= kCreditInterval;
    if (!all && now - last_told < kCreditSpacing) continue;
    Tell(all);
    last_told = now;
    if (all) last_all = now;
    const MutexLock lock(mutex_);
    problems_.Report(now, core_.counters().intake, pool_.Dropped());
  }
}

void RolloutSource::TakeChunks(std::deque<std::unique_ptr<PooledChunk>> chunks) {
  std::vector<Credit> refusals;
  for (std::unique_ptr<PooledChunk>& pooled : chunks) {
    {
      const MutexLock lock(mutex_);
      const ChunkResult result =
          core_.TakeChunk(pooled->chunk, session_clock_.Latest(WallTimeNs()));
      problems_.Note(pooled->chunk, result);
      if (result.fate == ChunkFate::kWrongSpec || result.fate == ChunkFate::kSuperseded) {
        refusals.push_back(core_.RefusalOf(pooled->chunk));
      }
      if (pooled->chunk.count > 0) last_chunk_ = Now();
      changed_.NotifyAll();
    }
    pool_.Release(std::move(pooled));
  }
  if (!refusals.empty()) send_({refusals});
}

void RolloutSource::WriteAccount() {
  const RunAccount account = core_.Account();
  faults_.Try(kAccountingFile, [&] { ReplaceAccount(folder_, account); });
}

void RolloutSource::Tell(bool all) {
  std::vector<Credit> credits;
  {
    const MutexLock lock(mutex_);
    credits = core_.TakeCredits(/*changed_only=*/!all);
    if (credits.empty() && !all) return;
    WriteAccount();
  }
  if (!credits.empty()) send_({credits});
}

bool RolloutSource::Complete(SteadyTime now) {
  const int ready = core_.Ready(), expected = core_.Expected();
  if (ready == 0) return false;
  if (!first_ready_) first_ready_ = now;
  // An update takes minibatches of learner.batch rows, so it needs at least one.
  if (int64_t{ready} * run_.config.ppo.rollout_steps < run_.config.learner.batch) return false;
  if (ready >= expected) return true;
  const std::chrono::duration<double> waited = now - *first_ready_;
  return waited >= deadline_ && (2 * ready >= expected || waited >= kAnyNumber * deadline_);
}

void RolloutSource::SayAbsent() {
  const int absent = core_.Absent();
  if (absent > absent_said_) {
    log::Warning(
        "{} environments have sent nothing for {} updates: updates do not wait for them until they "
        "send again",
        absent, RolloutCore::kAbsentAfter);
  }
  absent_said_ = absent;
}

Batch RolloutSource::HandOut() {
  const int ready = core_.Ready(), expected = core_.Expected();
  if (ready < expected) {
    late_rollouts_ += static_cast<uint64_t>(expected - ready);
    log::Warning(
        "update {} is made of the rollouts of {} environments: those of {} others did not come "
        "within ppo.rollout_deadline = {} s",
        updates_ + 1, ready, expected - ready, deadline_.count());
  }
  schema_.emplace(core_.ReadySchema());
  if (memory_bytes_ < schema_->total_bytes()) {
    memory_bytes_ = schema_->total_bytes();
    memory_ = AlignedBytes(memory_bytes_);
  }
  core_.TakeReady(*schema_, memory_.data());
  SayAbsent();
  handed_out_ = true;
  first_ready_.reset();
  return {.view = schema_->View(memory_.data(), core_.stored_steps()),
          .request = updates_ + 1,
          .stored_records = core_.used_records()};
}

std::optional<Batch> RolloutSource::Next(SteadyTime deadline) {
  const MutexLock lock(mutex_);
  if (std::exchange(handed_out_, false)) core_.Await({learner_session_, ++updates_});
  while (!Complete(Now())) {
    if (!changed_.WaitUntil(mutex_, deadline)) break;
  }
  if (!Complete(Now())) return std::nullopt;
  return HandOut();
}

void RolloutSource::SetActors(int actors) {
  pool_.SetMaxChunks(MaxChunks(actors));
  const MutexLock lock(mutex_);
  core_.SetActors(actors);
}

BatchCounters RolloutSource::counters() const {
  const MutexLock lock(mutex_);
  const RolloutCounters& counters = core_.counters();
  return {.rollouts = BatchCounters::Rollouts{.expected = static_cast<uint64_t>(core_.Expected()),
                                              .ready = static_cast<uint64_t>(core_.Ready()),
                                              .late = late_rollouts_,
                                              .dropped = counters.dropped_rollouts,
                                              .records = counters.intake.records,
                                              .rejected = counters.intake.rejected,
                                              .after_gap = counters.intake.after_gap,
                                              .lost = counters.intake.lost,
                                              .duplicates = counters.intake.duplicates,
                                              .refused_chunks = counters.intake.refused_chunks(),
                                              .pool_drops = pool_.Dropped(),
                                              .actor_sessions = core_.sessions().newest().size()}};
}

void RolloutSource::DrainAfterCoordinatorLoss() {
  const SteadyTime start = Now();
  while (Now() - start < kFarewellLimit) {
    {
      const MutexLock lock(mutex_);
      if (Now() - std::max(last_chunk_, start) > kFarewell) return;
    }
    SleepFor(kCreditSpacing);
  }
}

}  // namespace shoal::learner
