#include "replay_server/service/batch_sender.h"

#include <algorithm>
#include <exception>
#include <new>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/stop.h"

namespace shoal::replay {
namespace {

constexpr std::chrono::milliseconds kPause{5};  // between tries

}  // namespace

BatchSender::BatchSender(uint64_t spec_hash, uint64_t batch_bytes, int buffers, ShardWriter* writer,
                         std::function<void()> on_free)
    : spec_hash_(spec_hash),
      batch_bytes_(batch_bytes),
      writer_(*writer),
      on_free_(std::move(on_free)) {
  CHECK(buffers > 0 && batch_bytes % 64 == 0);
  for (int i = 0; i < buffers; ++i) {
    memory_.emplace_back(static_cast<uint8_t*>(std::aligned_alloc(64, batch_bytes)));
    if (!memory_.back()) throw std::bad_alloc();
    free_.push_back(memory_.back().get());
  }
  thread_ = std::thread([this] { Run(); });
}

BatchSender::~BatchSender() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

uint8_t* BatchSender::FreeBuffer() {
  const std::lock_guard lock(mutex_);
  return free_.empty() ? nullptr : free_.back();
}

void BatchSender::Send(const DrawnBatch& batch, uint8_t* buffer) {
  const std::lock_guard lock(mutex_);
  CHECK(!free_.empty());
  // The sender may have put another buffer behind it since FreeBuffer().
  const auto it = std::ranges::find(free_, buffer);
  CHECK(it != free_.end());
  free_.erase(it);
  queue_.push_back({batch, buffer});
  changed_.notify_one();
}

void BatchSender::Run() {
  try {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      const Outgoing outgoing = queue_.front();
      queue_.pop_front();
      lock.unlock();
      ++(SendShards(outgoing) ? sent_ : given_up_);
      lock.lock();
      free_.push_back(outgoing.buffer);
      on_free_();
    }
  } catch (const std::exception& e) {
    log::Failure("batch sender: {}", e.what());
    RequestStop();
  }
}

bool BatchSender::WaitForReader(const DrawnBatch& batch) {
  // The learner's request may come before its reader is matched, and a volatile writer without a
  // reader sends to nobody. DDS tells of a match in a status, so this looks again and again.
  const SteadyTime deadline = Now() + kReaderDeadline;
  while (!writer_.HasReader()) {
    if (!Wanted(batch.request.learner_session) || Now() > deadline) return false;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPause, [this] { return stopping_.load(); });
  }
  return true;
}

bool BatchSender::SendShards(const Outgoing& outgoing) {
  if (!WaitForReader(outgoing.batch)) return false;
  const SampleRequest& request = outgoing.batch.request;
  BatchShard shard;
  shard.spec_hash = spec_hash_;
  shard.learner_session = request.learner_session;
  shard.request = request.request;
  shard.shards = static_cast<uint32_t>((batch_bytes_ + kShardBytes - 1) / kShardBytes);
  shard.total_bytes = batch_bytes_;
  shard.stored_records = outgoing.batch.stored_records;
  shard.stored_steps = outgoing.batch.stored_steps;
  for (shard.shard = 0; shard.shard < shard.shards; ++shard.shard) {
    shard.offset = shard.shard * kShardBytes;
    shard.payload = {outgoing.buffer + shard.offset,
                     std::min(kShardBytes, batch_bytes_ - shard.offset)};
    if (!SendShard(shard)) return false;
  }
  return true;
}

bool BatchSender::SendShard(const BatchShard& shard) {
  const SteadyTime deadline = Now() + kShardDeadline;
  while (Wanted(shard.learner_session)) {
    if (writer_.Write(shard)) return true;
    if (Now() > deadline) {
      log::Warning("batch of request {} given up: shard {} of {} was not taken within {} s",
                   shard.request, shard.shard, shard.shards, kShardDeadline.count());
      return false;
    }
    std::unique_lock lock(mutex_);  // a writer that fails at once must not make this a busy loop
    changed_.wait_for(lock, kPause, [this] { return stopping_.load(); });
  }
  return false;
}

}  // namespace shoal::replay
