// SPDX-License-Identifier: Apache-2.0
// Coordinator, actors and learner for a replay server under test, all on one bus.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "common/config/batch_options.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/link/reader.h"
#include "common/link/writer.h"
#include "tests/replay_server/record_script.h"

namespace shoal::replay {

// Joins as the learner, because besides the replay only this role is on both domains. One test
// thread.
class ReplayPeers {
 public:
  ReplayPeers(const RunConfig& run, const ClusterAddress& address)
      : run_(run),
        bus_(address, run.config.transport, dds::Role::kLearner),
        control_(bus_),
        chunks_(bus_),
        requests_(bus_),
        credits_(bus_,
                 [this](const CreditsMessage& m) {
                   for (const Credit& credit : m.credits) OnCredit(credit);
                 }),
        parts_(bus_, [this](const BatchPart& part) { OnPart(part); }),
        slots_(bus_, [this](const BatchSlot& slot) { OnSlot(slot); }),
        metrics_(bus_, [this](const ReplayMetrics& m) { OnMetrics(m); }) {}

  // Sends a heartbeat if the last is old enough. All waits below also send heartbeats, unless
  // `silent`.
  void Beat() {
    if (silent || Now() - last_beat_ < std::chrono::milliseconds(200)) return;
    last_beat_ = Now();
    control_.Write({.epoch = 1, .state = state, .time = WallTimeSeconds()});
  }
  void Stop() {
    control_.Write({.epoch = 2, .state = RunState::kStopping, .time = WallTimeSeconds()});
  }

  // Waits until `done`, which is called under the lock, returns true. Returns false at the
  // deadline.
  bool WaitFor(const std::function<bool()>& done,
               std::chrono::seconds deadline = std::chrono::seconds(20)) {
    const SteadyTime end = Now() + deadline;
    while (true) {
      Beat();
      std::unique_lock lock(mutex_);
      if (changed_.wait_for(lock, std::chrono::milliseconds(50), done)) return true;
      if (Now() > end) return false;
    }
  }

  // Waits until the replay's readers are matched, so that later messages arrive.
  bool WaitForReplay() {
    return WaitFor([this] { return chunks_.Matched() > 0 && requests_.Matched() > 0; });
  }

  // Sends the script's records up to `last` like a correct actor, until all are acknowledged.
  // Returns false at the deadline.
  bool Deliver(RecordScript* script, uint64_t last) {
    const SteadyTime end = Now() + std::chrono::seconds(30);
    SteadyTime progress{};
    uint64_t sent = Stored(*script), known = sent;
    while (Now() < end) {
      const uint64_t stored = Stored(*script);
      if (stored >= last) return true;
      // Without progress, or after a new replay session, resends from the oldest record.
      if (stored > known) progress = Now();
      if (stored > sent || Now() - progress > std::chrono::milliseconds(300)) {
        sent = stored;
        progress = Now();
      }
      known = stored;
      const uint64_t limit = std::min(last, std::max(Allowed(*script), Window()));
      while (sent < limit) {
        const auto count = static_cast<uint32_t>(std::min<uint64_t>(
            limit - sent, static_cast<uint64_t>(run_.config.transport.chunk_records)));
        if (!chunks_.Write(script->Chunk(sent + 1, count))) break;
        sent += count;
      }
      Beat();
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(20),
                        [&] { return credit_[script->actor()].stored > stored; });
    }
    return false;
  }
  bool Write(const TransitionChunk& chunk) { return chunks_.Write(chunk); }

  // Requests a batch and assembles its parts. Repeats the request like a learner. Empty if the
  // batch does not arrive.
  std::vector<uint8_t> Batch(uint64_t request) {
    {
      const std::lock_guard lock(mutex_);
      batch_.assign(BatchSchemaOf(run_).total_bytes(), 0);
      missing_parts_.reset();
      wanted_ = request;
    }
    for (int attempt = 0; attempt < 4; ++attempt) {
      requests_.Write({.spec_hash = run_.spec.Hash(),
                       .learner_session = 5,
                       .request = request,
                       .batch = static_cast<uint32_t>(run_.config.learner.batch),
                       .after_steps = 0,
                       .schema_hash = BatchSchemaOf(run_).Hash()});
      if (WaitFor([this] { return missing_parts_ && missing_parts_->empty(); },
                  std::chrono::seconds(5))) {
        const std::lock_guard lock(mutex_);
        return batch_;
      }
    }
    return {};
  }

