// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/batch_sender.h"

#include <fmt/core.h>

#include <algorithm>
#include <exception>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/stop.h"

namespace shoal::replay {
namespace {

constexpr std::chrono::milliseconds kPause{5};  // between attempts
constexpr std::chrono::seconds kIdleWait{60};   // for a batch, before the next look

}  // namespace

BatchSender::BatchSender(uint64_t spec_hash, uint64_t batch_bytes, int buffers, PartWriter* writer,
                         std::function<void()> on_free)
    : spec_hash_(spec_hash),
      batch_bytes_(batch_bytes),
      writer_(*writer),
      on_free_(std::move(on_free)) {
  CHECK(buffers > 0 && batch_bytes % AlignedBytes::kAlignment == 0);
  for (int i = 0; i < buffers; ++i) {
    memory_.emplace_back(batch_bytes);
    free_.push_back(memory_.back().data());
  }
  thread_ = Thread([this] { Run(); });
}

BatchSender::~BatchSender() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
    changed_.NotifyAll();
  }
  thread_.join();
}

uint8_t* BatchSender::FreeBuffer() {
  const MutexLock lock(mutex_);
  return free_.empty() ? nullptr : free_.back();
}

void BatchSender::Send(const DrawnBatch& batch, uint8_t* buffer) {
  const MutexLock lock(mutex_);
  CHECK(!free_.empty());
  // The sender may have freed another buffer since FreeBuffer(), so this one need not be the last.
  const auto it = std::ranges::find(free_, buffer);
  CHECK(it != free_.end());
  free_.erase(it);
  queue_.push_back(BufferedBatch{batch, buffer});
  changed_.NotifyOne();
}

void BatchSender::Send(const BatchSlot& slot) {
  const MutexLock lock(mutex_);
  // A repeated request does not queue the same message twice.
  for (const Outgoing& waiting : queue_) {
    const auto* word = std::get_if<BatchSlot>(&waiting);
    if (word != nullptr && word->address == slot.address && word->request == slot.request) return;
  }
  queue_.push_back(slot);
  changed_.NotifyOne();
}

std::optional<BatchSender::Outgoing> BatchSender::TakeNext() {
  const MutexLock lock(mutex_);
  while (!stopping_ && queue_.empty()) changed_.WaitUntil(mutex_, Now() + kIdleWait);
  if (stopping_) return std::nullopt;
  const Outgoing outgoing = queue_.front();
  queue_.pop_front();
  return outgoing;
}

void BatchSender::Pause() {
  const MutexLock lock(mutex_);
  const SteadyTime until = Now() + kPause;
  // The notification of a new batch does not shorten the pause.
  while (!stopping_ && changed_.WaitUntil(mutex_, until)) {
  }
}

void BatchSender::Run() {
  try {
    while (const auto outgoing = TakeNext()) {
      const SteadyTime start = Now();
      const bool sent = std::visit([this](const auto& o) { return SendBatch(o); }, *outgoing);
      ++(sent ? sent_ : given_up_);
      sending_seconds_ = sending_seconds_ + SecondsSince(start);  // only this thread writes it
      const auto* buffered = std::get_if<BufferedBatch>(&*outgoing);
      if (buffered == nullptr) continue;
      {
        const MutexLock lock(mutex_);
        free_.push_back(buffered->buffer);
      }
      on_free_();
    }
  } catch (const std::exception& e) {
    log::Failure("batch sender: {}", e.what());
    RequestStop();
  }
}

bool BatchSender::WaitForReader(uint64_t session, bool (PartWriter::*has_reader)()) {
  // The learner's request may arrive before its reader is matched, and a volatile writer without a
  // reader loses its samples. DDS reports a match in a status, which this loop polls.
  const SteadyTime deadline = Now() + kReaderDeadline;
  while (!(writer_.*has_reader)()) {
    if (!Wanted(session) || Now() > deadline) return false;
    Pause();
  }
  return true;
}

bool BatchSender::SendBatch(const BufferedBatch& outgoing) {
  const SampleRequest& request = outgoing.batch.request;
  if (!WaitForReader(request.learner_session, &PartWriter::HasPartReader)) return false;
  BatchPart part;
  part.spec_hash = spec_hash_;
  part.learner_session = request.learner_session;
  part.request = request.request;
  part.parts = static_cast<uint32_t>((batch_bytes_ + kBulkPartBytes - 1) / kBulkPartBytes);
  part.total_bytes = batch_bytes_;
  part.stored_records = outgoing.batch.stored_records;
  part.stored_steps = outgoing.batch.stored_steps;
  part.unsampleable_steps = outgoing.batch.unsampleable_steps;
  for (part.part = 0; part.part < part.parts; ++part.part) {
    part.offset = part.part * kBulkPartBytes;
    part.payload = {outgoing.buffer + part.offset,
                    std::min(kBulkPartBytes, batch_bytes_ - part.offset)};
    if (!SendMessage(part, fmt::format("part {} of {}", part.part, part.parts))) return false;
  }
  return true;
}

bool BatchSender::SendBatch(const BatchSlot& slot) {
  return WaitForReader(slot.learner_session, &PartWriter::HasSlotReader) &&
         SendMessage(slot, fmt::format("the word of slot {}", slot.slot));
}

bool BatchSender::SendMessage(const auto& message, const std::string& what) {
  const SteadyTime deadline = Now() + kPartDeadline;
  while (Wanted(message.learner_session)) {
    if (writer_.Write(message)) return true;
    if (Now() > deadline) {
      log::Warning("batch of request {} given up: {} was not taken within {} s", message.request,
                   what, kPartDeadline.count());
      return false;
    }
    Pause();  // a writer that fails at once must not make this a busy loop
  }
  return false;
}

}  // namespace shoal::replay