  // Requests a batch in shared memory, and releases the slots of earlier requests up to `released`.
  void RequestSlot(uint64_t request, uint64_t released) {
    requests_.Write({.spec_hash = run_.spec.Hash(),
                     .learner_session = 6,
                     .request = request,
                     .batch = static_cast<uint32_t>(run_.config.learner.batch),
                     .after_steps = 0,
                     .schema_hash = BatchSchemaOf(run_).Hash(),
                     .released = released,
                     .takes_slots = true});
  }
  // Waits for the slot of a request. Empty if it does not arrive.
  std::optional<BatchSlot> WaitForSlot(uint64_t request) {
    if (!WaitFor([&] { return filled_.contains(request); })) return std::nullopt;
    const std::lock_guard lock(mutex_);
    return filled_.at(request);
  }

  Credit LastCredit(uint32_t actor) {
    const std::lock_guard lock(mutex_);
    return credit_[actor];
  }
  // May be called only in the predicate of WaitFor, which holds the lock.
  const Credit& CreditLocked(uint32_t actor) { return credit_[actor]; }
  const std::map<std::string, double>& MetricsLocked() { return newest_metrics_; }

  RunState state = RunState::kRunning;
  bool silent = false;

 private:
  uint64_t Stored(const RecordScript& script) {
    const Credit credit = LastCredit(script.actor());
    return credit.session == script.session() ? credit.stored : 0;
  }
  uint64_t Allowed(const RecordScript& script) {
    const Credit credit = LastCredit(script.actor());
    return credit.session == script.session() ? credit.allowed : 0;
  }
  uint64_t Window() const {
    return static_cast<uint64_t>(run_.config.replay.window_chunks) *
           run_.config.transport.chunk_records;
  }

  void OnCredit(const Credit& credit) {
    const std::lock_guard lock(mutex_);
    if (credit.replay_session < credit_[credit.actor].replay_session) return;
    credit_[credit.actor] = credit;
    changed_.notify_all();
  }
  void OnPart(const BatchPart& part) {
    const std::lock_guard lock(mutex_);
    if (part.request != wanted_ || part.offset + part.payload.size() > batch_.size()) return;
    std::ranges::copy(part.payload, batch_.begin() + static_cast<std::ptrdiff_t>(part.offset));
    if (!missing_parts_) {
      missing_parts_.emplace();
      for (uint32_t i = 0; i < part.parts; ++i) missing_parts_->insert(i);
    }
    missing_parts_->erase(part.part);
    changed_.notify_all();
  }
  void OnSlot(const BatchSlot& slot) {
    const std::lock_guard lock(mutex_);
    filled_[slot.request] = slot;
    changed_.notify_all();
  }
  void OnMetrics(const ReplayMetrics& message) {
    const std::lock_guard lock(mutex_);
    if (message.role != "replay") return;
    for (size_t i = 0; i < message.names.size(); ++i) {
      newest_metrics_[message.names[i]] = message.values[i];
    }
    changed_.notify_all();
  }

  const RunConfig run_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<uint32_t, Credit> credit_;
  std::vector<uint8_t> batch_;
  uint64_t wanted_ = 0;
  std::optional<std::set<uint32_t>> missing_parts_;
  std::map<uint64_t, BatchSlot> filled_;  // by request
  std::map<std::string, double> newest_metrics_;
  SteadyTime last_beat_{};

  dds::Bus bus_;
  link::Writer<ControlMessage> control_;
  link::Writer<TransitionChunk> chunks_;
  link::Writer<SampleRequest> requests_;
  link::Reader<CreditsMessage> credits_;
  link::Reader<BatchPart> parts_;
  link::Reader<BatchSlot> slots_;
  link::Reader<ReplayMetrics> metrics_;
};

}  // namespace shoal::replay
